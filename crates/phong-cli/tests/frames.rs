//! Frames of trajectories, drawn one after another.
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::fmt::Write as _;
use std::fs;

use support::{Given, given};

const OPTIONS: &str = "--size 24x18 --samples 1";

/// Frame `n` of a water molecule that flies off and comes apart.
fn xyz(n: u32) -> String {
    let x = f64::from(n) * 0.3;
    format!("3\nframe {n}\nO {x} 0 0\nH {} 0.7 0\nH {} -0.7 0\n", x + 0.6, x + 0.6 + x)
}

fn pdb_atoms(n: u32) -> String {
    let atom = |serial: u32, name: &str, x: f64| {
        let element = &name[..1];
        format!(
            "HETATM{serial:5}  {name:<3} LIG A   1    {x:8.3}   0.000   0.000  1.00  0.00           {element}\n"
        )
    };
    atom(1, "C1", 0.0) + &atom(2, "O1", 1.2 + 0.2 * f64::from(n))
}

fn gro(n: u32) -> String {
    let x = 0.1 * f64::from(n);
    format!("t= {n}\n1\n    1SOL     OW    1{x:8.3}   0.100   0.100\n   2.0 2.0 2.0\n")
}

fn dump(n: u32) -> String {
    format!(
        "ITEM: TIMESTEP\n{n}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 4\n\
         ITEM: ATOMS id type x y z\n1 1 {} 1 1\n2 2 3 1 1\n",
        1.0 + 0.1 * f64::from(n)
    )
}

/// Files of five frames in each format, and the files of the frames alone.
fn folder() -> Given {
    let folder = given(&[]);
    let all = |frame: fn(u32) -> String| (0..5).map(frame).collect::<String>();
    let write = |name: &str, text: &str| fs::write(folder.path(name), text).unwrap();
    write("a.xyz", &all(xyz));
    write("a.gro", &all(gro));
    write("a.lammpstrj", &all(dump));
    let (head, tail) =
        ("CRYST1   10.000   10.000   10.000  90.00  90.00  90.00\n", "CONECT    1    2\nEND\n");
    let mut models = head.to_owned();
    for n in 0..5 {
        let _ = write!(models, "MODEL     {:4}\n{}ENDMDL\n", n + 1, pdb_atoms(n));
    }
    write("a.pdb", &(models + tail));
    for n in 0..5 {
        write(&format!("{n}.xyz"), &xyz(n));
        write(&format!("{n}.gro"), &gro(n));
        write(&format!("{n}.lammpstrj"), &dump(n));
        write(&format!("{n}.pdb"), &format!("{head}{}{tail}", pdb_atoms(n)));
    }
    folder
}

/// Two pictures have the very same pixels.
fn are_the_same(folder: &Given, a: &str, b: &str) -> bool {
    folder.when(&format!("compare {a} {b} --json")).json()["max"] == 0.0
}

#[test]
fn a_frame_is_drawn_as_a_file_that_holds_it_alone_from_the_camera_of_the_first() {
    let folder = folder();
    for ending in ["xyz", "pdb", "gro", "lammpstrj"] {
        // Bonds and guessed radii are those of the first frame: spheres of a radius that is known.
        let scene = |file: &str| {
            format!(
                "version = 1\n[camera]\neye = [1, 2, 30]\nlook_at = [1, 0, 0]\n[[light]]\nkind = \"point\"\n\
                 position = [3, 4, 20]\n[[molecule]]\nfile = \"{file}\"\nstyle = \"spacefill\"\nradius = 1\n"
            )
        };
        fs::write(folder.path("all.toml"), scene(&format!("a.{ending}"))).unwrap();
        folder.done(&format!("render all.toml {OPTIONS} --frames 1:5:2 -o f%d.png"));
        for n in [1, 3] {
            fs::write(folder.path("one.toml"), scene(&format!("{n}.{ending}"))).unwrap();
            folder.done(&format!("render one.toml {OPTIONS} -o one.png"));
            assert!(are_the_same(&folder, &format!("f{n}.png"), "one.png"), "{ending}, {n}");
        }
        assert!(!are_the_same(&folder, "f1.png", "f3.png"), "{ending} moves");
        // The first frame of a bare file has the camera that it has alone.
        folder.done(&format!("render a.{ending} {OPTIONS} --frames 2: -o b%d.png"));
        folder.done(&format!("render 2.{ending} {OPTIONS} -o one.png"));
        assert!(are_the_same(&folder, "b2.png", "one.png"), "{ending}");
        for n in [1, 2, 3, 4] {
            assert_eq!(folder.path(&format!("b{n}.png")).is_file(), n > 1, "{ending}, {n}");
            let _ = fs::remove_file(folder.path(&format!("b{n}.png")));
        }
    }
}

#[test]
fn bonds_are_those_of_the_first_frame() {
    let folder = folder();
    let look = format!("{OPTIONS} --eye 1,0,9 --look-at 1,0,0 --aov depth");
    folder.done(&format!("render a.xyz {look} --frames 0:5:4 -o w%d.png"));
    // By then a hydrogen is too far away to be bound.
    folder.done(&format!("render 4.xyz {look} -o alone.png"));
    assert!(!are_the_same(&folder, "w4.depth.png", "alone.depth.png"));
    folder.done(&format!("render 0.xyz {look} -o alone.png"));
    assert!(are_the_same(&folder, "w0.depth.png", "alone.depth.png"));
}

#[test]
fn pictures_of_frames_that_are_there_are_kept() {
    let folder = folder();
    let film = format!("render a.xyz {OPTIONS} --frames : --json --resume -o f-%02d.png");
    assert_eq!(folder.done(&film).json()["pictures"], 5);
    fs::remove_file(folder.path("f-03.png")).unwrap();
    assert_eq!(folder.done(&film).json()["skipped"], 4);
    // One that has changed in the file is drawn again.
    let text = fs::read_to_string(folder.path("a.xyz")).unwrap();
    fs::write(folder.path("a.xyz"), text.replace("O 0.6 0 0", "O 0.7 0 0")).unwrap();
    assert_eq!(folder.done(&film).json()["skipped"], 4);
    folder.done(&format!("render a.xyz {OPTIONS} --frames :4 -o a.gif"));
    assert!(folder.bytes("a.gif").starts_with(b"GIF89a"));
    folder.done(&format!("render a.xyz {OPTIONS} --frames 3 -o three.png"));
    folder.done(&format!("render 3.xyz {OPTIONS} -o alone.png"));
    assert!(are_the_same(&folder, "three.png", "alone.png"));
}

#[test]
fn a_frame_that_is_broken_is_told_with_its_number_and_line() {
    let folder = folder();
    let film = |file: &str| format!("render {file} {OPTIONS} --frames 0: -o f%d.png");
    let broken = |file: &str, of: &str, from: &str, to: &str| {
        let text = fs::read_to_string(folder.path(of)).unwrap();
        assert!(text.contains(from), "{from}");
        fs::write(folder.path(file), text.replace(from, to)).unwrap();
    };
    broken("b.xyz", "a.xyz", "O 0.6 0 0", "O 0.6 zero 0");
    folder.when(&film("b.xyz")).is_refused(&["frame 2", "b.xyz:13:"]);
    assert!(folder.path("f1.png").is_file() && !folder.path("f2.png").is_file());
    broken("c.xyz", "a.xyz", "3\nframe 3", "4\nframe 3");
    folder.when(&film("c.xyz")).is_refused(&["frame 4", "c.xyz:22:1", "--frames 0:4"]);
    broken("d.xyz", "a.xyz", "3\nframe 4", "9\nframe 4");
    folder.when(&film("d.xyz")).is_refused(&["frame 4", "d.xyz:21", "3 of 9 atoms"]);
    broken("b.gro", "a.gro", "t= 3\n1\n", "t= 3\nmany\n");
    folder.when(&film("b.gro")).is_refused(&["frame 3", "b.gro:14"]);
}

#[test]
fn frames_that_are_not_there_are_refused_with_how_many_there_are() {
    let folder = folder();
    folder
        .when("render a.xyz --frames 2:9 -o f%d.png")
        .is_refused(&["5 frames, 0 to 4", "no frame 8"]);
    folder
        .when("render a.pdb --frames 5: -o f%d.png")
        .is_refused(&["5 frames, 0 to 4", "no frame 5"]);
    folder.when("render 0.xyz --frames 0:2 -o f%d.png").is_refused(&["1 frame, 0", "no frame 1"]);
    folder.when("render a.xyz --frames 3:3").is_refused(&["B must be more than A"]);
    folder.when("render a.xyz --frames 0:3 -o a.exr").is_refused(&["3 pictures", "a-%04d.exr"]);
    folder.when("render a.xyz --frames 0:3 --turntable 3").is_refused(&["--turntable"]);
    fs::write(folder.path("p.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    folder.when("render p.obj --frames 0:").is_refused(&["no file", "several frames", "XYZ"]);
    folder.done(&format!("render 0.xyz {OPTIONS} --frames 0: -o one.png"));
}
