//! From linear values to levels, right and wrong.

use phong::math::wide;
use phong_scene::{Rgb, srgb_encode};

/// How linear values become levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tone {
    /// Clamped, then the sRGB curve.
    Right,
    Missing,
    Twice,
    Power22,
    /// x / (1 + x) of each channel.
    Reinhard,
    /// The same of the luminance, the colour kept.
    ReinhardLuminance,
    /// 1 − exp(−x).
    Exponential,
    /// A fit of a film's curve that games use (Narkowicz 2015).
    Filmic,
    /// Divided by the largest channel where that is above 1.
    ByLargest,
    /// Levels above 255 begin at 0 again.
    Overflow,
    /// The same, levels cut to whole numbers instead of rounded.
    OverflowCut,
    /// The same for linear values, which are clamped to 1 by nobody but the byte, then the curve.
    OverflowBefore,
}

/// Linear values as levels in [0, 1].
pub(super) fn encode(color: Rgb, tone: Tone) -> [f32; 3] {
    let each = |f: &dyn Fn(f64) -> f64| color.to_array().map(|v| f(f64::from(v)) as f32);
    let curve = |v: f64| srgb_encode(v.clamp(0.0, 1.0));
    let luminance = || f64::from(color.luminance()).max(0.0);
    match tone {
        Tone::Right => each(&curve),
        Tone::Missing => each(&|v| v.clamp(0.0, 1.0)),
        Tone::Twice => each(&|v| curve(curve(v))),
        Tone::Power22 => each(&|v| wide::pow(v.clamp(0.0, 1.0), 1.0 / 2.2)),
        Tone::Reinhard => each(&|v| curve(v.max(0.0) / (1.0 + v.max(0.0)))),
        Tone::ReinhardLuminance => {
            let by = 1.0 / (1.0 + luminance());
            each(&|v| curve(v * by))
        }
        Tone::Exponential => each(&|v| curve(1.0 - wide::exp(-v.max(0.0)))),
        Tone::Filmic => each(&|v| {
            let v = v.max(0.0);
            curve(v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14))
        }),
        Tone::ByLargest => {
            let by = 1.0 / f64::from(color.max_channel()).max(1.0);
            each(&|v| curve(v * by))
        }
        Tone::Overflow => each(&|v| (255.0 * unclamped(v) + 0.5).floor().rem_euclid(256.0) / 255.0),
        Tone::OverflowCut => each(&|v| (255.0 * unclamped(v)).floor().rem_euclid(256.0) / 255.0),
        Tone::OverflowBefore => {
            each(&|v| curve((255.0 * v.max(0.0) + 0.5).floor().rem_euclid(256.0) / 255.0))
        }
    }
}

/// The sRGB curve, which goes on as it is above 1.
fn unclamped(v: f64) -> f64 {
    if v <= 1.0 { srgb_encode(v.max(0.0)) } else { 1.055 * wide::pow(v, 1.0 / 2.4) - 0.055 }
}
