//! A drawing as pixels, and pixels as PNG.

use tiny_skia::{FilterQuality, Pixmap, PixmapPaint, Transform};

use super::drawing::Drawing;
use super::mark::{Anchor, Bitmap, Ink, Mark, Path, Point, Run, Script, Stroke, Text};
use super::style;
use super::text::Faces;
use crate::draw;

/// Pixels a unit: a slide comes out 1920 wide.
pub(super) const SCALE: f64 = 2.0;

/// The drawing at [`SCALE`], as a PNG file.
pub(super) fn png(drawing: &Drawing) -> Vec<u8> {
    encode(&paint(drawing))
}

fn paint(drawing: &Drawing) -> Bitmap {
    let [width, height] = (drawing.size * SCALE).to_array().map(|side| side as u32);
    let mut canvas = Canvas {
        pixels: Pixmap::new(width.max(1), height.max(1)).expect("a canvas of moderate size"),
        faces: Faces::new(),
    };
    canvas.pixels.fill(draw::color(drawing.paper));
    for mark in &drawing.marks {
        match mark {
            Mark::Shape { path, fill, stroke } => canvas.shape(path, *fill, *stroke),
            Mark::Text(text) => canvas.text(text),
            Mark::Image { at, size, bitmap } => canvas.image(*at, *size, bitmap),
        }
    }
    Bitmap { width, height, rgba: canvas.pixels.take_demultiplied() }
}

/// A line of text as pixels: how much of each its letters cover.
pub(crate) struct Lettering {
    /// Width in pixels.
    pub(crate) width: usize,
    /// From 0 to 1, rows from the top.
    pub(crate) coverage: Vec<f32>,
}

/// Words in the figures' face, with letters `size` pixels high.
pub(crate) fn lettering(words: &str, size: f64) -> Lettering {
    let faces = Faces::new();
    let line = Text {
        at: Point::new(0.0, size.round()),
        anchor: Anchor::Start,
        size,
        ink: style::TEXT,
        bold: false,
        upright: false,
        runs: vec![Run { words: words.to_owned(), italic: false, script: Script::Line }],
    };
    let [_, right] = faces.extent(&line);
    let (width, height) = (right.ceil().max(1.0) as u32, (1.3 * size).ceil() as u32);
    let pixels = Pixmap::new(width, height).expect("a line of text is small");
    let mut canvas = Canvas { pixels, faces };
    let outline = canvas.faces.outline(&line.runs, line.at, size, false);
    canvas.transformed(&outline, Some(line.ink), None, Transform::identity());
    let coverage = canvas.pixels.pixels().iter().map(|p| f32::from(p.alpha()) / 255.0).collect();
    Lettering { width: width as usize, coverage }
}

struct Canvas {
    pixels: Pixmap,
    faces: Faces,
}

const TO_PIXELS: f32 = SCALE as f32;

impl Canvas {
    fn shape(&mut self, path: &Path, fill: Option<Ink>, stroke: Option<Stroke>) {
        self.transformed(path, fill, stroke, Transform::from_scale(TO_PIXELS, TO_PIXELS));
    }

    fn transformed(
        &mut self,
        path: &Path,
        fill: Option<Ink>,
        stroke: Option<Stroke>,
        transform: Transform,
    ) {
        if let Some(ink) = fill {
            draw::fill(&mut self.pixels, path, ink, transform);
        }
        if let Some(line) = stroke {
            draw::stroke(&mut self.pixels, path, line, transform);
        }
    }

    fn text(&mut self, text: &Text) {
        let [left, _] = self.faces.extent(text);
        let start = Point::new(left - text.at.x, 0.0);
        let outline = self.faces.outline(&text.runs, start, text.size, text.bold);
        let turn = if text.upright { -90.0 } else { 0.0 };
        let transform = Transform::from_rotate(turn)
            .post_translate(text.at.x as f32, text.at.y as f32)
            .post_scale(TO_PIXELS, TO_PIXELS);
        self.transformed(&outline, Some(text.ink), None, transform);
    }

    fn image(&mut self, at: Point, size: Point, bitmap: &Bitmap) {
        let Some(mut pixels) = Pixmap::new(bitmap.width, bitmap.height) else { return };
        for (pixel, rgba) in pixels.pixels_mut().iter_mut().zip(bitmap.rgba.chunks_exact(4)) {
            let straight = tiny_skia::ColorU8::from_rgba(rgba[0], rgba[1], rgba[2], rgba[3]);
            *pixel = straight.premultiply();
        }
        let scale = |side: f64, pixels: u32| (side * SCALE / f64::from(pixels)) as f32;
        let transform =
            Transform::from_scale(scale(size.x, bitmap.width), scale(size.y, bitmap.height))
                .post_translate((at.x * SCALE) as f32, (at.y * SCALE) as f32);
        let paint = PixmapPaint { quality: FilterQuality::Bilinear, ..PixmapPaint::default() };
        self.pixels.draw_pixmap(0, 0, pixels.as_ref(), &paint, transform, None);
    }
}

/// A bitmap as a PNG file: 8 bits, sRGB.
pub(super) fn encode(bitmap: &Bitmap) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, bitmap.width, bitmap.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(&bitmap.rgba))
        .expect("a bitmap of its own size, written to memory");
    file
}
