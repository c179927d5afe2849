//! Corners of triangles that share a tangent: those about a point that are reached over edges, of the same hand.

use super::edges::NONE;

/// What is known of a triangle's texture coordinates.
#[derive(Clone, Copy, Default)]
pub(super) struct Hand {
    /// Whether the tangents of the triangle itself are of no use: it takes those of any beside it.
    pub(super) is_any: bool,
    /// Whether they are right-handed about the normal.
    pub(super) is_right: bool,
}

impl Hand {
    /// A tangent, and 1 if it is of the right hand, else −1.
    pub(super) fn with(self, [x, y, z]: [f32; 3]) -> [f32; 4] {
        [x, y, z, if self.is_right { 1.0 } else { -1.0 }]
    }
}

/// The groups of the corners of some triangles.
pub(super) struct Groups {
    /// That of each corner, or [`NONE`].
    pub(super) of: Vec<[u32; 3]>,
    /// The hand of each.
    pub(super) each: Vec<Hand>,
}

impl Groups {
    /// The groups of triangles whose edges have these others beside them. Those that take any hand are given one.
    pub(super) fn new(beside: &[[u32; 3]], hands: &mut [Hand]) -> Self {
        let mut of = vec![[NONE; 3]; beside.len()];
        let mut each: Vec<Hand> = Vec::with_capacity(beside.len());
        for face in 0..beside.len() {
            let own = hands[face];
            if own.is_any {
                continue;
            }
            for i in 0..3 {
                if of[face][i] != NONE {
                    continue;
                }
                let group = each.len() as u32;
                each.push(own);
                of[face][i] = group;
                // About the point one way, over edges that leave it, and then the other way.
                for leaves in [true, false] {
                    let (mut face, mut i) = (face, i);
                    loop {
                        let edge = beside[face][if leaves { i } else { (i + 2) % 3 }] as usize;
                        if edge == NONE as usize {
                            break;
                        }
                        face = edge / 3;
                        i = if leaves { (edge + 1) % 3 } else { edge % 3 };
                        let hand = &mut hands[face];
                        if hand.is_any && of[face] == [NONE; 3] {
                            hand.is_right = own.is_right;
                        }
                        if of[face][i] != NONE || hand.is_right != own.is_right {
                            break;
                        }
                        of[face][i] = group;
                    }
                }
            }
        }
        Self { of, each }
    }
}
