//! What the corners of a lattice have for themselves: numbers by hashing, the same on every machine.

use glam::DVec3;

/// Farther out than this, in cells, a place has no part of a cell left.
pub(super) const FAR: f64 = 1e15;

/// A number for a corner of the lattice, every bit of which looks random.
pub(super) fn hash([x, y, z]: [i64; 3], seed: u64) -> u64 {
    // Odd constants: the golden ratio's fraction, and primes near other parts of 2^64.
    let mut h = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x51ed_270b_9e3f_6d4d;
    for c in [x, y, z] {
        h = (h ^ c as u64).wrapping_mul(0xd6e8_feb8_6659_fd93);
        h ^= h >> 32;
    }
    h = h.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    h ^ h >> 29
}

/// A number from 0 to 1 of 16 of the bits of a hash.
pub(super) fn share(hash: u64, part: u32) -> f64 {
    f64::from((hash >> (16 * part)) as u16) / 65536.0
}

/// Gradient noise: 0 at each corner, where it rises in a direction of the corner's own.
pub(super) fn noise(p: DVec3, seed: u64) -> f64 {
    let corner = p.floor();
    let part = p - corner;
    let cell = [corner.x as i64, corner.y as i64, corner.z as i64];
    // As smooth as its second derivative at the corners.
    let fade = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
    let at = |x: i64, y: i64, z: i64| {
        let corner = [cell[0] + x, cell[1] + y, cell[2] + z];
        rise(hash(corner, seed), part - DVec3::new(x as f64, y as f64, z as f64))
    };
    let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
    let row = |y: i64, z: i64| mix(at(0, y, z), at(1, y, z), fade.x);
    let layer = |z: i64| mix(row(0, z), row(1, z), fade.y);
    mix(layer(0), layer(1), fade.z)
}

/// How far it has risen this far from a corner: towards the middle of one of twelve edges of a cube.
fn rise(hash: u64, way: DVec3) -> f64 {
    let (a, b) = match (hash >> 8) % 3 {
        0 => (way.y, way.z),
        1 => (way.z, way.x),
        _ => (way.x, way.y),
    };
    let signed = |bit: u32, v: f64| if hash >> bit & 1 == 0 { v } else { -v };
    signed(0, a) + signed(1, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_0_at_corners_and_runs_smoothly_between_them() {
        for corner in [DVec3::ZERO, DVec3::new(3.0, -7.0, 11.0)] {
            assert_eq!(noise(corner, 5), 0.0);
        }
        let at = |x: f64| noise(DVec3::new(x, 0.37, -4.21), 0);
        for i in -2000..2000 {
            let x = f64::from(i) / 500.0;
            assert!((at(x + 1e-4) - at(x)).abs() < 5e-4, "{x}");
        }
        assert_ne!(noise(DVec3::splat(0.4), 0), noise(DVec3::splat(0.4), 1));
    }

    #[test]
    fn hashes_of_neighbours_share_no_bits() {
        for axis in 0..3 {
            let mut differing = 0;
            for i in 0..256 {
                let mut cell = [i, 7 * i, -3 * i];
                let here = hash(cell, 1);
                cell[axis] += 1;
                differing += (here ^ hash(cell, 1)).count_ones();
            }
            let mean = f64::from(differing) / 256.0;
            assert!((mean - 32.0).abs() < 1.0, "axis {axis}: {mean}");
        }
    }
}
