//! Our `pow` against std's, which differs between platforms, and libm's, which does not.
//!
//! `cargo bench -p phong --bench pow`. Throughput: independent powers of cosines, as a tile asks
//! for them. Latency: each power waits for the one before.

use divan::{Bencher, black_box};
use phong::math::{lobe, pow};

fn main() {
    divan::main();
}

const EXPONENTS: [f32; 3] = [5.0, 32.0, 200.0];

/// 1024 cosines spread over (0, 1], in no order.
fn cosines() -> Vec<f32> {
    (0_u32..1024).map(|i| (i.wrapping_mul(613) % 1024 + 1) as f32 / 1024.0).collect()
}

#[expect(clippy::disallowed_methods, reason = "std is what we are measured against")]
fn std_pow(x: f32, y: f32) -> f32 {
    x.powf(y)
}

fn throughput(bencher: Bencher, alpha: f32, pow: impl Fn(f32, f32) -> f32) {
    let cosines = cosines();
    bencher
        .counter(divan::counter::ItemsCount::new(cosines.len()))
        .bench_local(|| black_box(&cosines).iter().map(|&x| pow(x, black_box(alpha))).sum::<f32>());
}

fn latency(bencher: Bencher, alpha: f32, pow: impl Fn(f32, f32) -> f32) {
    let cosines = cosines();
    bencher.counter(divan::counter::ItemsCount::new(cosines.len())).bench_local(|| {
        // The next base depends on the last power, but only in its last bits.
        black_box(&cosines).iter().fold(0.0, |last, &x| pow(x + last * 1e-9, black_box(alpha)))
    });
}

#[divan::bench(args = EXPONENTS)]
fn throughput_ours(bencher: Bencher, alpha: f32) {
    throughput(bencher, alpha, pow);
}

#[divan::bench(args = EXPONENTS)]
fn throughput_ours_as_lobe(bencher: Bencher, alpha: f32) {
    throughput(bencher, alpha, lobe);
}

#[divan::bench(args = EXPONENTS)]
fn throughput_std(bencher: Bencher, alpha: f32) {
    throughput(bencher, alpha, std_pow);
}

#[divan::bench(args = EXPONENTS)]
fn throughput_libm(bencher: Bencher, alpha: f32) {
    throughput(bencher, alpha, libm::powf);
}

#[divan::bench(args = EXPONENTS)]
fn latency_ours(bencher: Bencher, alpha: f32) {
    latency(bencher, alpha, pow);
}

#[divan::bench(args = EXPONENTS)]
fn latency_std(bencher: Bencher, alpha: f32) {
    latency(bencher, alpha, std_pow);
}
