//! Images as textures: read from files, drawn on surfaces, and told.

use phong::explain::{End, explain};
use phong::film::{LayerKind, Window};
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Limits, Memory, Reading, Scene, read};

use super::vertices::{bare, replaced};

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
fn a_curved_mirror_or_glass_spreads_what_one_sample_sees_of_a_chequered_floor() {
    let [mirror, glass] =
        ["reflection = 1", "transmission = 1\nfresnel = false"].map(off_in_a_ball);
    assert!(mirror < 0.04, "off by {mirror}");
    assert!(glass < 0.037, "off by {glass}");
}

/// How far one sample a pixel is from many, as the root of the mean square, where a ball of this material is before
/// and above a chequered floor.
fn off_in_a_ball(material: &str) -> f32 {
    let picture = |samples| {
        let text = format!(
            "version = 1\n[image]\nsize = [32, 32]\nsamples = {samples}\n\
             [camera]\neye = [0, 1, 3]\nlook_at = [0, 0.8, 0]\nfov = 26\n\
             [[light]]\nkind = \"distant\"\ndirection = [1, -3, -1]\n\
             [textures.squares]\nkind = \"image\"\nfile = \"squares.png\"\n\
             space = \"object\"\nscale = 0.5\nrotate = [1, 0, 0, -90]\n\
             [materials.floor]\ncolor = {{ texture = \"squares\" }}\nk_s = 0\n\
             [materials.ball]\ncolor = 0\nk_s = 0\n{material}\n\
             [[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"floor\"\n\
             [[sphere]]\ncenter = [0, 0.9, 0]\nradius = 0.7\nmaterial = \"ball\"\n"
        );
        let scene = scene(&text, Memory::new().with("squares.png", squares(8)));
        let view = View::of(&scene).unwrap();
        let options = RenderOptions::of(&scene.image).unwrap();
        let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
        film.layer(LayerKind::Picture).unwrap().values.to_vec()
    };
    let [one, many] = [1, 64].map(picture);
    let square: f32 = one.iter().zip(&many).map(|(a, b)| (a - b) * (a - b)).sum();
    (square / one.len() as f32).sqrt()
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

/// The shading normal in the middle of a sheet that is looked at along −z, of this material and placed so.
fn normal_of(material: &str, place: &str, shape: &str) -> [f32; 3] {
    // Red 0.71, green 0.4 and blue 0.71 of −1 to 1.
    let lean = png([1, 1], png::ColorType::Rgb, &[218, 178, 218]);
    let ramp: Vec<u8> = (0..64 * 64).map(|i| (i % 64 * 4) as u8).collect();
    let ramp = png([64, 64], png::ColorType::Grayscale, &ramp);
    let text = format!(
        "version = 1\n[image]\nsize = [1, 1]\nsamples = 1\n\
         [camera]\nkind = \"orthographic\"\nheight = 0.01\neye = [0.1, 0.1, 5]\n\
         look_at = [0.1, 0.1, 0]\n[[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\n\
         [textures.lean]\nkind = \"image\"\nfile = \"lean.png\"\n\
         [textures.ramp]\nkind = \"image\"\nfile = \"ramp.png\"\n\
         [textures.other]\nkind = \"image\"\nfile = \"lean.png\"\n\
         [materials.m]\ncolor = {{ texture = \"other\" }}\nk_s = {{ texture = \"ramp\" }}\n\
         ambient_color = {{ texture = \"lean\" }}\n{material}\n[[{shape}]]\n{place}\n\
         material = \"m\"\n"
    );
    let files = Memory::new()
        .with("lean.png", lean)
        .with("ramp.png", ramp)
        .with("sheet.obj", SHEET.as_bytes());
    let scene = scene(&text, files);
    let view = View::of(&scene).unwrap();
    let told = explain(&view, &RenderOptions::of(&scene.image).unwrap(), [0, 0]).unwrap();
    let Some(End::Surface(s)) = told.samples[0].ray.as_ref().map(|ray| &ray.end) else {
        panic!("nothing is met")
    };
    s.n.to_array()
}

fn assert_near(got: [f32; 3], want: [f32; 3], what: &str) {
    let length = want.iter().map(|x| x * x).sum::<f32>().sqrt();
    let off = got.iter().zip(want).map(|(got, want)| (got - want / length).abs());
    assert!(off.fold(0.0, f32::max) < 0.01, "{what}: {got:?}, not along {want:?}");
}

#[test]
fn a_map_of_normals_turns_them_along_u_and_v_whatever_the_mesh_is_turned_or_mirrored_to() {
    let map = "normal = { texture = \"lean\" }";
    let (x, y, z) = (0.71, 0.396, 0.71);
    let mesh = |place: &str| normal_of(map, &format!("file = \"sheet.obj\"\n{place}"), "mesh");
    assert_near(mesh(""), [x, y, z], "as it is");
    assert_near(mesh("rotate = [0, 0, 1, 90]"), [-y, x, z], "turned");
    assert_near(mesh("scale = [-1, 1, 1]"), [-x, y, z], "mirrored");
    // From behind the sheet leans the same way, and its normal is turned to the eye.
    assert_near(mesh("rotate = [0, 1, 0, 180]"), [x, -y, z], "from behind");
    let directx = format!("{map}\nnormal_format = \"directx\"");
    assert_near(normal_of(&directx, "file = \"sheet.obj\"", "mesh"), [x, -y, z], "green down");
    let half = "normal = { texture = \"lean\", scale = 0.5 }";
    assert_near(normal_of(half, "file = \"sheet.obj\"", "mesh"), [x / 2.0, y / 2.0, z], "half");
    let plane = "point = [0, 0, 0]\nnormal = [0, 0, 1]";
    assert_near(normal_of(map, plane, "plane"), [x, y, z], "a plane");
}

#[test]
fn heights_turn_normals_as_if_the_surface_were_raised() {
    // Over a unit of u, which is 2 of the sheet, the ramp rises by 252/255.
    let map = "bump = { texture = \"ramp\", scale = 0.5 }";
    let slope = 0.5 * 252.0 / 255.0 / 2.0 * (64.0 / 63.0);
    let place = "file = \"sheet.obj\"";
    assert_near(normal_of(map, place, "mesh"), [-slope, 0.0, 1.0], "as it is");
    let large = "file = \"sheet.obj\"\nscale = 3";
    assert_near(normal_of(map, large, "mesh"), [-slope, 0.0, 1.0], "heights grow with the object");
}

#[test]
fn a_mask_is_all_or_nothing() {
    let spots = png([2, 1], png::ColorType::GrayscaleAlpha, &[255, 51, 255, 204]);
    let text = "version = 1\n[image]\nsize = [8, 1]\nsamples = 1\nbackground = [0, 0, 1]\n\
                [camera]\nkind = \"orthographic\"\nheight = 0.25\neye = [0, 0, 5]\n\
                look_at = [0, 0, 0]\n[[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\n\
                [textures.spots]\nkind = \"image\"\nfile = \"spots.png\"\n\
                [materials.m]\ncolor = [1, 0, 0]\nk_s = 0\nopacity_mode = \"mask\"\ncutoff = 0.3\n\
                opacity = { texture = \"spots\", channel = \"a\" }\n\
                [[mesh]]\nfile = \"sheet.obj\"\nmaterial = \"m\"\n";
    let files = Memory::new().with("spots.png", spots).with("sheet.obj", SHEET.as_bytes());
    let scene = scene(text, files);
    let view = View::of(&scene).unwrap();
    let options = RenderOptions::of(&scene.image).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    let mut seen = [0, 0];
    for x in 0..8 {
        let [r, _, b] = film.at(LayerKind::Picture, x, 0).unwrap() else { panic!("a colour") };
        assert!((*r > 0.5) != (*b > 0.5), "pixel {x}: {r} {b}");
        seen[usize::from(*r > 0.5)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 1), "{seen:?}");
}

#[test]
fn an_obj_file_brings_its_images_along() {
    let mtl = "newmtl wood\nKd 1 0.5 0.25\nmap_Kd -s 0.5 0.5 ..\\far\\squares.png\nmap_d squares.png\n\
               norm missing.png\n";
    let sheet = SHEET.replacen("v -1 -1 0\n", "v -1 -1 0 0 0 1\n", 1);
    let obj = format!("mtllib a.mtl\nusemtl wood\n{sheet}");
    let text = "version = 1\n[image]\nsize = [16, 16]\nsamples = 1\nbackground = 0\n[camera]\neye = [0, 0, 6]\n\
                look_at = [0, 0, 0]\nfov = 20\n[[light]]\nkind = \"distant\"\n\
                direction = [0, 0, -1]\n[[mesh]]\nfile = \"m/a.obj\"\n";
    let files = Memory::new()
        .with("m/a.obj", obj.into_bytes())
        .with("m/a.mtl", mtl.as_bytes())
        .with("m/squares.png", squares(8));
    let reading = reading(text, files);
    let told: Vec<_> = reading.diagnostics.iter().map(|told| told.message.as_str()).collect();
    assert!(told.contains(&"the image `missing.png` cannot be read: there is no such file"));
    assert!(told.contains(&"colours of vertices are not drawn where there is a texture"));
    let scene = reading.scene.unwrap();
    assert_eq!(scene.textures.len(), 2);
    let view = View::of(&scene).unwrap();
    let options = RenderOptions::of(&scene.image).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    let picture = &film.layer(LayerKind::Picture).unwrap().values;
    let (mut some, mut none) = (0, 0);
    for pixel in picture.chunks_exact(3) {
        if pixel[0] > 0.3 {
            some += 1;
            assert!(pixel[1] < 0.7 * pixel[0] && pixel[2] < 0.5 * pixel[0], "{pixel:?}");
        }
        none += u32::from(pixel[0] < 0.05);
    }
    assert!(some > 20 && none > 3, "{some} {none}");
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let letters = bytes.chunks(3).flat_map(|three| {
        let bits = three.iter().fold(0_u32, |bits, byte| bits << 8 | u32::from(*byte));
        let bits = bits << (8 * (3 - three.len()));
        (0..=three.len()).map(move |i| LETTERS[(bits >> (18 - 6 * i)) as usize & 63])
    });
    letters.map(char::from).collect()
}

/// A sheet of a square as glTF, of this material; images are those of `squares.png`, of the first view and of
/// a text.
fn gltf(material: &str) -> Scene {
    gltf_of(material, "")
}

/// [`gltf`] with more attributes of its vertices: accessor 3 has colours.
fn gltf_of(material: &str, attributes: &str) -> Scene {
    let image = png(
        [2, 2],
        png::ColorType::Rgba,
        &[255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0],
    );
    let mut buffer: Vec<u8> = [-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0]
        .into_iter()
        // From the upper left corner of the image, as the format has it.
        .chain([0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
        .flat_map(f32::to_le_bytes)
        .collect();
    buffer.extend([0, 1, 2, 0, 2, 3].into_iter().flat_map(u16::to_le_bytes));
    let images = buffer.len();
    buffer.extend(&image);
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let colors = buffer.len();
    let rainbow: [f32; 12] = [1.0, 0.2, 0.3, 0.1, 0.9, 0.3, 0.7, 0.7, 0.1, 0.2, 0.1, 1.0];
    buffer.extend(rainbow.into_iter().flat_map(f32::to_le_bytes));
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1 {attributes}}},
            "indices": 2, "material": 0}}]}}],
        "materials": [{{{material}}}],
        "textures": [{{"source": 0}}, {{"source": 1, "sampler": 0}}, {{"source": 2}}, {{"source": 3}}],
        "samplers": [{{"magFilter": 9728, "wrapS": 33071, "wrapT": 33071}}],
        "images": [{{"uri": "squares.png"}}, {{"bufferView": 3, "mimeType": "image/png"}},
            {{"uri": "data:image/png;base64,{}"}}, {{"uri": "nowhere.png"}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}},
            {{"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}},
            {{"bufferView": 4, "componentType": 5126, "count": 4, "type": "VEC3"}}],
        "bufferViews": [
            {{"buffer": 0, "byteOffset": 0, "byteLength": 48}},
            {{"buffer": 0, "byteOffset": 48, "byteLength": 32}},
            {{"buffer": 0, "byteOffset": 80, "byteLength": 12}},
            {{"buffer": 0, "byteOffset": {images}, "byteLength": {}}},
            {{"buffer": 0, "byteOffset": {colors}, "byteLength": 48}}],
        "buffers": [{{"byteLength": {}, "uri": "data:application/octet-stream;base64,{}"}}]}}"#,
        base64(&image),
        image.len(),
        buffer.len(),
        base64(&buffer)
    );
    let scene = "version = 1\n[image]\nsize = [4, 4]\nsamples = 1\nbackground = 0\n\
                 [camera]\nkind = \"orthographic\"\nheight = 2\neye = [0, 0, 5]\n\
                 look_at = [0, 0, 0]\n[[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\n\
                 [[mesh]]\nfile = \"a.gltf\"\n";
    let files = Memory::new().with("a.gltf", text.into_bytes()).with("squares.png", squares(8));
    let reading = reading(scene, files);
    let told: Vec<_> = reading.diagnostics.iter().map(|told| told.message.as_str()).collect();
    let lost = material.contains("\"index\": 3");
    assert_eq!(told.len(), usize::from(lost), "{told:?}");
    reading.scene.unwrap_or_else(|| panic!("{told:?}"))
}

/// What four by four pixels of it show.
fn shown(scene: &Scene) -> Vec<[f32; 3]> {
    let view = View::of(scene).unwrap();
    let options = RenderOptions::of(&scene.image).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    let picture = &film.layer(LayerKind::Picture).unwrap().values;
    picture.as_chunks::<3>().0.to_vec()
}

#[test]
fn a_gltf_file_brings_its_images_along_the_right_way_up() {
    let corners = |scene: &Scene| {
        let pixels = shown(scene);
        // Of a smooth image the others of the four shine in.
        let most = |pixel: [f32; 3]| pixel.into_iter().fold(0.0, f32::max);
        [0, 3, 12, 15].map(|i| pixels[i].map(|v| v > 0.1 && v > 0.6 * most(pixels[i])))
    };
    let [red, green, blue, white] =
        [[true, false, false], [false, true, false], [false, false, true], [true; 3]];
    for index in [1, 2] {
        let material = format!(
            "\"pbrMetallicRoughness\": {{\"baseColorTexture\": {{\"index\": {index}}}, \
             \"metallicFactor\": 0}}"
        );
        let want = [red, green, blue, white];
        assert_eq!(corners(&gltf(&material)), want, "texture {index}");
        let masked = format!("{material}, \"alphaMode\": \"MASK\"");
        let want = [red, green, blue, [false; 3]];
        assert_eq!(corners(&gltf(&masked)), want, "texture {index}, masked");
    }
    let turned = "\"pbrMetallicRoughness\": {\"metallicFactor\": 0, \"baseColorTexture\": \
                  {\"index\": 1, \"extensions\": {\"KHR_texture_transform\": \
                  {\"scale\": [-1, 1], \"offset\": [1, 0]}}}}";
    assert_eq!(corners(&gltf(turned)), [green, red, white, blue]);
    let lost = "\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 3}, \
                \"metallicFactor\": 0}";
    assert_eq!(corners(&gltf(lost)), [[true; 3]; 4]);
}

#[test]
fn a_gltf_surface_is_of_its_factor_times_its_image_times_the_colours_of_its_vertices() {
    let factor = [0.5, 0.25, 0.75];
    let material = "\"extensions\": {\"KHR_materials_unlit\": {}}, \"pbrMetallicRoughness\": \
         {\"baseColorFactor\": [0.5, 0.25, 0.75, 1], \"baseColorTexture\": {\"index\": 1}}";
    let scene = gltf_of(material, ", \"COLOR_0\": 3");
    let [got, vertices, written] =
        [scene.clone(), replaced(&scene), bare(&scene)].map(|s| shown(&s));
    let texels = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
    for (i, texel) in [0, 3, 12, 15].into_iter().zip(texels) {
        assert_eq!(written[i], [0, 1, 2].map(|c| factor[c] * texel[c]));
    }
    for ((got, vertex), written) in got.into_iter().zip(vertices).zip(written) {
        assert_eq!(got, [0, 1, 2].map(|c| written[c] * vertex[c]));
        assert!(vertex.into_iter().all(|c| 0.0 < c && c < 1.0), "{vertex:?}");
    }
}

#[test]
fn a_gltf_material_takes_every_value_from_its_images() {
    let scene = gltf(
        "\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 2}, \
         \"metallicRoughnessTexture\": {\"index\": 0}}, \"normalTexture\": {\"index\": 0, \
         \"scale\": 0.5}, \"occlusionTexture\": {\"index\": 0, \"strength\": 0.5}, \
         \"emissiveTexture\": {\"index\": 2}, \"emissiveFactor\": [1, 0.5, 0]",
    );
    let material = &scene.materials[scene.objects[0].material.0 as usize];
    let mut keys: Vec<_> = material.textured().into_iter().map(|(key, _)| key).collect();
    keys.sort_unstable();
    let all = [
        "ambient_color",
        "color",
        "emission_color",
        "k_a",
        "normal",
        "roughness",
        "specular_color",
    ];
    assert_eq!(keys, all);
    assert!(shown(&scene).iter().flatten().all(|v| v.is_finite()));
}

#[test]
fn within_glass_an_image_is_looked_up_as_if_no_glass_of_lower_priority_were_before_it() {
    let film = |ball: &str| {
        let text = format!(
            "version = 1\n[image]\nsize = [32, 24]\nsamples = 1\n\
             [camera]\neye = [0, 0, 6]\nlook_at = [0, 0, 0]\nfov = 25\n\
             [[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\nshadows = false\n\
             [textures.squares]\nkind = \"image\"\nfile = \"squares.png\"\n\
             [materials.sheet]\ncolor = {{ texture = \"squares\" }}\n\
             [materials.hard]\ncolor = 0\nreflection = 1\ntransmission = 1\npriority = 1\n\
             [materials.water]\ncolor = 0\nreflection = 1\ntransmission = 1\nior = 1.33\n\
             [[mesh]]\nfile = \"sheet.obj\"\nmaterial = \"sheet\"\ntranslate = [0, 0, -4]\n\
             [[box]]\nmin = [-2, -2, -5]\nmax = [2, 2, 2]\nmaterial = \"hard\"\n\
             [[sphere]]\ncenter = [{ball}]\nradius = 1.5\nmaterial = \"water\"\n"
        );
        let files =
            Memory::new().with("squares.png", squares(16)).with("sheet.obj", SHEET.as_bytes());
        let scene = scene(&text, files);
        let options = RenderOptions::of(&scene.image).unwrap();
        let film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
        film.layer(LayerKind::Picture).unwrap().values.clone()
    };
    let [inside, elsewhere] = ["0, 0, 0", "0, 0, 40"].map(film);
    assert!(inside == elsewhere, "a ball that is not there is seen");
}
