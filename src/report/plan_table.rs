//! A plan of angles: as an empty table to fill in, and in the order of least movement.

use pbrdf::measurement::Columns;
use std::io::{self, Write};

/// An empty measurement table of θi, θr and Δφ in degrees.
///
/// # Errors
///
/// The table cannot be written.
pub fn write_plan(out: &mut dyn Write, columns: Columns, angles: impl IntoIterator<Item = [f64; 3]>) -> io::Result<()> {
    let (header, empty) = match columns {
        Columns::Dolp => ("dolp", ","),
        Columns::Brdf => ("brdf", ","),
        Columns::Both => ("dolp,brdf", ",,"),
    };
    writeln!(out, "theta_i,theta_r,dphi,{header}")?;
    for [theta_i, theta_r, dphi] in angles {
        writeln!(out, "{theta_i},{theta_r},{dphi}{empty}")?;
    }
    Ok(())
}

/// Pairs of θi and θr in an order in which a goniometer moves little: θi once from its least to its greatest, θr to and fro.
#[must_use]
pub fn least_movement(pairs: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted = pairs.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut ordered: Vec<[f64; 2]> = Vec::with_capacity(sorted.len());
    for group in sorted.chunk_by(|a, b| a[0] == b[0]) {
        // From the end that is nearer to where the arm stands.
        let is_back = ordered.last().is_some_and(|last| (group[group.len() - 1][1] - last[1]).abs() < (group[0][1] - last[1]).abs());
        if is_back {
            ordered.extend(group.iter().rev());
        } else {
            ordered.extend(group);
        }
    }
    ordered
}

/// How far θi and θr move from the first pair to the last, in degrees.
#[must_use]
pub fn movement(pairs: &[[f64; 2]]) -> [f64; 2] {
    let of = |axis: usize| pairs.windows(2).map(|two| (two[1][axis] - two[0][axis]).abs()).sum();
    [of(0), of(1)]
}

#[cfg(test)]
mod tests {
    use super::{least_movement, movement, write_plan};
    use pbrdf::measurement::Columns;

    #[test]
    fn the_arm_goes_to_and_fro() {
        let pairs = [[40.0, 60.0], [20.0, 0.0], [20.0, 70.0], [40.0, 10.0], [60.0, 5.0], [20.0, 30.0]];
        let ordered = least_movement(&pairs);
        assert_eq!(ordered, [[20.0, 0.0], [20.0, 30.0], [20.0, 70.0], [40.0, 60.0], [40.0, 10.0], [60.0, 5.0]]);
        assert_eq!(movement(&ordered), [40.0, 135.0]);
        assert!(movement(&pairs)[1] > 200.0);
        assert_eq!(least_movement(&[]), Vec::<[f64; 2]>::new());
    }

    #[test]
    fn a_plan_is_an_empty_table_that_is_read_once_it_is_filled_in() {
        let mut table = Vec::new();
        write_plan(&mut table, Columns::Both, [[20.0, 30.0, 180.0]]).expect("memory");
        let text = String::from_utf8(table).expect("text");
        assert_eq!(text, "theta_i,theta_r,dphi,dolp,brdf\n20,30,180,,\n");
        assert!(pbrdf::Measurement::read(text.replace(",,", ",0.1,0.2").as_bytes()).is_ok());
    }
}
