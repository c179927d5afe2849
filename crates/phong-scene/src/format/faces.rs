//! Faces: lists of vertex numbers become triangles.

/// Triangles read so far.
#[derive(Debug, Default)]
pub(crate) struct Faces {
    pub(crate) indices: Vec<[u32; 3]>,
    /// First triangle and number of corners of every polygon of more than three.
    pub(crate) polygons: Vec<[u32; 2]>,
    /// How many faces had fewer than three corners.
    pub(crate) dropped: u64,
}

impl Faces {
    /// Adds a polygon as the fan around its first corner.
    pub(crate) fn push(&mut self, corners: &[u32]) {
        let [first, rest @ ..] = corners else {
            self.dropped += 1;
            return;
        };
        match rest.len() {
            0 | 1 => self.dropped += 1,
            2 => {}
            _ => self.polygons.push([self.indices.len() as u32, corners.len() as u32]),
        }
        self.indices.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }

    /// Adds a strip: every vertex makes a triangle with the two before it, every other of which is
    /// turned. Triangles that use a vertex twice only tie strips together.
    pub(crate) fn push_strip(&mut self, strip: &[u32]) {
        for (i, triangle) in strip.windows(3).enumerate() {
            let &[a, b, c] = triangle else { continue };
            if a != b && b != c && c != a {
                self.indices.push(if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
            }
        }
    }

    /// Adds those of a later piece.
    pub(crate) fn append(&mut self, mut later: Self) {
        let start = self.indices.len() as u32;
        self.polygons.extend(later.polygons.iter().map(|[first, n]| [first + start, *n]));
        self.indices.append(&mut later.indices);
        self.dropped += later.dropped;
    }

    /// Bytes that they take in memory.
    pub(crate) fn bytes(&self) -> u64 {
        (12 * self.indices.len() + 8 * self.polygons.len()) as u64
    }
}

/// How a face or strip of vertex numbers is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Polygons.
    Face,
    /// Strips of triangles, several in one list, each ended by −1.
    Strip,
}

impl Faces {
    /// Adds a list of numbers of `count` vertices; what is wrong with it, if anything.
    pub(crate) fn add(
        &mut self,
        kind: Kind,
        numbers: &[i64],
        count: u64,
        scratch: &mut Vec<u32>,
    ) -> Result<(), String> {
        scratch.clear();
        for &number in numbers {
            if kind == Kind::Strip && number == -1 {
                self.push_strip(scratch);
                scratch.clear();
                continue;
            }
            match u64::try_from(number) {
                Ok(index) if index < count => scratch.push(index as u32),
                _ => return Err(out_of_range(number, count)),
            }
        }
        match kind {
            Kind::Face => self.push(scratch),
            Kind::Strip => self.push_strip(scratch),
        }
        Ok(())
    }
}

/// Why a vertex number cannot be used.
pub(crate) fn out_of_range(number: i64, count: u64) -> String {
    match count {
        0 => format!("it uses vertex {number}, but there are none"),
        _ => format!("it uses vertex {number}, but the last one is {}", count - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_turn_every_other_triangle_and_end_at_minus_one() {
        let mut faces = Faces::default();
        faces.add(Kind::Strip, &[0, 1, 2, 3, 3, -1, 4, 5, 6], 7, &mut Vec::new()).unwrap();
        assert_eq!(faces.indices, [[0, 1, 2], [2, 1, 3], [4, 5, 6]]);
        assert!(faces.add(Kind::Face, &[0, 1, -1], 7, &mut Vec::new()).is_err());
        assert!(faces.add(Kind::Face, &[0, 1, 7], 7, &mut Vec::new()).is_err());
    }
}
