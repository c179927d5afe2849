//! The picture or the scene as a file.

use std::io::Cursor;

use phong::film::LayerKind;
use phong::finish::{Finishing, finish};
use phong::image::{Content, Encoding, Format, write};
use phong::part::fingerprint;

use super::opened::Opened;
use super::painting::Painting;
use crate::protocol::FileKind;

/// A file's name and bytes.
#[derive(Debug)]
pub(super) struct Exported {
    pub(super) name: String,
    pub(super) bytes: Vec<u8>,
}

/// What is open as a file.
pub(super) fn file(
    kind: FileKind,
    opened: &Opened,
    painting: Option<&Painting>,
) -> Result<Exported, String> {
    let stem = opened.path().rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    let (format, content, ending) = match kind {
        FileKind::Toml => {
            let text = opened.text().ok_or("a bare model has no text")?;
            return Ok(Exported { name: format!("{stem}.toml"), bytes: text.as_bytes().to_vec() });
        }
        FileKind::Png => (Format::Png, Content::Layer(LayerKind::Picture), "png"),
        FileKind::Exr => (Format::Exr, Content::Film, "exr"),
    };
    let film = painting.and_then(Painting::finished).ok_or("the picture is not finished yet")?;
    let finishing = Finishing::default().of_scene(fingerprint(&opened.scene()?));
    let mut out = Cursor::new(Vec::new());
    write(&finish(film, &finishing), content, format, &Encoding::default(), &mut out)
        .map_err(|error| error.to_string())?;
    Ok(Exported { name: format!("{stem}.{ending}"), bytes: out.into_inner() })
}
