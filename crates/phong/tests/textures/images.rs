//! Images as textures: read from files, drawn on surfaces, and told.

use phong::explain::{End, explain};
use phong::film::{LayerKind, Window};
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Limits, Memory, Reading, Scene, read};

/// A PNG of 8 bits.
pub(super) fn png(size: [u32; 2], color: png::ColorType, values: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(color);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(values).unwrap();
    writer.finish().unwrap();
    bytes
}

/// Squares of two colours, `count` along each side, one pixel each.
fn squares(count: u32) -> Vec<u8> {
    let light = |i: u32| (i + i / count).is_multiple_of(2);
    let values: Vec<u8> = (0..count * count).map(|i| if light(i) { 255 } else { 0 }).collect();
    png([count; 2], png::ColorType::Grayscale, &values)
}

fn reading(text: &str, files: Memory) -> Reading {
    let files = files.with("a.toml", text.as_bytes());
    read("a.toml", None, &files, &Limits::default())
}

fn scene(text: &str, files: Memory) -> Scene {
    let reading = reading(text, files);
    assert!(reading.diagnostics.is_empty(), "{:#?}", reading.diagnostics);
    reading.scene.unwrap()
}

const SHEET: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                     f 1/1 2/2 3/3 4/4\n";

/// A sheet, a ball that is a mirror and a floor to the horizon, all of squares.
fn squares_everywhere(samples: u32) -> Scene {
    let text = format!(
        "version = 1\n[image]\nsize = [40, 24]\nsamples = {samples}\n\
         [camera]\neye = [0, 1, 6]\nlook_at = [0, 0.6, 0]\nfov = 40\n\
         [[light]]\nkind = \"distant\"\ndirection = [1, -2, -1]\n\
         [textures.squares]\nkind = \"image\"\nfile = \"squares.png\"\nscale = 2\n\
         [textures.fine]\nkind = \"image\"\nfile = \"squares.png\"\n\
         [materials.floor]\ncolor = {{ texture = \"squares\" }}\n\
         [materials.sheet]\ncolor = {{ texture = \"fine\" }}\nk_s = {{ texture = \"fine\" }}\n\
         [materials.mirror]\ncolor = 0.1\nreflection = 0.8\n\
         [[mesh]]\nfile = \"sheet.obj\"\nmaterial = \"sheet\"\nrotate = [0, 1, 0, 60]\n\
         translate = [-1.5, 1, 0]\n\
         [[sphere]]\ncenter = [1, 1, 0]\nradius = 1\nmaterial = \"mirror\"\n\
         [[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"floor\"\n"
    );
    let files = Memory::new().with("squares.png", squares(8)).with("sheet.obj", SHEET.as_bytes());
    scene(&text, files)
}

#[test]
fn what_is_explained_of_images_is_what_is_drawn_in_the_whole_and_in_a_crop() {
    let scene = squares_everywhere(3);
    let view = View::of(&scene).unwrap();
    let options = RenderOptions::of(&scene.image).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    let crop = Window { x0: 5, y0: 3, x1: 33, y1: 20 };
    let other = options.clone().with_window(crop).unwrap().with_tile(8).unwrap();
    let part = render(&view, &other, &|_| {}, &Cancel::new()).film;
    let mut levels = 0;
    for (x, y) in (3..20).flat_map(|y| (5..33).map(move |x| (x, y))) {
        let at = film.at(LayerKind::Picture, x, y).unwrap();
        assert_eq!(part.at(LayerKind::Picture, x, y).unwrap(), at, "{x} {y}");
        let told = explain(&view, &options, [x, y]).unwrap();
        assert_eq!(told.linear.to_array(), at, "{x} {y}");
        for sample in &told.samples {
            let Some(End::Surface(s)) = sample.ray.as_ref().map(|ray| &ray.end) else { continue };
            for texture in &s.textures {
                levels += u32::from(texture.image.unwrap().level > 0.0);
            }
        }
    }
    assert!(levels > 40, "{levels} looked up halves of the image");
}

#[test]
fn a_chequered_floor_at_one_sample_is_near_what_many_samples_make_of_it() {
    let picture = |samples| {
        let scene = squares_everywhere(samples);
        let view = View::of(&scene).unwrap();
        let options = RenderOptions::of(&scene.image).unwrap();
        let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
        film.layer(LayerKind::Picture).unwrap().values.to_vec()
    };
    let [one, many] = [1, 64].map(picture);
    // Of the lower half, where the floor is, all but what lies near the edges of other things.
    let far = |from: usize, to: usize| {
        let rows = from * 40 * 3..to * 40 * 3;
        let mut off: Vec<f32> =
            one[rows.clone()].iter().zip(&many[rows]).map(|(a, b)| (a - b).abs()).collect();
        off.sort_by(f32::total_cmp);
        off[off.len() * 9 / 10]
    };
    assert!(far(8, 24) < 0.12, "nine in ten are within 0.12: {}", far(8, 24));
}

#[test]
fn two_materials_share_the_pixels_of_one_file() {
    let scene = squares_everywhere(1);
    let texels = |i: usize| match &scene.textures[i].kind {
        phong_scene::TextureKind::Image { texels, .. } => texels,
        other => panic!("{other:?}"),
    };
    assert!(std::sync::Arc::ptr_eq(texels(0), texels(1)));
}
