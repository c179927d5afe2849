//! What other programs mean by "Phong": presets of a material's five switches.
//!
//! The model fixes the lobe and `shininess` is always the exponent that is applied, so a dialect
//! says only the rest: whether the highlight is multiplied by N·L, whether the lobe is normalised,
//! what tints it, how often ambient light is added, and where the highlight is seen from. Each row
//! was read in that program's own source or specification.
//!
//! | name | lobe | × N·L | normalised | tint | ambient | viewer |
//! |---|---|---|---|---|---|---|
//! | `lecture` | any | no | no | light | once | local |
//! | `mtl` | N·H | no | no | light | once | local |
//! | `pov-ray` | R·E (`phong`) or N·H (`specular`) | no | no | light | once | local |
//! | `tachyon` | N·H, R·E with `-shade_phong`, N·H fast with `-shade_blinn_fast` | no | no | light | once | local |
//! | `tachyon-metal` | as `tachyon` | no | no | object | once | local |
//! | `vtk` | R·E | no | no | light | once | local |
//! | `opengl` | N·H | no | no | light | both | distant |
//! | `direct3d9` | N·H | no | no | light | both | local |
//! | `ospray` | N·H | no | yes | light | once | local |
//! | `three-js` | N·H | yes | yes | light | once | local |
//! | `pymol` | N·H | no | no | light | once | distant |
//! | `x3d` | N·H | no | no | light | per light | local |
//! | `collada` | R·E (`phong`) or N·H (`blinn`) | no | no | light | once | local |
//! | `rtc` | R·E | no | no | light | per light | local |
//!
//! POV-Ray's keywords are switches by themselves: `metallic` is `tint = "metallic"`, `albedo` is
//! `normalize = true`. OpenGL's viewer is distant unless `GL_LIGHT_MODEL_LOCAL_VIEWER` says
//! otherwise, PyMOL's unless `ray_spec_local` does.
//!
//! three.js multiplies its lobe by Schlick's F, so that in `three-js` a `blinn-phong` material *is*
//! one of facets: Blinn's distribution of exponent `shininess`, `shadowing = "implicit"`, and `f0` =
//! `k_s` × `specular_color`. It becomes that as it is read, and its switches cannot be set.

use crate::material::{AmbientRule, Dialect, Distribution, Model, Shadowing, Tint, Viewer};
use crate::wording::{Word, words};

/// The five switches that a dialect presets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Switches {
    /// Whether the specular term is multiplied by N·L.
    pub times_cosine: bool,
    /// Whether the lobe is scaled so that its energy does not depend on the exponent.
    pub normalize: bool,
    /// What tints the highlight.
    pub tint: Tint,
    /// How often the ambient term is added.
    pub ambient_rule: AmbientRule,
    /// Where highlights are seen from.
    pub viewer: Viewer,
}

words!(Dialect {
    "lecture" = Lecture,
    "mtl" = Mtl,
    "pov-ray" = PovRay,
    "tachyon" = Tachyon,
    "tachyon-metal" = TachyonMetal,
    "vtk" = Vtk,
    "opengl" = OpenGl,
    "direct3d9" = Direct3d9,
    "ospray" = Ospray,
    "three-js" = ThreeJs,
    "pymol" = Pymol,
    "x3d" = X3d,
    "collada" = Collada,
    "rtc" = Rtc,
});

impl Dialect {
    /// Every dialect, the lecture's first.
    pub const ALL: [Self; 14] = [
        Self::Lecture,
        Self::Mtl,
        Self::PovRay,
        Self::Tachyon,
        Self::TachyonMetal,
        Self::Vtk,
        Self::OpenGl,
        Self::Direct3d9,
        Self::Ospray,
        Self::ThreeJs,
        Self::Pymol,
        Self::X3d,
        Self::Collada,
        Self::Rtc,
    ];

    /// Its name in the scene text.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.word()
    }

    /// The dialect of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::of_word(name)
    }

    /// The switches it presets.
    ///
    /// ```
    /// use phong_scene::{Dialect, Tint};
    /// assert_eq!(Dialect::TachyonMetal.switches().tint, Tint::Object);
    /// assert!(Dialect::ThreeJs.switches().times_cosine);
    /// ```
    #[must_use]
    pub fn switches(self) -> Switches {
        Switches {
            times_cosine: self == Self::ThreeJs,
            normalize: matches!(self, Self::Ospray | Self::ThreeJs),
            tint: if self == Self::TachyonMetal { Tint::Object } else { Tint::Light },
            ambient_rule: match self {
                Self::OpenGl | Self::Direct3d9 => AmbientRule::Both,
                Self::X3d | Self::Rtc => AmbientRule::PerLight,
                _ => AmbientRule::Once,
            },
            viewer: match self {
                Self::OpenGl | Self::Pymol => Viewer::Distant,
                _ => Viewer::Local,
            },
        }
    }

    /// Whether a material of this model can be meant in this dialect: its lobe is one the program
    /// has. Lambert's has no lobe and suits all; the lecture's own suits every model.
    #[must_use]
    pub fn allows(self, model: &Model) -> bool {
        match model {
            _ if self == Self::Lecture => true,
            Model::Lambert => true,
            Model::Phong => matches!(
                self,
                Self::PovRay
                    | Self::Tachyon
                    | Self::TachyonMetal
                    | Self::Vtk
                    | Self::Collada
                    | Self::Rtc
            ),
            Model::BlinnPhong => !matches!(self, Self::Vtk | Self::Rtc),
            Model::BlinnFast => matches!(self, Self::Tachyon | Self::TachyonMetal),
            Model::Microfacet {
                distribution: Distribution::Blinn,
                shadowing: Shadowing::Implicit,
                ..
            } => self == Self::ThreeJs,
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dialect_is_found_by_its_name() {
        for dialect in Dialect::ALL {
            assert_eq!(Dialect::from_name(dialect.name()), Some(dialect));
        }
    }

    #[test]
    fn the_lecture_leaves_every_switch_off() {
        assert_eq!(Dialect::Lecture.switches(), Switches::default());
    }

    #[test]
    fn a_dialect_allows_the_lobes_its_program_has() {
        assert!(!Dialect::Mtl.allows(&Model::Phong), "MTL's lobe is N·H");
        assert!(Dialect::Mtl.allows(&Model::BlinnPhong));
        assert!(!Dialect::Vtk.allows(&Model::BlinnPhong), "VTK's lobe is R·E");
        for dialect in Dialect::ALL {
            let lobes = [Model::Phong, Model::BlinnPhong].map(|model| dialect.allows(&model));
            assert!(lobes.contains(&true), "{} has some lobe", dialect.name());
        }
    }

    /// The table in the module's doc is what users read; it must be what the code does.
    #[test]
    fn the_table_above_says_what_the_code_does() {
        let source = include_str!("dialect.rs");
        for dialect in Dialect::ALL {
            let start = format!("//! | `{}` |", dialect.name());
            let row = source.lines().find(|line| line.starts_with(&start)).expect("a row");
            let cells: Vec<_> = row.trim_start_matches("//! ").split('|').map(str::trim).collect();
            let Switches { times_cosine, normalize, tint, ambient_rule, viewer } =
                dialect.switches();
            let yes = |b| if b { "yes" } else { "no" };
            assert_eq!(cells[3], yes(times_cosine), "{row}");
            assert_eq!(cells[4], yes(normalize), "{row}");
            assert_eq!(cells[5], if tint == Tint::Object { "object" } else { "light" }, "{row}");
            let ambient = match ambient_rule {
                AmbientRule::Once => "once",
                AmbientRule::PerLight => "per light",
                AmbientRule::Both => "both",
            };
            assert_eq!(cells[6], ambient, "{row}");
            let distant = viewer == Viewer::Distant;
            assert_eq!(cells[7], if distant { "distant" } else { "local" }, "{row}");
        }
    }
}
