//! Numbers as colours: from near black by violet, red and orange to near white, in steps that look
//! equally large and grow lighter all the way, so that the picture can be read in grey as well.

use std::sync::OnceLock;

use phong::math::wide::sin_cos;

use super::delta_e::{Lab, delta_e_2000};

/// Entries of the map.
const COUNT: usize = 256;
/// Points of the path that are measured for each entry.
const FINE: usize = 16;

/// The colour of a number in [0, 1], in linear values; beyond the ends, that of the end.
pub fn color(t: f64) -> [f32; 3] {
    static MAP: OnceLock<Vec<[f32; 3]>> = OnceLock::new();
    let map = MAP.get_or_init(even);
    map[(t.clamp(0.0, 1.0) * (COUNT - 1) as f64 + 0.5) as usize]
}

/// A path through CIELAB, within the colours of sRGB: lightness grows, hue turns from blue by red
/// to yellow, chroma rises and falls.
fn path(t: f64) -> Lab {
    let (bulge, _) = sin_cos(std::f64::consts::PI * t);
    let (sin, cos) = sin_cos((285.0 + 170.0 * t).to_radians());
    let chroma = 65.0 * bulge;
    Lab { l: 4.0 + 90.0 * t, a: chroma * cos, b: chroma * sin }
}

/// The path at places between which ΔE₀₀ is the same.
fn even() -> Vec<[f32; 3]> {
    let last = (COUNT - 1) * FINE;
    let place = |i: usize| i as f64 / last as f64;
    let mut length = vec![0.0; last + 1];
    for i in 1..=last {
        length[i] = length[i - 1] + delta_e_2000(path(place(i - 1)), path(place(i)));
    }
    let mut at = 0;
    (0..COUNT)
        .map(|entry| {
            let wanted = length[last] * entry as f64 / (COUNT - 1) as f64;
            while at < last && length[at + 1] < wanted {
                at += 1;
            }
            let next = (at + 1).min(last);
            let step = length[next] - length[at];
            let part = if step > 0.0 { (wanted - length[at]) / step } else { 0.0 };
            path(place(at) + part / last as f64).to_linear().map(|v| v as f32)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lab(entry: usize) -> Lab {
        Lab::of_linear(color(entry as f64 / (COUNT - 1) as f64).map(f64::from))
    }

    #[test]
    fn every_step_looks_equally_large() {
        let steps: Vec<f64> =
            (1..COUNT).map(|entry| delta_e_2000(lab(entry - 1), lab(entry))).collect();
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        for (entry, step) in steps.iter().enumerate() {
            assert!((step / mean - 1.0).abs() < 0.02, "step {entry}: {step}, not {mean}");
        }
    }

    #[test]
    fn it_grows_lighter_all_the_way_and_no_colour_is_clipped() {
        for entry in 1..COUNT {
            assert!(lab(entry).l > lab(entry - 1).l, "{entry}");
        }
        for entry in 0..COUNT {
            let rgb = color(entry as f64 / (COUNT - 1) as f64);
            assert!(rgb.iter().all(|v| (0.0..=1.0).contains(v)), "{entry}: {rgb:?}");
        }
    }

    #[test]
    fn beyond_the_ends_it_stays() {
        assert_eq!(color(-1.0), color(0.0));
        assert_eq!(color(7.0), color(1.0));
    }
}
