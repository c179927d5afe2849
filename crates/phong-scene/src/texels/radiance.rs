//! Radiance HDR: three floats a pixel that share an exponent.

use std::io::Cursor;

use zune_hdr::HdrDecoder;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::allowed::allow;
use super::{TexelValues, Texels};
use crate::limits::Limits;

/// The largest side that a header may say: the pixels are counted besides.
const MOST_SIDE: usize = 1 << 20;

/// The pixels, or a clause that says what is wrong.
pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<Texels, String> {
    let broken = |error: &dyn std::fmt::Debug| format!("it is a broken HDR: {error:?}");
    let options = DecoderOptions::default().set_max_width(MOST_SIDE).set_max_height(MOST_SIDE);
    let mut decoder = HdrDecoder::new_with_options(Cursor::new(bytes), options);
    decoder.decode_headers().map_err(|error| broken(&error))?;
    let (width, height) = decoder.dimensions().ok_or("it is a broken HDR: it has no size")?;
    let size = [width, height].map(|side| side as u32);
    allow(size, 3 * 4, limits)?;
    let values = decoder.decode().map_err(|error| broken(&error))?;
    Texels::new(size, 3, TexelValues::Floats(values)).map_err(|error| error.to_string())
}
