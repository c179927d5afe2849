//! Numbers that points have besides their place.

use std::sync::Arc;

use super::Shared;

/// A number of each point, by name: a temperature, a pressure, an error. One that is not finite is unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name, not empty: that of the property of the file.
    pub name: Arc<str>,
    /// One for each position of a mesh and each sphere of points; of cylinders two for each segment, its ends'.
    pub values: Shared<f32>,
}

impl Field {
    /// The most that a scene draws.
    pub const MOST: usize = 4;

    /// Whether a file can hold numbers of this name beside places, normals, colours and radii: one word, none of
    /// theirs.
    #[must_use]
    pub fn is_name(name: &str) -> bool {
        const TAKEN: [&str; 10] =
            ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "radius"];
        let is_of_word = |letter: char| !letter.is_whitespace() && !letter.is_control();
        !name.is_empty() && name.chars().all(is_of_word) && !TAKEN.contains(&name)
    }

    /// Bytes that several take in memory.
    pub(crate) fn bytes(all: &[Self]) -> u64 {
        all.iter().map(|field| 4 * field.values.len() as u64).sum()
    }

    /// The fields of those points for whose number `keep` says so, with so many values each.
    pub(crate) fn retain(all: &mut [Self], each: usize, keep: impl Fn(usize) -> bool) {
        for field in all {
            let mut number = 0;
            field.values.retain(|_| {
                number += 1;
                keep((number - 1) / each)
            });
        }
    }
}
