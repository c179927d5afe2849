//! Furniture as pixels. The coverage of a pixel is computed without vector instructions, in the same
//! order on every machine.

use phong::film::Window;
use phong::finish::Patch;
use tiny_skia::{FillRule, LineCap, LineJoin, Pixmap, Transform};

use super::sheet::{Group, Paint, color_at, ink};
use crate::figures::mark::{Ink, Path, Point, Stroke};
use crate::figures::raster::{outline, solid};

/// The most pixels of one piece: a group that has more is painted in several.
const MOST_PIXELS: u64 = 1 << 26;

/// The pixels of a group within a picture of `size` pixels. They are those of the whole picture, whatever
/// part of it is drawn.
pub(super) fn patches(group: &Group, size: [u32; 2]) -> Vec<Patch> {
    let Some([low, high]) = group.bounds() else { return Vec::new() };
    let [width, height] = size.map(f64::from);
    let within = |v: f64, most: f64| v.clamp(0.0, most) as u32;
    let window = Window {
        x0: within(low.x.floor(), width),
        y0: within(low.y.floor(), height),
        x1: within(high.x.ceil() + 1.0, width),
        y1: within(high.y.ceil() + 1.0, height),
    };
    if !window.fits(size) {
        return Vec::new();
    }
    let rows = (MOST_PIXELS / u64::from(window.width())).max(1) as u32;
    let pieces = (window.y0..window.y1).step_by(rows as usize);
    let piece = |y0: u32| Window { y0, y1: y0.saturating_add(rows).min(window.y1), ..window };
    pieces.map(piece).filter_map(|window| patch(group, window)).collect()
}

fn patch(group: &Group, window: Window) -> Option<Patch> {
    let mut pixels = Pixmap::new(window.width(), window.height())?;
    let from = Point::new(f64::from(window.x0), f64::from(window.y0));
    if let Some((color, width)) = group.halo {
        for paint in &group.paints {
            let (path, more) = match paint {
                Paint::Fill(path, _) => (path.moved(-from), 0.0),
                Paint::Line(path, stroke) => (path.moved(-from), stroke.width),
                Paint::Ramp { .. } => continue,
            };
            stroke(&mut pixels, &path, Stroke::new(color, more + 2.0 * width));
        }
    }
    for paint in &group.paints {
        match paint.moved(-from) {
            Paint::Fill(path, ink) => fill(&mut pixels, &path, ink),
            Paint::Line(path, line) => stroke(&mut pixels, &path, line),
            Paint::Ramp { at, size, stops } => {
                let rows = size.y.max(1.0) as u32;
                for row in 0..rows {
                    let top = at.y + f64::from(row);
                    let corners = [(0.0, 0.0), (size.x, 0.0), (size.x, 1.0), (0.0, 1.0)];
                    let corners = corners.map(|(x, y)| Point::new(at.x + x, top + y));
                    let t = 1.0 - (f64::from(row) + 0.5) / f64::from(rows);
                    fill(&mut pixels, &Path::polygon(corners), ink(color_at(&stops, t as f32)));
                }
            }
        }
    }
    let bytes = pixels.take_demultiplied();
    let pixels = bytes.as_chunks::<4>().0.to_vec();
    Some(Patch { window, pixels, channels: [true; 3] })
}

fn fill(pixels: &mut Pixmap, path: &Path, ink: Ink) {
    if let Some(path) = outline(path) {
        pixels.fill_path(&path, &solid(ink), FillRule::Winding, Transform::identity(), None);
    }
}

fn stroke(pixels: &mut Pixmap, path: &Path, Stroke { ink, width, .. }: Stroke) {
    let stroke = tiny_skia::Stroke {
        width: width as f32,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        ..tiny_skia::Stroke::default()
    };
    if let Some(path) = outline(path) {
        pixels.stroke_path(&path, &solid(ink), &stroke, Transform::identity(), None);
    }
}
