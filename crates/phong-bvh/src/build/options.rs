//! How to build, and what can be wrong with it.

use thiserror::Error;

use super::MOST_OF_ONE;
use crate::Level;

/// How to build.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BuildOptions {
    /// How much time to spend on a better tree.
    pub preset: Preset,
    /// The vector instructions to use, by building and tracing. None: those that the environment
    /// variable `PHONG_SIMD` names, and without it the fastest of this machine.
    pub level: Option<Level>,
}

impl BuildOptions {
    /// The level that is used: see [`level`](Self::level).
    ///
    /// # Errors
    /// [`BuildError::NoSuchLevel`] and [`BuildError::UnknownLevel`].
    pub fn level_used(&self) -> Result<Level, BuildError> {
        let level = match (self.level, std::env::var_os("PHONG_SIMD")) {
            (Some(level), _) => level,
            (None, Some(name)) if !name.is_empty() => level_named(&name.to_string_lossy())?,
            (None, _) => return Ok(Level::detect()),
        };
        if level.is_available() { Ok(level) } else { Err(BuildError::NoSuchLevel(level)) }
    }
}

/// The level that the environment asks for.
fn level_named(name: &str) -> Result<Level, BuildError> {
    let named = match name {
        "scalar" => Some(Level::Scalar),
        "sse4.2" => Some(Level::Sse42),
        "avx2" => Some(Level::Avx2),
        "avx512" => Some(Level::Avx512),
        "neon" => Some(Level::Neon),
        "simd128" => Some(Level::Simd128),
        _ => None,
    };
    named.ok_or_else(|| BuildError::UnknownLevel(name.to_owned()))
}

/// How much time to spend on a better tree. The preset never changes a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// Soonest built: for fewer than two rays a primitive.
    Fast,
    /// The usual choice.
    #[default]
    Balanced,
    /// Fastest to trace.
    Best,
    /// Least memory.
    Compact,
}

impl Preset {
    /// The preset that takes the least time in all for so many primitives and rays, of every kind and
    /// in all samples of all pictures: [`Fast`](Self::Fast) up to two rays a primitive, then
    /// [`Balanced`](Self::Balanced).
    ///
    /// A function of the two numbers alone, so that a tree is the same on every machine.
    ///
    /// ```
    /// use phong_bvh::Preset;
    ///
    /// let rays = 2 * 1920 * 1080;
    /// assert_eq!(Preset::for_rays(20_000_000, rays), Preset::Fast);
    /// assert_eq!(Preset::for_rays(1_000_000, rays), Preset::Balanced);
    /// ```
    pub const fn for_rays(primitives: u64, rays: u64) -> Self {
        // Measured on spheres and meshes (NOTES.md): a ray loses half of the time that a primitive
        // saves.
        if rays / 2 < primitives { Self::Fast } else { Self::Balanced }
    }
}

/// Why a hierarchy could not be built.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum BuildError {
    /// More primitives than numbers, in one object or in all that are not instances: the caller's fault.
    #[error(
        "{0} primitives are too many: one mesh or cloud holds at most {of_one}, all that are written \
         one by one {all}",
        of_one = MOST_OF_ONE,
        all = u32::MAX - 1
    )]
    TooMany(u64),
    /// An infinite plane in the tree of an object, which has bounds: the caller's fault.
    #[error("an infinite plane has no bounds: it cannot be part of an instance")]
    Unbounded,
    /// A part's transform flattens it, or is not finite: the caller's fault.
    #[error("the transform of part {0} has no inverse")]
    NoInverse(u32),
    /// The level asked for is not one of this machine: the caller's fault.
    #[error("this machine has no level {0:?}; leave the level (PHONG_SIMD) out to use its fastest")]
    NoSuchLevel(Level),
    /// The environment variable `PHONG_SIMD` names no level: the user's fault.
    #[error(
        "PHONG_SIMD is {0:?}: it names vector instructions, one of scalar, sse4.2, avx2, avx512, \
         neon and simd128; without it the fastest of this machine are used"
    )]
    UnknownLevel(String),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_environment_names_levels_and_a_word_that_names_none_is_told() {
        assert_eq!(level_named("scalar"), Ok(Level::Scalar));
        assert_eq!(level_named("sse4.2"), Ok(Level::Sse42));
        let told = level_named("sse9").unwrap_err().to_string();
        assert!(told.starts_with("PHONG_SIMD is \"sse9\""), "{told}");
    }

    #[test]
    fn a_level_that_is_asked_for_is_used_if_the_machine_has_it() {
        let asked = |level| BuildOptions { level: Some(level), ..BuildOptions::default() };
        assert_eq!(asked(Level::Scalar).level_used(), Ok(Level::Scalar));
        let foreign = if cfg!(target_arch = "x86_64") { Level::Neon } else { Level::Avx2 };
        assert_eq!(asked(foreign).level_used(), Err(BuildError::NoSuchLevel(foreign)));
    }
}
