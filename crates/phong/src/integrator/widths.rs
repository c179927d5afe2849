//! How wide rays are where they meet a surface: what a look-up of an image stands for.
//!
//! Each ray knows it by itself, from the camera, the picture's size and its number of samples, and from the
//! surfaces that it came by: never from the rays beside it, which another crop, tile or pass does not have.

use glam::Vec3;
use phong_bvh::{Hits8, Rays8, lanes};

use super::interactions::Interactions;
use super::optics::Scattered8;
use super::{Integrator, Paths};
use crate::math::lanes::{direction, get};
use crate::texture::Cone;
use crate::witness::Branch;

/// The pixels that a picture has, and the samples that each of them is the mean of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampleGrid {
    /// Width and height of the picture.
    pub(crate) size: [u32; 2],
    /// Samples of each pixel, when all is done.
    pub(crate) samples: u32,
}

/// How grazing refraction counts at most: the least cosine.
const LEAST_COSINE: f32 = 1e-2;

impl Integrator<'_> {
    /// Finds out how wide rays are where they meet something: of each in `widths`, by its lane.
    pub(super) fn measure_widths(
        &self,
        rays: &[Rays8],
        hits: &[Hits8],
        paths: &Paths,
        widths: &mut Vec<[f32; 8]>,
    ) {
        let camera = self.scene.camera();
        let SampleGrid { size, samples } = self.grid;
        for (i, (rays, hits)) in rays.iter().zip(hits).enumerate() {
            let mut eight = [0.0; 8];
            for lane in lanes(hits.met) {
                let behind = paths.cones.get(8 * i + lane).copied();
                let dir = direction(&rays.dir, lane).to_vec();
                let ray = rays.get(lane);
                // A ray from the camera may start further on, where there is something to meet.
                let before = if behind.is_none() {
                    (ray.origin - camera.eye()).length() as f32
                } else {
                    0.0
                };
                let cone = behind.unwrap_or_else(|| camera.cone(dir, size, samples));
                eight[lane] = cone.after(before + hits.t[lane]).width;
            }
            widths.push(eight);
        }
    }

    /// The cone about a ray that goes on from a surface where the one before is `width` wide.
    ///
    /// Along that width the normal turns by the curvature. A mirror turns what is seen in it by twice as much. Where
    /// light is refracted, rays beside one another go on by Coddington's two equations, one across the plane of
    /// incidence and one within it; a cone is round, and takes the geometric mean of what they bring.
    pub(super) fn cone_on(
        &self,
        rays: &Rays8,
        interactions: &Interactions,
        behind: Option<Cone>,
        (i, lane): (usize, usize),
        (branch, scattered): (Branch, &Scattered8),
    ) -> Cone {
        let SampleGrid { size, samples } = self.grid;
        let width = interactions.widths[i][lane];
        let dir = direction(&rays.dir, lane).to_vec();
        let spread = if let Some(behind) = behind {
            behind.after(interactions.hits[i].t[lane]).spread
        } else {
            self.scene.camera().cone(dir, size, samples).spread
        };
        let [ng, front] = [&interactions.surfaces[i].ng, &interactions.shading[i].front]
            .map(|all| Vec3::from(get(all, lane)));
        let turn = || {
            let curvature = self.scene.curvature(&interactions.hits[i].get(lane), ng);
            width * if ng.dot(front) < 0.0 { -curvature } else { curvature }
        };
        match branch {
            Branch::Reflection => Cone { width, spread: spread + 2.0 * turn() },
            Branch::Transmission => {
                let eta = scattered.eta[lane];
                let [cos_i, cos_t] =
                    [dir, scattered.dir(lane)].map(|dir| (-dir.dot(front)).max(LEAST_COSINE));
                let bent = (cos_t - cos_i / eta) / (cos_i * cos_t).sqrt();
                let stretch = (cos_i / cos_t).sqrt();
                Cone { width: width / stretch, spread: spread * stretch / eta - turn() * bent }
            }
            Branch::Through => Cone { width, spread },
        }
    }
}
