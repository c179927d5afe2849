//! The cylinder x² + y² = 1, 0 ≤ z ≤ 1.
//!
//! A line is inside the endless cylinder where, seen along the axis, it is inside the unit circle.
//! With o and d meaning their x and y alone, and `a = d·d`, `b = o·d`, `c = o·o − 1`:
//! `a t² + 2 b t + c ≤ 0`. The discriminant `b² − a c` is `d·d − (o_x d_y − o_y d_x)²`, which does not
//! subtract large numbers from one another; neither does [`quadratic`], even where the line all but
//! follows the axis (a near 0). Where it does follow the axis, it is inside everywhere or nowhere.
//!
//! Faces: 0 the side, 1 the cap at z = 0, 2 the cap at z = 1. Without caps the side is met from
//! within as well. Coordinates of the side: u = angle / 2π from the x axis towards the y axis, v = z;
//! of the caps: see [`disc`].

use glam::{DVec2, DVec3};

use super::{
    crossing::{Crossings, Line, Span, quadratic},
    disc,
    patch::{Patch, turn},
};

/// The crossings of a line and the cylinder.
pub(super) fn crossings(line: &Line, capped: bool) -> Crossings {
    let Some(round) = around(line, 1.0) else { return Crossings::NONE };
    if capped {
        let between = Span::slab(line.o.z, line.d.z, [0.0, 1.0], [1, 2]);
        return between.and_then(|between| between.and(round)).into();
    }
    let mut crossings = Crossings::NONE;
    for t in round.ends() {
        if (0.0..=1.0).contains(&line.at(t).z) {
            crossings.push(t, 0);
        }
    }
    crossings
}

/// The part of a line inside the endless cylinder of `radius`.
pub(super) fn around(line: &Line, radius: f64) -> Option<Span> {
    let (o, d) = (line.o.truncate(), line.d.truncate());
    let (a, b, c) = (d.length_squared(), o.dot(d), o.length_squared() - radius * radius);
    if a == 0.0 {
        return (c <= 0.0).then_some(Span::WHOLE);
    }
    let across = o.perp_dot(d);
    let [enter, leave] = quadratic(a, b, c, a * radius * radius - across * across)?;
    Some(Span::new(enter, leave, 0))
}

/// The side around the point `p`, or one of the caps.
pub(super) fn patch(p: DVec3, face: u8) -> Patch {
    match face {
        1 => disc::patch(p, 0.0, 1.0, false),
        2 => disc::patch(p, 1.0, 1.0, true),
        _ => {
            let n = p.truncate().normalize_or(DVec2::X).extend(0.0);
            let z = p.z.clamp(0.0, 1.0);
            Patch {
                p: DVec3::new(n.x, n.y, z),
                normal: n,
                tangent: DVec3::new(-n.y, n.x, 0.0),
                uv: DVec2::new(turn(n.y, n.x), z),
                curvature: 1.0,
            }
        }
    }
}
