//! Outlines as pixels. What an outline covers of each is computed without vector instructions, in the same
//! order on every machine.

use tiny_skia::{FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, StrokeDash, Transform};

use super::{DASH, Ink, Path, Point, Step, Stroke};

/// Fills an outline.
pub(crate) fn fill(pixels: &mut Pixmap, path: &Path, ink: Ink, transform: Transform) {
    if let Some(path) = outline(path) {
        pixels.fill_path(&path, &solid(ink), FillRule::Winding, transform, None);
    }
}

/// Draws a line along an outline, with round ends and corners.
pub(crate) fn stroke(pixels: &mut Pixmap, path: &Path, stroke: Stroke, transform: Transform) {
    let Stroke { ink, width, dashed } = stroke;
    let dash = dashed.then(|| DASH.map(|side| side as f32).to_vec());
    let stroke = tiny_skia::Stroke {
        width: width as f32,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        dash: dash.and_then(|dash| StrokeDash::new(dash, 0.0)),
        ..tiny_skia::Stroke::default()
    };
    if let Some(path) = outline(path) {
        pixels.stroke_path(&path, &solid(ink), &stroke, transform, None);
    }
}

fn outline(path: &Path) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    let xy = |p: Point| (p.x as f32, p.y as f32);
    for step in &path.0 {
        match *step {
            Step::Move(p) => {
                let (x, y) = xy(p);
                builder.move_to(x, y);
            }
            Step::Line(p) => {
                let (x, y) = xy(p);
                builder.line_to(x, y);
            }
            Step::Quad(c, p) => {
                let ((x1, y1), (x, y)) = (xy(c), xy(p));
                builder.quad_to(x1, y1, x, y);
            }
            Step::Cubic(c, d, p) => {
                let ((x1, y1), (x2, y2), (x, y)) = (xy(c), xy(d), xy(p));
                builder.cubic_to(x1, y1, x2, y2, x, y);
            }
            Step::Close => builder.close(),
        }
    }
    builder.finish()
}

/// Ink as the painter has it.
pub(crate) fn color(Ink { srgb: [r, g, b], opacity }: Ink) -> tiny_skia::Color {
    tiny_skia::Color::from_rgba8(r, g, b, (opacity * 255.0 + 0.5) as u8)
}

fn solid(ink: Ink) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(color(ink));
    paint
}
