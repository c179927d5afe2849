//! How long building takes, what it makes, and how fast that is to trace.
//!
//! ```text
//! crates/phong-bvh/benches/peers/setup.sh               # once: fetches Embree and the meshes
//! cargo bench -p phong-bvh --bench build                # every scene and preset
//! cargo bench -p phong-bvh --bench build -- dragon spheres fast balanced
//! cargo bench -p phong-bvh --bench build -- --builds    # no rays are traced
//! cargo bench -p phong-bvh --bench build -- growth      # 1 k to 10 M triangles, 1 k to 20 M spheres
//! ```
//!
//! Scenes as in `peers`. Times are CPU time, the least of several rounds with all contenders
//! interleaved; wall time is that of two threads. Ratios are speeds: above 1 is faster.
//!
//! ```text
//! BUILD  <scene> <preset> <ratio to Embree> <CPU ns> <wall ns> <bytes> <Embree's bytes>   (each per primitive)
//! TRACE  <scene> <preset> <rays> <ratio to Balanced> <nodes> <leaves>                     (per ray) <ns>
//! GROWTH <kind> <preset> <primitives> <ratio to Embree> <CPU ns> <wall ns> <bytes>        (per primitive)
//! ```
//!
//! `PHONG_EMBREE` and `PHONG_PEERS` as in `peers`. Embree is given one thread; its ratio is 0 where it
//! is not there, or was left out: beyond four million primitives.

#![expect(unsafe_code, reason = "opens a foreign library and reads the CPU clock")]
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a bench prints what it measured")]

use std::{
    env,
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

use phong_bvh::{BuildOptions, Cost, Hit, Hits8, Preset, Primitives, Ray, Rays8, World};
use rayon::{ThreadPool, ThreadPoolBuilder};

#[path = "peers/clock.rs"]
mod clock;
#[path = "peers/embree.rs"]
#[expect(dead_code, reason = "`peers` traces with it as well")]
mod embree;
#[path = "peers/rays.rs"]
mod rays;
#[path = "peers/scenes.rs"]
mod scenes;

use embree::{Arrays, Embree, Flavour};

const PRESETS: [(&str, Preset); 4] = [
    ("fast", Preset::Fast),
    ("balanced", Preset::Balanced),
    ("best", Preset::Best),
    ("compact", Preset::Compact),
];

/// What the command line asks for.
#[derive(Default)]
struct Options {
    scenes: Vec<&'static str>,
    presets: Vec<(&'static str, Preset)>,
    growth: bool,
    builds: bool,
}

impl Options {
    fn read(args: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self::default();
        for arg in args {
            let scene = scenes::NAMES.into_iter().find(|&name| name == arg);
            let preset = PRESETS.into_iter().find(|&(name, _)| name == arg);
            match (arg.as_str(), scene, preset) {
                ("--bench", ..) => {}
                ("--builds", ..) => options.builds = true,
                ("growth", ..) => options.growth = true,
                (_, Some(scene), _) => options.scenes.push(scene),
                (_, _, Some(preset)) => options.presets.push(preset),
                _ => {
                    let (scenes, presets) =
                        (scenes::NAMES.join(" "), PRESETS.map(|p| p.0).join(" "));
                    return Err(format!(
                        "no {arg}: scenes are {scenes}; presets are {presets}; or growth"
                    ));
                }
            }
        }
        if options.scenes.is_empty() && !options.growth {
            options.scenes = scenes::NAMES.to_vec();
        }
        if options.presets.is_empty() {
            options.presets = PRESETS.to_vec();
        }
        Ok(options)
    }
}

fn main() -> ExitCode {
    if !env::args().any(|arg| arg == "--bench") {
        println!("a measurement, not a test: cargo bench -p phong-bvh --bench build");
        return ExitCode::SUCCESS;
    }
    let options = match Options::read(env::args().skip(1)) {
        Ok(options) => options,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::from(2);
        }
    };
    let target = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/peers");
    let folder = env::var_os("PHONG_PEERS").map_or(target, PathBuf::from);
    let embree = embree::find(&folder).and_then(|path| {
        Embree::open(&path).inspect_err(|error| println!("{}: {error}", path.display())).ok()
    });
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let bench = Bench { embree, one: pool(1), two: pool(2) };
    for &name in &options.scenes {
        match scenes::load(name, &folder) {
            Ok(geometry) => bench.compare(name, &geometry, &options),
            Err(error) => println!("{name} left out: {error} (see benches/peers/setup.sh)"),
        }
    }
    if options.growth {
        bench.growth("triangles", 10_000_000, &options.presets, terrain);
        bench.growth("spheres", 20_000_000, &options.presets, scenes::uniform);
    }
    ExitCode::SUCCESS
}

/// The contenders.
struct Bench {
    embree: Option<Embree>,
    one: ThreadPool,
    two: ThreadPool,
}

/// What a build took and made, per primitive.
#[derive(Clone, Copy)]
struct Built {
    cpu: f64,
    wall: f64,
    bytes: f64,
}

impl Built {
    const NONE: Self = Self { cpu: f64::INFINITY, wall: f64::INFINITY, bytes: 0.0 };
}

impl Bench {
    /// Builds with every preset, and Embree's default, in turn; the latter's ns and bytes come first.
    fn builds(
        &self,
        geometry: &Primitives,
        presets: &[(&str, Preset)],
        rounds: usize,
        with_peer: bool,
    ) -> ([f64; 2], Vec<Built>) {
        let peer = self.embree.as_ref().filter(|_| with_peer);
        let arrays = peer.map(|_| Arrays::of(geometry));
        let each = 1e9 / geometry.len() as f64;
        let mut theirs = [f64::INFINITY, 0.0];
        let mut ours = vec![Built::NONE; presets.len()];
        for _ in 0..rounds {
            for (&(_, preset), best) in presets.iter().zip(&mut ours) {
                let copy = geometry.clone();
                let (seconds, bvh) = self.one.install(|| clock::process(|| build(copy, preset)));
                best.cpu = best.cpu.min(each * seconds);
                best.bytes = bvh.stats().bytes as f64 / geometry.len() as f64;
                drop(bvh);
                let copy = geometry.clone();
                let start = Instant::now();
                let bvh = self.two.install(|| build(copy, preset));
                best.wall = best.wall.min(each * start.elapsed().as_secs_f64());
                drop(bvh);
            }
            if let (Some(embree), Some(arrays)) = (peer, &arrays) {
                let (seconds, scene) = clock::process(|| embree.build(arrays, Flavour::Default));
                theirs[0] = theirs[0].min(each * seconds);
                theirs[1] = scene.bytes() as f64 / geometry.len() as f64;
            }
        }
        if peer.is_none() {
            theirs[0] = 0.0;
        }
        (theirs, ours)
    }

    fn compare(&self, name: &str, geometry: &Primitives, options: &Options) {
        let presets = &options.presets;
        let ([ns, their_bytes], ours) = self.builds(geometry, presets, 5, true);
        for (&(preset, _), Built { cpu, wall, bytes }) in presets.iter().zip(&ours) {
            let ratio = ns / cpu;
            println!(
                "BUILD  {name} {preset} {ratio:.2} {cpu:.1} {wall:.1} {bytes:.1} {their_bytes:.1}"
            );
        }
        if options.builds {
            return;
        }
        let first = build(geometry.clone(), Preset::Balanced);
        let primary = rays::primary(geometry, 512);
        let mut hits = vec![Hit::NONE; primary.len()];
        rays::intersect(&first, &primary, &mut hits);
        let seen: Vec<(Ray, Hit)> = primary.into_iter().zip(hits).collect();
        let others: Vec<World> =
            presets.iter().map(|&(_, preset)| build(geometry.clone(), preset)).collect();
        for rays in rays::NAMES {
            let set = rays::set(rays, &first, &seen, 1 << 17);
            let mut base = f64::INFINITY;
            let mut best = vec![f64::INFINITY; others.len()];
            for _ in 0..5 {
                base = base.min(trace(&first, &set));
                for (bvh, best) in others.iter().zip(&mut best) {
                    *best = best.min(trace(bvh, &set));
                }
            }
            for ((&(preset, _), bvh), seconds) in presets.iter().zip(&others).zip(best) {
                let mut total = Cost::default();
                for ray in &set.rays {
                    let cost = bvh.intersect_counted(ray).1;
                    total.nodes += cost.nodes;
                    total.primitives += cost.primitives;
                }
                let count = set.rays.len() as f64;
                let each = |total: u32| f64::from(total) / count;
                let (nodes, leaves) = (each(total.nodes), each(total.primitives));
                let (ratio, ns) = (base / seconds, 1e9 * seconds / count);
                let rays = set.name;
                println!("TRACE  {name} {preset} {rays} {ratio:.2} {nodes:.2} {leaves:.2} {ns:.0}");
            }
        }
    }

    fn growth(
        &self,
        kind: &str,
        most: u32,
        presets: &[(&'static str, Preset)],
        make: fn(u32) -> Primitives,
    ) {
        let steps = (3..8).flat_map(|power| [1, 2, 5].map(|digit| digit * 10_u32.pow(power)));
        for count in steps.filter(|&count| count <= most) {
            let geometry = make(count);
            let rounds = (4_000_000 / count).clamp(2, 100) as usize;
            let ([ns, _], ours) = self.builds(&geometry, presets, rounds, count <= 4_000_000);
            for (&(preset, _), Built { cpu, wall, bytes }) in presets.iter().zip(&ours) {
                let (ratio, count) = (ns / cpu, geometry.len());
                println!("GROWTH {kind} {preset} {count} {ratio:.2} {cpu:.1} {wall:.1} {bytes:.1}");
            }
        }
    }
}

fn build(geometry: Primitives, preset: Preset) -> World {
    World::of(vec![geometry], BuildOptions { preset, ..BuildOptions::default() })
        .expect("fewer than 2³² primitives")
}

/// A terrain of about `count` triangles.
fn terrain(count: u32) -> Primitives {
    scenes::terrain(f64::from(count / 2).sqrt() as u32 + 1)
}

/// CPU seconds for a set of rays, in bundles.
fn trace(bvh: &World, set: &rays::Set) -> f64 {
    const BUNDLE: usize = 256;
    let (mut hits, mut blocked) = ([Hits8::NONE; BUNDLE / 8], [0; BUNDLE / 8]);
    let bundles: Vec<_> = set.rays.chunks(BUNDLE).map(Rays8::of).collect();
    let work = || {
        for rays in &bundles {
            if set.any {
                bvh.occluded_eights(rays, &mut blocked[..rays.len()]);
            } else {
                bvh.intersect_eights(rays, &mut hits[..rays.len()]);
            }
        }
    };
    clock::thread(work).0
}
