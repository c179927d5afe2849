//! Surfaces in one place: which is met first, and glass that touches or fills other glass.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use std::sync::Arc;

use phong::aov::Aov;
use phong::explain::{End, explain};
use phong::film::{Film, LayerKind};
use phong::geometry::{Geometry, GeometryOptions};
use phong::look::Look;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_bvh::{BuildOptions, Level};
use phong_scene::{Limits, Memory, Scene};

const FIRST: &str = include_str!("cases/floor-first.toml");
const LAST: &str = include_str!("cases/floor-last.toml");

/// A picture of what is added, from slightly above.
fn text(more: &[&str]) -> String {
    format!(
        "version = 1\n[image]\nsize = [48, 36]\nsamples = 1\ndepth = 8\nmin_weight = 0\n\
         background = {{ top = \"#9db4cf\", bottom = \"#202020\" }}\n\
         [camera]\neye = [3.1, 2.5, 6.2]\nlook_at = [0, 0.4, 0]\nfov = 30\n\
         [[light]]\nkind = \"distant\"\ndirection = [-1, -2, -1]\nshadows = false\n\
         [materials.glass]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\nreflection = 1\ntransmission = 1\n\
         [materials.water]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\nreflection = 1\ntransmission = 1\n\
         ior = 1.33\n\
         [materials.hard]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\nreflection = 1\ntransmission = 1\n\
         priority = 1\n\
         [materials.hollow]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\nreflection = 1\ntransmission = 1\n\
         ior = 0.6666667\n\
         [materials.film]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\ntransmission = 0.5\nfresnel = false\n\
         ior = 1\npriority = 1\n\
         [materials.red]\ncolor = \"#c03020\"\n[materials.blue]\ncolor = \"#3050c0\"\n\
         [materials.label]\ncolor = \"#3050c0\"\npriority = 1\n{}",
        more.concat()
    )
}

const FLOOR: &str = "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"red\"\n";

fn glass_box(min: [f64; 3], max: [f64; 3], material: &str) -> String {
    format!("[[box]]\nmin = {min:?}\nmax = {max:?}\nmaterial = \"{material}\"\n")
}

/// A cube of 1 on y = 0 as a mesh of 12 triangles, whose normals point outwards.
const CUBE: &str = "v -1 0 -0.5\nv 1 0 -0.5\nv 1 1 -0.5\nv -1 1 -0.5\nv -1 0 0.5\nv 1 0 0.5\nv 1 1 0.5\n\
    v -1 1 0.5\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

/// Two such cubes side by side in one mesh.
fn two_cubes() -> String {
    let mut text = String::new();
    for (shift, first) in [(-1.0, 0), (1.0, 8)] {
        for line in CUBE.lines() {
            let mut words = line.split(' ');
            let kind = words.next().unwrap();
            let numbers: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
            let line = if kind == "v" {
                format!("v {} {} {}\n", numbers[0] + shift, numbers[1], numbers[2])
            } else {
                let corner = |i: usize| numbers[i] as u32 + first;
                format!("f {} {} {} {}\n", corner(0), corner(1), corner(2), corner(3))
            };
            text += &line;
        }
    }
    text
}

fn scene(text: &str) -> Scene {
    let source = Memory::new()
        .with("scene.toml", text.as_bytes())
        .with("cube.obj", CUBE.as_bytes())
        .with("cubes.obj", two_cubes().into_bytes());
    let reading = phong_scene::read("scene.toml", None, &source, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:#?}", reading.diagnostics))
}

/// The picture of a scene, which is what is explained of each of its pixels.
fn drawn(text: &str) -> Film {
    let scene = scene(text);
    let view = View::of(&scene).unwrap();
    let options = RenderOptions::of(&scene.image).unwrap().with_aovs(&[Aov::Object]);
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    for pixel in [[20, 20], [24, 24], [28, 22], [17, 25], [30, 30], [24, 17]] {
        let told = explain(&view, &options, pixel).unwrap().linear.to_array();
        assert_eq!(told, film.at(LayerKind::Picture, pixel[0], pixel[1]).unwrap(), "{pixel:?}");
    }
    film
}

fn values(film: &Film) -> &[f32] {
    &film.layers[0].values
}

/// Holds two pictures to be the same but for what rounding does, and for few pixels at edges.
#[track_caller]
fn assert_same(a: &Film, b: &Film) {
    let pixels = values(a).as_chunks::<3>().0.iter().zip(values(b).as_chunks::<3>().0);
    let apart =
        |a: &[f32; 3], b: &[f32; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
    let differ = pixels.clone().filter(|(a, b)| apart(a, b) > 2e-4).count();
    let all = pixels.len();
    assert!(differ * 100 <= all, "{differ} of {all} pixels differ");
}

/// Holds that the order of two shapes in the text changes no bit.
#[track_caller]
fn in_any_order(a: &str, b: &str) -> Film {
    let (one, other) = (drawn(&text(&[a, b])), drawn(&text(&[b, a])));
    assert_eq!(values(&one), values(&other), "the order of the text matters");
    one
}

#[test]
fn glass_on_a_floor_is_drawn_alike_in_any_order() {
    let [first, last] = [FIRST, LAST].map(|text| {
        let scene = scene(&text.replace("size = [240, 180]", "size = [60, 45]"));
        let options = RenderOptions::of(&scene.image).unwrap();
        render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film
    });
    assert_eq!(values(&first), values(&last));
}

#[test]
fn a_floor_is_seen_through_the_glass_that_stands_on_it() {
    let on = in_any_order(FLOOR, &glass_box([-1.0, 0.0, -0.5], [1.0, 1.0, 0.5], "glass"));
    // A floor within the glass is met before the glass ends.
    let sunk = glass_box([-1.0, -0.01, -0.5], [1.0, 1.0, 0.5], "glass");
    assert_same(&on, &drawn(&text(&[FLOOR, &sunk])));
}

#[test]
fn a_mesh_of_glass_on_a_disc_shows_the_disc() {
    let disc = "[[disc]]\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 9\nmaterial = \"red\"\n";
    let cube = "[[mesh]]\nfile = \"cube.obj\"\nmaterial = \"glass\"\nsmooth = false\n";
    let sunk = glass_box([-1.0, -0.01, -0.5], [1.0, 1.0, 0.5], "glass");
    assert_same(&in_any_order(disc, cube), &drawn(&text(&[disc, &sunk])));
}

#[test]
fn a_turned_cylinder_of_glass_shows_the_box_it_stands_on() {
    let table = "[[box]]\nmin = [-4, -1, -4]\nmax = [4, 0.3, 4]\nmaterial = \"red\"\n";
    let glass = |from: f64| {
        format!(
            "[[cylinder]]\nfrom = [0, {from}, 0]\nto = [0, 1.2, 0]\nradius = 0.7\nmaterial = \"glass\"\n\
             rotate = [0, 1, 0, 33]\n"
        )
    };
    let on = in_any_order(table, &glass(0.3));
    assert_same(&on, &drawn(&text(&[table, &glass(0.29)])));
}

#[test]
fn two_touching_glasses_of_one_index_are_one() {
    let left = glass_box([-1.0, 0.1, -0.5], [0.1, 1.1, 0.5], "glass");
    let right = glass_box([0.1, 0.1, -0.5], [1.0, 1.1, 0.5], "glass");
    let both = in_any_order(&left, &right);
    let one = glass_box([-1.0, 0.1, -0.5], [1.0, 1.1, 0.5], "glass");
    assert_same(&both, &drawn(&text(&[&one])));
}

#[test]
fn touching_meshes_of_one_glass_are_one() {
    let cube = "[[mesh]]\nfile = \"cube.obj\"\nmaterial = \"glass\"\nsmooth = false\nscale = [0.5, 1, 1]\n";
    let left = format!("{cube}translate = [-0.5, 0.1, 0]\n");
    let right = format!("{cube}translate = [0.5, 0.1, 0]\n");
    let one = glass_box([-1.0, 0.1, -0.5], [1.0, 1.1, 0.5], "glass");
    assert_same(&in_any_order(&left, &right), &drawn(&text(&[&one])));
}

#[test]
fn touching_blocks_in_one_mesh_are_one() {
    let blocks = "[[mesh]]\nfile = \"cubes.obj\"\nmaterial = \"glass\"\nsmooth = false\n\
                  scale = [0.5, 1, 1]\ntranslate = [0, 0.1, 0]\n";
    let one = glass_box([-1.0, 0.1, -0.5], [1.0, 1.1, 0.5], "glass");
    assert_same(&drawn(&text(&[blocks])), &drawn(&text(&[&one])));
}

#[test]
fn two_touching_glasses_of_two_indices_have_one_interface() {
    let left = glass_box([-1.0, 0.1, -0.5], [0.1, 1.1, 0.5], "hard");
    let right = glass_box([0.1, 0.1, -0.5], [1.0, 1.1, 0.5], "water");
    // Water that reaches into glass of a higher priority ends where the glass begins.
    let under = glass_box([-0.7, 0.1, -0.5], [1.0, 1.1, 0.5], "water");
    assert_same(&in_any_order(&left, &right), &drawn(&text(&[&left, &under])));
    let equal = glass_box([-1.0, 0.1, -0.5], [0.1, 1.1, 0.5], "glass");
    assert_same(&in_any_order(&equal, &right), &drawn(&text(&[&left, &right])));
}

#[test]
fn glasses_of_one_index_that_overlap_are_one_where_priorities_differ() {
    let left = glass_box([-1.0, 0.1, -0.5], [0.4, 1.1, 0.5], "hard");
    let right = glass_box([-0.2, 0.1, -0.5], [1.0, 1.1, 0.5], "glass");
    let one = glass_box([-1.0, 0.1, -0.5], [1.0, 1.1, 0.5], "glass");
    assert_same(&in_any_order(&left, &right), &drawn(&text(&[&one])));
}

#[test]
fn liquid_that_fills_a_hollow_glass_has_its_own_index() {
    let cylinder = |radius: f64, from: f64, to: f64, material: &str| {
        format!(
            "[[cylinder]]\nfrom = [0, {from}, 0]\nto = [0, {to}, 0]\nradius = {radius}\n\
             material = \"{material}\"\n"
        )
    };
    let glass = cylinder(0.9, 0.0, 1.4, "glass");
    let (hollow, liquid) = (cylinder(0.7, 0.2, 1.3, "hollow"), cylinder(0.7, 0.2, 1.3, "water"));
    let one = text(&[FLOOR, &glass, &hollow, &liquid]);
    let other = text(&[&liquid, &hollow, &glass, FLOOR]);
    let relative = "[materials.relative]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\nreflection = 1\n\
                    transmission = 1\nior = 0.8866667\n";
    let filled = cylinder(0.7, 0.2, 1.3, "relative");
    let [one, other] = [drawn(&one), drawn(&other)];
    assert_same(&one, &other);
    assert_same(&one, &drawn(&text(&[FLOOR, &glass, relative, &filled])));
}

#[test]
fn within_liquid_a_rod_of_higher_priority_is_glass() {
    let cylinder = |radius: f64, from: f64, to: f64, material: &str| {
        format!(
            "[[cylinder]]\nfrom = [0, {from}, 0]\nto = [0, {to}, 0]\nradius = {radius}\n\
             material = \"{material}\"\n"
        )
    };
    let water = cylinder(0.9, 0.1, 1.4, "water");
    let both = in_any_order(&cylinder(0.4, 0.3, 1.1, "hard"), &water);
    // Its own index is relative to no glass; without a priority it is relative to the water around it.
    let relative = "[materials.relative]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\nreflection = 1\n\
                    transmission = 1\nior = 1.1278195\n";
    let rod = cylinder(0.4, 0.3, 1.1, "relative");
    assert_same(&both, &drawn(&text(&[&water, relative, &rod])));
}

#[test]
fn a_label_in_a_plane_is_seen_all_over() {
    let disc = |y: f64, material: &str| {
        format!(
            "[[disc]]\ncenter = [0.1, {y}, 0.2]\nnormal = [0, 1, 0]\nradius = 0.8\n\
             material = \"{material}\"\n"
        )
    };
    let label = in_any_order(FLOOR, &disc(0.0, "label"));
    assert_same(&label, &drawn(&text(&[FLOOR, &disc(1e-4, "blue")])));
    // Below the plane's priority it is not to be seen.
    let floor = FLOOR.replace("red", "label");
    let hidden = in_any_order(&floor, &disc(0.0, "red"));
    assert_same(&hidden, &drawn(&text(&[&floor])));
}

#[test]
fn a_label_in_the_face_of_a_tilted_box_is_seen_all_over() {
    let tilt = "rotate = [[1, 0, 0, 20], [0, 1, 0, 25]]\n";
    let table =
        format!("[[box]]\nmin = [-1, 0, -1]\nmax = [1, 0.5, 1]\nmaterial = \"red\"\n{tilt}");
    let label = |y: f64, material: &str| {
        format!(
            "[[triangle]]\npoints = [[-0.8, {y}, -0.8], [0, {y}, 0.9], [0.9, {y}, -0.5]]\n\
             material = \"{material}\"\n{tilt}"
        )
    };
    let shown = in_any_order(&table, &label(0.5, "label"));
    assert_same(&shown, &drawn(&text(&[&table, &label(0.5001, "blue")])));
}

#[test]
fn a_film_of_higher_priority_shows_the_plane_it_lies_in() {
    let film =
        "[[disc]]\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 20\nmaterial = \"film\"\n";
    let covered = in_any_order(FLOOR, film);
    let bare = drawn(&text(&[FLOOR]));
    let object = |film: &Film| film.at(LayerKind::Aov(Aov::Object), 24, 24).unwrap()[0];
    assert_eq!((object(&drawn(&text(&[FLOOR, film]))), object(&bare)), (2.0, 1.0));
    for y in 20..36 {
        let at = |film: &Film| film.at(LayerKind::Picture, 24, y).unwrap().to_vec();
        for (a, b) in at(&covered).into_iter().zip(at(&bare)) {
            assert!((a - 0.5 * b).abs() < 1e-5, "{a} of {b}");
        }
    }
}

#[test]
fn a_pane_through_which_nothing_is_bent_is_still_drawn() {
    let pane = glass_box([-1.0, 0.0, -0.5], [1.0, 1.0, 0.5], "film");
    let [with, without] = [drawn(&text(&[FLOOR, &pane])), drawn(&text(&[FLOOR]))];
    assert!(values(&with) != values(&without));
}

#[test]
fn threads_tiles_and_simd_levels_change_no_bit_where_surfaces_coincide() {
    let left = glass_box([-1.0, 0.0, -0.5], [0.1, 1.0, 0.5], "hard");
    let right = glass_box([0.1, 0.0, -0.5], [1.0, 1.0, 0.5], "water");
    let label =
        "[[disc]]\ncenter = [0, 0, 1]\nnormal = [0, 1, 0]\nradius = 0.6\nmaterial = \"label\"\n";
    let scene = scene(&text(&[FLOOR, &left, &right, label]));
    let options = RenderOptions::of(&scene.image).unwrap().with_depth(3).unwrap();
    let drawn = |level: Option<Level>, tile: u32, threads: usize| {
        let build = Some(BuildOptions { level, ..BuildOptions::default() });
        let geometry = GeometryOptions { build, ..GeometryOptions::default() };
        let geometry = Arc::new(Geometry::new(&scene, geometry).unwrap());
        let view = View::new(geometry, Look::new(&scene)).unwrap();
        let options = options.clone().with_tile(tile).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| render(&view, &options, &|_| {}, &Cancel::new())).film
    };
    let usual = drawn(None, 16, 1);
    for film in [drawn(None, 16, 3), drawn(None, 5, 2), drawn(Some(Level::Scalar), 16, 2)] {
        assert_eq!(values(&film), values(&usual));
    }
}

#[test]
fn explain_tells_the_index_where_two_glasses_meet() {
    let left = glass_box([-1.0, 0.1, -0.5], [0.1, 1.1, 0.5], "glass");
    let right = glass_box([0.1, 0.1, -0.5], [1.0, 1.1, 0.5], "water");
    let scene = scene(&text(&[&left, &right]));
    let options = RenderOptions::of(&scene.image).unwrap().with_depth(3).unwrap();
    let told = explain(&View::of(&scene).unwrap(), &options, [24, 20]).unwrap();
    let mut rays: Vec<_> = told.samples.into_iter().filter_map(|sample| sample.ray).collect();
    let mut etas = Vec::new();
    while let Some(ray) = rays.pop() {
        let End::Surface(surface) = ray.end else { continue };
        etas.extend(surface.eta);
        let onward = [surface.reflection, surface.transmission].into_iter().flatten();
        rays.extend(onward.filter_map(|onward| onward.ray));
    }
    let has = |want: f32| etas.iter().any(|eta| (eta - want).abs() < 1e-6);
    assert!(has(1.5 / 1.33) || has(1.33 / 1.5), "{etas:?}");
}
