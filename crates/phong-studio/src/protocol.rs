//! What the page and the engine say to one another; `PROTOCOL.md` is the same for people.
//!
//! Messages are JSON, a text each: the page sends [`Request`]s, the engine answers [`Reply`]s. What
//! is large comes as a frame of bytes: [`TileFrame`]s and files.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// The version of the protocol. A page and an engine of different versions do not talk.
pub const VERSION: u32 = 1;

/// What the page asks for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Request {
    /// Reads a scene or a model, and draws it. What was laid over the scene before is forgotten.
    Open {
        /// Its path, relative to the folder that was opened.
        path: String,
    },
    /// Takes this for the scene's text, and draws it if it can be read; if not, the last picture
    /// stays. What was laid over the scene stays, as far as it still applies.
    Edit {
        /// All of the text.
        text: String,
    },
    /// Lays values over the scene: `{"materials.red.shininess": 60}`. Of the same key the newest
    /// counts; `null` takes it back to what the text says.
    Look {
        /// The values by the paths of their keys.
        set: Map<String, Value>,
    },
    /// Takes everything back that was laid over the scene.
    Reset,
    /// Turns the eye about the point that is looked at.
    Turn {
        /// To the right and down, in heights of the picture: 1 is half a turn.
        by: [f64; 2],
    },
    /// Moves the eye and the point that is looked at across the view.
    Move {
        /// To the right and down, in heights of the picture at the distance of that point.
        by: [f64; 2],
    },
    /// Brings the eye nearer or further away.
    Zoom {
        /// What its distance is multiplied by; above 0.
        by: f64,
    },
    /// Says how the pixels of tiles are sent from now on.
    Pixels {
        /// As what.
        kind: PixelKind,
    },
    /// Why a pixel has its colour.
    Explain {
        /// Comes back with the answer.
        id: u64,
        /// Column and row, from the upper left.
        pixel: [u32; 2],
        /// Samples of it to tell, 1 to [`MOST_EXPLAINED`]; 1 is the ray through its centre.
        #[serde(default = "one")]
        samples: u32,
    },
    /// Stops drawing; what is drawn stays.
    Cancel,
    /// Goes on with what was stopped.
    Resume,
    /// Sends the picture or the scene as a file.
    Export {
        /// As what.
        format: FileKind,
    },
    /// Sends the table of keys.
    Keys,
    /// Draws tiny mirrors at random, and counts where they send the light.
    Facets {
        /// Comes back with the answer.
        id: u64,
        /// The angle at which the light comes in, from the normal, degrees in [5, 80].
        theta: f64,
        /// How many, 1 to [`MOST_FACETS`]; more begin with the same ones.
        count: u32,
    },
}

/// The most facets that are drawn at once.
pub const MOST_FACETS: u32 = 1_000_000;

fn one() -> u32 {
    1
}

/// The most samples that are told of one pixel.
pub const MOST_EXPLAINED: u32 = 64;

/// How pixels are sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PixelKind {
    /// Red, green, blue and alpha, a byte each, as a PNG of 8 bits has them.
    #[default]
    Srgb8,
    /// The picture's red, green, blue and its alpha, linear, each an f32: the bits of the film.
    Linear,
}

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FileKind {
    /// The finished picture, as `phong render` writes it.
    Png,
    /// The same with linear values.
    Exr,
    /// The scene's text as it was edited, without what was laid over it.
    Toml,
}

/// What the engine says.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "is", rename_all = "kebab-case")]
pub enum Reply {
    /// The first message.
    Hello {
        /// [`VERSION`].
        protocol: u32,
        /// The program's version.
        version: String,
        /// What to open first.
        open: String,
        /// Scenes and models beside it, by name.
        files: Vec<String>,
    },
    /// What was opened.
    Scene {
        /// Its path.
        path: String,
        /// Its text; `None` for a bare model, which has none.
        text: Option<String>,
    },
    /// All there is to say about the text, as `phong check --json` says it.
    Checked {
        /// Whether it can be drawn.
        ok: bool,
        /// Errors and warnings.
        diagnostics: Vec<Value>,
    },
    /// What the picture shows now. A picture of this number begins.
    Look {
        /// The picture's number; frames and passes of lower ones are out of date.
        picture: u32,
        /// Width and height in pixels.
        size: [u32; 2],
        /// Samples a pixel.
        samples: u32,
        /// Everything but the objects, by the keys of the scene text; what is as by default is left
        /// out.
        values: Value,
        /// The colours of lights, materials and the ambient light by the paths of their keys, as
        /// `#rrggbb`: what a colour well shows. Those that a texture gives are left out.
        wells: Map<String, Value>,
        /// What is laid over the text.
        set: Map<String, Value>,
        /// The command line that draws this very picture; `None` for a bare model that was turned.
        command: Option<String>,
    },
    /// A pass of a picture is done.
    Pass {
        /// The picture's number.
        picture: u32,
        /// The pass, from 0; the first is at an eighth of the size.
        pass: u32,
        /// How many there are.
        passes: u32,
        /// Samples that each pixel now has; 0 after the first.
        samples: u32,
    },
    /// A pixel, explained.
    Explanation {
        /// As asked.
        id: u64,
        /// The picture that it is a pixel of.
        picture: u32,
        /// What `phong explain --json` says.
        told: Value,
        /// Vectors and rays of the first sample, as they are seen in the picture.
        lines: Vec<Line>,
    },
    /// A file; its bytes follow as a frame.
    File {
        /// What to call it.
        name: String,
        /// How many bytes.
        bytes: usize,
    },
    /// The table of keys, as the JSON schema of `phong keys --schema`.
    Keys {
        /// The schema.
        schema: Value,
    },
    /// What tiny mirrors send out, and what they should add up to: densities per steradian.
    Facets {
        /// As asked.
        id: u64,
        /// As asked.
        count: u32,
        /// The angles from the normal between which directions are counted, degrees.
        range: [f64; 2],
        /// For each band of directions, facets by the light that each catches.
        counted: Vec<f64>,
        /// For each band, facets counted alike.
        alike: Vec<f64>,
        /// The lobe of the formula over the same range, at equal distances.
        lobe: Vec<f64>,
        /// How far `counted` is from it: root mean square, in units of its peak.
        error: f64,
    },
    /// A request could not be met. The engine goes on.
    Error {
        /// Why, in one sentence.
        message: String,
    },
}

/// A straight line in the picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// `n`, `l`, `r`, `e` or `h` for a unit vector at the surface; `mirror` and `glass` for a ray that
    /// goes on; `shadow` for the way to what stands before a light.
    pub name: &'static str,
    /// The light that it belongs to, from 1; `None`: to none.
    pub light: Option<usize>,
    /// Where it begins, in pixels of the picture from its upper left; it may be outside.
    pub from: [f64; 2],
    /// Where it ends.
    pub to: [f64; 2],
}

/// A message from the engine, as it is sent.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// JSON.
    Text(String),
    /// Bytes: a tile or a file.
    Frame(Vec<u8>),
}

impl From<&Reply> for Message {
    fn from(reply: &Reply) -> Self {
        // A reply holds nothing that JSON cannot: keys are texts.
        Self::Text(serde_json::to_string(reply).unwrap_or_default())
    }
}

/// Pixels of a part of a picture.
#[derive(Clone, Copy, Debug)]
pub struct TileFrame<'a> {
    /// The picture's number.
    pub picture: u32,
    /// The pass, from 0.
    pub pass: u16,
    /// How many pixels of the picture, across and down, each pixel here stands for: 8 or 1.
    pub step: u8,
    /// Left edge, in pixels of this frame's own grid.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
    /// Three linear values a pixel, rows from top to bottom.
    pub colors: &'a [f32],
    /// One value a pixel.
    pub alphas: &'a [f32],
}

/// Bytes before the pixels of a tile, and before a file.
pub const HEADER: usize = 24;

impl TileFrame<'_> {
    /// As it is sent: one byte for the kind (1 sRGB, 2 linear), one for the step, two for the pass, then
    /// the picture, x, y, width and height in four bytes each, and the pixels; least significant byte
    /// first.
    #[must_use]
    pub fn bytes(&self, kind: PixelKind) -> Vec<u8> {
        let pixels = self.colors.chunks_exact(3).zip(self.alphas);
        let (code, each) = match kind {
            PixelKind::Srgb8 => (1, 4),
            PixelKind::Linear => (2, 16),
        };
        let mut out = Vec::with_capacity(HEADER + each * self.alphas.len());
        out.extend([code, self.step]);
        out.extend(self.pass.to_le_bytes());
        for number in [self.picture, self.x, self.y, self.width, self.height] {
            out.extend(number.to_le_bytes());
        }
        match kind {
            PixelKind::Srgb8 => pixels.for_each(|(color, &alpha)| {
                let straight = |v: f32| if alpha > 0.0 { v / alpha } else { v };
                out.extend(color.iter().map(|&v| phong::image::srgb_level(straight(v))));
                out.push((alpha.clamp(0.0, 1.0) * 255.0 + 0.5) as u8);
            }),
            PixelKind::Linear => pixels.for_each(|(color, alpha)| {
                color.iter().chain([alpha]).for_each(|v| out.extend(v.to_le_bytes()));
            }),
        }
        out
    }
}

/// A file as it is sent: the kind 3, and 23 bytes that say nothing, so that pixels and files begin at
/// the same place.
#[must_use]
pub fn file_frame(bytes: &[u8]) -> Vec<u8> {
    let mut out = vec![0; HEADER];
    out[0] = 3;
    out.extend(bytes);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_reads_as_it_is_written_down() {
        let read = |text| serde_json::from_str::<Request>(text);
        let turn = read(r#"{"do": "turn", "by": [0.1, -0.2]}"#).unwrap();
        assert_eq!(turn, Request::Turn { by: [0.1, -0.2] });
        let explain = read(r#"{"do": "explain", "id": 7, "pixel": [3, 4]}"#).unwrap();
        assert_eq!(explain, Request::Explain { id: 7, pixel: [3, 4], samples: 1 });
        let pixels = read(r#"{"do": "pixels", "kind": "linear"}"#).unwrap();
        assert_eq!(pixels, Request::Pixels { kind: PixelKind::Linear });
        for wrong in
            ["", "{}", "[]", r#"{"do":"fly"}"#, r#"{"do":"turn"}"#, r#"{"do":"open","pfad":"a"}"#]
        {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_tile_begins_with_24_bytes_and_keeps_every_bit_of_linear_values() {
        let (colors, alphas) = ([0.25, 1.0, -0.5, 0.1, f32::MIN_POSITIVE, 3.0], [1.0, 0.5]);
        let tile = TileFrame {
            picture: 258,
            pass: 3,
            step: 1,
            x: 16,
            y: 32,
            width: 2,
            height: 1,
            colors: &colors,
            alphas: &alphas,
        };
        let bytes = tile.bytes(PixelKind::Linear);
        assert_eq!(bytes[..8], [2, 1, 3, 0, 2, 1, 0, 0]);
        assert_eq!(bytes.len(), HEADER + 2 * 16);
        let value = |i: usize| f32::from_le_bytes(bytes[HEADER + 4 * i..][..4].try_into().unwrap());
        let values: Vec<f32> = (0..8).map(value).collect();
        assert_eq!(values, [0.25, 1.0, -0.5, 1.0, 0.1, f32::MIN_POSITIVE, 3.0, 0.5]);
        let bytes = tile.bytes(PixelKind::Srgb8);
        assert_eq!(bytes[HEADER..], [137, 255, 0, 255, 124, 0, 255, 128]);
    }
}
