//! Cells about points that are strewn, one into each cube of a lattice.

use glam::DVec3;
use phong_scene::{CellsBy, Rgb};

use super::lattice::{FAR, hash, share};
use super::noise::shown_of;
use super::ramp::Ramp;

/// How many places the mean of the colours is of.
const PLACES: u32 = 1024;

#[derive(Clone, Debug)]
pub(super) struct Cells {
    ramp: Ramp,
    by: CellsBy,
    seed: u64,
    /// The mean of its colours.
    mean: Rgb,
}

impl Cells {
    pub(super) fn new(ramp: Ramp, by: CellsBy, seed: u32) -> Self {
        let mut cells = Self { ramp, by, seed: seed.into(), mean: Rgb::BLACK };
        cells.mean = match by {
            CellsBy::Cell => cells.ramp.mean(0.5, 0.5),
            CellsBy::Distance | CellsBy::Border => {
                // Powers of 1 / 1.2207…, whose multiples fill a cube evenly.
                let step = DVec3::new(0.819_172_513, 0.671_043_606, 0.549_700_477);
                let place = |i: u32| 16.0 * (f64::from(i) * step).fract();
                let sum = (0..PLACES).map(|i| cells.ramp.at(cells.t(place(i)))).sum::<Rgb>();
                sum / PLACES as f32
            }
        };
        cells
    }

    /// The colour at a place in cubes, where a sample of the picture is so many of them wide.
    pub(super) fn value(&self, p: DVec3, width: f64) -> Rgb {
        let shown = shown_of(width);
        if shown <= 0.0 || p.is_nan() || p.abs().max_element() >= FAR {
            return self.mean;
        }
        let color = self.ramp.at(self.t(p));
        self.mean + shown as f32 * (color - self.mean)
    }

    fn t(&self, p: DVec3) -> f32 {
        let corner = p.floor();
        let own = [corner.x as i64, corner.y as i64, corner.z as i64];
        // The squares of the distances to the nearest two points, and the number of the nearest one.
        let (mut first, mut second, mut number) = (f64::INFINITY, f64::INFINITY, 0);
        for (x, y, z) in cubes() {
            let low = corner + DVec3::new(x as f64, y as f64, z as f64);
            let to_cube = (low - p).max(p - low - 1.0).max(DVec3::ZERO);
            if to_cube.length_squared() >= second {
                continue; // it has no nearer point
            }
            let of_cube = hash([own[0] + x, own[1] + y, own[2] + z], self.seed);
            let point = low + DVec3::new(share(of_cube, 0), share(of_cube, 1), share(of_cube, 2));
            let square = (point - p).length_squared();
            if square < first {
                (first, second, number) = (square, first, of_cube);
            } else if square < second {
                second = square;
            }
        }
        let t = match self.by {
            CellsBy::Distance => first.sqrt(),
            CellsBy::Border => second.sqrt() - first.sqrt(),
            CellsBy::Cell => share(number, 3),
        };
        t.min(1.0) as f32
    }
}

/// The cubes in which the nearest two points may lie: the own one first, since near points spare far ones.
fn cubes() -> impl Iterator<Item = (i64, i64, i64)> {
    let near = [0, -1, 1, -2, 2];
    near.into_iter().flat_map(move |x| {
        near.into_iter().flat_map(move |y| near.into_iter().map(move |z| (x, y, z)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(by: CellsBy) -> Cells {
        Cells::new(Ramp::new(&[(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)]), by, 3)
    }

    fn place(i: i32) -> DVec3 {
        DVec3::new(0.754_877 * f64::from(i), 0.569_84 * f64::from(i), -0.31 * f64::from(i))
    }

    #[test]
    fn a_distance_runs_on_without_steps() {
        for by in [CellsBy::Distance, CellsBy::Border] {
            let cells = cells(by);
            let at = |x: f64| f64::from(cells.t(DVec3::new(x, 0.31, 7.77)));
            for i in 0..4000 {
                let x = f64::from(i) / 400.0;
                assert!((at(x + 1e-4) - at(x)).abs() < 3e-4, "{by:?} {x}");
            }
        }
    }

    #[test]
    fn a_cell_has_one_number_and_far_away_all_have_their_mean() {
        for by in [CellsBy::Distance, CellsBy::Border, CellsBy::Cell] {
            let cells = cells(by);
            let mean = (0..3000).map(|i| cells.value(place(i), 0.0).r).sum::<f32>() / 3000.0;
            let wide = cells.value(place(7), 1.0).r;
            assert!((wide - mean).abs() < 0.02, "{by:?}: {wide} {mean}");
            assert_eq!(cells.value(DVec3::NAN, 0.0), cells.value(DVec3::splat(1e18), 0.0));
        }
        let cells = cells(CellsBy::Cell);
        let near = |i: i32| cells.t(place(i)) == cells.t(place(i) + 1e-3);
        assert!((0..1000).filter(|i| near(*i)).count() > 980);
    }
}
