//! Sections of a file, read as if they were all of it.

use std::io;
use std::sync::Arc;

use super::scan::Section;
use crate::source::Blob;

/// Sections of a file, one behind the other.
pub(super) struct Excerpt {
    blob: Arc<dyn Blob>,
    sections: Vec<Section>,
}

impl Excerpt {
    pub(super) fn new(blob: Arc<dyn Blob>, sections: Vec<Section>) -> Self {
        Self { blob, sections }
    }
}

/// The number of a line in the whole file, of its number in these sections.
pub(super) fn line_in_file(sections: &[Section], line: u64) -> u64 {
    let mut before = 0;
    for section in sections {
        if line <= before + section.lines {
            return section.line + (line - before).max(1) - 1;
        }
        before += section.lines;
    }
    // Behind the last line, where something is missing.
    sections.last().map_or(line, |last| last.line + last.lines.max(1) - 1)
}

impl Blob for Excerpt {
    fn len(&self) -> u64 {
        self.sections.iter().map(|section| section.end - section.start).sum()
    }

    fn read_at(&self, buffer: &mut [u8], offset: u64) -> io::Result<usize> {
        let mut before = 0;
        for section in &self.sections {
            let length = section.end - section.start;
            if offset < before + length {
                let from = offset - before;
                let most = usize::try_from(length - from).unwrap_or(usize::MAX).min(buffer.len());
                return self.blob.read_at(&mut buffer[..most], section.start + from);
            }
            before += length;
        }
        Ok(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Memory, Source};

    #[test]
    fn an_excerpt_reads_like_a_file_and_knows_the_lines_of_the_whole() {
        let text = b"a\nbb\nccc\ndddd\n";
        let blob = Memory::new().with("a", *text).open("a").expect("memory");
        let sections = vec![
            Section { start: 0, end: 2, line: 1, lines: 1 },
            Section { start: 5, end: 14, line: 3, lines: 2 },
        ];
        let excerpt = Excerpt::new(Arc::from(blob), sections.clone());
        let mut all = [0; 20];
        assert_eq!(excerpt.read_full(&mut all, 0).expect("memory"), 11);
        assert_eq!((&all[..11], excerpt.len()), (&b"a\nccc\ndddd\n"[..], 11));
        assert_eq!(excerpt.read_full(&mut all, 4).expect("memory"), 7);
        assert_eq!([1, 2, 3, 9].map(|line| line_in_file(&sections, line)), [1, 3, 4, 4]);
    }
}
