//! The tree of nodes: what stands where.

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DMat4, DQuat, DVec3};

use super::json::{At, Result};
use crate::camera::{Camera, CameraKind};
use crate::color::Rgb;
use crate::diagnostic::Place;
use crate::format::text::{Findings, whole};
use crate::light::{Light, LightKind};
use crate::limits::LARGEST;

/// The extension that holds lights.
pub(super) const LIGHTS: &str = "KHR_lights_punctual";

/// A node that is drawn.
#[derive(Debug)]
pub(super) struct Node<'a> {
    pub(super) at: At<'a>,
    pub(super) to_world: DAffine3,
}

/// All nodes of the scene that is drawn, parents before their children; each with where it stands.
/// A node of two parents, or below itself, is a fault. A root that has a parent is told: it stands as
/// if it had none, for exporters name the child of what they mean (the kits of `UniGLTF` 1.27 do).
pub(super) fn drawn<'a>(
    root: &At<'a>,
    (file, findings): (&Arc<str>, &mut Findings),
) -> Result<Vec<Node<'a>>> {
    let all = root.list("nodes")?;
    let mut children = vec![Vec::new(); all.len()];
    let mut parents = vec![None; all.len()];
    for (number, node) in all.iter().enumerate() {
        for child in node.list("children")? {
            let of = child.index()?;
            match parents.get_mut(of) {
                None => return Err(child.fault(format!("there is no node {of}"))),
                Some(Some(_)) => return Err(child.fault(format!("node {of} has another parent"))),
                Some(parent) => *parent = Some(number),
            }
            children[number].push(of);
        }
    }
    let scene = match root.get("scene") {
        Some(number) => {
            Some(root.item("scenes", number.index()?).map_err(|f| number.fault(f.message))?)
        }
        None => root.list("scenes")?.into_iter().next(),
    };
    let mut open: Vec<(usize, DAffine3)> = Vec::new();
    if let Some(scene) = scene {
        let named = scene.list("nodes")?;
        let numbers = named.iter().map(At::index).collect::<Result<BTreeSet<_>>>()?;
        let within = within(&parents, &numbers);
        for node in named {
            let number = node.index()?;
            if number >= all.len() {
                return Err(node.fault(format!("there is no node {number}")));
            }
            let Some(is_within) = within[number] else {
                return Err(node.fault(format!("node {number} is below itself")));
            };
            if parents[number].is_some() {
                let end = if is_within { "below it, once" } else { "as if it had none" };
                findings.warning(
                    "roots that are none",
                    || whole(file),
                    || format!("{}: node {number} has a parent; it is drawn {end}", node.pointer),
                );
            }
            if !is_within {
                open.push((number, DAffine3::IDENTITY));
            }
        }
    } else {
        let roots = (0..all.len()).filter(|number| parents[*number].is_none());
        open.extend(roots.map(|number| (number, DAffine3::IDENTITY)));
    }
    // The first is drawn first.
    open.reverse();
    let mut seen = BTreeSet::new();
    let mut nodes = Vec::new();
    while let Some((number, parent)) = open.pop() {
        if !seen.insert(number) {
            return Err(all[number].fault("the scene names the node twice"));
        }
        let at = all[number].clone();
        let to_world = parent * placement(&at)?;
        open.extend(children[number].iter().rev().map(|child| (*child, to_world)));
        nodes.push(Node { at, to_world });
    }
    Ok(nodes)
}

/// Whether a node above each node is among those of these numbers; `None`: it is below itself.
fn within(parents: &[Option<usize>], numbers: &BTreeSet<usize>) -> Vec<Option<bool>> {
    let mut known: Vec<Option<bool>> = vec![None; parents.len()];
    let mut seen = vec![false; parents.len()];
    let mut path = Vec::new();
    for node in 0..parents.len() {
        // Every node is gone through once: up to one that is known, or that has no parent.
        let mut next = Some(node);
        while let Some(node) = next.filter(|&node| !seen[node]) {
            seen[node] = true;
            path.push(node);
            next = parents[node];
        }
        let mut above = next.map_or(Some(false), |top| Some(known[top]? || numbers.contains(&top)));
        while let Some(node) = path.pop() {
            known[node] = above;
            above = above.map(|above| above || numbers.contains(&node));
        }
    }
    known
}

/// Where a node stands, seen from its parent.
fn placement(at: &At<'_>) -> Result<DAffine3> {
    if let Some(matrix) = at.get("matrix") {
        return Ok(DAffine3::from_mat4(DMat4::from_cols_array(&matrix.numbers()?)));
    }
    let translation = DVec3::from(at.numbers_or("translation", [0.0; 3])?);
    let scale = DVec3::from(at.numbers_or("scale", [1.0; 3])?);
    let turn = DQuat::from_array(at.numbers_or("rotation", [0.0, 0.0, 0.0, 1.0])?);
    let length = turn.length();
    let turn = if length > 0.0 && length.is_finite() { turn / length } else { DQuat::IDENTITY };
    Ok(DAffine3::from_scale_rotation_translation(scale, turn, translation))
}

/// The camera that a node holds: it looks along its −Z.
pub(super) fn camera(root: &At<'_>, node: &Node<'_>) -> Result<Option<Camera>> {
    let Some(number) = node.at.get("camera") else { return Ok(None) };
    let at = root.item("cameras", number.index()?).map_err(|f| number.fault(f.message))?;
    let kind = at.need("type")?;
    let kind = match kind.text()? {
        "perspective" => {
            let angle = at.need("perspective")?.need("yfov")?;
            let fov = angle.number()?.to_degrees();
            if !(fov > 0.0 && fov < 180.0) {
                return Err(angle.fault("the angle must be above 0 and below π"));
            }
            CameraKind::Perspective { fov }
        }
        "orthographic" => {
            let half = at.need("orthographic")?.need("ymag")?;
            let height = 2.0 * half.number()?.abs();
            if height == 0.0 {
                return Err(half.fault("the height must not be 0"));
            }
            CameraKind::Orthographic { height }
        }
        other => return Err(kind.fault(format!("`{other}` is no type of a camera"))),
    };
    let eye = node.to_world.translation;
    let forward = node.to_world.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z);
    let up = node.to_world.transform_vector3(DVec3::Y).normalize_or(DVec3::Y);
    Ok(Some(Camera { kind, eye, look_at: eye + forward, up, ..Camera::default() }))
}

/// The light that a node holds: it shines along its −Z.
///
/// What it gives is divided by π: the format's surfaces send back a π-th of the light that falls on
/// them, ours all of it.
pub(super) fn light(root: &At<'_>, node: &Node<'_>, place: &Place) -> Result<Option<Light>> {
    let Some(of) = node.at.extension(LIGHTS) else { return Ok(None) };
    let number = of.need("light")?;
    let list = root.extension(LIGHTS).map(|all| all.list("lights")).transpose()?;
    let index = number.index()?;
    let Some(at) = list.as_ref().and_then(|all| all.get(index)) else {
        return Err(number.fault(format!("there is no light {index}")));
    };
    let color: [f64; 3] = at.numbers_or("color", [1.0; 3])?;
    let intensity = at.number_or("intensity", 1.0)?.max(0.0) / PI;
    let color = Rgb::from(color.map(|c| (c.max(0.0) * intensity) as f32));
    let position = node.to_world.translation;
    let direction = node.to_world.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z);
    let attenuation = [0.0, 0.0, 1.0];
    let kind = at.need("type")?;
    let kind = match kind.text()? {
        "directional" => LightKind::Distant { direction, angle: 0.0 },
        "point" => LightKind::Point { position, attenuation, radius: 0.0 },
        "spot" => {
            let spot = at.get("spot");
            let angle = |key: &str, default: f64| -> Result<f64> {
                let angle =
                    spot.as_ref().map_or(Ok(default), |spot| spot.number_or(key, default))?;
                Ok(angle.clamp(0.0, PI / 2.0).to_degrees())
            };
            let edge = angle("outerConeAngle", PI / 4.0)?.max(1e-3);
            let cone = angle("innerConeAngle", 0.0)?.min(edge);
            let target = position + direction;
            LightKind::Spot { position, target, cone, edge, attenuation, radius: 0.0 }
        }
        other => return Err(kind.fault(format!("`{other}` is no type of a light"))),
    };
    let ends = matches!(kind, LightKind::Point { .. } | LightKind::Spot { .. });
    let range = Some(at.number_or("range", 0.0)?);
    let range = range.filter(|range| ends && *range > 0.0 && *range <= LARGEST);
    let name = at.name("light");
    let place = place.clone();
    Ok(Some(Light { name, kind, color, specular_color: color, range, place, ..Light::default() }))
}
