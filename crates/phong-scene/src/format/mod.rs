//! The formats scenes and models come in, and the door to all of them: [`read`].

pub(crate) mod export;
pub(crate) mod mtl;
pub(crate) mod obj;
mod origin;
pub(crate) mod ply;
mod text;
pub(crate) mod toml;

use std::fmt;

use crate::diagnostic::{Diagnostic, Place, Span};
use crate::fragment::Fragment;
use crate::frame::{Framing, frame};
use crate::limits::Limits;
use crate::scene::Reading;
use crate::source::Source;

/// What a file is written in.
///
/// ```
/// use phong_scene::Format;
/// assert_eq!(Format::of_path("scenes/balls.TOML"), Some(Format::Toml));
/// assert_eq!(Format::of_path("balls"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Our own scene text.
    Toml,
    /// Wavefront OBJ, with the MTL files it names.
    Obj,
    /// Stanford PLY: meshes and clouds of points.
    Ply,
    /// Stereolithography. Known, not read yet.
    Stl,
    /// glTF 2.0, as text or binary. Known, not read yet.
    Gltf,
    /// Protein Data Bank. Known, not read yet.
    Pdb,
    /// mmCIF. Known, not read yet.
    Cif,
    /// XYZ coordinates. Known, not read yet.
    Xyz,
    /// Tachyon scenes. Known, not read yet.
    Tachyon,
    /// Neutral File Format. Known, not read yet.
    Nff,
}

impl Format {
    /// Every format with the endings of its files, the usual one first.
    const ENDINGS: [(Self, &'static [&'static str]); 10] = [
        (Self::Toml, &["toml"]),
        (Self::Obj, &["obj"]),
        (Self::Ply, &["ply"]),
        (Self::Stl, &["stl"]),
        (Self::Gltf, &["gltf", "glb"]),
        (Self::Pdb, &["pdb"]),
        (Self::Cif, &["cif"]),
        (Self::Xyz, &["xyz"]),
        (Self::Tachyon, &["dat"]),
        (Self::Nff, &["nff"]),
    ];

    /// The formats that are read; the others are known by name only.
    pub const READ: [Self; 3] = [Self::Toml, Self::Obj, Self::Ply];

    /// The formats that are written.
    pub const WRITTEN: [Self; 3] = [Self::Toml, Self::Obj, Self::Ply];

    /// The usual ending of its files, without the dot.
    #[must_use]
    pub fn ending(self) -> &'static str {
        let own = Self::ENDINGS.iter().find(|(format, _)| *format == self);
        own.map_or("", |(_, endings)| endings[0])
    }

    /// The format that the ending of a path stands for, in capitals or not.
    #[must_use]
    pub fn of_path(path: &str) -> Option<Self> {
        let (_, ending) = path.rsplit(['/', '\\']).next()?.rsplit_once('.')?;
        Self::of_ending(ending)
    }

    /// The format that an ending without its dot stands for, in capitals or not.
    #[must_use]
    pub fn of_ending(ending: &str) -> Option<Self> {
        let ending = ending.to_ascii_lowercase();
        let known = Self::ENDINGS.iter().find(|(_, endings)| endings.contains(&ending.as_str()));
        known.map(|&(format, _)| format)
    }

    /// Whether it holds a model without camera and lights.
    #[must_use]
    pub fn is_bare(self) -> bool {
        !matches!(self, Self::Toml | Self::Tachyon | Self::Nff)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Toml => "TOML scene",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Gltf => "glTF",
            Self::Pdb => "PDB",
            Self::Cif => "mmCIF",
            Self::Xyz => "XYZ",
            Self::Tachyon => "Tachyon",
            Self::Nff => "NFF",
        })
    }
}

/// Reads a scene or a bare model, and everything there is to say about it.
///
/// `format` `None` means what the path's ending says. A bare model is seen from the default
/// [`Framing`]; [`Scene::frame`](crate::Scene::frame) looks at it from another.
///
/// ```
/// use phong_scene::{Limits, Memory, read};
/// let text = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n[[sphere]]\ncenter = [0, 0, 0]\nradus = 1\n";
/// let files = Memory::new().with("ball.toml", text.as_bytes());
/// let reading = read("ball.toml", None, &files, &Limits::default());
/// assert!(reading.scene.is_none());
/// assert_eq!(
///     reading.diagnostics[0].to_string(),
///     "ball.toml:5:1: error: this `sphere` has no `radius` (`radius` is a number above 0)",
/// );
/// assert_eq!(
///     reading.diagnostics[1].to_string(),
///     "ball.toml:7:1: error: unknown key \"radus\" in this `sphere` (did you mean `radius`?)",
/// );
/// ```
pub fn read(path: &str, format: Option<Format>, source: &dyn Source, limits: &Limits) -> Reading {
    let place = Place { file: path.into(), ..Place::default() };
    let Some(format) = format.or_else(|| Format::of_path(path)) else {
        let span = Span { place, ..Span::default() };
        let message = "its name does not say what the file is written in";
        let help = format!("names end in {}; or the format is given", endings(&Format::READ, "or"));
        return refused(Diagnostic::error(message, span).with_help(help));
    };
    if format == Format::Toml {
        return toml::read_toml(path, source, limits);
    }
    let mut diagnostics = Vec::new();
    let fragment = read_model(path, format, None, source, limits, &mut diagnostics);
    let sound = !diagnostics.iter().any(Diagnostic::is_error);
    let Some(fragment) = fragment.filter(|_| sound) else {
        return Reading { scene: None, bare: true, diagnostics };
    };
    let bare = fragment.camera.is_none() && fragment.lights.is_empty();
    let scene = Some(frame(fragment, &Framing::default(), &place));
    Reading { scene, bare, diagnostics }
}

/// Reads a model file; `None` if a diagnostic is an error.
///
/// `default_radius` is of points for which the file gives none.
pub(crate) fn read_model(
    path: &str,
    format: Format,
    default_radius: Option<f32>,
    source: &dyn Source,
    limits: &Limits,
    out: &mut Vec<Diagnostic>,
) -> Option<Fragment> {
    match format {
        Format::Obj => obj::read_obj(path, source, limits, out),
        Format::Ply => ply::read_ply(path, source, limits, default_radius, out),
        _ => {
            let place = Place { file: path.into(), ..Place::default() };
            let message = match format {
                Format::Toml => "a scene is not a model".to_owned(),
                _ => format!("{format} files are not read yet"),
            };
            let help = models_are_read_from();
            let span = Span { place, ..Span::default() };
            out.push(Diagnostic::error(message, span).with_help(help));
            None
        }
    }
}

/// The formats of bare models that are read.
const MODELS: [Format; 2] = [Format::Obj, Format::Ply];

/// `.obj and .ply`, as prose.
fn endings(formats: &[Format], last: &str) -> String {
    let all: Vec<_> = formats.iter().map(|format| format!(".{}", format.ending())).collect();
    all.split_last()
        .map_or_else(String::new, |(end, rest)| format!("{} {last} {end}", rest.join(", ")))
}

/// What models are read from, as a way out.
pub(crate) fn models_are_read_from() -> String {
    format!("models are read from {} files", endings(&MODELS, "and"))
}

/// No scene, for this reason alone.
fn refused(diagnostic: Diagnostic) -> Reading {
    Reading { scene: None, bare: false, diagnostics: vec![diagnostic] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Memory;

    #[test]
    fn an_ending_names_its_format_in_any_case() {
        assert_eq!(Format::of_path("a/b.c/d.PLY"), Some(Format::Ply));
        assert_eq!(Format::of_path("d.glb"), Some(Format::Gltf));
        assert_eq!(Format::of_path("a.toml/readme"), None);
        assert_eq!(Format::of_path("C:\\models\\d.obj"), Some(Format::Obj));
        assert_eq!(Format::of_path("ply"), None);
    }

    #[test]
    fn a_file_of_unknown_ending_is_refused_with_a_way_out() {
        let reading = read("a.docx", None, &Memory::new(), &Limits::default());
        assert!(reading.scene.is_none());
        let said = reading.diagnostics[0].to_string();
        assert!(said.starts_with("a.docx: error: its name does not say"), "{said}");
    }

    #[test]
    fn a_known_format_that_is_not_built_says_not_yet() {
        for path in ["a.stl", "a.gltf", "a.glb", "a.pdb", "a.cif", "a.xyz", "a.dat", "a.nff"] {
            let reading = read(path, None, &Memory::new().with(path, *b""), &Limits::default());
            let said = reading.diagnostics[0].to_string();
            assert!(reading.scene.is_none() && said.contains("not read yet"), "{said}");
        }
    }

    #[test]
    fn the_formats_that_are_read_are_those_that_do_not_say_not_yet() {
        for (format, [ending, ..]) in Format::ENDINGS.map(|(f, e)| (f, [e[0], ""])) {
            assert_eq!(format.ending(), ending);
            let path = format!("a.{ending}");
            let reading = read(&path, None, &Memory::new().with(&*path, *b""), &Limits::default());
            let refused = reading.diagnostics.iter().any(|d| d.message.contains("not read yet"));
            assert_ne!(refused, Format::READ.contains(&format), "{ending}");
        }
    }

    #[test]
    fn a_format_that_is_given_wins_over_the_ending() {
        let files = Memory::new().with("-", *b"version = 1");
        let reading = read("-", Some(Format::Toml), &files, &Limits::default());
        assert!(reading.diagnostics[0].to_string().contains("`[camera]`"));
    }
}
