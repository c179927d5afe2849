//! Portable float map: a text header, then little-endian floats, the bottom row first.

use std::io::Write;

use super::picture::{Picture, Plane, ReadError, Transfer, count, within};
use super::{WriteError, layer};
use crate::film::LayerKind;
use crate::finish::Finished;

/// Writes one layer: `PF` for three values a pixel (two are filled up with 0), `Pf` for one.
pub(super) fn write(
    picture: &Finished<'_>,
    kind: LayerKind,
    out: &mut impl Write,
) -> Result<(), WriteError> {
    let (n, film) = (kind.channels(), picture.film());
    // As EXR it keeps the picture that nothing is drawn onto.
    let values = match film.layer(kind) {
        Some(layer) => &*layer.values,
        None => layer(picture, kind)?,
    };
    let magic = if n == 1 { "Pf" } else { "PF" };
    write!(out, "{magic}\n{} {}\n-1.0\n", film.width(), film.height())?;
    let mut bytes = Vec::with_capacity(film.width() as usize * 12);
    for row in values.chunks_exact(film.width() as usize * n).rev() {
        bytes.clear();
        for pixel in row.chunks_exact(n) {
            for value in pixel {
                bytes.extend_from_slice(&value.to_le_bytes());
            }
            if n == 2 {
                bytes.extend_from_slice(&[0; 4]);
            }
        }
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// Reads either kind, in either byte order.
pub(super) fn read(bytes: &[u8], max_bytes: u64) -> Result<Picture, ReadError> {
    let broken = |what: &str| ReadError::Broken(format!("PFM: {what}"));
    let mut rest = bytes;
    let channels = match word(&mut rest) {
        Some("PF") => 3,
        Some("Pf") => 1,
        _ => return Err(broken("it must begin with PF or Pf")),
    };
    let mut side = || word(&mut rest).and_then(|w| w.parse::<u32>().ok()).filter(|&n| n > 0);
    let (Some(width), Some(height)) = (side(), side()) else {
        return Err(broken("width and height must be whole numbers from 1"));
    };
    let scale: f32 = word(&mut rest)
        .and_then(|w| w.parse().ok())
        .filter(|s: &f32| s.is_finite() && *s != 0.0)
        .ok_or_else(|| broken("the scale must be a number other than 0"))?;
    let values = count(width, height, channels)?;
    within([width, height], 4 * channels, max_bytes)?;
    // The header may end its lines as Windows does, and pixels may begin with any byte.
    let end = bytes.len() - rest.len();
    if bytes[end - 1] == b'\r' && rest.first() == Some(&b'\n') && rest.len() as u64 > 4 * values {
        rest = &rest[1..];
    }
    if (rest.len() as u64) < 4 * values {
        return Err(broken(&format!("{} bytes of pixels, not {}", rest.len(), 4 * values)));
    }
    let value = |at: usize| {
        let four = [rest[at], rest[at + 1], rest[at + 2], rest[at + 3]];
        if scale < 0.0 { f32::from_le_bytes(four) } else { f32::from_be_bytes(four) }
    };
    let (w, h, n) = (width as usize, height as usize, channels as usize);
    let names: &[&str] = if n == 1 { &["Y"] } else { &["R", "G", "B"] };
    let plane = |(c, name): (usize, &&str)| Plane {
        name: (*name).to_owned(),
        values: (0..w * h).map(|i| value(4 * (((h - 1 - i / w) * w + i % w) * n + c))).collect(),
    };
    Ok(Picture {
        size: [width, height],
        planes: names.iter().enumerate().map(plane).collect(),
        transfer: Transfer::Linear,
        levels: None,
        lossy: None,
    })
}

/// The next word of the header, and the one white-space character after it.
fn word<'a>(rest: &mut &'a [u8]) -> Option<&'a str> {
    let begin = rest.iter().position(|b| !b.is_ascii_whitespace())?;
    let text = &rest[begin..];
    let end = text.iter().take(32).position(u8::is_ascii_whitespace)?;
    *rest = &text[end + 1..];
    std::str::from_utf8(&text[..end]).ok()
}
