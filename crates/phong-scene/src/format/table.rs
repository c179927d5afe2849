//! The one list of formats: names, endings, readers, writers.
//!
//! A new reader is a folder beside this file and an entry in [`TABLE`].

use std::fmt;

use super::export::WriteScene;
use super::input::{Models, Named, ReadModel, ReadScene};
use super::text::decode;
use super::{cif, gltf, gro, lammps, nff, obj, off, pdb, ply, stl, tachyon, toml, trajectory, xyz};
use crate::source::{Source, ending};
use crate::unpack::head_of;

/// Bytes from the beginning of a file that are looked at to tell its format.
const LOOK: usize = 1 << 10;

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
    /// STL, stereolithography: triangles, binary or as text.
    Stl,
    /// OFF, Geomview's polygons, as text.
    Off,
    /// glTF 2.0, as text or binary (GLB).
    Gltf,
    /// Protein Data Bank: atoms of large molecules.
    Pdb,
    /// CIF: mmCIF of large molecules, and crystals of small ones.
    Cif,
    /// XYZ, plain and extended: atoms, a line each; also plain points.
    Xyz,
    /// GRO, of GROMACS: atoms in nanometres.
    Gro,
    /// LAMMPS: dumps and data files of particles.
    Lammps,
    /// Tachyon scenes, with camera and lights.
    Tachyon,
    /// NFF, Haines' Neutral File Format: scenes with camera and lights.
    Nff,
    /// POV-Ray scenes: known, but programs in a language of their own, which are not read.
    PovRay,
    /// XTC, DCD and TRR: known, but they say where atoms are and not which, and are not read alone. XTC and DCD
    /// are named by the `[[molecule]]` of their atoms.
    Trajectory,
}

/// All that is known of a format.
struct Entry {
    format: Format,
    /// What it is called in a sentence.
    name: &'static str,
    /// The endings of its files, without the dot; the usual one first.
    endings: &'static [&'static str],
    /// Whether a file that begins so, as text if it is some, is surely of it. `None`: its name says so.
    tells: Option<fn(&[u8]) -> bool>,
    /// Whether it holds a model without camera and lights.
    bare: bool,
    /// `None`: known, but not read.
    read: Option<Read>,
    /// `None`: not written yet.
    write: Option<WriteScene>,
}

/// What only programs write: a browser's page keeps its scene as TOML, and goes without 100 KB of
/// code for others.
const fn elsewhere(write: WriteScene) -> Option<WriteScene> {
    if cfg!(target_arch = "wasm32") { None } else { Some(write) }
}

/// How a format is read.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Read {
    /// As a scene with its own camera.
    Scene(ReadScene),
    /// As a piece of a scene.
    Model(ReadModel),
}

/// Every format.
static TABLE: [Entry; 15] = [
    Entry {
        format: Format::Toml,
        name: "TOML scene",
        endings: &["toml"],
        tells: None,
        bare: false,
        read: Some(Read::Scene(toml::read)),
        write: Some(toml::write::write_toml),
    },
    Entry {
        format: Format::Obj,
        name: "OBJ",
        endings: &["obj"],
        tells: None,
        bare: true,
        read: Some(Read::Model(obj::read)),
        write: elsewhere(obj::export::write_obj),
    },
    Entry {
        format: Format::Ply,
        name: "PLY",
        endings: &["ply"],
        tells: Some(ply::is_ply),
        bare: true,
        read: Some(Read::Model(ply::read)),
        write: elsewhere(ply::export::write_ply),
    },
    Entry {
        format: Format::Stl,
        name: "STL",
        endings: &["stl"],
        tells: Some(stl::is_stl),
        bare: true,
        read: Some(Read::Model(stl::read)),
        write: elsewhere(stl::export::write_stl),
    },
    Entry {
        format: Format::Off,
        name: "OFF",
        endings: &["off"],
        tells: Some(off::is_off),
        bare: true,
        read: Some(Read::Model(off::read)),
        write: None,
    },
    Entry {
        format: Format::Gltf,
        name: "glTF",
        endings: &["gltf", "glb"],
        tells: Some(gltf::is_gltf),
        bare: true,
        read: Some(Read::Model(gltf::read)),
        write: elsewhere(gltf::export::write_gltf),
    },
    Entry {
        format: Format::Pdb,
        name: "PDB",
        endings: &["pdb", "ent", "pdbqt"],
        tells: Some(pdb::is_pdb),
        bare: true,
        read: Some(Read::Model(pdb::read)),
        write: None,
    },
    Entry {
        format: Format::Cif,
        name: "CIF",
        endings: &["cif", "mmcif"],
        tells: Some(cif::is_cif),
        bare: true,
        read: Some(Read::Model(cif::read)),
        write: None,
    },
    Entry {
        format: Format::Xyz,
        name: "XYZ",
        endings: &["xyz", "extxyz"],
        tells: None,
        bare: true,
        read: Some(Read::Model(xyz::read)),
        write: None,
    },
    Entry {
        format: Format::Gro,
        name: "GRO",
        endings: &["gro"],
        tells: None,
        bare: true,
        read: Some(Read::Model(gro::read)),
        write: None,
    },
    Entry {
        format: Format::Lammps,
        name: "LAMMPS",
        endings: &["lammpstrj", "dump", "data", "lmp", "lammps"],
        tells: Some(lammps::is_lammps),
        bare: true,
        read: Some(Read::Model(lammps::read)),
        write: None,
    },
    Entry {
        format: Format::Tachyon,
        name: "Tachyon",
        endings: &["dat"],
        tells: Some(tachyon::is_tachyon),
        bare: false,
        read: Some(Read::Scene(tachyon::read)),
        write: elsewhere(tachyon::export::write_tachyon),
    },
    Entry {
        format: Format::Nff,
        name: "NFF",
        endings: &["nff"],
        tells: Some(nff::is_nff),
        bare: false,
        read: Some(Read::Scene(nff::read)),
        write: None,
    },
    Entry {
        format: Format::PovRay,
        name: "POV-Ray",
        endings: &["pov"],
        tells: None,
        bare: false,
        read: None,
        write: None,
    },
    Entry {
        format: Format::Trajectory,
        name: "binary trajectory",
        endings: &["xtc", "dcd", "trr"],
        tells: Some(trajectory::is_trajectory),
        bare: true,
        read: None,
        write: None,
    },
];

/// The table as scenes see it.
pub(crate) static MODELS: Models = Models { find, help: models_are_read_from };

impl Format {
    /// The formats that are read; the others are known by name only.
    #[must_use]
    pub fn readable() -> Vec<Self> {
        Self::those(|entry| entry.read.is_some())
    }

    /// The formats that are written.
    #[must_use]
    pub fn writable() -> Vec<Self> {
        Self::those(|entry| entry.write.is_some())
    }

    fn those(which: fn(&Entry) -> bool) -> Vec<Self> {
        TABLE.iter().filter(|entry| which(entry)).map(|entry| entry.format).collect()
    }

    fn entry(self) -> &'static Entry {
        TABLE.iter().find(|entry| entry.format == self).expect("every format has an entry")
    }

    /// The usual ending of its files, without the dot.
    #[must_use]
    pub fn ending(self) -> &'static str {
        self.entry().endings[0]
    }

    /// The format of a file: what it begins with says it, or else its ending, as of
    /// [`of_path`](Self::of_path). A file that cannot be opened is what its ending says.
    ///
    /// ```
    /// use phong_scene::{Format, Memory};
    /// let files = Memory::new().with("scan.stl", *b"ply\nformat ascii 1.0\n");
    /// assert_eq!(Format::of_file("scan.stl", &files), Some(Format::Ply));
    /// assert_eq!(Format::of_file("gone.stl", &files), Some(Format::Stl));
    /// ```
    #[must_use]
    pub fn of_file(path: &str, source: &dyn Source) -> Option<Self> {
        let head = head_of(source, path, LOOK).map(decode).unwrap_or_default();
        let tells = |entry: &&Entry| entry.tells.is_some_and(|tells| tells(&head));
        TABLE.iter().find(tells).map(|entry| entry.format).or_else(|| Self::of_path(path))
    }

    /// The format that the ending of a path stands for, in capitals or not; that it is packed
    /// (`.ply.gz`) makes no difference.
    #[must_use]
    pub fn of_path(path: &str) -> Option<Self> {
        Self::of_ending(ending(path)?)
    }

    /// The format that an ending without its dot stands for, in capitals or not.
    #[must_use]
    pub fn of_ending(ending: &str) -> Option<Self> {
        let ending = ending.to_ascii_lowercase();
        let known = TABLE.iter().find(|entry| entry.endings.contains(&ending.as_str()));
        known.map(|entry| entry.format)
    }

    /// Whether it holds a model without camera and lights.
    #[must_use]
    pub fn is_bare(self) -> bool {
        self.entry().bare
    }

    /// How it is read; `None`: it is not.
    pub(crate) fn reader(self) -> Option<Read> {
        self.entry().read
    }

    /// How it is written; `None`: not yet.
    pub(crate) fn writer(self) -> Option<WriteScene> {
        self.entry().write
    }

    /// What it is called in a sentence.
    pub(crate) fn name(self) -> &'static str {
        self.entry().name
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

fn find(path: &str, source: &dyn Source) -> Named {
    // What is packed would be unpacked for it, so there the name alone counts if it says something.
    let packed = path.len() > 3 && path.as_bytes()[path.len() - 3..].eq_ignore_ascii_case(b".gz");
    let format = Format::of_path(path).filter(|_| packed);
    match format.or_else(|| Format::of_file(path, source)).map(Format::entry) {
        None => Named::Unknown,
        Some(Entry { read: Some(Read::Model(read)), .. }) => Named::Model(*read),
        Some(Entry { format: Format::Toml, .. }) => Named::Scene,
        Some(Entry { name, read: Some(Read::Scene(_)), .. }) => Named::Foreign(name),
        Some(Entry { name, .. }) => Named::Refused(name),
    }
}

/// `.obj and .ply`, as prose.
pub(crate) fn endings(formats: &[Format], last: &str) -> String {
    let all: Vec<_> = formats.iter().map(|format| format!(".{}", format.ending())).collect();
    all.split_last()
        .map_or_else(String::new, |(end, rest)| format!("{} {last} {end}", rest.join(", ")))
}

/// What models are read from, as a way out.
pub(crate) fn models_are_read_from() -> String {
    let models = Format::those(|entry| matches!(entry.read, Some(Read::Model(_))));
    format!("models are read from {} files", endings(&models, "and"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_has_one_entry_and_every_ending_one_format() {
        for entry in &TABLE {
            assert_eq!(entry.format.entry().name, entry.name);
            for ending in entry.endings {
                assert_eq!(Format::of_ending(ending), Some(entry.format), "{ending}");
            }
        }
    }

    #[test]
    fn an_ending_names_its_format_in_any_case() {
        assert_eq!(Format::of_path("a/b.c/d.PLY"), Some(Format::Ply));
        assert_eq!(Format::of_path("d.glb"), Some(Format::Gltf));
        assert_eq!(Format::of_path("a.toml/readme"), None);
        assert_eq!(Format::of_path("C:\\models\\d.obj"), Some(Format::Obj));
        assert_eq!(Format::of_path("ply"), None);
        assert_eq!(Format::of_path("a/b.OBJ.gz"), Some(Format::Obj));
        assert_eq!(Format::of_path("obj.gz"), None);
    }
}
