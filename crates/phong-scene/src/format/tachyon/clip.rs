//! Clip groups: what stands in one is cut along its planes, and one looks into it.

use glam::Vec3;

use crate::clip::{Cap, Clip, ClipKind};
use crate::diagnostic::Place;
use crate::scene::Object;

/// The clip groups of a scene.
#[derive(Debug, Default)]
pub(super) struct Clips {
    groups: Vec<ClipGroup>,
    /// Whether what is read now is in the last of them.
    open: bool,
}

#[derive(Debug)]
struct ClipGroup {
    /// Its planes, as clips that name no objects yet.
    planes: Vec<Clip>,
    /// How many others are without a normal, or have a number that is none.
    bad: usize,
}

impl Clips {
    /// A group begins, and one that was open ends.
    pub(super) fn begin(&mut self, planes: &[(Vec3, f32)], place: &Place) {
        let clip = |&(normal, most): &(Vec3, f32)| {
            let normal = normal.as_dvec3();
            let sound = normal.try_normalize().is_some() && most.is_finite();
            let point = normal * (f64::from(most) / normal.length_squared());
            let sound = sound && point.abs().max_element() <= crate::limits::LARGEST;
            let kind = ClipKind::Plane { point, normal };
            sound.then(|| Clip { kind, cap: Cap::Open, place: place.clone(), ..Clip::default() })
        };
        let clips: Vec<Clip> = planes.iter().filter_map(clip).collect();
        let bad = planes.len() - clips.len();
        self.groups.push(ClipGroup { planes: clips, bad });
        self.open = true;
    }

    pub(super) fn end(&mut self) {
        self.open = false;
    }

    /// The number of the group that what is read now is in.
    pub(super) fn now(&self) -> Option<usize> {
        self.groups.len().checked_sub(1).filter(|_| self.open)
    }

    /// The clips, each with the names of the objects of its group, and what of them is left out, in words;
    /// `groups`: that of each object.
    pub(super) fn of(
        self,
        objects: &[Object],
        groups: &[Option<usize>],
    ) -> (Vec<Clip>, Option<String>) {
        let (mut clips, mut bad) = (Vec::new(), 0);
        for (number, group) in self.groups.into_iter().enumerate() {
            let within = objects.iter().zip(groups).filter(|(_, group)| **group == Some(number));
            let names: Vec<String> = within.map(|(object, _)| object.name.clone()).collect();
            // Without a name it would cut everything.
            if !names.is_empty() {
                let planes = group.planes.into_iter();
                clips.extend(planes.map(|clip| Clip { objects: names.clone(), ..clip }));
                bad += group.bad;
            }
        }
        let most = Clip::MOST;
        let beyond = clips.len().saturating_sub(most) + bad;
        let message = format!(
            "planes of clip groups that are left out: {beyond} (a scene has at most {most}, each with a normal)"
        );
        clips.truncate(most);
        (clips, (beyond > 0).then_some(message))
    }
}
