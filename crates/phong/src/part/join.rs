//! Shares put together.

use std::io::Read;

use thiserror::Error;

use super::{Part, PartError, Settings, read_settings, read_tiles};
use crate::film::{Film, MergeError};

/// The name of a part, and which share it is.
type Member = (String, Option<(u32, u32)>);

/// Shares of one picture, gathered one after another.
#[derive(Debug, Default)]
pub struct Join {
    whole: Option<Part>,
    /// What is in it: the name of each file, and which share it is.
    members: Vec<Member>,
}

/// Why parts are not the shares of one picture.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum JoinError {
    /// Nothing was given.
    #[error("there are no parts")]
    Empty,
    /// Two parts are of different pictures.
    #[error("{first} and {second} are of different pictures: {what} is {here} and {there}")]
    Differ {
        /// The part that came first.
        first: String,
        /// The part that does not belong to it.
        second: String,
        /// The name of the setting.
        what: String,
        /// Its value in the first.
        here: String,
        /// Its value in the second.
        there: String,
    },
    /// Two parts hold the same tiles.
    #[error("{first} and {second} overlap: {share}")]
    Overlap {
        /// The part that came first.
        first: String,
        /// The one that has some of it again.
        second: String,
        /// What they share.
        share: String,
    },
    /// The parts are not the whole.
    #[error("the picture is not complete: {0}")]
    Missing(String),
}

/// Why a file could not be added.
#[derive(Debug, Error)]
pub enum ReadError {
    /// It could not be read.
    #[error(transparent)]
    Part(#[from] PartError),
    /// It does not belong to what was gathered before.
    #[error(transparent)]
    Join(#[from] JoinError),
}

impl Join {
    /// Adds a part; `name` is what errors call it.
    ///
    /// # Errors
    /// [`JoinError::Differ`], [`JoinError::Overlap`]; what was gathered before is as it was.
    pub fn add(&mut self, name: &str, part: Part) -> Result<(), JoinError> {
        let share = part.settings.share;
        if let Some(whole) = &mut self.whole {
            check_settings(&self.members, whole, name, &part.settings)?;
            whole.film.merge(&part.film).map_err(|error| match error {
                MergeError::Overlap(tile) => overlap(&self.members, name, share, tile),
                MergeError::Differ(what) => JoinError::Differ {
                    first: self.members[0].0.clone(),
                    second: name.to_owned(),
                    what: what.to_owned(),
                    here: "one thing".to_owned(),
                    there: "another".to_owned(),
                },
            })?;
        } else {
            self.whole = Some(part);
        }
        self.members.push((name.to_owned(), share));
        Ok(())
    }

    /// Reads a part, of which every tile has all its samples, into what was gathered before: it takes
    /// no film of its own. As [`Part::read`] and [`Join::add`] otherwise.
    ///
    /// # Errors
    /// [`ReadError`]; what was gathered before is as it was.
    pub fn read(
        &mut self,
        name: &str,
        input: &mut impl Read,
        max_bytes: u64,
    ) -> Result<(), ReadError> {
        let Some(whole) = &mut self.whole else {
            return Ok(self.add(name, Part::read(input, max_bytes)?)?);
        };
        let settings = read_settings(input, max_bytes)?;
        check_settings(&self.members, whole, name, &settings)?;
        let mut tiles = Vec::new();
        read_tiles(&settings, input, max_bytes, |tile| tiles.push(tile))?;
        // As in `Film::merge`, what lacks samples is not taken.
        tiles.retain(|tile| tile.sums.is_none());
        if let Some(tile) = tiles.iter().find(|tile| whole.film.done[tile.index]) {
            return Err(overlap(&self.members, name, settings.share, tile.index).into());
        }
        for tile in tiles {
            whole.film.put_tile(tile);
        }
        self.members.push((name.to_owned(), settings.share));
        Ok(())
    }

    /// The whole, if it is one.
    ///
    /// # Errors
    /// [`JoinError::Empty`], [`JoinError::Missing`].
    pub fn finish(self) -> Result<(Film, Settings), JoinError> {
        let Some(Part { settings, film }) = self.whole else {
            return Err(JoinError::Empty);
        };
        if film.is_complete() {
            return Ok((film, settings));
        }
        let count = self.members.iter().filter_map(|(_, share)| Some(share.as_ref()?.1)).max();
        let has = |i: u32, n: u32| self.members.iter().any(|(_, share)| *share == Some((i, n)));
        let absent: Vec<String> = count.map_or_else(Vec::new, |n| {
            (0..n).filter(|&i| !has(i, n)).take(10).map(|i| format!("{i}/{n}")).collect()
        });
        let what = if absent.is_empty() {
            let done = film.done.iter().filter(|&&done| done).count();
            format!("{done} of {} tiles are there; a part is unfinished", film.tiles())
        } else {
            let verb = if absent.len() == 1 { "share {} is" } else { "shares {} are" };
            format!("{} missing", verb.replace("{}", &absent.join(", ")))
        };
        Err(JoinError::Missing(what))
    }
}

/// Whether a part is of the same picture as what was gathered before.
fn check_settings(
    members: &[Member],
    whole: &Part,
    name: &str,
    settings: &Settings,
) -> Result<(), JoinError> {
    let Some((what, here, there)) = whole.settings.difference(settings) else { return Ok(()) };
    let (first, second) = (members[0].0.clone(), name.to_owned());
    Err(JoinError::Differ { first, second, what, here, there })
}

/// What is said of a part that has a tile which is there already.
fn overlap(members: &[Member], name: &str, share: Option<(u32, u32)>, tile: usize) -> JoinError {
    let twin = members.iter().find(|(_, other)| *other == share);
    let (first, share) = match (twin, share) {
        (Some((twin, _)), Some((i, n))) => (twin.clone(), format!("both are share {i}/{n}")),
        _ => (members[0].0.clone(), format!("both have tile {tile}")),
    };
    JoinError::Overlap { first, second: name.to_owned(), share }
}
