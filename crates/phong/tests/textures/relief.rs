//! A map of normals against a mesh that really has them.

use std::fmt::Write as _;

use phong::film::LayerKind;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Limits, Memory, read};

use super::images::png;

/// A height over the square from −1 to 1, and its slopes along x and y: two studs and a dent, so that no side is
/// like another.
fn relief(x: f64, y: f64) -> [f64; 3] {
    let studs = [(-0.35, 0.3, 0.5, 0.16), (0.45, -0.35, 0.42, 0.12), (0.4, 0.5, 0.35, -0.09)];
    let mut sum = [0.0; 3];
    for (at_x, at_y, radius, height) in studs {
        let (dx, dy) = ((x - at_x) / radius, (y - at_y) / radius);
        let rest = (1.0 - dx * dx - dy * dy).max(0.0);
        sum[0] += height * rest * rest;
        sum[1] -= 4.0 * height * rest * dx / radius;
        sum[2] -= 4.0 * height * rest * dy / radius;
    }
    sum
}

/// The normals of the relief as a PNG, and its surface as a mesh that has no normals but those of its faces.
fn files() -> Memory {
    const TEXELS: u32 = 64;
    const SQUARES: u32 = 48;
    let place = |i: u32, of: u32| 2.0 * f64::from(i) / f64::from(of) - 1.0;
    let mut levels = Vec::new();
    for row in 0..TEXELS {
        for column in 0..TEXELS {
            let half = 1.0 / f64::from(TEXELS);
            let (x, y) = (place(column, TEXELS) + half, -place(row, TEXELS) - half);
            let [_, along_x, along_y] = relief(x, y);
            let length = (along_x * along_x + along_y * along_y + 1.0).sqrt();
            let normal = [-along_x / length, -along_y / length, 1.0 / length];
            levels.extend(normal.map(|v| ((0.5 + 0.5 * v) * 255.0).round() as u8));
        }
    }
    let mut obj = String::new();
    for row in 0..=SQUARES {
        for column in 0..=SQUARES {
            let (x, y) = (place(column, SQUARES), place(row, SQUARES));
            let _ = writeln!(obj, "v {x} {y} {}", relief(x, y)[0]);
        }
    }
    for row in 0..SQUARES {
        for column in 0..SQUARES {
            let a = 1 + row * (SQUARES + 1) + column;
            let b = a + SQUARES + 1;
            let _ = writeln!(obj, "f {a} {} {} {b}", a + 1, b + 1);
        }
    }
    let sheet = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    Memory::new()
        .with("normals.png", png([TEXELS; 2], png::ColorType::Rgb, &levels))
        .with("raised.obj", obj.into_bytes())
        .with("sheet.obj", sheet.as_bytes())
}

/// The picture of a mesh, looked straight down at, under light that comes from one side.
fn lit(files: &Memory, file: &str, material: &str, [x, y]: [i32; 2]) -> Vec<f32> {
    let text = format!(
        "version = 1\n[image]\nsize = [32, 32]\nsamples = 1\n\
         [camera]\nkind = \"orthographic\"\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nheight = 1.9\n\
         [[light]]\nkind = \"distant\"\ndirection = [{}, {}, -1.5]\nshadows = false\n\
         [textures.map]\nkind = \"image\"\nfile = \"normals.png\"\nencoding = \"linear\"\n\
         [materials.m]\ncolor = 0.8\nk_a = 0.1\nk_d = 0.7\nk_s = 0.3\nshininess = 8\n{material}\n\
         [[mesh]]\nfile = \"{file}\"\nmaterial = \"m\"\n",
        -x, -y
    );
    let files = files.clone().with("a.toml", text.into_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    let scene = reading.scene.unwrap_or_else(|| panic!("{:#?}", reading.diagnostics));
    let options = RenderOptions::of(&scene.image).unwrap();
    let film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
    film.layer(LayerKind::Picture).unwrap().values.iter().copied().step_by(3).collect()
}

/// The largest and the mean difference.
fn apart(a: &[f32], b: &[f32]) -> [f32; 2] {
    let each = || a.iter().zip(b).map(|(a, b)| (a - b).abs());
    [each().fold(0.0, f32::max), each().sum::<f32>() / a.len() as f32]
}

#[test]
fn a_map_of_normals_is_lit_from_each_side_as_the_mesh_that_has_them() {
    let files = files();
    let map = "normal = { texture = \"map\" }";
    let directx = "normal = { texture = \"map\" }\nnormal_format = \"directx\"";
    for side in [[1, 0], [0, 1], [-1, 0], [0, -1]] {
        let raised = lit(&files, "raised.obj", "", side);
        let [largest, mean] = apart(&raised, &lit(&files, "sheet.obj", map, side));
        assert!(largest < 0.04 && mean < 0.005, "{side:?}: {largest}, {mean} in the mean");
        // A flat sheet, and one with the green channel upside down, are told from it.
        let [largest, mean] = apart(&raised, &lit(&files, "sheet.obj", "", side));
        assert!(largest > 0.2 && mean > 0.02, "flat, {side:?}: {largest}, {mean} in the mean");
        if side[1] != 0 {
            let [largest, mean] = apart(&raised, &lit(&files, "sheet.obj", directx, side));
            assert!(largest > 0.2 && mean > 0.02, "down, {side:?}: {largest}, {mean} in the mean");
        }
    }
}
