//! `phong bench`: how fast a scene is read, built and traced.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use glam::DVec2;
use phong::film::{Film, Window};
use phong::render::RenderOptions;
use phong::view::View;
use phong_bvh::{Hits8, Ray, Rays8, lanes};
use rayon::prelude::*;
use serde_json::{Map, Value as Json, json};

use crate::args::QuestionArgs;
use crate::compile::compile;
use crate::failure::Failure;
use crate::progress::rate;
use crate::{input, memory, report};

const EXAMPLES: &str = "\
Examples:
  phong bench dragon.ply
  phong bench scene.toml --json";

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
    let scene = compile(input.scene, &args.input, 0)?;
    let build = started.elapsed().as_secs_f64();
    let bytes = memory::of_hierarchy(scene.bvh());
    let primitives = scene.bvh().stats().primitives;

    let bundles = Bundles::of(&scene, size);
    let kinds = [
        ("primary", best(&bundles.primary, |rays| closest(&scene, rays))),
        ("shadow", best(&bundles.shadow, |rays| any(&scene, rays))),
        ("secondary", best(&bundles.secondary, |rays| closest(&scene, rays))),
    ];
    let per_primitive = bytes as f64 / primitives.max(1) as f64;
    if args.json {
        let by_kind = |value: fn(&Measured) -> Json| -> Json {
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
            "rays_per_second": by_kind(|m| json!(m.rays as f64 / m.seconds)),
            "primitives": primitives,
            "bytes": bytes,
            "bytes_per_primitive": per_primitive,
            "peak_bytes": memory::peak(),
        }));
    }
    let mut text = format!("read        {read:.3} s\nbuild       {build:.3} s\n");
    for (kind, Measured { rays, seconds }) in &kinds {
        let told = if *rays == 0 { "no rays".to_owned() } else { rate(*rays, *seconds) };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{kind:<12}{told}");
    }
    let _ = writeln!(text, "memory      {per_primitive:.1} bytes a primitive, of {primitives}");
    report::data(text.as_bytes())
}

/// Rays that are traced together, by tile.
#[derive(Debug, Default)]
struct Bundles {
    /// Through the middle of every pixel.
    primary: Vec<Vec<Rays8>>,
    /// From where those meet a surface to every light.
    shadow: Vec<Vec<Rays8>>,
    /// From there on as off a mirror.
    secondary: Vec<Vec<Rays8>>,
}

impl Bundles {
    fn of(scene: &View, size: [u32; 2]) -> Self {
        let film = Film::new(size, Window::full(size), RenderOptions::TILE, &[]);
        let mut bundles = Self::default();
        for tile in 0..film.tiles() {
            let Window { x0, y0, x1, y1 } = film.tile_window(tile);
            let pixels = (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y)));
            let rays: Vec<Ray> = pixels
                .filter_map(|(x, y)| {
                    let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                    scene.camera().ray(middle, size, [0.5; 2])
                })
                .collect();
            let rays = Rays8::of(&rays);
            let mut hits = vec![Hits8::NONE; rays.len()];
            scene.bvh().intersect_eights(&rays, &mut hits);
            let met: Vec<_> = rays
                .iter()
                .zip(&hits)
                .flat_map(|(rays, hits)| lanes(hits.met).map(|i| (rays.get(i), hits.get(i))))
                .map(|(ray, hit)| scene.interaction(&ray, &hit))
                .collect();
            for light in scene.lights() {
                let shadow = met.iter().filter_map(|at| {
                    let sample = light.sample(at.p, [0.5; 2])?;
                    (sample.l.dot(at.facing_ng()) > 0.0)
                        .then(|| at.spawn(sample.l, sample.distance))
                });
                bundles.shadow.push(Rays8::of(&shadow.collect::<Vec<_>>()));
            }
            let mirror = met.iter().map(|at| at.spawn(at.n.mirror(at.e), f32::INFINITY));
            bundles.secondary.push(Rays8::of(&mirror.collect::<Vec<_>>()));
            bundles.primary.push(rays);
        }
        bundles
    }
}

/// How long it took to trace so many rays.
#[derive(Clone, Copy, Debug)]
struct Measured {
    rays: u64,
    seconds: f64,
}

/// The shortest of as many runs over all bundles as fit into a second, three at least.
fn best(bundles: &[Vec<Rays8>], trace: impl Fn(&[Rays8]) + Sync) -> Measured {
    let rays = bundles.iter().flatten().map(|rays| u64::from(rays.there.count_ones())).sum();
    let begun = Instant::now();
    let mut seconds = f64::INFINITY;
    let mut runs = 0;
    while runs < 3 || begun.elapsed().as_secs_f64() < 1.0 {
        let run = Instant::now();
        bundles.par_iter().for_each(|rays| trace(rays));
        seconds = seconds.min(run.elapsed().as_secs_f64());
        runs += 1;
    }
    Measured { rays, seconds }
}

fn closest(scene: &View, rays: &[Rays8]) {
    let mut hits = vec![Hits8::NONE; rays.len()];
    scene.bvh().intersect_eights(rays, &mut hits);
    black_box(hits);
}

fn any(scene: &View, rays: &[Rays8]) {
    let mut blocked = vec![0; rays.len()];
    scene.bvh().occluded_eights(rays, &mut blocked);
    black_box(blocked);
}
