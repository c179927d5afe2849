//! Mistakes planted in a student's renderer, each recognised, and a table of what was said.
//!
//! `PHONG_BLESS=1 cargo test -p phong --test grade planted` writes the table, planted.md, anew.

use std::fmt::Write;
use std::path::Path;

use crate::student::{Body, Lamp, Slip, Thing, World};
use crate::{backlit, graded, world};

/// Where a mistake is planted: where it can be seen.
#[derive(Clone, Copy)]
enum Stage {
    /// Three balls on a floor under a lamp and the sun, Phong's lobe.
    Phong,
    /// The same with Blinn's lobe.
    Blinn,
    /// The same without the floor, which would hide it.
    Afloat,
    /// Two balls lit from behind by one lamp, without shadows, which would hide it.
    Backlit,
    /// The floor and a lamp, with a ball above the lamp.
    Above,
}

/// A mistake, in the student's words, and what must be said of it.
struct Planted {
    mistake: &'static str,
    stage: Stage,
    slip: Slip,
    cause: &'static str,
}

const fn planted(mistake: &'static str, stage: Stage, slip: Slip, cause: &'static str) -> Planted {
    Planted { mistake, stage, slip, cause }
}

const PLANTED: [Planted; 30] = [
    planted("R = L − 2(L·N)N", Stage::Phong, Slip::ReflectionSign, "reflection-sign"),
    planted("E towards the surface", Stage::Phong, Slip::EyeBackwards, "reflection-sign"),
    planted("H = L + E", Stage::Blinn, Slip::HalfSum, "half-unnormalized"),
    planted("H = (L + E)/2", Stage::Blinn, Slip::HalfMean, "half-mean"),
    planted("N·L not clamped", Stage::Backlit, Slip::NoDiffuseClamp, "clamp-missing-diffuse"),
    planted("R·E not clamped", Stage::Backlit, Slip::NoSpecularClamp, "clamp-missing-specular"),
    planted("ambient once per light", Stage::Phong, Slip::AmbientPerLight, "ambient-per-light"),
    planted("no ambient term", Stage::Phong, Slip::NoAmbient, "ambient-missing"),
    planted("no ambient in shadow", Stage::Phong, Slip::NoAmbientInShadow, "ambient-not-in-shadow"),
    planted("no diffuse term", Stage::Phong, Slip::NoDiffuse, "diffuse-missing"),
    planted("no specular term", Stage::Phong, Slip::NoSpecular, "specular-missing"),
    planted("normals inside out", Stage::Phong, Slip::InsideOut, "normal-inside-out"),
    planted("sun reversed", Stage::Afloat, Slip::SunReversed, "distant-reversed"),
    planted("no sRGB curve", Stage::Phong, Slip::NoGamma, "gamma-missing"),
    planted("sRGB curve twice", Stage::Phong, Slip::GammaTwice, "gamma-twice"),
    planted("gamma 2.2", Stage::Phong, Slip::Gamma22, "gamma-2.2"),
    planted("rows upside down", Stage::Phong, Slip::UpsideDown, "upside-down"),
    planted("columns reversed", Stage::Phong, Slip::LeftRight, "left-right"),
    planted("blue first", Stage::Phong, Slip::BlueFirst, "blue-first"),
    planted("no shadows", Stage::Phong, Slip::NoShadows, "shadows-missing"),
    planted("endless shadow ray", Stage::Above, Slip::EndlessShadowRay, "shadow-ray-endless"),
    planted("shadow acne", Stage::Phong, Slip::Acne, "shadow-acne"),
    planted("Blinn's lobe for Phong's", Stage::Phong, Slip::BlinnForPhong, "blinn-not-phong"),
    planted("half the exponent", Stage::Phong, Slip::ExponentHalf, "exponent-half"),
    planted("L not normalised", Stage::Phong, Slip::LongL, "light-unnormalized"),
    planted("highlight × colour", Stage::Phong, Slip::TintedHighlight, "specular-tinted"),
    planted("highlight × N·L", Stage::Phong, Slip::HighlightTimesCosine, "specular-times-cosine"),
    planted("first light only", Stage::Phong, Slip::FirstLightOnly, "first-light-only"),
    planted("inverse square", Stage::Phong, Slip::InverseSquare, "inverse-square"),
    planted("fov horizontal", Stage::Phong, Slip::HorizontalFov, "fov-horizontal"),
];

/// The world of a stage, and whether its lights cast shadows.
fn staged(stage: Stage) -> (World, bool) {
    match stage {
        Stage::Phong => (world(false), true),
        Stage::Blinn => (world(true), true),
        Stage::Afloat => {
            let mut world = world(false);
            world.things.truncate(3);
            (world, true)
        }
        Stage::Backlit => {
            let mut world = backlit();
            world.lamps.truncate(1);
            (world, false)
        }
        Stage::Above => {
            let mut world = world(false);
            world.lamps[0] = Lamp::Point { at: [0.0, 3.0, 2.0], color: 0.6 };
            let floor = world.things.len() - 1;
            let above = Body::Sphere { c: [0.0, 7.0, 3.0], r: 2.5 };
            world.things.insert(floor, Thing { body: above, ..world.things[floor] });
            (world, true)
        }
    }
}

#[test]
fn every_planted_mistake_is_recognised_and_the_table_says_so() {
    let mut table = "| planted | named | confidence | off by, without it → with it (rms of 255) \
                     | next best |\n|---|---|---|---|---|\n"
        .to_owned();
    for Planted { mistake, stage, slip, cause } in &PLANTED {
        let (world, shadows) = staged(*stage);
        let told = graded(&world, shadows, *slip);
        assert!(!told.pass, "{mistake} passes: {:?}", told.residual);
        let list: Vec<_> =
            told.candidates.iter().map(|c| (&c.cause, c.residual.rms * 255.0)).collect();
        assert_eq!(told.cause.as_deref(), Some(*cause), "{mistake}: {list:?}");
        let next = told.candidates.get(1);
        writeln!(
            table,
            "| {mistake} | `{cause}` | {:.2} | {:.1} → {:.1} | {} |",
            told.confidence,
            255.0 * told.residual.rms,
            255.0 * told.candidates[0].residual.rms,
            next.map_or("-".to_owned(), |c| format!("`{}` {:.1}", c.cause, 255.0 * c.residual.rms))
        )
        .unwrap();
    }
    println!("{table}");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/grade/planted.md");
    if std::env::var_os("PHONG_BLESS").is_some_and(|v| v == "1") {
        std::fs::write(&path, &table).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert_eq!(written, table, "planted.md is not what is said now; see this file's head");
}
