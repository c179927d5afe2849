//! Batch files, and values laid over a scene's text.
#![allow(clippy::unwrap_used, reason = "tests")]

use phong_scene::{
    Batch, Change, Limits, Memory, ParameterValues, Reading, batch_reference_markdown,
    batch_schema_json, read_batch, read_changed,
};

const SCENE: &str = r#"version = 1
[camera]
eye = [0, 0, 5]
look_at = [0, 0, 0]
[[light]]
kind = "point"
position = [0, 4, 0]
[materials.red]
color = "red"
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "red"
[[sphere]]
name = "second"
center = [2, 0, 0]
radius = 1
[[include]]
file = "more.toml"
"#;

const MORE: &str = r#"
[[light]]
kind = "point"
position = [1, 1, 1]
[materials.blue]
color = "blue"
[[sphere]]
center = [4, 0, 0]
radius = 1
material = "blue"
"#;

fn read(changes: &[&str]) -> Reading {
    let files = Memory::new().with("a.toml", SCENE).with("more.toml", MORE).with("a.ply", "ply\n");
    let changes: Vec<Change> = changes.iter().map(|c| Change::parse(c).unwrap()).collect();
    read_changed("a.toml", None, &files, &Limits::default(), &changes)
}

#[track_caller]
fn told(changes: &[&str]) -> String {
    let reading = read(changes);
    assert!(reading.scene.is_none());
    reading.diagnostics[0].to_string()
}

fn batch(text: &str) -> (Option<Batch>, Vec<String>) {
    let files = Memory::new().with("b.toml", text);
    let reading = read_batch("b.toml", &files, &Limits::default());
    (reading.batch, reading.diagnostics.iter().map(ToString::to_string).collect())
}

#[track_caller]
fn only_told(text: &str) -> String {
    let (batch, told) = batch(text);
    assert!(batch.is_none(), "it is accepted: {text}");
    assert_eq!(told.len(), 1, "{told:#?}");
    told[0].clone()
}

#[test]
fn a_change_reaches_settings_names_numbers_and_includes() {
    let scene = read(&[
        "camera.eye=[1, 2, 3]",
        "image.samples=4",
        "ambient.color=0.5",
        "materials.red.shininess=7",
        "materials.blue.color=tomato",
        "light.2.position=[9, 9, 9]",
        "sphere.second.radius=0.25",
        "sphere.3.radius=0.5",
    ])
    .scene
    .unwrap();
    assert_eq!(scene.camera.eye.to_array(), [1.0, 2.0, 3.0]);
    assert_eq!((scene.image.samples, scene.ambient.r), (4, 0.5));
    let lights = format!("{:?}", scene.lights);
    assert!(lights.contains("9.0, 9.0, 9.0") && lights.contains("0.0, 4.0, 0.0"), "{lights}");
    let material = |name: &str| format!("{:?}", scene.materials.iter().find(|m| m.name == name));
    assert!(material("red").contains("shininess: 7.0"), "{}", material("red"));
    assert!(material("blue") != material("red"));
    let shapes = format!("{:?}", scene.objects);
    for radius in ["radius: 1.0", "radius: 0.25", "radius: 0.5"] {
        assert!(shapes.contains(radius), "{shapes}");
    }
}

#[test]
fn the_last_of_several_changes_of_one_key_counts() {
    let scene = read(&["image.samples=4", "image.samples=9"]).scene.unwrap();
    assert_eq!(scene.image.samples, 9);
}

#[test]
fn what_is_wrong_with_a_change_is_told_where_it_is_written() {
    for (change, words) in [
        (
            "camera.eey=1",
            "--set:1:8: error: unknown key \"eey\" in this `camera` (did you mean `eye`?)",
        ),
        ("camera.eye=1", "--set:1:12: error: `eye` must be three numbers, `[x, y, z]`; this is 1"),
        ("camera.look_at=[0, 0, 5]", "--set:1:16: error: "),
        (
            "material.red.color=1",
            "--set:1:1: error: a scene has no table \"material\" whose keys can be set (did you mean `materials`?)",
        ),
        (
            "materials.rde.color=1",
            "--set:1:1: error: there is no material \"rde\" (did you mean `red`?)",
        ),
        (
            "light.3.color=1",
            "--set:1:1: error: the scene has no light 3 to change (it has 2 of them, counted from 1)",
        ),
        (
            "light.color=1",
            "--set:1:1: error: \"light.color\" does not say which one (write `light.1.color`)",
        ),
        (
            "image.background.top=1",
            "--set:1:7: error: a value is set as a whole (write `image.background`, and all of its value)",
        ),
        ("camera=1", "--set:1:1: error: \"camera\" is no path of a key"),
        ("version.a=1", "--set:1:1: error: a scene has no table \"version\""),
        ("camera.height=1", "--set:1:1: error: `height` means nothing to a perspective camera"),
    ] {
        let said = told(&[change]);
        assert!(said.starts_with(words), "{said}");
    }
}

#[test]
fn a_bare_model_has_no_text_to_change() {
    let files = Memory::new().with("a.ply", "ply\n");
    let change = Change::parse("camera.eye=[1, 2, 3]").unwrap();
    let reading = read_changed("a.ply", None, &files, &Limits::default(), &[change]);
    let said = reading.diagnostics[0].to_string();
    assert!(reading.scene.is_none() && said.contains("bare model"), "{said}");
}

#[test]
fn parameters_may_be_lists_ranges_files_or_one_value() {
    let (batch, told) = batch(
        "version = 1\ninputs = \"a.toml\"\n[parameters]\n\"camera.eye\" = { from = [0, 0, 5], to = [1, 0, 5], steps = 3 }\n\
         materials.red.shininess = [1, 10]\n\"mesh.1.file\" = { files = \"f-*.ply\" }\nimage.samples = 4\n",
    );
    assert_eq!(told, [""; 0]);
    let batch = batch.unwrap();
    let values = |i: usize| match &batch.parameters[i].values {
        ParameterValues::Changes(all) => all.iter().map(|c| c.value().to_owned()).collect(),
        ParameterValues::Files(pattern) => vec![pattern.text.clone()],
    };
    let paths: Vec<_> = batch.parameters.iter().map(|p| p.path.text.as_str()).collect();
    assert_eq!(paths, ["camera.eye", "materials.red.shininess", "mesh.1.file", "image.samples"]);
    assert_eq!(values(0), ["[0, 0, 5]", "[0.5, 0, 5]", "[1, 0, 5]"]);
    assert_eq!(values(1), ["1", "10"]);
    assert_eq!(values(2), ["f-*.ply"]);
    assert_eq!(values(3), ["4"]);
    let file = batch.parameters[2].file("a \"b\".ply");
    assert_eq!((file.path(), file.value()), ("mesh.1.file", "\"a \\\"b\\\".ply\""));
}

#[test]
fn steps_are_free_of_the_noise_of_their_sum() {
    let (batch, _) = batch(
        "version = 1\ninputs = \"a\"\n[parameters]\nmaterials.a.k_s = { from = 0, to = 1, steps = 11 }",
    );
    let ParameterValues::Changes(all) = &batch.unwrap().parameters[0].values else { panic!() };
    let values: Vec<_> = all.iter().map(Change::value).collect();
    assert_eq!(values, ["0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1"]);
}

#[test]
fn what_is_wrong_with_a_batch_is_told_at_its_place_before_anything_is_opened() {
    let top = "version = 1\ninputs = \"a.toml\"\n";
    let parameters = format!("{top}[parameters]\n");
    for (text, words) in [
        (
            format!("{top}shars = 2\n"),
            "b.toml:3:1: error: unknown key \"shars\" in this `batch` (did you mean `shares`?)",
        ),
        (
            format!("{top}frames = 2\n"),
            "b.toml:3:1: error: unknown key \"frames\" in this `batch` (did you mean `inputs`?)",
        ),
        (
            format!("{top}shares = 0\n"),
            "b.toml:3:10: error: `shares` must be a whole number from 1 to 10000; this is 0",
        ),
        ("version = 1\n".to_owned(), "b.toml:1:1: error: this `batch` has no `inputs`"),
        (
            format!("{parameters}\"camera.fovv\" = [1]\n"),
            "b.toml:4:9: error: unknown key \"fovv\" in this `camera` (did you mean `fov`?)",
        ),
        (format!("{parameters}camera.fovv = [1]\n"), "b.toml:4:8: error: unknown key \"fovv\""),
        (
            format!("{parameters}\"camera.eye\" = [0, 1, 5]\n"),
            "b.toml:4:17: error: `eye` must be three numbers",
        ),
        (
            format!("{parameters}\"materials.red.shininess\" = [1, -1]\n"),
            "b.toml:4:33: error: `shininess` must be",
        ),
        (
            format!("{parameters}\"materials.red.shininess\" = []\n"),
            "b.toml:4:29: error: `materials.red.shininess` has no values",
        ),
        (
            format!("{parameters}\"image.samples\" = {{ from = 1, to = 2, steps = 3 }}\n"),
            "b.toml:4:19: error: `samples` must be a whole number",
        ),
        (
            format!("{parameters}\"image.samples\" = {{ from = 1, to = [2, 3], steps = 3 }}\n"),
            "b.toml:4:36: error: `from` has 1 numbers, `to` has 2",
        ),
        (
            format!("{parameters}\"image.samples\" = {{ from = 1, to = 2, step = 3 }}\n"),
            "b.toml:4:19: error: this `range` has no `steps`",
        ),
        (
            format!("{parameters}\"image.samples\" = {{ files = \"*\" }}\n"),
            "b.toml:4:19: error: `image.samples` names no file",
        ),
        (
            format!("{parameters}\"ligt.1.color\" = [1]\n"),
            "b.toml:4:2: error: a scene has no table \"ligt\" whose keys can be set (did you mean `light`?)",
        ),
        (
            format!("{top}[slurm]\narray = \"1-2\"\n"),
            "b.toml:4:1: error: the script sets `array` itself",
        ),
        (format!("{top}[slurm]\ntime = [1]\n"), "b.toml:4:8: error: `time` must be text"),
        (
            format!("{top}[slurm]\n\"--time\" = 1\nok = 1\n"),
            "b.toml:4:1: error: \"--time\" is no option of sbatch",
        ),
        (format!("{top}[slurm\n"), "b.toml:3:7: error: "),
    ] {
        let (batch, told) = batch(&text);
        assert!(batch.is_none(), "{text}");
        assert!(told.iter().any(|said| said.starts_with(words)), "{words}\n{told:#?}");
    }
    let twice = only_told(&format!("{parameters}\"camera.fov\" = [20]\ncamera.fov = [30]\n"));
    assert!(twice.starts_with("b.toml:5:1: error: `camera.fov` has values already"), "{twice}");
}

#[test]
fn every_problem_of_a_batch_is_told_in_one_go() {
    let (_, told) = batch("inputs = 3\nname = \"\"\n[parameters]\ncamera.eye = 1\nligt.1.a = 2\n");
    assert_eq!(told.len(), 5, "{told:#?}");
}

#[test]
fn the_reference_and_the_schema_of_batches_name_every_key() {
    let (text, schema) = (batch_reference_markdown(), batch_schema_json());
    let keys = ["version", "inputs", "output", "name", "options", "combine", "shares", "threads"];
    for key in keys.iter().chain(&["parameters", "slurm", "from", "to", "steps", "files"]) {
        assert!(text.contains(&format!("| `{key}` |")), "{key}");
        assert!(schema.contains(&format!("\"{key}\": {{")), "{key}");
    }
}
