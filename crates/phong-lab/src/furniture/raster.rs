//! Furniture as pixels.

use phong::film::Window;
use phong::finish::Patch;
use phong::scene::Rgb;
use tiny_skia::{Pixmap, Transform};

use super::sheet::{Group, Paint, ink};
use crate::draw::{self, Path, Point, Stroke};

/// The most pixels of one piece: what has more is painted in several.
const MOST_PIXELS: u64 = 1 << 26;

/// How many pixels the pieces of groups that are painted each for itself may have together, for each of the
/// picture's. Furniture of any size and number would otherwise take any memory.
const MOST_LAYERS: u64 = 2;

/// The pixels of groups within a picture of `size` pixels, to be painted one over the other. They are those of
/// the whole picture, whatever part of it is drawn.
///
/// A group is a piece of its own. Where groups lie over one another so often that these would have more than
/// twice as many pixels as the picture, the rest of them are one piece.
pub(super) fn patches(groups: &[Group], size: [u32; 2]) -> Vec<Patch> {
    let most = MOST_LAYERS.saturating_mul(u64::from(size[0]) * u64::from(size[1]));
    let mut left = most;
    let windows: Vec<Option<Window>> = groups.iter().map(|group| window(group, size)).collect();
    let alone = windows.iter().map_while(|window| {
        left = left.checked_sub(window.map_or(0, |window| window.pixels()))?;
        Some(())
    });
    let alone = alone.count();
    let each = windows[..alone].iter().enumerate().filter_map(|(i, window)| Some((i, (*window)?)));
    let each = each.flat_map(|(i, window)| pieces(&groups[i..=i], window));
    let rest = windows[alone..].iter().flatten().copied().reduce(|a, b| Window {
        x0: a.x0.min(b.x0),
        y0: a.y0.min(b.y0),
        x1: a.x1.max(b.x1),
        y1: a.y1.max(b.y1),
    });
    let rest = rest.into_iter().flat_map(|window| pieces(&groups[alone..], window));
    each.chain(rest).collect()
}

/// Where a group lies in the picture; `None`: nowhere.
fn window(group: &Group, size: [u32; 2]) -> Option<Window> {
    let [low, high] = group.bounds()?;
    let [width, height] = size.map(f64::from);
    let within = |v: f64, most: f64| v.clamp(0.0, most) as u32;
    let window = Window {
        x0: within(low.x.floor(), width),
        y0: within(low.y.floor(), height),
        x1: within(high.x.ceil() + 1.0, width),
        y1: within(high.y.ceil() + 1.0, height),
    };
    window.fits(size).then_some(window)
}

/// Groups painted one over the other.
fn pieces(groups: &[Group], window: Window) -> impl Iterator<Item = Patch> {
    let rows = (MOST_PIXELS / u64::from(window.width())).max(1) as u32;
    let pieces = (window.y0..window.y1).step_by(rows as usize);
    pieces.filter_map(move |y0| {
        patch(groups, Window { y0, y1: y0.saturating_add(rows).min(window.y1), ..window })
    })
}

fn patch(groups: &[Group], window: Window) -> Option<Patch> {
    let mut pixels = Pixmap::new(window.width(), window.height())?;
    let from = Point::new(f64::from(window.x0), f64::from(window.y0));
    for group in groups {
        paint(&mut pixels, group, from);
    }
    let bytes = pixels.take_demultiplied();
    let pixels = bytes.as_chunks::<4>().0.to_vec();
    Some(Patch { window, pixels, channels: [true; 3] })
}

/// Paints a group onto a piece whose corner is at `from`.
fn paint(pixels: &mut Pixmap, group: &Group, from: Point) {
    let still = Transform::identity();
    if let Some((color, width)) = group.halo {
        for paint in &group.paints {
            let (path, more) = match paint {
                Paint::Fill(path, _) => (path.moved(-from), 0.0),
                Paint::Line(path, stroke) => (path.moved(-from), stroke.width),
                Paint::Ramp { .. } => continue,
            };
            let stroke = Stroke::new(color, more + 2.0 * width);
            draw::stroke(pixels, &path, stroke, still);
        }
    }
    for paint in &group.paints {
        match paint.moved(-from) {
            Paint::Fill(path, ink) => draw::fill(pixels, &path, ink, still),
            Paint::Line(path, line) => draw::stroke(pixels, &path, line, still),
            Paint::Ramp { at, size, stops } => {
                let rows = size.y.max(1.0) as u32;
                for row in 0..rows {
                    let top = at.y + f64::from(row);
                    let corners = [(0.0, 0.0), (size.x, 0.0), (size.x, 1.0), (0.0, 1.0)];
                    let corners = corners.map(|(x, y)| Point::new(at.x + x, top + y));
                    let t = 1.0 - (f64::from(row) + 0.5) / f64::from(rows);
                    let color = ink(Rgb::of_stops(&stops, t as f32));
                    draw::fill(pixels, &Path::polygon(corners), color, still);
                }
            }
        }
    }
}
