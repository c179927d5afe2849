//! Polygons of more than three corners, cut into triangles by clipping ears.
//!
//! A reader writes a polygon of n corners as the fan of n − 2 triangles around its first corner,
//! which is right if the polygon is convex. Here the fans are checked once all positions are
//! known, and where one leaves the polygon or folds over, its triangles are replaced, in place:
//! every triangulation has n − 2 triangles.
//!
//! The polygon is seen along the axis nearest to its normal (Newell's, which is that of the plane
//! that fits best): dropping a coordinate rounds nothing, so the signs of areas, taken in f64,
//! are those of the numbers in the file.

use std::collections::VecDeque;

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

use super::blocks::Blocks;

/// Corners looked at per corner before a polygon is given up as tangled: simple ones need fewer,
/// and no file can keep the machine busy for long.
const PATIENCE: u64 = 256;

/// Corners that are looked at in any polygon before it is given up.
const PATIENCE_AT_LEAST: u64 = 1 << 22;

/// Polygons whose fans are checked by one task.
const GROUP: usize = 1024;

/// Replaces the fans that do not cover their polygons; how many polygons are so tangled (they
/// cross themselves, or have no area) that no triangulation covers them.
///
/// `polygons` holds the first triangle and the number of corners of each, ascending. The same
/// cuts are made in `indices` and in each of `others` that is not empty.
pub(crate) fn cut_polygons(
    positions: &[Vec3],
    polygons: &[[u32; 2]],
    indices: &mut [[u32; 3]],
    others: [&mut [[u32; 3]]; 2],
) -> u64 {
    let mut arrays = [indices].into_iter().chain(others).collect::<Vec<_>>();
    let mut offset = 0;
    let mut tasks = Vec::new();
    for group in polygons.chunks(GROUP) {
        let [start, corners] = *group.last().unwrap_or(&[0, 0]);
        let end = start as usize + corners as usize - 2;
        let mut mine = Vec::new();
        for array in &mut arrays {
            let count = (end - offset).min(array.len());
            mine.push(array.split_off_mut(..count).unwrap_or_default());
        }
        tasks.push((offset, group, mine));
        offset = end;
    }
    tasks
        .into_par_iter()
        .map(|(offset, group, mut arrays)| {
            let cut = |&[start, corners]: &[u32; 2]| {
                let start = start as usize - offset;
                let fan = start..start + corners as usize - 2;
                let around = corners_of(&arrays[0][fan.clone()]);
                let points =
                    around.iter().map(|&i| positions[i as usize].as_dvec3()).collect::<Vec<_>>();
                let (triangles, covered) = match triangulate(&points) {
                    Cut::Fan => return 0,
                    Cut::Ears(triangles) => (triangles, 0),
                    Cut::Tangled(triangles) => (triangles, 1),
                };
                for array in arrays.iter_mut().filter(|a| !a.is_empty()) {
                    let around = corners_of(&array[fan.clone()]);
                    for (to, from) in array[fan.clone()].iter_mut().zip(&triangles) {
                        *to = from.map(|corner| around[corner as usize]);
                    }
                }
                covered
            };
            group.iter().map(cut).sum::<u64>()
        })
        .sum()
}

/// The corners of a polygon whose fan this is.
fn corners_of(fan: &[[u32; 3]]) -> Vec<u32> {
    fan.first().into_iter().flat_map(|t| [t[0], t[1]]).chain(fan.iter().map(|t| t[2])).collect()
}

/// How a polygon falls into triangles of its corners.
#[derive(Debug, PartialEq)]
enum Cut {
    /// The fan around its first corner covers it.
    Fan,
    /// These cover it.
    Ears(Vec<[u32; 3]>),
    /// It is not simple; these are as good as any.
    Tangled(Vec<[u32; 3]>),
}

fn triangulate(corners: &[DVec3]) -> Cut {
    let points = flatten(corners);
    let fan = |i: usize| area(points[0], points[i], points[i + 1]) > 0.0;
    if (1..points.len() - 1).all(fan) {
        return Cut::Fan;
    }
    let mut clipper = Clipper::new(&points);
    let clean = clipper.clip();
    let triangles = clipper.triangles;
    if clean { Cut::Ears(triangles) } else { Cut::Tangled(triangles) }
}

/// The polygon as seen along the axis nearest to its normal, counter-clockwise.
fn flatten(corners: &[DVec3]) -> Vec<DVec2> {
    let origin = corners[0];
    let normal: DVec3 =
        corners.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin)).sum();
    let size = normal.abs();
    let (pick, along): (fn(DVec3) -> DVec2, f64) = if size.z >= size.x && size.z >= size.y {
        (|p| DVec2::new(p.x, p.y), normal.z)
    } else if size.x >= size.y {
        (|p| DVec2::new(p.y, p.z), normal.x)
    } else {
        (|p| DVec2::new(p.z, p.x), normal.y)
    };
    let upright = |p: DVec2| if along < 0.0 { DVec2::new(p.y, p.x) } else { p };
    corners.iter().map(|&p| upright(pick(p))).collect()
}

/// Twice the area of a triangle; positive if counter-clockwise.
#[inline]
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// What is left of a polygon while its ears are clipped.
struct Clipper<'a> {
    points: &'a [DVec2],
    previous: Vec<u32>,
    next: Vec<u32>,
    /// Corners that may lie in another's ear: those where the outline does not turn left.
    blocks: Blocks,
    /// Corners that wait in the queue to be clipped.
    waits: Vec<bool>,
    left: usize,
    looked_at: u64,
    triangles: Vec<[u32; 3]>,
}

impl<'a> Clipper<'a> {
    fn new(points: &'a [DVec2]) -> Self {
        let n = points.len() as u32;
        let mut clipper = Self {
            points,
            previous: (0..n).map(|i| if i == 0 { n - 1 } else { i - 1 }).collect(),
            next: (0..n).map(|i| if i + 1 == n { 0 } else { i + 1 }).collect(),
            blocks: Blocks::new(points),
            waits: vec![false; points.len()],
            left: points.len(),
            looked_at: 0,
            triangles: Vec::with_capacity(points.len() - 2),
        };
        for i in 0..n {
            clipper.blocks.set(i, clipper.turn(i) <= 0.0);
        }
        clipper
    }

    /// Clips all ears; whether they cover the polygon.
    fn clip(&mut self) -> bool {
        let mut clean = true;
        let mut any = 0;
        let patience = PATIENCE_AT_LEAST.max(PATIENCE * self.points.len() as u64);
        while self.left > 3 {
            if self.looked_at > patience {
                // What comes next goes, and so on to the end.
                clean = false;
                any = self.cut_off(any);
                continue;
            }
            let mut queue = self.ears(any);
            if queue.is_empty() {
                // Not simple: what turns left least wrongly goes.
                clean &= self.is_flat();
                any = self.cut_off(self.straightest(any));
                self.looked_at += 2 * self.left as u64;
                continue;
            }
            while let Some(ear) = queue.pop_front() {
                self.waits[ear as usize] = false;
                if self.left == 3 || self.looked_at > patience {
                    break;
                }
                if !self.is_ear(ear) {
                    continue;
                }
                any = self.cut_off(ear);
                for neighbour in [self.previous[any as usize], any] {
                    if !self.waits[neighbour as usize] && self.turn(neighbour) > 0.0 {
                        self.waits[neighbour as usize] = true;
                        queue.push_back(neighbour);
                    }
                }
            }
        }
        self.triangles.push([self.previous[any as usize], any, self.next[any as usize]]);
        clean && self.turn(any) >= 0.0
    }

    /// All ears there are, going around from `start`.
    fn ears(&mut self, start: u32) -> VecDeque<u32> {
        let mut ears = VecDeque::new();
        let mut at = start;
        self.looked_at += self.left as u64;
        for _ in 0..self.left {
            if self.is_ear(at) {
                self.waits[at as usize] = true;
                ears.push_back(at);
            }
            at = self.next[at as usize];
        }
        ears
    }

    /// Cuts a corner off; its successor.
    fn cut_off(&mut self, corner: u32) -> u32 {
        let (before, after) = (self.previous[corner as usize], self.next[corner as usize]);
        self.triangles.push([before, corner, after]);
        self.next[before as usize] = after;
        self.previous[after as usize] = before;
        self.blocks.set(corner, false);
        for neighbour in [before, after] {
            self.blocks.set(neighbour, self.turn(neighbour) <= 0.0);
        }
        self.left -= 1;
        after
    }

    /// Twice the area of the triangle that a corner makes with its neighbours.
    #[inline]
    fn turn(&self, corner: u32) -> f64 {
        let [a, b, c] = self.triangle(corner);
        area(a, b, c)
    }

    #[inline]
    fn triangle(&self, corner: u32) -> [DVec2; 3] {
        let i = corner as usize;
        [self.previous[i], corner, self.next[i]].map(|i| self.points[i as usize])
    }

    /// Whether a corner turns left and no other corner lies in its triangle or on its border.
    fn is_ear(&mut self, corner: u32) -> bool {
        let [a, b, c] = self.triangle(corner);
        if area(a, b, c) <= 0.0 {
            return false;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        // A corner at the same place as one of the three is no obstacle: outlines with holes
        // pass twice through the ends of the bridges that join them.
        let inside = |p: DVec2| {
            p.cmpge(low).all()
                && p.cmple(high).all()
                && p != a
                && p != b
                && p != c
                && area(a, b, p) >= 0.0
                && area(b, c, p) >= 0.0
                && area(c, a, p) >= 0.0
        };
        // The corner of a box that lies farthest to the left of an edge; every step of the area is
        // monotone, rounding included, so no point of the box has a greater one.
        let leftmost = |from: DVec2, to: DVec2, low: DVec2, high: DVec2| {
            let x = if to.y > from.y { low.x } else { high.x };
            let y = if to.x > from.x { high.y } else { low.y };
            area(from, to, DVec2::new(x, y))
        };
        let may = |from: DVec2, to: DVec2| {
            from.cmple(high).all()
                && to.cmpge(low).all()
                && leftmost(a, b, from, to) >= 0.0
                && leftmost(b, c, from, to) >= 0.0
                && leftmost(c, a, from, to) >= 0.0
        };
        !self.blocks.any(self.points, &mut self.looked_at, may, inside)
    }

    /// The corner whose triangle is smallest, going around from `start`.
    fn straightest(&self, start: u32) -> u32 {
        let mut best = start;
        let mut at = start;
        for _ in 0..self.left {
            if self.turn(at).abs() < self.turn(best).abs() {
                best = at;
            }
            at = self.next[at as usize];
        }
        best
    }

    /// Whether a corner can be cut off without taking anything away from the polygon.
    fn is_flat(&self) -> bool {
        let mut at = self.triangles.last().map_or(0, |t| t[2]);
        (0..self.left).any(|_| {
            at = self.next[at as usize];
            self.turn(at) == 0.0
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<DVec3> {
        // In a tilted plane: the projection must not matter.
        points.iter().map(|&(x, y)| DVec3::new(x, y, 0.25 * x - 0.5 * y)).collect()
    }

    fn outline_area(points: &[DVec2]) -> f64 {
        (1..points.len() - 1).map(|i| area(points[0], points[i], points[i + 1])).sum()
    }

    /// Every triangle is counter-clockwise and their areas add up to the polygon's: they cover
    /// it, and only it, exactly once.
    fn covers_exactly_once(corners: &[DVec3]) {
        let points = flatten(corners);
        let triangles = match triangulate(corners) {
            Cut::Fan => (1..corners.len() as u32 - 1).map(|i| [0, i, i + 1]).collect(),
            Cut::Ears(triangles) => triangles,
            Cut::Tangled(_) => panic!("a simple polygon was called tangled: {corners:?}"),
        };
        assert_eq!(triangles.len(), corners.len() - 2);
        let areas = triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            area(a, b, c)
        });
        let whole = outline_area(&points);
        assert!(areas.clone().all(|a| a >= 0.0), "{triangles:?}");
        assert!((areas.sum::<f64>() - whole).abs() <= 1e-12 * whole.abs(), "{triangles:?}");
    }

    #[test]
    fn a_convex_polygon_stays_a_fan() {
        let square = polygon(&[(0., 0.), (1., 0.), (1., 1.), (0., 1.)]);
        assert_eq!(triangulate(&square), Cut::Fan);
        let clockwise: Vec<_> = square.into_iter().rev().collect();
        assert_eq!(triangulate(&clockwise), Cut::Fan);
    }

    #[test]
    fn concave_polygons_are_covered_exactly_once() {
        let arrow = [(0., 0.), (2., -1.), (0., 2.), (-2., -1.)];
        for turn in 0..4 {
            let mut turned = arrow;
            turned.rotate_left(turn);
            covers_exactly_once(&polygon(&turned));
            turned.reverse();
            covers_exactly_once(&polygon(&turned));
        }
        let mut comb = vec![(0.0, 0.0)];
        for tooth in 0..40 {
            let x = f64::from(tooth);
            comb.extend([(x + 0.1, 10.0), (x + 1.0, 0.0)]);
        }
        comb.push((40.0, -1.0));
        comb.push((0.0, -1.0));
        comb.reverse();
        covers_exactly_once(&polygon(&comb));
    }

    #[test]
    fn corners_on_a_straight_edge_make_no_triangle_leave_the_polygon() {
        let tees = [(0., 0.), (1., 0.), (2., 0.), (3., 0.), (3., 3.), (1.5, 3.), (0., 3.)];
        for turn in 0..7 {
            let mut turned = tees;
            turned.rotate_left(turn);
            covers_exactly_once(&polygon(&turned));
        }
    }

    #[test]
    fn a_hole_joined_to_the_outline_by_a_bridge_stays_open() {
        let ring = [
            (0., 0.),
            (4., 0.),
            (4., 4.),
            (0., 4.),
            (0., 0.),
            (1., 1.),
            (1., 3.),
            (3., 3.),
            (3., 1.),
            (1., 1.),
        ];
        for turn in 0..10 {
            let mut turned = ring;
            turned.rotate_left(turn);
            covers_exactly_once(&polygon(&turned));
        }
    }

    #[test]
    fn a_spiral_of_a_thousand_corners_is_covered_exactly_once() {
        let at = |i: u32, r: f64| {
            let angle = f64::from(i) * 0.05;
            (r * libm::cos(angle), r * libm::sin(angle))
        };
        let outer = (0..500).map(|i| at(i, 1.0 + f64::from(i) * 0.01));
        let inner = (0..500).rev().map(|i| at(i, 0.6 + f64::from(i) * 0.01));
        covers_exactly_once(&polygon(&outer.chain(inner).collect::<Vec<_>>()));
    }

    #[test]
    fn long_outlines_of_any_run_are_covered_and_what_is_looked_at_grows_as_they_do() {
        let n = 20_000_u32;
        let mut comb = vec![(0.0, 0.0)];
        comb.extend((0..n / 2).map(f64::from).flat_map(|x| [(x + 0.1, 10.0), (x + 1.0, 0.0)]));
        comb.extend([(f64::from(n / 2), -1.0), (0.0, -1.0)]);
        let lying: Vec<_> = comb.iter().map(|&(x, y)| (y, x)).collect();
        let star = (0..n).map(|i| {
            let (angle, r) =
                (f64::from(i) / f64::from(n) * std::f64::consts::TAU, 1.0 + f64::from(i % 2));
            (r * libm::cos(angle), r * libm::sin(angle))
        });
        for outline in [comb, lying, star.collect()] {
            let points = flatten(&polygon(&outline));
            let mut clipper = Clipper::new(&points);
            assert!(clipper.clip());
            assert!(clipper.looked_at < 200 * u64::from(n), "{}", clipper.looked_at);
        }
    }

    #[test]
    fn a_long_tangle_is_given_up_before_long() {
        let at = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 8);
        let tangle: Vec<_> = (0..20_000).map(|i| DVec2::new(at(i), at(i + 77))).collect();
        let line: Vec<_> = (0..20_000).map(|i| DVec2::new(f64::from(i), 0.0)).collect();
        for points in [tangle, line] {
            let mut clipper = Clipper::new(&points);
            clipper.clip();
            assert_eq!(clipper.triangles.len(), points.len() - 2);
            assert!(clipper.looked_at < 2 * PATIENCE_AT_LEAST.max(PATIENCE * 20_000));
        }
    }

    #[test]
    fn what_crosses_itself_or_has_no_area_is_called_tangled_and_still_answered() {
        let bow = polygon(&[(0., 0.), (2., 2.), (2., 0.), (0., 3.)]);
        assert!(matches!(triangulate(&bow), Cut::Tangled(t) if t.len() == 2));
        let star: Vec<_> = (0..5)
            .map(|i| {
                let angle = f64::from(i) * 2.0 * std::f64::consts::TAU / 5.0;
                (libm::cos(angle), libm::sin(angle))
            })
            .collect();
        let line = polygon(&[(0., 0.), (1., 0.), (2., 0.), (3., 0.)]);
        let (Cut::Ears(t) | Cut::Tangled(t)) = triangulate(&line) else { panic!("no fan") };
        assert_eq!(t.len(), 2);
        assert!(!matches!(triangulate(&polygon(&star)), Cut::Ears(_)));
    }

    #[test]
    fn cuts_are_made_in_every_array_alike() {
        let positions =
            [[0., 0.], [2., -1.], [0., 2.], [-2., -1.]].map(|[x, y]| Vec3::new(x, y, 0.));
        let fan =
            |base: u32| vec![[9, 9, 9], [base + 1, base + 2, base + 3], [base + 1, base + 3, base]];
        let (mut indices, mut normals) = (fan(0), fan(10));
        indices[0] = [0, 0, 0];
        assert_eq!(cut_polygons(&positions, &[[1, 4]], &mut indices, [&mut normals, &mut []]), 0);
        assert_ne!(indices[1..], fan(0)[1..]);
        let lifted: Vec<_> = indices[1..].iter().map(|t| t.map(|i| i + 10)).collect();
        assert_eq!(normals[1..], lifted);
        assert_eq!((indices[0], normals[0]), ([0, 0, 0], [9, 9, 9]));
    }

    proptest! {
        #[test]
        fn any_star_shaped_polygon_is_covered_exactly_once(
            radii in prop::collection::vec(0.1..10.0_f64, 3..80), turn in 0..80_usize,
        ) {
            let n = radii.len() as f64;
            let mut corners: Vec<_> = radii.iter().enumerate().map(|(i, r)| {
                let angle = std::f64::consts::TAU * i as f64 / n;
                (r * libm::cos(angle), r * libm::sin(angle))
            }).collect();
            corners.rotate_left(turn % radii.len());
            covers_exactly_once(&polygon(&corners));
        }

        #[test]
        fn any_points_at_all_end_in_triangles(
            points in prop::collection::vec((-4..4_i32, -4..4_i32), 4..40),
        ) {
            let corners: Vec<_> = points.iter().map(|&(x, y)| (f64::from(x), f64::from(y))).collect();
            if let Cut::Ears(t) | Cut::Tangled(t) = triangulate(&polygon(&corners)) {
                prop_assert_eq!(t.len(), corners.len() - 2);
            }
        }
    }
}
