//! A scene from a string, its picture, and why one pixel is the colour it is.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "an example talks")]

use std::error::Error;

use phong::explain::explain;
use phong::film::LayerKind;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::TermSet;
use phong::view::View;
use phong_scene::{Limits, Memory};

const SCENE: &str = r#"
version = 1
image = { size = [64, 64], samples = 4 }
camera = { eye = [0, 0, 5], look_at = [0, 0, 0], fov = 30 }
light = [{ kind = "distant", direction = [-1, -1, -1] }]
sphere = [{ center = [0, 0, 0], radius = 1 }]
"#;

fn main() -> Result<(), Box<dyn Error>> {
    // Reading: a scene and what there is to say about it. Files come from a `Source`.
    let files = Memory::new().with("ball.toml", SCENE.as_bytes());
    let reading = phong_scene::read("ball.toml", None, &files, &Limits::default());
    for diagnostic in &reading.diagnostics {
        eprintln!("{}", diagnostic.message);
    }
    let scene = reading.scene.ok_or("the scene has errors")?;

    // Compiling: what rays meet. Rendering: on rayon's threads, the same bits on any number.
    let options = RenderOptions::of(&scene.image)?.with_terms(TermSet::ALL);
    let compiled = View::of(&scene)?;
    let film = render(&compiled, &options, &|_| {}, &Cancel::new()).film;

    // A pixel of the film is the sum of its terms; so is its explanation.
    let pixel = film.at(LayerKind::Picture, 38, 25).ok_or("no such pixel")?;
    let told = explain(&compiled, &options, [38, 25])?;
    assert_eq!(pixel, told.linear.to_array());
    println!("{}", told.linear.to_array().map(|v| format!("{v:.4}")).join(" "));
    println!("diffuse  {:.4}", told.terms.diffuse.r);
    println!("specular {:.4}", told.terms.specular.r);
    Ok(())
}
