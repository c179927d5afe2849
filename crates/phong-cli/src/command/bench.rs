//! `phong bench`: how fast a scene is read, built and traced.

use std::fmt::Write as _;
use std::time::Instant;

use phong_lab::measure::{Holdings, RaySpeed, Speeds, memory};
use serde_json::{Map, Value as Json, json};

use crate::args::QuestionArgs;
use crate::compile::compile;
use crate::failure::Failure;
use crate::progress::rate;
use crate::{input, report};

const EXAMPLES: &str = "\
Examples:
  phong bench dragon.ply
  phong bench scene.toml --json";

/// Bytes that the rays of a pixel take, at least.
const RAYS: u64 = 60;

/// Rays per second by kind, time by stage, bytes per primitive
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    question: QuestionArgs,
}

pub(crate) fn run(Args { question: args }: &Args) -> Result<(), Failure> {
    let started = Instant::now();
    let input = input::open(&args.input, false)?;
    let read = started.elapsed().as_secs_f64();
    let size = input.scene.image.size;
    let started = Instant::now();
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    let scene = compile(&input.scene, &args.input, pixels.saturating_mul(RAYS))?;
    let build = started.elapsed().as_secs_f64();
    let held = Holdings::of(scene.geometry());
    let (primitives, per_primitive) = (held.primitives(), held.bytes_per_primitive());
    let Speeds { primary, shadow, secondary } = Speeds::of(&scene, size);
    let kinds = [("primary", primary), ("shadow", shadow), ("secondary", secondary)];
    if args.json {
        let by_kind = |value: fn(&RaySpeed) -> Json| -> Json {
            kinds
                .iter()
                .map(|(kind, m)| ((*kind).to_owned(), value(m)))
                .collect::<Map<_, _>>()
                .into()
        };
        return report::json(&json!({
            "threads": rayon::current_num_threads(),
            "size": size,
            "seconds": { "read": read, "build": build },
            "rays": by_kind(|m| json!(m.rays)),
            "rays_per_second": by_kind(|m| json!(m.per_second())),
            "primitives": primitives,
            "bytes": held.bytes,
            "bytes_per_primitive": per_primitive,
            "peak_bytes": memory::peak(),
        }));
    }
    let mut text = format!("read        {read:.3} s\nbuild       {build:.3} s\n");
    for (kind, RaySpeed { rays, seconds }) in &kinds {
        let told = if *rays == 0 { "no rays".to_owned() } else { rate(*rays, *seconds) };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{kind:<12}{told}");
    }
    let _ = writeln!(text, "memory      {per_primitive:.1} bytes a primitive, of {primitives}");
    report::data(text.as_bytes())
}
