//! What one light sends to one point.

mod angle;
mod area;
mod mesh;

use fearless_simd::{Simd, f32x8, f64x4, prelude::*};
use glam::{DVec3, Vec3};
use phong_bvh::{Lanes, halves};
use phong_scene::{LightKind, Rgb};

use crate::math::lanes::{add, dot, normalize, scale, splat3, sub};
use crate::math::{Dir3, wide};
use crate::sampling::concentric_disc;
use area::{Area, Chosen, choose_of_sphere};
use mesh::LuminousMesh;

/// The share of its way by which the surface of a light may lie behind another and still be seen: one that is
/// mounted in a ceiling is meant to be before it.
pub(crate) const MOUNTED: f32 = 4e-6;

/// A light in the world.
#[derive(Clone, Debug)]
pub struct Light {
    kind: Kind,
    color: Rgb,
    specular_color: Rgb,
    /// Whether things in between take its light away.
    pub shadows: bool,
    /// Whether it has an extent, so that its samples differ.
    pub soft: bool,
    /// How far from its position there is any of it; infinite: everywhere.
    range: f32,
    /// Radius of the sphere that holds all of it; 0 for a distant one.
    extent: f64,
    /// Whether rays see its surface.
    pub(crate) is_seen: bool,
}

#[derive(Clone, Debug)]
enum Kind {
    Distant { to_light: Dir3, half_angle_tan: f32 },
    Point { position: DVec3, attenuation: [f32; 3], radius: f32, cone: Option<Cone> },
    Area { position: DVec3, attenuation: [f32; 3], area: Area },
    Mesh { attenuation: [f32; 3], mesh: LuminousMesh },
}

#[derive(Clone, Debug)]
struct Cone {
    /// The way the light travels along the axis.
    axis: Dir3,
    /// Cosine of the half-angle of full light.
    full: f32,
    /// Cosine of the half-angle where it ends.
    none: f32,
    /// Cosine and sine of that angle.
    edge: [f64; 2],
}

/// What one light sends to one point, before the surface answers and whatever stands between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// To the light.
    pub l: Dir3,
    /// Distance to the light in scene units; infinite for a distant one.
    pub distance: f32,
    /// Its colour there, attenuated: what `C_{m,d}` is before the material. Linear.
    pub color: Rgb,
    /// Its specular colour there, attenuated. Linear.
    pub specular_color: Rgb,
}

impl LightSample {
    /// The same of which things on the way left so much, channel by channel.
    pub(crate) fn filtered(&self, left: Rgb) -> Self {
        let (color, specular_color) = (self.color * left, self.specular_color * left);
        Self { color, specular_color, ..*self }
    }
}

/// How a light reaches a point, or eight: without colours.
pub(crate) struct Reach<L, F> {
    /// To the light.
    pub(crate) l: L,
    /// Distance to the light.
    pub(crate) distance: F,
    /// The share of its colours that is left there.
    pub(crate) share: F,
}

impl Light {
    /// A light; where it is, is rounded to f32 about `center`. One that is a mesh gives nothing: only a
    /// [`View`](crate::view::View) knows its triangles.
    pub fn new(light: &phong_scene::Light, center: DVec3) -> Self {
        let (kind, size) = match light.kind {
            LightKind::Distant { direction, angle } => {
                let to_light = Dir3::from_unit((-direction).normalize_or(DVec3::Y).as_vec3());
                let half_angle_tan = wide::tan((angle / 2.0).to_radians()) as f32;
                (Kind::Distant { to_light, half_angle_tan }, angle)
            }
            LightKind::Point { position, attenuation, radius } => {
                (point(about(position, center), attenuation, radius, None), radius)
            }
            LightKind::Spot { position, target, cone, edge, attenuation, radius } => {
                let axis = Dir3::from_unit((target - position).normalize_or(-DVec3::Y).as_vec3());
                let [full, none] = [cone, edge].map(|a| wide::cos(a.to_radians()) as f32);
                let (sin, cos) = wide::sin_cos(edge.to_radians());
                let cone = Cone { axis, full, none, edge: [cos, sin] };
                (point(about(position, center), attenuation, radius, Some(cone)), radius)
            }
            LightKind::Rectangle { position, direction, up, width, height, attenuation } => {
                let area = Area::rectangle(direction, up, [width, height]);
                (surface(about(position, center), attenuation, area), light.kind.extent())
            }
            LightKind::Disc { position, direction, radius, attenuation } => (
                surface(about(position, center), attenuation, Area::disc(direction, radius)),
                radius,
            ),
            LightKind::Sphere { position, radius, attenuation } => {
                (surface(about(position, center), attenuation, Area::sphere(radius)), radius)
            }
            LightKind::Mesh { attenuation } => {
                let attenuation = attenuation.map(|a| a as f32);
                (Kind::Mesh { attenuation, mesh: LuminousMesh::default() }, 1.0)
            }
        };
        Self {
            kind,
            color: light.color,
            specular_color: light.specular_color,
            shadows: light.shadows,
            soft: size > 0.0,
            range: light.range.map_or(f32::INFINITY, |range| range as f32),
            extent: if light.kind.position().is_some() { size } else { 0.0 },
            is_seen: light.kind.has_surface() && light.visible,
        }
    }

    /// Gives a light that is a mesh its triangles.
    pub(crate) fn shine_from(&mut self, triangles: &[[DVec3; 3]]) {
        if let Kind::Mesh { mesh, .. } = &mut self.kind {
            *mesh = LuminousMesh::new(triangles);
        }
    }

    /// How far a surface that is a light may be from where it was written, by rounding about `center`.
    pub(crate) fn error(&self, center: DVec3) -> f32 {
        match &self.kind {
            Kind::Mesh { mesh, .. } => f32::EPSILON * mesh.reach_about(center) as f32,
            _ => 0.0,
        }
    }

    /// Whether there are places that it sends nothing to, wherever its horizon is.
    pub(crate) fn has_end(&self) -> bool {
        match &self.kind {
            Kind::Distant { .. } | Kind::Mesh { .. } => false,
            Kind::Point { cone, .. } => cone.is_some() || self.range < f32::INFINITY,
            Kind::Area { area, .. } => area.facing().is_some() || self.range < f32::INFINITY,
        }
    }

    /// Whether it may send anything into a box, given by its middle and half its size: never no where it
    /// sends some.
    pub(crate) fn may_reach(&self, [center, half]: [DVec3; 2]) -> bool {
        let Some(position) = self.position() else { return true };
        let (way, radius) = (center - position, half.length());
        let distance = way.length();
        // What rounding may make of it, many times over.
        if distance - radius > f64::from(self.range) * (1.0 + 1e-5) {
            return false;
        }
        let slack = radius + self.extent + 1e-3 * (distance + radius);
        match &self.kind {
            Kind::Point { cone: Some(cone), .. } => {
                let along = way.dot(cone.axis.to_vec().as_dvec3());
                let aside = (distance * distance - along * along).max(0.0).sqrt();
                let [cos, sin] = cone.edge;
                aside * cos - along * sin <= slack
            }
            Kind::Area { area, .. } => {
                let behind = |facing: Vec3| way.dot(facing.as_dvec3()) < -slack;
                !area.facing().is_some_and(behind)
            }
            Kind::Point { .. } | Kind::Distant { .. } | Kind::Mesh { .. } => true,
        }
    }

    /// How far rays go until they see its surface, eight of them; +∞ where they do not.
    #[inline(always)]
    pub(crate) fn meet8<S: Simd>(
        &self,
        simd: S,
        origin: &[[f64; 8]; 3],
        dir: [f32x8<S>; 3],
    ) -> f32x8<S> {
        match &self.kind {
            Kind::Area { area, .. } => {
                let [low, high] = self.toward8(simd, origin);
                area.meet(narrow(low, high), dir)
            }
            Kind::Point { .. } | Kind::Distant { .. } | Kind::Mesh { .. } => {
                dir[0].splat(f32::INFINITY)
            }
        }
    }

    /// How far one ray goes until it sees its surface; +∞ where it does not, or its surface is not seen.
    pub(crate) fn meet(&self, origin: DVec3, dir: Vec3) -> f32 {
        match &self.kind {
            Kind::Area { area, .. } if self.is_seen => {
                let toward = self.toward(origin.to_array()).map(|v| v as f32);
                area.meet(toward, dir.to_array())
            }
            _ => f32::INFINITY,
        }
    }

    /// How far a ray from `origin` towards `dir`, which is unit, may be moved along, at most `start`, and still
    /// see its surface.
    pub(crate) fn approach(&self, origin: DVec3, dir: DVec3, start: f64) -> f64 {
        let Some(position) = self.position().filter(|_| self.is_seen) else { return start };
        // Where the ray comes into a ball twice as large as the surface. It is found in f64; from there on f32
        // is exact enough to tell whether the surface is met.
        let way = position - origin;
        let along = way.dot(dir);
        let half = 4.0 * self.extent * self.extent - (way - along * dir).length_squared();
        let from = (along - half.max(0.0).sqrt()).max(0.0);
        if half <= 0.0 || from >= start {
            return start;
        }
        let t = self.meet(origin + from * dir, dir.as_vec3());
        if from + f64::from(t) < start { from } else { start }
    }

    /// Its own colour: that of its surface, where it has one. Linear.
    pub(crate) fn color(&self) -> Rgb {
        self.color
    }

    /// What it sends to `p`. `place` in [0, 1)² picks a point of a soft light, (½, ½) its centre.
    /// `None` if `p` is where the light is.
    pub fn sample(&self, p: DVec3, place: [f32; 2]) -> Option<LightSample> {
        self.reach(p, place).map(|reach| self.colored(reach))
    }

    /// What reaches a point, in its colours.
    pub(crate) fn colored(&self, Reach { l, distance, share }: Reach<Dir3, f32>) -> LightSample {
        let (color, specular_color) = (self.color * share, self.specular_color * share);
        LightSample { l, distance, color, specular_color }
    }

    /// How it reaches `p`, as [`Light::sample`] has it.
    pub(crate) fn reach(&self, p: DVec3, place: [f32; 2]) -> Option<Reach<Dir3, f32>> {
        let toward = self.toward(p.to_array()).map(|v| v as f32);
        let Reach { l, distance, share } = self.arrive(toward, self.soft.then_some(place));
        (l != [0.0; 3]).then(|| Reach { l: Dir3::from_unit(Vec3::from(l)), distance, share })
    }

    /// [`Light::reach`] of eight points: the same bits. `l` is 0 where the light is. `place`: of a
    /// soft light.
    #[inline(always)]
    pub(crate) fn reach8<S: Simd>(
        &self,
        simd: S,
        p: &[[f64; 8]; 3],
        place: Option<&[[f32; 8]; 2]>,
    ) -> Reach<[f32x8<S>; 3], f32x8<S>> {
        let [low, high] = self.toward8(simd, p);
        let place =
            place.map(|[u, v]| [f32x8::load_array_ref(simd, u), f32x8::load_array_ref(simd, v)]);
        self.arrive(narrow(low, high), place)
    }

    /// [`Light::toward`] from eight points, four by four.
    #[inline(always)]
    fn toward8<S: Simd>(&self, simd: S, p: &[[f64; 8]; 3]) -> [[f64x4<S>; 3]; 2] {
        let ([x, x_high], [y, y_high], [z, z_high]) =
            (halves(simd, &p[0]), halves(simd, &p[1]), halves(simd, &p[2]));
        [self.toward([x, y, z]), self.toward([x_high, y_high, z_high])]
    }

    /// The way from one point, or several, to where the light is, of a mesh to its middle; of a distant one unspecified.
    #[inline(always)]
    fn toward<F: Lanes<Scalar = f64>>(&self, p: [F; 3]) -> [F; 3] {
        let position = match &self.kind {
            Kind::Distant { .. } => return p,
            Kind::Point { position, .. } | Kind::Area { position, .. } => position,
            Kind::Mesh { mesh, .. } => &mesh.middle,
        };
        sub(splat3(p[0], position.to_array()), p)
    }

    /// How it reaches one point, or eight, given the way to where the light is, and of a soft light a place in
    /// the unit square; `l` is 0 where the light is.
    #[inline(always)]
    fn arrive<F: Lanes<Scalar = f32>>(
        &self,
        mut toward: [F; 3],
        place: Option<[F; 2]>,
    ) -> Reach<[F; 3], F> {
        let width = toward[0];
        match &self.kind {
            Kind::Mesh { attenuation, mesh } => {
                let middle = place.unwrap_or([width.splat(0.5); 2]);
                arrival(mesh.choose(toward, middle), *attenuation)
            }
            Kind::Distant { to_light, half_angle_tan } => {
                let mut l = splat3(width, to_light.to_array());
                if let Some(place) = place {
                    let aside = across(width.splat(*half_angle_tan), l, concentric_disc(place));
                    l = normalize(add(l, aside));
                }
                Reach { l, distance: width.splat(f32::INFINITY), share: width.splat(1.0) }
            }
            Kind::Point { attenuation, radius, cone, .. } => {
                let middle = toward;
                if let Some(place) = place {
                    toward = choose_of_sphere(*radius, toward, concentric_disc(place)).toward;
                }
                let Reach { l, distance, mut share } = arrival(toward, *attenuation);
                if let Some(cone) = cone {
                    let along = dot(splat3(width, cone.axis.to_array()), l);
                    share = share * along.map(|cos| cone.share(-cos));
                }
                Reach { l, distance, share: self.within(middle, share) }
            }
            Kind::Area { attenuation, area, .. } => {
                let chosen = match place {
                    Some(place) => area.choose(toward, place),
                    None => Chosen { toward, weight: width.splat(1.0) },
                };
                let Reach { l, distance, share } = arrival(chosen.toward, *attenuation);
                let mut share = share * chosen.weight;
                if let Some(facing) = area.facing() {
                    let lit = dot(toward, splat3(width, facing.to_array())).lt(width.splat(0.0));
                    share = F::select(lit, share, width.splat(0.0));
                }
                Reach { l, distance, share: self.within(toward, share) }
            }
        }
    }

    /// What is left of its share at a point from which its position is `toward`.
    #[inline(always)]
    fn within<F: Lanes<Scalar = f32>>(&self, toward: [F; 3], share: F) -> F {
        if self.range == f32::INFINITY {
            return share;
        }
        let zero = share.splat(0.0);
        let distance = dot(toward, toward).sqrt();
        F::select(distance.gt(share.splat(self.range)), zero, share)
    }

    /// Where it is, rounded as it is used; `None`: it is distant, or a mesh.
    pub(crate) fn position(&self) -> Option<DVec3> {
        match self.kind {
            Kind::Distant { .. } | Kind::Mesh { .. } => None,
            Kind::Point { position, .. } | Kind::Area { position, .. } => Some(position),
        }
    }

    /// The largest channel of its two colours; 0 for a light that gives none.
    pub(crate) fn brightest(&self) -> f32 {
        self.color.max_channel().max(self.specular_color.max_channel())
    }

    /// Its colour and its specular colour, before any is lost on the way. Linear.
    pub(crate) fn colors(&self) -> [Rgb; 2] {
        [self.color, self.specular_color]
    }
}

/// The direction of `toward`, which is 0 where there is none; its length; and the share of light
/// left at that distance: `1 / (c + k d + q d²)`.
#[inline(always)]
fn arrival<F: Lanes<Scalar = f32>>(toward: [F; 3], [c, k, q]: [f32; 3]) -> Reach<[F; 3], F> {
    let l = normalize(toward);
    let distance = dot(toward, l);
    let share = distance.splat(1.0) / (distance * k + c + distance * q * distance);
    Reach { l, distance, share }
}

impl Cone {
    /// The share of light at `cos` off the axis: 1 within the cone, 0 beyond the edge, between them
    /// smoothstep in the cosine.
    fn share(&self, cos: f32) -> f32 {
        if cos >= self.full {
            1.0
        } else if cos <= self.none {
            0.0
        } else {
            let t = (cos - self.none) / (self.full - self.none);
            t * t * (3.0 - 2.0 * t)
        }
    }
}

/// A place rounded to f32 about `center`: in scenes about the origin a number of f32.
fn about(position: DVec3, center: DVec3) -> DVec3 {
    (position - center).as_vec3().as_dvec3() + center
}

fn point(position: DVec3, attenuation: [f64; 3], radius: f64, cone: Option<Cone>) -> Kind {
    Kind::Point {
        position,
        attenuation: attenuation.map(|a| a as f32),
        radius: radius as f32,
        cone,
    }
}

fn surface(position: DVec3, attenuation: [f64; 3], area: Area) -> Kind {
    Kind::Area { position, attenuation: attenuation.map(|a| a as f32), area }
}

#[inline(always)]
fn narrow<S: Simd>(low: [f64x4<S>; 3], high: [f64x4<S>; 3]) -> [f32x8<S>; 3] {
    [low[0].narrow(high[0]), low[1].narrow(high[1]), low[2].narrow(high[2])]
}

/// A point, of the unit disc, of the disc of this radius perpendicular to `axis`. (The frame is that of Duff and others, *Building an orthonormal basis,
/// revisited*, 2017.)
#[inline(always)]
pub(crate) fn across<F: Lanes<Scalar = f32>>(
    radius: F,
    [x, y, z]: [F; 3],
    [u, v]: [F; 2],
) -> [F; 3] {
    let (zero, one) = (x.splat(0.0), x.splat(1.0));
    let sign = F::select(z.lt(zero), zero - one, one);
    let a = (zero - one) / (sign + z);
    let b = x * y * a;
    let first = [one + sign * x * x * a, sign * b, zero - sign * x];
    let second = [b, sign + y * y * a, zero - y];
    scale(radius, add(scale(u, first), scale(v, second)))
}

#[cfg(test)]
mod tests;
