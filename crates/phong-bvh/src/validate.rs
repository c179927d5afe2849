//! Whether a tree is sound: children lie inside parents, and every primitive is in it once.

use glam::Vec3;

use crate::{
    Aabb, Primitives, Tree,
    build::Nodes,
    node8::{Kind, NODE, REFS, Ref, Row, rows},
    primitives::{capsule, sphere, triangle},
};

/// What is wrong with a tree, or nothing.
pub(crate) fn validate(tree: &Tree) -> Result<(), String> {
    let mut seen = vec![false; tree.len() as usize];
    if let Some(root) = tree.rows().root {
        let everything = Aabb { lo: Vec3::NEG_INFINITY, hi: Vec3::INFINITY };
        visit(tree, root, &everything, &mut seen)?;
    }
    for (index, geometry) in tree.batches().iter().enumerate() {
        for (local, prim) in (tree.first()[index]..tree.first()[index + 1]).enumerate() {
            if seen[prim as usize] != belongs(geometry, local) {
                return Err(format!(
                    "primitive {prim} of geometry {index} is missing or should be"
                ));
            }
        }
    }
    Ok(())
}

/// Whether a primitive belongs into a tree.
fn belongs(geometry: &Primitives, local: usize) -> bool {
    match geometry {
        Primitives::Triangles { positions, indices } => {
            !triangle::is_degenerate(indices[local].map(|i| positions[i as usize]))
        }
        Primitives::Spheres(_) | Primitives::Cylinders { .. } | Primitives::Solid(_) => true,
        Primitives::Plane(_) => false,
    }
}

fn visit(tree: &Tree, at: Ref, bounds: &Aabb, seen: &mut [bool]) -> Result<(), String> {
    let nodes = tree.rows().rows.as_slice();
    let mut found = |prim: u32, inside: Aabb| {
        if prim == u32::MAX {
            return Ok(());
        }
        if std::mem::replace(&mut seen[prim as usize], true) {
            return Err(format!("primitive {prim} is there twice"));
        }
        bounds.contains(&inside).then_some(()).ok_or(format!("primitive {prim} is outside its box"))
    };
    match at.kind() {
        None => {
            let node: &[Row; NODE] = rows(nodes, at.row());
            for child in 0..8 {
                let inside = Nodes::child_bounds(node, child);
                if inside.is_empty() {
                    continue;
                }
                if !bounds.contains(&inside) {
                    return Err(format!("child {child} of the node at {} is outside", at.row()));
                }
                visit(tree, Ref(node[REFS].bits(child)).from(at.row()), &inside, seen)?;
            }
        }
        Some(Kind::Triangles) => {
            let block = rows(nodes, at.row());
            for lane in 0..8 {
                let [a, b, c] = triangle::corners(block, lane).map(Vec3::from);
                let inside = Aabb { lo: a.min(b).min(c), hi: a.max(b).max(c) };
                found(block[triangle::BLOCK - 1].bits(lane), inside)?;
            }
        }
        Some(Kind::Indexed) => {
            let [locals, geometries]: &[Row; 2] = rows(nodes, at.row());
            for lane in (0..8).filter(|&lane| locals.bits(lane) != u32::MAX) {
                let (index, local) = (geometries.bits(lane) as usize, locals.bits(lane) as usize);
                if let Primitives::Triangles { positions, indices } = &tree.batches()[index] {
                    let [a, b, c] = indices[local].map(|i| positions[i as usize]);
                    let inside = Aabb { lo: a.min(b).min(c), hi: a.max(b).max(c) };
                    found(tree.first()[index] + local as u32, inside)?;
                }
            }
        }
        Some(Kind::Spheres) => {
            let block: &[Row; sphere::BLOCK] = rows(nodes, at.row());
            for lane in 0..8 {
                let [x, y, z, r] = [0, 1, 2, 3].map(|row| block[row].0[lane]);
                let (center, radius) = (Vec3::new(x, y, z), Vec3::splat(r));
                let inside = Aabb { lo: center - radius, hi: center + radius };
                found(block[sphere::BLOCK - 1].bits(lane), inside)?;
            }
        }
        Some(Kind::Cylinders) => {
            let block: &[Row; capsule::BLOCK] = rows(nodes, at.row());
            for lane in 0..8 {
                let [x, y, z, hx, hy, hz, ..] = block.map(|row| row.0[lane]);
                let (from, half) = (Vec3::new(x, y, z), Vec3::new(hx, hy, hz));
                let (low, high) = (from.min(from + half), from.max(from + half));
                found(block[capsule::BLOCK - 1].bits(lane), Aabb { lo: low, hi: high })?;
            }
        }
        Some(Kind::Solid) => {
            let row = nodes[at.row()];
            if let Primitives::Solid(solid) = &tree.batches()[row.bits(1) as usize] {
                let [lo, hi] = solid.bounds();
                found(row.bits(0), Aabb { lo, hi })?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BuildOptions, Preset, Sphere};

    #[test]
    fn every_preset_makes_a_sound_tree_of_mixed_geometry() {
        let at = |i: u32| Vec3::new((i % 17) as f32, (i % 29) as f32, (i / 500) as f32 * 0.1);
        let spheres: Vec<_> = (0..40_000).map(|i| Sphere { center: at(i), radius: 0.3 }).collect();
        let positions: Vec<Vec3> = (0..9_000).map(|i| at(i) * 1.7).collect();
        let indices: Vec<_> = (0..8_000).map(|i| [i, i + 1, i + 17]).collect();
        let geometry = vec![
            Primitives::spheres(spheres),
            Primitives::triangles(positions, indices),
            Primitives::Plane(crate::Plane { point: glam::DVec3::ZERO, normal: glam::DVec3::Z }),
            Primitives::Solid(crate::Solid {
                shape: crate::Canonical::Box,
                to_world: glam::DAffine3::IDENTITY,
            }),
        ];
        for preset in [Preset::Fast, Preset::Balanced, Preset::Best, Preset::Compact] {
            let options = BuildOptions { preset, level: None };
            let tree = Tree::of(geometry.clone(), options).unwrap();
            assert_eq!(validate(&tree), Ok(()), "{preset:?}");
        }
    }
}
