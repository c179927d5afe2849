//! How large an image may be, told before it is decoded.

use crate::limits::Limits;

/// Whether an image of this size may be read, `bytes` being what a pixel of it takes.
pub(super) fn allow(size: [u32; 2], bytes: u64, limits: &Limits) -> Result<(), String> {
    let [width, height] = size;
    if width == 0 || height == 0 {
        return Err(format!("it has no pixels: it is {width} × {height}"));
    }
    let pixels = u64::from(width) * u64::from(height);
    if pixels > limits.image_pixels {
        let most = limits.image_pixels;
        return Err(format!("it is {width} × {height}: more than {most} pixels"));
    }
    let needed = pixels.saturating_mul(bytes);
    if needed > limits.bytes {
        let most = limits.bytes;
        return Err(format!("its pixels take {needed} bytes, over the limit of {most}"));
    }
    Ok(())
}
