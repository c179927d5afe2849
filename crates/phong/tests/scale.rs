//! Large and small, near and far: a scene draws the same picture however its numbers are written.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::film::LayerKind;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Limits, Memory, Rgb, read};

const SIZE: usize = 64;

/// A ball and a box under a lamp, `more` around them; `s` is a unit of length, `x` how far it is moved along x.
fn things(s: f64, x: f64, more: &str) -> String {
    format!(
        "version = 1\n[image]\nsize = [{SIZE}, {SIZE}]\nbackground = 0.2\n\
         [camera]\neye = [{x}, {}, {}]\nlook_at = [{x}, 0, 0]\n\
         [[light]]\nkind = \"point\"\nposition = [{}, {}, {}]\n\
         [[sphere]]\ncenter = [{x}, 0, 0]\nradius = {s}\n\
         [[box]]\nmin = [{}, {}, {}]\nmax = [{}, {s}, {s}]\n{more}",
        3.0 * s,
        8.0 * s,
        x + 4.0 * s,
        5.0 * s,
        3.0 * s,
        x + 1.2 * s,
        -s,
        -s,
        x + 2.2 * s,
    )
}

const PLANE: &str = "[[plane]]\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n";

fn picture(text: &str) -> Vec<Rgb> {
    let files = Memory::new().with("scene.toml", text.as_bytes());
    let files = files.with("ground.obj", ground(1e8).as_bytes());
    let result = read("scene.toml", None, &files, &Limits::default());
    let scene = result.scene.unwrap_or_else(|| panic!("{:?}", result.diagnostics));
    let options = RenderOptions::of(&scene.image).unwrap();
    let film = render(&View::of(&scene).unwrap(), &options, &|_| (), &Cancel::default()).film;
    let layer = film.layer(LayerKind::Picture).unwrap();
    layer.values.chunks(3).map(|v| Rgb::new(v[0], v[1], v[2])).collect()
}

fn ground(r: f64) -> String {
    format!("v {} -1 {r}\nv {r} -1 {r}\nv {r} -1 {}\nv {} -1 {}\nf 1 2 3 4\n", -r, -r, -r, -r)
}

/// The largest difference away from edges of the first picture, and how many pixels were compared.
fn difference(one: &[Rgb], other: &[Rgb]) -> (f32, usize) {
    let off = |a: Rgb, b: Rgb| (a.r - b.r).abs().max((a.g - b.g).abs()).max((a.b - b.b).abs());
    let (mut most, mut count) = (0.0_f32, 0);
    for y in 1..SIZE - 1 {
        for x in 1..SIZE - 1 {
            let at = |dx: usize, dy: usize| one[(y + dy - 1) * SIZE + x + dx - 1];
            let here = at(1, 1);
            if (0..9).all(|i| off(at(i % 3, i / 3), here) < 0.05) {
                most = most.max(off(here, other[y * SIZE + x]));
                count += 1;
            }
        }
    }
    (most, count)
}

fn agree(one: &[Rgb], other: &[Rgb], what: &str) {
    let (most, count) = difference(one, other);
    assert!(count > SIZE * SIZE / 2, "{what}: {count} pixels are away from edges");
    assert!(most <= 1e-4, "{what}: {most}");
}

#[test]
fn a_ground_of_any_size_and_shape_is_the_plane() {
    let plane = picture(&things(1.0, 0.0, PLANE));
    for (what, ground) in [
        ("sphere of 1e7", "[[sphere]]\ncenter = [0, -10000001, 0]\nradius = 1e7\n"),
        ("sphere of 1e8", "[[sphere]]\ncenter = [0, -100000001, 0]\nradius = 1e8\n"),
        ("box of 1e6", "[[box]]\nmin = [-1e6, -1e6, -1e6]\nmax = [1e6, -1, 1e6]\n"),
        ("disc of 1e8", "[[disc]]\ncenter = [0, -1, 0]\nnormal = [0, 1, 0]\nradius = 1e8\n"),
        ("mesh of 1e8", "[[mesh]]\nfile = \"ground.obj\"\n"),
        ("triangle", "[[triangle]]\npoints = [[-1e8, -1, 1e8], [1e8, -1, 1e8], [0, -1, -1e8]]\n"),
    ] {
        agree(&plane, &picture(&things(1.0, 0.0, ground)), what);
    }
}

#[test]
fn a_long_lens_from_far_away_sees_what_a_shorter_one_sees_from_nearer() {
    let seen = |distance: f64| {
        let fov = 2.0 * libm::atan(2.2 / distance).to_degrees();
        let text = things(1.0, 0.0, PLANE).replace(
            "eye = [0, 3, 8]",
            &format!("fov = {fov}\neye = [0, {}, {}]", 0.6 * distance, 0.8 * distance),
        );
        assert!(text.contains("fov"));
        picture(&text)
    };
    let near = seen(2000.0);
    for distance in [5e5, 1e7, 1e9] {
        // At 1e7 the view is the nearer one's up to its perspective, 1 in 2000 of 2 units.
        let (most, count) = difference(&near, &seen(distance));
        assert!(count > SIZE * SIZE / 2 && most < 2e-3, "{distance}: {most}");
    }
    agree(&seen(1e7), &seen(1e9), "1e7 and 1e9");
}

#[test]
fn sizes_from_1e_minus_12_to_1e12_and_places_far_off_draw_one_picture() {
    let usual = picture(&things(1.0, 0.0, ""));
    for exponent in [-40, -27, 27, 40] {
        let s = libm::exp2(f64::from(exponent));
        agree(&usual, &picture(&things(s, 0.0, "")), &format!("2^{exponent}"));
    }
    for x in [1e5, 16_777_216.0, 1e9] {
        agree(&usual, &picture(&things(1.0, x, "")), &format!("at {x}"));
    }
}

#[test]
fn what_strays_far_from_the_others_takes_no_detail_from_them() {
    let x = 4_649_776.0;
    let usual = picture(&things(1.0, x, ""));
    for stray in [
        "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n",
        "[[box]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n",
        "[[sphere]]\ncenter = [1e12, 0, 0]\nradius = 3\nscale = [1, 2, 1]\n",
    ] {
        agree(&usual, &picture(&things(1.0, x, stray)), stray);
    }
    // And is itself drawn as it should be.
    let there = things(1.0, 0.0, "[[sphere]]\ncenter = [4649776, 0, 0]\nradius = 1\n");
    agree(&picture(&things(1.0, 0.0, "")), &picture(&there), "seen from the stray one's side");
}
