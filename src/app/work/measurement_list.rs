//! The open measurements, each with its surface.

use crate::app::work::open_measurement::{OpenMeasurement, STYLES};
use crate::app::work::surface::Surface;
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters};

/// The open measurements, one of which is active: panels and panes show it. Without data the list
/// holds one measurement without rows, whose surface the sliders move.
#[derive(Debug, Clone)]
pub struct MeasurementList {
    all: Vec<OpenMeasurement>,
    active: usize,
    /// The parameters that all surfaces share; the others are each surface's own.
    shared: ParameterSet,
    /// Those that were closed, for undo.
    closed: Vec<OpenMeasurement>,
}

impl MeasurementList {
    /// One measurement.
    pub fn single(measurement: OpenMeasurement) -> Self {
        Self { all: vec![measurement], active: 0, shared: ParameterSet::EMPTY, closed: Vec::new() }
    }

    /// Several measurements, the active one by its place; with the first active where there is none
    /// of that place.
    pub fn several(mut all: Vec<OpenMeasurement>, active: usize, shared: ParameterSet) -> Self {
        if all.is_empty() {
            all.push(OpenMeasurement::nothing());
        }
        let active = if active < all.len() { active } else { 0 };
        Self { all, active, shared, closed: Vec::new() }
    }

    /// Whether there is nothing but what the program opened by itself: the next measurement takes
    /// its place.
    pub fn is_placeholder(&self) -> bool {
        self.all.len() == 1 && self.active().is_placeholder
    }

    /// Whether anything is open that was measured.
    pub fn has_rows(&self) -> bool {
        self.all.iter().any(|open| !open.measurement.rows.is_empty())
    }

    /// Adds a measurement and makes it the active one. It gets a colour and a marker that no other
    /// one has, while there are such, and a name that tells it from the others.
    pub fn add(&mut self, mut opened: OpenMeasurement) {
        if self.is_placeholder() {
            self.closed.append(&mut self.all);
        }
        let is_free = |style: &&(usize, _)| self.all.iter().all(|open| (open.style.color, open.style.marker) != **style);
        let (color, marker) = STYLES.iter().find(is_free).copied().unwrap_or(STYLES[self.all.len() % STYLES.len()]);
        (opened.style.color, opened.style.marker) = (color, marker);
        let is_taken = |name: &str| self.all.iter().any(|open| open.name == name);
        if is_taken(&opened.name) {
            let mut names = (2..).map(|number| format!("{} ({number})", opened.name));
            opened.name = names.find(|name| !is_taken(name)).unwrap_or_default();
        }
        self.all.push(opened);
        self.active = self.all.len() - 1;
    }

    /// Closes the measurement of that number; the one after it becomes active in its place.
    pub fn close(&mut self, number: u64) {
        let Some(index) = self.place_of(number) else { return };
        let closed = self.all.remove(index);
        if self.all.is_empty() {
            self.all.push(OpenMeasurement::nothing().with_surface(closed.surface.clone()));
        }
        self.closed.push(closed);
        if self.active > index || self.active >= self.all.len() {
            self.active -= 1;
        }
    }

    /// Opens a closed measurement again, or the one that is made in its place.
    pub fn reopen(&mut self, number: u64, make: impl FnOnce() -> OpenMeasurement) {
        let kept = self.closed.iter().position(|open| open.number == number).map(|index| self.closed.remove(index));
        let open = kept.unwrap_or_else(make);
        if self.is_placeholder() {
            self.closed.append(&mut self.all);
        }
        self.all.push(open);
        self.active = self.active.min(self.all.len() - 1);
    }

    /// Makes the measurement of that number the active one.
    pub fn activate(&mut self, number: u64) {
        self.active = self.place_of(number).unwrap_or(self.active);
    }

    /// Moves the measurement of that number so many places down the list, or up.
    pub fn move_by(&mut self, number: u64, by: isize) {
        let Some(from) = self.place_of(number) else { return };
        let to = from.saturating_add_signed(by).min(self.all.len() - 1);
        let active = self.active().number;
        let open = self.all.remove(from);
        self.all.insert(to, open);
        self.activate(active);
    }

    /// Opens exactly the measurements of those numbers in that order, as far as they are still
    /// known; the others are closed.
    pub fn arrange(&mut self, numbers: &[u64], active: u64) {
        let surface = self.active().surface.clone();
        let mut known: Vec<OpenMeasurement> = self.all.drain(..).chain(self.closed.drain(..)).collect();
        for number in numbers {
            if let Some(index) = known.iter().position(|open| open.number == *number) {
                self.all.push(known.remove(index));
            }
        }
        self.closed = known;
        if self.all.is_empty() {
            self.all.push(OpenMeasurement::nothing().with_surface(surface));
        }
        self.active = 0;
        self.activate(active);
    }

    /// Lets go of closed measurements that nothing leads back to.
    pub fn forget_closed(&mut self, is_needed: impl Fn(u64) -> bool) {
        self.closed.retain(|open| is_needed(open.number));
    }

    /// Keeps all measurements of another list, as closed ones.
    pub fn keep_closed(&mut self, other: Self) {
        let fresh = other.all.into_iter().chain(other.closed);
        let fresh: Vec<OpenMeasurement> = fresh.filter(|open| self.get(open.number).is_none()).collect();
        self.closed.extend(fresh);
    }

    fn place_of(&self, number: u64) -> Option<usize> {
        self.all.iter().position(|open| open.number == number)
    }

    /// The open measurement of that number.
    pub fn get(&self, number: u64) -> Option<&OpenMeasurement> {
        self.all.iter().find(|open| open.number == number)
    }

    pub fn get_mut(&mut self, number: u64) -> Option<&mut OpenMeasurement> {
        self.all.iter_mut().find(|open| open.number == number)
    }

    pub fn active(&self) -> &OpenMeasurement {
        &self.all[self.active]
    }

    pub fn active_mut(&mut self) -> &mut OpenMeasurement {
        &mut self.all[self.active]
    }

    /// The place of the active one.
    pub fn active_index(&self) -> usize {
        self.active
    }

    /// The measurements with rows: those that can be fitted.
    pub fn measured(&self) -> impl Iterator<Item = &OpenMeasurement> + Clone {
        self.all.iter().filter(|open| !open.measurement.rows.is_empty())
    }

    pub fn shared(&self) -> ParameterSet {
        self.shared
    }

    /// Shares those parameters; surfaces stay as they are.
    pub fn set_shared(&mut self, shared: ParameterSet) {
        self.shared = shared;
    }

    /// Shares those parameters. On all surfaces they are what they are on the active one, and so is the model, if any is shared. A
    /// shared k_s is free where any BRDF frees it, an own one where its measurement has one.
    pub fn share(&mut self, shared: ParameterSet) {
        let was_shared = self.shared.contains(Parameter::Ks);
        self.shared = shared;
        let is_free = |open: &OpenMeasurement| !open.surface.locked.contains(Parameter::Ks);
        if shared.contains(Parameter::Ks) && self.all.iter().any(is_free) {
            let active = self.active_mut();
            active.surface.locked = active.surface.locked.without(Parameter::Ks);
        } else if was_shared && !shared.contains(Parameter::Ks) {
            self.all.iter_mut().for_each(|open| open.surface.adapt_to(&open.measurement));
        }
        self.spread(self.active);
    }

    pub fn iter(&self) -> std::slice::Iter<'_, OpenMeasurement> {
        self.all.iter()
    }

    /// The measurements that are drawn: the active one and the others that are shown.
    pub fn shown(&self) -> impl Iterator<Item = &OpenMeasurement> {
        let active = self.active().number;
        self.all.iter().filter(move |open| open.style.shown || open.number == active)
    }

    /// Gives the active surface these values; a shared parameter moves on all surfaces.
    pub fn set_parameters(&mut self, parameters: Parameters) {
        self.set_parameters_of(self.active().number, parameters);
    }

    /// The same of the surface of the measurement of that number, if that is open.
    pub fn set_parameters_of(&mut self, number: u64, parameters: Parameters) {
        if let Some(index) = self.place_of(number) {
            self.all[index].surface.parameters = parameters;
            self.spread(index);
        }
    }

    /// The same, with a model.
    pub fn set_values_of(&mut self, number: u64, model: Model, parameters: Parameters) {
        if let Some(open) = self.get_mut(number) {
            open.surface.model = model;
        }
        self.set_parameters_of(number, parameters);
    }

    /// Gives the active measurement another model, and the others too, if anything is shared.
    pub fn set_model(&mut self, model: Model) {
        self.set_surface(Surface { model, ..self.active().surface.clone() });
    }

    /// Gives the active measurement another surface; what is shared changes on all surfaces.
    pub fn set_surface(&mut self, surface: Surface) {
        self.active_mut().surface = surface;
        self.spread(self.active);
    }

    /// Takes what is shared from one surface to all others: values, what fits may do with them, the model and the ties. What is tied follows.
    fn spread(&mut self, from: usize) {
        self.all[from].surface.follow_ties();
        if self.shared.is_empty() {
            return;
        }
        let surface = self.all[from].surface.clone();
        for open in &mut self.all {
            open.surface.model = surface.model;
            open.surface.ties.clone_from(&surface.ties);
            self.shared.iter().for_each(|parameter| open.surface.take(parameter, &surface));
            open.surface.follow_ties();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{MeasurementList, Model, OpenMeasurement, Parameter, ParameterSet, Parameters, Surface};
    use pbrdf::measurement::Measurement;

    #[test]
    fn a_shared_parameter_moves_on_all_surfaces_and_an_own_one_on_its_own() {
        let mut list = MeasurementList::several(vec![of("a"), of("b")], 1, ParameterSet::EMPTY.with(Parameter::Sigma));
        list.set_parameters(Parameters { n: 1.5, sigma: 0.25, ..Parameters::default() });
        let values: Vec<(f64, f64)> = list.iter().map(|open| (open.surface.parameters.n, open.surface.parameters.sigma)).collect();
        assert_eq!((list.active().name.as_str(), values), ("b", vec![(Parameters::default().n, 0.25), (1.5, 0.25)]));
    }

    #[test]
    fn what_fits_may_do_with_a_shared_parameter_is_shared_and_so_is_the_model() {
        let mut list = MeasurementList::several(vec![of("a"), of("b")], 1, ParameterSet::EMPTY);
        let mut surface = Surface { model: Model::SPECULAR, ..Surface::default() };
        surface.locked = surface.locked.with(Parameter::Sigma).with(Parameter::N);
        surface.set_bounds(Parameter::Sigma, 0.1, 0.9).expect("sound bounds");
        surface.set_bounds(Parameter::N, 0.5, 1.5).expect("sound bounds");
        list.set_surface(surface.clone());
        assert_eq!(list.iter().next().map(|open| &open.surface), Some(&Surface::default()), "nothing is shared");
        list.share(ParameterSet::EMPTY.with(Parameter::Sigma));
        let first = &list.iter().next().expect("the first").surface;
        let is_locked = |parameter| first.locked.contains(parameter);
        assert_eq!((first.model, is_locked(Parameter::Sigma), is_locked(Parameter::N)), (Model::SPECULAR, true, false));
        assert_eq!((first.bounds_of(Parameter::Sigma), first.has_own_bounds(Parameter::N)), ((0.1, 0.9), false));
        list.set_model(Model::CAUCHY);
        assert!(list.iter().all(|open| open.surface.model == Model::CAUCHY));
    }

    fn names(list: &MeasurementList) -> Vec<&str> {
        list.iter().map(|open| open.name.as_str()).collect()
    }

    fn of(name: &str) -> OpenMeasurement {
        OpenMeasurement::new(name.to_owned(), Measurement::default())
    }

    #[test]
    fn what_is_added_has_a_name_a_colour_and_a_marker_of_its_own() {
        let mut list = MeasurementList::single(of("a"));
        for name in ["b", "a", "a"] {
            list.add(of(name));
        }
        assert_eq!(names(&list), ["a", "b", "a (2)", "a (3)"]);
        let mut styles: Vec<_> = list.iter().map(|open| (open.style.color, open.style.marker as u8)).collect();
        styles.sort_unstable();
        styles.dedup();
        assert_eq!((styles.len(), list.active().name.as_str()), (4, "a (3)"));
    }

    #[test]
    fn the_first_measurement_takes_the_place_of_what_the_program_opened_by_itself() {
        let mut list = MeasurementList::single(OpenMeasurement::nothing());
        list.add(of("a"));
        list.add(of("b"));
        assert_eq!(names(&list), ["a", "b"]);
    }

    #[test]
    fn measurements_are_closed_moved_and_arranged_as_before() {
        let mut list = MeasurementList::several(["a", "b", "c"].map(of).to_vec(), 1, ParameterSet::EMPTY);
        let numbers: Vec<u64> = list.iter().map(|open| open.number).collect();
        list.move_by(numbers[1], -1);
        assert_eq!((names(&list), list.active().name.as_str()), (vec!["b", "a", "c"], "b"));
        list.move_by(numbers[1], -5);
        list.close(numbers[1]);
        assert_eq!((names(&list), list.active().name.as_str()), (vec!["a", "c"], "a"));
        list.close(numbers[2]);
        list.close(numbers[0]);
        assert_eq!((names(&list), list.has_rows()), (vec![""], false));
        list.arrange(&numbers, numbers[2]);
        assert_eq!((names(&list), list.active().name.as_str()), (vec!["a", "b", "c"], "c"));
        list.close(numbers[2]);
        list.forget_closed(|_| false);
        list.arrange(&numbers, numbers[2]);
        assert_eq!(names(&list), ["a", "b"], "what is forgotten stays closed");
    }

    #[test]
    fn there_is_always_an_active_measurement() {
        let list = MeasurementList::several(Vec::new(), 7, ParameterSet::EMPTY);
        assert_eq!((list.iter().len(), list.active().measurement.rows.len()), (1, 0));
    }
}
