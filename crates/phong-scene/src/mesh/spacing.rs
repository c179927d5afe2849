//! A radius for points that bring none: that at which neighbours just touch.

use rayon::prelude::*;

use super::Points;

/// Distances taken at most: what a hundred points among a million cost.
const DISTANCES: usize = 1 << 27;

/// Points that are asked for at once.
const LANES: usize = 8;

impl Points {
    /// Gives all points the radius at which neighbours just touch: half the median distance between
    /// a point and its nearest neighbour.
    pub(crate) fn guess_radius(&mut self) {
        let radius = radius_that_touches(&self.spheres);
        self.set_radius(Some(radius));
        self.guessed = Some(radius);
    }

    /// Gives all points this radius, if it is one.
    pub(crate) fn set_radius(&mut self, radius: Option<f32>) {
        if let Some(radius) = radius.filter(|r| self.spheres.iter().any(|s| s[3] != *r)) {
            self.spheres.iter_mut().for_each(|sphere| sphere[3] = radius);
        }
    }
}

/// Half the median distance from a point to its nearest neighbour elsewhere, over up to 512 points
/// spread evenly over the file (fewer among millions); 1 if all are at one place.
pub(crate) fn radius_that_touches(spheres: &[[f32; 4]]) -> f32 {
    let xyz = |s: &[f32; 4]| [s[0], s[1], s[2]];
    let asked = (DISTANCES / spheres.len().max(1)).clamp(16, 512).min(spheres.len());
    let queries: Vec<[f32; 3]> =
        (0..asked).map(|i| xyz(&spheres[i * spheres.len() / asked])).collect();
    let Some(first) = queries.first() else { return 1.0 };
    let span = |axis: usize| {
        let values = || queries.iter().map(|q| q[axis] - first[axis]);
        values().fold(0.0, f32::max) - values().fold(0.0, f32::min)
    };
    let extent = span(0).max(span(1)).max(span(2));
    // In units of the cloud's size, squares neither vanish nor overflow.
    let scale = if extent > 0.0 && extent.is_finite() { extent.recip() } else { 1.0 };
    // Points asked for lie side by side by axis, so that each point of the file is held against eight at once.
    let lanes = |eight: &[[f32; 3]]| {
        let of = |axis: usize| std::array::from_fn(|k| eight[k.min(eight.len() - 1)][axis]);
        [of(0), of(1), of(2)]
    };
    let eights: Vec<[[f32; LANES]; 3]> = queries.chunks(LANES).map(lanes).collect();
    let nearest = spheres
        .par_chunks(1 << 14)
        .map(|part| {
            let nearest = |[x, y, z]: &[[f32; LANES]; 3]| {
                part.iter().fold([f32::INFINITY; LANES], |least, s| {
                    std::array::from_fn(|k| {
                        let d = [s[0] - x[k], s[1] - y[k], s[2] - z[k]].map(|d| d * scale);
                        let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                        if square > 0.0 && square < least[k] { square } else { least[k] }
                    })
                })
            };
            eights.iter().flat_map(nearest).take(queries.len()).collect::<Vec<_>>()
        })
        .reduce_with(|a, b| a.iter().zip(&b).map(|(a, b)| a.min(*b)).collect());
    let mut found: Vec<f32> =
        nearest.unwrap_or_default().into_iter().filter(|d| d.is_finite()).collect();
    found.sort_by(f32::total_cmp);
    let radius = found.get(found.len() / 2).map_or(1.0, |square| 0.5 * square.sqrt() / scale);
    if radius.is_normal() { radius } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_on_a_grid_just_touch_whatever_its_size() {
        for step in [1e-20_f32, 0.25, 1e12] {
            let grid: Vec<_> = (0..20 * 20 * 20)
                .map(|i| [i % 20, i / 20 % 20, i / 400].map(|c| c as f32 * step))
                .map(|[x, y, z]| [x, y, z, 0.0])
                .collect();
            let radius = radius_that_touches(&grid);
            assert!((radius / step - 0.5).abs() < 1e-5, "{radius}");
        }
    }

    #[test]
    fn points_at_one_place_get_a_radius_too() {
        assert_eq!(radius_that_touches(&[]), 1.0);
        assert_eq!(radius_that_touches(&[[5.0, 5.0, 5.0, 0.0]; 3]), 1.0);
    }
}
