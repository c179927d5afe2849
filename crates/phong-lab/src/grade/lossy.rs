//! What the compression of a JPEG may have changed.
//!
//! Our picture is compressed as theirs was: its blocks are rounded with the steps that their file
//! tells. What that changes of a block of ours, it may have changed of theirs.

use phong::image::Lossy;
use phong::math::wide;

/// A block's values.
type Block = [f64; 64];

/// So much more than it changed of ours compression may have changed of theirs, which is not the
/// same to the last bit.
const MORE: f64 = 1.25;

/// How far each value of a picture may have been moved, encoded (1 is white).
pub(super) fn allowance(
    ours: &[[f32; 3]],
    [width, height]: [u32; 2],
    lossy: &Lossy,
) -> Vec<[f32; 3]> {
    let (w, h) = (width as usize, height as usize);
    let cosines = cosines();
    let plane = |of: &dyn Fn([f64; 3]) -> f64| -> Vec<f64> {
        ours.iter().map(|pixel| of(pixel.map(|v| 255.0 * f64::from(v)))).collect()
    };
    let brightness = plane(&|[r, g, b]| 0.299 * r + 0.587 * g + 0.114 * b);
    let blue = plane(&|[r, g, b]| -0.168_736 * r - 0.331_264 * g + 0.5 * b);
    let red = plane(&|[r, g, b]| 0.5 * r - 0.418_688 * g - 0.081_312 * b);
    let [fine, coarse] = &lossy.steps;
    let shared = lossy.block.map(|side| usize::from(side / 8).max(1));
    let moved = [(&brightness, fine, [1, 1]), (&blue, coarse, shared), (&red, coarse, shared)]
        .map(|(plane, steps, shared)| compressed(plane, [w, h], steps, shared, &cosines));
    let usual = usual(fine) + 1.8 * usual(coarse);
    // By how much each channel moved, and the most of its block.
    let off = |i: usize| {
        let [y, cb, cr] =
            [moved[0][i] - brightness[i], moved[1][i] - blue[i], moved[2][i] - red[i]];
        [y + 1.402 * cr, y - 0.344_136 * cb - 0.714_136 * cr, y + 1.772 * cb]
    };
    let across = w.div_ceil(8);
    let mut most = vec![[0.0_f64; 3]; across * h.div_ceil(8)];
    for i in 0..w * h {
        let block = &mut most[i / w / 8 * across + i % w / 8];
        for (most, off) in block.iter_mut().zip(off(i)) {
            *most = most.max(off.abs());
        }
    }
    let allowed = |i: usize| {
        most[i / w / 8 * across + i % w / 8].map(|m| ((MORE * m + usual) / 255.0) as f32)
    };
    (0..w * h).map(allowed).collect()
}

/// Twice the deviation that rounding the ten lowest coefficients leaves: what smooth surfaces lose.
fn usual(steps: &[u16; 64]) -> f64 {
    let low = (0..64).filter(|i| i / 8 + i % 8 < 4);
    let variance: f64 = low.map(|i| f64::from(steps[i]) * f64::from(steps[i]) / 12.0).sum();
    2.0 * variance.sqrt() / 8.0
}

/// A plane as it comes back from its blocks, of which each value stands for `shared` pixels.
fn compressed(
    plane: &[f64],
    [w, h]: [usize; 2],
    steps: &[u16; 64],
    shared: [usize; 2],
    cosines: &Block,
) -> Vec<f64> {
    let mut out = vec![0.0; plane.len()];
    let [across, down] = [8 * shared[0], 8 * shared[1]];
    for top in (0..h).step_by(down) {
        for left in (0..w).step_by(across) {
            let mut block = [0.0; 64];
            for (k, value) in block.iter_mut().enumerate() {
                let (x, y) = (left + k % 8 * shared[0], top + k / 8 * shared[1]);
                let mut sum = 0.0;
                for v in 0..shared[1] {
                    for u in 0..shared[0] {
                        // Beyond the border the last pixel goes on.
                        sum += plane[(y + v).min(h - 1) * w + (x + u).min(w - 1)];
                    }
                }
                *value = sum / (shared[0] * shared[1]) as f64;
            }
            let mut coefficients = transformed(&block, cosines, false);
            for (coefficient, &step) in coefficients.iter_mut().zip(steps) {
                let step = f64::from(step.max(1));
                *coefficient = (*coefficient / step).round() * step;
            }
            let back = transformed(&coefficients, cosines, true);
            for y in top..(top + down).min(h) {
                for x in left..(left + across).min(w) {
                    let (u, v) = ((x - left) / shared[0], (y - top) / shared[1]);
                    out[y * w + x] = back[8 * v + u];
                }
            }
        }
    }
    out
}

/// The cosine transform's matrix, orthonormal: a row a frequency.
fn cosines() -> Block {
    std::array::from_fn(|i| {
        let (frequency, place) = ((i / 8) as f64, (i % 8) as f64);
        let scale: f64 = if i < 8 { 0.125 } else { 0.25 };
        scale.sqrt() * wide::cos((2.0 * place + 1.0) * frequency * std::f64::consts::PI / 16.0)
    })
}

/// A block's coefficients, or the block of these coefficients.
fn transformed(block: &Block, cosines: &Block, back: bool) -> Block {
    let weight = |to: usize, from: usize| {
        if back { cosines[8 * from + to] } else { cosines[8 * to + from] }
    };
    let mut rows = [0.0; 64];
    for (i, sum) in rows.iter_mut().enumerate() {
        *sum = (0..8).map(|k| weight(i % 8, k) * block[i / 8 * 8 + k]).sum();
    }
    let mut out = [0.0; 64];
    for (i, sum) in out.iter_mut().enumerate() {
        *sum = (0..8).map(|k| weight(i / 8, k) * rows[8 * k + i % 8]).sum();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_comes_back_from_its_coefficients() {
        let block: Block = std::array::from_fn(|i| ((37 * i) % 101) as f64);
        let cosines = cosines();
        let coefficients = transformed(&block, &cosines, false);
        assert!((coefficients[0] - block.iter().sum::<f64>() / 8.0).abs() < 1e-9);
        let back = transformed(&coefficients, &cosines, true);
        assert!(back.iter().zip(block).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    #[test]
    fn edges_may_move_further_than_smooth_surfaces() {
        let ours: Vec<[f32; 3]> = (0..16 * 8)
            .map(|i| if i % 16 < 8 { [0.5; 3] } else { [f32::from(u8::from(i % 3 == 0)); 3] })
            .collect();
        let lossy = Lossy { steps: [[20; 64]; 2], block: [8, 8] };
        let allowed = allowance(&ours, [16, 8], &lossy);
        assert!(allowed[0][0] < 0.1 && allowed[8][0] > 1.5 * allowed[0][0], "{allowed:?}");
    }
}
