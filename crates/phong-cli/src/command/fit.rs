//! `phong fit`: one model matched to another.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use phong_lab::fit::plot::svg;
use phong_lab::fit::{self, Fit, FitError, Lobe, Model, hold};
use phong_scene::closest;

use crate::failure::Failure;
use crate::output::Output;
use crate::report;

const ABOUT: &str = "\
The exponent or roughness with which model B best matches model A, with the residual.

A is a model with its number, as phong:32; B a model without, whose number is looked for, or with
one, which is then held against A as it is. The fit is least squares over all eyes for light along
the normal, each lobe 1 at its peak; the residual is told for light at other angles, too, in the
plane of incidence and across it: no single number is right for all of them.";

const MODELS: &str = "\
Models, and what their number is:
  phong           exponent of R·E              cook-torrance  m, Beckmann's facets, V-cavities
  blinn-phong     exponent of N·H              beckmann       m, Smith's shadowing
  mtl             Ns: N·H to the Ns            ggx            α, Smith's shadowing
  x3d             shininess: N·H to 128 times  gltf           roughness: ggx with α = roughness²
  ospray          ns: N·H to 4 times           ward           a, along and across the grain
  pov-specular    roughness: N·H to 1/roughness

Examples:
  phong fit phong:32 blinn-phong          about four times, but only in the plane of incidence
  phong fit mtl:200 gltf                  a roughness for an old material
  phong fit phong:32 blinn-phong:128      how good the rule of thumb is
  phong fit ggx:0.3 phong --json
  phong fit mtl:60 gltf --plot fit.svg    # both lobes, and a ball in both models";

/// The exponent or roughness with which model B best matches model A, with the residual
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_help = MODELS)]
pub(crate) struct Args {
    /// The model to match, with its number: phong:32
    #[arg(value_name = "A")]
    from: String,

    /// The model to find the number of: blinn-phong
    #[arg(value_name = "B")]
    to: String,

    /// One JSON object on standard output
    #[arg(long)]
    json: bool,

    /// Draw both lobes, and a ball on a floor in both models, as SVG; - is standard output, and
    /// then nothing else goes there
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let output = args.plot.as_deref().map(Output::create).transpose()?;
    let found = find(&args.from, &args.to).map_err(|error| trouble(&error))?;
    if let Some(mut output) = output {
        output.write(|out| out.write_all(svg(&found).as_bytes()))?;
        Output::commit(vec![output])?;
    }
    if args.plot.as_deref() == Some(Path::new("-")) {
        Ok(())
    } else if args.json {
        report::json(&fit::json(&found))
    } else {
        report::data(as_text(&found, !args.to.contains(':')).as_bytes())
    }
}

fn find(from: &str, to: &str) -> Result<Fit, FitError> {
    let from: Lobe = from.parse()?;
    if to.contains(':') { hold(from, to.parse()?) } else { fit::fit(from, to.parse()?) }
}

/// Says what is wrong with a model, and which one was probably meant.
pub(super) fn trouble(error: &FitError) -> Failure {
    let failure = Failure::usage(error.to_string());
    let FitError::UnknownModel { name } = error else { return failure };
    match closest(name, Model::ALL.iter().map(|model| model.name())) {
        Some(name) => failure.with_help(format!("did you mean `{name}`?")),
        None => failure,
    }
}

fn as_text(fit: &Fit, fitted: bool) -> String {
    let mut text = String::new();
    // Writing to a String does not fail.
    let _ = write_text(&mut text, fit, fitted);
    text
}

fn write_text(out: &mut String, fit: &Fit, fitted: bool) -> std::fmt::Result {
    let [from, to] = [fit.from, fit.to].map(|lobe| lobe.to_string());
    if fitted {
        writeln!(out, "{from} looks most like {to}, for light along the normal.")?;
    } else {
        writeln!(out, "{from} held against {to}.")?;
    }
    if fit.at_the_end {
        writeln!(
            out,
            "That is an end of the range of `{}`: nothing in it fits well.",
            fit.to.model
        )?;
    }
    writeln!(out)?;
    match fit.formula {
        Some(formula) => {
            let on_paper = Lobe { model: fit.to.model, number: formula.value };
            writeln!(out, "By formula   {on_paper}    {}", formula.text)?;
            writeln!(out, "             {}", formula.why)?;
        }
        None => writeln!(out, "By formula   there is none")?,
    }
    writeln!(out)?;
    let room = from.len().max(to.len()).max(13);
    let two = 2 * room + 2;
    writeln!(out, "          residual             {:<two$}  best number", "half width, degrees")?;
    writeln!(out, "light at  in plane  across     {from:<room$}  {to:<room$}  in plane  across")?;
    for at in &fit.angles {
        let [in_plane, across] = [at.residual.in_plane, at.residual.across].map(percent);
        let [from, to] = [at.half_width_from, at.half_width_to]
            .map(|[in_plane, across]| format!("{} / {}", degrees(in_plane), degrees(across)));
        let [alone, alone_across] = at.best_alone.map(brief);
        write!(out, "{:>6}°   {in_plane:<8}  {across:<8}   ", at.theta)?;
        writeln!(out, "{from:<room$}  {to:<room$}  {alone:<8}  {alone_across}")?;
    }
    let [in_plane, across] = [fit.residual.in_plane, fit.residual.across].map(percent);
    writeln!(out, "all       {in_plane:<8}  {across}")?;
    writeln!(out)?;
    writeln!(
        out,
        "Residual: what is left of {from} without {to}, each 1 at its peak, for all eyes"
    )?;
    writeln!(
        out,
        "in the plane of incidence, and across it. Half widths in the same order; - where the"
    )?;
    writeln!(out, "horizon cuts the lobe. Best number: of a fit to that angle and plane alone.")?;
    writeln!(out, "No single number is right for all angles.")?;
    if !fit.in_use.is_empty() {
        writeln!(out)?;
        writeln!(
            out,
            "In use, as a roughness (α = roughness²), for Ns = {}:",
            brief(fit.from.exponent().unwrap_or_default())
        )?;
        for in_use in &fit.in_use {
            writeln!(out, "  {:.3}  {:<18}  {}", in_use.roughness, in_use.text, in_use.source)?;
        }
    }
    Ok(())
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

fn degrees(width: Option<f64>) -> String {
    width.map_or_else(|| "-".to_owned(), |width| format!("{width:.1}"))
}

fn brief(number: f64) -> String {
    match number {
        10.0.. => format!("{number:.0}"),
        1.0.. => format!("{number:.1}"),
        _ => format!("{number:.3}"),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value as Json, json};

    use super::*;

    #[test]
    fn the_json_has_the_shape_that_is_promised() {
        let found = fit::json(&find("phong:32", "blinn-phong").unwrap());
        assert_eq!(found["from"], json!({"model": "phong", "exponent": 32.0}));
        assert_eq!(found["to"]["model"], "blinn-phong");
        let number = |at: &Json| at.as_f64().unwrap();
        assert!((number(&found["to"]["exponent"]) - 129.28).abs() < 0.05);
        assert!((number(&found["formula"]) - 128.69).abs() < 0.01);
        assert!(number(&found["residual"]["in_plane"]) < 0.01);
        assert!(number(&found["residual"]["across"]) > 0.4);
        let rough = fit::json(&find("mtl:200", "ggx").unwrap());
        assert!(number(&rough["to"]["roughness"]) > 0.1);
        assert_eq!(rough["in_use"].as_array().unwrap().len(), 5);
    }

    #[test]
    fn the_text_says_that_no_single_number_is_right() {
        let text = as_text(&find("phong:32", "blinn-phong").unwrap(), true);
        assert!(text.starts_with("phong:32 looks most like blinn-phong:129.3, for light along"));
        assert!(text.contains("By formula   blinn-phong:128.7"));
        assert!(text.contains("No single number is right for all angles."));
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    }

    #[test]
    fn a_number_after_b_is_held_as_it_is() {
        let found = find("phong:32", "blinn-phong:128").unwrap();
        assert_eq!(found.to.number, 128.0);
        assert!(as_text(&found, false).starts_with("phong:32 held against blinn-phong:128."));
    }

    #[test]
    fn trouble_comes_with_the_name_that_was_meant() {
        let error = find("phong:32", "blin-phong").unwrap_err();
        let Failure::Usage { help, .. } = trouble(&error) else { panic!("no usage") };
        assert_eq!(help.as_deref(), Some("did you mean `blinn-phong`?"));
        let Failure::Usage { help, .. } = trouble(&find("lambert:1", "ggx").unwrap_err()) else {
            panic!("no usage")
        };
        assert_eq!(help, None);
    }
}
