//! The picture in five lines, as the README and the front page of the documentation have it.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

use phong::film::LayerKind;
use phong::image::Picture;
use phong::{Cancel, Encoding, Finishing, RenderOptions, View, finish, render, save, scene};

const SCENE: &str = r#"
version = 1
image = { size = [16, 16], samples = 2 }
camera = { eye = [0, 0, 5], look_at = [0, 0, 0], fov = 30 }
light = [{ kind = "distant", direction = [-1, -1, -1] }]
sphere = [{ center = [0, 0, 0], radius = 1 }]
"#;

#[rustfmt::skip]
fn picture() -> Result<phong::film::Film, Box<dyn Error>> {
    let reading = scene::read("scenes/two-balls.toml", None, &scene::Folder, &scene::Limits::default());
    let scene = reading.into_scene()?;
    let options = RenderOptions::of(&scene.image)?;
    let film = render(&View::of(&scene)?, &options, &|_| {}, &Cancel::default()).film;
    save(&finish(&film, &Finishing::default()), "two-balls.png".as_ref(), &Encoding::default())?;
    Ok(film)
}

#[test]
fn five_lines_make_a_picture_and_stand_alike_wherever_they_are_shown() -> Result<(), Box<dyn Error>>
{
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let lines = |file: &str| -> Result<Vec<String>, Box<dyn Error>> {
        let text = fs::read_to_string(root.join(file))?;
        let lines = text.lines().map(|line| line.trim_start_matches("//!").trim().to_owned());
        let lines = lines.skip_while(|line| !line.starts_with("let reading = scene::read("));
        Ok(lines.take(5).collect())
    };
    let here = lines("crates/phong/tests/embed.rs")?;
    assert!(here.len() == 5 && here[4].starts_with("save("), "{here:?}");
    assert_eq!(lines("README.md")?, here);
    assert_eq!(lines("crates/phong/src/lib.rs")?, here);

    let folder = tempfile::tempdir()?;
    fs::create_dir(folder.path().join("scenes"))?;
    fs::write(folder.path().join("scenes/two-balls.toml"), SCENE)?;
    env::set_current_dir(folder.path())?;
    let film = picture()?;
    let read = Picture::read(&fs::read("two-balls.png")?)?;
    assert_eq!((read.size, [film.width(), film.height()]), ([16, 16], [16, 16]));
    let seen =
        film.at(LayerKind::Picture, 8, 8).is_some_and(|pixel| pixel.iter().any(|&v| v > 0.0));
    assert!(seen, "the ball is lit");
    Ok(())
}
