//! Lights with a surface: points of them chosen by solid angle, and the surfaces as rays see them.
//!
//! A light's samples fill the solid angle that it is seen under evenly, so that their mean is that of a
//! point light over all directions to it. The middle of the square of places is the light's own middle.

use std::f32::consts::FRAC_1_SQRT_2;

use glam::{DVec3, Vec3};
use phong_bvh::{Lanes, lanes::cross};

use super::across;
use super::angle::{on_circle, turn};
use crate::math::lanes::{add, dot, normalize, scale, select3, splat3, sub};
use crate::sampling::concentric_disc;

/// The surface of a light, about its middle.
#[derive(Clone, Debug)]
pub(super) enum Area {
    Rectangle(Rectangle),
    Disc {
        /// The way it faces, unit.
        facing: Vec3,
        radius: f32,
    },
    Sphere {
        radius: f32,
    },
}

/// A rectangle.
#[derive(Clone, Debug)]
pub(super) struct Rectangle {
    /// Along its width, its height, and the way it faces; unit and perpendicular to one another.
    axes: [Vec3; 3],
    /// Half its width and half its height.
    half: [f32; 2],
}

impl Area {
    pub(super) fn rectangle(direction: DVec3, up: Option<DVec3>, size: [f64; 2]) -> Self {
        let facing = direction.normalize_or(DVec3::NEG_Y);
        let up =
            phong_scene::LightKind::upright(facing, up).unwrap_or(facing.any_orthonormal_vector());
        let axes = [facing.cross(up), up, facing].map(DVec3::as_vec3);
        Self::Rectangle(Rectangle { axes, half: size.map(|size| (0.5 * size) as f32) })
    }

    pub(super) fn disc(direction: DVec3, radius: f64) -> Self {
        let facing = direction.normalize_or(DVec3::NEG_Y).as_vec3();
        Self::Disc { facing, radius: radius as f32 }
    }

    pub(super) fn sphere(radius: f64) -> Self {
        Self::Sphere { radius: radius as f32 }
    }

    /// The way it faces; `None`: it shines all around.
    pub(super) fn facing(&self) -> Option<Vec3> {
        match self {
            Self::Rectangle(Rectangle { axes: [.., facing], .. }) | Self::Disc { facing, .. } => {
                Some(*facing)
            }
            Self::Sphere { .. } => None,
        }
    }

    /// How far a ray goes until it meets the surface from the side to which it shines, for one ray or
    /// several; +∞ where it does not. `toward` is the way from the ray's start to the light's middle.
    #[inline(always)]
    pub(super) fn meet<F: Lanes<Scalar = f32>>(&self, toward: [F; 3], dir: [F; 3]) -> F {
        let (zero, none) = (dir[0].splat(0.0), dir[0].splat(f32::INFINITY));
        match self {
            Self::Rectangle(Rectangle { axes: [width, height, facing], half }) => {
                let (t, from_middle) = meet_plane(*facing, toward, dir);
                let x = dot(from_middle, splat3(zero, width.to_array())).abs();
                let y = dot(from_middle, splat3(zero, height.to_array())).abs();
                let (across, up) = (zero.splat(half[0]), zero.splat(half[1]));
                F::select(x.gt(across) | y.gt(up), none, t)
            }
            Self::Disc { facing, radius } => {
                let (t, from_middle) = meet_plane(*facing, toward, dir);
                F::select(dot(from_middle, from_middle).gt(zero.splat(radius * radius)), none, t)
            }
            Self::Sphere { radius } => {
                // By the point of the ray that is closest to the middle.
                let closest = dot(toward, dir);
                let aside = sub(toward, scale(closest, dir));
                let square = zero.splat(radius * radius) - dot(aside, aside);
                let half = F::select(square.gt(zero), square, zero).sqrt();
                let t = closest - half;
                F::select(square.gt(zero) & t.gt(zero), t, none)
            }
        }
    }
}

// What follows is vector code: a closure called more than once, or by `array::map`, may become a call, and is then
// compiled without the level's instructions. So what is needed more than once is a function that is always inlined.

/// How far a ray goes until it meets a plane from the side to which it faces, +∞ where it does not; and where that
/// is, from the point of the plane to which `toward` leads.
#[inline(always)]
fn meet_plane<F: Lanes<Scalar = f32>>(facing: Vec3, toward: [F; 3], dir: [F; 3]) -> (F, [F; 3]) {
    let (zero, none) = (dir[0].splat(0.0), dir[0].splat(f32::INFINITY));
    let facing = splat3(zero, facing.to_array());
    let (along, slope) = (dot(toward, facing), dot(dir, facing));
    let t = along / slope;
    // It is seen only from its front.
    let seen = along.lt(zero) & slope.lt(zero);
    (F::select(seen, t, none), sub(scale(F::select(seen, t, zero), dir), toward))
}

impl Area {
    /// A point of it, seen from where `toward` leads to its middle, by a `place` of the unit square.
    #[inline(always)]
    pub(super) fn choose<F: Lanes<Scalar = f32>>(
        &self,
        toward: [F; 3],
        place: [F; 2],
    ) -> Chosen<F> {
        match self {
            Self::Rectangle(rectangle) => {
                let one = place[0].splat(1.0);
                Chosen { toward: rectangle.choose(toward, place), weight: one }
            }
            &Self::Disc { facing, radius } => {
                choose_of_disc((facing, radius), toward, concentric_disc(place))
            }
            Self::Sphere { radius } => choose_of_sphere(*radius, toward, concentric_disc(place)),
        }
    }
}

/// A point of a light that was chosen, seen from a point.
pub(super) struct Chosen<F> {
    /// The way to it.
    pub(super) toward: [F; 3],
    /// What it counts, of the mean.
    pub(super) weight: F,
}

impl Rectangle {
    /// The way to a point of it: the spherical rectangle is filled evenly. `toward` leads to its middle,
    /// `place` is of the unit square.
    ///
    /// After Ureña, Fajardo and King, *An Area-Preserving Parametrization for Spherical Rectangles*, 2013;
    /// their angles are kept as points of the plane, so that one arc tangent is enough. Where the rectangle is seen at
    /// less than a degree, a point may be off by a hundredth of its width.
    #[inline(always)]
    fn choose<F: Lanes<Scalar = f32>>(&self, toward: [F; 3], place: [F; 2]) -> [F; 3] {
        /// A spherical rectangle of a smaller solid angle is filled as a flat one: rounding would show.
        const FLAT: f32 = 1e-4;
        let (half, one) = (place[0].splat(0.5), place[0].splat(1.0));
        let [half_width, half_height] = self.half;
        let right = splat3(one, self.axes[0].to_array());
        let up = splat3(one, self.axes[1].to_array());
        let facing = splat3(one, self.axes[2].to_array());
        let (x, y, depth) = (dot(toward, right), dot(toward, up), dot(toward, facing).abs());
        // In a unit that no length is greater than, so that their products stay in range.
        let unit = x.abs() + y.abs() + depth + (half_width + half_height);
        let share = one / unit;
        let (x0, x1) = ((x - half_width) * share, (x + half_width) * share);
        let (y0, y1) = ((y - half_height) * share, (y + half_height) * share);
        // How far its plane is, and never 0.
        let depth = (depth * share).at_least(1e-7);
        let square = depth * depth;
        // The paper's angles at the four corners, whose sum is 2π more than the solid angle.
        let right_corners =
            times([y0 * x1, at_corner(depth, x1, y0)], [-(y1 * x1), at_corner(depth, x1, y1)]);
        let left_corners =
            times([y1 * x0, at_corner(depth, x0, y1)], [-(y0 * x0), at_corner(depth, x0, y0)]);
        let solid_angle = turn(times(right_corners, left_corners));
        // The angle of the paper's slice: that of the left corners taken from a share of the solid angle.
        let [cos, sin] =
            times([left_corners[0], -left_corners[1]], on_circle(place[0] * solid_angle));
        // The slope of the plane that ends the slice, by the distance of the lower edge; times the sine.
        let lower = square + y0 * y0;
        let slope = -(cos * y0 + (square + x0 * x0) * lower * y1);
        let (rise, run) = (slope.abs(), sin.abs() * depth);
        let steep = (rise - run) * (rise + run);
        let aside = run * (lower / steep.at_least(1e-30)).sqrt();
        let is_right = (slope * sin).gt(slope.splat(0.0));
        let xu = clamp(F::select(is_right, aside, -aside), x0, x1);
        let square = xu * xu + square;
        let (to_low, to_high) = ((square + y0 * y0).sqrt(), (square + y1 * y1).sqrt());
        let share = one / (to_low * to_high);
        let (h0, h1) = (y0 * to_high * share, y1 * to_low * share);
        let h = h0 + place[1] * (h1 - h0);
        let yv = clamp(h * (square / (one - h * h).at_least(1e-30)).sqrt(), y0, y1);
        // From its middle; from the middle of all places there is no way.
        let flat = solid_angle.lt(one * FLAT) | (place[0].eq(half) & place[1].eq(half));
        let across = F::select(flat, (place[0] - 0.5) * (2.0 * half_width), xu * unit - x);
        let along = F::select(flat, (place[1] - 0.5) * (2.0 * half_height), yv * unit - y);
        add(toward, add(scale(across, right), scale(along, up)))
    }
}

/// How far a corner is, times the distance of the plane that it is in.
#[inline(always)]
fn at_corner<F: Lanes<Scalar = f32>>(depth: F, x: F, y: F) -> F {
    depth * (x * x + y * y + depth * depth).sqrt()
}

/// The sum of the angles of two points of the plane, as that of a third.
#[inline(always)]
fn times<F: Lanes<Scalar = f32>>([a, b]: [F; 2], [c, d]: [F; 2]) -> [F; 2] {
    [a * c - b * d, a * d + b * c]
}

/// The nearest number between two; the lower where it is NaN.
#[inline(always)]
pub(super) fn clamp<F: Lanes<Scalar = f32>>(v: F, low: F, high: F) -> F {
    let v = v.max(low);
    F::select(v.gt(high), high, v)
}

/// The way to the sphere's middle turned into the cone that the sphere fills: evenly, by a `place` of the
/// unit disc. It ends where it is closest to the middle; from within, all is in the half towards that.
#[inline(always)]
pub(super) fn choose_of_sphere<F: Lanes<Scalar = f32>>(
    radius: f32,
    toward: [F; 3],
    place: [F; 2],
) -> Chosen<F> {
    let one = place[0].splat(1.0);
    let axis = normalize(toward);
    let distance = dot(toward, axis);
    let sine = F::select(distance.gt(one * radius), one * radius / distance, one);
    // 1 − cos of the cone, without cancellation.
    let depth = sine * sine / ((one - sine * sine).sqrt() + one);
    let lower = depth * (place[0] * place[0] + place[1] * place[1]);
    let aside = across((depth * (-lower + 2.0)).sqrt(), axis, place);
    let cos = one - lower;
    let zero = one.splat(0.0);
    let is_somewhere = zero.lt(distance);
    let way = select3(is_somewhere, add(scale(cos, axis), aside), [zero; 3]);
    Chosen { toward: scale(distance * cos, way), weight: one }
}

/// The way to a point of a disc, chosen by a `place` of the unit disc.
///
/// The disc is seen as an elliptic cone. Its directions are (a ρ cos ψ, b ρ sin ψ, 1) with ρ ≤ 1; in each
/// sector of ψ they are chosen evenly by solid angle, and what sectors of the same width hold differently
/// is their weight: g(q) over its mean, q = a² cos² ψ + b² sin² ψ, g = 1 / (√(1 + q) (1 + √(1 + q))).
#[inline(always)]
pub(super) fn choose_of_disc<F: Lanes<Scalar = f32>>(
    (facing, radius): (Vec3, f32),
    toward: [F; 3],
    place: [F; 2],
) -> Chosen<F> {
    /// The largest tangent of half an angle that the disc is seen under: that of 180° to rounding.
    const WIDEST: f32 = 1e6;
    /// Cosines of the odd multiples of π/16: the mean over ψ is that of 16 values evenly spread.
    const SPREAD: [f32; 4] = [0.980_785_28, 0.831_469_6, 0.555_570_24, 0.195_090_32];
    /// Where q swings by a smaller share of 1 + q, the mean of four values is that of all to 1e-6.
    const EVEN: f32 = 0.04;
    let (zero, one, widest) = (place[0].splat(0.0), place[0].splat(1.0), place[0].splat(WIDEST));
    let n = splat3(zero, facing.to_array());
    let depth = dot(toward, n);
    let aside = sub(toward, scale(depth, n));
    // Away from where the point is below the disc; there, anywhere across.
    let length = dot(aside, aside);
    let is_aside = length.gt(dot(toward, toward) * 1e-10);
    let anywhere = splat3(zero, facing.any_orthonormal_vector().to_array());
    let length = F::select(is_aside, length, one).sqrt();
    let away = scale(one / length, aside);
    let away = select3(is_aside, away, anywhere);
    let offset = F::select(is_aside, length, zero);
    // The nearest and the farthest point of the rim.
    let square = depth * depth;
    let (near, far) = (offset - radius, offset + radius);
    let near_length = (square + near * near).sqrt();
    let far_length = (square + far * far).sqrt();
    let sum = near_length + far_length;
    // Where the cone's axis meets the disc, from its middle, and half the chord there.
    let shift = -(offset / (sum * sum)) * (4.0 * radius * radius);
    let chord = (-(shift * shift) + radius * radius).at_least(0.0).sqrt();
    let axis = add(toward, scale(shift, away));
    let axis_length = dot(axis, axis).at_least(1e-30).sqrt();
    let axis = scale(one / axis_length, axis);
    let a = chord / axis_length;
    let a = F::select(a.lt(widest), a, widest);
    // Half the angle between the two points of the rim: by its sine and cosine, in the form that does not
    // cancel.
    let (lengths, cosine) = (near_length * far_length, near * far + square);
    let sine = (depth.abs() * (2.0 * radius)).at_least(1e-30);
    let b = F::select(cosine.gt(zero), sine / (lengths + cosine), (lengths - cosine) / sine);
    let b = F::select(b.lt(widest), b, widest);
    let wide = cross(n, away);
    let narrow = cross(axis, wide);
    let (a2, b2) = (a * a, b * b);
    let (x2, y2) = (place[0] * place[0], place[1] * place[1]);
    let share = x2 + y2;
    let is_off = share.gt(zero);
    let q = (a2 * x2 + b2 * y2) / F::select(is_off, share, one);
    let (middle, swing) = ((a2 + b2) * 0.5, (a2 - b2) * 0.5);
    let part = swing * FRAC_1_SQRT_2;
    let mut sum = (per_sector(middle + part) + per_sector(middle - part)) * 4.0;
    let is_even = swing.abs().lt((middle + 1.0) * EVEN);
    if !F::all(is_even) {
        let mut all = zero;
        for cos in SPREAD {
            all = all + per_sector(middle + swing * cos) + per_sector(middle - swing * cos);
        }
        sum = F::select(is_even, sum, all);
    }
    let own = per_sector(q);
    let w = one - share * q * own;
    let stretch = (own * (w + one)).sqrt() / w;
    let dir =
        add(axis, add(scale(a * place[0] * stretch, wide), scale(b * place[1] * stretch, narrow)));
    let t = depth / dot(dir, n);
    // The middle of all places is the disc's own. From a point in its plane the disc is a line, and t would be
    // 0 / 0: its middle stands for it.
    let is_seen = depth.abs().gt(zero);
    Chosen {
        toward: select3(is_off & is_seen, scale(t, dir), toward),
        weight: F::select(is_off, own * 8.0 / sum, one),
    }
}

/// What a sector of a disc's cone holds: g of [`choose_of_disc`].
#[inline(always)]
fn per_sector<F: Lanes<Scalar = f32>>(q: F) -> F {
    let one = q.splat(1.0);
    let root = (q + one).sqrt();
    one / (root * (root + one))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACING: DVec3 = DVec3::NEG_Z;
    /// Points to the light's middle: straight, aslant, near, far, grazing, and so near that it fills half of
    /// all directions but for a little.
    const TOWARD: [[f64; 3]; 6] = [
        [0.0, 0.0, 1.5],
        [0.7, -1.2, 0.8],
        [-0.3, 0.2, 0.4],
        [30.0, 10.0, 40.0],
        [2.0, 0.5, 0.1],
        [0.1, 0.05, 0.3],
    ];

    /// The mean direction over the solid angle of what is told by points about the middle, each of as much
    /// area, and how many of the points are to be had.
    fn mean_of_area(toward: [f64; 3], points: impl Iterator<Item = [f64; 2]>) -> DVec3 {
        let (mut sum, mut whole) = (DVec3::ZERO, 0.0);
        for [x, y] in points {
            let way = DVec3::from_array(toward) + DVec3::new(x, y, 0.0);
            let solid_angle = -way.normalize_or_zero().dot(FACING) / way.length_squared();
            sum += solid_angle * way.normalize_or_zero();
            whole += solid_angle;
        }
        sum / whole
    }

    fn grid(n: usize) -> impl Iterator<Item = [f64; 2]> {
        let at = move |i: usize| (i as f64 + 0.5) / n as f64;
        (0..n * n).map(move |i| [at(i % n), at(i / n)])
    }

    #[test]
    fn places_of_a_rectangle_are_even_over_its_solid_angle() {
        let [width, height] = [0.8, 0.5];
        let Area::Rectangle(rectangle) = Area::rectangle(FACING, Some(DVec3::Y), [width, height])
        else {
            panic!("a rectangle");
        };
        for toward in TOWARD {
            let points = grid(300).map(|[u, v]| [(u - 0.5) * width, (v - 0.5) * height]);
            let expected = mean_of_area(toward, points);
            let middle = toward.map(|v| v as f32);
            let ways = grid(40).map(|place| {
                Vec3::from(rectangle.choose(middle, place.map(|v| v as f32))).as_dvec3()
            });
            let slack = 1e-6 * DVec3::from_array(toward).length();
            let mut mean = DVec3::ZERO;
            for way in ways {
                let aside = way - DVec3::from_array(toward);
                assert!(aside.x.abs() <= width / 2.0 + slack, "{toward:?}: {aside}");
                assert!(aside.y.abs() <= height / 2.0 + slack && aside.z.abs() <= slack);
                mean += way.normalize_or_zero() / 1600.0;
            }
            assert!(mean.distance(expected) < 2e-3, "{toward:?}: {mean} instead of {expected}");
            assert_eq!(rectangle.choose(middle, [0.5; 2]), middle, "its middle");
        }
    }

    #[test]
    fn a_rectangle_far_away_is_filled_as_a_flat_one() {
        let Area::Rectangle(rectangle) = Area::rectangle(FACING, Some(DVec3::Y), [1.0, 2.0]) else {
            panic!("a rectangle");
        };
        for distance in [90.0_f32, 200.0, 5000.0] {
            let toward = [0.3 * distance, 0.0, distance];
            let [x, y, _] = rectangle.choose(toward, [0.25, 0.75]);
            // Facing −Z with +Y up, the width runs along −X.
            let [x, y] = [(x - toward[0]).abs(), (y - toward[1]) / 2.0];
            assert!((x - 0.25).abs() < 1e-3 && (y - 0.25).abs() < 1e-3, "{distance}: {x} {y}");
        }
    }

    #[test]
    fn places_of_a_disc_are_even_over_its_solid_angle() {
        let radius = 0.5;
        for toward in TOWARD {
            let on = |place: [f64; 2]| {
                concentric_disc(place.map(|v| v as f32)).map(|v| radius * f64::from(v))
            };
            let expected = mean_of_area(toward, grid(400).map(on));
            let (mut mean, mut weights) = (DVec3::ZERO, 0.0);
            for place in grid(60) {
                let place = concentric_disc(place.map(|v| v as f32));
                let toward = toward.map(|v| v as f32);
                let facing = FACING.as_vec3();
                let Chosen { toward: way, weight } =
                    choose_of_disc((facing, radius as f32), toward, place);
                let aside = Vec3::from(way) - Vec3::from(toward);
                let slack = 1e-5 * Vec3::from(toward).length();
                assert!(aside.length() <= 0.5 + slack, "{toward:?}: {aside}");
                assert!(aside.z.abs() <= slack);
                mean += f64::from(weight) * Vec3::from(way).as_dvec3().normalize_or_zero() / 3600.0;
                weights += f64::from(weight) / 3600.0;
            }
            assert!((weights - 1.0).abs() < 2e-3, "{toward:?}: {weights}");
            assert!(mean.distance(expected) < 3e-3, "{toward:?}: {mean} instead of {expected}");
        }
    }

    #[test]
    fn places_of_a_sphere_are_even_over_its_cone() {
        for distance in [1.1_f64, 2.0, 20.0] {
            let toward = [0.6 * distance as f32, 0.0, 0.8 * distance as f32];
            let edge = (1.0 - 1.0 / (distance * distance)).sqrt();
            let mut mean = 0.0;
            for place in grid(60) {
                let place = concentric_disc(place.map(|v| v as f32));
                let Chosen { toward: way, .. } = choose_of_sphere(1.0, toward, place);
                let cos = normalize(way)[0] * 0.6 + normalize(way)[2] * 0.8;
                assert!(f64::from(cos) > edge - 1e-6);
                assert!((dot(way, normalize(way)) - distance as f32 * cos).abs() < 1e-5);
                mean += f64::from(cos) / 3600.0;
            }
            // Evenly over a cone the cosine is evenly from the edge's to 1.
            assert!((mean - f64::midpoint(edge, 1.0)).abs() < 1e-3, "{mean}");
        }
    }

    #[test]
    fn surfaces_are_seen_from_the_side_to_which_they_shine() {
        let lamps = [
            (Area::rectangle(FACING, None, [2.0, 1.0]), [0.9, 0.0, 2.0], [0.0, 0.6, 2.0]),
            (Area::disc(FACING, 1.0), [0.9, 0.0, 2.0], [0.8, 0.7, 2.0]),
        ];
        let ahead = [0.0, 0.0, 1.0];
        for (area, within, beside) in lamps {
            assert_eq!(area.meet(within, ahead), 2.0);
            assert_eq!(area.meet(beside, ahead), f32::INFINITY, "{area:?}");
            assert_eq!(area.meet(within.map(|v: f32| -v), [0.0, 0.0, -1.0]), f32::INFINITY);
            assert_eq!(area.meet(within, [0.0, 0.0, -1.0]), f32::INFINITY, "looking away");
        }
        let ball = Area::sphere(1.0);
        assert_eq!(ball.meet([0.0, 0.0, 3.0], ahead), 2.0);
        assert_eq!(ball.meet([1.1, 0.0, 3.0], ahead), f32::INFINITY);
        assert_eq!(ball.meet([0.0, 0.0, 0.5], ahead), f32::INFINITY, "from within");
    }

    #[test]
    fn from_a_point_in_its_plane_a_disc_is_seen_at_its_middle() {
        for toward in [[0.3_f32, -0.2, 0.0], [2.0, 0.5, 0.0], [-40.0, 0.0, 0.0]] {
            for place in [[0.0, 0.0], [0.5, -0.25], [-0.1, 0.9]] {
                let Chosen { toward: way, weight } =
                    choose_of_disc((FACING.as_vec3(), 0.5), toward, place);
                assert_eq!(way, toward, "{place:?}");
                assert!(weight.is_finite(), "{toward:?}, {place:?}: {weight}");
            }
        }
    }
}
