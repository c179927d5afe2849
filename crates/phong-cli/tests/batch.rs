//! A batch makes the pictures that `phong render` makes, each once, under names by their content.
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::fs;

use support::{BALLS, Given, Then, given};

const SWEEP: &str = r#"
version = 1
inputs = "a.toml"
name = "{scene}-{reflection}-{frame}.png"
options = "--samples 1"
[parameters]
"materials.mirror.reflection" = [0, 0.25, 1]
"#;

fn sweep() -> Given {
    given(&[("a.toml", BALLS), ("sweep.toml", SWEEP)])
}

fn told(then: &Then) -> &str {
    std::str::from_utf8(&then.out).unwrap()
}

/// How often tasks were begun in a folder of pictures.
fn starts(folder: &Given, output: &str) -> usize {
    let records = fs::read_dir(folder.path(output).join(".batch")).unwrap();
    let text = |entry: fs::DirEntry| fs::read_to_string(entry.path()).unwrap();
    records.map(|entry| text(entry.unwrap()).matches("\"start\"").count()).sum()
}

/// The pictures of a batch by their content.
fn contents(folder: &Given, output: &str) -> Vec<String> {
    let entries = fs::read_dir(folder.path(output).join("by-content")).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_batch_that_is_only_looked_at_writes_nothing() {
    let folder = sweep();
    let then = folder.done("batch sweep.toml");
    let plan = told(&then);
    assert!(plan.starts_with("3 pictures: 1 input × 3 materials.mirror.reflection\n"), "{plan}");
    assert!(plan.contains("2     missing  a-1-0.png"), "{plan}");
    assert_eq!(folder.names(), ["a.toml", "sweep.toml"]);
}

#[test]
fn every_picture_has_the_bytes_of_a_render_and_is_drawn_once() {
    let folder = sweep();
    assert_eq!(folder.when("batch sweep.toml --status").code, Some(1));
    folder.done("batch sweep.toml --run --jobs 2");
    for reflection in ["0", "0.25", "1"] {
        let set = format!("--set materials.mirror.reflection={reflection}");
        folder.done(&format!("render a.toml --samples 1 {set} -o alone.png"));
        assert_eq!(folder.bytes("alone.png"), folder.bytes(&format!("sweep/a-{reflection}-0.png")));
    }
    assert_eq!((starts(&folder, "sweep"), contents(&folder, "sweep").len()), (3, 3));
    folder.done("batch sweep.toml --run");
    folder.done("batch sweep.toml --task 1");
    assert_eq!(starts(&folder, "sweep"), 3);
    assert!(told(&folder.done("batch sweep.toml --status")).ends_with("\n3 done\n"));
}

#[test]
fn what_changes_gets_another_name_and_what_does_not_is_not_drawn_again() {
    let folder = sweep();
    folder.done("batch sweep.toml --run");
    // Another parameter value: one picture more.
    fs::write(folder.path("sweep.toml"), SWEEP.replace("[0, 0.25, 1]", "[0, 0.25, 0.5, 1]"))
        .unwrap();
    folder.done("batch sweep.toml --run");
    assert_eq!(starts(&folder, "sweep"), 4);
    // Another scene: all of them. The former ones stay, by their content.
    let before = folder.bytes("sweep/a-0-0.png");
    fs::write(folder.path("a.toml"), BALLS.replace("radius = 1", "radius = 0.5")).unwrap();
    folder.done("batch sweep.toml --run");
    assert_eq!((starts(&folder, "sweep"), contents(&folder, "sweep").len()), (8, 8));
    assert_ne!(folder.bytes("sweep/a-0-0.png"), before);
    // And back: nothing to do but the names.
    fs::write(folder.path("a.toml"), BALLS).unwrap();
    folder.done("batch sweep.toml --run");
    assert_eq!(starts(&folder, "sweep"), 8);
    assert_eq!(folder.bytes("sweep/a-0-0.png"), before);
}

#[test]
fn a_change_of_an_included_file_counts_and_its_place_does_not() {
    let folder = given(&[
        ("a.toml", &format!("{BALLS}[[include]]\nfile = \"more.toml\"\n")),
        ("more.toml", "[[sphere]]\ncenter = [2, 1, 0]\nradius = 0.5\n"),
        ("b.toml", "version = 1\ninputs = \"a.toml\"\n"),
    ]);
    let file = |folder: &Given, words: &str| {
        folder.done(words).json()["tasks"][0]["file"].as_str().unwrap().to_owned()
    };
    let first = file(&folder, "batch b.toml --json");
    assert_eq!(first, file(&folder, "batch b.toml --json"));
    fs::write(folder.path("more.toml"), "[[sphere]]\ncenter = [2, 1, 0]\nradius = 0.4\n").unwrap();
    assert_ne!(first, file(&folder, "batch b.toml --json"));
    let elsewhere = given(&[
        ("a.toml", &format!("{BALLS}[[include]]\nfile = \"more.toml\"\n")),
        ("more.toml", "[[sphere]]\ncenter = [2, 1, 0]\nradius = 0.5\n"),
        ("b.toml", "version = 1\ninputs = \"a.toml\"\n"),
    ]);
    assert_eq!(first, file(&elsewhere, "batch b.toml --json"));
}

#[test]
fn shares_are_put_together_to_the_same_bytes() {
    let folder = given(&[
        ("a.toml", BALLS),
        (
            "b.toml",
            "version = 1\ninputs = \"a.toml\"\nname = \"whole.exr\"\nshares = 3\noptions = \"--terms\"\n",
        ),
    ]);
    let early = folder.when("batch b.toml --task 3");
    assert_eq!(early.code, Some(3));
    assert!(early.err.contains("shares of picture 0 are lacking: tasks 0, 1, 2"), "{}", early.err);
    let failed = folder.when("batch b.toml --status");
    assert!(
        told(&failed).contains("task 3 (whole.exr, of its shares) failed with 3"),
        "{}",
        told(&failed)
    );
    folder.done("batch b.toml --run --jobs 2");
    folder.done("render a.toml --terms -o alone.exr");
    assert_eq!(folder.bytes("b/whole.exr"), folder.bytes("alone.exr"));
    assert_eq!(contents(&folder, "b").len(), 1);
    folder.done("batch b.toml --task 0");
    assert_eq!(starts(&folder, "b"), 5);
}

#[test]
fn layers_of_a_png_have_names_as_well() {
    let folder = given(&[
        ("a.toml", BALLS),
        ("b.toml", "version = 1\ninputs = \"a.toml\"\noptions = \"--aov depth --samples 1\"\n"),
    ]);
    folder.done("batch b.toml --run");
    folder.done("render a.toml --aov depth --samples 1 -o alone.png");
    assert_eq!(folder.bytes("b/a.depth.png"), folder.bytes("alone.depth.png"));
}

#[test]
fn frames_are_found_by_a_pattern_in_the_order_of_their_numbers() {
    let triangle = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let film = "version = 1\ncombine = \"zip\"\ninputs = \"film.toml\"\nname = \"{frame}-{file}-{task}\"\n\
                [parameters]\nmesh.1.file = { files = \"f-*.ply\" }\ncamera.eye = { from = [0, 0, 5], to = [0, 0, 6], steps = 3 }\n";
    let scene = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n[image]\nsize = [8, 8]\n[[mesh]]\nfile = \"f-9.ply\"\n";
    let folder = given(&[
        ("film.toml", scene),
        ("b.toml", film),
        (
            "bare.toml",
            "version = 1\ninputs = [\"f-*.ply\"]\noptions = \"--view front --size 8x8\"\n",
        ),
        ("f-9.ply", triangle),
        ("f-10.ply", &triangle.replace("0 1 0", "0 2 0")),
        ("f-100.ply", &triangle.replace("0 1 0", "0 3 0")),
    ]);
    let names = |words: &str| -> Vec<String> {
        let told = folder.done(words).json();
        let tasks = told["tasks"].as_array().unwrap();
        tasks.iter().map(|task| task["picture"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(names("batch b.toml --json"), ["0-f-9-0.png", "0-f-10-1.png", "0-f-100-2.png"]);
    assert_eq!(names("batch bare.toml --json"), ["f-9.png", "f-10.png", "f-100.png"]);
    folder.done("batch b.toml --run");
    folder.done("batch bare.toml --run");
    folder.done("render f-10.ply --view front --size 8x8 -o alone.png");
    assert_eq!(folder.bytes("bare/f-10.png"), folder.bytes("alone.png"));
    assert_eq!(contents(&folder, "b").len(), 3);
}

#[test]
fn an_index_leads_from_parameters_to_files() {
    let folder = sweep();
    folder.done("batch sweep.toml --run");
    let index: serde_json::Value =
        serde_json::from_slice(&folder.bytes("sweep/index.json")).unwrap();
    let picture = &index[1];
    assert_eq!(picture["parameters"]["materials.mirror.reflection"], 0.25);
    let file = format!("sweep/{}", picture["file"].as_str().unwrap());
    assert_eq!(folder.bytes(&file), folder.bytes("sweep/a-0.25-0.png"));
    let table = String::from_utf8(folder.bytes("sweep/index.tsv")).unwrap();
    assert!(
        table.starts_with("picture\tname\tfile\tinput\tmaterials.mirror.reflection\n"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 4);
}

#[test]
fn with_an_error_in_the_batch_nothing_is_begun() {
    let top = "version = 1\n";
    for (text, words) in [
        ("inputs = \"b.tml\"\n", &["sweep.toml:2:10", "b.tml", "there is no such file"][..]),
        ("inputs = \"*.obj\"\n", &["sweep.toml:2:10", "no file is called like this"]),
        (
            "inputs = \"a.toml\"\noptions = \"--sampels 4\"\n",
            &["sweep.toml:3:11", "--sampels", "--samples"],
        ),
        (
            "inputs = \"a.toml\"\noptions = \"--tile 0/2\"\n",
            &["sweep.toml:3:11", "write `shares = N`"],
        ),
        (
            "inputs = \"a.toml\"\nname = \"{sene}\"\n",
            &["sweep.toml:3:8", "did you mean `{scene}`?"],
        ),
        (
            "inputs = \"a.toml\"\nname = \"x\"\n[parameters]\nimage.samples = [1, 2]\n",
            &["sweep.toml:3:8", "pictures 0 and 1 would both be called x.png"],
        ),
        (
            "inputs = \"a.toml\"\n[parameters]\nimage.sampels = [1]\n",
            &["sweep.toml:4:7", "did you mean `samples`?"],
        ),
        (
            "inputs = \"a.toml\"\n[parameters]\nmaterials.miror.reflection = [1]\n",
            &["sweep.toml:4:1", "did you mean `mirror`?"],
        ),
        (
            "inputs = \"a.toml\"\n[parameters]\ncamera.eye = [[1, 2, 3], [0, 0.7, 0]]\n",
            &["look_at", "sweep.toml:4:", "camera.eye = [0, 0.7, 0]"],
        ),
        (
            "inputs = \"a.toml\"\ncombine = \"zip\"\n[parameters]\nimage.samples = [1, 2]\nimage.seed = [1, 2, 3]\n",
            &["sweep.toml:5:1", "there are 2 values here, and 3 elsewhere"],
        ),
        (
            "inputs = \"a.toml\"\n[parameters]\nimage.seed = { from = 1, to = 1000, steps = 1000 }\nimage.samples = { from = 1, to = 10000, steps = 10000 }\n",
            &["more than 1000000 pictures"],
        ),
    ] {
        let folder = given(&[("a.toml", BALLS), ("sweep.toml", &format!("{top}{text}"))]);
        for command in
            ["batch sweep.toml", "batch sweep.toml --run", "batch sweep.toml --script make"]
        {
            folder.when(command).is_refused(words);
        }
        assert_eq!(folder.names(), ["a.toml", "sweep.toml"], "{text}");
    }
    sweep()
        .when("batch sweep.toml --task 3")
        .is_refused(&["there is no task 3: the last one is 2"]);
    sweep().when("batch sweep.tml").is_refused(&["there is no such file", "did you mean"]);
}

#[test]
fn a_task_that_fails_keeps_its_error_and_the_others_are_done() {
    let folder = given(&[
        ("a.toml", BALLS),
        ("b.toml", &BALLS.replace("size = [40, 30]", "size = [4000, 3000]")),
        ("c.toml", "version = 1\ninputs = [\"a.toml\", \"b.toml\"]\n"),
    ]);
    let then = folder.when("batch c.toml --run --max-memory 30M");
    assert_eq!(then.code, Some(3), "{}", then.err);
    assert!(then.err.contains("1 task has failed"), "{}", then.err);
    let status = folder.when("batch c.toml --status --json").json();
    assert_eq!((&status["done"], &status["failed"]), (&1.into(), &1.into()));
    let failed = &status["tasks"][1];
    assert_eq!(failed["code"], 2);
    assert!(failed["error"].as_str().unwrap().contains("over the limit"), "{failed}");
    let then = folder.when("batch c.toml --status");
    assert!(told(&then).contains("task 1 (b.png) failed with 2 on "), "{}", told(&then));
}

#[test]
fn a_file_that_is_not_of_the_batch_is_not_replaced() {
    let folder = sweep();
    fs::create_dir(folder.path("sweep")).unwrap();
    fs::write(folder.path("sweep/a-0-0.png"), b"mine").unwrap();
    folder.when("batch sweep.toml --task 0").is_refused(&["a-0-0.png", "no picture of this batch"]);
    assert_eq!(folder.bytes("sweep/a-0-0.png"), b"mine");
}

#[test]
fn scripts_name_every_task_and_the_shares_first() {
    let folder = sweep();
    let slurm = String::from_utf8(folder.done("batch sweep.toml --script slurm").out).unwrap();
    for words in
        ["#SBATCH --array=0-2\n", "#SBATCH --signal=TERM@60\n", "#SBATCH --requeue\n", "batch "]
    {
        assert!(slurm.contains(words), "{slurm}");
    }
    let shares = SWEEP.replace(
        "[parameters]",
        "shares = 2\nthreads = 3\n[slurm]\ntime = \"1:00\"\nmem = 500\n[parameters]",
    );
    fs::write(folder.path("sweep.toml"), shares).unwrap();
    let slurm = String::from_utf8(folder.done("batch sweep.toml --script slurm").out).unwrap();
    for words in [
        "#SBATCH --array=0-5\n",
        "#SBATCH --time=1:00\n",
        "#SBATCH --mem=500\n",
        "#SBATCH --cpus-per-task=3\n",
        "--array=0-2 \"$@\" \"$0\" 6 9 3\n",
        "afterok",
    ] {
        assert!(slurm.contains(words), "{words}\n{slurm}");
    }
    let make = String::from_utf8(folder.done("batch sweep.toml --script make").out).unwrap();
    assert!(
        make.contains("all: task-6 task-7 task-8\n") && make.contains("task-7: task-2 task-3\n"),
        "{make}"
    );
    let parallel =
        String::from_utf8(folder.done("batch sweep.toml --script parallel").out).unwrap();
    assert!(parallel.contains("tasks 0 5 \"$@\"\ntasks 6 8 \"$@\"\n"), "{parallel}");
    for text in [&slurm, &parallel] {
        fs::write(folder.path("script"), text).unwrap();
        let bash = std::process::Command::new("bash").arg("-n").arg(folder.path("script")).status();
        assert!(bash.unwrap().success(), "{text}");
    }
}

#[test]
fn a_value_laid_over_a_scene_is_drawn() {
    let folder = sweep();
    folder
        .done("render a.toml --set image.size=[8,6] --set materials.mirror.color=tomato -o a.png");
    let scene = BALLS
        .replace("[40, 30]", "[8, 6]")
        .replace("reflection = 0.5", "reflection = 0.5\ncolor = \"tomato\"");
    fs::write(folder.path("b.toml"), scene).unwrap();
    folder.done("render b.toml");
    let then = folder.done("compare a.png b.png --json");
    assert_eq!(then.json()["max"], 0.0);
    folder
        .when("render a.toml --set camera.fvo=30")
        .is_refused(&["--set:1:8", "did you mean `fov`?"]);
    folder.when("render a.toml --set camera.fov").is_refused(&["KEY=VALUE"]);
}
