//! Files are read back by the crates they are the formats of, and byte by byte.

use std::io::Cursor;

use phong_scene::{Exposure, Tone, ToneCurve};

use super::*;
use crate::aov::Aov;
use crate::film::{Film, Window};
use crate::finish::{Finishing, finish};
use crate::terms::Term;

const PICTURE: LayerKind = LayerKind::Picture;

/// A film of given layers, values row by row.
fn film(size: [u32; 2], layers: &[(LayerKind, &[f32])]) -> Film {
    let kinds: Vec<_> = layers.iter().map(|&(kind, _)| kind).collect();
    let mut film = Film::new(size, Window::full(size), 16, &kinds);
    for (layer, &(_, values)) in film.layers.iter_mut().zip(layers) {
        layer.values.copy_from_slice(values);
    }
    film
}

fn bytes(film: &Film, content: Content, format: Format, encoding: Encoding) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    let finished = finish(film, &Finishing::default());
    write(&finished, content, format, &encoding, &mut out).unwrap();
    out.into_inner()
}

fn png_of(film: &Film, kind: LayerKind, encoding: Encoding) -> (::png::OutputInfo, Vec<u8>) {
    let file = bytes(film, Content::Layer(kind), Format::Png, encoding);
    let mut reader = ::png::Decoder::new(Cursor::new(file)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    (info, data)
}

#[test]
fn a_png_holds_the_encoded_picture() {
    let film = film([2, 1], &[(PICTURE, &[0.0, 0.5, 1.0, -1.0, 7.0, 0.002])]);
    let (info, data) = png_of(&film, PICTURE, Encoding::default());
    assert_eq!((info.color_type, info.bit_depth), (::png::ColorType::Rgb, ::png::BitDepth::Eight));
    assert_eq!(data, [0, 188, 255, 0, 255, 7]);
}

#[test]
fn a_png_says_which_program_made_it_and_of_which_scene() {
    let film = film([1, 1], &[(PICTURE, &[0.5, 0.25, 1.0])]);
    let mut out = Cursor::new(Vec::new());
    let finished = finish(&film, &Finishing::default().of_scene(0xbeef));
    write(&finished, Content::Layer(PICTURE), Format::Png, &Encoding::default(), &mut out).unwrap();
    let reader = ::png::Decoder::new(Cursor::new(out.into_inner())).read_info().unwrap();
    let texts = &reader.info().uncompressed_latin1_text;
    let said: Vec<_> = texts.iter().map(|t| (t.keyword.as_str(), t.text.as_str())).collect();
    let program = concat!("phong ", env!("CARGO_PKG_VERSION"));
    assert_eq!(said, [("Software", program), ("Scene", "crc32 0000beef")]);
}

#[cfg(feature = "exr")]
#[test]
fn an_exr_says_which_program_made_it_and_of_which_scene() {
    let film = film([1, 1], &[(PICTURE, &[0.5, 0.25, 1.0])]);
    let mut out = Cursor::new(Vec::new());
    let finished = finish(&film, &Finishing::default().of_scene(0xbeef));
    write(&finished, Content::Film, Format::Exr, &Encoding::default(), &mut out).unwrap();
    let meta =
        ::exr::meta::MetaData::read_from_buffered(Cursor::new(out.into_inner()), false).unwrap();
    let told = format!("{:?}", meta.headers[0].own_attributes);
    assert!(told.contains("crc32 0000beef"), "{told}");
    let program = concat!("phong ", env!("CARGO_PKG_VERSION"));
    assert!(
        meta.headers[0].own_attributes.software_name.as_ref().is_some_and(|name| name.eq(program))
    );
}

#[cfg(feature = "exr")]
#[test]
fn an_exr_says_which_layers_are_averaged_and_which_are_of_the_pixels_centre() {
    let (depth, uv) = (LayerKind::Aov(Aov::Depth), LayerKind::Aov(Aov::Uv));
    let diffuse = LayerKind::Term(Term::Diffuse);
    let said = |layers: &[(LayerKind, &[f32])]| {
        let file = bytes(&film([1, 1], layers), Content::Film, Format::Exr, Encoding::default());
        let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(file), false).unwrap();
        let own = &meta.headers[0].own_attributes.other;
        let mut said: Vec<_> =
            own.iter().map(|(name, value)| format!("{name} {value:?}")).collect();
        said.sort();
        said
    };
    let picture = (PICTURE, &[0.5, 0.25, 1.0][..]);
    let all = said(&[picture, (diffuse, &[0.0; 3]), (depth, &[1.0]), (uv, &[0.0; 2])]);
    let [averaged, centre] = &all[..] else { panic!("{all:?}") };
    assert!(averaged.starts_with("averaged") && averaged.contains("picture,diffuse"), "{all:?}");
    assert!(centre.starts_with("pixelCenter") && centre.contains("depth,uv"), "{all:?}");
    assert_eq!(said(&[picture]).len(), 1);
}

#[test]
fn a_png_of_16_bits_is_big_endian() {
    let film = film([1, 1], &[(PICTURE, &[0.5, 0.18, 1.0])]);
    let encoding = Encoding { bits: Bits::Sixteen, ..Encoding::default() };
    let (info, data) = png_of(&film, PICTURE, encoding);
    assert_eq!(info.bit_depth, ::png::BitDepth::Sixteen);
    // 0.735357 × 65535 = 48192 and 0.461356 × 65535 = 30235.
    assert_eq!(data, [[188, 64], [118, 27], [255, 255]].concat());
}

/// So wide that a few rows are all that is encoded at a time.
#[test]
fn a_wide_png_has_every_row_with_and_without_alpha() {
    let (width, height) = (5000, 21);
    let picture: Vec<f32> = (0..3 * width * height).map(|i| (i % 1009) as f32 / 1008.0).collect();
    let size = [width as u32, height as u32];
    let levels =
        |scale: f32| -> Vec<u8> { picture.iter().map(|value| srgb_level(value * scale)).collect() };
    let (info, data) = png_of(&film(size, &[(PICTURE, &picture)]), PICTURE, Encoding::default());
    assert_eq!(info.color_type, ::png::ColorType::Rgb);
    assert_eq!(data, levels(1.0));
    let alpha = vec![0.5; width * height];
    let film = film(size, &[(PICTURE, &picture), (LayerKind::Alpha, &alpha)]);
    let (info, data) = png_of(&film, PICTURE, Encoding::default());
    assert_eq!(info.color_type, ::png::ColorType::Rgba);
    let colors = levels(2.0);
    let rgba = colors.as_chunks::<3>().0.iter().flat_map(|&[r, g, b]| [r, g, b, 128]);
    assert_eq!(data, rgba.collect::<Vec<u8>>());
}

#[test]
fn a_linear_png_says_so() {
    let film = film([1, 1], &[(PICTURE, &[0.5, 0.25, 1.0])]);
    let encoding = Encoding { linear: true, ..Encoding::default() };
    assert_eq!(png_of(&film, PICTURE, encoding).1, [128, 64, 255]);
    let transfer = |encoding| {
        let file = bytes(&film, Content::Layer(PICTURE), Format::Png, encoding);
        Picture::read(&file).unwrap().transfer
    };
    assert_eq!(transfer(encoding), Transfer::Linear);
    assert_eq!(transfer(Encoding::default()), Transfer::Srgb);
}

/// The bytes of a PNG of one layer of a film with such tone.
fn toned(film: &Film, kind: LayerKind, tone: Tone, encoding: Encoding) -> Vec<u8> {
    let finished = finish(film, &Finishing::default().with_tone(tone));
    let mut file = Cursor::new(Vec::new());
    write(&finished, Content::Layer(kind), Format::Png, &encoding, &mut file).unwrap();
    let mut reader = ::png::Decoder::new(Cursor::new(file.into_inner())).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut data).unwrap();
    data
}

#[test]
fn a_stop_of_exposure_doubles_the_light_of_the_picture_alone() {
    let term = LayerKind::Term(Term::Diffuse);
    let film = film([1, 1], &[(PICTURE, &[0.25; 3]), (term, &[0.25; 3])]);
    let tone = Tone { exposure: Exposure::Stops(1.0), ..Tone::default() };
    assert_eq!(toned(&film, PICTURE, tone, Encoding::default()), [188; 3]);
    assert_eq!(toned(&film, term, tone, Encoding::default()), [137; 3]);
}

/// (0.25 · 2) through the filmic curve is 0.616306…, by hand, and that on the sRGB curve 206.
#[test]
fn tone_comes_before_the_curve_of_a_png_and_after_alpha_and_beside_the_light_of_an_exr() {
    let film = film([1, 1], &[(PICTURE, &[0.125; 3]), (LayerKind::Alpha, &[0.5])]);
    let exposure = Exposure::Stops(1.0);
    let tone = Tone { exposure, curve: ToneCurve::Filmic, ..Tone::default() };
    assert_eq!(toned(&film, PICTURE, tone, Encoding::default()), [206, 206, 206, 128]);
    let linear = Encoding { linear: true, ..Encoding::default() };
    assert_eq!(toned(&film, PICTURE, tone, linear), [157, 157, 157, 128]);
    let sixteen = Encoding { bits: Bits::Sixteen, ..linear };
    let data = toned(&film, PICTURE, tone, sixteen);
    assert_eq!(u16::from_be_bytes([data[0], data[1]]), 40_390);
    let plain = bytes(&film, Content::Layer(PICTURE), Format::Pfm, linear);
    let mut out = Cursor::new(Vec::new());
    let finished = finish(&film, &Finishing::default().with_tone(tone));
    assert_eq!(srgb8(&finished, &Encoding::default()), [206, 206, 206, 128]);
    write(&finished, Content::Layer(PICTURE), Format::Pfm, &linear, &mut out).unwrap();
    assert_eq!(out.into_inner(), plain);
    #[cfg(feature = "exr")]
    {
        let mut out = Cursor::new(Vec::new());
        write(&finished, Content::Film, Format::Exr, &linear, &mut out).unwrap();
        let exr = Picture::read(&out.into_inner()).unwrap();
        let red = |name| exr.plane(name).unwrap()[0];
        assert_eq!((red("R"), red("A"), red("finished.A")), (0.125, 0.5, 0.5));
        assert_eq!((2.0 * red("finished.R") * 65535.0).round(), 40_390.0);
    }
}

#[test]
fn alpha_is_straight_and_only_there_if_something_shows_through() {
    let half = film([2, 1], &[(PICTURE, &[0.25; 6]), (LayerKind::Alpha, &[0.5, 0.0])]);
    let (info, data) = png_of(&half, PICTURE, Encoding::default());
    assert_eq!(info.color_type, ::png::ColorType::Rgba);
    assert_eq!(data, [188, 188, 188, 128, 0, 0, 0, 0]);
    let whole = film([2, 1], &[(PICTURE, &[0.25; 6]), (LayerKind::Alpha, &[1.0, 1.0])]);
    assert_eq!(png_of(&whole, PICTURE, Encoding::default()).0.color_type, ::png::ColorType::Rgb);
}

#[test]
fn variables_in_a_png_follow_their_own_rules() {
    let inf = f32::INFINITY;
    let film = film(
        [2, 1],
        &[
            (PICTURE, &[0.0; 6]),
            (LayerKind::Aov(Aov::Depth), &[4.0, inf]),
            (LayerKind::Aov(Aov::Normal), &[0.0, 1.0, -1.0, 0.0, 0.0, 0.0]),
            (LayerKind::Aov(Aov::Object), &[300.0, 0.0]),
            (LayerKind::Aov(Aov::Uv), &[0.5, 1.0, 0.0, 2.0]),
            (LayerKind::Aov(Aov::Position), &[1.0, 2.0, 0.0, 3.0, 2.0, 0.0]),
            (LayerKind::Aov(Aov::Shadow), &[0.5, 1.0]),
        ],
    );
    let png = |aov| png_of(&film, LayerKind::Aov(aov), Encoding::default()).1;
    assert_eq!(png(Aov::Depth), [255, 255, 0, 0]);
    assert_eq!(png(Aov::Normal), [128, 255, 0, 128, 128, 128]);
    assert_eq!(png(Aov::Object), [1, 44, 0, 0]);
    assert_eq!(png(Aov::Uv), [128, 255, 0, 0, 255, 0]);
    assert_eq!(png(Aov::Position), [0, 0, 0, 255, 0, 0]);
    assert_eq!(png(Aov::Shadow), [128, 255]);
}

#[test]
fn a_pfm_is_little_endian_from_the_bottom_up() {
    let film = film([1, 2], &[(PICTURE, &[1.0, 2.0, 3.0, -4.0, 5.0, f32::INFINITY])]);
    let file = bytes(&film, Content::Layer(PICTURE), Format::Pfm, Encoding::default());
    let floats: Vec<u8> =
        [-4.0, 5.0, f32::INFINITY, 1.0, 2.0, 3.0].into_iter().flat_map(f32::to_le_bytes).collect();
    assert_eq!(file, [b"PF\n1 2\n-1.0\n".as_slice(), &floats].concat());
    let back = Picture::read(&file).unwrap();
    assert_eq!(back.rgb().unwrap(), [&[1.0, -4.0], &[2.0, 5.0], &[3.0, f32::INFINITY]]);
}

#[test]
fn a_pfm_of_one_value_a_pixel_is_grey() {
    let film = film([2, 1], &[(LayerKind::Aov(Aov::Depth), &[1.5, f32::INFINITY])]);
    let content = Content::Layer(LayerKind::Aov(Aov::Depth));
    let file = bytes(&film, content, Format::Pfm, Encoding::default());
    assert!(file.starts_with(b"Pf\n2 1\n-1.0\n"));
    assert_eq!(Picture::read(&file).unwrap().plane("Y").unwrap(), [1.5, f32::INFINITY]);
}

#[test]
fn a_big_endian_pfm_is_read() {
    let file = [b"Pf 1 1 1.0\n".as_slice(), &2.5_f32.to_be_bytes()].concat();
    assert_eq!(Picture::read(&file).unwrap().plane("Y").unwrap(), [2.5]);
}

#[cfg(feature = "exr")]
#[test]
fn an_exr_holds_every_layer_to_the_bit() {
    let picture: Vec<f32> = (0..5 * 37 * 3).map(|i| 1.0 / (i as f32 - 50.5)).collect();
    let depth: Vec<f32> = (0..5 * 37).map(|i| 1.0 / i as f32).collect();
    let film = film(
        [5, 37],
        &[
            (PICTURE, &picture),
            (LayerKind::Alpha, &vec![0.5; 5 * 37]),
            (LayerKind::Term(Term::Specular), &picture),
            (LayerKind::Aov(Aov::Depth), &depth),
            (LayerKind::Aov(Aov::Normal), &picture),
        ],
    );
    let file = bytes(&film, Content::Film, Format::Exr, Encoding::default());
    let back = Picture::read(&file).unwrap();
    let names: Vec<_> = back.planes.iter().map(|p| p.name.as_str()).collect();
    let normal = ["normal.X", "normal.Y", "normal.Z"];
    let specular = ["specular.B", "specular.G", "specular.R"];
    assert_eq!(names, [&["A", "B", "G", "R", "depth"], &normal[..], &specular].concat());
    assert_eq!(back.plane("depth").unwrap(), depth);
    assert_eq!(back.plane("A").unwrap(), [0.5; 5 * 37]);
    let of = |c: usize| picture.iter().skip(c).step_by(3).copied().collect::<Vec<_>>();
    let names = [(0, ["R", "specular.R", "normal.X"]), (2, ["B", "specular.B", "normal.Z"])];
    for (c, names) in names {
        for name in names {
            assert_eq!(back.plane(name).unwrap(), of(c), "{name}");
        }
    }
}

/// Noise is not made smaller, and blocks of it stand as they are beside one that is.
#[cfg(feature = "exr")]
#[test]
fn an_exr_holds_noise_in_many_blocks_to_the_bit() {
    let (width, height) = (23, 16 * 9 + 5);
    let mut state = 1_u32;
    let picture: Vec<f32> = (0..3 * width * height)
        .map(|i| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let bits = state ^ (state >> 15);
            if i < 3 * 16 * width { 1.0 } else { f32::from_bits(bits & 0xbfff_ffff) }
        })
        .collect();
    let film = film([width as u32, height as u32], &[(PICTURE, &picture)]);
    let file = bytes(&film, Content::Film, Format::Exr, Encoding::default());
    let back = Picture::read(&file).unwrap();
    let bits = |values: &mut dyn Iterator<Item = f32>| values.map(f32::to_bits).collect::<Vec<_>>();
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        let expected = bits(&mut picture.iter().skip(c).step_by(3).copied());
        assert_eq!(bits(&mut back.plane(name).unwrap().iter().copied()), expected, "{name}");
    }
    assert_eq!(back.plane("A").unwrap(), vec![1.0; width * height]);
}

#[cfg(feature = "exr")]
#[test]
fn an_exr_says_which_red_green_and_blue_it_means_and_how_it_is_packed() {
    let film = film([1, 1], &[(PICTURE, &[0.25; 3])]);
    let file = bytes(&film, Content::Film, Format::Exr, Encoding::default());
    let meta = ::exr::meta::MetaData::read_from_buffered(Cursor::new(file), true).unwrap();
    let header = &meta.headers[0];
    assert_eq!(header.compression, ::exr::compression::Compression::ZIP16);
    let rec_709 = header.shared_attributes.chromaticities.unwrap();
    assert_eq!((rec_709.red.0, rec_709.white.1), (0.64, 0.3290));
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let picture: Vec<f32> = (0..3 * 64 * 64).map(|i| (i % 97) as f32 / 96.0).collect();
    let film = film([64, 64], &[(PICTURE, &picture)]);
    for format in Format::ALL {
        let content = Content::of(&[PICTURE], format)[0];
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| bytes(&film, content, format, Encoding::default()))
        };
        assert_eq!(with(1), with(5), "{format:?}");
    }
}

#[test]
fn a_pfm_header_may_end_its_lines_as_windows_does() {
    let pixels: Vec<u8> = [1.0_f32, 2.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    for end in ["\n", "\r\n", " "] {
        let header = format!("Pf{end}2 1{end}-1.0{end}");
        let picture = Picture::read(&[header.as_bytes(), &pixels].concat()).unwrap();
        assert_eq!(picture.planes[0].values, [1.0, 2.0], "{end:?}");
    }
}

#[cfg(feature = "exr")]
#[test]
fn the_picture_of_an_exr_file_is_its_display_window() {
    use ::exr::prelude::{
        Encoding, Image, IntegerBounds, Layer, LayerAttributes, SpecificChannels, Vec2,
        WritableImage,
    };
    // 2 × 2 pixels at (1, 1), of which a picture of 4 × 2 shows the upper row.
    let pixel = |at: Vec2<usize>| (1.0_f32 + at.x() as f32, 0.0_f32, 10.0 * at.y() as f32);
    let attributes = LayerAttributes { layer_position: Vec2(1, 1), ..LayerAttributes::default() };
    let channels = SpecificChannels::rgb(pixel);
    let layer = Layer::new((2, 2), attributes, Encoding::UNCOMPRESSED, channels);
    let mut image = Image::from_layer(layer);
    image.attributes.display_window = IntegerBounds::from_dimensions((4, 2));
    let mut file = Cursor::new(Vec::new());
    image.write().to_buffered(&mut file).unwrap();
    let picture = Picture::read(file.get_ref()).unwrap();
    assert_eq!(picture.size, [4, 2]);
    let red = picture.planes.iter().find(|plane| plane.name == "R").unwrap();
    assert_eq!(red.values, [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0]);
}

#[test]
fn damaged_files_are_errors_and_no_panic() {
    let picture: Vec<f32> = (0..3 * 20 * 20).map(|i| (i % 7) as f32 / 6.0).collect();
    let film = film([20, 20], &[(PICTURE, &picture)]);
    for format in Format::ALL.into_iter().filter(|f| cfg!(feature = "exr") || !f.holds_layers()) {
        let content = Content::of(&[PICTURE], format)[0];
        let whole = bytes(&film, content, format, Encoding::default());
        for end in 0..whole.len().min(400) {
            let _ = Picture::read(&whole[..end]);
        }
        assert!(Picture::read(&whole[..whole.len() / 2]).is_err(), "{format:?}");
        for at in 0..whole.len().min(2000) {
            for mask in [0x01, 0x80, 0xff] {
                let mut bent = whole.clone();
                bent[at] ^= mask;
                let _ = Picture::read(&bent);
            }
        }
    }
    assert_eq!(Picture::read(b""), Err(ReadError::Unknown));
    assert_eq!(Picture::read(b"GIF89a"), Err(ReadError::Unknown));
}

#[test]
fn a_picture_that_claims_to_be_huge_is_refused_before_memory_is_taken() {
    let (width, height) = (4_000_000_000, 4_000_000_000);
    let pfm = b"PF\n4000000000 4000000000\n-1.0\n";
    assert_eq!(Picture::read(pfm), Err(ReadError::TooLarge { width, height }));

    let mut png = Vec::new();
    let (width, height) = (1_000_000, 2_000_000);
    let mut writer = ::png::Encoder::new(&mut png, width, height).write_header().unwrap();
    writer.write_chunk(::png::chunk::IDAT, &[0x78, 0x01]).unwrap();
    drop(writer);
    assert_eq!(Picture::read(&png), Err(ReadError::TooLarge { width, height }));
}

#[test]
fn files_of_a_film_are_named_by_their_layers() {
    let kinds =
        [PICTURE, LayerKind::Alpha, LayerKind::Term(Term::Diffuse), LayerKind::Aov(Aov::Depth)];
    let words = |format| Content::of(&kinds, format).into_iter().map(Content::word).collect();
    let apart: Vec<_> = words(Format::Png);
    let apart: Vec<_> = apart.iter().map(|word| word.as_deref()).collect();
    assert_eq!(apart, [None, Some("diffuse"), Some("depth")]);
    let together: Vec<_> = words(Format::Exr);
    assert_eq!(together, [None]);
}
