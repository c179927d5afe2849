//! Faces whose corners are written over several lines, as a stream of numbers would be.

use std::io;

use crate::source::Blob;

/// The rows from byte `body` on, those of so many vertices first, with every face on a line of its own;
/// `None`: they were so before, or they are more than `most` bytes, or no faces.
pub(super) fn rejoined(
    blob: &dyn Blob,
    body: u64,
    vertices: u64,
    most: u64,
) -> io::Result<Option<Vec<u8>>> {
    let length = blob.len().saturating_sub(body);
    if length > most {
        return Ok(None);
    }
    let mut text = vec![0; length as usize];
    let read = blob.read_full(&mut text, body)?;
    text.truncate(read);
    let mut rows = Vec::with_capacity(text.len() + 1);
    let mut lines = text.split(|b| *b == b'\n').filter_map(|line| {
        let line = line.split(|b| *b == b'#').next().unwrap_or_default().trim_ascii();
        (!line.is_empty()).then_some(line)
    });
    for line in lines.by_ref().take(usize::try_from(vertices).unwrap_or(usize::MAX)) {
        rows.extend_from_slice(line);
        rows.push(b'\n');
    }
    // How many words of the face are still to come.
    let (mut wanted, mut joined) = (0_usize, false);
    for line in lines {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        if wanted == 0 {
            let count =
                words.clone().next().and_then(|word| str::from_utf8(word).ok()?.parse().ok());
            let Some(count) = count.and_then(|count: usize| count.checked_add(1)) else {
                return Ok(None);
            };
            wanted = count;
        } else {
            joined = true;
        }
        wanted = wanted.saturating_sub(words.by_ref().count());
        rows.extend_from_slice(line);
        rows.push(if wanted == 0 { b'\n' } else { b' ' });
    }
    Ok(joined.then_some(rows))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Memory, Source};

    #[test]
    fn faces_are_joined_and_what_is_no_face_is_not() {
        let joined = |text: &str| {
            let source = Memory::new().with("a", text.as_bytes());
            let blob = source.open("a").expect("it is there");
            let rows = rejoined(&*blob, 0, 1, 1000).expect("memory");
            rows.map(|rows| String::from_utf8(rows).expect("text"))
        };
        let rows = joined("0 0 0\n\n3 0 # the first\n1\n2\n3 0 0 0 1 0 0\n").expect("rows");
        assert_eq!(rows, "0 0 0\n3 0 1 2\n3 0 0 0 1 0 0\n");
        assert_eq!(joined("0 0 0\n3 0 1 2\n3 0 0 0\n"), None);
        assert_eq!(joined("0 0 0\n3 0 1\n2\nx 0 0 0\n"), None);
    }
}
