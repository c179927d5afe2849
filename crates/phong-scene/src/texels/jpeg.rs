//! JPEG: baseline or progressive, in colour or grey.

use std::io::Cursor;

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::allowed::allow;
use super::{TexelValues, Texels};
use crate::limits::Limits;

/// Bytes that a pixel takes at most while it is read: coefficients of a progressive file, and bytes.
const PIXEL: u64 = 3 * (2 + 2 + 1);

/// The pixels, or a clause that says what is wrong.
pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<Texels, String> {
    let broken = |what: &dyn ToString| format!("it is a broken JPEG: {}", what.to_string());
    // Strictly: what is cut short is no image with grey below.
    let options = DecoderOptions::default().set_strict_mode(true);
    let mut headers = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    headers.decode_headers().map_err(|error| broken(&error))?;
    let info = headers.info().ok_or_else(|| broken(&"it has no size"))?;
    let size = [u32::from(info.width), u32::from(info.height)];
    allow(size, PIXEL, limits)?;
    let (channels, space) = match headers.input_colorspace() {
        Some(ColorSpace::Luma) => (1, ColorSpace::Luma),
        Some(ColorSpace::CMYK | ColorSpace::YCCK) => {
            return Err(
                "it is a JPEG of four inks (CMYK), which are no colours of light".to_owned()
            );
        }
        _ => (3, ColorSpace::RGB),
    };
    let options = options.jpeg_set_out_colorspace(space);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    let data = decoder.decode().map_err(|error| broken(&error))?;
    Texels::new(size, channels, TexelValues::Bytes(data)).map_err(|error| error.to_string())
}
