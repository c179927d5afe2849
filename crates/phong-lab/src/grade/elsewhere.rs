//! Pictures whose rays go elsewhere, or end elsewhere, than those of the right one.

use glam::DVec2;
use phong::interaction::SurfaceInteraction;
use phong::math::Dir3;
use phong::terms::Terms;
use phong_bvh::Ray;
use phong_scene::{Background, Rgb, Scene, Shape};
use rayon::prelude::*;

use super::picture::alike;
use super::points::{Casting, MaterialHere, Point, shared, surface};
use super::prepared::Prepared;

/// Where a pixel's ray passes through the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lens {
    /// Pixels, added to the pixel's middle.
    pub(super) shift: [f64; 2],
    /// What the way from the picture's middle is multiplied by.
    pub(super) scale: [f64; 2],
}

impl Default for Lens {
    fn default() -> Self {
        Self { shift: [0.0; 2], scale: [1.0; 2] }
    }
}

impl Lens {
    fn place(&self, pixel: [i64; 2], size: [u32; 2]) -> DVec2 {
        let along = |axis: usize| {
            let middle = f64::from(size[axis]) / 2.0;
            let own = pixel[axis] as f64 + 0.5 + self.shift[axis];
            middle + (own - middle) * self.scale[axis]
        };
        DVec2::new(along(0), along(1))
    }
}

/// How rays go elsewhere.
#[derive(Clone, Debug)]
pub(super) enum Way {
    Lens(Lens),
    Camera(phong_scene::Camera),
    /// They end where they leave spheres.
    FarRoot {
        /// Whether N leaves the sphere, or else faces the ray.
        outward: bool,
    },
}

/// What a ray met.
struct Met {
    /// Where it started last.
    ray: Ray,
    at: SurfaceInteraction,
    /// From where it started first.
    distance: f32,
    /// Whether it is a sphere, met where the ray leaves it.
    sphere: bool,
}

/// Traces rays that go elsewhere.
pub(super) struct Elsewhere<'a> {
    right: &'a Prepared,
    way: &'a Way,
    camera: phong::camera::Camera,
    materials: Vec<Option<std::sync::Arc<MaterialHere>>>,
    /// Of each object, whether it is a sphere; empty where the numbers are not the text's.
    spheres: Vec<bool>,
}

impl<'a> Elsewhere<'a> {
    pub(super) fn new(right: &'a Prepared, scene: &Scene, way: &'a Way) -> Self {
        let camera = match way {
            Way::Camera(camera) => phong::camera::Camera::new(camera),
            _ => right.view.camera().clone(),
        };
        let known = scene.groups.is_empty();
        let is_sphere = |o: &phong_scene::Object| matches!(o.shape, Shape::Sphere { .. });
        let spheres = scene.objects.iter().filter(|_| known).map(is_sphere).collect();
        Self { right, way, camera, materials: shared(&right.view), spheres }
    }

    /// What the rays of these pixels meet; `None`: that cannot be told.
    pub(super) fn trace(&self, pixels: &[usize]) -> Vec<Option<Point>> {
        pixels.par_iter().with_min_len(32).map(|&i| self.at(i, [0, 0])).collect()
    }

    /// Whether those around a pixel meet the same as `point`, which its own ray met.
    pub(super) fn is_inner(&self, i: usize, point: &Point) -> bool {
        [[-1, 0], [1, 0], [0, -1], [0, 1]].into_iter().all(|off| {
            self.at(i, off)
                .is_some_and(|other| alike(point.surface.as_ref(), other.surface.as_ref()))
        })
    }

    fn at(&self, i: usize, off: [i64; 2]) -> Option<Point> {
        let size = self.right.size;
        let (x, y) = (i as u32 % size[0], i as u32 / size[0]);
        let pixel = [i64::from(x) + off[0], i64::from(y) + off[1]];
        let lens = match self.way {
            Way::Lens(lens) => *lens,
            _ => Lens::default(),
        };
        let ray = self.camera.ray(lens.place(pixel, size), size, [0.5; 2])?;
        match self.meet(&ray) {
            Some(met) => self.point(&met),
            None => match self.right.view.background() {
                Background::Color(background) => Some(Point {
                    terms: Terms { background, ..Terms::default() },
                    ..Point::default()
                }),
                _ => None,
            },
        }
    }

    fn meet(&self, ray: &Ray) -> Option<Met> {
        let view = &self.right.view;
        let hit = view.world().intersect(ray);
        if !hit.t.is_finite() {
            return None;
        }
        let first = view.interaction(ray, &hit);
        if !matches!(self.way, Way::FarRoot { .. }) {
            let distance = first.hit.t;
            return Some(Met { ray: *ray, at: first, distance, sphere: false });
        }
        // Of spheres the last hit on the ray's way, of all else the first; the nearest of these.
        let dir = Dir3::new(ray.dir)?;
        let mut met: Vec<(u32, Met)> = Vec::new();
        let (mut ray_on, mut at) = (*ray, first);
        for _ in 0..MOST_HITS {
            let object = view.object(&at.hit);
            let sphere = self.spheres.get(object as usize).copied().unwrap_or(false);
            let distance = at.p.distance(ray.origin) as f32;
            let one = Met { ray: ray_on, at, distance, sphere };
            match met.iter_mut().find(|(other, _)| *other == object) {
                Some((_, former)) if sphere => *former = one,
                Some(_) => {}
                None => met.push((object, one)),
            }
            ray_on = at.spawn(dir, f32::INFINITY);
            let hit = view.world().intersect(&ray_on);
            if !hit.t.is_finite() {
                break;
            }
            at = view.interaction(&ray_on, &hit);
        }
        let nearest = met.into_iter().min_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        nearest.map(|(_, met)| met)
    }

    fn point(&self, met: &Met) -> Option<Point> {
        let Met { ray, mut at, distance, sphere: far } = *met;
        let view = &self.right.view;
        if far && matches!(self.way, Way::FarRoot { outward: true }) {
            at.n = at.ng;
        }
        let mut met = surface(view, &self.materials, &ray, &at, Rgb::BLACK);
        met.to_eye = distance;
        let material = std::sync::Arc::clone(&met.material);
        if material.ready.bounces() {
            return None;
        }
        let ambient = view.ambient();
        met.ambient = material.ready.ambient(met.color, ambient);
        let casting = Casting { view, shadows: self.right.options.shadows() };
        for (number, light) in view.lights().iter().enumerate() {
            let Some(sample) = light.sample(at.p, [0.5; 2]) else { continue };
            met.ambient += material.ready.ambient_of_light(met.color, ambient, &sample);
            let facing = if at.n == at.ng { at.ng } else { at.facing_ng() };
            let above = at.n.dot(sample.l) > 0.0 && facing.dot(sample.l) > 0.0;
            let free = above && casting.free(number, &at, sample.l, sample.distance);
            met.lights.push(casting.light(number, &at, &sample, [above, free]));
        }
        let written = &material.written;
        let emission = written.emission_color.unwrap_or(met.color) * written.k_e;
        let terms = Terms { ambient: met.ambient, emission, ..Terms::default() };
        Some(Point { terms, surface: Some(met), fog: None })
    }
}

/// More surfaces than these on a ray's way are not looked through.
const MOST_HITS: usize = 24;
