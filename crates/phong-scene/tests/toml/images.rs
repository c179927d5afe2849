//! Images of textures: every kind is read, and what is no image is told at its place.

use phong_scene::{
    Diagnostic, Limits, Memory, Reading, TexelValues, Texels, TextureKind, read, read_changed,
};

const TEXT: &str = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
                    [textures.map]\nkind = \"image\"\nfile = \"map\"\n\
                    [materials.m]\ncolor = { texture = \"map\" }\n\
                    [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\n\
                    [[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\n";

fn reading(image: &[u8], limits: &Limits) -> Reading {
    let files = Memory::new().with("a.toml", TEXT.as_bytes()).with("map", image);
    read("a.toml", None, &files, limits)
}

/// The pixels that are read.
fn texels(image: &[u8]) -> std::sync::Arc<Texels> {
    let reading = reading(image, &Limits::default());
    assert!(reading.diagnostics.is_empty(), "{:#?}", reading.diagnostics);
    let TextureKind::Image { texels, .. } = &reading.scene.expect("a scene").textures[0].kind
    else {
        panic!("an image")
    };
    texels.clone()
}

/// The one error that there is.
fn error(image: &[u8], limits: &Limits) -> Diagnostic {
    let reading = reading(image, limits);
    assert!(reading.scene.is_none());
    let errors: Vec<_> = reading.diagnostics.into_iter().filter(Diagnostic::is_error).collect();
    assert_eq!(errors.len(), 1, "{errors:#?}");
    errors.into_iter().next().expect("one")
}

fn png(size: [u32; 2], kind: (png::ColorType, png::BitDepth), values: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(kind.0);
    encoder.set_depth(kind.1);
    if kind.0 == png::ColorType::Indexed {
        encoder.set_palette(vec![255, 0, 0, 0, 0, 255]);
        encoder.set_trns(vec![255, 51]);
    }
    let mut writer = encoder.write_header().expect("memory");
    writer.write_image_data(values).expect("memory");
    writer.finish().expect("memory");
    bytes
}

#[test]
fn every_colour_type_and_depth_of_png_is_read() {
    use png::BitDepth::{Eight, Four, One, Sixteen, Two};
    use png::ColorType::{Grayscale, GrayscaleAlpha, Indexed, Rgb, Rgba};
    // Of two pixels the second.
    let cases: [(_, &[u8], [f32; 4]); 11] = [
        ((Grayscale, One), &[0b0100_0000], [1.0; 4]),
        ((Grayscale, Two), &[0b0010_0000], [2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 1.0]),
        ((Grayscale, Four), &[0x03], [0.2, 0.2, 0.2, 1.0]),
        ((Grayscale, Eight), &[0, 51], [0.2, 0.2, 0.2, 1.0]),
        ((Grayscale, Sixteen), &[0, 0, 0x33, 0x33], [0.2, 0.2, 0.2, 1.0]),
        ((GrayscaleAlpha, Eight), &[0, 0, 51, 102], [0.2, 0.2, 0.2, 0.4]),
        ((GrayscaleAlpha, Sixteen), &[0, 0, 0, 0, 0x33, 0x33, 0x66, 0x66], [0.2, 0.2, 0.2, 0.4]),
        ((Indexed, One), &[0b0100_0000], [0.0, 0.0, 1.0, 0.2]),
        ((Rgb, Eight), &[0, 0, 0, 255, 51, 102], [1.0, 0.2, 0.4, 1.0]),
        ((Rgba, Eight), &[0, 0, 0, 0, 255, 51, 102, 0], [1.0, 0.2, 0.4, 0.0]),
        (
            (Rgba, Sixteen),
            &[0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 0x33, 0x33, 0x66, 0x66, 0, 0],
            [1.0, 0.2, 0.4, 0.0],
        ),
    ];
    for (kind, values, want) in cases {
        let texels = texels(&png([2, 1], kind, values));
        assert_eq!(texels.size(), [2, 1], "{kind:?}");
        assert_eq!(texels.get([1, 0], false), want, "{kind:?}");
        let is_wide = matches!(texels.values(), TexelValues::Shorts(_));
        assert_eq!(is_wide, kind.1 == Sixteen, "{kind:?}: bytes stay bytes");
    }
}

#[test]
fn jpegs_are_read_whether_baseline_progressive_or_grey() {
    let near = |a: f32, b: f32| (a - b / 255.0).abs() < 0.03;
    for bytes in [
        &include_bytes!("../cases/images/baseline.jpg")[..],
        include_bytes!("../cases/images/progressive.jpg"),
    ] {
        let texels = texels(bytes);
        assert_eq!((texels.size(), texels.channels()), ([16, 8], 3));
        let [r, g, b, _] = texels.get([2, 4], false);
        assert!(near(r, 200.0) && near(g, 40.0) && near(b, 40.0), "{r} {g} {b}");
    }
    let grey = texels(include_bytes!("../cases/images/grey.jpg"));
    assert_eq!((grey.size(), grey.channels()), ([16, 8], 1));
}

/// Two pixels, the second of which is this bright.
fn exr(bright: f32) -> Vec<u8> {
    use exr::prelude::{SpecificChannels, WritableImage};
    let colors = SpecificChannels::rgb(|at: exr::math::Vec2<usize>| {
        if at.x() == 1 { (bright, 0.5_f32, 0.25_f32) } else { (0.0, 0.0, 0.0) }
    });
    let mut bytes = std::io::Cursor::new(Vec::new());
    exr::prelude::Image::from_channels((2, 1), colors)
        .write()
        .to_buffered(&mut bytes)
        .expect("memory");
    bytes.into_inner()
}

/// Two pixels of Radiance HDR as they are without run lengths.
const HDR: &[u8] =
    b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x00\x00\x00\x00\x80\x40\x20\x83";

#[test]
fn images_of_floats_keep_what_is_brighter_than_white() {
    assert_eq!(texels(&exr(7.5)).get([1, 0], false), [7.5, 0.5, 0.25, 1.0]);
    let [r, g, b, _] = texels(HDR).get([1, 0], false);
    assert!(
        (r - 4.0).abs() < 0.02 && (g - 2.0).abs() < 0.02 && (b - 1.0).abs() < 0.02,
        "{r} {g} {b}"
    );
}

/// Radiance HDR without run lengths, whose pixels are as red as their numbers.
fn hdr(header: &str, pixels: &[u8]) -> Vec<u8> {
    let pixels = pixels.iter().flat_map(|&red| [red, 8, 16, 136]);
    format!("#?RADIANCE\n{header}\n").into_bytes().into_iter().chain(pixels).collect()
}

#[test]
fn hdr_lines_may_run_any_way() {
    // 10 20 30 over 40 50 60, written in each of the eight ways.
    for (size, pixels) in [
        ("-Y 2 +X 3", [10, 20, 30, 40, 50, 60]),
        ("-Y 2 -X 3", [30, 20, 10, 60, 50, 40]),
        ("+Y 2 +X 3", [40, 50, 60, 10, 20, 30]),
        ("+Y 2 -X 3", [60, 50, 40, 30, 20, 10]),
        ("+X 3 -Y 2", [10, 40, 20, 50, 30, 60]),
        ("+X 3 +Y 2", [40, 10, 50, 20, 60, 30]),
        ("-X 3 -Y 2", [30, 60, 20, 50, 10, 40]),
        ("-X 3 +Y 2", [60, 30, 50, 20, 40, 10]),
    ] {
        let texels = texels(&hdr(&format!("\n{size}"), &pixels));
        assert_eq!(texels.size(), [3, 2], "{size}");
        let red = |at| (texels.get(at, false)[0] / 10.0).round() as u32;
        let rows = [0, 1].map(|y| [0, 1, 2].map(|x| red([x, y])));
        assert_eq!(rows, [[1, 2, 3], [4, 5, 6]], "{size}");
    }
}

#[test]
fn hdr_exposures_are_divided_out() {
    let pixel =
        |header: &str| texels(&hdr(&format!("{header}\n-Y 1 +X 1"), &[64])).get([0, 0], false);
    let plain = pixel("");
    assert_eq!(
        pixel("EXPOSURE=2\nVIEW=-vtv\nEXPOSURE= 4\n"),
        [plain[0] / 8.0, plain[1] / 8.0, plain[2] / 8.0, 1.0]
    );
    let corrected = [plain[0], plain[1] / 2.0, plain[2] / 4.0, 1.0];
    assert_eq!(pixel("FORMAT=32-bit_rle_rgbe\nCOLORCORR=1 2 4\n"), corrected);
}

/// The one warning that there is, where the file is named.
fn warning(image: &[u8]) -> String {
    let reading = reading(image, &Limits::default());
    assert!(reading.scene.is_some());
    let [warning] = &reading.diagnostics[..] else { panic!("{:#?}", reading.diagnostics) };
    let span = warning.span.as_ref().expect("a place");
    assert_eq!((span.place.line, span.place.column), (7, 8), "{}", warning.message);
    warning.message.clone()
}

#[test]
fn hdr_primaries_other_than_those_of_rec_709_are_told() {
    for (said, is_told) in [
        ("0.640 0.330 0.300 0.600 0.150 0.060 0.3127 0.3290", false),
        ("0.64 0.33 0.30 0.60 0.15 0.06 0.313 0.329", false),
        // Radiance's own, whose white is of equal energy.
        ("0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333", true),
        ("0.7347 0.2653 0 1 0.0001 -0.077 0.3217 0.3377", true),
        ("0.64 0.33", true),
        ("red", true),
    ] {
        let image = hdr(&format!("PRIMARIES= {said}\n\n-Y 1 +X 1"), &[64]);
        if is_told {
            let told = warning(&image);
            assert!(told.contains(&format!("not by `PRIMARIES= {said}`")), "{told}");
        } else {
            texels(&image);
        }
    }
}

#[test]
fn parts_of_an_exr_beside_the_first_are_told() {
    use exr::prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds,
        Layer, LayerAttributes, WritableImage,
    };
    let part = |name: &str| {
        let channel = |name: &str| AnyChannel::new(name, FlatSamples::F32(vec![0.5]));
        let channels = AnyChannels::sort(["R", "G", "B"].map(channel).into_iter().collect());
        Layer::new((1, 1), LayerAttributes::named(name), Encoding::UNCOMPRESSED, channels)
    };
    let attributes = ImageAttributes::new(IntegerBounds::from_dimensions((1, 1)));
    let image = Image::from_layers(attributes, ["beauty", "shadow", "depth"].map(part).to_vec());
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).expect("memory");
    let told = warning(&bytes.into_inner());
    assert!(told.contains("of its parts \"beauty\" is taken, not `shadow` and `depth`"), "{told}");
}

#[test]
fn what_is_no_image_is_an_error_where_it_is_named() {
    let whole = png([2, 1], (png::ColorType::Rgb, png::BitDepth::Eight), &[9; 6]);
    let jpeg = include_bytes!("../cases/images/baseline.jpg");
    let exr = exr(1.0);
    let mut empty = whole.clone();
    empty[16..20].fill(0);
    let limits = Limits::default();
    for (bytes, message) in [
        (&b""[..], "it is empty"),
        (b"GIF89a", "it is no PNG, JPEG, HDR or EXR"),
        (&whole[..whole.len() / 2], "it is a broken PNG"),
        (&empty, "PNG"),
        (&jpeg[..jpeg.len() / 2], "it is a broken JPEG"),
        (include_bytes!("../cases/images/inks.jpg"), "four inks (CMYK)"),
        (&HDR[..HDR.len() - 4], "it is a broken HDR"),
        (b"#?RADIANCE\nnothing", "it is a broken HDR"),
        (&hdr("EXPOSURE=0\n\n-Y 1 +X 1", &[1]), "`EXPOSURE=0` is no factor above 0"),
        (&hdr("\n-Y 1 +Y 1", &[1]), "`-Y 1 +Y 1` is no size"),
        (&hdr("\n-Y 0 +X 1", &[1]), "it has no pixels"),
        (&hdr("FORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1", &[1]), "unsupported format `32-bit_rle_xyze`"),
        (&exr[..exr.len() / 2], "it is a broken EXR"),
    ] {
        let error = error(bytes, &limits);
        assert!(error.message.contains(message), "{} lacks {message}", error.message);
        let span = error.span.unwrap();
        assert_eq!((span.place.line, span.place.column), (7, 8), "{}", error.message);
    }
}

#[test]
fn an_image_with_nan_or_over_the_limits_is_told() {
    let message = error(&exr(f32::NAN), &Limits::default()).message;
    assert!(message.contains("the pixel at (1, 0) is NaN"), "{message}");
    let image = png([2, 2], (png::ColorType::Rgb, png::BitDepth::Eight), &[9; 12]);
    let small = Limits { image_pixels: 3, ..Limits::default() };
    assert!(error(&image, &small).message.contains("2 × 2: more than 3 pixels"));
    let narrow = Limits { bytes: 80, ..Limits::default() };
    assert!(!error(&image, &narrow).message.is_empty());
    for bytes in [&exr(1.0)[..], HDR, include_bytes!("../cases/images/grey.jpg")] {
        let one = Limits { image_pixels: 1, ..Limits::default() };
        assert!(error(bytes, &one).message.contains("more than 1 pixels"));
    }
}

#[test]
fn an_image_that_is_not_there_is_told_and_a_mesh_without_coordinates_is_warned_of() {
    let files = Memory::new().with("a.toml", TEXT.as_bytes());
    let told = read("a.toml", None, &files, &Limits::default()).diagnostics;
    assert_eq!(told[0].message, "`map` cannot be read: there is no such file");
    let text =
        TEXT.replace("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1", "[[mesh]]\nfile = \"flat.obj\"");
    let image = png([1, 1], (png::ColorType::Rgb, png::BitDepth::Eight), &[9; 3]);
    let files = Memory::new()
        .with("a.toml", text.as_bytes())
        .with("map", image)
        .with("flat.obj", &b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"[..]);
    let told = read_changed("a.toml", None, &files, &Limits::default(), &[]).diagnostics;
    let messages: Vec<_> = told.iter().map(|told| told.message.as_str()).collect();
    assert_eq!(messages, ["mesh 1 has no texture coordinates, which the texture \"map\" needs"]);
}

#[test]
fn a_sky_may_be_an_image_which_is_read_and_written_as_those_of_textures_are() {
    use phong_scene::{ExportOptions, SkyKind};
    let text = TEXT.replace(
        "[textures.map]",
        "[sky]\nkind = \"image\"\nfile = \"map\"\nrotation = 30\n[textures.map]",
    );
    let image = png([2, 1], (png::ColorType::Rgb, png::BitDepth::Eight), &[9, 8, 7, 6, 5, 4]);
    let files = Memory::new().with("a.toml", text.as_bytes()).with("map", &*image);
    let reading = read("a.toml", None, &files, &Limits::default());
    assert!(reading.diagnostics.is_empty(), "{:#?}", reading.diagnostics);
    let scene = reading.scene.expect("a scene");
    let Some(SkyKind::Image { texels, rotation, .. }) = scene.sky.as_ref().map(|sky| &sky.kind)
    else {
        panic!("an image")
    };
    assert_eq!((texels.size(), *rotation), ([2, 1], 30.0));
    // One file is read once, and written once.
    let TextureKind::Image { texels: other, .. } = &scene.textures[0].kind else { panic!("one") };
    assert!(std::sync::Arc::ptr_eq(texels, other));
    let export = scene.clone().export(&ExportOptions::default(), "b.toml").expect("it is written");
    let names: Vec<_> = export.files.iter().map(|file| file.name.clone()).collect();
    assert_eq!(names, ["b.toml", "b-image-1.png"]);
    // What is no image is told at its place.
    let files = Memory::new().with("a.toml", text.as_bytes()).with("map", &b"no image"[..]);
    let said = read("a.toml", None, &files, &Limits::default()).diagnostics;
    assert!(said.iter().any(|d| d.is_error() && d.message.contains("map")), "{said:#?}");
}

#[test]
fn a_sky_of_floats_is_as_bright_when_it_was_written_and_read_again() {
    use phong_scene::{ExportOptions, Scene, SkyKind, TexelValues};
    let texels = Texels::new([1, 1], 3, TexelValues::Floats(vec![0.5, 0.25, 0.0])).expect("one");
    let kind = SkyKind::Image {
        texels: texels.into(),
        file: "sky.exr".to_owned(),
        rotation: 0.0,
        place: phong_scene::Place::default(),
    };
    let scene =
        Scene { sky: Some(phong_scene::Sky { kind, ..Default::default() }), ..Scene::default() };
    let export = scene.export(&ExportOptions::default(), "b.toml").expect("it is written");
    let mut files = Memory::new();
    for file in &export.files {
        let mut bytes = Vec::new();
        file.write(&mut bytes).expect("memory");
        files = files.with(&file.name, bytes);
    }
    let again = read("b.toml", None, &files, &Limits::default()).into_scene().expect("a scene");
    let Some(SkyKind::Image { texels, .. }) = again.sky.map(|sky| sky.kind) else { panic!("one") };
    for (found, wanted) in texels.get([0, 0], true).into_iter().zip([0.5, 0.25, 0.0]) {
        assert!((found - wanted).abs() < 1e-4, "{found} for {wanted}");
    }
}
