//! A figure as PNG: the same SVG, rendered by `resvg`.

use crate::figure::Figure;
use crate::figure::canvas::Missing;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

/// Why there is no PNG.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// More pixels than an image may have, or none.
    #[error("an image of {width_mm} mm × {height_mm} mm at {dpi} dots per inch is too large or too small")]
    Size {
        /// Width of the figure.
        width_mm: f64,
        /// Height of the figure.
        height_mm: f64,
        /// Dots per inch.
        dpi: f64,
    },
    /// The drawing was not understood by the renderer.
    #[error("the drawing cannot be rendered: {0}")]
    Drawing(#[from] resvg::usvg::Error),
    /// The image was not encoded.
    #[error("the image cannot be encoded: {0}")]
    Encoding(#[from] png::EncodingError),
}

/// Most pixels of an image.
const MOST_PIXELS: f64 = 1e8;
/// Inches per metre, for the resolution in the file.
const INCHES_PER_METRE: f64 = 1.0 / 0.0254;

/// An image: red, green, blue and opacity, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Pixels side by side.
    pub width: u32,
    /// Rows of pixels.
    pub height: u32,
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
}

impl Figure {
    /// The figure as pixels at `dpi` dots per inch (300 for print).
    ///
    /// # Errors
    ///
    /// [`PngError`] where `dpi` and the size give no image of 1 to 10⁸ pixels, or the renderer fails.
    pub fn image(&self, dpi: f64) -> Result<Image, PngError> {
        rendered(&self.drawn(Missing::Boxes), self.width_mm, self.height_mm, dpi)
    }

    /// The figure as the bytes of a PNG file at `dpi` dots per inch (300 for print), which the file
    /// states.
    ///
    /// # Errors
    ///
    /// [`PngError`] where `dpi` and the size give no image of 1 to 10⁸ pixels, or renderer or
    /// encoder fail.
    pub fn png(&self, dpi: f64) -> Result<Vec<u8>, PngError> {
        self.image(dpi)?.png(dpi)
    }
}

/// A drawing of that size in millimetres as pixels.
pub fn rendered(drawing: &str, width_mm: f64, height_mm: f64, dpi: f64) -> Result<Image, PngError> {
    let tree = Tree::from_str(drawing, &Options::default())?;
    let wrong = || PngError::Size { width_mm, height_mm, dpi };
    let pixels = |mm: f64| (mm / 25.4 * dpi).round();
    let (width, height) = (pixels(width_mm), pixels(height_mm));
    if !(dpi > 0.0 && width >= 1.0 && height >= 1.0 && width * height <= MOST_PIXELS) {
        return Err(wrong());
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most MOST_PIXELS")]
    let mut pixmap = Pixmap::new(width as u32, height as u32).ok_or_else(wrong)?;
    let size = tree.size();
    #[expect(clippy::cast_possible_truncation, reason = "a scale for a renderer of f32")]
    let scale = Transform::from_scale((width / f64::from(size.width())) as f32, (height / f64::from(size.height())) as f32);
    resvg::render(&tree, scale, &mut pixmap.as_mut());
    // The page is white and opaque, so that premultiplied and plain colours are the same.
    Ok(Image { width: pixmap.width(), height: pixmap.height(), rgba: pixmap.take() })
}

/// A square drawing as so many pixels along an edge; colours are not multiplied by their opacity.
///
/// # Errors
///
/// [`PngError`] where the drawing is not understood, or has no pixels.
pub fn icon(drawing: &str, pixels: u32) -> Result<Image, PngError> {
    let tree = Tree::from_str(drawing, &Options::default())?;
    let mm = f64::from(pixels);
    let mut pixmap = Pixmap::new(pixels, pixels).ok_or(PngError::Size { width_mm: mm, height_mm: mm, dpi: 25.4 })?;
    #[expect(clippy::cast_precision_loss, reason = "a scale for a renderer of f32")]
    let edge = pixels as f32;
    let scale = Transform::from_scale(edge / tree.size().width(), edge / tree.size().height());
    resvg::render(&tree, scale, &mut pixmap.as_mut());
    Ok(Image { width: pixels, height: pixels, rgba: pixmap.take_demultiplied() })
}

impl Image {
    /// The bytes of a PNG file that states that resolution in dots per inch.
    ///
    /// # Errors
    ///
    /// [`PngError`] where the encoder fails.
    pub fn png(&self, dpi: f64) -> Result<Vec<u8>, PngError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgba);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a resolution; casts saturate")]
        let per_metre = (dpi * INCHES_PER_METRE).round() as u32;
        encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit: png::Unit::Meter }));
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgba)?;
        writer.finish()?;
        Ok(bytes)
    }
}
