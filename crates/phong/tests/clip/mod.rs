//! Clipping: what is cut away, what casts no shadow, and what a cut shows.

use std::fmt::Write as _;

use glam::{DVec3, Vec3};
use phong::aov::Aov;
use phong::explain::{End, explain};
use phong::film::LayerKind;
use phong::geometry::{Geometry, GeometryOptions};
use phong::look::Look;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::TermSet;
use phong::view::{View, ViewError};
use phong_bvh::{Hit, Ray};
use phong_scene::{Cap, Clip, ClipKind, Keep, Limits, MaterialId, Memory, Scene, Shape, read};

const HEAD: &str = "version = 1\n[image]\nsize = [3, 3]\nsamples = 1\n[camera]\neye = [0, 0, 5]\n\
    look_at = [0, 0, 0]\nkind = \"orthographic\"\nheight = 0.01\n[[light]]\nkind = \"distant\"\n\
    direction = [0, 0, -1]\n[materials.plaster]\ncolor = 0.25\nk_a = 0.5\n\
    [[plane]]\npoint = [0, 0, -9]\nnormal = [0, 0, 1]\nmaterial = \"plaster\"\n";
const BALL: &str = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
const FRONT: &str = "[[clip]]\npoint = [0, 0, 0.25]\nnormal = [0, 0, 3]\n";
/// A tetrahedron around the origin, closed, with corners of their own for one of its faces.
const MESH: &str = "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nv 1 1 1\nv -1 1 -1\nv -1 -1 1\n\
    f 1 3 4\nf 1 4 2\nf 2 4 3\nf 5 7 6\n";

fn scene(text: &str) -> Scene {
    let open = MESH.replace("f 5 7 6\n", "");
    let files = Memory::new().with("a.toml", text.as_bytes());
    let files = files.with("closed.obj", MESH.as_bytes()).with("open.obj", open.into_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn seen(text: &str) -> (f32, f32, [f32; 3]) {
    let scene = scene(&format!("{HEAD}{text}"));
    let aovs = [Aov::Depth, Aov::Material, Aov::Normal];
    let options = RenderOptions::of(&scene.image).expect("options").with_aovs(&aovs);
    let film = render(&View::of(&scene).expect("a view"), &options, &|_| {}, &Cancel::new()).film;
    let [depth, material, normal] = aovs.map(|aov| film.layer(LayerKind::Aov(aov)).expect("it"));
    (depth.values[4], material.values[4], [0, 1, 2].map(|axis| normal.values[12 + axis]))
}

#[test]
fn a_cut_ball_shows_its_cap_and_without_one_its_inner_side() {
    let front = [0.0, 0.0, 1.0];
    assert_eq!(seen(BALL), (4.0, 2.0, front));
    assert_eq!(seen(&format!("{BALL}{FRONT}")), (4.75, 2.0, front));
    assert_eq!(seen(&format!("{BALL}{FRONT}cap = false\n")), (6.0, 2.0, front));
    assert_eq!(seen(&format!("{BALL}{FRONT}cap = \"plaster\"\n")), (4.75, 1.0, front));
    assert_eq!(seen(&format!("{BALL}{FRONT}objects = [\"plane 1\"]\n")), (4.0, 2.0, front));
    let away = "[[clip]]\npoint = [0, 0, -2]\nnormal = [0, 0, 1]\n";
    assert_eq!(seen(&format!("{BALL}{away}")), (14.0, 1.0, front));
}

#[test]
fn boxes_cut_notches_or_leave_blocks() {
    let boxed = |keep: &str| {
        format!("{BALL}[[clip]]\nkind = \"box\"\nmin = [-2, -2, -0.5]\nmax = [2, 2, 0.5]\n{keep}")
    };
    // The ball ends before the notch does on its far side; what is before the notch stays.
    assert_eq!(seen(&boxed("")).0, 4.0);
    assert_eq!(seen(&boxed("keep = \"inside\"\n")), (4.5, 2.0, [0.0, 0.0, 1.0]));
    let deep = boxed("").replace("2, 0.5]", "2, 2]");
    assert_eq!(seen(&deep), (5.5, 2.0, [0.0, 0.0, 1.0]));
}

#[test]
fn closed_meshes_have_caps_and_open_ones_none() {
    let mesh = |file: &str| {
        format!("[[mesh]]\nfile = \"{file}.obj\"\nsmooth = false\nmaterial = \"plaster\"\n")
    };
    assert_eq!(seen(&format!("{}{FRONT}", mesh("closed"))).0, 4.75);
    let (depth, ..) = seen(&format!("{}{FRONT}", mesh("open")));
    assert!(depth > 5.0, "{depth}");
}

#[test]
fn what_is_cut_away_casts_no_shadow_and_what_is_left_does() {
    let lit = |text: &str| {
        let under = HEAD.replace("[0, 0, 5]", "[0, 0, -2]").replace("[0, 0, 0]", "[0, 0, -9]");
        let scene = scene(&format!("{under}{text}"));
        let film = render(
            &View::of(&scene).expect("a view"),
            &RenderOptions::of(&scene.image).expect("options").with_aovs(&[Aov::Shadow]),
            &|_| {},
            &Cancel::new(),
        );
        film.film.layer(LayerKind::Aov(Aov::Shadow)).expect("it").values[4]
    };
    assert_eq!(lit(BALL), 0.0);
    assert_eq!(lit(&format!("{BALL}{FRONT}")), 0.0);
    assert_eq!(lit(&format!("{BALL}{}", FRONT.replace("0.25", "-1.5"))), 1.0);
}

#[test]
fn of_things_in_one_another_the_priority_says_whose_cap_is_seen() {
    let core = |keys: &str| {
        format!(
            "{BALL}[materials.core]\n{keys}\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 0.5\n\
             material = \"core\"\n{FRONT}"
        )
    };
    let scene = scene(&format!("{HEAD}{}", core("")));
    let number = scene.materials.iter().position(|m| m.name == "core").expect("it") as f32 + 1.0;
    assert_ne!(seen(&core("")).1, number);
    assert_eq!(seen(&core("priority = 1")).1, number);
}

/// What a ray meets first, worked out from every surface that it crosses.
fn by_hand(view: &View, scene: &Scene, ray: &Ray) -> Option<f64> {
    let at = |t: f64| ray.origin + t * ray.dir.as_dvec3();
    let takes = |clip: &Clip, p: DVec3| match clip.kind {
        ClipKind::Plane { point, normal } => (p - point).dot(normal) > 0.0,
        ClipKind::Box { min, max, keep } => {
            let inside = p.cmpgt(min).all() && p.cmplt(max).all();
            inside == (keep == Keep::Outside)
        }
    };
    let cut_away = |p: DVec3, name: &str| {
        scene.clips.iter().any(|clip| clip.cut_objects().has(name) && takes(clip, p))
    };
    let mut kept: Option<f64> = None;
    let mut from = *ray;
    loop {
        let hit: Hit = view.world().intersect(&from);
        if !hit.is_some() {
            break;
        }
        let name = &view.objects()[view.object(&hit) as usize].name;
        if !cut_away(at(hit.t.into()), name) {
            kept = Some(hit.t.into());
            break;
        }
        from.t_min = hit.t;
    }
    // Caps: the first step along the ray at which it is inside a ball that is there.
    let steps = (1..40_000).map(|step| f64::from(step) * 2.5e-4);
    let inside = |p: DVec3| {
        scene.objects.iter().any(|object| match object.shape {
            Shape::Sphere { center, radius } => {
                p.distance(center) < radius - 1e-3 && !cut_away(p, &object.name)
            }
            _ => false,
        })
    };
    let cap = steps.take_while(|t| kept.is_none_or(|kept| *t < kept)).find(|t| inside(at(*t)));
    cap.or(kept)
}

#[test]
fn the_first_thing_met_is_that_of_trying_all() {
    let mut number = 7_u32;
    let mut random = move || {
        number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(number >> 8) / f64::from(1 << 24)
    };
    let mut text = HEAD.to_owned();
    for _ in 0..12 {
        let [x, y, z, r] = [0; 4].map(|_| random());
        let [x, y, z] = [x, y, z].map(|x| 4.0 * x - 2.0);
        writeln!(text, "[[sphere]]\ncenter = [{x}, {y}, {z}]\nradius = {}", 0.3 + r)
            .expect("memory");
    }
    text += FRONT;
    text += "[[clip]]\nkind = \"box\"\nmin = [-1, -1, -1]\nmax = [1, 0.5, 1]\n";
    text += "[[clip]]\npoint = [0, 1, 0]\nnormal = [0.3, 1, 0]\n\
             objects = [\"sphere 1\", \"sphere 3\", \"sphere 5\"]\n";
    let scene = scene(&text);
    let view = View::of(&scene).expect("a view");
    let mut met = 0;
    for _ in 0..300 {
        let [x, y, a, b] = [0; 4].map(|_| 4.0 * random() - 2.0);
        let origin = DVec3::new(x, y, 4.5);
        let dir = (DVec3::new(a, b, -2.0) - origin).normalize_or(DVec3::NEG_Z).as_vec3();
        let ray = Ray::new(origin, dir);
        let hit = view.intersect(&ray);
        let found = hit.is_some().then_some(f64::from(hit.t));
        let expected = by_hand(&view, &scene, &ray);
        // A cap thinner than a step may be stepped over.
        let far = |(a, b): (f64, f64)| (a - b).abs() > 5e-3;
        let differ = found.zip(expected).is_none_or(far) && found.is_some() | expected.is_some();
        let grazes = found.zip(expected).is_some_and(|(found, expected)| found < expected);
        assert!(!differ || grazes, "{ray:?}: {found:?}, by hand {expected:?}");
        met += u32::from(found.is_some_and(|t| t < 7.0));
    }
    assert!(met > 150, "{met}");
}

#[test]
fn what_is_explained_of_a_cut_scene_is_the_pixel() {
    for text in [
        include_str!("../golden/shapes/clip_plane.toml"),
        include_str!("../golden/shapes/clip_box.toml"),
    ] {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/shapes/");
        let path = |name: &str| std::fs::read(format!("{folder}{name}")).expect("a model");
        let files = Memory::new()
            .with("a.toml", text.as_bytes())
            .with("points.ply", path("points.ply"))
            .with("icosahedron.obj", path("icosahedron.obj"));
        let scene = read("a.toml", None, &files, &Limits::default()).scene.expect("a scene");
        let view = View::of(&scene).expect("a view");
        let options = RenderOptions::of(&scene.image).expect("options").with_terms(TermSet::ALL);
        let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
        let picture = &film.layer(LayerKind::Picture).expect("a picture").values;
        let mut caps = 0;
        for (x, y) in (0..64).step_by(3).flat_map(|x| (0..48).step_by(5).map(move |y| (x, y))) {
            let told = explain(&view, &options, [x, y]).expect("within the picture");
            let at = 3 * (64 * y + x) as usize;
            assert_eq!(told.linear.to_array(), picture[at..at + 3], "at {x}, {y}");
            for sample in &told.samples {
                if let Some(End::Surface(surface)) = sample.ray.as_ref().map(|ray| &ray.end) {
                    caps += u32::from(surface.cap.is_some());
                }
            }
        }
        assert!(caps > 20, "{caps}");
    }
}

#[test]
fn clips_may_differ_from_look_to_look() {
    let written = scene(&format!("{HEAD}{BALL}{FRONT}"));
    let geometry = std::sync::Arc::new(
        Geometry::new(&written, GeometryOptions::default()).expect("a geometry"),
    );
    let depth = |clips: Vec<Clip>| {
        let look = Look { clips, ..Look::new(&written) };
        let view = View::new(std::sync::Arc::clone(&geometry), look)?;
        Ok::<_, ViewError>(view.intersect(&Ray::new(DVec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z)).t)
    };
    let plane = |z: f64, cap| Clip {
        kind: ClipKind::Plane { point: DVec3::new(0.0, 0.0, z), normal: DVec3::Z },
        cap,
        ..Clip::default()
    };
    assert_eq!(depth(Vec::new()).expect("a view"), 4.0);
    assert_eq!(depth(vec![plane(0.5, Cap::Own)]).expect("a view"), 4.5);
    assert!(depth(vec![plane(0.5, Cap::Of(MaterialId(9)))]).is_err());
    assert!(depth(vec![plane(f64::NAN, Cap::Own)]).is_err());
}

#[test]
fn a_look_may_ask_for_caps_that_the_geometry_was_built_without() {
    let closed = "[[mesh]]\nfile = \"closed.obj\"\nsmooth = false\n";
    let ray = Ray::new(DVec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z);
    for body in [BALL, closed] {
        let capped = scene(&format!("{HEAD}{body}{FRONT}"));
        for clip in ["", &format!("{FRONT}cap = false\n")] {
            let bare = scene(&format!("{HEAD}{body}{clip}"));
            let geometry = Geometry::new(&bare, GeometryOptions::default()).expect("a geometry");
            let updated = geometry.update(&bare).expect("a geometry");
            for geometry in [geometry, updated] {
                let view = View::new(std::sync::Arc::new(geometry), Look::new(&capped));
                assert_eq!(view.expect("a view").intersect(&ray).t, 4.75, "{body}{clip}");
            }
        }
    }
}
