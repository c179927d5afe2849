//! What a page makes of messages: replies, and a picture put together from tiles.

use phong_studio::protocol::{HEADER, Message};
use serde_json::Value;

/// What was heard so far.
#[derive(Default)]
pub(crate) struct Page {
    pub(crate) replies: Vec<Value>,
    /// The newest picture's values, four a pixel, as the last pass left them.
    pub(crate) pixels: Vec<f32>,
    pub(crate) file: Vec<u8>,
    /// The number of the newest picture, and its width.
    picture: u64,
    width: usize,
}

impl Page {
    pub(crate) fn hear(&mut self, message: &Message) {
        match message {
            Message::Text(text) => {
                let reply: Value = serde_json::from_str(text).unwrap();
                if reply["is"] == "look" {
                    let size = [0, 1].map(|i| reply["size"][i].as_u64().unwrap() as usize);
                    self.picture = reply["picture"].as_u64().unwrap();
                    self.width = size[0];
                    self.pixels = vec![f32::NAN; 4 * size[0] * size[1]];
                }
                self.replies.push(reply);
            }
            Message::Frame(bytes) if bytes[0] == 3 => self.file = bytes[HEADER..].to_vec(),
            Message::Frame(bytes) => {
                let mut rest = &bytes[..];
                while !rest.is_empty() {
                    rest = self.take(rest);
                }
            }
            Message::Nothing => {}
        }
    }

    /// Takes the first of some tiles; the rest.
    fn take<'a>(&mut self, bytes: &'a [u8]) -> &'a [u8] {
        assert_eq!(bytes[0], 2, "linear tiles were asked for");
        let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let (picture, x, y, width, height) =
            (number(4), number(8), number(12), number(16), number(20));
        let (tile, rest) = bytes.split_at(HEADER + 16 * width * height);
        if bytes[1] != 1 || picture as u64 != self.picture {
            return rest;
        }
        let values = tile[HEADER..].chunks_exact(4);
        let values: Vec<f32> = values.map(|v| f32::from_le_bytes(v.try_into().unwrap())).collect();
        for (row, values) in values.chunks_exact(4 * width).enumerate() {
            self.pixels[4 * ((y + row) * self.width + x)..][..4 * width].copy_from_slice(values);
        }
        rest
    }

    /// The replies of a kind, in order.
    pub(crate) fn all(&self, is: &str) -> Vec<&Value> {
        self.replies.iter().filter(|reply| reply["is"] == is).collect()
    }

    pub(crate) fn last(&self, is: &str) -> &Value {
        let all = self.all(is);
        all.last().unwrap_or_else(|| panic!("no `{is}` among {:#?}", self.replies))
    }

    /// Whether the newest picture has all its passes.
    pub(crate) fn is_done(&self) -> bool {
        self.all("pass").iter().any(|pass| {
            pass["picture"].as_u64() == Some(self.picture)
                && pass["pass"].as_u64().unwrap() + 1 == pass["passes"].as_u64().unwrap()
        })
    }
}
