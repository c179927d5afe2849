//! Parameters by a texture of two values: of either the very bits of the material that has it everywhere.

use phong::explain::{End, explain};
use phong::film::LayerKind;
use phong_scene::{Limits, Memory, Scene, read};

use super::{drawn, picture};

const HEAD: &str = "version = 1\n[image]\nsize = [24, 16]\nsamples = 1\n\
    background = { top = 0.9, bottom = [0.1, 0.2, 0.6] }\n[camera]\neye = [0, 1, 6]\n\
    look_at = [0, 0, 0]\nfov = 40\n[[light]]\nkind = \"point\"\nposition = [2, 3, 4]\n";

fn scene(text: &str) -> Scene {
    let files = Memory::new().with("a.toml", format!("{HEAD}{text}").into_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

#[test]
fn where_a_texture_has_a_value_a_surface_has_the_bits_of_that_value() {
    let [gold, other] = [[0.143, 0.375, 1.442], [1.5, 0.9, 0.4]];
    let k = [[3.983, 2.386, 1.603], [0.5, 1.0, 2.0]];
    let glass = "reflection = 1\ntransmission = 0.8\n";
    for (model, more, key, values) in [
        ("ggx", "k_s = 0.8\n", "f0", [[0.9, 0.6, 0.2], [0.04; 3]]),
        ("cook-torrance", "k_s = 0.8\n", "f0", [[0.5; 3], [1.0; 3]]),
        ("ggx", "k_s = 0.8\n", "eta", [[1.25; 3], [2.5; 3]]),
        ("ggx", "k = [3.983, 2.386, 1.603]\n", "eta", [gold, other]),
        ("ggx", "eta = [0.143, 0.375, 1.442]\n", "k", k),
        ("oren-nayar", "", "sigma", [[5.0; 3], [40.0; 3]]),
        ("oren-nayar", "form = \"full\"\n", "sigma", [[0.0; 3], [90.0; 3]]),
        ("phong", glass, "ior", [[1.25; 3], [0.75; 3]]),
    ] {
        let of = |value: &str| {
            let [a, b] = values;
            scene(&format!(
                "[textures.t]\nkind = \"checker\"\ncolors = [{a:?}, {b:?}]\n[materials.m]\n\
                 model = \"{model}\"\n{more}{key} = {value}\n[[plane]]\n\
                 point = [0, 0, 0]\nnormal = [0, 0.1, 1]\nmaterial = \"m\"\n"
            ))
        };
        let number = |[r, g, b]: [f32; 3]| {
            if [g, b] == [r; 2] { r.to_string() } else { format!("[{r}, {g}, {b}]") }
        };
        let even = values.map(|value| drawn(&of(&number(value)), &[]).2);
        let (view, options, film) = drawn(&of("{ texture = \"t\" }"), &[]);
        let mut counts = [0; 2];
        for (x, y) in (0..16).flat_map(|y| (0..24).map(move |x| (x, y))) {
            let told = explain(&view, &options, [x, y]).unwrap();
            let got = film.at(LayerKind::Picture, x, y).unwrap();
            assert_eq!(told.linear.to_array()[..], *got, "{model} {key}: {x} {y}");
            let Some(End::Surface(s)) = told.samples[0].ray.as_ref().map(|ray| &ray.end) else {
                continue;
            };
            let value = s.textures.iter().find(|told| told.parameter == key).unwrap().value;
            let which = usize::from(value.r == values[1][0]);
            assert_eq!(value.r, values[which][0]);
            assert_eq!(got, even[which].at(LayerKind::Picture, x, y).unwrap(), "{model} {key}");
            counts[which] += 1;
        }
        assert!(counts[0] > 50 && counts[1] > 50, "{model} {key}: {counts:?}");
        assert_ne!(picture(&of(&number(values[0]))), picture(&of(&number(values[1]))), "{key}");
    }
}

#[test]
fn glass_bends_light_alike_whether_a_texture_says_its_index_or_not_also_within_other_glass() {
    let glass = |name: &str, ior: &str| {
        format!(
            "[materials.{name}]\ncolor = 0\nk_s = 0\nreflection = 1\ntransmission = 1\n\
             priority = 1\nior = {ior}\n"
        )
    };
    let around = "[materials.around]\ncolor = 0\nk_s = 0\nreflection = 1\ntransmission = 0.9\n\
                  ior = 1.25\n[[box]]\nmin = [-3, -2, -2]\nmax = [3, 2, 2]\nmaterial = \"around\"\n";
    let halves = "[textures.t]\nkind = \"checker\"\ncolors = [1.5, 1.75]\nspace = \"world\"\n\
                  scale = 0.25\ntranslate = [0, -2, -2]\n";
    for around in ["", around] {
        let of = |[left, right]: [&str; 2]| {
            let balls = "[[sphere]]\ncenter = [-1.5, 0, 0]\nradius = 1.2\nmaterial = \"left\"\n\
                         [[sphere]]\ncenter = [1.5, 0, 0]\nradius = 1.2\nmaterial = \"right\"\n";
            let glasses = [glass("left", left), glass("right", right)].concat();
            picture(&scene(&format!("{halves}{glasses}{around}{balls}")))
        };
        let textured = of(["{ texture = \"t\" }"; 2]);
        assert_eq!(textured, of(["1.75", "1.5"]));
        assert_ne!(textured, of(["1.5", "1.75"]));
    }
}
