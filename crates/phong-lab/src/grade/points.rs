//! What every pixel's centre ray meets: the ingredients that a renderer puts into the equation.

use std::sync::Arc;

use glam::DVec3;
use phong::explain::listen;
use phong::interaction::SurfaceInteraction;
use phong::material::Material;
use phong::math::Dir3;
use phong::render::RenderOptions;
use phong::terms::Terms;
use phong::texture::TexturePoint;
use phong::view::View;
use phong::witness::{Branch, Cut, Faded, LightContribution, Witness};
use phong_bvh::Ray;
use phong_scene::{ConstantMaterial, FilterKind, Rgb};
use rayon::prelude::*;

/// What one pixel is made of.
#[derive(Clone, Debug, Default)]
pub(super) struct Point {
    /// The terms as they are in the sum, but for what lights add.
    pub(super) terms: Terms,
    /// What the ray met.
    pub(super) surface: Option<Surface>,
    /// What fog leaves of the sum, and what it adds; `None`: there is none.
    pub(super) fog: Option<(f32, Rgb)>,
}

/// A material as it is at a surface: as it was written, and ready for light.
#[derive(Debug)]
pub(super) struct MaterialHere {
    pub(super) written: ConstantMaterial,
    pub(super) ready: Material,
}

impl MaterialHere {
    pub(super) fn new(scene: &View, number: u32, point: &TexturePoint) -> Self {
        let written = scene.written_at(number, point);
        Self { written, ready: scene.material_at(number, point) }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) object: u32,
    /// The material's number, from 0.
    pub(super) number: u32,
    pub(super) material: Arc<MaterialHere>,
    pub(super) p: DVec3,
    pub(super) n: Dir3,
    /// The normal as the surface has it: what a program uses that never turns it to the ray.
    pub(super) ng: Dir3,
    pub(super) e: Dir3,
    /// How far the eye is.
    pub(super) to_eye: f32,
    pub(super) tangent: Dir3,
    pub(super) color: Rgb,
    /// The ambient term as it is in the sum, per-light parts included.
    pub(super) ambient: Rgb,
    /// What of the ambient light finds its way here, or of a sky's: a factor of the ambient term.
    pub(super) openness: Rgb,
    pub(super) lights: Vec<LightPoint>,
}

/// One light at one point.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a ray's answer")]
pub(super) struct LightPoint {
    /// Its number, from 0.
    pub(super) number: usize,
    pub(super) l: Dir3,
    pub(super) distance: f32,
    /// Attenuated.
    pub(super) color: Rgb,
    pub(super) specular_color: Rgb,
    /// Above the horizon.
    pub(super) above: bool,
    /// Above, and nothing between.
    pub(super) visible: bool,
    /// Above, and nothing in its direction, however far.
    pub(super) clear: bool,
    /// Nothing between, above the horizon or not.
    pub(super) reached: bool,
    /// Nothing in the opposite direction, as far as the light is.
    pub(super) away: bool,
    /// Nothing in the opposite direction, however far.
    pub(super) away_endless: bool,
}

/// Which rays objects can block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Casting<'a> {
    pub(super) view: &'a View,
    pub(super) shadows: bool,
}

impl Casting<'_> {
    /// Whether nothing is in the way of a light's ray from a point.
    pub(super) fn free(self, light: usize, at: &SurfaceInteraction, dir: Dir3, far: f32) -> bool {
        let casts = self.shadows && self.view.lights()[light].shadows;
        !(casts && self.view.world().occluded(&at.spawn(dir, far)))
    }

    /// A light at a point where it sends `sample`, and is seen as told.
    pub(super) fn light(
        self,
        number: usize,
        at: &SurfaceInteraction,
        sample: &phong::light::LightSample,
        [above, visible]: [bool; 2],
    ) -> LightPoint {
        let (l, distance) = (sample.l, sample.distance);
        let point_light = self.view.written_lights()[number].kind.position().is_some();
        let free = |dir, far| self.free(number, at, dir, far);
        let away = free(-l, distance);
        LightPoint {
            number,
            l,
            distance,
            color: sample.color,
            specular_color: sample.specular_color,
            above,
            visible,
            clear: visible && (!point_light || free(l, f32::INFINITY)),
            reached: if above { visible } else { free(l, distance) },
            away,
            away_endless: away && (!point_light || free(-l, f32::INFINITY)),
        }
    }
}

/// Materials that are the same everywhere on their surfaces; `None`: those with a texture.
pub(super) fn shared(scene: &View) -> Vec<Option<Arc<MaterialHere>>> {
    let everywhere = |(number, written): (usize, &phong_scene::Material)| {
        let here = || MaterialHere::new(scene, number as u32, &TexturePoint::default());
        written.textured().is_empty().then(|| Arc::new(here()))
    };
    scene.written_materials().iter().enumerate().map(everywhere).collect()
}

/// The points of a whole picture, row by row.
pub(super) fn gather(scene: &View, options: &RenderOptions) -> Vec<Point> {
    let [width, height] = options.size();
    let all: Vec<usize> = (0..width as usize * height as usize).collect();
    gather_at(scene, options, &all)
}

/// The points of these pixels, numbered row by row.
pub(super) fn gather_at(scene: &View, options: &RenderOptions, pixels: &[usize]) -> Vec<Point> {
    // One sample is in the middle of its pixel whatever the filter, and this one is soonest made.
    let centre = options.one_sample().with_filter(FilterKind::Box);
    let width = options.size()[0];
    let shared = &*shared(scene);
    let casting = Casting { view: scene, shadows: options.shadows() };
    let at = |&i: &usize| {
        let mut listener =
            Listener { casting, shared, weights: Vec::new(), point: Point::default(), at: None };
        let pixel = [i as u32 % width, i as u32 / width];
        // Within the picture, so there is nothing that can be outside.
        let _ = listen(scene, &centre, pixel, 0, &mut listener);
        listener.point
    };
    pixels.par_iter().with_min_len(64).map(at).collect()
}

/// A surface that a ray met, before any light.
pub(super) fn surface(
    view: &View,
    shared: &[Option<Arc<MaterialHere>>],
    ray: &Ray,
    at: &SurfaceInteraction,
    ambient: Rgb,
) -> Surface {
    // A tangent is of unit length; whatever else it were would have no direction.
    let tangent = view.coordinates(ray, &at.hit).tangent.to_array();
    Surface {
        object: view.object(&at.hit),
        number: at.material,
        material: shared[at.material as usize].clone().unwrap_or_else(|| {
            let point = view.texture_point_of(ray, at);
            Arc::new(MaterialHere::new(view, at.material, &point))
        }),
        p: at.p,
        n: at.n,
        ng: at.ng,
        e: at.e,
        to_eye: at.hit.t,
        tangent: Dir3::from_array(tangent).unwrap_or(Dir3::X),
        color: at.color,
        ambient,
        openness: Rgb::WHITE,
        lights: Vec::with_capacity(view.lights().len()),
    }
}

/// Listens to the first hit of one ray.
struct Listener<'a> {
    casting: Casting<'a>,
    /// The materials that are the same everywhere.
    shared: &'a [Option<Arc<MaterialHere>>],
    /// Weights of the rays on their way below the camera's.
    weights: Vec<Rgb>,
    point: Point,
    at: Option<SurfaceInteraction>,
}

impl Witness for Listener<'_> {
    fn missed(&mut self, _: &Ray, background: Rgb) {
        if self.weights.is_empty() {
            self.point.terms.background = background;
        }
    }

    fn saw(&mut self, _: &Ray, _: usize, _: f32, emission: Rgb) {
        if self.weights.is_empty() {
            self.point.terms.emission = emission;
        }
    }

    fn met(&mut self, ray: &Ray, at: &SurfaceInteraction, terms: Terms) {
        if self.weights.is_empty() {
            self.point.terms = terms;
            self.point.surface =
                Some(surface(self.casting.view, self.shared, ray, at, terms.ambient));
            self.at = Some(*at);
        }
    }

    fn opened(&mut self, share: f32) {
        if let (true, Some(surface)) = (self.weights.is_empty(), &mut self.point.surface) {
            surface.openness = Rgb::grey(share);
        }
    }

    fn lit_by_sky(&mut self, light: Rgb) {
        if let (true, Some(surface)) = (self.weights.is_empty(), &mut self.point.surface) {
            surface.openness = light;
        }
    }

    fn faded(&mut self, told: &Faded) {
        if self.weights.is_empty() {
            self.point.fog = Some((told.clear, told.light));
        }
    }

    fn lit(&mut self, told: &LightContribution) {
        let (true, Some(surface), Some(sample), Some(at)) =
            (self.weights.is_empty(), &mut self.point.surface, told.sample, &self.at)
        else {
            return;
        };
        let ambient = self.casting.view.ambient();
        let more = surface.material.ready.ambient_of_light(surface.color, ambient, &sample);
        surface.ambient += more * surface.openness;
        let seen = [told.above, told.visible];
        surface.lights.push(self.casting.light(told.light, at, &sample, seen));
    }

    fn entered(&mut self, _: Branch, weight: Rgb, _: Option<f32>, _: &Ray) {
        self.weights.push(weight);
    }

    fn left(&mut self, branch: Branch, light: Rgb) {
        let Some(weight) = self.weights.pop() else { return };
        if self.weights.is_empty() {
            self.point.terms[branch.term()] += weight * light;
        }
    }

    fn cut(&mut self, _: Branch, _: &Cut) {}
}
