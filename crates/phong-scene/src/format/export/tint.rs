//! Colours of vertices beside those of materials, for formats in which the first replace the second.

use super::Account;
use crate::color::Rgb;
use crate::material::VertexColors;
use crate::scene::Scene;
use crate::shape::Shape;

/// Works the colours of materials that are multiplied by those of vertices and points into these, or that count in their
/// place; 0.5 stands for a texture.
pub(crate) fn work_in(scene: &mut Scene, account: &mut Account) {
    let Scene { materials, objects, groups, .. } = scene;
    // By what the colours are multiplied, and what is added.
    let tint = |number: u32| {
        let material = materials.get(number as usize);
        let color = material.map_or(Rgb::WHITE, |m| m.color.constant().unwrap_or(Rgb::grey(0.5)));
        match material.map_or(VertexColors::Replace, |m| m.vertex_colors) {
            VertexColors::Replace => (Rgb::WHITE, Rgb::BLACK),
            VertexColors::Multiply => (color, Rgb::BLACK),
            VertexColors::Ignore => (Rgb::BLACK, color),
        }
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
        is_tinted |= tints.iter().any(|(by, _)| ![Rgb::WHITE, Rgb::BLACK].contains(by));
        colors.iter_mut().zip(tints).for_each(|(color, (by, more))| *color = *color * by + more);
    }
    if is_tinted {
        account
            .map("colours of vertices are written times the `color` of their material".to_owned());
    }
}
