//! What shading needs of a surface besides its geometry, of one surface or of eight.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};
use phong_bvh::{Hit, Hits8, lanes};
use phong_scene::Rgb;

use super::View;
use crate::math::Dir3;
use crate::math::lanes::{Lanes3, dot, load3, select3, set, splat3, store3};

/// What shading needs of a surface besides its geometry.
pub(super) struct Shading {
    /// Shading normal, on the side of the eye.
    pub(super) n: Dir3,
    /// Number of the material.
    pub(super) material: u32,
    /// The diffuse colour, if the geometry brings one.
    pub(super) color: Option<Rgb>,
}

/// What shading needs of eight surfaces besides their geometry, number by number.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Shading8 {
    /// Shading normals, on the side of the eye.
    pub(crate) n: Lanes3,
    /// The diffuse colours.
    pub(crate) color: Lanes3,
    /// Numbers of the materials.
    pub(crate) material: [u32; 8],
}

impl Shading8 {
    pub(crate) const NONE: Self = Self { n: [[0.0; 8]; 3], color: [[0.0; 8]; 3], material: [0; 8] };
}

impl View {
    /// What shading needs of the surface at a hit whose geometric normal is `ng`; `e` leads to the
    /// eye.
    pub(super) fn shading(&self, hit: &Hit, ng: Dir3, e: Dir3) -> Shading {
        let local = hit.prim;
        let batch = self.geometry.batch(hit.part);
        let material = batch.material(local);
        let corners = self.geometry.corners(hit.part, local);
        let n = corners.and_then(|c| batch.normal(local, c, hit)).unwrap_or(ng);
        let color = batch.color(local, corners, hit);
        Shading { n: n.facing(e), material, color }
    }

    /// Whether the geometry brings the colour at a hit, which counts before the material's.
    pub(super) fn has_own_color(&self, hit: &Hit) -> bool {
        let corners = self.geometry.corners(hit.part, hit.prim);
        self.geometry.batch(hit.part).color(hit.prim, corners, hit).is_some()
    }

    /// [`View::shading`] of those of eight surfaces that were met: the same bits, with the
    /// material's colour where the geometry brings none.
    #[inline(always)]
    pub(crate) fn shading8<S: Simd>(
        &self,
        simd: S,
        hits: &Hits8,
        ng: [f32x8<S>; 3],
        e: [f32x8<S>; 3],
        shading: &mut Shading8,
    ) {
        let Shading8 { n, color, material } = shading;
        let zero = f32x8::splat(simd, 0.0);
        *n = store3(ng);
        let mut left = hits.met;
        while left != 0 {
            // Neighbours are mostly of one part.
            let part = hits.part[left.trailing_zeros() as usize & 7];
            let batch = self.geometry.batch(part);
            let parts = u32x8::load_array_ref(simd, &hits.part);
            let same = left & parts.simd_eq(u32x8::splat(simd, part)).to_bitmask() as u32;
            left &= !same;
            if let (Some(number), true) = (batch.only_material(), batch.is_plain()) {
                let own = splat3(zero, self.materials[number as usize].color.to_array());
                // What is in lanes without a hit is unspecified.
                let lanes = if same == hits.met { 0xff } else { same };
                let lanes = mask32x8::from_bitmask(simd, lanes.into());
                *color = store3(select3(lanes, own, load3(simd, color)));
                let old = u32x8::load_array_ref(simd, material);
                lanes.select(u32x8::splat(simd, number), old).store_array(material);
                continue;
            }
            for lane in lanes(same) {
                let (hit, local) = (hits.get(lane), hits.prim[lane]);
                let corners = self.geometry.corners(part, local);
                let own = batch.material(local);
                material[lane] = own;
                let own = self.materials[own as usize].color;
                set(color, lane, batch.color(local, corners, &hit).unwrap_or(own).to_array());
                if let Some(normal) = corners.and_then(|c| batch.normal(local, c, &hit)) {
                    set(n, lane, normal.to_array());
                }
            }
        }
        let up = load3(simd, n);
        let away = dot(up, e).simd_lt(zero);
        *n = store3(select3(away, [-up[0], -up[1], -up[2]], up));
    }
}
