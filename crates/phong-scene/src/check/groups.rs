//! What instances place: groups that there are, that come before, and not too much of it.

use super::{At, Judge};
use crate::scene::Object;
use crate::shape::Shape;

/// Groups within one another at most: whoever walks them may recurse.
const DEEPEST: u32 = 256;

/// Most objects that a scene's instances may unfold into.
pub(crate) const MOST_OBJECTS: u64 = 1 << 28;

impl Judge<'_> {
    /// Says of each instance what is wrong with what it places. A group holds instances of earlier
    /// groups only, so that none holds itself, and all of this is one pass.
    pub(super) fn groups(&mut self) {
        let scene = self.scene;
        let mut depths = Vec::with_capacity(scene.groups.len());
        let mut counts = Vec::with_capacity(scene.groups.len());
        for (number, group) in scene.groups.iter().enumerate() {
            let (mut depth, mut count) = (1_u32, 0_u64);
            for (i, object) in group.objects.iter().enumerate() {
                let Shape::Instance(inner) = object.shape else {
                    count = count.saturating_add(1);
                    continue;
                };
                let inner = inner.0 as usize;
                let at = At::Group(number, i);
                if inner >= number {
                    let message = match inner {
                        _ if inner == number => "the group holds itself".to_owned(),
                        _ if inner >= scene.groups.len() => self.no_group(inner),
                        _ => {
                            let name = &scene.groups[inner].name;
                            format!(
                                "the group {inner} (`{name}`) comes later: a group holds earlier ones"
                            )
                        }
                    };
                    self.object_error(at, object, &message);
                    continue;
                }
                depth = depth.max(depths[inner] + 1);
                count = count.saturating_add(counts[inner]);
                if depths[inner] == DEEPEST {
                    self.object_error(at, object, &format!("groups go deeper than {DEEPEST}"));
                }
            }
            depths.push(depth);
            counts.push(count);
        }
        self.top(&counts);
    }

    fn top(&mut self, counts: &[u64]) {
        let scene = self.scene;
        let mut all = 0_u64;
        let mut first: Option<(usize, &Object)> = None;
        for (i, object) in scene.objects.iter().enumerate() {
            let Shape::Instance(inner) = object.shape else {
                all = all.saturating_add(1);
                continue;
            };
            first.get_or_insert((i, object));
            if let Some(count) = counts.get(inner.0 as usize) {
                all = all.saturating_add(*count);
            } else {
                let message = self.no_group(inner.0 as usize);
                self.object_error(At::Top(i), object, &message);
            }
        }
        if let Some((i, object)) = first
            && all > MOST_OBJECTS
        {
            let message = format!("the instances unfold into more than {MOST_OBJECTS} objects");
            self.object_error(At::Top(i), object, &message);
        }
    }

    fn no_group(&self, number: usize) -> String {
        let count = self.scene.groups.len();
        format!("there is no group {number}: the scene holds {count}")
    }
}
