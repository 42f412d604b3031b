//! Raster images: PNG from cells, and PNG drawn from SVG.

use super::FigureError;
use super::draw::colour::Rgb;
use super::glyphs::outlined;
use resvg::{tiny_skia, usvg};

/// Larger pictures are refused: this is already a poster.
const LARGEST_SIDE: f32 = 20_000.0;

/// PNG of `width × height` pixels, rows from the top; four channels if `alpha`, else three.
pub(super) fn encode(width: usize, height: usize, alpha: bool, data: &[u8]) -> Result<Vec<u8>, FigureError> {
    let fails = |reason: String| FigureError::Encode { reason };
    let side = |n: usize| u32::try_from(n).map_err(|e| fails(e.to_string()));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, side(width)?, side(height)?);
    encoder.set_color(if alpha { png::ColorType::Rgba } else { png::ColorType::Rgb });
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(|e| fails(e.to_string()))?;
    writer.write_image_data(data).map_err(|e| fails(e.to_string()))?;
    writer.finish().map_err(|e| fails(e.to_string()))?;
    Ok(bytes)
}

/// PNG of a map: a pixel for each cell, `colours` with the first axis fastest and the second upwards.
pub(super) fn cells(width: usize, height: usize, colours: &[Rgb]) -> Result<Vec<u8>, FigureError> {
    if width == 0 || height == 0 {
        return Err(FigureError::Empty { what: "a slice without cells" });
    }
    let data: Vec<u8> = colours.chunks_exact(width).rev().flatten().flatten().copied().collect();
    encode(width, height, false, &data)
}

/// Draws an SVG of this room.
pub(super) fn render(svg: &str, scale: f32) -> Result<Vec<u8>, FigureError> {
    let fails = |reason: String| FigureError::Encode { reason };
    let tree =
        usvg::Tree::from_str(&outlined(svg)?, &usvg::Options::default()).map_err(|e| fails(e.to_string()))?;
    let (width, height) = (tree.size().width() * scale, tree.size().height() * scale);
    if !(width <= LARGEST_SIDE && height <= LARGEST_SIDE) {
        return Err(fails(format!(
            "a picture of {width:.0} × {height:.0} pixels is too large; choose a smaller scale"
        )));
    }
    let mut pixels = tiny_skia::Pixmap::new(width.ceil() as u32, height.ceil() as u32)
        .ok_or_else(|| fails(format!("a picture of {width:.0} × {height:.0} pixels has no area")))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| fails(e.to_string()))
}
