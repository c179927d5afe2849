//! Shading normals that textures turn: by a map of normals, or by one of heights.

use glam::{DVec3, Vec3};
use phong_bvh::{Hit, Lanes, Ray};
use phong_scene::{NormalFormat, TextureRef, TextureUse};

use super::View;
use crate::math::lanes::{add, cross, dot, scale, select3, sub};
use crate::texture::TexturePoint;

/// What turns the normals of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Relief {
    pub(super) normal: Option<(TextureRef, NormalFormat)>,
    pub(super) bump: Option<TextureRef>,
}

/// How far above the surface a normal looks at least: the cosine to the geometric one.
const LEAST_COSINE: f64 = 0.01;

/// How far apart heights are asked for where a look-up stands for a point, in the object's own units.
const STEP: f64 = 1.0 / 1024.0;

impl Relief {
    /// That of a material; `None`: nothing turns its normals.
    pub(super) fn of(material: &phong_scene::Material) -> Option<Self> {
        let normal = material.normal.map(|by| (by, material.normal_format));
        let bump = material.bump;
        (normal.is_some() || bump.is_some()).then_some(Self { normal, bump })
    }
}

/// A surface whose normal is to be turned.
pub(super) struct Turned<'a> {
    pub(super) ray: &'a Ray,
    pub(super) hit: &'a Hit,
    pub(super) point: &'a TexturePoint,
    /// The shading normal, on the side of `front`.
    pub(super) n: Vec3,
    /// The geometric normal on the side that is seen.
    pub(super) front: Vec3,
    /// Whether the shading normal is not as the surface has it, but turned to the side that is seen.
    pub(super) is_flipped: bool,
}

impl View {
    /// What turns the normals of a material.
    #[inline]
    pub(super) fn relief(&self, material: u32) -> Option<Relief> {
        self.reliefs.get(material as usize).copied().flatten()
    }

    /// The shading normal where textures turn it, still on the side that is seen.
    pub(super) fn turned_normal(&self, relief: Relief, at: &Turned<'_>) -> Vec3 {
        let facing = at.n.as_dvec3();
        // The texture lies about the normal as the surface has it, whichever side is seen.
        let (own, side) = if at.is_flipped { (-facing, -1.0) } else { (facing, 1.0) };
        let Some([t, b]) = self.tangents_at(at, own) else { return at.n };
        let mut n = own;
        if let Some((by, format)) = relief.normal {
            let value = self.look_up(number(by), at.point).to_array();
            let value = mapped(value.map(f64::from), (by.scale.into(), format));
            let own = own.to_array();
            n = DVec3::from(turned(own, [t.to_array(), b.to_array()], value));
        }
        if let Some(by) = relief.bump {
            n = self.bumped(by, at, [t, b], n);
        }
        let n = raised((side * n).to_array(), at.front.as_dvec3().to_array(), facing.to_array());
        DVec3::from(n).as_vec3()
    }

    /// The normal of what the heights of a texture raise.
    fn bumped(&self, by: TextureRef, at: &Turned<'_>, across: [DVec3; 2], n: DVec3) -> DVec3 {
        let height = |point: &TexturePoint| {
            let value = self.look_up(number(by), point);
            f64::from(phong_scene::Param::<f32>::from(by).at(|_| value))
        };
        let here = height(at.point);
        let own = |v: DVec3| self.geometry.own_vector(at.hit, v).length();
        // As far as the look-up stands for, or a little way.
        let width = at.point.footprint.world[0].length();
        let mut slope = DVec3::ZERO;
        for direction in across {
            let scale = own(direction);
            if scale.is_nan() || scale <= 0.0 {
                continue;
            }
            let step = if width > 0.0 { width } else { STEP / scale };
            let beside = self.beside(at, step * direction);
            slope += (height(&beside) - here) / (step * scale) * direction;
        }
        (n - slope).normalize_or(n)
    }

    /// Where textures are that far along the surface.
    fn beside(&self, at: &Turned<'_>, by: DVec3) -> TexturePoint {
        let [du, _] = self.uv_changes(at.ray, at.hit, [by, by]);
        let TexturePoint { object, world, uv, .. } = *at.point;
        TexturePoint {
            object: object + self.geometry.own_vector(at.hit, by),
            world: world + by,
            uv: [uv[0] + du.x as f32, uv[1] + du.y as f32],
            ..*at.point
        }
    }

    /// The directions in which u and v grow, unit and at right angles to `n`; `None`: there are none.
    fn tangents_at(&self, at: &Turned<'_>, n: DVec3) -> Option<[DVec3; 2]> {
        let tangents = self.tangents.get(at.hit.part as usize).and_then(Option::as_ref);
        let of_mesh = tangents.filter(|_| self.cap(at.hit).is_none());
        let (t, hand) = match of_mesh.and_then(|all| self.geometry.tangent(at.hit, all)) {
            Some((t, hand)) => (t, Some(hand)),
            None => (Vec3::from(at.point.tangent).as_dvec3(), None),
        };
        let (is_there, [t, b]) = frame(t.to_array(), n.to_array());
        if !is_there {
            return None;
        }
        let [t, b] = [t, b].map(DVec3::from);
        // Where the surface itself says no hand, v is asked which way it grows.
        let hand = hand.unwrap_or_else(|| {
            let [_, change] = self.uv_changes(at.ray, at.hit, [t, b]);
            if change.y < 0.0 { -1.0 } else { 1.0 }
        });
        Some([t, hand * b])
    }
}

/// The direction of `t` at right angles to `n`, unit, and the one at right angles to both; and whether there are some.
#[inline(always)]
pub(super) fn frame<F: Lanes<Scalar = f64>>(t: [F; 3], n: [F; 3]) -> (F::Mask, [[F; 3]; 2]) {
    let t = sub(t, scale(dot(t, n), n));
    let (is_there, t) = unit(t);
    (is_there, [t, cross(n, t)])
}

/// What a map of normals shows, of −1 to 1 along the tangents and the normal: its `value` is from 0 to 1.
#[inline(always)]
pub(super) fn mapped<F: Lanes<Scalar = f64>>(
    value: [F; 3],
    (strength, format): (f64, NormalFormat),
) -> [F; 3] {
    let [x, y, z] = [value[0] * 2.0 - 1.0, value[1] * 2.0 - 1.0, value[2] * 2.0 - 1.0];
    let y = if format == NormalFormat::DirectX { -y } else { y };
    [x * strength, y * strength, z]
}

/// The normal that a map shows about the surface's own.
#[inline(always)]
pub(super) fn turned<F: Lanes<Scalar = f64>>(
    own: [F; 3],
    [t, b]: [[F; 3]; 2],
    [x, y, z]: [F; 3],
) -> [F; 3] {
    unit_or(add(add(scale(x, t), scale(y, b)), scale(z, own)), own)
}

/// A normal that looks at least a little above the surface, whose geometric normal on that side is `front`, unit;
/// `facing` where it has no direction.
#[inline(always)]
pub(super) fn raised<F: Lanes<Scalar = f64>>(n: [F; 3], front: [F; 3], facing: [F; 3]) -> [F; 3] {
    let up = dot(n, front);
    let least = up.splat(LEAST_COSINE);
    let n = select3(up.lt(least), add(n, scale(least - up, front)), n);
    unit_or(n, facing)
}

/// `v` made unit, and whether it has a direction.
#[inline(always)]
fn unit<F: Lanes<Scalar = f64>>(v: [F; 3]) -> (F::Mask, [F; 3]) {
    let shrink = v[0].splat(1.0) / dot(v, v).sqrt();
    let has_direction = shrink.gt(shrink.splat(0.0)) & shrink.lt(shrink.splat(f64::INFINITY));
    (has_direction, scale(shrink, v))
}

#[inline(always)]
fn unit_or<F: Lanes<Scalar = f64>>(v: [F; 3], or: [F; 3]) -> [F; 3] {
    let (has_direction, unit) = unit(v);
    select3(has_direction, unit, or)
}

/// What a map of normals or heights is asked for: numbers as they are.
pub(super) fn number(by: TextureRef) -> TextureUse {
    TextureUse { texture: by.texture, channel: by.channel, is_color: false }
}
