//! A scene written in a format: files, and an account of what became of it.

mod flat;
mod merge;
mod split;

use std::collections::BTreeMap;
use std::io::{self, Write};

pub(crate) use flat::free_name;
pub(crate) use split::split_all;

use super::Format;
use super::toml::write::write_toml;
use crate::diagnostic::Diagnostic;
use crate::format::ply::PlyEncoding;
use crate::material::Material;
use crate::mesh::{Mesh, Points};
use crate::scene::Scene;

/// How a scene is to be written.
///
/// ```
/// use phong_scene::{ExportOptions, Format};
/// let options = ExportOptions { format: Format::Obj, ..ExportOptions::default() };
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ExportOptions {
    /// The format. Default: [`Format::Toml`]; OBJ and PLY are written as well.
    pub format: Format,
    /// How numbers stand in PLY files.
    pub ply: PlyEncoding,
    /// Whether the scene was a bare model: its camera and lights are automatic, so nothing is
    /// lost where a format has none. Default: no.
    pub bare: bool,
    /// Bytes of memory that unfolded instances may take. Default: no limit.
    pub max_bytes: u64,
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self { format: Format::Toml, ply: PlyEncoding::default(), bare: false, max_bytes: u64::MAX }
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

/// What was carried over, how, and what the format cannot hold.
#[derive(Clone, Debug, Default)]
pub struct Account {
    /// How many things of each kind are in the files.
    pub carried: BTreeMap<&'static str, usize>,
    /// What is in the files in another form, a sentence each, with the formula.
    pub mapped: Vec<String>,
    /// What is not in the files: warnings at the places where it was written.
    pub dropped: Vec<Diagnostic>,
}

impl Account {
    /// So many more of a kind are carried over.
    pub(crate) fn carry(&mut self, kind: &'static str, count: usize) {
        if count > 0 {
            *self.carried.entry(kind).or_default() += count;
        }
    }

    pub(crate) fn map(&mut self, how: String) {
        self.mapped.push(how);
    }

    pub(crate) fn drop(&mut self, what: Diagnostic) {
        self.dropped.push(what);
    }
}

/// A file to be written.
#[derive(Debug)]
pub struct File {
    /// Its name: the one that was asked for, or that of one beside it.
    pub name: String,
    pub(crate) content: Content,
}

/// What a file holds.
#[derive(Debug)]
pub(crate) enum Content {
    Text(String),
    Ply(Mesh, PlyEncoding),
    Points(Points, PlyEncoding),
    Obj {
        mesh: Mesh,
        /// What `face_materials` indexes, under their names in the file.
        materials: Vec<Material>,
        /// The first triangle and the name of what the triangles belong to.
        objects: Vec<(usize, String)>,
        /// The MTL file beside it.
        library: Option<String>,
    },
}

impl File {
    /// Writes all of it.
    ///
    /// # Errors
    /// Whatever `to` says.
    pub fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        match &self.content {
            Content::Text(text) => to.write_all(text.as_bytes()),
            Content::Ply(mesh, encoding) => mesh.write_ply(*encoding, to),
            Content::Points(points, encoding) => points.write_ply(*encoding, to),
            Content::Obj { mesh, materials, objects, library } => {
                if let Some(library) = library {
                    writeln!(to, "mtllib {library}")?;
                }
                mesh.write_obj_objects(materials, objects, to)
            }
        }
    }
}

impl Scene {
    /// Turns the scene into files, the first of them called `name`, the others beside it.
    ///
    /// What the scene is drawn from stays: TOML reads back to the same picture, bit for bit,
    /// apart from the numbers of objects where a mesh of several materials becomes several.
    ///
    /// # Errors
    /// What makes the scene one that the format cannot hold at all.
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
    pub fn export(self, options: &ExportOptions, name: &str) -> Result<Export, Box<Diagnostic>> {
        let mut account = Account::default();
        if options.bare && options.format == Format::Toml {
            account
                .map("camera, lights and background are those a bare model is shown with".into());
            let [width, height] = self.image.size;
            account.map(format!(
                "the camera stands where the model fills a picture of {width} × {height}; one of \
                 narrower shape cuts off its sides"
            ));
        }
        let files = match options.format {
            Format::Toml => write_toml(self, name, options.ply, &mut account)?,
            Format::Obj => flat::write_obj(self, options, name, &mut account)?,
            Format::Ply => flat::write_ply(self, options, name, &mut account)?,
            other => {
                let message = format!("{other} files are not written yet");
                let help = format!("write {}", super::endings(&Format::WRITTEN, "or"));
                return Err(Box::new(Diagnostic::error(message, None).with_help(help)));
            }
        };
        Ok(Export { files, account })
    }
}
