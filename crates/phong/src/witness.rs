//! What the integrator reports while it traces a ray.

use phong_bvh::Ray;
use phong_scene::Rgb;

use crate::interaction::SurfaceInteraction;
use crate::light::LightSample;
use crate::reflectance::Incident;
use crate::terms::{Term, Terms};

/// Which ray goes on from a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// The mirror ray.
    Reflection,
    /// The refracted ray.
    Transmission,
    /// The ray that goes straight on, beside the share of a surface that is there.
    Through,
}

impl Branch {
    /// The term that the ray brings.
    pub const fn term(self) -> Term {
        match self {
            Self::Reflection => Term::Reflection,
            Self::Transmission | Self::Through => Term::Transmission,
        }
    }
}

/// A ray that is not sent on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// The weight it would have had at its surface.
    pub weight: Rgb,
    /// The reflectance F where it was asked for.
    pub fresnel: Option<f32>,
    /// The product of all weights from the camera on, this one included: what light of 1 there
    /// would have added to the sample.
    pub path_weight: Rgb,
    /// Why it is not sent.
    pub reason: CutReason,
}

/// Why a ray is not sent on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CutReason {
    /// The depth is used up.
    Depth,
    /// The product of all weights from the camera on is below this, in every channel.
    Weight(f32),
}

/// What happened with one light at one hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightContribution {
    /// Number of the light, from 0.
    pub light: usize,
    /// What it sends; `None` if the point is where the light is.
    pub sample: Option<LightSample>,
    /// The light tinted by the material.
    pub incident: Option<Incident>,
    /// Whether the light is above the horizon: that of N, and where things cast shadows, that of the
    /// geometric normal as well, but for smooth meshes whose shadow rays start above the face.
    pub above: bool,
    /// The ray that asked whether it is seen, from just above the surface to just before the light; `None`
    /// if none was needed.
    pub shadow: Option<Ray>,
    /// Whether that ray starts above the face, where the smooth surface is that a mesh's normals stand for.
    pub lifted: bool,
    /// Whether it is seen: above the horizon and nothing between.
    pub visible: bool,
    /// What is left of its light on the way, channel by channel: black if it is not seen, less than white
    /// behind what is see-through.
    pub visibility: Rgb,
    /// What it adds.
    pub terms: Terms,
}

/// What fog made of what a ray brought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Faded {
    /// How far from the eye the ray's end is, as the fog counts it; infinite where it met nothing.
    pub distance: f32,
    /// What is left of the light on this ray's own way: 1 − f, a factor of all that it brought.
    pub clear: f32,
    /// The fog's colour, linear.
    pub color: Rgb,
    /// What the fog adds: f times its colour.
    pub light: Rgb,
}

/// Receives what the integrator reports. Reports are in order, depth first, when one ray is traced
/// at a time. The rays of a bundle cannot be told apart, so trace one ray only.
///
/// `()` says nothing and costs nothing.
pub trait Witness {
    /// Whether reports are wanted. If not, they are not even worked out.
    const LISTENS: bool = true;

    /// A ray hit nothing and saw this background.
    fn missed(&mut self, ray: &Ray, background: Rgb);
    /// A ray saw the surface of this light, by its number, so far along it, and brought this emission.
    fn saw(&mut self, _ray: &Ray, _light: usize, _distance: f32, _emission: Rgb) {}
    /// A ray met a surface, with these terms, that belong to no light and to no ray that goes on.
    fn met(&mut self, ray: &Ray, at: &SurfaceInteraction, terms: Terms);
    /// This share of the surface just met is there; not told in scenes where nothing is see-through. What
    /// was told of its terms, and what lights add, counts that much.
    fn covered(&mut self, _share: f32) {}
    /// This share of the ambient light finds its way to the surface just met; not told in scenes that do
    /// not ask. What was told of it, and what lights add to its ambient term, counts that much.
    fn opened(&mut self, _share: f32) {}
    /// This light of the sky finds its way to the surface just met, as a matt surface weighs it; not told
    /// without a sky. What was told of the ambient term counts that much, in place of the share.
    fn lit_by_sky(&mut self, _light: Rgb) {}
    /// A light was asked for at the surface just met.
    fn lit(&mut self, light: &LightContribution);
    /// A ray goes on, with this weight; `fresnel` is the reflectance F where it was asked for.
    fn entered(&mut self, branch: Branch, weight: Rgb, fresnel: Option<f32>, ray: &Ray);
    /// It came back with this light, not yet weighted.
    fn left(&mut self, branch: Branch, light: Rgb);
    /// What the ray brought faded. What was told of it before is of what it was without fog.
    fn faded(&mut self, _faded: &Faded) {}
    /// A ray was not sent on: it brings black.
    fn cut(&mut self, branch: Branch, cut: &Cut);
}

impl Witness for () {
    const LISTENS: bool = false;

    fn missed(&mut self, _: &Ray, _: Rgb) {}
    fn met(&mut self, _: &Ray, _: &SurfaceInteraction, _: Terms) {}
    fn lit(&mut self, _: &LightContribution) {}
    fn entered(&mut self, _: Branch, _: Rgb, _: Option<f32>, _: &Ray) {}
    fn left(&mut self, _: Branch, _: Rgb) {}
    fn cut(&mut self, _: Branch, _: &Cut) {}
}
