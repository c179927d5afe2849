//! What the page and the engine say to one another; `PROTOCOL.md` is the same for people.
//!
//! Messages are JSON, a text each: the page sends [`Request`]s, the engine answers [`Reply`]s. What
//! is large comes as a frame of bytes: [`TileFrame`]s and files.

pub(crate) mod frame;
mod reply;
mod request;

pub use frame::{HEADER, TileFrame, file_frame};
pub use reply::{Choice, Exercise, Handle, Line, Mark, Reply};
pub use request::{FileKind, MOST_EXPLAINED, MOST_EXPONENT, MOST_FACETS, PixelKind, Request};

/// The version of the protocol. A page and an engine of different versions do not talk.
pub const VERSION: u32 = 4;

/// A message from the engine, as it is sent.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// JSON.
    Text(String),
    /// Bytes: a tile or a file.
    Frame(Vec<u8>),
    /// Nothing is sent: it asks whether to go on drawing.
    Nothing,
}

#[cfg(test)]
mod tests {
    use serde_json::Map;

    use super::*;

    #[test]
    fn a_request_reads_as_it_is_written_down() {
        let read = |text| serde_json::from_str::<Request>(text);
        let turn = read(r#"{"do": "turn", "by": [0.1, -0.2]}"#).unwrap();
        assert_eq!(turn, Request::Turn { by: [0.1, -0.2] });
        let explain = read(r#"{"do": "explain", "id": 7, "pixel": [3, 4]}"#).unwrap();
        assert_eq!(explain, Request::Explain { id: 7, pixel: [3, 4], samples: 1, set: Map::new() });
        let pixels = read(r#"{"do": "pixels", "kind": "linear"}"#).unwrap();
        assert_eq!(pixels, Request::Pixels { kind: PixelKind::Linear });
        for wrong in
            ["", "{}", "[]", r#"{"do":"fly"}"#, r#"{"do":"turn"}"#, r#"{"do":"open","pfad":"a"}"#]
        {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
