//! How different two colours look: CIELAB, and CIEDE2000 in it.
//!
//! A difference of 1 is about the least that is seen side by side; 2.3 is seen at a glance.

use phong::math::wide::{atan2, cos, exp, pow, sin_cos};

/// A colour of CIELAB under D65: lightness from 0 to 100, green to red, blue to yellow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab {
    /// L*, 0 black and 100 white.
    pub l: f64,
    /// a*, towards red.
    pub a: f64,
    /// b*, towards yellow.
    pub b: f64,
}

/// CIE XYZ of Rec. 709's primaries under D65, a row each (IEC 61966-2-1).
const XYZ: [[f64; 3]; 3] =
    [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
/// 25⁷, where the corrections for chroma turn.
const TURN: f64 = 6_103_515_625.0;
/// Where CIELAB's cube root gives way to a line.
const KNEE: f64 = 6.0 / 29.0;

impl Lab {
    /// The colour of linear values, clamped to [0, 1] as a display does.
    ///
    /// ```
    /// let white = phong_lab::compare::Lab::of_linear([1.0; 3]);
    /// assert!((white.l - 100.0).abs() < 1e-9 && white.a.abs() < 1e-9);
    /// ```
    pub fn of_linear(rgb: [f64; 3]) -> Self {
        let rgb = rgb.map(|v| v.clamp(0.0, 1.0));
        // White is the sum of a row: grey is then exactly grey.
        let [x, y, z] = XYZ.map(|[r, g, b]| {
            let root = |t: f64| {
                if t > KNEE * KNEE * KNEE {
                    libm::cbrt(t)
                } else {
                    t / (3.0 * KNEE * KNEE) + 4.0 / 29.0
                }
            };
            root((r * rgb[0] + g * rgb[1] + b * rgb[2]) / (r + g + b))
        });
        Self { l: 116.0 * y - 16.0, a: 500.0 * (x - y), b: 200.0 * (y - z) }
    }

    /// The linear values of this colour, which may lie outside of [0, 1].
    pub fn to_linear(self) -> [f64; 3] {
        let y = (self.l + 16.0) / 116.0;
        let roots = [y + self.a / 500.0, y, y - self.b / 200.0];
        let mut xyz =
            roots.map(|t| if t > KNEE { t * t * t } else { 3.0 * KNEE * KNEE * (t - 4.0 / 29.0) });
        for (v, row) in xyz.iter_mut().zip(XYZ) {
            *v *= row.iter().sum::<f64>();
        }
        solve(XYZ, xyz)
    }
}

/// `m⁻¹ y`, by Cramer's rule.
fn solve(m: [[f64; 3]; 3], y: [f64; 3]) -> [f64; 3] {
    let det = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = det(m);
    std::array::from_fn(|column| {
        let mut replaced = m;
        for (row, y) in replaced.iter_mut().zip(y) {
            row[column] = y;
        }
        det(replaced) / whole
    })
}

/// CIEDE2000, ΔE₀₀, with all weights 1 (CIE 142-2001).
///
/// The letters and their order are the standard's: chroma corrected for greys (`G`), hues in
/// degrees, then the three differences with their weights `S` and the rotation `R_T` for blues.
pub fn delta_e_2000(one: Lab, two: Lab) -> f64 {
    if one == two {
        return 0.0;
    }
    let seventh = |c: f64| {
        let c7 = pow(c, 7.0);
        (c7 / (c7 + TURN)).sqrt()
    };
    let chroma = |a: f64, b: f64| (a * a + b * b).sqrt();
    let mean_c = 0.5 * (chroma(one.a, one.b) + chroma(two.a, two.b));
    let g = 0.5 * (1.0 - seventh(mean_c));
    let [(c_1, h_1), (c_2, h_2)] = [one, two].map(|lab| {
        let a = (1.0 + g) * lab.a;
        let hue = atan2(lab.b, a).to_degrees();
        (chroma(a, lab.b), if hue < 0.0 { hue + 360.0 } else { hue })
    });
    let grey = c_1 * c_2 == 0.0;
    let turn = match h_2 - h_1 {
        _ if grey => 0.0,
        turn if turn > 180.0 => turn - 360.0,
        turn if turn < -180.0 => turn + 360.0,
        turn => turn,
    };
    let delta_l = two.l - one.l;
    let delta_c = c_2 - c_1;
    let (half_turn, _) = sin_cos((0.5 * turn).to_radians());
    let delta_h = 2.0 * (c_1 * c_2).sqrt() * half_turn;

    let (mean_l, mean_c) = (0.5 * (one.l + two.l), 0.5 * (c_1 + c_2));
    let mean_h = match h_1 + h_2 {
        sum if grey => sum,
        sum if (h_1 - h_2).abs() <= 180.0 => 0.5 * sum,
        sum if sum < 360.0 => 0.5 * (sum + 360.0),
        sum => 0.5 * (sum - 360.0),
    };
    let wave = |times: f64, minus: f64| cos((times * mean_h - minus).to_radians());
    let t = 1.0 - 0.17 * wave(1.0, 30.0) + 0.24 * wave(2.0, 0.0) + 0.32 * wave(3.0, -6.0)
        - 0.20 * wave(4.0, 63.0);
    let from_50 = (mean_l - 50.0) * (mean_l - 50.0);
    let s_l = 1.0 + 0.015 * from_50 / (20.0 + from_50).sqrt();
    let s_c = 1.0 + 0.045 * mean_c;
    let s_h = 1.0 + 0.015 * mean_c * t;
    let from_blue = (mean_h - 275.0) / 25.0;
    let (turned, _) = sin_cos((60.0 * exp(-from_blue * from_blue)).to_radians());
    let r_t = -2.0 * seventh(mean_c) * turned;
    let (l, c, h) = (delta_l / s_l, delta_c / s_c, delta_h / s_h);
    (l * l + c * c + h * h + r_t * c * h).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs that reach every branch of the formula, and their differences: the data of Sharma,
    /// Wu and Dalal, "The CIEDE2000 color-difference formula", Color Res. Appl. 30 (2005).
    const PUBLISHED: [([f64; 3], [f64; 3], f64); 34] = [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 3.1571, -77.2803], [50.0, 0.0, -82.7485], 2.8615),
        ([50.0, 2.8361, -74.0200], [50.0, 0.0, -82.7485], 3.4412),
        ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0000),
        ([50.0, -1.1848, -84.8006], [50.0, 0.0, -82.7485], 1.0000),
        ([50.0, -0.9009, -85.5211], [50.0, 0.0, -82.7485], 1.0000),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, -1.0, 2.0], [50.0, 0.0, 0.0], 2.3669),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0009], 7.1792),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0010], 7.1792),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0011], 7.2195),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0012], 7.2195),
        ([50.0, -0.0010, 2.4900], [50.0, 0.0009, -2.4900], 4.8045),
        ([50.0, -0.0010, 2.4900], [50.0, 0.0010, -2.4900], 4.8045),
        ([50.0, -0.0010, 2.4900], [50.0, 0.0011, -2.4900], 4.7461),
        ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
        ([50.0, 2.5, 0.0], [61.0, -5.0, 29.0], 22.8977),
        ([50.0, 2.5, 0.0], [56.0, -27.0, -3.0], 31.9030),
        ([50.0, 2.5, 0.0], [58.0, 24.0, 15.0], 19.4535),
        ([50.0, 2.5, 0.0], [50.0, 3.1736, 0.5854], 1.0000),
        ([50.0, 2.5, 0.0], [50.0, 3.2972, 0.0], 1.0000),
        ([50.0, 2.5, 0.0], [50.0, 1.8634, 0.5757], 1.0000),
        ([50.0, 2.5, 0.0], [50.0, 3.2592, 0.3350], 1.0000),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ([63.0109, -31.0961, -5.8663], [62.8187, -29.7946, -4.0864], 1.2630),
        ([61.2901, 3.7196, -5.3901], [61.4292, 2.2480, -4.9620], 1.8731),
        ([35.0831, -44.1164, 3.7933], [35.0232, -40.0716, 1.5901], 1.8645),
        ([22.7233, 20.0904, -46.6940], [23.0331, 14.9730, -42.5619], 2.0373),
        ([36.4612, 47.8580, 18.3852], [36.2715, 50.5065, 21.2231], 1.4146),
        ([90.8027, -2.0831, 1.4410], [91.1528, -1.6435, 0.0447], 1.4441),
        ([90.9257, -0.5406, -0.9208], [88.6381, -0.8985, -0.7239], 1.5381),
        ([6.7747, -0.2908, -2.4247], [5.8714, -0.0985, -2.2286], 0.6377),
        ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514], 0.9082),
    ];

    #[test]
    fn the_published_pairs_differ_by_the_published_numbers() {
        let lab = |[l, a, b]: [f64; 3]| Lab { l, a, b };
        for (one, two, expected) in PUBLISHED {
            let found = delta_e_2000(lab(one), lab(two));
            assert!((found - expected).abs() < 5.1e-5, "{one:?} {two:?}: {found}, not {expected}");
            let back = delta_e_2000(lab(two), lab(one));
            assert!((found - back).abs() < 1e-12, "it is symmetric");
        }
    }

    #[test]
    fn known_colours_have_their_published_lab() {
        // sRGB's primaries under D65.
        for (rgb, lab) in [
            ([1.0, 0.0, 0.0], [53.24, 80.09, 67.20]),
            ([0.0, 1.0, 0.0], [87.73, -86.18, 83.18]),
            ([0.0, 0.0, 1.0], [32.30, 79.19, -107.86]),
            ([1.0, 1.0, 1.0], [100.0, 0.0, 0.0]),
            ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        ] {
            let Lab { l, a, b } = Lab::of_linear(rgb);
            for (found, expected) in [l, a, b].into_iter().zip(lab) {
                assert!((found - expected).abs() < 0.05, "{rgb:?}: {l}, {a}, {b}");
            }
        }
    }

    #[test]
    fn linear_values_come_back_from_lab() {
        for rgb in [[0.0; 3], [0.001, 0.5, 0.9], [1.0, 0.2, 0.003], [1.0; 3]] {
            let back = Lab::of_linear(rgb).to_linear();
            for (v, w) in rgb.into_iter().zip(back) {
                assert!((v - w).abs() < 1e-12, "{rgb:?}: {back:?}");
            }
        }
    }
}
