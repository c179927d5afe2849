//! The highlight's lobe at a pixel, in the plane of a light: the polar plot of the lecture.

use phong::explain::{End, Explanation, Surface};
use phong::glam::Vec3;
use phong::material::Material;
use phong::math::{Dir3, wide};
use phong::reflectance::Incident;
use phong::scene::Rgb;
use phong::view::View;

use crate::protocol::{Mark, Reply};

/// Directions on each side of the normal.
const HALF: i32 = 90;

/// The lobe for a light, from 1, at the first sample's surface.
///
/// # Errors
/// Why there is none.
pub(super) fn of(id: u64, told: &Explanation, light: usize, view: &View) -> Result<Reply, String> {
    let end = told.samples.first().and_then(|sample| sample.ray.as_ref()).map(|ray| &ray.end);
    let Some(End::Surface(surface)) = end else {
        return Err("the ray through this pixel meets nothing".to_owned());
    };
    let lit = light.checked_sub(1).and_then(|i| surface.lights.get(i));
    let lit = lit.ok_or_else(|| format!("there is no light {light}"))?;
    let l = lit.l.ok_or("this light has no direction here")?;
    let material = Material::new(&surface.material, view.camera().backward());
    let value = |e: Dir3| specular(surface, &material, l, e);
    // The plane of n and l, with l on the left and r on the right.
    let across = across(surface.n, l);
    let values: Vec<(Vec3, f32)> = (-HALF..=HALF)
        .filter_map(|degrees| {
            let (sin, cos) = wide::sin_cos(f64::from(degrees).to_radians());
            let (sin, cos) = (sin as f32, cos as f32);
            let e = Dir3::new(cos * surface.n.to_vec() + sin * across)?;
            Some((Vec3::new(sin, cos, 0.0), value(e)))
        })
        .collect();
    let most = values.iter().map(|(_, v)| *v).fold(0.0, f32::max);
    let scale = if most > 0.0 && most.is_finite() { most.recip() } else { 0.0 };
    let points =
        values.iter().map(|(place, v)| [place.x * v * scale, place.y * v * scale]).collect();
    let mark = |name, v: Option<Dir3>| {
        let v = v?.to_vec();
        Some(Mark { name, at: [v.dot(across), v.dot(surface.n.to_vec())] })
    };
    let marks = [
        mark("n", Some(surface.n)),
        mark("l", Some(l)),
        mark("r", lit.r),
        mark("e", Some(surface.e)),
        mark("h", lit.h),
    ];
    let marks = marks.into_iter().flatten().collect();
    let (at_eye, light_name) = (value(surface.e), lit.name.clone());
    Ok(Reply::Lobe { id, pixel: told.pixel, light: light_name, points, marks, most, at_eye })
}

/// What of the light's white goes to `e` as highlight, `k_s` and all.
fn specular(surface: &Surface, material: &Material, l: Dir3, e: Dir3) -> f32 {
    let white = Incident { l, c_d: Rgb::WHITE, c_s: Rgb::WHITE, color: surface.color };
    let terms = material.reflectance.shade_light(surface.n, surface.tangent, e, white);
    let value = terms.specular.max_channel();
    if value.is_finite() { value } else { 0.0 }
}

/// The unit vector across the normal, away from the light.
fn across(n: Dir3, l: Dir3) -> Vec3 {
    let (n, l) = (n.to_vec(), l.to_vec());
    (l.dot(n) * n - l).normalize_or(n.any_orthonormal_vector())
}
