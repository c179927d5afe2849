//! Tiles on their way to a client: those of one moment go as one message.
//!
//! A browser takes some tenths of a millisecond for a message, however short, and passes it on through
//! three of its processes: a picture of a message a tile came more slowly than it was drawn, and what was asked
//! for meanwhile was answered behind it.

use std::time::Duration;

use tokio::time::Instant;

use crate::protocol::HEADER;

/// How long a tile waits for others: as long as a screen shows one picture.
const MOMENT: Duration = Duration::from_millis(16);

/// Bytes that are sent at once, whatever the time.
const MOST: usize = 256 << 10;

/// Tiles of one picture that wait to be sent together.
#[derive(Debug)]
pub(super) struct Bundle {
    bytes: Vec<u8>,
    /// When they are to be sent.
    due: Instant,
}

impl Bundle {
    pub(super) fn new() -> Self {
        Self { bytes: Vec::new(), due: Instant::now() }
    }

    /// Puts a tile behind the others.
    pub(super) fn push(&mut self, tile: Vec<u8>) {
        if self.bytes.is_empty() {
            self.due = Instant::now() + MOMENT;
            self.bytes = tile;
        } else {
            self.bytes.extend(tile);
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Whether there is enough for a message.
    pub(super) fn is_full(&self) -> bool {
        self.bytes.len() >= MOST
    }

    /// When they are to be sent, if there are any.
    pub(super) fn due(&self) -> Instant {
        self.due
    }

    /// All of them, one after another.
    pub(super) fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.bytes)
    }
}

/// The number of the picture that a frame is a tile of; `None`: it is a file.
pub(super) fn picture(frame: &[u8]) -> Option<u32> {
    let head = frame.first_chunk::<HEADER>()?;
    (head[0] != 3).then(|| u32::from_le_bytes([head[4], head[5], head[6], head[7]]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::{PixelKind, TileFrame, file_frame};

    fn tile(picture: u32, width: u32) -> Vec<u8> {
        let (colors, alphas) = (vec![0.5; 3 * width as usize], vec![1.0; width as usize]);
        let (pass, step, x, y, height) = (1, 1, 0, 0, 1);
        TileFrame { picture, pass, step, x, y, width, height, colors: &colors, alphas: &alphas }
            .bytes(PixelKind::Srgb8)
    }

    #[test]
    fn tiles_stand_one_behind_another_until_there_are_enough() {
        let mut bundle = Bundle::new();
        assert!(bundle.is_empty() && bundle.take().is_empty());
        bundle.push(tile(7, 3));
        let due = bundle.due();
        bundle.push(tile(7, 2));
        assert_eq!(bundle.due(), due, "the first does not wait for ever");
        assert!(!bundle.is_empty() && !bundle.is_full());
        assert_eq!(bundle.take(), [tile(7, 3), tile(7, 2)].concat());
        assert!(bundle.is_empty());
        bundle.push(tile(8, 1 << 16));
        assert!(bundle.is_full());
    }

    #[test]
    fn tiles_tell_their_picture_and_files_none() {
        assert_eq!(picture(&tile(0x0102_0304, 1)), Some(0x0102_0304));
        assert_eq!(picture(&file_frame(b"text")), None);
        assert_eq!(picture(&[]), None);
    }
}
