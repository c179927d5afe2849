//! What is sent as bytes: tiles and files.

use super::PixelKind;

/// What stands before the pixels of a part of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Head {
    pub(crate) picture: u32,
    pub(crate) pass: u16,
    pub(crate) step: u8,
    pub(crate) x: u32,
    pub(crate) y: u32,
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl Head {
    /// As it is sent: one byte for the kind (1 sRGB, 2 linear), one for the step, two for the pass, then
    /// the picture, x, y, width and height in four bytes each, least significant byte first. There is room
    /// for the pixels behind it.
    pub(crate) fn bytes(&self, kind: PixelKind) -> Vec<u8> {
        let (code, each) = match kind {
            PixelKind::Srgb8 => (1, 4),
            PixelKind::Linear => (2, 16),
        };
        let pixels = self.width as usize * self.height as usize;
        let mut out = Vec::with_capacity(HEADER + each * pixels);
        out.extend([code, self.step]);
        out.extend(self.pass.to_le_bytes());
        for number in [self.picture, self.x, self.y, self.width, self.height] {
            out.extend(number.to_le_bytes());
        }
        out
    }
}

/// Pixels of a part of a picture.
#[derive(Clone, Copy, Debug)]
pub struct TileFrame<'a> {
    /// The picture's number.
    pub picture: u32,
    /// The pass, from 0.
    pub pass: u16,
    /// How many pixels of the picture, across and down, each pixel here stands for: 8 or 1.
    pub step: u8,
    /// Left edge, in pixels of this frame's own grid.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
    /// Three linear values a pixel, rows from top to bottom.
    pub colors: &'a [f32],
    /// One value a pixel.
    pub alphas: &'a [f32],
}

/// Bytes before the pixels of a tile, and before a file.
pub const HEADER: usize = 24;

impl TileFrame<'_> {
    /// As it is sent: [`HEADER`] bytes, and the pixels.
    #[must_use]
    pub fn bytes(&self, kind: PixelKind) -> Vec<u8> {
        let pixels = self.colors.chunks_exact(3).zip(self.alphas);
        let &Self { picture, pass, step, x, y, width, height, .. } = self;
        let mut out = Head { picture, pass, step, x, y, width, height }.bytes(kind);
        match kind {
            PixelKind::Srgb8 => pixels.for_each(|(color, &alpha)| {
                let straight = |v: f32| if alpha > 0.0 { v / alpha } else { v };
                out.extend(color.iter().map(|&v| phong::image::srgb_level(straight(v))));
                out.push((alpha.clamp(0.0, 1.0) * 255.0 + 0.5) as u8);
            }),
            PixelKind::Linear => pixels.for_each(|(color, alpha)| {
                color.iter().chain([alpha]).for_each(|v| out.extend(v.to_le_bytes()));
            }),
        }
        out
    }
}

/// A file as it is sent: the kind 3, and 23 bytes that say nothing, so that pixels and files begin at
/// the same place.
#[must_use]
pub fn file_frame(bytes: &[u8]) -> Vec<u8> {
    let mut out = vec![0; HEADER];
    out[0] = 3;
    out.extend(bytes);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tile_begins_with_24_bytes_and_keeps_every_bit_of_linear_values() {
        let (colors, alphas) = ([0.25, 1.0, -0.5, 0.1, f32::MIN_POSITIVE, 3.0], [1.0, 0.5]);
        let tile = TileFrame {
            picture: 258,
            pass: 3,
            step: 1,
            x: 16,
            y: 32,
            width: 2,
            height: 1,
            colors: &colors,
            alphas: &alphas,
        };
        let bytes = tile.bytes(PixelKind::Linear);
        assert_eq!(bytes[..8], [2, 1, 3, 0, 2, 1, 0, 0]);
        assert_eq!(bytes.len(), HEADER + 2 * 16);
        let value = |i: usize| f32::from_le_bytes(bytes[HEADER + 4 * i..][..4].try_into().unwrap());
        let values: Vec<f32> = (0..8).map(value).collect();
        assert_eq!(values, [0.25, 1.0, -0.5, 1.0, 0.1, f32::MIN_POSITIVE, 3.0, 0.5]);
        let bytes = tile.bytes(PixelKind::Srgb8);
        assert_eq!(bytes[HEADER..], [137, 255, 0, 255, 124, 0, 255, 128]);
    }
}
