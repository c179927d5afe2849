//! Images that MTL files bring along, and what they do to materials.

use phong_scene::{Limits, Material, Rgb, Scene};

use super::{read_with, scene, told};

/// The only material of an MTL file beside which lies `s.png`, a grey of 0.2, and what was told.
fn material_with_image(mtl: &str) -> (Material, Scene, String) {
    let obj = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
    let image = png([1, 1], &[51; 3]);
    let files: [(&str, &[u8]); 3] =
        [("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes()), ("s.png", &image)];
    let reading = read_with(&files, &Limits::default());
    let told = told(&reading);
    let scene = scene(reading);
    (scene.materials[1].clone(), scene, told)
}

/// A PNG of three bytes a pixel.
fn png(size: [u32; 2], values: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("memory");
    writer.write_image_data(values).expect("memory");
    writer.finish().expect("memory");
    bytes
}

#[test]
fn an_image_of_the_highlight_is_that_of_the_mirror() {
    for (illum, through) in [(3, 0.0), (7, 1.0)] {
        let mtl = format!("newmtl a\nKs 0 0 0\nmap_Ks s.png\nillum {illum}\n");
        let (material, _, told) = material_with_image(&mtl);
        let keys: Vec<_> = material.textured().into_iter().map(|(key, _)| key).collect();
        assert!(keys.contains(&"reflection"), "{keys:?} {told}");
        assert_eq!(material.transmission, Rgb::grey(through).into());
    }
    let (material, ..) = material_with_image("newmtl a\nKs 0 0 0\nmap_Ks s.png\nillum 2\n");
    assert_eq!(material.reflection, Rgb::BLACK.into());
}

#[test]
fn an_image_of_opacity_is_multiplied_with_tr_as_with_d() {
    for (said, scale) in
        [("Tr 0.5", 0.5), ("d 0.25", 0.25), ("d 0.25\nTr 0.5", 0.25), ("Tr 1", 1.0), ("", 1.0)]
    {
        let (material, _, told) = material_with_image(&format!("newmtl a\n{said}\nmap_d s.png\n"));
        let textured = material.textured();
        let by = textured.iter().find(|(key, _)| *key == "opacity").expect("an image");
        assert_eq!(by.1.scale, scale, "{said}");
        assert_eq!(told.contains("disagree"), said.contains('\n'), "{told}");
        assert_eq!(told.contains("it is read as opaque"), said == "Tr 1", "{told}");
    }
}
