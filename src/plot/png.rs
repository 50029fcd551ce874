//! From SVG to PNG, with an embedded typeface and nothing of the system's.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

use super::PlotError;

/// The pixels of an SVG text, `scale` times its own size.
pub(super) fn render(svg: &str, scale: f32) -> Result<Vec<u8>, PlotError> {
    let failed = |what: String| PlotError::Render(what);
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    // A character that the typeface lacks is taken from the other one.
    fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
    fonts.set_sans_serif_family("Ubuntu");
    let options =
        usvg::Options { font_family: "Ubuntu".into(), fontdb: Arc::new(fonts), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| failed(e.to_string()))?;
    let size = tree.size();
    let (width, height) = ((size.width() * scale).ceil() as u32, (size.height() * scale).ceil() as u32);
    let mut pixels =
        tiny_skia::Pixmap::new(width, height).ok_or_else(|| failed("the picture has no area".into()))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| failed(e.to_string()))
}
