//! What the page asks for.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

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

fn one() -> u32 {
    1
}
