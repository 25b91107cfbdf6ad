//! SVG text: paths and outlined words on a white page.

use crate::figure::Rgb;
use crate::figure::text::{Font, short};
use std::fmt::Write as _;

/// Ink of frames, marks and words.
pub const INK: Rgb = Rgb(20, 20, 20);
/// Ink of grids.
pub const FAINT: Rgb = Rgb(222, 222, 222);

/// How a path is painted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paint {
    /// Filled, with an opacity from 0 to 1.
    Fill(Rgb, f64),
    /// Filled without anti-aliasing, so that adjacent cells leave no gap.
    Cells(Rgb),
    /// Mark as a line of that width, with the lengths of dash and gap.
    Stroke(Rgb, f64, Option<(f64, f64)>),
}

/// Which point of a text its position is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// The beginning of its baseline.
    Start,
    /// The middle of its baseline.
    Middle,
    /// The end of its baseline.
    End,
}

/// Rendering of characters that the fonts lack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    /// The fonts of the viewer draw the text.
    LeftToViewer,
    /// Empty boxes.
    #[cfg(feature = "figures")]
    Boxes,
}

/// A page under construction.
pub struct Canvas<'a> {
    pub font: &'a Font,
    missing: Missing,
    out: String,
}

/// Text that XML may hold: `&<>"` escaped, characters that XML forbids replaced.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(' '),
            control if control.is_control() || matches!(control, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            letter => out.push(letter),
        }
    }
    out
}

fn hex(Rgb(r, g, b): Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Millimetres in points.
pub const POINTS_PER_MM: f64 = 72.0 / 25.4;

impl<'a> Canvas<'a> {
    /// A white page of that size in millimetres.
    pub fn new(font: &'a Font, missing: Missing, width_mm: f64, height_mm: f64, title: &str) -> Self {
        let (width, height) = (width_mm * POINTS_PER_MM, height_mm * POINTS_PER_MM);
        let name = escape(title);
        let out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{name}\">\n\
             <title>{name}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
            short(width_mm),
            short(height_mm),
            short(width),
            short(height),
        );
        Self { font, missing, out }
    }

    /// What follows, moved by so many points, until [`Self::end_group`].
    pub fn begin_group(&mut self, right: f64, down: f64) {
        self.write(format_args!("<g transform=\"translate({} {})\">\n", short(right), short(down)));
    }

    /// Ends what [`Self::begin_group`] began.
    pub fn end_group(&mut self) {
        self.write(format_args!("</g>\n"));
    }

    /// A path of that data, if there is any.
    pub fn path(&mut self, data: &str, paint: Paint) {
        if data.is_empty() {
            return;
        }
        let style = match paint {
            Paint::Fill(color, opacity) if opacity < 1.0 => format!("fill=\"{}\" fill-opacity=\"{}\"", hex(color), short(opacity)),
            Paint::Fill(color, _) => format!("fill=\"{}\"", hex(color)),
            Paint::Cells(color) => format!("fill=\"{}\" shape-rendering=\"crispEdges\"", hex(color)),
            Paint::Stroke(color, width, dash) => {
                let dash = dash.map_or_else(String::new, |(on, off)| format!(" stroke-dasharray=\"{} {}\"", short(on), short(off)));
                format!("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{dash}", hex(color), short(width))
            }
        };
        self.write(format_args!("<path d=\"{data}\" {style}/>\n"));
    }

    /// Words on one line; `upwards` turns them a quarter to the left about their position.
    pub fn text(&mut self, text: &str, size: f64, (x, y): (f64, f64), anchor: Anchor, upwards: bool, color: Rgb) {
        if text.is_empty() {
            return;
        }
        let turn = if upwards { format!(" transform=\"rotate(-90 {} {})\"", short(x), short(y)) } else { String::new() };
        let words = escape(text);
        let fill = hex(color);
        if self.missing == Missing::LeftToViewer && !self.font.covers(text) {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            self.write(format_args!(
                "<text x=\"{}\" y=\"{}\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{fill}\"{turn}>{words}</text>\n",
                short(x),
                short(y),
                short(size),
            ));
            return;
        }
        let width = self.font.width(text, size);
        let start = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - 0.5 * width,
            Anchor::End => x - width,
        };
        let data = self.font.outline(text, size, start, y);
        self.write(format_args!("<path aria-label=\"{words}\" d=\"{data}\" fill=\"{fill}\"{turn}/>\n"));
    }

    /// The finished page.
    pub fn finish(mut self) -> String {
        self.out.push_str("</svg>\n");
        self.out
    }

    fn write(&mut self, text: std::fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        let _ = self.out.write_fmt(text);
    }
}

/// Path data through points.
pub fn polyline(points: &[(f64, f64)]) -> String {
    let mut data = String::new();
    for (i, (x, y)) in points.iter().enumerate() {
        let letter = if i == 0 { 'M' } else { 'L' };
        // Writing to a string does not fail.
        let _ = write!(data, "{letter}{} {}", short(*x), short(*y));
    }
    data
}

/// Path data of a rectangle. Adjacent rectangles have the same digits at their common edge.
pub fn rectangle(left: f64, top: f64, width: f64, height: f64) -> String {
    let (x, y) = (short(left), short(top));
    format!("M{x} {y}H{}V{}H{x}Z", short(left + width), short(top + height))
}

/// Path data of a circle.
pub fn circle(x: f64, y: f64, radius: f64) -> String {
    let r = short(radius);
    format!("M{} {}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 {} 0Z", short(x - radius), short(y), short(2.0 * radius), short(-2.0 * radius))
}
