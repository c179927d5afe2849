//! Instructions per ray of the hot kernels, counted by callgrind: the same on a loaded machine.
//!
//! ```text
//! cargo bench -p phong-bvh --bench instructions              # against instructions.txt
//! cargo bench -p phong-bvh --bench instructions -- --bless   # writes it anew
//! ```
//!
//! Fails where a case takes 3 % more instructions than `instructions.txt` says; that file belongs to
//! one compiler and is blessed anew with it. A cheaper case is a reason to bless as well. Fewer
//! instructions are not always less time (caches, prefetching): for that there is `peers`.
//!
//! The program runs itself under valgrind once per case and counts within [`measured`] alone.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a bench prints what it measured")]

use std::{env, fs, hint::black_box, io, path::Path, process::Command, process::ExitCode};

use glam::{DAffine3, DQuat, DVec3, Vec3, swizzles::Vec3Swizzles};
use phong_bvh::{
    BuildOptions, Canonical, Hit, Hits8, Primitives, Ray, Rays8, Solid, Sphere, World,
};

const CASES: [&str; 8] = [
    "triangles closest",
    "triangles any",
    "triangles bundle",
    "spheres closest",
    "spheres any",
    "spheres bundle",
    "cylinders closest",
    "spheres surface",
];

/// Rays a case.
const RAYS: usize = 64 * 64;

fn main() -> ExitCode {
    let args: Vec<String> = env::args().skip(1).collect();
    if let [flag, name] = args.as_slice()
        && flag == "--case"
    {
        run(name);
        return ExitCode::SUCCESS;
    }
    if !args.iter().any(|arg| arg == "--bench") {
        println!("a measurement, not a test: cargo bench -p phong-bvh --bench instructions");
        return ExitCode::SUCCESS;
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("no valgrind: nothing measured");
        return ExitCode::SUCCESS;
    }
    match compare(args.iter().any(|arg| arg == "--bless")) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Counts every case, and compares with the file or writes it.
fn compare(bless: bool) -> io::Result<ExitCode> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/instructions.txt");
    let known = if bless { String::new() } else { fs::read_to_string(&path)? };
    let known = |case: &str| {
        let line = known.lines().find_map(|line| line.strip_prefix(case))?;
        line.trim().parse::<f64>().ok()
    };
    let (mut text, mut worse) = (String::new(), false);
    for case in CASES {
        let count = count(case)?;
        let line = format!("{case:<20}{count:8.1}\n");
        text += &line;
        let verdict = match known(case) {
            Some(known) if count > 1.03 * known => {
                worse = true;
                format!("WORSE than {known:.1}")
            }
            Some(known) => format!("{:+.1} %", 100.0 * (count / known - 1.0)),
            None => "new".to_owned(),
        };
        println!("{}  {verdict}", line.trim_end());
    }
    if bless {
        fs::write(path, text)?;
    }
    Ok(if worse { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Instructions per ray of one case.
fn count(case: &str) -> io::Result<f64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .args(["--collect-atstart=no", "--toggle-collect=instructions::measured*"])
        .arg(env::current_exe()?)
        .args(["--case", case])
        .output()?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let collected = said.lines().find_map(|line| line.split("Collected :").nth(1));
    let count = collected.and_then(|count| count.trim().parse::<f64>().ok());
    match count {
        Some(count) if count > 0.0 => Ok(count / RAYS as f64),
        _ => Err(io::Error::other(format!("valgrind counted nothing for {case}:\n{said}"))),
    }
}

/// The work of one case, set up first.
fn run(case: &str) {
    let (scene, what) = case.split_once(' ').unwrap_or((case, ""));
    let bvh = World::of(geometry(scene), BuildOptions::default()).expect("few primitives");
    let rays: Vec<Ray> = (0..RAYS).map(ray).collect();
    let mut hits = vec![Hit::NONE; RAYS];
    match what {
        "closest" => measured(|| {
            for (ray, hit) in rays.iter().zip(&mut hits) {
                *hit = bvh.intersect(ray);
            }
        }),
        "any" => measured(|| {
            for ray in &rays {
                black_box(bvh.occluded(ray));
            }
        }),
        "bundle" => {
            let eights = Rays8::of(&rays);
            let mut hits = vec![Hits8::NONE; eights.len()];
            measured(|| bvh.intersect_eights(&eights, &mut hits));
            black_box(&hits);
        }
        "surface" => {
            for (ray, hit) in rays.iter().zip(&mut hits) {
                *hit = bvh.intersect(ray);
            }
            let seen: Vec<(Ray, Hit)> =
                rays.into_iter().zip(hits.clone()).filter(|(_, hit)| hit.is_some()).collect();
            measured(|| {
                for (ray, hit) in seen.iter().cycle().take(RAYS) {
                    black_box(bvh.surface(ray, hit));
                }
            });
        }
        _ => panic!("there is no case {case}"),
    }
    black_box(&hits);
}

/// What callgrind counts.
#[inline(never)]
fn measured(work: impl FnOnce()) {
    work();
}

/// A camera's ray through a picture of 64 × 64, in rows, from outside the unit cube.
fn ray(i: usize) -> Ray {
    let on_film = |k: usize| 0.7 * ((k as f32 + 0.5) / 64.0 - 0.5);
    let dir = Vec3::new(on_film(i % 64), on_film(i / 64), -1.0);
    Ray::new(Vec3::new(0.0, 0.0, 4.0), dir.normalize_or(Vec3::NEG_Z))
}

/// Twenty thousand primitives of one kind, along a sequence that fills [−1, 1]³ evenly (Roberts's:
/// multiples of powers of the plastic number's cousin in three dimensions).
fn geometry(scene: &str) -> Vec<Primitives> {
    const STEP: DVec3 =
        DVec3::new(0.819_172_513_396_164_5, 0.671_043_606_703_789_3, 0.549_700_477_901_970_2);
    let places = (1..=20_000).map(|i| 2.0 * (f64::from(i) * STEP).fract() - 1.0);
    match scene {
        "triangles" => {
            let corners = |p: DVec3| {
                let [x, y] = [p.zxy(), p.yzx()].map(|v| 0.03 * v.normalize_or(DVec3::X));
                [p, p + x, p + y].map(DVec3::as_vec3)
            };
            let positions: Vec<Vec3> = places.flat_map(corners).collect();
            let indices: Vec<_> = (0..20_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            vec![Primitives::triangles(positions, indices)]
        }
        "spheres" => {
            let sphere = |p: DVec3| Sphere { center: p.as_vec3(), radius: 0.015 };
            vec![Primitives::spheres(places.map(sphere).collect::<Vec<_>>())]
        }
        "cylinders" => {
            let cylinder = |p: DVec3| {
                let turn = DQuat::from_rotation_arc(DVec3::Z, p.normalize_or(DVec3::Z));
                let scale = DVec3::new(0.008, 0.008, 0.04);
                let to_world = DAffine3::from_scale_rotation_translation(scale, turn, p);
                Primitives::Solid(Solid { shape: Canonical::Cylinder { capped: true }, to_world })
            };
            places.map(cylinder).collect()
        }
        _ => panic!("there is no scene {scene}"),
    }
}
