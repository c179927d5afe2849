//! How large an image may be, told before it is decoded.

use std::collections::BTreeMap;
use std::ptr;

use super::{TexelValues, Texels};
use crate::limits::Limits;

impl Texels {
    /// Bytes that its numbers take, and those of its halves, which are made when they are needed.
    pub(crate) fn bytes(&self) -> u64 {
        let size = match self.values {
            TexelValues::Bytes(_) => 1,
            TexelValues::Shorts(_) => 2,
            TexelValues::Floats(_) => 4,
        };
        with_halves(size * self.values.len() as u64)
    }

    /// [`Texels::bytes`] of all of these, each once however often it is among them.
    pub(crate) fn bytes_of<'a>(all: impl Iterator<Item = &'a Self>) -> u64 {
        let each: BTreeMap<_, _> = all.map(|texels| (ptr::from_ref(texels), texels)).collect();
        each.into_values().map(Self::bytes).fold(0, u64::saturating_add)
    }

    /// The limits of the next image where `all` are in memory already: together they stay within `limits`.
    pub(crate) fn left<'a>(limits: &Limits, all: impl Iterator<Item = &'a Self>) -> Limits {
        let taken = Self::bytes_of(all);
        Limits { bytes: limits.bytes.saturating_sub(taken), ..limits.clone() }
    }
}

/// Bytes of an image together with its half, the half of that and so on, a quarter each.
fn with_halves(bytes: u64) -> u64 {
    bytes.saturating_add(bytes / 3)
}

/// Whether an image of this size may be read or made, `bytes` being what a pixel of it takes.
pub(crate) fn allow(size: [u32; 2], bytes: u64, limits: &Limits) -> Result<(), String> {
    let [width, height] = size;
    if width == 0 || height == 0 {
        return Err(format!("it has no pixels: it is {width} × {height}"));
    }
    let pixels = u64::from(width) * u64::from(height);
    if pixels > limits.image_pixels {
        let most = limits.image_pixels;
        return Err(format!("it is {width} × {height}: more than {most} pixels"));
    }
    let needed = with_halves(pixels.saturating_mul(bytes));
    if needed > limits.bytes {
        let most = limits.bytes;
        return Err(format!(
            "its pixels and halves take {needed} bytes, over the {most} that are left of the limit"
        ));
    }
    Ok(())
}
