//! A comparison for programs.

use serde_json::{Value, json};

use super::{Comparison, exceeds};

/// The comparison as one JSON object; `tolerance` bounds the largest difference.
pub fn json(told: &Comparison, tolerance: f64) -> Value {
    let Comparison { max, mean, rms, over_1_255, psnr, worst, channel, .. } = told;
    let pixels = told.pixels_over(tolerance);
    let channels: Vec<Value> = told
        .channels
        .iter()
        .map(|c| {
            let [max, mean, rms] = [c.max, c.mean, c.rms].map(shortest);
            json!({"name": c.name, "max": max, "mean": mean, "rms": rms, "psnr": c.psnr})
        })
        .collect();
    let worst_pixels: Vec<Value> = told
        .worst_pixels
        .iter()
        .map(|p| {
            let [a, b] =
                [&p.a, &p.b].map(|side| side.iter().copied().map(shortest).collect::<Vec<_>>());
            json!({"at": p.at, "difference": shortest(p.difference), "a": a, "b": b})
        })
        .collect();
    let delta_e = told
        .delta_e
        .map(|d| json!({"mean": d.mean, "max": d.max, "worst": d.worst, "over_1": d.over_1}));
    json!({
        "max": shortest(*max),
        "mean": shortest(*mean),
        "rms": shortest(*rms),
        "over_1_255": over_1_255,
        "psnr": psnr,
        "worst": worst,
        "channel": channel,
        "same_size": true,
        "within_tolerance": !exceeds(*max, tolerance),
        "over_tolerance": {
            "pixels": pixels,
            "share": pixels as f64 / told.largest.len() as f64,
        },
        "not_finite": told.not_finite,
        "channels": channels,
        "delta_e_2000": delta_e,
        "worst_pixels": worst_pixels,
    })
}

/// A number as it is told: of one that is an f32, the f64 with the fewest digits that is the same
/// f32, since the digits beyond were never there; and never −0.
pub fn shortest(number: f64) -> f64 {
    let narrow = number as f32;
    let number = if f64::from(narrow) == number {
        narrow.to_string().parse().unwrap_or(number)
    } else {
        number
    };
    number + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_the_digits_it_was_computed_with() {
        assert_eq!(shortest(f64::from(0.1_f32)).to_string(), "0.1");
        assert_eq!(shortest(0.1).to_string(), "0.1");
        assert_eq!(shortest(1.0 / 3.0).to_string(), "0.3333333333333333");
        assert_eq!(shortest(-0.0).to_string(), "0");
        assert_eq!(shortest(f64::INFINITY), f64::INFINITY);
        assert!(shortest(f64::NAN).is_nan());
    }
}
