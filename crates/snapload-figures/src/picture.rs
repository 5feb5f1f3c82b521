//! A finished picture, as SVG and as pixels.

use crate::error::FigureError;
use crate::text;
use resvg::{tiny_skia, usvg};

/// Pixels per point of a PNG with 300 dots per inch, which journals require for a line drawing in a
/// raster format.
pub const PNG_SCALE: f32 = 300.0 / 72.0;

/// The most pixels that a PNG may have.
const MOST_PIXELS: f64 = 1.0e8;

/// A finished picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Its name: the stem of a file's name.
    pub name: String,
    svg: String,
    size_pt: (f64, f64),
}

impl Picture {
    /// A picture from a document of this size in points.
    pub(crate) fn new(name: &str, svg: String, size_pt: (f64, f64)) -> Self {
        let name = name.to_string();
        Self { name, svg, size_pt }
    }

    /// The SVG document. Its size is in millimetres; its letters are text.
    pub fn svg(&self) -> &str {
        &self.svg
    }

    /// Width and height on paper, in points (1/72 inch).
    pub fn size_pt(&self) -> (f64, f64) {
        self.size_pt
    }

    /// The same picture as a PNG with `scale` pixels per point on paper (so 600 dots per inch are a
    /// scale of 600/72). The file contains its size on paper.
    ///
    /// # Errors
    ///
    /// [`FigureError::Scale`] if the scale is not positive or asks for more than 100 million
    /// pixels.
    pub fn png(&self, scale: f32) -> Result<Vec<u8>, FigureError> {
        let (width, height) = self.size_pt();
        let pixels = |points: f64| (points * f64::from(scale)).ceil();
        let (wide, high) = (pixels(width), pixels(height));
        if !(scale > 0.0 && wide * high <= MOST_PIXELS) {
            return Err(FigureError::Scale);
        }
        let mut pixmap =
            tiny_skia::Pixmap::new(wide as u32, high as u32).ok_or(FigureError::Scale)?;
        pixmap.fill(tiny_skia::Color::WHITE);
        let mut options = usvg::Options::default();
        options.fontdb_mut().load_font_data(text::UPRIGHT.to_vec());
        options.fontdb_mut().load_font_data(text::ITALIC.to_vec());
        let tree = usvg::Tree::from_str(&self.svg, &options)
            .map_err(|reason| FigureError::Raster(reason.to_string()))?;
        // The document's size is in millimetres, which the rasteriser counts in 1/96 inch.
        let per_unit = scale * (width as f32) / tree.size().width();
        let transform = tiny_skia::Transform::from_scale(per_unit, per_unit);
        resvg::render(&tree, transform, &mut pixmap.as_mut());
        encode(&pixmap, scale).map_err(|reason| FigureError::Raster(reason.to_string()))
    }
}

/// The pixels, all opaque, as a PNG without transparency.
fn encode(pixmap: &tiny_skia::Pixmap, scale: f32) -> Result<Vec<u8>, png::EncodingError> {
    let pixels = pixmap.pixels().iter();
    let rgb: Vec<u8> = pixels
        .flat_map(|p| [p.red(), p.green(), p.blue()])
        .collect();
    let per_metre = (f64::from(scale) * 72.0 / 0.0254).round() as u32;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixmap.width(), pixmap.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let (xppu, yppu, unit) = (per_metre, per_metre, png::Unit::Meter);
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu, yppu, unit }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
}
