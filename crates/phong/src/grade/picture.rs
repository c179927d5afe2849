//! Pictures, pixel by pixel.

use phong_scene::{Rgb, srgb_encode};
use rayon::prelude::*;

use super::mistakes::{Curve, Layout};
use super::points::{Point, Surface};
use crate::image::{Picture, Transfer};
use crate::math::wide;

/// How far two pictures are apart, in encoded values (1 is white), over all but edge pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Root of the mean square, all channels.
    pub rms: f64,
    /// The largest difference.
    pub worst: f64,
    /// Where.
    pub worst_at: [u32; 2],
    /// Share of the pixels that differ by more than [`Residual::NOTICED`] in some channel.
    pub over: f64,
    /// Pixels compared.
    pub pixels: usize,
}

impl Residual {
    /// More than rounding to 8 bits, twice, can explain.
    pub const NOTICED: f64 = 2.5 / 255.0;
}

/// Their picture, encoded.
pub(super) struct Theirs {
    values: Vec<[f32; 3]>,
}

impl Theirs {
    /// `None` if it has no colours.
    pub(super) fn new(picture: &Picture) -> Option<Self> {
        let [r, g, b] = picture.rgb()?;
        let alpha = picture.plane("A");
        let at = |i: usize| {
            let color = Rgb::new(r[i], g[i], b[i]);
            match picture.transfer {
                Transfer::Srgb => color.to_array(),
                Transfer::Linear => encode(color, Curve::Right),
            }
            .map(|v| if alpha.is_some_and(|a| a[i] == 0.0) { 0.0 } else { v })
        };
        Some(Self { values: (0..r.len()).map(at).collect() })
    }

    /// The value that belongs at a pixel if the picture is laid out wrongly.
    pub(super) fn at(
        &self,
        i: usize,
        [width, height]: [u32; 2],
        layout: Option<Layout>,
    ) -> [f32; 3] {
        let (w, h) = (width as usize, height as usize);
        let (x, y) = (i % w, i / w);
        match layout {
            None => self.values[i],
            Some(Layout::UpsideDown) => self.values[(h - 1 - y) * w + x],
            Some(Layout::LeftRight) => self.values[y * w + w - 1 - x],
            Some(Layout::Turned) => self.values[(h - 1 - y) * w + w - 1 - x],
            Some(Layout::BlueFirst) => {
                let [r, g, b] = self.values[i];
                [b, g, r]
            }
        }
    }
}

/// Linear values as levels in [0, 1].
pub(super) fn encode(color: Rgb, curve: Curve) -> [f32; 3] {
    color.to_array().map(|v| {
        let v = f64::from(v).clamp(0.0, 1.0);
        let encoded = match curve {
            Curve::Right => srgb_encode(v),
            Curve::Missing => v,
            Curve::Twice => srgb_encode(srgb_encode(v)),
            Curve::Power22 => wide::pow(v, 1.0 / 2.2),
        };
        encoded as f32
    })
}

/// How far two pictures are apart where `inner` says to look.
pub(super) fn residual(
    [width, _]: [u32; 2],
    inner: &[bool],
    ours: impl Fn(usize) -> [f32; 3] + Sync,
    theirs: impl Fn(usize) -> [f32; 3] + Sync,
) -> Residual {
    let row = |y: usize| {
        let mut out = Residual::default();
        let from = y * width as usize;
        for i in (from..from + width as usize).filter(|&i| inner[i]) {
            let (a, b) = (ours(i), theirs(i));
            let off: [f64; 3] = std::array::from_fn(|c| f64::from(a[c]) - f64::from(b[c]));
            out.rms += off.iter().map(|d| d * d).sum::<f64>();
            let worst = off.iter().fold(0.0, |worst: f64, d| worst.max(d.abs()));
            out.over += f64::from(u8::from(worst > Residual::NOTICED));
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

/// Which pixels are not at an edge: the eight around meet the same object and see the same lights.
pub(super) fn inner(points: &[Point], [width, height]: [u32; 2]) -> Vec<bool> {
    let (w, h) = (width as usize, height as usize);
    let alike = |a: &Option<Surface>, b: &Option<Surface>| match (a, b) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            a.object == b.object
                && a.lights.len() == b.lights.len()
                && a.lights.iter().zip(&b.lights).all(|(a, b)| {
                    (a.above, a.visible, a.clear) == (b.above, b.visible, b.clear)
                })
                // Faces of a mesh or box that meet at a corner.
                && a.n.dot(b.n) > 0.7
        }
        _ => false,
    };
    let at = |i: usize| {
        let (x, y) = (i % w, i / w);
        let around = |v: usize, most: usize| v.saturating_sub(1)..=(v + 1).min(most - 1);
        around(y, h)
            .all(|v| around(x, w).all(|u| alike(&points[i].surface, &points[v * w + u].surface)))
    };
    (0..points.len()).into_par_iter().map(at).collect()
}
