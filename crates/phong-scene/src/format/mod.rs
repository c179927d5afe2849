//! The formats scenes and models come in, and the doors to all of them: [`read`] and
//! [`Scene::export`].

mod atoms;
mod cif;
pub(crate) mod export;
mod faces;
mod facets;
pub(crate) mod frames;
pub(crate) mod gltf;
mod gro;
pub(crate) mod input;
mod lammps;
pub(crate) mod mtl;
pub(crate) mod nff;
pub(crate) mod obj;
pub(crate) mod off;
pub(crate) mod origin;
mod pdb;
pub(crate) mod ply;
pub(crate) mod stl;
pub(crate) mod table;
pub(crate) mod tachyon;
mod text;
pub(crate) mod toml;
mod trajectory;
mod triangles;
mod xyz;

use std::io;

use self::export::{Account, File, PlyEncoding, Writing};
use self::input::Input;
use self::table::{Format, MODELS, Read, endings};
use crate::change::Change;
use crate::diagnostic::{Diagnostic, Place, Span};
use crate::frame::{Framing, frame};
use crate::limits::Limits;
use crate::molecule::Topology;
use crate::scene::{Reading, Scene};
use crate::source::Source;
use crate::unpack::Unpacked;

/// What to do with a scene that is a program.
const OF_PROGRAMS: &str = "let the program that wrote it export the model as .obj, .glb or .ply, or the scene as \
                       .dat for Tachyon, as VMD and OVITO do";

/// What to do with frames that say nothing of their atoms.
const OF_TRAJECTORIES: &str = "an XTC or a DCD is named beside the file of its atoms, as `trajectory` of a `[[molecule]]` \
                               (`phong render a.pdb --set molecule.1.trajectory=a.xtc`); of a TRR let the program that \
                               wrote it make an XTC: `gmx trjconv -f a.trr -o a.xtc`";

/// Reads a scene or a bare model, and everything there is to say about it.
///
/// `format` `None` means what the file begins with says, or else the path's ending
/// ([`Format::of_file`]). A bare model is seen from the default
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
    read_changed(path, format, source, limits, &[])
}

/// The same, with these values laid over what the scene's text says.
pub fn read_changed(
    path: &str,
    format: Option<Format>,
    source: &dyn Source,
    limits: &Limits,
    changes: &[Change],
) -> Reading {
    read_known(path, format, source, limits, changes, None)
}

/// The same, where bonds of earlier frames may be known.
fn read_known(
    path: &str,
    format: Option<Format>,
    source: &dyn Source,
    limits: &Limits,
    changes: &[Change],
    topology: Option<&Topology>,
) -> Reading {
    let place = Place { file: path.into(), ..Place::default() };
    let refused = |message: String, help: String, bare| {
        let span = Span { place: place.clone(), ..Span::default() };
        let diagnostics = vec![Diagnostic::error(message, span).with_help(help)];
        Reading { scene: None, bare, diagnostics }
    };
    let Some(format) = format.or_else(|| Format::of_file(path, source)) else {
        let message = "its name does not say what the file is written in".to_owned();
        let help =
            format!("names end in {}; or the format is given", endings(&Format::readable(), "or"));
        return refused(message, help, false);
    };
    let source = &Unpacked::new(source, limits);
    let input = Input { changes, topology, ..Input::new(path, source, limits) };
    let read = match format.reader() {
        None => {
            let (why, help) = match format {
                Format::Trajectory => (
                    "files (XTC, TRR, DCD) do not say which atoms they are of, and",
                    OF_TRAJECTORIES,
                ),
                _ => ("files are programs, which", OF_PROGRAMS),
            };
            return refused(format!("{format} {why} are not read"), help.to_owned(), true);
        }
        Some(Read::Scene(read)) => return read(&input, &MODELS),
        Some(Read::Model(read)) => read,
    };
    let of_atoms = [Format::Pdb, Format::Cif, Format::Xyz, Format::Gro, Format::Lammps];
    let of_molecule = |change: &&Change| change.path().starts_with("molecule.1.");
    let molecule = of_atoms.contains(&format) && changes.iter().any(|c| of_molecule(&c));
    if let Some(change) = changes.iter().find(|change| !molecule || !of_molecule(change)) {
        let message =
            format!("this is a bare model, which has no text for {} to change", change.path());
        let help = if of_atoms.contains(&format) {
            "the keys of a `[[molecule]]` can be set, like `molecule.1.style=sticks`; others in a scene"
        } else {
            "write a scene that names it as `file` of a `[[mesh]]`, and set that one's keys"
        };
        return refused(message, help.to_owned(), true);
    }
    let mut diagnostics = Vec::new();
    let fragment = if molecule {
        toml::read_molecule(&input, read, &MODELS, &mut diagnostics)
    } else {
        read(&input, &mut diagnostics)
    };
    let sound = !diagnostics.iter().any(Diagnostic::is_error);
    let Some(fragment) = fragment.filter(|_| sound) else {
        return Reading { scene: None, bare: true, diagnostics };
    };
    let bare = fragment.camera.is_none() && fragment.lights.is_empty();
    let scene = frame(fragment, &Framing::default(), &place);
    diagnostics.extend(scene.check());
    let sound = !diagnostics.iter().any(Diagnostic::is_error);
    Reading { scene: sound.then_some(scene), bare, diagnostics }
}

/// How a scene is to be written.
///
/// ```
/// use phong_scene::{ExportOptions, Format};
/// let options = ExportOptions { format: Format::Obj, ..ExportOptions::default() };
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ExportOptions {
    /// The format. Default: [`Format::Toml`]; OBJ, PLY, STL, glTF and Tachyon are written as well.
    pub format: Format,
    /// How numbers stand in PLY files.
    pub ply: PlyEncoding,
    /// Whether the scene was a bare model: its camera and lights are automatic, so nothing is
    /// lost where a format has none. Default: no.
    pub bare: bool,
    /// Bytes of memory that unfolded instances may take. Default: no limit.
    pub max_bytes: u64,
    /// Triangles in place of spheres, cylinders, cones, tori, discs and boxes, no point of which is farther
    /// from the surface than this, in scene units, above 0. Default `None`: they stay what they are.
    pub tessellate: Option<f64>,
    /// Whether the images of textures are written beside a TOML file. If not, its text names the files
    /// that the scene names. Default: yes.
    pub images: bool,
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self {
            format: Format::Toml,
            ply: PlyEncoding::default(),
            bare: false,
            max_bytes: u64::MAX,
            tessellate: None,
            images: true,
        }
    }
}

/// What a scene becomes in a format.
#[derive(Debug)]
pub struct Export {
    /// The file that was asked for, then those that it names.
    pub files: Vec<File>,
    /// What became of the scene.
    pub account: Account,
}

impl Export {
    /// What the file that was asked for holds, as text.
    ///
    /// # Errors
    /// It is no text, as of binary formats.
    pub fn text(&self) -> io::Result<String> {
        let mut text = Vec::new();
        if let Some(file) = self.files.first() {
            file.write(&mut text)?;
        }
        String::from_utf8(text).map_err(io::Error::other)
    }
}

impl Scene {
    /// Turns the scene into files, the first of them called `name`, the others beside it.
    ///
    /// What the scene is drawn from stays: TOML reads back to the same picture, bit for bit,
    /// apart from the numbers of objects where a mesh of several materials becomes several.
    ///
    /// # Errors
    /// What makes the scene one that the format cannot hold at all, a tolerance that is none or needs
    /// more memory than `max_bytes`, or the first error of [`Scene::check`].
    ///
    /// ```
    /// use phong_scene::{ExportOptions, Limits, Memory, read};
    /// let text = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
    ///             [[sphere]]\ncenter = [0, 0, 0]\nradius = 0.5\n";
    /// let files = Memory::new().with("ball.toml", text.as_bytes());
    /// let scene = read("ball.toml", None, &files, &Limits::default()).scene.expect("a scene");
    /// let export = scene.export(&ExportOptions::default(), "copy.toml").expect("files");
    /// let mut file = Vec::new();
    /// export.files[0].write(&mut file)?;
    /// assert!(file.ends_with(b"[[sphere]]\ncenter = [0, 0, 0]\nradius = 0.5\n"));
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn export(
        mut self,
        options: &ExportOptions,
        name: &str,
    ) -> Result<Export, Box<Diagnostic>> {
        let Some(write) = options.format.writer() else {
            let message = format!("{} files are not written yet", options.format);
            let help = format!("write {}", endings(&Format::writable(), "or"));
            return Err(Box::new(Diagnostic::error(message, None).with_help(help)));
        };
        if let Some(error) = self.check().into_iter().find(Diagnostic::is_error) {
            return Err(Box::new(error));
        }
        let ExportOptions { format, ply, bare, max_bytes, tessellate, images } = *options;
        let writing = Writing { format: format.name(), ply, bare, max_bytes, images };
        let mut account = Account::default();
        if let Some(tolerance) = tessellate {
            export::tessellate::tessellate(&mut self, tolerance, max_bytes, &mut account)?;
        }
        if !matches!(format, Format::Toml | Format::Gltf) {
            export::tint::work_in(&mut self, &mut account);
        }
        let files = write(self, &writing, name, &mut account)?;
        Ok(Export { files, account })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Memory;

    #[test]
    fn a_file_of_unknown_ending_is_refused_with_a_way_out() {
        let reading = read("a.docx", None, &Memory::new(), &Limits::default());
        assert!(reading.scene.is_none());
        let said = reading.diagnostics[0].to_string();
        assert!(said.starts_with("a.docx: error: its name does not say"), "{said}");
    }

    #[test]
    fn a_known_format_that_is_not_read_says_what_to_do_instead() {
        let files = Memory::new().with("a.pov", *b"camera { location 0 }");
        let reading = read("a.pov", None, &files, &Limits::default());
        let said = reading.diagnostics[0].to_string();
        assert!(reading.scene.is_none() && said.contains("export the model as .obj"), "{said}");
    }

    #[test]
    fn a_binary_trajectory_is_told_by_its_bytes_and_refused_with_a_way_out() {
        let dcd = [&[84, 0, 0, 0][..], b"CORD", &[0; 80]].concat();
        let xtc = [&1995_u32.to_be_bytes()[..], &[0; 80]].concat();
        for (name, bytes) in
            [("a.xtc", xtc.clone()), ("b", xtc), ("c.dcd", dcd.clone()), ("d", dcd)]
        {
            let reading = read(name, None, &Memory::new().with(name, bytes), &Limits::default());
            let said = reading.diagnostics[0].to_string();
            assert!(said.contains("do not say which atoms they are of"), "{said}");
            assert!(reading.diagnostics[0].help.as_ref().is_some_and(|help| help.contains("gmx")));
        }
    }

    #[test]
    fn a_format_that_is_given_wins_over_the_ending() {
        let files = Memory::new().with("-", *b"version = 1");
        let reading = read("-", Some(Format::Toml), &files, &Limits::default());
        assert!(reading.diagnostics[0].to_string().contains("`[camera]`"));
    }
}
