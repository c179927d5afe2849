//! The picture or the scene as a file.

use std::io::Cursor;

use phong::film::{Film, LayerKind};
use phong::finish::{Finishing, finish};
use phong::image::{Content, Encoding, Format, write};
use phong::part::Settings;
use phong::render::{Cancel, render};
use phong::terms::TermSet;
use phong_lab::furniture;
use phong_lab::tell::html;

use super::opened::Opened;
use super::painting::Painting;
use crate::protocol::FileKind;

/// A file's name and bytes.
#[derive(Debug)]
pub(super) struct Exported {
    pub(super) name: String,
    pub(super) bytes: Vec<u8>,
}

/// The most rays that are traced for a page of explanations: more would keep its reader waiting.
const MOST_RAYS: u64 = 100_000;

/// Every pixel explained, as `phong explain --html` has it, with as many samples as are soon told.
fn explained(title: &str, painting: &Painting) -> Result<String, String> {
    let [width, height] = painting.options().size();
    let pixels = u64::from(width) * u64::from(height);
    let most = html::MAX_PIXELS;
    if pixels > u64::from(most) {
        return Err(format!(
            "a page explains at most {most} pixels, and there are {width} × {height}: make \
             `image.size` smaller"
        ));
    }
    let samples = u64::from(painting.options().samples()).min(MOST_RAYS / pixels).max(1) as u32;
    let options = painting.options().clone().with_samples(samples);
    let options =
        options.map_err(|error| error.to_string())?.with_terms(TermSet::NONE).with_lines(None);
    let cancel = Cancel::new();
    let film = render(painting.view(), &options, &|_| {}, &cancel).film;
    let mut png = Cursor::new(Vec::new());
    let content = Content::Layer(LayerKind::Picture);
    let mut finishing = Finishing::default().with_tone(options.tone());
    finishing.cel = options.cel();
    let finished = finish(&film, &finishing);
    write(&finished, content, Format::Png, &Encoding::default(), &mut png)
        .map_err(|error| error.to_string())?;
    let picture = (&*png.into_inner(), &finished);
    html::page(painting.view(), &options, title, picture, &|_| {}, &cancel)
        .map_err(|error| error.to_string())
}

/// The film of a picture that is finished, and what its file goes by.
fn whole<'a>(
    opened: &Opened,
    painting: Option<&'a Painting>,
) -> Result<(&'a Film, Settings), String> {
    let whole = painting.and_then(|painting| Some((painting, painting.finished()?)));
    let (painting, film) = whole.ok_or("the picture is not finished yet")?;
    Ok((film, Settings::of(&opened.scene()?, painting.options(), Encoding::default())))
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
        FileKind::Python => {
            let bytes = opened.python()?.into_bytes();
            return Ok(Exported { name: format!("{stem}.py"), bytes });
        }
        FileKind::Html => {
            let painting = painting.ok_or("there is no picture")?;
            let bytes = explained(opened.path(), painting)?.into_bytes();
            return Ok(Exported { name: format!("{stem}.html"), bytes });
        }
        FileKind::Png => (Format::Png, Content::Layer(LayerKind::Picture), "png"),
        FileKind::Exr => (Format::Exr, Content::Film, "exr"),
        FileKind::Svg => {
            let (film, settings) = whole(opened, painting)?;
            let text = furniture::svg(film, &settings, &settings.encoding);
            let bytes = text.map_err(|error| error.to_string())?.into_bytes();
            return Ok(Exported { name: format!("{stem}.svg"), bytes });
        }
    };
    let (film, settings) = whole(opened, painting)?;
    let mut finishing = furniture::finishing(film, &settings);
    if opened.frame.number > 0 {
        // As a frame is written by `phong render --frames`, which knows by it what is there already.
        finishing = finishing.of_picture(settings.checksum());
    }
    let mut out = Cursor::new(Vec::new());
    write(&finish(film, &finishing), content, format, &settings.encoding, &mut out)
        .map_err(|error| error.to_string())?;
    Ok(Exported { name: format!("{stem}.{ending}"), bytes: out.into_inner() })
}
