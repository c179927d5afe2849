//! Binary files: facets of 50 bytes, read block by block in parallel.
//!
//! Each block puts its own corners together while they lie in the cache; what is left of them, about
//! a sixth to a quarter, is put together over the whole file, in the order of the blocks. So vertices are
//! numbered in the order of first use, whatever the number of threads.

use std::io;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::Vec3;
use rayon::prelude::*;

use super::{Counts, FACET, Facets, HEAD, are_held, blame, is_contrary, number_at};
use crate::format::text::{Findings, whole};
use crate::format::triangles::has_room;
use crate::limits::Limits;
use crate::mesh::{Few, Hash, Weld};
use crate::source::Blob;

/// Facets of a block.
const BLOCK: u64 = 1 << 14;

/// Whether the number of facets that a binary file would have fits the length.
pub(super) fn fits(blob: &dyn Blob) -> io::Result<bool> {
    let Some(count) = number_at(blob, HEAD - 4)? else { return Ok(false) };
    Ok(blob.len() == HEAD + u64::from(count) * FACET as u64)
}

/// Whether the file begins with text, which binary files do not.
fn is_other_text(blob: &dyn Blob) -> io::Result<bool> {
    let mut head = [0; 2 * HEAD as usize];
    let read = blob.read_full(&mut head, 0)?;
    Ok(read > 0 && head[..read].iter().all(|b| *b >= b' ' || b.is_ascii_whitespace()))
}

/// Reads the facets.
pub(super) fn read(
    blob: &dyn Blob,
    file: &Arc<str>,
    limits: &Limits,
    findings: &mut Findings,
) -> io::Result<Facets> {
    let said = number_at(blob, HEAD - 4)?;
    let Some(said) = said.filter(|_| blob.len() >= HEAD) else {
        let message = || {
            let length = blob.len();
            format!(
                "the file is no STL: it does not begin with `solid`, and its {length} bytes are fewer \
                 than the {HEAD} before binary facets"
            )
        };
        findings.error("short files", || whole(file), message);
        return Ok(Facets::default());
    };
    if !fits(blob)? && is_other_text(blob)? {
        let message =
            || "the file is no STL: it is text that does not begin with `solid`".to_owned();
        findings.error("other files", || whole(file), message);
        return Ok(Facets::default());
    }
    let said = u64::from(said);
    let there = (blob.len() - HEAD) / FACET as u64;
    let behind = blob.len() - HEAD - said.min(there) * FACET as u64;
    let count = if said > there {
        findings.damage(limits.lenient, "counts beyond the file", || whole(file), || {
            format!(
                "the file has room for {there} of {said} facets: it is cut short or its header is wrong"
            )
        });
        there
    } else if said == 0 && there > 0 {
        findings.warning(
            "counts of 0",
            || whole(file),
            || {
                format!(
                    "the file says that it has no facet, but has room for {there}: they are read"
                )
            },
        );
        there
    } else {
        if behind > 0 {
            findings.warning(
                "bytes behind the end",
                || whole(file),
                || format!("{behind} bytes behind the last facet are ignored"),
            );
        }
        said
    };
    if findings.any_error() || !has_room(count, 0, 12 * count, limits, file, findings) {
        return Ok(Facets::default());
    }

    // Closed meshes have half as many vertices as triangles; more room is made where there are more.
    let hash = Hash::new();
    let mut weld = Weld::with_room((count / 2) as usize, hash);
    let mut indices = vec![[0; 3]; count as usize];
    let mut counts = Counts::default();
    let size = (2 * rayon::current_num_threads() as u64).clamp(4, 64);
    let blocks = count.div_ceil(BLOCK);
    let tools = Mutex::new(Vec::new());
    let (mut first, mut filled) = (0, 0);
    // One wave is read, that before it numbered, and that before that one written, all at once.
    let (mut read, mut numbered): (Vec<Block>, Vec<Block>) = Default::default();
    let mut spare: Vec<Block> = Vec::new();
    loop {
        let wave = (blocks - first).min(size) as usize;
        spare.resize_with(wave, Block::default);
        let mut places = Vec::with_capacity(numbered.len());
        let mut rest = &mut indices[filled..];
        for block in &numbered {
            filled += block.indices.len();
            let (place, behind) = std::mem::take(&mut rest).split_at_mut(block.indices.len());
            places.push(place);
            rest = behind;
        }
        let read_block = |(i, block): (usize, &mut Block)| {
            let mut own = held(&tools).pop().unwrap_or_else(|| Tools::new(hash));
            let start = (first + i as u64) * BLOCK;
            let facets = start..(start + BLOCK).min(count);
            let result = block.read(blob, facets, &mut own, file);
            held(&tools).push(own);
            result
        };
        let number_blocks = || {
            read.iter_mut().all(|block| {
                weld.number_all(&block.positions, &mut block.numbers);
                findings.append(std::mem::take(&mut block.findings));
                counts.add(block.counts);
                let (vertices, bytes) = (weld.positions().len() as u64, 12 * count + weld.bytes());
                has_room(count, vertices, bytes, limits, file, findings)
            })
        };
        let (room, (result, ())) = rayon::join(number_blocks, || {
            rayon::join(
                || spare.par_iter_mut().enumerate().map(read_block).collect::<io::Result<()>>(),
                || numbered.par_iter().zip(places).for_each(|(block, place)| block.write(place)),
            )
        });
        result?;
        if !room {
            break;
        }
        (read, numbered, spare) = (spare, read, numbered);
        first += wave as u64;
        if read.is_empty() && numbered.is_empty() {
            break;
        }
    }
    indices.truncate(filled);
    Ok(Facets { positions: weld.into_positions(), indices, counts, ..Facets::default() })
}

/// What a thread needs to read a block, kept from block to block.
#[derive(Debug)]
struct Tools {
    bytes: Vec<u8>,
    few: Few,
}

impl Tools {
    fn new(hash: Hash) -> Self {
        let few = Few::with_room(BLOCK as usize, 3 * BLOCK as usize, hash);
        Self { bytes: Vec::new(), few }
    }
}

fn held<T>(tools: &Mutex<T>) -> MutexGuard<'_, T> {
    tools.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Some facets with their own vertices.
#[derive(Debug, Default)]
struct Block {
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    /// The numbers that the positions have in the file.
    numbers: Vec<u32>,
    counts: Counts,
    findings: Findings,
}

impl Block {
    /// Reads facets of these numbers.
    fn read(
        &mut self,
        blob: &dyn Blob,
        facets: Range<u64>,
        tools: &mut Tools,
        file: &Arc<str>,
    ) -> io::Result<()> {
        let Tools { bytes, few } = tools;
        bytes.resize((facets.end - facets.start) as usize * FACET, 0);
        if blob.read_full(bytes, HEAD + facets.start * FACET as u64)? < bytes.len() {
            let message = "it became shorter meanwhile";
            return Err(io::Error::new(io::ErrorKind::UnexpectedEof, message));
        }
        self.parse(bytes, facets.start, few, file);
        self.positions = few.take(std::mem::take(&mut self.positions));
        Ok(())
    }

    /// Parses whole facets, the first of which has this number.
    fn parse(&mut self, bytes: &[u8], first: u64, few: &mut Few, file: &Arc<str>) {
        let (facets, _) = bytes.as_chunks::<FACET>();
        self.counts = Counts::default();
        self.indices.clear();
        self.indices.reserve_exact(facets.len());
        let (mut before, mut numbered) = ([Vec3::NAN; 3], [0; 3]);
        for (number, facet) in facets.iter().enumerate() {
            let (numbers, _) = facet.as_chunks::<4>();
            let number_at = |i: usize| f32::from_le_bytes(numbers[i]);
            let vector = |i: usize| Vec3::new(number_at(i), number_at(i + 1), number_at(i + 2));
            let (normal, corners) = (vector(0), [vector(3), vector(6), vector(9)]);
            self.counts.facets += 1;
            self.counts.attributes += u64::from(facet[48..] != [0, 0]);
            if !are_held(&corners) {
                self.findings.warning(
                    "facets that are left out",
                    || whole(file),
                    || {
                        let number = first + number as u64;
                        let byte = HEAD + number * FACET as u64;
                        let what = blame(&corners);
                        format!("facet {number} (counted from 0, at byte {byte}): {what}; it is left out")
                    },
                );
                continue;
            }
            self.counts.contrary += u64::from(is_contrary(normal, corners));
            // Neighbours in the file are mostly neighbours in space.
            let number = |p: Vec3| match before.iter().position(|known| *known == p) {
                Some(known) => numbered[known],
                None => few.number(p),
            };
            (before, numbered) = (corners, corners.map(number));
            self.indices.push(numbered);
        }
    }

    /// Writes the triangles by the numbers that their corners have in the file.
    fn write(&self, to: &mut [[u32; 3]]) {
        for (to, triangle) in to.iter_mut().zip(&self.indices) {
            *to = triangle.map(|i| self.numbers[i as usize]);
        }
    }
}
