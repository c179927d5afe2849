//! Binary files: facets of 50 bytes, read block by block in parallel.
//!
//! Each block puts its own corners together while they lie in the cache; what is left of them, about
//! a sixth, is put together over the whole file, in the order of the blocks. So vertices are numbered
//! in the order of first use, whatever the number of threads.

use std::io;
use std::sync::Arc;

use glam::Vec3;
use rayon::prelude::*;

use super::{Counts, FACET, Facets, HEAD, are_held, blame, is_contrary, number_at};
use crate::format::text::{Findings, whole};
use crate::format::triangles::has_room;
use crate::limits::Limits;
use crate::mesh::{Hash, Weld};
use crate::source::Blob;

/// Facets of a block.
const BLOCK: u64 = 1 << 13;

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
    let mut all = Facets::default();
    let hash = Hash::new();
    let mut weld = Weld::with_room((count / 2) as usize, hash);
    all.indices.reserve_exact(count as usize);
    let wave = (2 * rayon::current_num_threads() as u64).clamp(4, 64);
    let blocks = count.div_ceil(BLOCK);
    let mut numbers = Vec::new();
    let mut parsed: Vec<Block> = Vec::new();
    let mut first = 0;
    loop {
        let (room, next) = rayon::join(
            || {
                parsed.drain(..).all(|block| {
                    let bytes = 12 * count + weld.bytes();
                    let vertices = weld.positions().len() as u64;
                    findings.append(block.findings);
                    all.counts.add(block.counts);
                    numbers.clear();
                    numbers.extend(block.positions.iter().map(|p| weld.number(*p)));
                    let number = |i: u32| numbers[i as usize];
                    all.indices.extend(block.indices.iter().map(|t| t.map(number)));
                    has_room(count, vertices, bytes, limits, file, findings)
                })
            },
            || {
                let wave = first..(first + wave).min(blocks);
                let read = |buffer: &mut Vec<u8>, block: u64| {
                    let facets = block * BLOCK..((block + 1) * BLOCK).min(count);
                    buffer.resize((facets.end - facets.start) as usize * FACET, 0);
                    let at = HEAD + facets.start * FACET as u64;
                    if blob.read_full(buffer, at)? < buffer.len() {
                        let message = "it became shorter meanwhile";
                        return Err(io::Error::new(io::ErrorKind::UnexpectedEof, message));
                    }
                    Ok(Block::parse(buffer, facets.start, hash, file))
                };
                wave.into_par_iter().map_init(Vec::new, read).collect::<io::Result<Vec<Block>>>()
            },
        );
        parsed = next?;
        first += wave;
        if !room || parsed.is_empty() {
            break;
        }
    }
    all.positions = weld.into_positions();
    Ok(all)
}

/// Some facets with their own vertices.
#[derive(Debug, Default)]
struct Block {
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    counts: Counts,
    findings: Findings,
}

impl Block {
    /// Parses whole facets, the first of which has this number.
    fn parse(bytes: &[u8], first: u64, hash: Hash, file: &Arc<str>) -> Self {
        let (facets, _) = bytes.as_chunks::<FACET>();
        let mut block = Self::default();
        block.indices.reserve_exact(facets.len());
        let mut weld = Weld::with_room(facets.len(), hash);
        for (number, facet) in facets.iter().enumerate() {
            let (numbers, _) = facet.as_chunks::<4>();
            let number_at = |i: usize| f32::from_le_bytes(numbers[i]);
            let vector = |i: usize| Vec3::new(number_at(i), number_at(i + 1), number_at(i + 2));
            let (normal, corners) = (vector(0), [vector(3), vector(6), vector(9)]);
            block.counts.facets += 1;
            block.counts.attributes += u64::from(facet[48..] != [0, 0]);
            if !are_held(&corners) {
                block.findings.warning(
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
            block.counts.contrary += u64::from(is_contrary(normal, corners));
            block.indices.push(corners.map(|p| weld.number(p)));
        }
        block.positions = weld.into_positions();
        block
    }
}
