//! A picture drawn by several engines at once: each draws a share of its tiles, and the first puts the
//! shares together where the whole is asked for.

use phong::image::Encoding;
use phong::part::{Part, Settings, write};

use super::opened::Opened;
use super::painting::Painting;

/// What is drawn of the picture, as a part file; `None`: the share is not finished.
pub(super) fn part(opened: &Opened, painting: &Painting) -> Option<Vec<u8>> {
    let film = painting.film().filter(|_| painting.is_done())?;
    let mut bytes = Vec::new();
    write(film.film_tiles(), &settings(opened, painting).ok()?, &mut bytes).ok()?;
    Some(bytes)
}

/// Puts a share of another engine to what is drawn here.
pub(super) fn join(
    bytes: &[u8],
    opened: &Opened,
    painting: &mut Painting,
    most: u64,
) -> Result<(), String> {
    let part = Part::read(&mut &*bytes, most).map_err(|error| error.to_string())?;
    if let Some((what, here, there)) = settings(opened, painting)?.difference(&part.settings) {
        return Err(format!("a share of another picture: {what} is {here} and {there}"));
    }
    match painting.film_mut() {
        Some(film) if !film.is_complete() => {
            film.merge(&part.film).map_err(|error| error.to_string())
        }
        _ => Ok(()),
    }
}

fn settings(opened: &Opened, painting: &Painting) -> Result<Settings, String> {
    Ok(Settings::of(&opened.scene()?, painting.options(), Encoding::default()))
}
