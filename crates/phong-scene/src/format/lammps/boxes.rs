//! The simulation's box.

use glam::DVec3;

use crate::molecule::Cell;

/// The box from these corners, with these tilts `xy xz yz`.
pub(super) fn cell_of(low: DVec3, high: DVec3, [xy, xz, yz]: [f64; 3]) -> Option<Cell> {
    let size = high - low;
    let edges =
        [DVec3::new(size.x, 0.0, 0.0), DVec3::new(xy, size.y, 0.0), DVec3::new(xz, yz, size.z)];
    let cell = Cell { origin: low, edges };
    let sound = low.is_finite() && edges.iter().all(|edge| edge.is_finite());
    (sound && size.min_element() > 0.0).then_some(cell)
}

/// The box that dumps describe by the bounds of the tilted box.
pub(super) fn cell_of_bounds(low: DVec3, high: DVec3, tilts: [f64; 3]) -> Option<Cell> {
    let [xy, xz, yz] = tilts;
    let both = [0.0, xy, xz, xy + xz];
    let least = both.into_iter().fold(0.0, f64::min);
    let most = both.into_iter().fold(0.0, f64::max);
    let low = low - DVec3::new(least, yz.min(0.0), 0.0);
    let high = high - DVec3::new(most, yz.max(0.0), 0.0);
    cell_of(low, high, tilts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bounds_of_a_tilted_box_are_taken_back() {
        let cell = cell_of_bounds(DVec3::new(-1.0, 0.0, 0.0), DVec3::splat(4.0), [-1.0, 0.0, 1.0]);
        let cell = cell.expect("a box");
        assert_eq!((cell.origin, cell.edges[0].x, cell.edges[1].y), (DVec3::ZERO, 4.0, 3.0));
    }
}
