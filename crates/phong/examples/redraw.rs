//! How long it takes to be ready to draw a scene again after one thing about it changed.
//!
//! ```text
//! cargo run --release -p phong --example redraw -- SCENE [RUNS]
//! ```
//!
//! Prints a Markdown table: building everything anew, which is what any change once cost, against
//! changing the look or updating the geometry; and the drawing itself, which is the same for both.

#![expect(clippy::print_stdout, reason = "an example talks")]

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use glam::{DAffine3, DVec3};
use phong::geometry::{Geometry, GeometryOptions};
use phong::look::Look;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Folder, LightKind, Limits, Rgb, Scene, read};

/// What is changed, and how.
type Change = (&'static str, fn(&mut Scene));

const CHANGES: [Change; 4] = [
    ("the eye", |scene| scene.camera.eye += DVec3::new(0.1, 0.05, 0.0)),
    ("a light", |scene| {
        let lights = scene.lights.iter_mut();
        for light in lights.take(1) {
            match &mut light.kind {
                LightKind::Distant { direction, .. } => direction.x += 0.1,
                LightKind::Point { position, .. }
                | LightKind::Spot { position, .. }
                | LightKind::Rectangle { position, .. }
                | LightKind::Disc { position, .. }
                | LightKind::Sphere { position, .. } => {
                    position.x += 0.1;
                }
                LightKind::Mesh { .. } => {}
            }
        }
    }),
    ("a colour", |scene| {
        scene
            .materials
            .iter_mut()
            .take(1)
            .for_each(|material| material.color = Rgb::grey(0.4).into());
    }),
    ("one object", |scene| {
        let shift = DAffine3::from_translation(DVec3::new(0.0, 0.1, 0.0));
        scene.objects.iter_mut().take(1).for_each(|object| {
            object.transform = shift * object.transform;
        });
    }),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let path = args.next().ok_or("name a scene")?;
    let runs: usize = args.next().map_or(Ok(5), |runs| runs.parse())?;
    let scene =
        read(&path, None, &Folder, &Limits::default()).scene.ok_or("the scene is broken")?;
    let geometry = Arc::new(Geometry::new(&scene, GeometryOptions::default())?);

    println!("| changed | built anew, ms | now, ms | drawn, ms |");
    println!("|---|---|---|---|");
    for (name, change) in CHANGES {
        let mut changed = scene.clone();
        change(&mut changed);
        let moved = name == "one object";
        let again = || -> Result<View, Box<dyn Error>> {
            let geometry =
                if moved { Arc::new(geometry.update(&changed)?) } else { Arc::clone(&geometry) };
            Ok(View::new(geometry, Look::new(&changed))?)
        };
        let (mut anew, mut now, mut drawn) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..runs {
            let started = Instant::now();
            let built = Geometry::new(&changed, GeometryOptions::default())?;
            View::new(Arc::new(built), Look::new(&changed))?;
            anew.push(started.elapsed().as_secs_f64());
            let started = Instant::now();
            let view = again()?;
            now.push(started.elapsed().as_secs_f64());
            let started = Instant::now();
            render(&view, &RenderOptions::of(&changed.image)?, &|_| {}, &Cancel::new());
            drawn.push(started.elapsed().as_secs_f64());
        }
        let [anew, now, drawn] = [anew, now, drawn].map(median);
        println!("| {name} | {anew:.2} | {now:.3} | {drawn:.0} |");
    }
    Ok(())
}

/// Milliseconds.
fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    1e3 * seconds[seconds.len() / 2]
}
