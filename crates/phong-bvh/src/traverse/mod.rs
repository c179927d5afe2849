//! Rays through the tree.

mod boxes;
mod coherent;
mod columns;
mod every;
mod framed;
mod frustum;
mod interleaved;
mod leaves;
mod pause;
mod query;
mod scattered;
mod sheared;
mod single;
mod slabs;
mod waiting;
mod walk;

pub(crate) use self::boxes::{Boxes, Stack as BoxStack};
pub(crate) use self::columns::{highest, lowest};
pub(crate) use self::slabs::meet;

use std::{cell::RefCell, marker::PhantomData};

use self::{
    coherent::{Group, Groups},
    every::Every,
    interleaved::{Interleaved, RAYS, Stacks},
    leaves::{Anything, Content, OnlyCylinders, OnlySpheres, OnlyTriangles},
    query::{AnyHit, ClosestHit, Query},
    scattered::{Scattered, TOGETHER},
};
use crate::{
    Cost, Primitives,
    build::Nodes,
    level::Token,
    local::{Hit, Hits8, Ray, Rays8},
    node8::{Kind, Ref, Row, rows},
    primitives::{capsule::At, sphere},
};

/// A tree and what its leaves refer to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct World<'a> {
    rows: &'a [Row],
    root: Option<Ref>,
    only: Option<Kind>,
    geometry: &'a [Primitives],
    /// First primitive number of each geometry.
    first: &'a [u32],
    token: Token,
}

impl<'a> World<'a> {
    /// The world of a tree.
    #[inline(always)]
    pub(crate) fn new(
        nodes: &'a Nodes,
        geometry: &'a [Primitives],
        first: &'a [u32],
        token: Token,
    ) -> Self {
        let (rows, root, only) = (nodes.rows.as_slice(), nodes.root, nodes.only);
        Self { rows, root, only, geometry, first, token }
    }

    /// The closest hit of a ray, given the best outside the tree.
    pub(crate) fn closest(&self, ray: &Ray, best: &mut Best, meter: &mut impl Meter) {
        match self.only {
            Some(Kind::Triangles) => self.closest_in::<OnlyTriangles>(ray, best, meter),
            Some(Kind::Spheres) => self.closest_in::<OnlySpheres>(ray, best, meter),
            Some(Kind::Cylinders) => self.closest_in::<OnlyCylinders>(ray, best, meter),
            _ => self.closest_in::<Anything>(ray, best, meter),
        }
    }

    /// The closest hit of each ray in the tree; `hits` come with how far each has to look, and what
    /// is there.
    pub(crate) fn closest_of_eights(&self, rays: &[Rays8], hits: &mut [Hits8]) {
        match self.only {
            Some(Kind::Triangles) => self.many_in::<OnlyTriangles, _>(rays, ClosestHit(hits)),
            Some(Kind::Spheres) => self.many_in::<OnlySpheres, _>(rays, ClosestHit(hits)),
            Some(Kind::Cylinders) => self.many_in::<OnlyCylinders, _>(rays, ClosestHit(hits)),
            _ => self.many_in::<Anything, _>(rays, ClosestHit(hits)),
        }
    }

    /// Whether each ray hits anything in the tree, a bit each; those already `blocked` stay so.
    pub(crate) fn any_of_eights(&self, rays: &[Rays8], blocked: &mut [u32]) {
        match self.only {
            Some(Kind::Triangles) => self.many_in::<OnlyTriangles, _>(rays, AnyHit(blocked)),
            Some(Kind::Spheres) => self.many_in::<OnlySpheres, _>(rays, AnyHit(blocked)),
            Some(Kind::Cylinders) => self.many_in::<OnlyCylinders, _>(rays, AnyHit(blocked)),
            _ => self.many_in::<Anything, _>(rays, AnyHit(blocked)),
        }
    }

    /// [`World::any_of_eights`] of rays that start close together and go everywhere.
    pub(crate) fn any_of_scattered(&self, rays: &[Rays8], blocked: &mut [u32]) {
        let root = self.root.filter(|root| root.kind().is_none());
        let (Some(Kind::Spheres), Some(root)) = (self.only, root) else {
            return self.any_of_eights(rays, blocked);
        };
        let world = self;
        LANES.with_borrow_mut(|lanes| {
            for (rays, blocked) in rays.chunks(TOGETHER).zip(blocked.chunks_mut(TOGETHER)) {
                lanes.clear();
                lanes.extend(
                    rays.iter().zip(&*blocked).map(|(rays, blocked)| rays.there & !blocked),
                );
                SCATTERED.with_borrow_mut(|memory| {
                    let (lanes, blocked) = (&mut *lanes, &mut *blocked);
                    self.token.run(Scattered { world, root, rays, lanes, blocked, memory });
                });
                STACKS.with_borrow_mut(|stacks| {
                    let (query, content) = (&mut AnyHit(blocked), PhantomData::<OnlySpheres>);
                    self.token.run(Interleaved {
                        world,
                        root,
                        rays,
                        lanes,
                        query,
                        stacks,
                        content,
                    });
                });
            }
        });
    }

    /// Gives `visit` the number of every primitive whose box a ray may enter before its end, in no order.
    pub(crate) fn every(&self, ray: &Ray, visit: impl FnMut(u32)) {
        let (world, Some(root)) = (self, self.root) else { return };
        BOXES.with_borrow_mut(|stack| {
            self.token.run(Every { world, root, ray, stack, visit });
        });
    }

    /// The only leaf of a tree that is a single leaf of spheres.
    pub(crate) fn single_leaf(&self) -> Option<&'a [Row; sphere::BLOCK]> {
        let leaf = self.root.filter(|root| root.kind() == Some(Kind::Spheres))?;
        Some(rows(self.rows, leaf.row()))
    }

    /// Whether a ray hits anything.
    pub(crate) fn any(&self, ray: &Ray) -> bool {
        match self.only {
            Some(Kind::Triangles) => self.any_in::<OnlyTriangles>(ray),
            Some(Kind::Spheres) => self.any_in::<OnlySpheres>(ray),
            Some(Kind::Cylinders) => self.any_in::<OnlyCylinders>(ray),
            _ => self.any_in::<Anything>(ray),
        }
    }

    #[inline(always)]
    fn closest_in<C: Content>(&self, ray: &Ray, best: &mut Best, meter: &mut impl Meter) {
        let Some(root) = self.root else { return };
        let (world, content) = (self, PhantomData::<C>);
        LONE.with_borrow_mut(|stack| {
            self.token.run(single::Closest { world, root, ray, best, stack, meter, content });
        });
    }

    /// Traces the rays of a bundle: coherent ones in groups, then the others one by one.
    fn many_in<C: Content, E: Query>(&self, rays: &[Rays8], mut query: E) {
        let Some(root) = self.root else { return };
        let (world, content, query) = (self, PhantomData::<C>, &mut query);
        LANES.with_borrow_mut(|lanes| {
            lanes.clear();
            let wanted = rays.iter().enumerate().map(|(i, rays)| query.wanted(rays, i));
            lanes.extend(wanted);
            // A root that is a leaf has no box to test.
            if root.kind().is_none() && (C::ANY_TOGETHER || !E::ANY) {
                GROUP.with_borrow_mut(|group| {
                    let (lanes, query) = (&mut *lanes, &mut *query);
                    self.token.run(Groups { world, root, rays, lanes, query, group, content });
                });
            }
            STACKS.with_borrow_mut(|stacks| {
                self.token.run(Interleaved { world, root, rays, lanes, query, stacks, content });
            });
        });
    }

    #[inline(always)]
    fn any_in<C: Content>(&self, ray: &Ray) -> bool {
        let Some(root) = self.root else { return false };
        let (world, content) = (self, PhantomData::<C>);
        LONE.with_borrow_mut(|stack| {
            self.token.run(single::Any { world, root, ray, stack, content })
        })
    }
}

/// Entries a stack can need: a tree is at most [`DEEP`](crate::build) cuts and 40 halvings deep, and
/// each node leaves seven children behind.
const STACK: usize = 7 * (64 + 40);

/// An empty stack of boxes.
pub(crate) const NO_BOXES: BoxStack = [0; STACK];

thread_local! {
    /// A thread's stacks: to clear one for each ray would cost a tenth of its time.
    static BOXES: RefCell<BoxStack> = const { RefCell::new(NO_BOXES) };
    static LONE: RefCell<single::Stack> = const { RefCell::new([0; STACK]) };
    static STACKS: RefCell<Stacks> = const { RefCell::new([walk::Stack::EMPTY; RAYS]) };
    /// The rays of a bundle that have to be traced, a bit each.
    static LANES: RefCell<Vec<u32>> = const { RefCell::new(Vec::new()) };
    static GROUP: RefCell<Group> = const { RefCell::new(Group::EMPTY) };
    static SCATTERED: RefCell<scattered::Memory> = const { RefCell::new(scattered::Memory::EMPTY) };
}

/// Counts what a ray costs; `()` counts nothing.
pub(crate) trait Meter {
    /// A node was visited.
    fn node(&mut self);
    /// A block of primitives, or a solid or plane, was tested.
    fn primitive(&mut self);
}

impl Meter for () {
    #[inline(always)]
    fn node(&mut self) {}

    #[inline(always)]
    fn primitive(&mut self) {}
}

impl Meter for Cost {
    #[inline(always)]
    fn node(&mut self) {
        self.nodes += 1;
    }

    #[inline(always)]
    fn primitive(&mut self) {
        self.primitives += 1;
    }
}

/// The best hit so far. Before the first one its distance is the ray's `t_max` and its number that of none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Best(pub(crate) Hit);

impl Best {
    /// No hit yet.
    #[inline(always)]
    pub(crate) fn new(t_max: f32) -> Self {
        Self(Hit { t: t_max, ..Hit::NONE })
    }

    /// The best hit outside the tree: it has no barycentric weights.
    ///
    /// Its two numbers are passed separately: written one by one and read back together, they would stall
    /// for longer than a node takes.
    #[inline(always)]
    pub(crate) fn outside(t: f32, prim: u32) -> Self {
        Self(Hit { t, prim, u: 0.0, v: 0.0 })
    }

    /// Takes a hit that is nearer, or at the same distance and of a lower number.
    #[inline(always)]
    pub(crate) fn offer(&mut self, t: f32, prim: u32, u: f32, v: f32) {
        if t < self.0.t || (t == self.0.t && prim < self.0.prim) {
            self.0 = Hit { t, prim, u, v };
        }
    }

    /// Takes a cylinder's hit that is nearer, or as near and of a lower number.
    #[inline(always)]
    pub(crate) fn offer_cylinder(&mut self, at: At, prim: u32) {
        self.offer(at.t, prim, f32::from(u8::from(at.second_half)), 0.0);
    }

    /// The hit, if any.
    #[inline(always)]
    pub(crate) fn hit(self) -> Hit {
        if self.0.is_some() { self.0 } else { Hit::NONE }
    }
}
