//! Lines around things: silhouettes, and creases.
//!
//! Between two pixels side by side there is an edge where the object changes, the distance jumps or the
//! normal turns. Edges are joined across every square of four pixels, the corners of the lines that result are
//! moved towards their neighbours a few times, so that steps become slopes, and each pixel is covered by
//! how near it is to a line. All of it looks only as far as [`Lines::margin`], so a part of a picture has the
//! lines of the whole.

use std::collections::BTreeMap;

use crate::aov::Aov;
use crate::film::{Film, LayerKind};
use crate::math::wide::cos;
use crate::render::{Lines, SMOOTHINGS};

/// How much each pixel of a film is covered by lines, from 0 to 1; `None`: the film lacks what they are
/// drawn by.
pub(super) fn coverage(film: &Film, lines: &Lines) -> Option<Vec<f32>> {
    let layer = |aov| film.layer(LayerKind::Aov(aov)).map(|layer| &*layer.values);
    let seen = Seen {
        width: film.width() as usize,
        height: film.height() as usize,
        object: layer(Aov::Object)?,
        depth: layer(Aov::Depth)?,
        normal: layer(Aov::Normal)?,
        least_cos: if lines.crease < 180.0 {
            cos(f64::from(lines.crease).to_radians()) as f32
        } else {
            f32::NEG_INFINITY
        },
        lines,
    };
    let mut chains = Chains::default();
    chains.join(&seen);
    for _ in 0..SMOOTHINGS {
        chains.smooth();
    }
    Some(chains.cover(&seen))
}

/// What the pixels of a film show.
struct Seen<'a> {
    width: usize,
    height: usize,
    object: &'a [f32],
    depth: &'a [f32],
    normal: &'a [f32],
    /// The cosine below which normals differ.
    least_cos: f32,
    lines: &'a Lines,
}

impl Seen<'_> {
    /// Whether a line runs between a pixel and the one `step` pixels on; `before` and `beyond` are the
    /// pixels on either side of the two, if there are such.
    fn parts(&self, p: usize, step: usize, before: Option<usize>, beyond: Option<usize>) -> bool {
        let q = p + step;
        if self.object[p] != self.object[q] {
            return self.lines.objects;
        }
        if self.object[p] == 0.0 {
            return false;
        }
        let normal = |i: usize| [0, 1, 2].map(|axis| self.normal[3 * i + axis]);
        let (m, n) = (normal(p), normal(q));
        if m[0] * n[0] + m[1] * n[1] + m[2] * n[2] < self.least_cos {
            return true;
        }
        let jumps = |of: fn(f32) -> f32| {
            let at = |i: usize| of(self.depth[i]);
            let least = self.lines.depth * at(p).min(at(q));
            let jump = (at(q) - at(p)).abs();
            // A slope goes on as it came: then nothing jumps.
            let off = |from: Option<usize>, here: usize, there: usize| {
                let from = from.filter(|&from| self.object[from] == self.object[here]);
                from.map_or(jump, |from| (at(there) - (2.0 * at(here) - at(from))).abs())
            };
            jump > least && off(before, p, q).min(off(beyond, q, p)) > least
        };
        // Over a plane the distance is linear where rays are parallel; where they spread from a point, its
        // inverse is, but for how little they turn from one pixel to the next.
        self.lines.depth > 0.0 && jumps(|distance| distance) && jumps(|distance| 1.0 / distance)
    }
}

/// Lines as corners, by twice their place in pixels, and what they are joined to.
#[derive(Default)]
struct Chains {
    /// Of each corner its place.
    places: Vec<[f32; 2]>,
    joined: Vec<Vec<u32>>,
    segments: Vec<[u32; 2]>,
}

impl Chains {
    /// Joins the edges across every square of four pixels.
    fn join(&mut self, seen: &Seen<'_>) {
        let (width, height) = (seen.width, seen.height);
        let across: Vec<bool> = (0..width * height)
            .map(|p| {
                let x = p % width;
                x + 1 < width
                    && seen.parts(p, 1, (x > 0).then(|| p - 1), (x + 2 < width).then_some(p + 2))
            })
            .collect();
        let down: Vec<bool> = (0..width * height)
            .map(|p| {
                let y = p / width;
                let beyond = (y + 2 < height).then_some(p + 2 * width);
                y + 1 < height && seen.parts(p, width, (y > 0).then(|| p - width), beyond)
            })
            .collect();
        let mut numbers = BTreeMap::new();
        for y in 0..height.saturating_sub(1) {
            for x in 0..width.saturating_sub(1) {
                let p = y * width + x;
                // The middles between pixels, in halves: above, below, left and right.
                let all = [
                    (across[p], [2 * x + 1, 2 * y]),
                    (across[p + width], [2 * x + 1, 2 * y + 2]),
                    (down[p], [2 * x, 2 * y + 1]),
                    (down[p + 1], [2 * x + 2, 2 * y + 1]),
                ];
                let ends: Vec<[usize; 2]> =
                    all.into_iter().filter(|(is_there, _)| *is_there).map(|(_, at)| at).collect();
                match ends[..] {
                    [a, b] => self.segment(&mut numbers, a, b),
                    [] => {}
                    _ => {
                        let middle = [2 * x + 1, 2 * y + 1];
                        for end in ends {
                            self.segment(&mut numbers, end, middle);
                        }
                    }
                }
            }
        }
    }

    fn segment(&mut self, numbers: &mut BTreeMap<[usize; 2], u32>, a: [usize; 2], b: [usize; 2]) {
        let [a, b] = [a, b].map(|at| {
            *numbers.entry(at).or_insert_with(|| {
                self.places.push(at.map(|halves| 0.5 * halves as f32));
                self.joined.push(Vec::new());
                self.places.len() as u32 - 1
            })
        });
        self.segments.push([a, b]);
        self.joined[a as usize].push(b);
        self.joined[b as usize].push(a);
    }

    /// Moves each corner between two others half of the way to their middle.
    fn smooth(&mut self) {
        let before = self.places.clone();
        for (place, joined) in self.places.iter_mut().zip(&self.joined) {
            if let [a, b] = joined[..] {
                let (a, b) = (before[a as usize], before[b as usize]);
                *place = [0, 1].map(|axis| 0.5 * place[axis] + 0.25 * (a[axis] + b[axis]));
            }
        }
    }

    /// How much each pixel is covered.
    fn cover(&self, seen: &Seen<'_>) -> Vec<f32> {
        let mut covered = vec![0.0_f32; seen.width * seen.height];
        // A line thinner than a pixel is one of a pixel that covers less of it.
        let (half, most) = (0.5 * seen.lines.width.max(1.0), seen.lines.width.min(1.0));
        let reach = half + 0.5;
        for &[a, b] in &self.segments {
            let (a, b) = (self.places[a as usize], self.places[b as usize]);
            let range = |axis: usize, end: usize| {
                let low = (a[axis].min(b[axis]) - reach).ceil().max(0.0) as usize;
                let high = (a[axis].max(b[axis]) + reach).floor().max(0.0) as usize;
                low..(high + 1).min(end)
            };
            for y in range(1, seen.height) {
                for x in range(0, seen.width) {
                    let away = distance([x as f32, y as f32], a, b);
                    let share = most * (reach - away).clamp(0.0, 1.0);
                    let to = &mut covered[y * seen.width + x];
                    *to = to.max(share);
                }
            }
        }
        covered
    }
}

/// How far a point is from a segment.
fn distance(p: [f32; 2], a: [f32; 2], b: [f32; 2]) -> f32 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let from = [p[0] - a[0], p[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let t = if length > 0.0 {
        ((from[0] * along[0] + from[1] * along[1]) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let off = [from[0] - t * along[0], from[1] - t * along[1]];
    (off[0] * off[0] + off[1] * off[1]).sqrt()
}
