//! Where mirror and glass rays go, and what they weigh.

use glam::Vec3;
use phong_scene::Rgb;

use crate::interaction::SurfaceInteraction;
use crate::material::Material;
use crate::math::{Dir3, reflect};
use crate::reflectance::fresnel;

/// The index of refraction of the far side relative to the near one.
fn relative_ior(material: &Material, at: &SurfaceInteraction) -> f32 {
    if at.from_outside() { material.ior } else { 1.0 / material.ior }
}

/// The exact reflectance where the material wants it, and 1 where nothing is refracted.
fn dielectric(material: &Material, at: &SurfaceInteraction) -> f32 {
    fresnel::dielectric(at.n.cos(at.e), relative_ior(material, at))
}

/// Where the mirror ray goes, its weight, and F where it was asked for.
pub(super) fn mirrored(material: &Material, at: &SurfaceInteraction) -> (Dir3, Rgb, Option<f32>) {
    let facing = at.facing_ng();
    let mirrored = reflect(-at.e, at.n);
    // A shading normal can send the mirror ray into the surface: the real normal does not.
    let dir = if mirrored.dot(facing) > 0.0 { mirrored } else { reflect(-at.e, facing) };
    if material.fresnel {
        let f = dielectric(material, at);
        return (dir, material.reflection * f, Some(f));
    }
    let total = !material.transmission.is_black() && refracted(material, at).is_none();
    let weight =
        if total { material.reflection + material.transmission } else { material.reflection };
    (dir, weight, None)
}

/// Where the refracted ray goes, its weight, and F where it was asked for; `None` under total
/// internal reflection.
pub(super) fn refracted(
    material: &Material,
    at: &SurfaceInteraction,
) -> Option<(Dir3, Rgb, Option<f32>)> {
    let eta = relative_ior(material, at);
    let facing = at.facing_ng();
    let dir = refract(at.e, at.n, eta)?;
    let dir = if dir.dot(facing) < 0.0 { dir } else { refract(at.e, facing, eta)? };
    if material.fresnel {
        let f = dielectric(material, at);
        return Some((dir, material.transmission * (1.0 - f), Some(f)));
    }
    Some((dir, material.transmission, None))
}

/// Snell's law: `sin θ_i = η sin θ_t`, η the index of the far side relative to the near one, `e`
/// and `n` on the near side. `None` under total internal reflection.
fn refract(e: Dir3, n: Dir3, eta: f32) -> Option<Dir3> {
    let cos_i = n.dot(e);
    let sin2_t = (1.0 - cos_i * cos_i).max(0.0) / (eta * eta);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let (e, n): (Vec3, Vec3) = (e.to_vec(), n.to_vec());
    Dir3::new((cos_i / eta - cos_t) * n - e / eta)
}
