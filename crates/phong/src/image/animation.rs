//! Pictures that follow one another in one file: animated PNG, and GIF.
//!
//! Each is encoded and written when it comes, so that memory does not grow with their number.

use std::io::Write;
use std::path::Path;

use png::{BitDepth, ColorType, Compression, ScaledFloat, SrgbRenderingIntent};

use super::{Encoding, WriteError, srgb8};
use crate::finish::Finished;

/// How finely the palette of a GIF's picture is looked for, from 1 (finest) to 30.
const GIF_SPEED: i32 = 10;

/// A file format for pictures that follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnimationFormat {
    /// Animated PNG: every colour of 8 bits, and alpha. Programs that do not know it show the first
    /// picture.
    Png,
    /// GIF: 256 colours a picture, and pixels that are there or not. Every program knows it.
    Gif,
}

impl AnimationFormat {
    /// Pictures a second, at most: delays are told in hundredths of a second in a GIF, and those below
    /// two are ignored by most programs.
    pub const fn most_a_second(self) -> u16 {
        match self {
            Self::Png => 1000,
            Self::Gif => 50,
        }
    }

    /// The format that a file name's extension means, whatever its case.
    ///
    /// ```
    /// use phong::image::AnimationFormat;
    /// assert_eq!(AnimationFormat::of_path("a/b.GIF".as_ref()), Some(AnimationFormat::Gif));
    /// assert_eq!(AnimationFormat::of_path("a.exr".as_ref()), None);
    /// ```
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        let all = [("png", Self::Png), ("gif", Self::Gif)];
        all.into_iter().find(|(name, _)| name.eq_ignore_ascii_case(extension)).map(|(_, f)| f)
    }
}

/// A file of pictures that follow one another, while it is written.
pub struct Animation<W: Write> {
    file: Kind<W>,
    size: [u32; 2],
    /// Pictures a second.
    rate: u16,
    /// How many pictures there are so far.
    written: u32,
    encoding: Encoding,
    /// Whether pixels may lack something, so that alpha is kept.
    alpha: bool,
    /// How many there are to be.
    pictures: u32,
}

enum Kind<W: Write> {
    Png(png::Writer<W>),
    Gif(gif::Encoder<W>),
}

/// What an animation is like.
#[derive(Clone, Copy, Debug)]
pub struct AnimationOptions {
    /// The format.
    pub format: AnimationFormat,
    /// Width and height of every picture, pixels.
    pub size: [u32; 2],
    /// How many pictures there will be, at least 1.
    pub pictures: u32,
    /// Pictures a second, from 1 to [`AnimationFormat::most_a_second`].
    pub rate: u16,
    /// Whether a PNG is linear; a GIF never is. Its `bits` are not looked at: 8.
    pub encoding: Encoding,
    /// Whether alpha is kept; else what lacks something is seen before black.
    pub alpha: bool,
}

impl<W: Write> std::fmt::Debug for Animation<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Animation").field("size", &self.size).finish_non_exhaustive()
    }
}

impl<W: Write> Animation<W> {
    /// Begins a file, which is shown again and again.
    ///
    /// # Errors
    /// [`WriteError::Io`] as `out` says; [`WriteError::Unsuitable`] where the format takes no pictures
    /// of this size, none at all, or not so many a second.
    pub fn new(out: W, options: AnimationOptions) -> Result<Self, WriteError> {
        let AnimationOptions { format, size, pictures, rate, mut encoding, alpha } = options;
        if !(1..=format.most_a_second()).contains(&rate) {
            let most = format.most_a_second();
            let message = format!("pictures a second must be from 1 to {most}, not {rate}");
            return Err(WriteError::Unsuitable(message));
        }
        let [width, height] = size;
        let file = match format {
            AnimationFormat::Png => {
                let mut encoder = png::Encoder::new(out, width, height);
                encoder.set_color(if alpha { ColorType::Rgba } else { ColorType::Rgb });
                encoder.set_depth(BitDepth::Eight);
                if encoding.linear {
                    encoder.set_source_gamma(ScaledFloat::from_scaled(100_000));
                } else {
                    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
                }
                encoder.set_compression(Compression::Balanced);
                encoder.set_animated(pictures, 0).map_err(png_error)?;
                encoder.set_frame_delay(1, rate).map_err(png_error)?;
                Kind::Png(encoder.write_header().map_err(png_error)?)
            }
            AnimationFormat::Gif => {
                let (Ok(width), Ok(height)) = (u16::try_from(width), u16::try_from(height)) else {
                    let message =
                        format!("a GIF has at most 65535 × 65535 pixels, not {width} × {height}");
                    return Err(WriteError::Unsuitable(message));
                };
                encoding.linear = false;
                let mut encoder = gif::Encoder::new(out, width, height, &[]).map_err(gif_error)?;
                encoder.set_repeat(gif::Repeat::Infinite).map_err(gif_error)?;
                Kind::Gif(encoder)
            }
        };
        Ok(Self { file, size, rate, written: 0, encoding, alpha, pictures })
    }

    /// Writes the next picture.
    ///
    /// # Errors
    /// [`WriteError::Io`]; [`WriteError::Unsuitable`] if the picture is of another size, or one more than
    /// there were to be.
    pub fn add(&mut self, picture: &Finished<'_>) -> Result<(), WriteError> {
        let size = [picture.film().width(), picture.film().height()];
        if size != self.size {
            let [[w, h], [width, height]] = [size, self.size];
            let message =
                format!("a picture of {w} × {h} pixels among those of {width} × {height}");
            return Err(WriteError::Unsuitable(message));
        }
        let mut pixels = srgb8(picture, &self.encoding);
        match &mut self.file {
            Kind::Png(writer) if self.alpha => {
                writer.write_image_data(&pixels).map_err(png_error)?;
            }
            Kind::Png(writer) => {
                let opaque: Vec<u8> = pixels
                    .chunks_exact(4)
                    .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
                    .collect();
                writer.write_image_data(&opaque).map_err(png_error)?;
            }
            Kind::Gif(encoder) => {
                for pixel in pixels.chunks_exact_mut(4) {
                    // A pixel is there or not.
                    pixel[3] = if !self.alpha || pixel[3] >= 128 { 255 } else { 0 };
                }
                let [width, height] = self.size.map(|side| side as u16);
                let mut frame = gif::Frame::from_rgba_speed(width, height, &mut pixels, GIF_SPEED);
                // Rounded where it ends, so that the whole takes as long as it should.
                let end = |count: u32| 100 * u64::from(count) / u64::from(self.rate);
                frame.delay = (end(self.written + 1) - end(self.written)) as u16;
                if self.alpha {
                    frame.dispose = gif::DisposalMethod::Background;
                }
                encoder.write_frame(&frame).map_err(gif_error)?;
            }
        }
        self.written += 1;
        Ok(())
    }

    /// Ends the file.
    ///
    /// # Errors
    /// [`WriteError::Io`]; [`WriteError::Unsuitable`] if there were to be more pictures.
    pub fn finish(self) -> Result<(), WriteError> {
        if self.written < self.pictures {
            let message = format!(
                "{} pictures of {} are missing",
                self.pictures - self.written,
                self.pictures
            );
            return Err(WriteError::Unsuitable(message));
        }
        match self.file {
            Kind::Png(writer) => writer.finish().map_err(png_error),
            Kind::Gif(encoder) => encoder.into_inner().map(drop).map_err(gif_error),
        }
    }
}

fn png_error(error: png::EncodingError) -> WriteError {
    match error {
        png::EncodingError::IoError(error) => WriteError::Io(error),
        other => WriteError::Unsuitable(format!("animated PNG: {other}")),
    }
}

fn gif_error(error: gif::EncodingError) -> WriteError {
    match error {
        gif::EncodingError::Io(error) => WriteError::Io(error),
        other => WriteError::Unsuitable(format!("GIF: {other}")),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::film::{Film, LayerKind, Window};
    use crate::finish::{Finishing, finish};

    const SIZE: [u32; 2] = [6, 4];

    /// A picture of one grey.
    fn grey(level: f32) -> Film {
        let mut film = Film::new(SIZE, Window::full(SIZE), 16, &[LayerKind::Picture]);
        film.layers[0].values.fill(level);
        film
    }

    fn options(format: AnimationFormat, pictures: u32) -> AnimationOptions {
        let encoding = Encoding { linear: true, ..Encoding::default() };
        AnimationOptions { format, size: SIZE, pictures, rate: 30, encoding, alpha: false }
    }

    #[test]
    fn an_animated_png_holds_every_picture() {
        let mut file = Vec::new();
        let mut animation = Animation::new(&mut file, options(AnimationFormat::Png, 3)).unwrap();
        for level in [0.0, 0.2, 1.0] {
            animation.add(&finish(&grey(level), &Finishing::default())).unwrap();
        }
        animation.finish().unwrap();
        let mut reader = png::Decoder::new(Cursor::new(&file)).read_info().unwrap();
        assert_eq!(reader.info().animation_control.unwrap().num_frames, 3);
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        for level in [0, 51, 255] {
            reader.next_frame(&mut bytes).unwrap();
            assert_eq!(bytes, [level; 72], "{level}");
            let control = reader.info().frame_control.unwrap();
            assert_eq!((control.delay_num, control.delay_den), (1, 30));
        }
    }

    #[test]
    fn a_gif_holds_every_picture_and_lasts_as_long_as_it_should() {
        let mut file = Vec::new();
        let mut animation = Animation::new(&mut file, options(AnimationFormat::Gif, 30)).unwrap();
        for level in 0..30 {
            let film = grey(level as f32 / 29.0);
            animation.add(&finish(&film, &Finishing::default())).unwrap();
        }
        animation.finish().unwrap();
        let mut decoder = gif::DecodeOptions::new();
        decoder.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = decoder.read_info(&*file).unwrap();
        let (mut hundredths, mut greys) = (0, Vec::new());
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            hundredths += u32::from(frame.delay);
            greys.push(frame.buffer[0]);
        }
        assert_eq!((hundredths, greys.len()), (100, 30));
        assert!(greys.is_sorted() && greys[29] == 255, "{greys:?}");
    }

    #[test]
    fn what_a_format_cannot_hold_is_refused() {
        let refused = |options| Animation::new(Vec::new(), options).unwrap_err().to_string();
        let gif = options(AnimationFormat::Gif, 2);
        assert!(refused(AnimationOptions { rate: 60, ..gif }).contains("from 1 to 50"));
        assert!(refused(AnimationOptions { size: [65536, 1], ..gif }).contains("65535"));
        let none = options(AnimationFormat::Png, 0);
        assert!(refused(none).contains("PNG"));
        let mut two = Animation::new(Vec::new(), options(AnimationFormat::Png, 2)).unwrap();
        two.add(&finish(&grey(0.5), &Finishing::default())).unwrap();
        assert!(two.finish().is_err(), "one is missing");
    }
}
