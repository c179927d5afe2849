//! Pictures, pixel by pixel.

use phong::image::{Picture, Transfer};
use phong_scene::srgb_encode;
use rayon::prelude::*;

use super::points::{Point, Surface};

/// Where pixels are put.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    UpsideDown,
    LeftRight,
    Turned,
    BlueFirst,
    /// By so many pixels to the right, and down.
    Shifted(i32, i32),
}

/// How far two pictures are apart, in encoded values (1 is white), over all but edge pixels, beyond
/// what rounding coarser than to 8 bits on the curve explains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Root of the mean square, all channels.
    pub rms: f64,
    /// The largest difference.
    pub worst: f64,
    /// Where.
    pub worst_at: [u32; 2],
    /// Share of the pixels that differ in some channel by more than [`Residual::NOTICED`], and more
    /// than the smoothing of a narrow highlight explains.
    pub over: f64,
    /// Pixels compared.
    pub pixels: usize,
}

impl Residual {
    /// More than rounding to 8 bits, twice, can explain.
    pub const NOTICED: f64 = 2.5 / 255.0;
    /// Of how much a value stands out from the mean of its neighbours, samples spread over its pixel
    /// may take this share.
    pub(super) const SMOOTHED: f64 = 0.5;
}

/// Their picture, encoded. NaN stays NaN, and is compared with nothing.
pub(super) struct Theirs {
    values: Vec<[Level; 3]>,
}

/// A value of their picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Level {
    /// On the sRGB curve; 1 is white.
    pub(super) value: f32,
    /// How much further their file's rounding may have moved it than the rounding to 8 bits on the
    /// curve, which every threshold here allows for: half a step of linear values is much in the
    /// dark, where the curve is steep.
    pub(super) rounding: f32,
}

impl Level {
    /// How far from `ours` it was drawn at least.
    pub(super) fn apart(self, ours: f32) -> f64 {
        ((f64::from(ours) - f64::from(self.value)).abs() - f64::from(self.rounding)).max(0.0)
    }
}

/// Pixels with a value that is no number.
#[derive(Clone, Copy, Debug)]
pub(super) struct NotNumbers {
    pub(super) count: usize,
    pub(super) first: usize,
}

impl Theirs {
    /// `None` if it has no colours.
    pub(super) fn new(picture: &Picture) -> Option<Self> {
        let [r, g, b] = picture.rgb()?;
        let alpha = picture.plane("A");
        let half = picture.levels.map_or(0.0, |levels| 0.5 / f64::from(levels));
        let level = |drawn: f32| match picture.transfer {
            Transfer::Srgb => Level { value: drawn, rounding: beyond_usual(half) },
            Transfer::Linear => {
                let drawn = f64::from(drawn).clamp(0.0, 1.0);
                let [below, value, above] =
                    [drawn - half, drawn, drawn + half].map(|v| srgb_encode(v.clamp(0.0, 1.0)));
                let rounding = beyond_usual((value - below).max(above - value));
                Level { value: value as f32, rounding }
            }
        };
        let at = |i: usize| {
            let clear = alpha.is_some_and(|a| a[i] == 0.0);
            [r[i], g[i], b[i]].map(|v| if clear { Level::default() } else { level(v) })
        };
        Some(Self { values: (0..r.len()).map(at).collect() })
    }

    /// Allows each value to be further off by so much.
    pub(super) fn allow(&mut self, by: &[[f32; 3]]) {
        for (pixel, by) in self.values.iter_mut().zip(by) {
            for (level, by) in pixel.iter_mut().zip(by) {
                level.rounding += by;
            }
        }
    }

    /// The pixels with a value that is no number; `None`: there are none.
    pub(super) fn not_numbers(&self) -> Option<NotNumbers> {
        let is_nan = |pixel: &[Level; 3]| pixel.iter().any(|level| level.value.is_nan());
        let first = self.values.iter().position(is_nan)?;
        Some(NotNumbers { count: self.values.iter().filter(|v| is_nan(v)).count(), first })
    }

    /// The value that belongs at a pixel if the picture is laid out wrongly; `None`: it is not in
    /// the picture.
    pub(super) fn at(
        &self,
        i: usize,
        [width, height]: [u32; 2],
        layout: Option<Layout>,
    ) -> Option<[Level; 3]> {
        let (w, h) = (width as usize, height as usize);
        let (x, y) = (i % w, i / w);
        Some(match layout {
            None => self.values[i],
            Some(Layout::UpsideDown) => self.values[(h - 1 - y) * w + x],
            Some(Layout::LeftRight) => self.values[y * w + w - 1 - x],
            Some(Layout::Turned) => self.values[(h - 1 - y) * w + w - 1 - x],
            Some(Layout::BlueFirst) => {
                let [r, g, b] = self.values[i];
                [b, g, r]
            }
            Some(Layout::Shifted(right, down)) => {
                let (x, y) = (x as i64 + i64::from(right), y as i64 + i64::from(down));
                let there = (0..w as i64).contains(&x) && (0..h as i64).contains(&y);
                return there.then(|| self.values[y as usize * w + x as usize]);
            }
        })
    }

    /// By how much a value stands out from the mean of the eight around it, in the channel where that
    /// is most; 0 at the picture's border.
    pub(super) fn standing_out(&self, i: usize, width: usize) -> f64 {
        standing_out(|j, c| f64::from(self.values[j][c].value), i, width, self.values.len())
    }
}

/// What half a step of a file is more than half a step of 8 bits.
fn beyond_usual(half: f64) -> f32 {
    (half - 0.5 / 255.0).max(0.0) as f32
}

/// How far two pictures are apart where `inner` says to look.
pub(super) fn residual(
    [width, _]: [u32; 2],
    inner: &[bool],
    ours: &[[f32; 3]],
    theirs: &Theirs,
) -> Residual {
    let row = |y: usize| {
        let mut out = Residual::default();
        let from = y * width as usize;
        for i in (from..from + width as usize).filter(|&i| inner[i]) {
            let (a, b) = (ours[i], theirs.values[i]);
            if b.iter().any(|level| level.value.is_nan()) {
                continue;
            }
            let off: [f64; 3] = std::array::from_fn(|c| b[c].apart(a[c]));
            out.rms += off.iter().map(|d| d * d).sum::<f64>();
            let worst = off.iter().fold(0.0, |worst: f64, d| worst.max(*d));
            let noticed = worst > Residual::NOTICED
                && worst
                    > Residual::NOTICED
                        + Residual::SMOOTHED
                            * standing_out(
                                |j, c| f64::from(ours[j][c]),
                                i,
                                width as usize,
                                ours.len(),
                            );
            out.over += f64::from(u8::from(noticed));
            out.pixels += 1;
            if worst > out.worst {
                out.worst = worst;
                out.worst_at = [i as u32 % width, y as u32];
            }
        }
        out
    };
    // Rows are summed in order: the same bits for any number of threads.
    let rows: Vec<Residual> = (0..inner.len() / width as usize).into_par_iter().map(row).collect();
    let mut all = Residual::default();
    for row in rows {
        all.rms += row.rms;
        all.over += row.over;
        all.pixels += row.pixels;
        if row.worst > all.worst {
            (all.worst, all.worst_at) = (row.worst, row.worst_at);
        }
    }
    if all.pixels > 0 {
        let pixels = all.pixels as f64;
        all.rms = (all.rms / (3.0 * pixels)).sqrt();
        all.over /= pixels;
    }
    all
}

fn standing_out(value: impl Fn(usize, usize) -> f64, i: usize, width: usize, pixels: usize) -> f64 {
    let (x, y, height) = (i % width, i / width, pixels / width);
    if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
        return 0.0;
    }
    let most = |most: f64, c: usize| {
        let block = (y - 1..=y + 1).flat_map(|v| (x - 1..=x + 1).map(move |u| v * width + u));
        let sum: f64 = block.map(|j| value(j, c)).sum();
        let own = value(i, c);
        most.max((own - (sum - own) / 8.0).abs())
    };
    (0..3).fold(0.0, most)
}

/// What mirrors and glass bring to neighbours may differ by this, in linear values; by more it is
/// an edge that is seen in them.
const JUMP: f32 = 0.02;

/// Which pixels are not at an edge: the eight around meet the same object, see the same lights, and
/// are brought nearly the same by mirrors and glass.
pub(super) fn inner(points: &[Point], [width, height]: [u32; 2]) -> Vec<bool> {
    let (w, h) = (width as usize, height as usize);
    let brought = |i: usize| points[i].terms.reflection + points[i].terms.transmission;
    let no_jump = |i: usize, j: usize| {
        (brought(i) - brought(j)).to_array().iter().all(|apart| apart.abs() <= JUMP)
    };
    let at = |i: usize| {
        let (x, y) = (i % w, i / w);
        let around = |v: usize, most: usize| v.saturating_sub(1)..=(v + 1).min(most - 1);
        let mut neighbours = around(y, h).flat_map(|v| around(x, w).map(move |u| v * w + u));
        neighbours
            .all(|j| alike(points[i].surface.as_ref(), points[j].surface.as_ref()) && no_jump(i, j))
    };
    (0..points.len()).into_par_iter().map(at).collect()
}

/// Whether two points are of one surface, and see the same lights.
pub(super) fn alike(a: Option<&Surface>, b: Option<&Surface>) -> bool {
    match (a, b) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            a.object == b.object
                && a.lights.len() == b.lights.len()
                && a.lights.iter().zip(&b.lights).all(|(a, b)| {
                    (a.above, a.visible, a.clear, a.reached, a.away, a.away_endless)
                        == (b.above, b.visible, b.clear, b.reached, b.away, b.away_endless)
                })
                // Faces of a mesh or box that meet at a corner.
                && a.n.dot(b.n) > 0.7
        }
        _ => false,
    }
}
