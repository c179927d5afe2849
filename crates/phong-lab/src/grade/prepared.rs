//! A scene, what its pixels are made of, and the right picture.

use phong::render::{OptionsError, RenderOptions};
use phong::view::View;
use phong_scene::Scene;
use rayon::prelude::*;

use super::fault::Fault;
use super::picture::inner;
use super::points::{Point, gather};
use super::shade::{Facts, shade};
use super::tone::{Tone, encode};

/// A scene, what its pixels are made of, and the right picture.
pub(super) struct Prepared {
    pub(super) view: View,
    pub(super) options: RenderOptions,
    pub(super) size: [u32; 2],
    pub(super) facts: Facts,
    pub(super) points: Vec<Point>,
    /// Pixels to compare: not at an edge.
    pub(super) inner: Vec<bool>,
    /// The right picture, encoded.
    pub(super) ours: Vec<[f32; 3]>,
    /// Pixels that are looked at, in an order that looks random: not at edges.
    pub(super) some_inner: Vec<usize>,
    /// The same, edges and all.
    pub(super) some: Vec<usize>,
}

/// So many pixels are looked at, at most.
const MOST_PIXELS: usize = 16_384;

/// Some of `from`, in an order that looks random.
fn scattered(from: &[usize]) -> Vec<usize> {
    let n = from.len();
    let coprime = |step: &usize| {
        let (mut a, mut b) = (*step, n);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a == 1
    };
    let step = ((n as f64 * 0.618_034) as usize..n).find(coprime).unwrap_or(1);
    (0..n.min(MOST_PIXELS)).map(|k| from[(k * step) % n]).collect()
}

impl Prepared {
    /// `view` is what the picture of `scene` shows.
    pub(super) fn new(view: View, scene: &Scene) -> Result<Self, OptionsError> {
        let options = RenderOptions::of(&scene.image)?;
        let points = gather(&view, &options);
        let inner = inner(&points, options.size());
        let facts = Facts::new(scene, view.camera().backward());
        let nothing = Fault::default();
        let right = |point: &Point| encode(shade(point, &nothing, &facts).total(), Tone::Right);
        let every: Vec<usize> = (0..points.len()).collect();
        let inside: Vec<usize> = every.iter().copied().filter(|&i| inner[i]).collect();
        let (some_inner, some) = (scattered(&inside), scattered(&every));
        let ours = points.par_iter().with_min_len(256).map(right).collect();
        let size = options.size();
        Ok(Self { view, options, size, facts, points, inner, ours, some_inner, some })
    }
}
