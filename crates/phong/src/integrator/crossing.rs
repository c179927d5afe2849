//! Surfaces in one place, and glass within glass.
//!
//! Of surfaces that coincide within the bounds of their errors a ray meets first the one of the highest
//! priority, then what is opaque before glass, then the first of the text. A ray that goes on through glass
//! crosses all glass that is there at once, as one interface: from what it was in to what it is in then,
//! and starts beyond all of it. Where it is in several glasses, those of the highest priority alone count.
//! Glass that changes nothing is not met at all: where two glasses of one index touch, and where glass lies
//! within one of higher priority.

use glam::{DVec3, Vec3};
use phong_bvh::{Hit, Hits8, Ray, Rays8, Surface, lanes};

use super::Steps;
use super::filtered::material_met;
use crate::view::{Coincidences, View};

/// Up to so many surfaces that change nothing are passed on the way to one that does.
const MOST_PASSED: usize = 1000;

/// Up to so many glasses that a ray is in at once are known.
const MOST_MEDIA: usize = 8;

/// The cosine between the normals of surfaces that lie in one another.
const PARALLEL: f32 = 0.999;

/// The glasses that a ray is in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Media {
    glasses: [Glass; MOST_MEDIA],
    count: usize,
}

/// A glass that a ray is in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Glass {
    /// The object that is made of it.
    object: u32,
    priority: u32,
    /// Its index of refraction, relative to what is around it.
    ior: f32,
}

impl Media {
    fn all(&self) -> &[Glass] {
        &self.glasses[..self.count]
    }

    fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn enter(&mut self, glass: Glass) {
        if self.count < MOST_MEDIA {
            self.glasses[self.count] = glass;
            self.count += 1;
        }
    }

    fn leave(&mut self, object: u32) {
        if let Some(place) = self.all().iter().rposition(|glass| glass.object == object) {
            self.glasses.copy_within(place + 1..self.count, place);
            self.count -= 1;
        }
    }

    /// Is in this glass, which has this index here: its way may have begun in there.
    fn hold(&mut self, glass: Glass) {
        match self.all().iter().rposition(|inside| inside.object == glass.object) {
            Some(place) => self.glasses[place].ior = glass.ior,
            None => self.enter(glass),
        }
    }

    /// The highest priority of any; `None`: it is in no glass.
    fn highest(&self) -> Option<u32> {
        self.all().iter().map(|glass| glass.priority).max()
    }

    /// The index of refraction here, relative to where there is no glass: each glass's own is relative
    /// to what is around it, and those below the highest priority are not there.
    fn index(&self) -> f32 {
        let highest = self.highest();
        let counts = |glass: &&Glass| Some(glass.priority) == highest;
        self.all().iter().filter(counts).map(|glass| glass.ior).product()
    }
}

/// What a mirror or glass ray knows of where it starts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Departure {
    media: Media,
    next: Option<Next>,
}

/// The opaque surface just behind the glass that a ray crossed, which it meets at once.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Next {
    part: u32,
    prim: u32,
    /// It is nearer than this.
    within: f32,
}

/// What a ray met where more than the closest hit counts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// The number of the ray in its bundle.
    ray: usize,
    /// The index of refraction of the far side relative to the near one; `None`: the material's own.
    eta: Option<f32>,
    /// Bound on the error of each coordinate of the point, so large that all surfaces there are within.
    error: Vec3,
    before: Media,
    after: Media,
    next: Option<Next>,
}

impl Crossing {
    /// What the mirror ray knows.
    pub(super) fn reflected(&self) -> Departure {
        Departure { media: self.before, next: None }
    }

    /// What the refracted ray knows, and whether it starts before the surface, not beyond it.
    pub(super) fn refracted(&self) -> (Departure, bool) {
        (Departure { media: self.after, next: self.next }, self.next.is_some())
    }
}

/// All crossings of a bundle, in the order of its rays.
#[derive(Debug, Default)]
pub(super) struct Crossings {
    all: Vec<Crossing>,
    /// The rays, each from where the last surface was passed that changes nothing.
    rays: Vec<Rays8>,
    found: Vec<Hit>,
}

impl Crossings {
    /// That of one ray.
    pub(super) fn of(&self, eight: usize, lane: usize) -> Option<&Crossing> {
        let ray = 8 * eight + lane;
        let place = self.all.binary_search_by_key(&ray, |crossing| crossing.ray).ok()?;
        Some(&self.all[place])
    }

    /// Of each the number of its ray, the index of refraction of the far side, and the bound on the error
    /// of the point.
    pub(super) fn each(&self) -> impl Iterator<Item = (usize, Option<f32>, Vec3)> {
        self.all.iter().map(|crossing| (crossing.ray, crossing.eta, crossing.error))
    }

    /// Makes of the closest hits those that are met first. Returns the rays as they get there.
    pub(super) fn settle(
        &mut self,
        view: &View,
        coincidences: &Coincidences,
        rays: &[Rays8],
        departures: &[Departure],
        hits: &mut [Hits8],
    ) -> &[Rays8] {
        let Self { all, rays: own, found } = self;
        own.clear();
        own.extend_from_slice(rays);
        all.clear();
        for (i, (rays, hits)) in own.iter_mut().zip(hits).enumerate() {
            for lane in lanes(hits.met & rays.there) {
                let ray = 8 * i + lane;
                let departure = departures.get(ray).copied().unwrap_or_default();
                let mut way = rays.get(lane);
                let closest = hits.get(lane);
                let (hit, crossing) =
                    first(view, coincidences, &mut way, closest, departure, found);
                if hit != closest {
                    hits.set(lane, hit);
                    rays.set(lane, &way);
                }
                all.extend(crossing.map(|crossing| Crossing { ray, ..crossing }));
            }
        }
        own
    }
}

/// The surface that a ray from the camera shows first, and the ray as it gets there: what has no opacity where
/// it is met is not seen.
pub(crate) fn first_seen(view: &View, ray: Ray, closest: Hit) -> (Ray, Hit) {
    let (mut ray, mut hit) = first_met(view, ray, closest);
    if !view.has_see_through() {
        return (ray, hit);
    }
    for passed in 0..Steps::MOST_PASSED {
        if !hit.is_some() {
            break;
        }
        let at = view.interaction(&ray, &hit);
        if material_met(view, &ray, &at).cover(at.n.dot(at.e), passed) > 0.0 {
            break;
        }
        ray.t_min = hit.t + Member::new(view, &ray, hit).window(&ray);
        (ray, hit) = first_met(view, ray, view.intersect(&ray));
    }
    (ray, hit)
}

/// The surface that a ray from the camera meets first, and the ray as it gets there.
fn first_met(view: &View, ray: Ray, closest: Hit) -> (Ray, Hit) {
    let Some(coincidences) = view.coincidences() else { return (ray, closest) };
    let mut way = ray;
    let departure = Departure::default();
    let (hit, _) = first(view, coincidences, &mut way, closest, departure, &mut Vec::new());
    (way, hit)
}

/// What a ray meets first, given the closest hit.
fn first(
    view: &View,
    coincidences: &Coincidences,
    ray: &mut Ray,
    closest: Hit,
    Departure { mut media, next }: Departure,
    found: &mut Vec<Hit>,
) -> (Hit, Option<Crossing>) {
    let mut hit = closest;
    if let Some(next) = next {
        view.every(&Ray { t_max: next.within, ..*ray }, found);
        let next = found.iter().find(|hit| (hit.part, hit.prim) == (next.part, next.prim));
        hit = next.copied().unwrap_or(hit);
        if next.is_some() {
            let error = view.surface(ray, &hit).p_error;
            return (hit, Some(Crossing::within(media, error)));
        }
    }
    for _ in 0..MOST_PASSED {
        if !hit.is_some() {
            return (hit, None);
        }
        let batch = view.geometry().batch(hit.part);
        let may_coincide = coincidences.may_coincide(batch.object(hit.prim));
        if !may_coincide && !coincidences.nested {
            return (hit, None);
        }
        let group = Group::at(view, may_coincide, ray, hit, found);
        if let [only] = &group.members[..]
            && !(coincidences.nested && only.ior.is_some())
        {
            // An opaque surface within glass: what its mirror shows is seen through the glass.
            let is_in_glass = !media.is_empty();
            return (hit, is_in_glass.then(|| Crossing::within(media, only.surface.p_error)));
        }
        match group.cross(coincidences, media) {
            Crossed::Met(hit, crossing) => return (hit, Some(crossing)),
            Crossed::Passed(after) => media = after,
        }
        hit = group.pass(view, ray);
    }
    (hit, None)
}

impl Crossing {
    /// A surface that a ray meets within these glasses, and from which it goes on by the material alone.
    fn within(media: Media, error: Vec3) -> Self {
        Self { ray: 0, eta: None, error, before: media, after: media, next: None }
    }
}

/// What becomes of a ray where surfaces coincide.
enum Crossed {
    /// It meets one of them.
    Met(Hit, Crossing),
    /// None of them is there for it, and it is in these glasses from then on.
    Passed(Media),
}

/// A surface among those that coincide.
#[derive(Clone, Copy, Debug)]
struct Member {
    hit: Hit,
    surface: Surface,
    object: u32,
    priority: u32,
    /// The index of refraction of glass; `None`: it is opaque.
    ior: Option<f32>,
    /// Whether the ray comes from outside.
    entering: bool,
}

impl Member {
    fn new(view: &View, ray: &Ray, hit: Hit) -> Self {
        let batch = view.geometry().batch(hit.part);
        let number = view.material_of(&hit);
        let material = &view.materials()[number as usize];
        let surface = view.surface(ray, &hit);
        Self {
            hit,
            surface,
            object: batch.object(hit.prim),
            priority: material.priority,
            ior: (!material.transmission.is_black())
                .then(|| view.ior_at(number, ray, &hit, &surface)),
            entering: surface.ng.dot(ray.dir) < 0.0,
        }
    }

    /// How far off the surface its point may be.
    fn off(&self) -> f32 {
        self.surface.ng.abs().dot(self.surface.p_error)
    }

    /// How far along the ray before and behind its hit it may be.
    fn window(&self, ray: &Ray) -> f32 {
        let cos = self.surface.ng.dot(ray.dir).abs().max(1e-3);
        // What rounding makes of distances is a few of their last digits.
        8.0 * self.off() / cos + 8.0 * f32::EPSILON * self.hit.t
    }

    /// Whether it lies where `other` does, within the bounds of both errors.
    fn coincides(&self, other: &Self) -> bool {
        let between = (other.surface.p - self.surface.p).dot(self.surface.ng.as_dvec3());
        let near = 2.0 * f64::from(self.off() + other.off());
        between.abs() <= near && self.surface.ng.dot(other.surface.ng).abs() > PARALLEL
    }
}

/// Surfaces that coincide, in the order in which they are met.
struct Group {
    members: Vec<Member>,
    /// The ray has all of them behind it here.
    end: f32,
}

impl Group {
    /// All that coincide with a hit.
    fn at(view: &View, may_coincide: bool, ray: &Ray, hit: Hit, found: &mut Vec<Hit>) -> Self {
        let closest = Member::new(view, ray, hit);
        let window = closest.window(ray);
        let mut group = Self { members: vec![closest], end: hit.t + window };
        if !may_coincide {
            return group;
        }
        let t_min = (hit.t - window).max(ray.t_min);
        let near = Ray { t_min, t_max: group.end.min(ray.t_max), ..*ray };
        view.every(&near, found);
        for other in found.iter().filter(|other| (other.part, other.prim) != (hit.part, hit.prim)) {
            let other = Member::new(view, &near, *other);
            // A ray through the edge between two faces of one object meets both.
            let again = |member: &Member| {
                (member.object, member.entering) == (other.object, other.entering)
            };
            if closest.coincides(&other) && !group.members.iter().any(again) {
                group.members.push(other);
            }
        }
        let order = |member: &Member| {
            let Member { hit, priority, ior, .. } = member;
            (std::cmp::Reverse(*priority), ior.is_some(), hit.part, hit.prim)
        };
        group.members.sort_by_key(order);
        group
    }

    /// What a ray within `media` meets of them.
    fn cross(&self, coincidences: &Coincidences, media: Media) -> Crossed {
        let opaque = self.members.iter().position(|member| member.ior.is_none());
        let glass = &self.members[..opaque.unwrap_or(self.members.len())];
        let (mut before, mut after, mut carried) = (media, media, media);
        // What is left first, for one mesh may hold both of two blocks that touch.
        let (leaving, entering) =
            (glass.iter().filter(|m| !m.entering), glass.iter().filter(|m| m.entering));
        for member in leaving.chain(entering) {
            let Member { object, priority, ior: Some(ior), entering, .. } = *member else {
                continue;
            };
            let own = Glass { object, priority, ior };
            if entering {
                after.enter(own);
                if coincidences.nested && coincidences.is_closed(object) {
                    carried.enter(own);
                }
            } else {
                before.hold(own);
                after.leave(object);
                carried.leave(object);
            }
        }
        let highest = before.highest().max(after.highest());
        let visible = glass.iter().find(|member| Some(member.priority) >= highest);
        let (from, to) = (before.index(), after.index());
        let is_within = !before.is_empty() && !after.is_empty();
        let changes = (from - to).abs() > 1e-6 * from || !is_within;
        match (visible.filter(|_| changes), opaque) {
            (Some(first), _) => {
                let error = self.error(first);
                let next = opaque.map(|opaque| {
                    let Hit { part, prim, .. } = self.members[opaque].hit;
                    let off = first.surface.ng.abs().dot(error);
                    Next { part, prim, within: 400.0 * off + f32::MIN_POSITIVE }
                });
                let (eta, ray) = (Some(to / from), 0);
                let crossing = Crossing { ray, eta, error, before: media, after: carried, next };
                Crossed::Met(first.hit, crossing)
            }
            (None, Some(opaque)) => {
                let first = &self.members[opaque];
                Crossed::Met(first.hit, Crossing::within(carried, self.error(first)))
            }
            (None, None) => Crossed::Passed(carried),
        }
    }

    /// The closest hit beyond all of them.
    fn pass(&self, view: &View, ray: &mut Ray) -> Hit {
        let farthest = self.members.iter().map(|member| member.hit.t).fold(self.end, f32::max);
        ray.t_min = farthest.next_up();
        view.intersect(ray)
    }

    /// The bound on the error of `of`'s point that all members are within.
    fn error(&self, of: &Member) -> Vec3 {
        let apart = |member: &Member| {
            let between: DVec3 = (member.surface.p - of.surface.p).abs();
            between.as_vec3() + member.surface.p_error
        };
        self.members.iter().map(apart).fold(Vec3::ZERO, Vec3::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glass(object: u32, priority: u32, ior: f32) -> Glass {
        Glass { object, priority, ior }
    }

    #[test]
    fn the_index_within_glasses_is_that_of_the_highest_priority() {
        let mut media = Media::default();
        assert_eq!((media.index(), media.highest()), (1.0, None));
        media.enter(glass(1, 0, 1.25));
        media.enter(glass(2, 3, 1.5));
        assert_eq!((media.index(), media.highest()), (1.5, Some(3)));
        media.leave(2);
        assert_eq!((media.index(), media.highest()), (1.25, Some(0)));
    }

    #[test]
    fn an_index_is_relative_to_what_is_around_it_at_one_priority() {
        let mut media = Media::default();
        media.enter(glass(1, 2, 1.5));
        media.enter(glass(2, 2, 0.5));
        assert_eq!(media.index(), 0.75);
        media.leave(1);
        assert_eq!((media.index(), media.count), (0.5, 1));
    }

    #[test]
    fn glass_has_the_index_of_the_place_where_it_is_left() {
        let mut media = Media::default();
        media.enter(glass(1, 2, 1.5));
        media.enter(glass(2, 2, 0.5));
        media.hold(glass(1, 2, 2.0));
        assert_eq!((media.index(), media.count), (1.0, 2));
        media.hold(glass(3, 2, 1.25));
        assert_eq!((media.index(), media.count), (1.25, 3));
    }

    #[test]
    fn more_glasses_than_are_known_are_left_as_they_were_entered() {
        let mut media = Media::default();
        for object in 0..2 * MOST_MEDIA as u32 {
            media.enter(glass(object, 0, 1.5));
        }
        for object in 0..2 * MOST_MEDIA as u32 {
            media.leave(object);
        }
        assert!(media.is_empty());
    }
}
