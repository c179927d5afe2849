//! What every pixel's centre ray meets: the ingredients that a renderer puts into the equation.

use std::sync::Arc;

use phong::explain::listen;
use phong::interaction::SurfaceInteraction;
use phong::material::Material;
use phong::math::Dir3;
use phong::render::RenderOptions;
use phong::terms::Terms;
use phong::texture::TexturePoint;
use phong::view::View;
use phong::witness::{Branch, Cut, LightContribution, Witness};
use phong_bvh::Ray;
use phong_scene::{ConstantMaterial, FilterKind, LightKind, Rgb};
use rayon::prelude::*;

/// What one pixel is made of.
#[derive(Clone, Debug, Default)]
pub(super) struct Point {
    /// The terms as they are in the sum, but for what lights add.
    pub(super) terms: Terms,
    /// What the ray met.
    pub(super) surface: Option<Surface>,
}

/// A material as it is at a surface: as it was written, and ready for light.
#[derive(Debug)]
pub(super) struct MaterialHere {
    pub(super) written: ConstantMaterial,
    pub(super) ready: Material,
}

impl MaterialHere {
    fn new(scene: &View, number: u32, point: &TexturePoint) -> Self {
        let written = scene.written_at(number, point);
        Self { written, ready: scene.material_at(number, point) }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) object: u32,
    pub(super) material: Arc<MaterialHere>,
    pub(super) n: Dir3,
    /// The normal as the surface has it: what a program uses that never turns it to the ray.
    pub(super) ng: Dir3,
    pub(super) e: Dir3,
    pub(super) tangent: Dir3,
    pub(super) color: Rgb,
    /// The ambient term as it is in the sum, per-light parts included.
    pub(super) ambient: Rgb,
    pub(super) lights: Vec<LightPoint>,
}

/// One light at one point.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightPoint {
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
}

/// The points of a whole picture, row by row.
pub(super) fn gather(scene: &View, options: &RenderOptions) -> Vec<Point> {
    // One sample is in the middle of its pixel whatever the filter, and this one is soonest made.
    let centre = options.one_sample().with_filter(FilterKind::Box);
    let [width, height] = options.size();
    let everywhere = |(number, written): (usize, &phong_scene::Material)| {
        let here = || MaterialHere::new(scene, number as u32, &TexturePoint::default());
        written.textured().is_empty().then(|| Arc::new(here()))
    };
    let shared: Vec<_> = scene.written_materials().iter().enumerate().map(everywhere).collect();
    let shared = &*shared;
    let row = |y: u32| {
        let centre = &centre;
        (0..width).map(move |x| {
            let mut listener =
                Listener { scene, shared, weights: Vec::new(), point: Point::default() };
            // Within the picture, so there is nothing that can be outside.
            let _ = listen(scene, centre, [x, y], 0, &mut listener);
            listener.point
        })
    };
    (0..height).into_par_iter().flat_map_iter(row).collect()
}

/// Listens to the first hit of one ray.
struct Listener<'a> {
    scene: &'a View,
    /// The materials that are the same everywhere.
    shared: &'a [Option<Arc<MaterialHere>>],
    /// Weights of the rays on their way below the camera's.
    weights: Vec<Rgb>,
    point: Point,
}

impl Witness for Listener<'_> {
    fn missed(&mut self, _: &Ray, background: Rgb) {
        if self.weights.is_empty() {
            self.point.terms.background = background;
        }
    }

    fn met(&mut self, ray: &Ray, at: &SurfaceInteraction, terms: Terms) {
        if self.weights.is_empty() {
            // A tangent is of unit length; whatever else it were would have no direction.
            let tangent = self.scene.coordinates(ray, &at.hit).tangent.to_array();
            self.point.terms = terms;
            self.point.surface = Some(Surface {
                object: self.scene.object(&at.hit),
                material: self.shared[at.material as usize].clone().unwrap_or_else(|| {
                    let point = self.scene.texture_point_of(ray, at);
                    Arc::new(MaterialHere::new(self.scene, at.material, &point))
                }),
                n: at.n,
                ng: at.ng,
                e: at.e,
                tangent: Dir3::from_array(tangent).unwrap_or(Dir3::X),
                color: at.color,
                ambient: terms.ambient,
                lights: Vec::with_capacity(self.scene.lights().len()),
            });
        }
    }

    fn lit(&mut self, told: &LightContribution) {
        let (true, Some(surface), Some(sample)) =
            (self.weights.is_empty(), &mut self.point.surface, told.sample)
        else {
            return;
        };
        surface.ambient +=
            surface.material.ready.ambient_of_light(surface.color, self.scene.ambient(), &sample);
        let endless = told.shadow.map(|ray| Ray { t_max: f32::INFINITY, ..ray });
        let point_light =
            !matches!(self.scene.written_lights()[told.light].kind, LightKind::Distant { .. });
        let clear = told.visible
            && !(point_light && endless.is_some_and(|ray| self.scene.world().occluded(&ray)));
        surface.lights.push(LightPoint {
            l: sample.l,
            distance: sample.distance,
            color: sample.color,
            specular_color: sample.specular_color,
            above: told.above,
            visible: told.visible,
            clear,
        });
    }

    fn entered(&mut self, _: Branch, weight: Rgb, _: Option<f32>, _: &Ray) {
        self.weights.push(weight);
    }

    fn left(&mut self, branch: Branch, light: Rgb) {
        let Some(weight) = self.weights.pop() else { return };
        if self.weights.is_empty() {
            self.point.terms[branch.term()] = weight * light;
        }
    }

    fn cut(&mut self, _: Branch, _: &Cut) {}
}
