//! What the page and the engine say to one another; `PROTOCOL.md` is the same for people.
//!
//! Messages are JSON, a text each: the page sends [`Request`]s, the engine answers [`Reply`]s. What
//! is large comes as a frame of bytes: [`TileFrame`]s and files.

pub(crate) mod frame;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

pub use frame::{HEADER, TileFrame, file_frame};

/// The version of the protocol. A page and an engine of different versions do not talk.
pub const VERSION: u32 = 4;

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
        /// What is laid over it from now on; `None`: what was.
        #[serde(default)]
        set: Option<Map<String, Value>>,
    },
    /// Writes values into the text, of which nothing else is changed, and draws that. What was laid
    /// over these keys is taken back.
    Write {
        /// The values by the paths of their keys; `null` takes a key out of the text.
        set: Map<String, Value>,
    },
    /// Puts a look on, by its name: written into the text, lit as the picture is seen now. A bare model has
    /// it on itself.
    PutOn {
        /// Its name, as of `phong render --look`; `None` takes it off a bare model.
        look: Option<String>,
    },
    /// Shows another frame of the trajectories that are open. A bare model is seen as its first frame is; what is
    /// laid over the scene stays.
    Frame {
        /// Its number, from 0.
        number: u64,
    },
    /// Draws what is open with a look on, and changes nothing else: what would come of `put-on`. The next
    /// request that changes the picture ends it.
    TryOn {
        /// Its name; `None` ends it.
        look: Option<String>,
    },
    /// Writes the text into the file that it was opened from. Where somebody else has changed that
    /// meanwhile, nothing is written, and that is said.
    Save {
        /// Whether it is written over such a change.
        #[serde(default)]
        over: bool,
        /// The text that is meant: where the engine has another, nothing is written. `None`: the engine's.
        #[serde(default)]
        text: Option<String>,
    },
    /// Says whether somebody else has changed the file since it was read or saved; if not, nothing.
    CheckFile,
    /// Takes the text that the file has now. What was laid over the scene stays, as far as it still
    /// applies.
    TakeFile,
    /// Drags a handle in the plane through it that faces the camera, and lays the keys that follow it
    /// over the scene.
    Drag {
        /// Which handle.
        path: String,
        /// Where it was taken hold of, in pixels of the picture.
        from: [f64; 2],
        /// Where it is now.
        to: [f64; 2],
        /// Whether it is let go of: then its keys are written into the text.
        #[serde(default)]
        keep: bool,
    },
    /// Leaves terms out of what is drawn from now on. Files are of the whole picture.
    Terms {
        /// The names of those to leave out.
        off: Vec<String>,
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
        /// Values that are laid over the scene for this answer alone, as of `look`.
        #[serde(default)]
        set: Map<String, Value>,
    },
    /// The highlight's lobe at a pixel.
    Lobe {
        /// Comes back with the answer.
        id: u64,
        /// Column and row, from the upper left.
        pixel: [u32; 2],
        /// The light, from 1.
        light: usize,
        /// Values that are laid over the scene for this answer alone, as of `look`.
        #[serde(default)]
        set: Map<String, Value>,
    },
    /// Draws the picture with one mistake in it, for somebody to find.
    Mistake {
        /// Which of those that the scene can show.
        #[serde(default)]
        seed: u64,
        /// The name of the one that is wanted; `None`: the seed decides.
        #[serde(default)]
        cause: Option<String>,
    },
    /// Says what the mistake is.
    Guess {
        /// Its name; `None`: somebody gives up.
        cause: Option<String>,
    },
    /// Holds somebody else's picture of the scene against ours.
    Grade {
        /// What it is called.
        name: String,
        /// Its file, in base 64.
        bytes: String,
    },
    /// Stops drawing; what is drawn stays.
    Cancel,
    /// Goes on with what was stopped.
    Resume,
    /// Sends the finished picture as one tile, and says its last pass, if all of it is there: for who has
    /// given an engine the shares of others. Else nothing is said.
    Finish {
        /// The picture's number.
        picture: u32,
    },
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
    /// How cos^i falls off from the peak of a highlight.
    CosinePower {
        /// Comes back with the answer.
        id: u64,
        /// The exponent i, from 0 to [`MOST_EXPONENT`].
        exponent: f64,
    },
}

/// The largest exponent of which a curve is told.
pub const MOST_EXPONENT: f64 = 1e6;

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
    /// The finished picture with its furniture as outlines over it, as `phong render` writes it.
    Svg,
    /// The scene's text as it was edited, without what was laid over it.
    Toml,
    /// A program in Python that draws what is shown.
    Python,
    /// Every pixel of what is shown explained, in one page for offline use.
    Html,
}

/// What the engine says.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(clippy::large_enum_variant, reason = "one at a time, and written at once")]
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
        /// The look to put on what is opened first; `None`: none.
        look: Option<&'static str>,
        /// Every look by its name.
        looks: Vec<&'static str>,
        /// Whether a text can be saved in its file.
        saves: bool,
    },
    /// What was opened.
    Scene {
        /// Its path.
        path: String,
        /// Its text; `None` for a bare model, which has none.
        text: Option<String>,
    },
    /// The text as it is after values were written into it.
    Text {
        /// All of it.
        text: String,
        /// What is left to say of it; `None`: nothing.
        note: Option<String>,
        /// Whether it is what the file holds.
        from_file: bool,
    },
    /// The text is in its file.
    Saved {
        /// The file.
        path: String,
    },
    /// Somebody else has changed the file since it was read or saved.
    FileChanged {
        /// The file.
        path: String,
        /// Whether it cannot be read any more.
        gone: bool,
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
        /// The look that a bare model has on; `None`: none.
        dressed: Option<&'static str>,
        /// The number of the frame that is shown, from 0.
        frame: u64,
        /// How many frames there are; 1 where nothing that is open has several.
        frames: u64,
        /// The look that is tried on: all else of this is as it would be with it; `None`: none.
        tried: Option<&'static str>,
        /// Points of the scene that can be dragged, where they are seen.
        handles: Vec<Handle>,
        /// The terms that a picture of the scene can have, in the order of the sum.
        terms: Vec<&'static str>,
        /// Those that are left out of what is drawn.
        off: Vec<&'static str>,
        /// Whether something is drawn onto the picture when a pass is whole, such as lines.
        finished: bool,
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
        /// The levels that the pixel has in a picture with a mistake, where one is shown.
        drawn: Option<[u8; 3]>,
        /// Vectors and rays of the first sample, as they are seen in the picture.
        lines: Vec<Line>,
    },
    /// The highlight's lobe at a pixel, in the plane of the normal and a light.
    Lobe {
        /// As asked.
        id: u64,
        /// The pixel.
        pixel: [u32; 2],
        /// The light's name.
        light: String,
        /// The lobe's outline, degree by degree from one horizon to the other: as far from (0, 0) as
        /// it is strong towards there; the strongest is 1. Up is the normal, and the light comes from
        /// the left.
        points: Vec<[f32; 2]>,
        /// Unit vectors, as they lie in this plane.
        marks: Vec<Mark>,
        /// How strong it is at most, with `k_s`, of white light.
        most: f32,
        /// How strong it is towards the eye.
        at_eye: f32,
    },
    /// The picture has a mistake in it. Its tiles follow, then its only pass.
    Mistake {
        /// The picture's number.
        picture: u32,
        /// What it may be.
        choices: Vec<Choice>,
    },
    /// Whether the mistake was found.
    Verdict {
        /// What was said.
        cause: Option<String>,
        /// Whether it is right.
        right: bool,
        /// What is wrong with the picture, and what would be right; `None`: it is still to be found.
        says: Option<String>,
    },
    /// What there is to say about somebody's picture.
    Graded {
        /// What it is called.
        name: String,
        /// What `phong grade --json` says.
        told: Value,
    },
    /// A class sheet was opened.
    Sheet {
        /// What it is called.
        title: String,
        /// What there is to do.
        exercises: Vec<Exercise>,
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
    /// How cos^i falls off from the peak of a highlight.
    CosinePower {
        /// As asked.
        id: u64,
        /// As asked.
        exponent: f64,
        /// The first and the last angle from the peak, degrees.
        range: [f64; 2],
        /// The share of the peak from the first to the last, at equal distances.
        curve: Vec<f64>,
        /// The angle at which half of the peak is left, degrees.
        half_width: f64,
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

/// A point of the scene that can be dragged in the picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Handle {
    /// The key that follows it, or the first of several; it names the handle.
    pub path: String,
    /// `camera`, `light`, `target` (of a spot light) or `object`.
    pub kind: &'static str,
    /// What it is a handle of.
    pub name: String,
    /// Where it is seen, in pixels of the picture from its upper left.
    pub at: [f64; 2],
}

/// One of several mistakes that a picture may have in it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Choice {
    /// Its name, as of `phong grade`.
    pub cause: &'static str,
    /// What is wrong, and what would be right.
    pub says: &'static str,
}

/// Something to do, from a class sheet.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exercise {
    /// What it is called.
    pub title: String,
    /// What to do.
    #[serde(default)]
    pub text: String,
    /// The scene that it is about, relative to the opened folder.
    pub scene: String,
    /// The seed of a mistake to be found in its picture; `None`: there is none.
    #[serde(default)]
    pub mistake: Option<u64>,
}

/// A direction in a plot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mark {
    /// `n`, `l`, `r`, `e` or `h`.
    pub name: &'static str,
    /// Its part in the plane of the plot: shorter than 1 where it leaves that plane.
    pub at: [f32; 2],
}

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

impl From<&Reply> for Message {
    fn from(reply: &Reply) -> Self {
        // A reply holds nothing that JSON cannot: keys are texts.
        Self::Text(serde_json::to_string(reply).unwrap_or_default())
    }
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
