use phong_scene::{Exposure, Image, Rgb, Scene, Tone, ToneCurve};

use super::*;
use crate::aov::Aov;
use crate::film::{LayerKind, Window};
use crate::finish::Finishing;
use crate::image::{Bits, Encoding};
use crate::render::RenderOptions;
use crate::terms::{Term, TermSet};

const NO_LIMIT: u64 = u64::MAX;

fn settings(share: Option<(u32, u32)>) -> Settings {
    let image = Image { size: [40, 30], ..Image::default() };
    let options = RenderOptions::of(&image).unwrap().with_terms(TermSet::ALL);
    let options = options.with_window(Window { x0: 1, y0: 2, x1: 40, y1: 30 }).unwrap();
    let options = options.with_aovs(&[Aov::Depth, Aov::Normal]);
    let options = share.map_or(options.clone(), |(i, n)| options.with_share(i, n).unwrap());
    let encoding = Encoding { bits: Bits::Sixteen, linear: true };
    let tone = Tone { exposure: Exposure::Stops(-0.1), ..Tone::default() };
    Settings::of(&Scene { image, tone: Some(tone), ..Scene::default() }, &options, encoding)
}

/// A part with its tiles done, every value told apart from every other.
fn part(share: Option<(u32, u32)>) -> Part {
    let settings = settings(share);
    let mut film = settings.empty_film();
    let mine = |tile: usize| share.is_none_or(|(i, n)| tile as u32 % n == i);
    for tile in (0..film.tiles()).filter(|&tile| mine(tile)) {
        let mut values = film.take(tile);
        for (i, v) in values.iter_mut().flatten().enumerate() {
            *v = 1.0 / (1 + i + 1000 * tile) as f32;
        }
        film.put(tile, &values);
    }
    Part { settings, film }
}

fn bytes(part: &Part) -> Vec<u8> {
    let mut out = Vec::new();
    write(part.film.film_tiles(), &part.settings, &mut out).unwrap();
    out
}

fn read(mut bytes: &[u8]) -> Result<Part, PartError> {
    Part::read(&mut bytes, NO_LIMIT)
}

/// Puts parts together, as films and as files, which is the same.
fn join(parts: &[(&str, Part)]) -> Result<(Film, Settings), JoinError> {
    let [mut join, mut reading] = [Join::default(), Join::default()];
    for (name, part) in parts {
        let added = join.add(name, part.clone());
        match reading.read(name, &mut &*bytes(part), NO_LIMIT) {
            Ok(()) => assert_eq!(added, Ok(())),
            Err(ReadError::Join(error)) => assert_eq!(added, Err(error)),
            Err(ReadError::Part(error)) => panic!("{error}"),
        }
        added?;
    }
    let whole = join.finish();
    assert_eq!(reading.finish(), whole);
    whole
}

#[test]
fn a_picture_is_finished_alike_by_its_options_and_by_what_a_part_says_of_it() {
    let outline = Some(phong_scene::Outline::default());
    let scene = Scene { outline, ..Scene::default() };
    let options = RenderOptions::of(&scene.image).unwrap().with_finishing_of(&scene);
    let said = Settings::of(&scene, &options, Encoding::default()).finishing();
    let by_options = Finishing::of(&options).of_scene(fingerprint(&scene));
    assert!(by_options.draws());
    assert_eq!(said, by_options);
}

#[test]
fn what_is_written_is_read() {
    for share in [None, Some((1, 4))] {
        let part = part(share);
        assert_eq!(read(&bytes(&part)).unwrap(), part);
    }
}

#[test]
fn tone_is_kept_and_is_part_of_what_a_picture_is() {
    let plain = part(None);
    let neutral = Some(Rgb::new(1.0, 0.25, 1e-7));
    for tone in [
        Tone { exposure: Exposure::Auto, ..Tone::default() },
        Tone { white_balance: Some(3200.5), curve: ToneCurve::Filmic, ..Tone::default() },
        Tone { neutral, curve: ToneCurve::Reinhard { white: 2.25 }, ..Tone::default() },
    ] {
        let settings = Settings { tone, ..plain.settings.clone() };
        let toned = Part { settings, film: plain.film.clone() };
        assert_eq!(read(&bytes(&toned)).unwrap(), toned);
        assert_ne!(toned.settings.checksum(), plain.settings.checksum());
        assert!(toned.settings.difference(&plain.settings).is_some());
        assert!(plain.settings.difference(&toned.settings).is_some());
        assert_eq!(toned.settings.finishing().tone, tone);
    }
}

#[test]
fn every_cut_is_noticed() {
    let whole = bytes(&part(Some((0, 3))));
    for end in (0..whole.len()).step_by(7).chain([whole.len() - 1]) {
        assert!(read(&whole[..end]).is_err(), "cut at {end} of {}", whole.len());
    }
    assert!(read(&[&whole[..], b"x"].concat()).is_err());
}

#[test]
fn every_flipped_bit_is_noticed() {
    let whole = bytes(&part(Some((0, 6))));
    for at in (0..400).chain((400..whole.len()).step_by(13)) {
        let mut bent = whole.clone();
        bent[at] ^= 1 << (at % 8);
        assert!(read(&bent).is_err(), "bit {} of byte {at}", at % 8);
    }
}

#[test]
fn other_files_and_other_versions_are_told_apart() {
    assert!(matches!(read(b"\x89PNG\r\n\x1a\n0123456789"), Err(PartError::Unknown)));
    assert!(matches!(read(b""), Err(PartError::Unknown)));
    for version in ["1", "2", "3", "5"] {
        let other = MAGIC.replace('4', version);
        assert!(matches!(read(other.as_bytes()), Err(PartError::Version)), "{version}");
    }
}

#[test]
fn pixels_of_another_arithmetic_are_refused() {
    let whole = bytes(&part(None));
    let (header, _) = header(&mut &*whole).unwrap();
    let ours = format!("arithmetic {ARITHMETIC}\n");
    let other = header.replace(&ours, &format!("arithmetic {}\n", ARITHMETIC + 1));
    let text = format!("{other}check {:08x}\n\n", checksum(other.as_bytes()));
    let error = read(text.as_bytes()).unwrap_err();
    assert!(matches!(error, PartError::Arithmetic { theirs } if theirs == ARITHMETIC + 1));
    assert!(error.to_string().contains("of the arithmetic"), "{error}");
}

/// The same, of which every other tile has 3 samples a pixel and the sums to go on from.
fn begun() -> Part {
    let Part { settings, film } = part(None);
    let mut begun = settings.empty_film();
    for tile in 0..film.tiles() {
        let number = |i: usize| 0.1 * (1 + i + 1000 * tile) as f64;
        let sums = |k: usize| {
            let numbers: Vec<f64> = (0..Sums8::NUMBERS).map(|i| number(200 * k + i)).collect();
            Sums8::of_numbers(&numbers)
        };
        let eights = (0..eights_of(film.tile_window(tile))).map(sums).collect();
        if tile % 2 == 0 {
            begun.put(tile, &film.take(tile));
        } else {
            let sums = Some(Arc::new(TileSums::new(3, eights)));
            begun.put_unfinished(tile, &film.take(tile), sums);
        }
    }
    Part { settings, film: begun }
}

#[test]
fn sums_between_passes_are_read_as_they_were_written() {
    let part = begun();
    let whole = bytes(&part);
    assert_eq!(read(&whole).unwrap(), part);
    for at in (0..whole.len()).step_by(97) {
        let mut bent = whole.clone();
        bent[at] ^= 1 << (at % 8);
        assert!(read(&bent).is_err(), "bit {} of byte {at}", at % 8);
        assert!(read(&whole[..at]).is_err(), "cut at {at} of {}", whole.len());
    }
    let limit = part.settings.film_bytes() + 1000;
    let result = Part::read(&mut &*whole, limit);
    assert!(matches!(result, Err(PartError::TooLarge { .. })), "sums take memory too");
}

#[test]
fn a_picture_larger_than_allowed_is_refused() {
    let part = part(None);
    let limit = part.settings.film_bytes() - 1;
    let result = Part::read(&mut &*bytes(&part), limit);
    assert!(matches!(result, Err(PartError::TooLarge { .. })));
}

#[test]
fn shares_in_any_order_are_the_whole() {
    let whole = part(None).film;
    let parts = [2, 0, 1].map(|i| ("x", part(Some((i, 3)))));
    assert_eq!(join(&parts).unwrap().0, whole);
}

#[test]
fn a_missing_share_is_named() {
    let parts = [("a", part(Some((0, 3)))), ("b", part(Some((2, 3))))];
    let error = join(&parts).unwrap_err();
    assert_eq!(error.to_string(), "the picture is not complete: share 1/3 is missing");
    assert_eq!(join(&[]).unwrap_err(), JoinError::Empty);
}

#[test]
fn a_damaged_part_adds_nothing_to_what_was_gathered_before() {
    let mut join = Join::default();
    join.read("a", &mut &*bytes(&part(Some((0, 2)))), NO_LIMIT).unwrap();
    let whole = bytes(&part(Some((1, 2))));
    let cut = join.read("b", &mut &whole[..whole.len() - 1], NO_LIMIT).unwrap_err();
    assert!(matches!(cut, ReadError::Part(PartError::Damaged(_))), "{cut}");
    join.read("b", &mut &*whole, NO_LIMIT).unwrap();
    assert!(join.finish().unwrap().0.is_complete());
}

#[test]
fn the_same_share_twice_is_named() {
    let parts = [("a", part(Some((0, 2)))), ("b", part(Some((1, 2)))), ("c", part(Some((1, 2))))];
    let error = join(&parts).unwrap_err();
    assert_eq!(error.to_string(), "b and c overlap: both are share 1/2");
}

#[test]
fn parts_of_different_pictures_say_how_they_differ() {
    let a = part(Some((0, 2)));
    let mut b = part(Some((1, 2)));
    b.settings.picture[1].1 = "64".to_owned();
    let error = join(&[("a", a), ("b", b)]).unwrap_err();
    let told = "a and b are of different pictures: samples is 16 and 64";
    assert_eq!(error.to_string(), told);
}

#[test]
fn a_scene_is_known_by_what_it_holds_and_not_by_where_it_was_written() {
    use glam::{DAffine3, DVec3};
    use phong_scene::{Camera, CameraKind, Material, MaterialId, Object, Place, Scene, Shape};
    let object = Object {
        name: "sphere 1".to_owned(),
        shape: Shape::Sphere { center: DVec3::ZERO, radius: 1.0 },
        material: MaterialId(0),
        transform: DAffine3::IDENTITY,
        place: Place::default(),
    };
    let scene = Scene {
        image: Image::default(),
        camera: Camera {
            kind: CameraKind::Perspective { fov: 40.0 },
            eye: DVec3::Z,
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
            shift: glam::DVec2::ZERO,
        },
        lights: Vec::new(),
        materials: vec![Material::default()],
        objects: vec![object],
        ..Scene::default()
    };
    let mut elsewhere = scene.clone();
    elsewhere.objects[0].place = Place { file: "b.toml".into(), line: 7, column: 1 };
    elsewhere.image.samples = 1;
    assert_eq!(fingerprint(&elsewhere), fingerprint(&scene));
    let mut other = scene.clone();
    other.objects[0].shape = Shape::Sphere { center: DVec3::ZERO, radius: 1.000_000_1 };
    assert_ne!(fingerprint(&other), fingerprint(&scene));
    let mut other = scene.clone();
    other.materials[0].shininess = 33.0.into();
    assert_ne!(fingerprint(&other), fingerprint(&scene));
}

#[test]
fn a_scene_is_known_by_the_pixels_of_its_images_and_not_by_their_files() {
    use phong_scene::{
        Encoding, Rgb, TexelFilter, TexelValues, Texels, Texture, TextureKind, Wrap,
    };
    let of = |file: &str, values: TexelValues| {
        let kind = TextureKind::Image {
            file: file.to_owned(),
            texels: Arc::new(Texels::new([2, 1], 1, values).unwrap()),
            wrap: Wrap::Repeat,
            wrap_v: None,
            border: Rgb::BLACK,
            tint: Rgb::WHITE,
            filter: TexelFilter::Auto,
            encoding: Encoding::Auto,
        };
        let textures = vec![Texture { kind, ..Texture::default() }];
        fingerprint(&Scene { textures, ..Scene::default() })
    };
    let kinds: [fn(u8) -> TexelValues; 3] = [
        |last| TexelValues::Bytes(vec![7, last]),
        |last| TexelValues::Shorts(vec![7, last.into()]),
        |last| TexelValues::Floats(vec![7.0, last.into()]),
    ];
    for values in kinds {
        let own = of("a.png", values(8));
        assert_eq!(of("b.png", values(8)), own);
        assert_ne!(of("a.png", values(9)), own, "one pixel is another");
    }
}

/// Between them, of every camera, shape, model, light, filter and texture some.
const DRAWN: [&str; 17] = [
    "cameras/fisheye",
    "cameras/lens",
    "film/filter_mitchell",
    "film/transparent",
    "lights/attenuation",
    "lights/spot",
    "materials/cook_torrance",
    "materials/oren_nayar",
    "materials/ward",
    "shapes/cylinders",
    "shapes/mesh_smooth",
    "shapes/sphere_far",
    "shapes/torus",
    "terms/sum",
    "terms/transmission",
    "textures/numbers",
    "transforms/instance_nested",
];

#[test]
fn who_moves_a_bit_of_a_picture_raises_the_version_of_the_arithmetic() {
    let golden = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let mut sum = crc32fast::Hasher::new();
    for name in DRAWN {
        let path = golden.join(format!("{name}.toml"));
        let limits = phong_scene::Limits::default();
        let read = phong_scene::read(&path.to_string_lossy(), None, &phong_scene::Folder, &limits);
        let scene = read.into_scene().unwrap();
        let options = RenderOptions::of(&scene.image).unwrap().with_terms(TermSet::ALL);
        let view = crate::view::View::of(&scene).unwrap();
        let film = crate::render::render(&view, &options, &|_| {}, &crate::render::Cancel::new());
        // There is fog in none of them.
        let layers = film.film.layers.iter().filter(|l| l.kind != LayerKind::Term(Term::Fog));
        for value in layers.flat_map(|layer| layer.values.iter()) {
            sum.update(&value.to_bits().to_le_bytes());
        }
    }
    let drawn = (ARITHMETIC, sum.finalize());
    assert_eq!(
        drawn,
        FILMS,
        "bits of pictures moved: raise `part::ARITHMETIC` and write ({}, {:#010x}) into `part::FILMS`",
        ARITHMETIC + u32::from(ARITHMETIC == FILMS.0),
        drawn.1,
    );
}
