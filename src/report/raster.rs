//! SVG to PNG, with the font that comes with the program, so that every machine draws the same.

use super::ReportError;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

/// Pixels per point: sharp on screens of today and in print at half width.
const PIXELS: f32 = 2.0;
/// Family name inside the bundled font.
const FAMILY: &str = "Ubuntu";

/// Draws an SVG document as PNG bytes.
///
/// # Errors
/// [`ReportError::Drawing`] if it is not SVG, or too large to hold in memory.
pub fn png(svg: &str) -> Result<Vec<u8>, ReportError> {
    let failed = |error: &dyn std::fmt::Display| ReportError::Drawing(error.to_string());
    let mut options = Options { font_family: FAMILY.into(), ..Options::default() };
    options.fontdb_mut().load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    options.fontdb_mut().set_sans_serif_family(FAMILY);
    let tree = Tree::from_str(svg, &options).map_err(|error| failed(&error))?;
    let (width, height) = (tree.size().width() * PIXELS, tree.size().height() * PIXELS);
    let mut pixmap = Pixmap::new(width.ceil() as u32, height.ceil() as u32)
        .ok_or_else(|| failed(&format!("a figure of {width} by {height} pixels")))?;
    resvg::render(&tree, Transform::from_scale(PIXELS, PIXELS), &mut pixmap.as_mut());
    pixmap.encode_png().map_err(|error| failed(&error))
}
