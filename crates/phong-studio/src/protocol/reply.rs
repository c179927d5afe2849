//! What the engine says.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::Message;

/// What the engine says.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(clippy::large_enum_variant, reason = "one at a time, and written at once")]
#[serde(tag = "is", rename_all = "kebab-case")]
pub enum Reply {
    /// The first message.
    Hello {
        /// [`VERSION`](super::VERSION).
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

impl From<&Reply> for Message {
    fn from(reply: &Reply) -> Self {
        // A reply holds nothing that JSON cannot: keys are texts.
        Self::Text(serde_json::to_string(reply).unwrap_or_default())
    }
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
