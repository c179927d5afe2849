//! The keys of a batch: which pictures are to be made, and how they are called.

use super::{Default, Key, Kind, Table, VERSION};

/// A batch file as a whole.
pub(crate) static BATCH: Table = Table {
    name: "batch",
    doc: "A batch file.",
    select: None,
    keys: &[&[
        VERSION,
        Key::new(
            "inputs",
            Kind::Files,
            Default::Required,
            "Scenes or bare models, relative to this file's folder. `*`, `?` and `[..]` stand for \
             parts of a name; numbers in names are sorted as numbers.",
        ),
        Key::new(
            "output",
            Kind::File,
            Default::Said("this file's name without its ending"),
            "The folder that pictures are written to, relative to this file's folder.",
        ),
        Key::new(
            "name",
            Kind::Text,
            Default::Said("`{scene}` and the values of all parameters"),
            "What pictures are called. `{scene}` is the input's name, `{frame}` its number from 0, \
             `{task}` the picture's number from 0, and a parameter's path, or its last word, its \
             value. The ending (.png, .pfm or .exr) says what is written; without one it is PNG.",
        ),
        Key::new(
            "options",
            Kind::Text,
            Default::Said("none"),
            "Options of `phong render` for every picture, as on its command line: \
             `--size 640x360 --samples 4 --terms`.",
        ),
        Key::new(
            "combine",
            Kind::Word(&["cross", "zip"]),
            Default::Word("cross"),
            "Whether there is a picture for every input with every combination of values, or one \
             for the first input and the first values, one for the second, and so on.",
        ),
        Key::new(
            "shares",
            Kind::Integer(1, MOST_SHARES),
            Default::Integer(1),
            "Tasks that each picture is divided into; one more puts it together.",
        ),
        Key::new(
            "threads",
            Kind::Integer(1, 4096),
            Default::Said("all cores"),
            "Threads of each task; in a Slurm job its `cpus-per-task`.",
        ),
        Key::new(
            "parameters",
            Kind::Values,
            Default::Said("none"),
            "What differs from picture to picture: values by the path of a scene's key.",
        ),
        Key::new(
            "slurm",
            Kind::Options,
            Default::Said("none"),
            "Options of `sbatch`, such as `time` and `partition`, for `--script slurm`.",
        ),
    ]],
};

/// `{ from, to, steps }`.
pub(crate) static RANGE: Table = Table {
    name: "range",
    doc: "Values at equal distances.",
    select: None,
    keys: &[&[
        Key::new("from", Kind::Numbers, Default::Required, "The first value."),
        Key::new("to", Kind::Numbers, Default::Required, "The last value."),
        Key::new(
            "steps",
            Kind::Integer(1, MOST_VALUES),
            Default::Required,
            "How many values there are, the first and the last included.",
        ),
    ]],
};

/// `{ files }`.
pub(crate) static FILES: Table = Table {
    name: "files",
    doc: "Files as values of a key that names one, such as `mesh.1.file`.",
    select: None,
    keys: &[&[Key::new(
        "files",
        Kind::File,
        Default::Required,
        "A pattern as in `inputs`, relative to the batch file's folder.",
    )]],
};

/// The most tasks of one picture.
const MOST_SHARES: u64 = 10_000;

/// The most values of one parameter.
const MOST_VALUES: u64 = 1_000_000;
