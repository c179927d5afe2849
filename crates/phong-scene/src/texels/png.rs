//! PNG, of every colour type and depth.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, Transformations};

use super::allowed::allow;
use super::{TexelValues, Texels};
use crate::color::srgb_encode;
use crate::limits::Limits;

/// The pixels, or a clause that says what is wrong. Palettes become colours, depths below 8 bytes.
pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<Texels, String> {
    let broken = |error: png::DecodingError| format!("it is a broken PNG: {error}");
    // What it may allocate for chunks; the pixels are counted below.
    let most = usize::try_from(limits.bytes).unwrap_or(usize::MAX).min(64 << 20);
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), png::Limits { bytes: most });
    decoder.set_transformations(Transformations::EXPAND);
    decoder.ignore_checksums(false);
    let mut reader = decoder.read_info().map_err(broken)?;
    let size = [reader.info().width, reader.info().height];
    let (color, depth) = reader.output_color_type();
    let channels = match color {
        ColorType::Grayscale | ColorType::Indexed => 1,
        ColorType::GrayscaleAlpha => 2,
        ColorType::Rgb => 3,
        ColorType::Rgba => 4,
    };
    let wide = depth == BitDepth::Sixteen;
    allow(size, if wide { 2 * channels } else { channels }, limits)?;
    let length = reader.output_buffer_size().ok_or("it is a broken PNG: it is too large")?;
    let mut data = vec![0; length];
    let frame = reader.next_frame(&mut data).map_err(broken)?;
    data.truncate(frame.buffer_size());
    let values = if wide {
        let (pairs, _) = data.as_chunks::<2>();
        TexelValues::Shorts(pairs.iter().map(|&pair| u16::from_be_bytes(pair)).collect())
    } else {
        TexelValues::Bytes(data)
    };
    Texels::new(size, channels as usize, values).map_err(|error| error.to_string())
}

impl Texels {
    /// A PNG of two pixels, of the least and the greatest values: it stands for the image where only what
    /// its values may be counts. Floats beyond 0 to 1 are cut off.
    ///
    /// # Errors
    /// None that memory does not have.
    pub fn stand_in(&self) -> std::io::Result<Vec<u8>> {
        let [least, most] = self.bounds(false);
        let values = TexelValues::Floats([least, most].concat());
        let bounds = Self::new([2, 1], 4, values).map_err(std::io::Error::other)?;
        let mut bytes = Vec::new();
        bounds.write_png(false, &mut bytes)?;
        Ok(bytes)
    }

    /// Writes it as PNG: floats with 16 bits, between 0 and 1; `srgb`: but for the opacity on the sRGB curve.
    pub(crate) fn write_png(&self, srgb: bool, to: &mut dyn std::io::Write) -> std::io::Result<()> {
        let mut encoder = png::Encoder::new(to, self.size[0], self.size[1]);
        encoder.set_color(match self.channels {
            1 => ColorType::Grayscale,
            2 => ColorType::GrayscaleAlpha,
            3 => ColorType::Rgb,
            _ => ColorType::Rgba,
        });
        let short = |(i, value): (usize, &f32)| {
            let value = f64::from(value.clamp(0.0, 1.0));
            let is_opacity =
                matches!(self.channels, 2 | 4) && i % self.channels == self.channels - 1;
            let value = if srgb && !is_opacity { srgb_encode(value) } else { value };
            (value * 65535.0 + 0.5) as u16
        };
        let (depth, bytes): (_, Vec<u8>) = match &self.values {
            TexelValues::Bytes(values) => (BitDepth::Eight, values.clone()),
            TexelValues::Shorts(values) => {
                (BitDepth::Sixteen, values.iter().flat_map(|v| v.to_be_bytes()).collect())
            }
            TexelValues::Floats(values) => {
                let shorts = values.iter().enumerate().map(short);
                (BitDepth::Sixteen, shorts.flat_map(u16::to_be_bytes).collect())
            }
        };
        encoder.set_depth(depth);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&bytes)?;
        writer.finish()?;
        Ok(())
    }
}
