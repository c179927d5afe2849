//! Ours against Embree 4, on the same rays, in one process and one thread.
//!
//! ```text
//! crates/phong-bvh/benches/peers/setup.sh             # once: fetches Embree and the meshes
//! cargo bench -p phong-bvh --bench peers              # everything
//! cargo bench -p phong-bvh --bench peers -- dragon spheres ao bounce --quick
//! ```
//!
//! Scenes: `bunny` (3.7 k triangles) `dragon` (871 k) `terrain` (2.1 M) `sticks` (360 k thin ones),
//! `spheres` (1 M) `clusters` (1 M of mixed radii); ours alone: `bonds` (1 M capsules) `rods` (the same with flat
//! ends) `chains` (1 M bonds of molecules) `beads` (as many balls in their places). Rays: `primary` (1024², in 8 × 8 tiles), `shadow`
//! (to two point lights), `ao` (eight cosine rays a hit), `bounce` (one), `shuffled` (those in no
//! order). Naming some runs only those. `--quick` takes 256² pixels and 64 k rays a set, fewer
//! rounds, no `COMPACT` build: for the ratio's first digit, in seconds. `--bundle N` sets how many
//! rays are passed to ours at once (256).
//!
//! Peers: `E1` one ray at a time, `E8` eight, `E8coh` eight said to be coherent, and on triangles
//! `ROBUST`, one at a time in Embree's watertight mode. Their rays and hits are converted from and
//! to ours, which is counted. Rounds of all contenders are interleaved and the least CPU time of
//! each counts. Ratios are speeds, ours over theirs: above 1 we are faster.
//!
//! ```text
//! BUILD  <scene> <DEFAULT|COMPACT> <ratio> <our bytes per primitive> <their bytes per primitive> <our ms>
//! OURS   <scene> <rays> <our ns per ray, one by one> <in bundles> (without a peer)
//! COUNT  <scene> <rays> <nodes a ray for the closest hit> <leaves> (without a peer)
//! RATIO  <scene> <rays> <peer> <single> <bundle> <their ns per ray>
//! DIFFER <scene> <rays> <share of rays for which the answers differ> [<ours right> <theirs right> <of>]
//! ```
//!
//! Off triangles, up to 200 of the rays that differ are judged in f64, against every triangle.
//!
//! `PHONG_EMBREE` names the library, `PHONG_PEERS` the folder of `setup.sh` (default `target/peers`).
//! Without Embree only our own times are printed.

#![expect(unsafe_code, reason = "opens a foreign library and reads the CPU clock")]
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a bench prints what it measured")]

use std::{
    env,
    hint::black_box,
    path::{Path, PathBuf},
    process::ExitCode,
};

use phong_bvh::{BuildOptions, Hit, Hits8, Preset, Primitives, Ray, Rays8, World};

#[path = "peers/clock.rs"]
mod clock;
#[path = "peers/embree.rs"]
mod embree;
#[path = "peers/judge.rs"]
mod judge;
#[path = "peers/rays.rs"]
mod rays;
#[path = "peers/scenes.rs"]
mod scenes;

use embree::{Arrays, Embree, EmbreeScene, Flavour, Width};
use rays::Set;

/// What the command line asks for.
struct Options {
    scenes: Vec<&'static str>,
    rays: Vec<&'static str>,
    quick: bool,
    bundle: usize,
}

impl Options {
    fn read(mut args: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self { scenes: Vec::new(), rays: Vec::new(), quick: false, bundle: 256 };
        while let Some(arg) = args.next() {
            let named = |names: &[&'static str]| names.iter().copied().find(|&name| name == arg);
            match arg.as_str() {
                "--bench" => {}
                "--quick" => options.quick = true,
                "--bundle" => {
                    let count = args.next().and_then(|n| n.parse().ok()).filter(|&n| n > 0);
                    options.bundle = count.ok_or("--bundle takes a number above 0")?;
                }
                _ => match (named(&scenes::NAMES), named(&rays::NAMES)) {
                    (Some(scene), _) => options.scenes.push(scene),
                    (_, Some(rays)) => options.rays.push(rays),
                    _ => {
                        let (scenes, rays) = (scenes::NAMES.join(" "), rays::NAMES.join(" "));
                        return Err(format!("no {arg}: scenes are {scenes}; rays are {rays}"));
                    }
                },
            }
        }
        if options.scenes.is_empty() {
            options.scenes = scenes::NAMES.to_vec();
        }
        if options.rays.is_empty() {
            options.rays = rays::NAMES.to_vec();
        }
        Ok(options)
    }

    fn side(&self) -> u32 {
        if self.quick { 256 } else { 1024 }
    }

    fn most(&self) -> usize {
        if self.quick { 1 << 16 } else { 1 << 20 }
    }

    fn rounds(&self) -> u32 {
        if self.quick { 5 } else { 9 }
    }
}

fn main() -> ExitCode {
    if !env::args().any(|arg| arg == "--bench") {
        println!("a measurement, not a test: cargo bench -p phong-bvh --bench peers");
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
    if embree.is_none() {
        println!("no Embree (see benches/peers/setup.sh): measuring ours alone");
    }
    // One thread for everything; Embree is told the same.
    if let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(1).build_global() {
        eprintln!("{error}");
    }
    for &name in &options.scenes {
        match scenes::load(name, &folder) {
            Ok(geometry) => measure(name, geometry, embree.as_ref(), &options),
            Err(error) => println!("{name} left out: {error} (see benches/peers/setup.sh)"),
        }
    }
    ExitCode::SUCCESS
}

fn measure(name: &str, geometry: Primitives, embree: Option<&Embree>, options: &Options) {
    let contest = embree.filter(|_| !matches!(geometry, Primitives::Cylinders { .. }));
    let contest = contest.map(|embree| (embree, Arrays::of(&geometry)));
    if let Some((embree, arrays)) = &contest {
        let presets = [(Flavour::Default, Preset::Balanced), (Flavour::Compact, Preset::Compact)];
        let builds = if options.quick { &presets[..1] } else { &presets[..] };
        for &(flavour, preset) in builds {
            compare_builds(name, &geometry, (embree, arrays, flavour), preset, options);
        }
    }
    let triangles = matches!(geometry, Primitives::Triangles { .. });
    let bvh = build(geometry, Preset::Balanced);
    let theirs = |flavour| contest.as_ref().map(|(embree, arrays)| embree.build(arrays, flavour));
    let scene = theirs(Flavour::Default);
    let robust = if triangles { theirs(Flavour::Robust) } else { None };

    let primary = rays::primary(bvh.primitives(0), options.side());
    let mut hits = vec![Hit::NONE; primary.len()];
    // Embree's own hits where there are any: the rays are then the same whatever becomes of ours.
    match &scene {
        Some(scene) => scene.intersect(Width::One, &primary, &mut hits),
        None => rays::intersect(&bvh, &primary, &mut hits),
    }
    let seen: Vec<(Ray, Hit)> = primary.into_iter().zip(hits).collect();
    for &rays in &options.rays {
        let set = rays::set(rays, &bvh, &seen, options.most());
        let contest = Contest { name, set: &set, bvh: &bvh, bundle: options.bundle };
        contest.run(scene.as_ref(), robust.as_ref(), options.rounds());
    }
}

fn build(geometry: Primitives, preset: Preset) -> World {
    World::of(vec![geometry], BuildOptions { preset, ..BuildOptions::default() })
        .expect("fewer than 2³² primitives")
}

fn compare_builds(
    name: &str,
    geometry: &Primitives,
    (embree, arrays, flavour): (&Embree, &Arrays, Flavour),
    preset: Preset,
    options: &Options,
) {
    let (mut ours, mut theirs) = (f64::INFINITY, f64::INFINITY);
    let (mut our_bytes, mut their_bytes) = (0.0, 0.0);
    let count = geometry.len() as f64;
    for _ in 0..options.rounds().min(5) {
        let copy = geometry.clone();
        let (seconds, bvh) = clock::process(|| build(copy, preset));
        ours = ours.min(seconds);
        our_bytes = bvh.stats().bytes as f64 / count;
        drop(bvh);
        let (seconds, scene) = clock::process(|| embree.build(arrays, flavour));
        theirs = theirs.min(seconds);
        their_bytes = scene.bytes() as f64 / count;
    }
    let peer = if flavour == Flavour::Default { "DEFAULT" } else { "COMPACT" };
    let (ratio, ms) = (theirs / ours, 1e3 * ours);
    println!("BUILD  {name} {peer} {ratio:.2} {our_bytes:.1} {their_bytes:.1} {ms:.0}");
}

/// One set of rays, traced by all.
struct Contest<'a> {
    name: &'a str,
    set: &'a Set,
    bvh: &'a World,
    bundle: usize,
}

/// Room for either answer.
struct Answers {
    hits: Vec<Hit>,
    blocked: Vec<bool>,
}

impl Contest<'_> {
    fn run(&self, scene: Option<&EmbreeScene>, robust: Option<&EmbreeScene>, rounds: u32) {
        let eight = |coherent| Width::Eight { coherent };
        let mut peers: Vec<(&str, &EmbreeScene, Width)> = Vec::new();
        if let Some(scene) = scene {
            peers.push(("E1", scene, Width::One));
            peers.push(("E8", scene, eight(false)));
            peers.push(("E8coh", scene, eight(true)));
        }
        peers.extend(robust.map(|robust| ("ROBUST", robust, Width::One)));

        let count = self.set.rays.len();
        let room = || Answers { hits: vec![Hit::NONE; count], blocked: vec![false; count] };
        let (mut ours, mut theirs) = (room(), room());
        let eights: Vec<_> = self.set.rays.chunks(self.bundle).map(Rays8::of).collect();
        let (mut single, mut bundle) = (f64::INFINITY, f64::INFINITY);
        let mut best = vec![f64::INFINITY; peers.len()];
        let mut differ = None;
        for _ in 0..rounds {
            single = single.min(clock::thread(|| self.single(&mut ours)).0);
            for (i, &(_, scene, width)) in peers.iter().enumerate() {
                let trace = || {
                    if self.set.any {
                        scene.occluded(width, &self.set.rays, &mut theirs.blocked);
                    } else {
                        scene.intersect(width, &self.set.rays, &mut theirs.hits);
                    }
                };
                best[i] = best[i].min(clock::thread(trace).0);
                if i == 0 && differ.is_none() {
                    differ = Some(self.differ(&ours, &theirs));
                }
            }
            bundle = bundle.min(clock::thread(|| self.bundles(&eights)).0);
        }
        let (name, rays) = (self.name, self.set.name);
        let ns = |seconds: f64| 1e9 * seconds / count as f64;
        for (&(peer, ..), &seconds) in peers.iter().zip(&best) {
            let (single, bundle, ns) = (seconds / single, seconds / bundle, ns(seconds));
            println!("RATIO  {name} {rays} {peer} {single:.2} {bundle:.2} {ns:.0}");
        }
        if let Some(differing) = differ {
            let share = differing.len() as f64 / count as f64;
            println!("DIFFER {name} {rays} {share:.6}{}", self.judged(&differing));
        }
        if peers.is_empty() {
            let some = || self.set.rays.iter().step_by(count.div_ceil(1 << 14).max(1));
            let costs = some().map(|ray| self.bvh.intersect_counted(ray).1);
            let (nodes, leaves) = costs.fold((0, 0), |(nodes, leaves), cost| {
                (nodes + cost.nodes, leaves + cost.primitives)
            });
            let a_ray = |of: u32| f64::from(of) / some().count() as f64;
            println!("COUNT  {name} {rays} {:.1} {:.1}", a_ray(nodes), a_ray(leaves));
            println!("OURS   {name} {rays} {:.0} {:.0} ns per ray", ns(single), ns(bundle));
        }
    }

    fn single(&self, answers: &mut Answers) {
        let rays = &self.set.rays;
        if self.set.any {
            for (ray, blocked) in rays.iter().zip(&mut answers.blocked) {
                *blocked = self.bvh.occluded(ray);
            }
        } else {
            for (ray, hit) in rays.iter().zip(&mut answers.hits) {
                *hit = self.bvh.intersect(ray);
            }
        }
    }

    /// Bundles of rays that lie side by side already, as a renderer's do.
    fn bundles(&self, eights: &[Vec<Rays8>]) {
        let most = self.bundle.div_ceil(8);
        let (mut hits, mut blocked) = (vec![Hits8::NONE; most], vec![0; most]);
        for rays in eights {
            if self.set.any {
                self.bvh.occluded_eights(rays, &mut blocked[..rays.len()]);
            } else {
                self.bvh.intersect_eights(rays, &mut hits[..rays.len()]);
            }
            black_box((&hits, &blocked));
        }
    }

    /// The rays blocked for one and not for the other, or hit at a different distance; and both answers.
    /// That two primitives at one distance are told apart by number is no difference.
    fn differ(&self, ours: &Answers, theirs: &Answers) -> Vec<(usize, [Answer; 2])> {
        let answer = |of: &Answers, i: usize| match (self.set.any, of.hits[i]) {
            (true, _) => of.blocked[i].then_some(0.0),
            (_, hit) => hit.is_some().then_some(hit.t),
        };
        let both = |i: usize| (i, [answer(ours, i), answer(theirs, i)]);
        (0..self.set.rays.len()).map(both).filter(|(_, [a, b])| !same(*a, *b)).collect()
    }

    /// How many of some answers are right, ours and theirs.
    fn judged(&self, differing: &[(usize, [Answer; 2])]) -> String {
        let geometry = self.bvh.primitives(0);
        if differing.is_empty() || !matches!(geometry, Primitives::Triangles { .. }) {
            return String::new();
        }
        let mut right = [0, 0];
        let step = differing.len().div_ceil(judge::CASES);
        for (i, answers) in differing.iter().step_by(step) {
            let t = judge::closest(geometry, &self.set.rays[*i]).map(|t| t as f32);
            let truth = if self.set.any { t.map(|_| 0.0) } else { t };
            for (answer, right) in answers.iter().zip(&mut right) {
                *right += i32::from(same(*answer, truth));
            }
        }
        format!(" {} {} {}", right[0], right[1], differing.len().div_ceil(step))
    }
}

/// Where a ray hits, or 0 where any hit will do; none: nowhere.
type Answer = Option<f32>;

/// Whether two answers agree, but for rounding.
fn same(a: Answer, b: Answer) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= 1e-4 * (a + b),
        (a, b) => a.is_none() == b.is_none(),
    }
}
