//! Colours of vertices that multiply their material's, for formats that know only such as replace it.

use super::Account;
use crate::color::Rgb;
use crate::material::{Material, VertexColors};
use crate::scene::Scene;
use crate::shape::Shape;

/// Works the colours of materials that are multiplied by those of vertices and points into these; 0.5 stands for a
/// texture.
pub(crate) fn work_in(scene: &mut Scene, account: &mut Account) {
    let Scene { materials, objects, groups, .. } = scene;
    let multiplies = |m: &&Material| m.vertex_colors == VertexColors::Multiply;
    let tint = |number: u32| {
        let material = materials.get(number as usize).filter(multiplies);
        material.map_or(Rgb::WHITE, |m| m.color.constant().unwrap_or(Rgb::grey(0.5)))
    };
    let mut is_tinted = false;
    for object in objects.iter_mut().chain(groups.iter_mut().flat_map(|group| &mut group.objects)) {
        let own = tint(object.material.0);
        let mut tints = Vec::new();
        let colors = match &mut object.shape {
            Shape::Mesh(mesh) if !mesh.colors.is_empty() => {
                tints = vec![own; mesh.colors.len()];
                for (corners, material) in mesh.indices.iter().zip(&mesh.face_materials) {
                    for &i in corners {
                        tints[i as usize] = tint(*material);
                    }
                }
                &mut mesh.colors[..]
            }
            Shape::Points(points) => &mut points.colors[..],
            Shape::Cylinders(cylinders) => cylinders.colors.as_flattened_mut(),
            _ => continue,
        };
        tints.resize(colors.len(), own);
        is_tinted |= tints.iter().any(|tint| *tint != Rgb::WHITE);
        colors.iter_mut().zip(tints).for_each(|(color, tint)| *color = *color * tint);
    }
    if is_tinted {
        account
            .map("colours of vertices are written times the `color` of their material".to_owned());
    }
}
