//! Clip groups: what stands in one is cut along its planes, and one looks into it.

use glam::Vec3;

use crate::clip::{Cap, Clip, ClipKind};
use crate::diagnostic::Place;
use crate::scene::Object;

/// The clip groups of a scene.
#[derive(Debug, Default)]
pub(super) struct Clips {
    /// The planes of each, as clips that name no objects yet.
    groups: Vec<Vec<Clip>>,
    /// Whether what is read now is in the last of them.
    open: bool,
    /// Planes without a normal, or of which a number is none.
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
        self.bad += planes.len() - clips.len();
        self.groups.push(clips);
        self.open = true;
    }

    pub(super) fn end(&mut self) {
        self.open = false;
    }

    /// The number of the group that what is read now is in.
    pub(super) fn now(&self) -> Option<usize> {
        self.groups.len().checked_sub(1).filter(|_| self.open)
    }

    /// What of them is not drawn, in words.
    pub(super) fn beyond(&self) -> Option<String> {
        let count: usize = self.groups.iter().map(Vec::len).sum();
        let beyond = count.saturating_sub(Clip::MOST) + self.bad;
        (beyond > 0).then(|| {
            let most = Clip::MOST;
            format!("planes of clip groups that do not cut: {beyond}; at most {most} do, and none without a normal")
        })
    }

    /// The clips, each with the names of the objects of its group; `groups`: that of each object.
    pub(super) fn of(self, objects: &[Object], groups: &[Option<usize>]) -> Vec<Clip> {
        let mut clips = Vec::new();
        for (number, planes) in self.groups.into_iter().enumerate() {
            let within = objects.iter().zip(groups).filter(|(_, group)| **group == Some(number));
            let names: Vec<String> = within.map(|(object, _)| object.name.clone()).collect();
            // Without a name it would cut everything.
            if !names.is_empty() {
                clips
                    .extend(planes.into_iter().map(|clip| Clip { objects: names.clone(), ..clip }));
            }
        }
        clips.truncate(Clip::MOST);
        clips
    }
}
