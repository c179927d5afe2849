//! Images that MTL and glTF files bring along, and what they do to materials.

use std::collections::BTreeMap;

use phong_scene::{
    Channel, Fresnel, Limits, Material, Model, Reading, Rgb, Scene, TextureKind, Wrap,
};

use super::{read_with, scene, told};

/// The only material of an MTL file beside which lie `s.png`, a grey of 0.2, and `m.png`, black and white; and
/// what was told.
fn material_with_image(mtl: &str) -> (Material, Scene, String) {
    let obj = "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
    let grey = png([1, 1], &[51; 3]);
    let metal = png([2, 1], &[0, 0, 0, 255, 255, 255]);
    let files: [(&str, &[u8]); 4] =
        [("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes()), ("s.png", &grey), ("m.png", &metal)];
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

/// How wide facets are, and what they mirror at normal incidence.
fn facets(material: &Material) -> (Option<f32>, Option<Rgb>) {
    match material.model {
        Model::Microfacet { roughness, fresnel, .. } => match fresnel {
            Fresnel::Schlick { f0 } => (roughness.constant(), f0.constant()),
            _ => (roughness.constant(), None),
        },
        other => panic!("{other:?}"),
    }
}

#[test]
fn roughness_and_metal_of_the_physically_based_extension_are_those_of_gltf() {
    let red = Rgb::new(0.5, 0.25, 0.0);
    let read = |said: &str| {
        let mtl = format!("newmtl a\nKd 0.5 0.25 0\nKa 1 1 1\nKs 1 1 1\nNs 32\nillum 3\n{said}");
        let (material, _, told) = material_with_image(&mtl);
        assert_eq!(told, "", "{said}");
        assert_eq!((material.reflection, material.k_s), (Rgb::BLACK.into(), 1.0.into()));
        assert_eq!(material.ambient_color, Some(red.into()));
        (facets(&material), material.color, material.k_a.constant().expect("a number"))
    };
    let grey = |f0| (Some(0.25), Some(Rgb::grey(f0)));
    assert_eq!(read("Pr 0.5\nPm 0\nNi 1\nPc 0\nPcr 0.03\n"), (grey(0.04), red.into(), 0.1));
    assert_eq!(read("Pr 0.5\nNi 3\n"), (grey(0.25), red.into(), 0.1));
    let ((width, mirrored), color, k_a) = read("Pr 0.5\nPm 1\n");
    assert_eq!(((width, mirrored), color), ((Some(0.25), Some(red)), Rgb::BLACK.into()));
    assert!((k_a - 0.4).abs() < 1e-6, "{k_a}");
    // α² = 2/(32 + 2) without `Pr`.
    let ((width, _), ..) = read("Pm 1\n");
    assert!((width.expect("a number") - (2.0_f32 / 34.0).sqrt()).abs() < 1e-6, "{width:?}");
}

#[test]
fn zeros_of_the_physically_based_extension_say_nothing_and_the_rest_is_told() {
    let (plain, _, told) = material_with_image("newmtl a\nPr 0\nPm 0\nPs 0\nPc 0\naniso 0\n");
    assert_eq!((plain.model, told.as_str()), (Model::Lambert, ""));
    for word in ["Ps", "Pc", "aniso"] {
        let (_, _, told) = material_with_image(&format!("newmtl a\nPr 0.5\n{word} 0.5\n"));
        assert!(told.starts_with("a.mtl:3:1: warning: ") && told.contains(word), "{told}");
    }
    let (rough, _, told) = material_with_image("newmtl a\nPr 2\n");
    assert_eq!(facets(&rough).0, Some(1.0));
    assert!(told.contains("`Pr` must not be above 1: 2 is read as 1"), "{told}");
    let (_, _, told) = material_with_image("newmtl a\nPr 0.5\nKs 1 1 1\nmap_Ks s.png\n");
    assert!(told.contains("a.mtl:4:1: warning: `map_Ks` of `s.png` is not drawn beside"), "{told}");
}

#[test]
fn images_of_roughness_and_of_metal_take_the_place_of_both() {
    // α = 0.2², whatever `Pr` is.
    let (material, scene, told) = material_with_image("newmtl a\nPr 0.5\nmap_Pr s.png\n");
    let rough = pixels(&material, &scene)["roughness"][0][0];
    assert!((rough - 0.04).abs() < 1e-5, "{rough} {told}");
    let (material, scene, told) = material_with_image("newmtl a\nKd 0.5 0.5 0.5\nmap_Pm m.png\n");
    let images = pixels(&material, &scene);
    assert_eq!((facets(&material).1, told.as_str()), (None, ""));
    let reds = |key: &str| images[key].iter().map(|[r, ..]| *r).collect::<Vec<_>>();
    assert_eq!((reds("color"), reds("specular_color")), (vec![0.5, 0.0], vec![0.04, 0.5]));
    assert!((material.k_a.constant().expect("a number") - 0.25).abs() < 1e-6);
    // One that is everywhere the same is as good as a number, and a texture is multiplied.
    let (material, ..) = material_with_image("newmtl a\nmap_Kd m.png\nmap_Pm s.png\n");
    let by = material.color.texture().expect("an image");
    assert!((by.scale - 0.8).abs() < 1e-6 && material.k_s.constant() == Some(0.2 + 0.8 * 0.04));
}

#[test]
fn an_image_of_metal_that_lies_otherwise_than_that_of_colour_counts_by_its_mean() {
    for (options, is_told) in [("", false), ("-s 2 2 ", true), ("-mm 0 0.5 ", true)] {
        let mtl = format!("newmtl a\nmap_Kd {options}m.png\nmap_Pm m.png\n");
        let (material, _, told) = material_with_image(&mtl);
        assert_eq!(told.contains("a.mtl:3:1: warning: the image `m.png` lies"), is_told, "{told}");
        let by = material.color.texture().expect("an image");
        let want = match options {
            "" => 1.0,
            "-s 2 2 " => 0.5,
            _ => 0.25,
        };
        assert_eq!(by.scale, want, "{options}");
    }
}

#[test]
fn a_displacement_is_a_bump_unless_there_is_one() {
    for (beside, told) in [
        ("", "a.mtl:2:1: warning: `disp` of `s.png` is drawn as `bump`"),
        ("bump s.png\n", "a.mtl:2:1: warning: `disp` of `s.png` is not drawn beside `bump`"),
        ("norm s.png\n", "a.mtl:2:1: warning: `disp` of `s.png` is not drawn beside `norm`"),
    ] {
        let mtl = format!("newmtl a\ndisp -mm 0.5 2 s.png\n{beside}");
        let (material, _, all) = material_with_image(&mtl);
        assert!(all.starts_with(told), "{all}");
        assert_eq!(material.bump.is_some(), !beside.contains("norm"), "{mtl}");
        // Of the file's heights 1 is a hundredth of a unit.
        let scale = material.bump.map(|by| (by.scale, by.offset));
        assert!(!beside.is_empty() || scale == Some((0.02, 0.005)), "{scale:?}");
    }
}

#[test]
fn what_stands_for_an_image_that_mirrors_show_is_told() {
    let (_, _, told) = material_with_image("newmtl a\nrefl -type sphere s.png\ndecal s.png\n");
    assert!(told.contains("`[sky] kind = \"image\"`"), "{told}");
    assert!(told.contains("a.mtl:3:1: warning: `decal` of `s.png` is not drawn\n"), "{told}");
}

#[test]
fn bytes_of_images_are_those_of_each_once() {
    let (_, scene, _) = material_with_image("newmtl a\nmap_Kd s.png\nKs 1 1 1\nmap_Ks s.png\n");
    // Of a pixel three, and a third more for its halves.
    assert_eq!((scene.textures.len(), scene.image_bytes()), (2, 4));
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

#[test]
fn emission_is_drawn_by_its_colour_and_by_its_image() {
    let emission = |mtl: &str| {
        let (material, scene, told) = material_with_image(&format!("newmtl a\n{mtl}"));
        assert_eq!(told, "");
        let by = material.emission_color.map(|color| match color.texture() {
            Some(by) => match &scene.textures[by.texture.0 as usize].kind {
                TextureKind::Image { tint, .. } => (*tint, true),
                other => panic!("{other:?}"),
            },
            None => (color.constant().expect("a colour"), false),
        });
        (material.k_e.constant().expect("a number"), by)
    };
    let red = Rgb::new(2.0, 0.0, 0.0);
    assert_eq!(emission("Ke 2 0 0\n"), (1.0, Some((red, false))));
    assert_eq!(emission("Ke 2 0 0\nd 0.5\n"), (0.5, Some((red, false))));
    assert_eq!(emission("Ke 0 0 0\n"), (0.0, None));
    assert_eq!(emission("Ke 2 0 0\nmap_Ke s.png\n"), (1.0, Some((red, true))));
    assert_eq!(emission("Ke 0 0 0\nmap_Ke s.png\n"), (1.0, Some((Rgb::WHITE, true))));
}

#[test]
fn options_of_images_that_are_not_drawn_are_told_and_the_rest_is_drawn() {
    for (options, told) in [
        ("-s 0 0 0", "`-s 0 0` of the image `s.png` is not drawn"),
        ("-s 1e400", "`-s 1e400` of"),
        ("-mm 0 nan", "`-mm 0 nan` of"),
        ("-imfchan z", "`-imfchan z` of"),
        ("-imfchan l", ""),
        ("-s 2 2 0", ""),
    ] {
        let mtl = format!("newmtl a\nmap_d {options} s.png\n");
        let (material, scene, all) = material_with_image(&mtl);
        assert_eq!(all.contains("is not drawn"), !told.is_empty(), "{all}");
        assert!(all.contains(told), "{all}");
        assert_eq!(material.textured()[0].0, "opacity");
        let channel = material.textured()[0].1.channel;
        assert_eq!(channel, options.ends_with('l').then_some(Channel::Luminance), "{options}");
        let scale = scene.textures[0].transform.matrix3.x_axis.x;
        assert_eq!(scale, if options == "-s 2 2 0" { 0.5 } else { 1.0 }, "{options}");
    }
}

#[test]
fn an_image_of_ambient_colour_that_is_not_drawn_is_told() {
    for (ambient, diffuse, is_told) in [
        ("", "", true),
        ("Ka 1 1 1\n", "", true),
        ("Ka 1 1 1\n", "map_Kd -o 0.5 0 s.png\n", true),
        ("Ka 1 1 1\n", "map_Kd s.png\n", false),
        ("Ka 0.5 0.5 0.5\n", "", false),
    ] {
        let mtl = format!("newmtl a\n{ambient}{diffuse}map_Ka s.png\n");
        let (material, _, told) = material_with_image(&mtl);
        let is_drawn = material.textured().iter().any(|(key, _)| *key == "ambient_color");
        assert_eq!(is_drawn, ambient.contains("0.5"), "{mtl}");
        assert_eq!(
            told.contains("`map_Ka` of `s.png` is drawn only beside"),
            is_told,
            "{mtl}{told}"
        );
    }
}

/// A triangle as glTF of each of these materials, with its textures and images, beside `s.png`, a grey of 0.2,
/// `m.png`, which is `metal`, and `nothing.png`, which is not there.
fn gltf(materials: &[&str], metal: &[u8], limits: &Limits) -> Reading {
    let primitive = |i: usize| {
        format!(
            r#"{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2}}, "material": {i}}}"#
        )
    };
    let primitives: Vec<_> = (0..materials.len()).map(primitive).collect();
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{}]}}], "materials": [{}],
        "textures": [{{"source": 0}}, {{"source": 1}}, {{"source": 2}}, {{"source": 1, "sampler": 0}},
            {{"source": 3}}],
        "samplers": [{{"wrapS": 33071}}],
        "images": [{{"uri": "s.png"}}, {{"uri": "m.png"}}, {{"uri": "nothing.png"}}, {{"uri": "m.png"}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}},
            {{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}},
            {{"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 3, "type": "VEC2"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
        "buffers": [{{"byteLength": 36, "uri": "b.bin"}}]}}"#,
        primitives.join(", "),
        materials.join(", ")
    );
    let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let corners: Vec<u8> = corners.into_iter().flat_map(f32::to_le_bytes).collect();
    let grey = png([1, 1], &[51; 3]);
    let files: [(&str, &[u8]); 4] =
        [("a.gltf", text.as_bytes()), ("b.bin", &corners), ("s.png", &grey), ("m.png", metal)];
    read_with(&files, limits)
}

/// The material that a `pbrMetallicRoughness` and more gives, the pixels of its images by key, and what was told.
fn pbr(pbr: &str, more: &str) -> (Material, Pixels, String) {
    let material = format!(r#"{{"pbrMetallicRoughness": {{{pbr}}}{more}}}"#);
    // Metal by 0, and by 1.
    let metal = png([2, 1], &[0, 255, 0, 0, 255, 255]);
    let reading = gltf(&[&material], &metal, &Limits::default());
    let told = told(&reading);
    let scene = scene(reading);
    let material = scene.materials[scene.objects[0].material.0 as usize].clone();
    let images = pixels(&material, &scene);
    (material, images, told)
}

type Pixels = BTreeMap<&'static str, Vec<[f32; 4]>>;

/// The pixels in the first row of a material's images, by key.
fn pixels(material: &Material, scene: &Scene) -> Pixels {
    let image = |key: &str| {
        let textured = material.textured();
        let by = textured.into_iter().find(|(other, _)| *other == key)?.1;
        match &scene.textures[by.texture.0 as usize].kind {
            TextureKind::Image { texels, .. } => {
                Some((0..texels.size()[0]).map(|x| texels.get([x, 0], false)).collect())
            }
            other => panic!("{other:?}"),
        }
    };
    let keys = ["color", "specular_color", "roughness"];
    keys.into_iter().filter_map(|key| Some((key, image(key)?))).collect()
}

const METAL: &str = r#""metallicRoughnessTexture": {"index": 1}"#;

#[test]
fn what_is_no_metal_keeps_its_reflectance_beside_an_image_of_metal() {
    let ior = r#", "extensions": {"KHR_materials_ior": {"ior": 3}}"#;
    let f0 = |model: &Model| match model {
        Model::Microfacet { fresnel: Fresnel::Schlick { f0 }, .. } => {
            f0.constant().expect("one colour").r
        }
        other => panic!("{other:?}"),
    };
    let (even, ..) = pbr(&format!(r#""metallicFactor": 0, {METAL}"#), ior);
    assert!((f0(&even.model) - 0.25).abs() < 1e-6);
    let (_, images, told) = pbr(METAL, ior);
    let mirrored = &images["specular_color"];
    assert!((mirrored[0][0] - 0.25).abs() < 1e-6 && mirrored[1][0] == 1.0, "{mirrored:?} {told}");
}

#[test]
fn ambient_light_is_that_of_the_mean_share_of_metal() {
    for (factor, want) in [(0.0, 0.1), (0.5, 0.175), (1.0, 0.25)] {
        let (material, ..) = pbr(&format!(r#""metallicFactor": {factor}, {METAL}"#), "");
        let k_a = material.k_a.constant().expect("a number");
        assert!((k_a - want).abs() < 1e-6, "{factor}: {k_a}");
    }
}

#[test]
fn an_image_of_one_pixel_gives_its_colour_to_metal_and_to_the_rest() {
    let base = r#""baseColorTexture": {"index": 0}"#;
    let (_, images, told) = pbr(&format!("{base}, {METAL}"), "");
    // 51 is 0.0331 of linear light.
    let [color, mirrored] = ["color", "specular_color"].map(|key| &images[key]);
    assert!((color[0][0] - 0.0331).abs() < 1e-4 && color[1][0] == 0.0, "{color:?} {told}");
    assert!((mirrored[1][0] - 0.0331).abs() < 1e-4, "{mirrored:?}");
}

#[test]
fn images_of_colour_and_of_metal_that_lie_differently_are_told_and_both_drawn() {
    let base = r#""baseColorTexture": {"index": 4, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}}"#;
    let (material, images, told) = pbr(&format!("{base}, {METAL}"), "");
    assert!(told.contains("its images of colour and of metal lie differently"), "{told}");
    assert_eq!(images["color"].len(), 2);
    assert!((material.k_a.constant().expect("a number") - 0.25).abs() < 1e-6);
}

#[test]
fn coordinates_are_of_the_set_that_the_first_image_lies_in() {
    let base = |said: &str| {
        format!(r#""pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0{said}}}}}"#)
    };
    let occlusion = |set: u32| format!(r#""occlusionTexture": {{"index": 1, "texCoord": {set}}}"#);
    let other = r#", "texCoord": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}"#;
    let beside = "occlusionTexture: its set";
    let set_1 = r#", "texCoord": 1"#;
    for (material, set, told) in [
        (base(""), 0, ""),
        (base(set_1), 1, ""),
        (base(other), 1, ""),
        (base(set_1) + "," + &occlusion(1), 1, ""),
        (base(set_1) + "," + &occlusion(0), 1, "its set 0 is not that of"),
        (base("") + "," + &occlusion(1), 0, "its set 1 is not that of"),
        (occlusion(1), 1, ""),
    ] {
        let reading =
            gltf(&[&format!("{{{material}}}")], &png([1, 1], &[9; 3]), &Limits::default());
        let all = super::told(&reading);
        assert_eq!(all.contains(beside), !told.is_empty(), "{material}: {all}");
        assert!(all.contains(told), "{material}: {all}");
        // The first corner: (0, 0) in set 0 and (1, 0) in set 1, both turned over.
        assert_eq!(super::mesh(reading).uvs[0], [set as f32, 1.0].into(), "{material}");
    }
}

#[test]
fn a_gltf_colour_whose_image_is_not_there_is_grey() {
    let base = r#""metallicFactor": 0, "baseColorTexture": {"index": 2}"#;
    let (material, _, told) = pbr(base, "");
    assert!(told.contains("`baseColorTexture` is left out"), "{told}");
    assert_eq!(material.color, Rgb::grey(0.8).into());
    let red = format!(r#"{base}, "baseColorFactor": [1, 0, 0, 1]"#);
    assert_eq!(pbr(&red, "").0.color, Rgb::new(1.0, 0.0, 0.0).into());
}

#[test]
fn a_sampler_may_differ_between_axes() {
    let wraps = |index: u32| {
        let material = format!(
            r#"{{"pbrMetallicRoughness": {{"metallicRoughnessTexture": {{"index": {index}}}}}}}"#
        );
        let reading = gltf(&[&material], &png([1, 1], &[0, 255, 0]), &Limits::default());
        match scene(reading).textures[0].kind {
            TextureKind::Image { wrap, wrap_v, .. } => (wrap, wrap_v),
            ref other => panic!("{other:?}"),
        }
    };
    assert_eq!(wraps(3), (Wrap::Clamp, Some(Wrap::Repeat)));
    assert_eq!(wraps(1), (Wrap::Repeat, None));
}

/// Squares of metal and of none, 64 along each side: 12288 bytes.
fn squares() -> Vec<u8> {
    let blue = |i: u32| if (i + i / 64).is_multiple_of(2) { 255 } else { 0 };
    let values: Vec<u8> = (0..64 * 64).flat_map(|i| [0, 128, blue(i)]).collect();
    png([64, 64], &values)
}

#[test]
fn images_of_a_gltf_file_are_bounded_in_sum_and_made_once() {
    // Of each of two images roughness (2 bytes a pixel) and two colours (12 each) are made; halves of all of
    // them take a third more.
    let each = [3, 2, 12, 12].map(|bytes| 64 * 64 * bytes * 4 / 3).iter().sum::<u64>();
    let of = |image: &str| {
        format!(
            r#"{{"pbrMetallicRoughness": {{"metallicRoughnessTexture": {{"index": {image}}}}}}}"#
        )
    };
    let all = [of("1"), of("1"), of("4")];
    let all = [0, 1, 2].map(|i| all[i].as_str());
    let textures = |bytes| {
        let reading = gltf(&all, &squares(), &Limits { bytes, ..Limits::default() });
        let told = told(&reading);
        (scene(reading).textures.len(), told)
    };
    let (count, all_told) = textures(2 * each);
    assert_eq!(count, 9, "{all_told}");
    let (count, told) = textures(2 * each - 1);
    assert_eq!(count, 7);
    assert!(
        told.contains("everywhere as metallic as the mean: its pixels and halves take 65536"),
        "{told}"
    );
    let (count, told) = textures(each + 1000);
    assert_eq!(count, 6);
    assert!(
        told.contains("its pixels and halves take 16384 bytes, over the 1000 that are left"),
        "{told}"
    );
}

#[test]
fn images_of_an_mtl_file_and_of_a_scene_are_bounded_in_sum() {
    let image = squares();
    let limits = Limits { bytes: 20_000, ..Limits::default() };
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n\
               usemtl b\nf 1/1 2/1 3/1\nusemtl c\nf 1/1 2/1 3/1\n";
    let mtl = "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd a.png\nnewmtl c\nmap_Kd b.png\n";
    let toml = "version = 1\n[textures.a]\nkind = \"image\"\nfile = \"a.png\"\n\
                [textures.b]\nkind = \"image\"\nfile = \"a.png\"\n\
                [textures.c]\nkind = \"image\"\nfile = \"b.png\"\n";
    for (name, text) in [("a.obj", obj), ("a.toml", toml)] {
        let files = [
            (name, text.as_bytes()),
            ("a.mtl", mtl.as_bytes()),
            ("a.png", &image),
            ("b.png", &image),
        ];
        let told = told(&read_with(&files, &limits));
        assert_eq!(told.matches("cannot be read").count(), 1, "{name}: {told}");
        assert!(told.contains("take 16384 bytes, over the 3616 that are left"), "{name}: {told}");
    }
}

#[test]
fn images_of_a_scene_and_of_its_models_are_bounded_in_sum() {
    let image = squares();
    let limits = Limits { bytes: 20_000, ..Limits::default() };
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
    let own = "[textures.c]\nkind = \"image\"\nfile = \"b.png\"\n";
    let model = "[[mesh]]\nfile = \"a.obj\"\n";
    for (first, second) in [(own, model), (model, own)] {
        let text = format!("version = 1\n{first}{second}");
        let files = [
            ("a.toml", text.as_bytes()),
            ("a.obj", obj.as_bytes()),
            ("a.mtl", b"newmtl a\nmap_Kd a.png\n"),
            ("a.png", &image),
            ("b.png", &image),
        ];
        let told = told(&read_with(&files, &limits));
        assert_eq!(told.matches("cannot be read").count(), 1, "{text}: {told}");
        assert!(told.contains("bytes, over the 3616 that are left"), "{text}: {told}");
    }
}
