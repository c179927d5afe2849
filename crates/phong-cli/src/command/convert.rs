//! `phong convert`: from one scene format to another.

use std::ffi::OsStr;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use phong_lab::tell::diagnostic;
use phong_scene::{
    Account, Diagnostic, Export, ExportOptions, File, Format, PlyEncoding, Severity,
};
use serde_json::json;

use crate::args::{
    InputArgs, PictureSize, ViewArgs, output_help, size, written_endings, written_format,
    written_help,
};
use crate::failure::Failure;
use crate::output::{Output, keep_inputs_safe};
use crate::progress::Meter;
use crate::{input, memory, report};

const EXAMPLES: &str = "\
Examples:
  phong convert dragon.ply dragon.toml --view front    # a scene to go on with: camera, lights
  phong convert dragon.ply dragon.toml --size 600x800  # framed for a picture on end
  phong convert scene.toml scene.obj                   # and scene.mtl, with what MTL can hold
  phong convert atoms.pdb atoms.glb --tessellate 0.02  # spheres and sticks as triangles
  phong convert model.obj model.ply --strict           # refused if anything would be lost
  phong convert scene.toml - --to ply > scene.ply

What OUT cannot hold is a warning with its place; what is written in another form is told with
the formula. Meshes and points of a .toml lie beside it, in OUT's stem.mesh-1.ply and so on.";

/// From one format to another, with a report of what was mapped and what was dropped
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: InputArgs,

    #[arg(value_name = "OUT", help = output_help())]
    output: PathBuf,

    #[arg(long, value_name = "NAME", value_parser = written_format, help = written_help())]
    to: Option<Format>,

    /// PLY files as text instead of binary
    #[arg(long)]
    ascii: bool,

    /// Triangles in place of spheres, cylinders, cones, tori, discs and boxes, nowhere farther than this
    /// from the surface, in scene units
    #[arg(long, value_name = "TOLERANCE", value_parser = tolerance, allow_hyphen_values = true)]
    tessellate: Option<f64>,

    /// Width and height of the scene's picture, which a bare model is framed for
    #[arg(long, value_name = "WxH", value_parser = size, allow_hyphen_values = true)]
    size: Option<PictureSize>,

    /// The report as one JSON object on standard output
    #[arg(long)]
    json: bool,

    /// No talk but errors
    #[arg(short, long)]
    quiet: bool,

    // Last: its heading holds for all that follows.
    #[command(flatten)]
    view: ViewArgs,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let stdout = args.output == Path::new("-");
    if stdout && args.json {
        return Err(Failure::usage("--json and - both want standard output"));
    }
    let format = output_format(args)?;
    // What cannot be written is known before anything is read.
    let mut outputs = vec![Output::create(&args.output)?];
    keep_inputs_safe(&outputs, [&args.input.input])?;

    let meter = Meter::new(args.quiet, "reading");
    let mut input = input::open(&args.input, args.quiet)?;
    let image = &mut input.scene.image;
    image.size = args.size.map_or(image.size, |size| size.0);
    input::look(&mut input, &args.view)?;
    meter.stage("converting");
    let ply = if args.ascii { PlyEncoding::Ascii } else { PlyEncoding::Binary };
    let (bare, tessellate, images) = (input.bare, args.tessellate, true);
    let max_bytes = memory::limit();
    let options = ExportOptions { format, ply, bare, max_bytes, tessellate, images };
    let name = args.output.file_name().unwrap_or(OsStr::new("-")).to_string_lossy();
    let inputs = input.files().to_vec();
    let Export { files, account } =
        input.scene.export(&options, &name).map_err(|error| Failure::Input(vec![*error]))?;
    if args.input.strict && !account.dropped.is_empty() {
        let strict = |d| Diagnostic { severity: Severity::Error, ..d };
        return Err(Failure::Input(account.dropped.into_iter().map(strict).collect()));
    }
    if stdout && files.len() > 1 {
        return Err(Failure::usage("several files do not fit into standard output")
            .with_help("give the name of a file to write the others beside"));
    }
    let beside = |file: &File| args.output.with_file_name(&file.name);
    for file in files.iter().skip(1) {
        outputs.push(Output::create(&beside(file))?);
    }
    keep_inputs_safe(&outputs, &inputs)?;
    meter.stage("writing");
    for (file, output) in files.iter().zip(&mut outputs) {
        output.write(|out| {
            let mut out = BufWriter::with_capacity(1 << 18, out);
            file.write(&mut out)?;
            out.flush()
        })?;
    }
    Output::commit(outputs)?;
    meter.finish();

    let paths: Vec<_> = files.iter().skip(1).map(beside).collect();
    let paths: Vec<_> = std::iter::once(&args.output).chain(&paths).collect();
    // Memory goes back to the system with the process, all at once.
    std::mem::forget(files);
    if args.json {
        return report::json(&json!({
            "input": args.input.input,
            "output": args.output.to_string_lossy(),
            "format": format.to_string(),
            "files": paths.iter().map(|path| path.to_string_lossy()).collect::<Vec<_>>(),
            "carried": account.carried,
            "mapped": account.mapped,
            "dropped": account.dropped.iter().map(diagnostic).collect::<Vec<_>>(),
            "warnings": input.warnings.iter().map(diagnostic).collect::<Vec<_>>(),
        }));
    }
    if !args.quiet {
        tell(&paths, &account);
    }
    Ok(())
}

/// A length above 0.
fn tolerance(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "a tolerance is a number above 0".to_owned())
}

/// What to write, by `--to` or by OUT's name.
fn output_format(args: &Args) -> Result<Format, Failure> {
    let format = args.to.or_else(|| Format::of_path(&args.output.to_string_lossy()));
    let help = format!("end OUT in {}, or give --to", written_endings());
    match format {
        Some(format) if Format::writable().contains(&format) => Ok(format),
        Some(other) => {
            Err(Failure::usage(format!("{other} files are not written yet")).with_help(help))
        }
        None => {
            let what = format!("the name {} does not say what to write", args.output.display());
            Err(Failure::usage(what).with_help(help))
        }
    }
}

/// The report, for people.
fn tell(paths: &[&PathBuf], account: &Account) {
    let Account { carried, mapped, dropped } = account;
    for path in paths {
        report::say(&format!("wrote {}", path.display()));
    }
    let carried = carried.iter().map(|(kind, n)| match (*kind, n) {
        ("cylinders", 1) => "1 bundle of cylinders".to_owned(),
        ("cylinders", n) => format!("{n} bundles of cylinders"),
        (kind, 1) => format!("1 {kind}"),
        ("box", n) => format!("{n} boxes"),
        ("torus", n) => format!("{n} tori"),
        ("mesh", n) => format!("{n} meshes"),
        ("points", n) => format!("{n} clouds of points"),
        (kind, n) => format!("{n} {kind}s"),
    });
    let carried = carried.collect::<Vec<_>>().join(", ");
    report::say(&format!(
        "carried over: {}",
        if carried.is_empty() { "nothing" } else { &carried }
    ));
    for how in mapped {
        report::say(&format!("mapped: {how}"));
    }
    report::diagnostics(dropped);
}
