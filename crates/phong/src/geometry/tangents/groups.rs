//! Corners of triangles that share a tangent: those about a point that are reached over edges, of the same hand.

use super::edges::NONE;
use super::weld::Welded;

/// What is known of a triangle's texture coordinates.
#[derive(Clone, Copy, Default)]
pub(super) struct Hand {
    /// Whether the tangents of the triangle itself are of no use: it takes those of any beside it.
    pub(super) is_any: bool,
    /// Whether they are right-handed about the normal.
    pub(super) is_right: bool,
}

/// The groups of the corners of some triangles.
pub(super) struct Groups {
    /// That of each corner, or [`NONE`].
    pub(super) of: Vec<[u32; 3]>,
    /// The hand of each.
    pub(super) each: Vec<Hand>,
}

impl Groups {
    /// The groups of triangles, which have these others beside them. Those that take any hand are given one.
    pub(super) fn new(
        welded: &Welded,
        faces: &[u32],
        beside: &[[u32; 3]],
        hands: &mut [Hand],
    ) -> Self {
        let numbers = |face: usize| welded.numbers[faces[face] as usize];
        let each = Vec::with_capacity(welded.first.len());
        let mut groups = Self { of: vec![[NONE; 3]; faces.len()], each };
        let mut next = Vec::new();
        for face in 0..faces.len() {
            for (i, number) in numbers(face).into_iter().enumerate() {
                let Hand { is_any, is_right } = hands[face];
                if is_any || groups.of[face][i] != NONE {
                    continue;
                }
                let group = groups.each.len() as u32;
                groups.each.push(hands[face]);
                groups.of[face][i] = group;
                next.extend([beside[face][i], beside[face][(i + 2) % 3]]);
                while let Some(face) = next.pop() {
                    if face == NONE {
                        continue;
                    }
                    let face = face as usize;
                    let at = numbers(face).iter().position(|&other| other == number);
                    let Some(i) = at else { continue };
                    if groups.of[face][i] != NONE {
                        continue;
                    }
                    let hand = &mut hands[face];
                    if hand.is_any && groups.of[face] == [NONE; 3] {
                        hand.is_right = is_right;
                    }
                    if hand.is_right == is_right {
                        groups.of[face][i] = group;
                        next.extend([beside[face][i], beside[face][(i + 2) % 3]]);
                    }
                }
            }
        }
        groups
    }
}
