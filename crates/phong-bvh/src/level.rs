//! Which vector instructions the kernels use: picked once, or forced by a test.

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use fearless_simd::Level as Cpu;
use fearless_simd::Simd;

/// A set of vector instructions. Every level gives the same bits; they differ in speed alone.
///
/// A level is offered where it can be tested. A development build has two of x86, [`Scalar`](Self::Scalar) and
/// [`Avx2`](Self::Avx2), since every kernel is compiled once for each. The release build has all, and the gate draws
/// every scene at each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// No vector instructions beyond what the compiler makes of plain code. Not offered by a module of
    /// WebAssembly that has vectors: nobody would run it, and it is larger than they are.
    Scalar,
    /// x86 with SSE4.2: four lanes. Not in a development build.
    Sse42,
    /// x86 with AVX2: eight lanes.
    Avx2,
    /// x86 with AVX-512 as of Ice Lake and Zen 4: eight lanes, more registers, masks of their own.
    /// Not in a development build.
    Avx512,
    /// 64-bit ARM: four lanes.
    Neon,
    /// WebAssembly with 128-bit vectors: four lanes. Whether there are any is said when the module is
    /// compiled.
    Simd128,
}

impl Level {
    /// Every level, slowest first.
    pub const ALL: [Self; 6] =
        [Self::Scalar, Self::Sse42, Self::Avx2, Self::Avx512, Self::Neon, Self::Simd128];

    /// The fastest level of this machine.
    pub fn detect() -> Self {
        let fastest = Self::ALL.into_iter().rev().find(|level| level.is_available());
        fastest.unwrap_or(Self::Scalar)
    }

    /// Whether this machine has it.
    pub fn is_available(self) -> bool {
        Token::of(self).is_some()
    }

    /// Runs `kernel` compiled for this level; where it is not available, for the slowest one that is.
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        Token::of(self).unwrap_or(Token::BASE).run(kernel)
    }
}

/// The proof that the machine has a level, which the vector types ask for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Token {
    #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
    Scalar(fearless_simd::Fallback),
    #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
    Sse42(fearless_simd::x86::Sse4_2),
    #[cfg(target_arch = "x86_64")]
    Avx2(fearless_simd::x86::Avx2),
    #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
    Avx512(fearless_simd::x86::Avx512),
    #[cfg(target_arch = "aarch64")]
    Neon(fearless_simd::aarch64::Neon),
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    Simd128(fearless_simd::wasm32::WasmSimd128),
}

impl Token {
    /// The level that is always there.
    #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
    const BASE: Self = Self::Scalar(fearless_simd::Fallback::new());
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    const BASE: Self = Self::Simd128(fearless_simd::wasm32::WasmSimd128::assume_supported());

    /// The proof for `level`, or none where the machine lacks it.
    pub(crate) fn of(level: Level) -> Option<Self> {
        match level {
            #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
            Level::Scalar => Some(Self::BASE),
            #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
            Level::Sse42 => Cpu::new().as_sse4_2().map(Self::Sse42),
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => Cpu::new().as_avx2().map(Self::Avx2),
            #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
            Level::Avx512 => Cpu::new().as_avx512().map(Self::Avx512),
            #[cfg(target_arch = "aarch64")]
            Level::Neon => Cpu::new().as_neon().map(Self::Neon),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Level::Simd128 => Some(Self::BASE),
            _ => None,
        }
    }

    /// Runs `kernel` compiled for this level.
    #[inline(always)]
    pub(crate) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        #[inline(always)]
        fn at<S: Simd, K: Kernel>(simd: S, kernel: K) -> K::Output {
            simd.vectorize(
                #[inline(always)]
                || kernel.run(simd),
            )
        }
        match self {
            #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
            Self::Scalar(simd) => at(simd, kernel),
            #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
            Self::Sse42(simd) => at(simd, kernel),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(simd) => at(simd, kernel),
            #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
            Self::Avx512(simd) => at(simd, kernel),
            #[cfg(target_arch = "aarch64")]
            Self::Neon(simd) => at(simd, kernel),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Self::Simd128(simd) => at(simd, kernel),
        }
    }
}

/// What runs at a level: a closure that is generic over the level.
pub trait Kernel {
    /// What it returns.
    type Output;

    /// Runs. Must be `#[inline(always)]`, as must all it calls that is vector code.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scalar_level_is_everywhere_and_the_detected_one_is_available() {
        assert!(Level::Scalar.is_available());
        assert!(Level::detect().is_available());
    }
}
