//! Figures: what an SVG contains, read as XML, and what a PNG is when decoded.

use pbrdf_explorer::figure::{Axis, ColorMap, Dash, Figure, HeatMap, Panel, Point, Rgb, SERIES, Series, Symbol};
use roxmltree::{Document, Node};

fn panel(series: Vec<Series>) -> Panel {
    Panel { x: Axis::linear("θr", "°").between(0.0, 90.0), y: Axis::linear("DoLP", "").between(0.0, 1.0), series, ..Panel::default() }
}

fn svg_of(panel: Panel) -> String {
    Figure { title: "A figure".to_owned(), panels: vec![panel], ..Figure::default() }.svg()
}

/// Paths of that stroke or fill and, for lines, that width.
fn paths<'a>(document: &'a Document<'a>, color: &str, width: Option<&str>) -> Vec<Node<'a, 'a>> {
    let matches = |node: &Node<'_, '_>| {
        let is_colored = [node.attribute("stroke"), node.attribute("fill")].contains(&Some(color));
        node.has_tag_name("path") && is_colored && (width.is_none() || node.attribute("stroke-width") == width)
    };
    document.descendants().filter(matches).collect()
}

fn labels<'a>(document: &'a Document<'a>) -> Vec<&'a str> {
    document.descendants().filter(|node| node.has_tag_name("path")).filter_map(|node| node.attribute("aria-label")).collect()
}

fn color(index: usize) -> String {
    let c = SERIES[index];
    format!("#{:02x}{:02x}{:02x}", c.0, c.1, c.2)
}

/// Numbers of a path's data, in pairs.
fn points(data: &str) -> Vec<(f64, f64)> {
    let words: Vec<f64> = data.split(['M', 'L', ' ', 'Z']).filter_map(|word| word.parse().ok()).collect();
    words.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
}

#[test]
fn an_svg_is_well_formed_whatever_its_texts_are() {
    let hostile = "<script>\"&'\u{0}\u{1b}\u{ffff} 钢 ]]> --";
    let series = vec![Series::line(hostile, vec![[0.0, 0.0], [90.0, 1.0]]), Series::labels(vec![([10.0, 0.5], hostile.to_owned())])];
    let panel = Panel { title: hostile.to_owned(), x: Axis::linear(hostile, hostile), ..panel(series) };
    let svg = Figure { title: hostile.to_owned(), panels: vec![panel], ..Figure::default() }.svg();
    let document = Document::parse(&svg).unwrap();
    assert!(document.descendants().all(|node| !node.has_tag_name("script")));
    // What the font lacks is left to the viewer as text.
    assert!(document.descendants().any(|node| node.has_tag_name("text") && node.text().is_some_and(|text| text.contains('钢'))));
}

#[test]
fn axes_have_their_units_and_logarithmic_marks_their_powers() {
    let panel = Panel {
        x: Axis::log("time", "ns").between(1.0, 1e4),
        y: Axis::log("worst relative error", "").between(1e-16, 1.0),
        ..panel(vec![Series::points("batch", [[10.0, 1e-8]])])
    };
    let svg = svg_of(panel);
    let document = Document::parse(&svg).unwrap();
    let labels = labels(&document);
    for label in ["A figure", "time / ns", "worst relative error", "10⁰", "10¹", "10⁴", "10⁻¹⁰", "batch"] {
        assert!(labels.contains(&label), "{label} is missing among {labels:?}");
    }
}

#[test]
fn a_value_that_is_not_finite_splits_a_curve() {
    let points = vec![[0.0, 0.1], [10.0, 0.2], [20.0, f64::NAN], [30.0, 0.3], [40.0, f64::INFINITY], [50.0, 0.5], [60.0, 0.6]];
    let svg = svg_of(panel(vec![Series::line("curve", points)]));
    let document = Document::parse(&svg).unwrap();
    // The sample in the legend is one path, the curve another.
    let data: Vec<&str> = paths(&document, &color(0), Some("1.2")).iter().filter_map(|node| node.attribute("d")).collect();
    let curve = data.iter().max_by_key(|data| data.len()).unwrap();
    assert_eq!(curve.matches('M').count(), 2, "{curve}: a lone point between two gaps is no curve");
}

#[test]
fn a_logarithmic_axis_splits_a_curve_at_zero_and_below() {
    let curve = vec![[0.0, 1e-3], [10.0, 1e-2], [20.0, 0.0], [30.0, 1e-2], [40.0, 1e-1], [50.0, -1.0], [60.0, 1e-1], [70.0, 1.0]];
    let svg = svg_of(Panel { y: Axis::log("BRDF", "sr⁻¹"), ..panel(vec![Series::line("", curve)]) });
    let document = Document::parse(&svg).unwrap();
    assert_eq!(paths(&document, &color(0), Some("1.2"))[0].attribute("d").unwrap().matches('M').count(), 3);
}

#[test]
fn nothing_of_a_curve_leaves_the_frame() {
    let wild = (0..=900).map(|i| [f64::from(i) / 10.0, if i % 3 == 0 { 1e300 } else { -1e300 }]).collect();
    let steep = vec![[-1e9, -5.0], [45.0, 0.5], [1e9, 7.0]];
    let band = vec![[-10.0, -3.0, 0.2], [50.0, 0.1, 9.0], [100.0, 0.0, 0.5]];
    let series = vec![Series::line("", wild), Series::line("", steep), Series::band("", band)];
    let svg = svg_of(Panel { legend: false, ..panel(series) });
    let document = Document::parse(&svg).unwrap();
    let frame = points(paths(&document, &color(2), None)[0].attribute("d").unwrap());
    // The band fills the panel from left to right and from foot to top somewhere: its extremes are the frame.
    let (left, right) = frame.iter().fold((f64::MAX, f64::MIN), |(low, high), (x, _)| (low.min(*x), high.max(*x)));
    let (top, foot) = frame.iter().fold((f64::MAX, f64::MIN), |(low, high), (_, y)| (low.min(*y), high.max(*y)));
    for index in [0, 1] {
        let found = points(paths(&document, &color(index), None)[0].attribute("d").unwrap());
        assert!(found.len() >= 2);
        // Two decimals are written.
        let slack = 0.011;
        for (x, y) in found {
            assert!((left - slack..=right + slack).contains(&x) && (top - slack..=foot + slack).contains(&y), "{x} {y}");
        }
    }
}

#[test]
fn a_curve_keeps_its_shape() {
    let svg = svg_of(Panel { legend: false, ..panel(vec![Series::line("", vec![[0.0, 0.0], [45.0, 1.0], [90.0, 0.0]])]) });
    let document = Document::parse(&svg).unwrap();
    let found = points(paths(&document, &color(0), None)[0].attribute("d").unwrap());
    assert_eq!(found.len(), 3, "{found:?}");
    assert!((found[1].0 - 0.5 * (found[0].0 + found[2].0)).abs() < 0.011);
    assert!(found[1].1 < found[0].1 && found[0].1 == found[2].1, "up is towards smaller y: {found:?}");
}

#[test]
fn dense_curves_are_thinned_without_losing_length() {
    // A hundred thousand steps of a thousandth of a point each.
    let dense: Vec<[f64; 2]> = (0..=100_000).map(|i| [f64::from(i) * 9e-4, f64::from(i) * 1e-5]).collect();
    let svg = svg_of(Panel { legend: false, ..panel(vec![Series::line("", dense)]) });
    let document = Document::parse(&svg).unwrap();
    let found = points(paths(&document, &color(0), None)[0].attribute("d").unwrap());
    let whole = svg_of(Panel { legend: false, ..panel(vec![Series::line("", vec![[0.0, 0.0], [90.0, 1.0]])]) });
    let ends = points(paths(&Document::parse(&whole).unwrap(), &color(0), None)[0].attribute("d").unwrap());
    // Half of a hundredth of a point is the rounding; what is thinned is at most 0.02 points.
    assert!((found[found.len() - 1].0 - ends[1].0).abs() < 0.03, "{:?} {:?}", found.last(), ends);
    assert!(found.len() < 30_000);
}

#[test]
fn series_of_one_name_share_a_colour_and_an_entry() {
    let measured = vec![Point { x: 30.0, y: 0.5, bar: Some((0.4, 0.6)) }, Point { x: 40.0, y: f64::NAN, bar: None }];
    let series = vec![
        Series::line("θi = 30°", vec![[0.0, 0.1], [90.0, 0.9]]),
        Series::dashed("Fresnel limit", vec![[0.0, 0.2], [90.0, 1.0]], Dash::Dashed),
        Series::measured("θi = 30°", measured, Symbol::Disc),
    ];
    let svg = svg_of(panel(series));
    let document = Document::parse(&svg).unwrap();
    assert_eq!(labels(&document).iter().filter(|label| **label == "θi = 30°").count(), 1);
    assert!(paths(&document, &color(1), Some("0.9")).iter().all(|node| node.attribute("stroke-dasharray").is_some()));
    assert!(paths(&document, &color(2), None).is_empty(), "points of a named curve have the curve's colour");
    // One disc in the panel, one in the legend: the NaN has none.
    let discs: usize = paths(&document, &color(0), None)
        .iter()
        .filter(|node| node.attribute("stroke").is_none())
        .map(|node| node.attribute("d").unwrap().matches('M').count())
        .sum();
    assert_eq!(discs, 2);
}

#[test]
fn a_name_for_curves_of_several_colours_has_a_neutral_sample() {
    let limit = |y: f64, color: Rgb| Series::dashed("Fresnel limit", vec![[0.0, y], [90.0, y]], Dash::Dotted).colored(color);
    let svg = svg_of(panel(vec![limit(0.2, SERIES[3]), limit(0.4, SERIES[4])]));
    let document = Document::parse(&svg).unwrap();
    let dotted = |color: &str| paths(&document, color, Some("0.9")).len();
    assert_eq!((dotted(&color(3)), dotted(&color(4)), dotted("#141414")), (1, 1, 1));
}

#[test]
fn a_heat_map_has_a_bar_with_a_unit_and_leaves_missing_cells_blank() {
    let map = HeatMap {
        x_edges: vec![0.0, 1.0, 2.0],
        y_edges: vec![0.0, 1.0, 2.0],
        values: vec![0.0, 1.0, f64::NAN],
        color_axis: Axis::linear("BRDF", "sr⁻¹"),
        colors: ColorMap::Sequential,
    };
    let svg = svg_of(Panel { x: Axis::linear("x", "m"), y: Axis::linear("y", "m"), ..panel(vec![Series::heat_map(map)]) });
    let document = Document::parse(&svg).unwrap();
    assert!(labels(&document).contains(&"BRDF / sr⁻¹"));
    let cells = |color: &str| paths(&document, color, None).len();
    assert_eq!(
        (cells("#440154"), cells("#fde725")),
        (1, 1),
        "the ends of the map, in the panel only: the bar has the middles of its bands"
    );
}

#[test]
fn degenerate_figures_are_drawn_all_the_same() {
    let nothing = Figure::default();
    Document::parse(&nothing.svg()).unwrap();
    let empty = Figure { panels: vec![Panel::default(); 3], columns: 0, width_mm: f64::NAN, height_mm: -1.0, ..Figure::default() };
    Document::parse(&empty.svg()).unwrap();
    let constant = Series::line("", vec![[1.0, 5e-324], [1.0, 5e-324]]);
    let huge = Series::points("", [[f64::MAX, f64::MIN], [f64::MIN, f64::MAX], [0.0, 1.0]]);
    let map =
        HeatMap { x_edges: vec![0.0], y_edges: Vec::new(), values: vec![1.0; 7], color_axis: Axis::log("", ""), colors: ColorMap::Cyclic };
    for series in [constant, huge, Series::heat_map(map), Series::band("", vec![[0.0, 1.0, 2.0]]), Series::steps("", Vec::new())] {
        for (x, y) in [(Axis::linear("x", "m"), Axis::log("y", "m")), (Axis::log("x", ""), Axis::linear("y", "").between(3.0, -3.0))] {
            Document::parse(&svg_of(Panel { x, y, series: vec![series.clone()], ..Panel::default() })).unwrap();
        }
    }
}

#[test]
fn the_same_figure_has_the_same_bytes() {
    let figure = || Figure { panels: vec![panel(vec![Series::line("a", vec![[0.0, 0.1], [90.0, 0.9]])])], ..Figure::default() };
    assert_eq!(figure().svg(), figure().svg());
}

#[cfg(feature = "figures")]
mod as_png {
    use super::{panel, svg_of};
    use pbrdf_explorer::figure::{Figure, Panel, Series};

    #[test]
    fn a_png_has_the_size_and_resolution_that_were_asked_for() {
        let curve = Series::line("curve", vec![[0.0, 0.1], [90.0, 0.9]]);
        let figure = Figure { panels: vec![panel(vec![curve])], width_mm: 50.8, height_mm: 25.4, ..Figure::default() };
        let bytes = figure.png(300.0).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        assert_eq!(reader.info().size(), (600, 300));
        // 300 dots an inch are 11811 a metre.
        assert_eq!(reader.info().pixel_dims.unwrap().xppu, 11_811);
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let white = pixels.chunks_exact(4).filter(|pixel| *pixel == [255; 4]).count();
        assert!(white > 90_000 && white < 178_000, "mostly paper, some ink: {white}");
        assert!(pixels.chunks_exact(4).all(|pixel| pixel[3] == 255), "a page is opaque");
        assert_eq!(bytes, figure.png(300.0).unwrap());
    }

    #[test]
    fn impossible_resolutions_are_refused_in_words() {
        for dpi in [0.0, -3.0, f64::NAN, f64::INFINITY, 1e9] {
            assert!(Figure::default().png(dpi).unwrap_err().to_string().contains("too large or too small"));
        }
    }

    #[test]
    fn cells_of_a_map_leave_no_gap() {
        use pbrdf_explorer::figure::{Axis, ColorMap, HeatMap};
        let edges: Vec<f64> = (0..=37).map(f64::from).collect();
        let map = HeatMap {
            x_edges: edges.clone(),
            y_edges: edges,
            values: (0..37 * 37).map(|i| f64::from(i % 5)).collect(),
            color_axis: Axis::linear("z", ""),
            colors: ColorMap::Sequential,
        };
        let figure = Figure { panels: vec![Panel { series: vec![Series::heat_map(map)], ..Panel::default() }], ..Figure::default() };
        let image = figure.image(150.0).unwrap();
        let row = |y: u32| &image.rgba[(4 * y * image.width) as usize..][..4 * image.width as usize];
        // Across the middle of the page, between the first and the last cell, nothing is white.
        let middle: Vec<&[u8]> = row(image.height / 2).chunks_exact(4).collect();
        let is_map = |pixel: &&[u8]| pixel[0] != pixel[1] || pixel[1] != pixel[2];
        let first = middle.iter().position(is_map).unwrap();
        let width = middle.iter().rposition(is_map).unwrap() - first;
        let white = middle[first..first + width * 8 / 10].iter().filter(|pixel| **pixel == [255; 4]).count();
        assert_eq!(white, 0);
        let column = first + width / 3;
        let upright: Vec<bool> = (0..image.height).map(|y| is_map(&&row(y)[4 * column..4 * column + 4])).collect();
        let (top, foot) = (upright.iter().position(|map| *map).unwrap(), upright.iter().rposition(|map| *map).unwrap());
        assert!(upright[top..foot].iter().all(|map| *map));
    }

    #[test]
    fn letters_that_the_font_lacks_are_boxes() {
        let with = |title: &str| Figure { title: title.to_owned(), ..Figure::default() }.image(72.0).unwrap();
        assert_ne!(with("钢"), with(" "));
        assert!(svg_of(panel(Vec::new())).contains("</svg>"));
    }
}

#[test]
fn a_sheet_has_its_figures_in_a_grid() {
    let of = |title: &str| Figure {
        title: title.to_owned(),
        panels: vec![panel(vec![Series::line("model", vec![[0.0, 0.2], [90.0, 0.4]])])],
        ..Figure::default()
    };
    let sheet = Figure::sheet("", vec![of("one"), of("two"), of("three")], 2);
    let svg = sheet.svg();
    let document = Document::parse(&svg).unwrap();
    let page = document.root_element();
    let side = |name: &str| page.attribute(name).and_then(|mm| mm.strip_suffix("mm")).and_then(|mm| mm.parse::<f64>().ok()).unwrap();
    // Lengths have two decimals.
    assert!((side("width") - sheet.width_mm).abs() < 0.01 && (side("height") - sheet.height_mm).abs() < 0.01);
    let places: Vec<(f64, f64)> = document
        .descendants()
        .filter(|node| node.has_tag_name("g"))
        .map(|group| {
            let inside = group.attribute("transform").unwrap().trim_start_matches("translate(").trim_end_matches(')');
            let (x, y) = inside.split_once(' ').unwrap();
            (x.parse().unwrap(), y.parse().unwrap())
        })
        .collect();
    // Two beside each other, the third below the first.
    assert_eq!((places.len(), places[0], places[1].1, places[2].0), (3, (0.0, 0.0), 0.0, 0.0));
    assert!(places[1].0 > 0.0 && places[2].1 > 0.0);
    let labels = labels(&document);
    assert!(["one", "two", "three"].iter().all(|title| labels.contains(title)), "{labels:?}");
    // One figure alone is no sheet.
    assert_eq!(Figure::sheet("", vec![of("one")], 2), of("one"));
}
