//! Shares put together.

use thiserror::Error;

use super::{Part, Settings};
use crate::film::{Film, MergeError};

/// Shares of one picture, gathered one after another.
#[derive(Debug, Default)]
pub struct Join {
    whole: Option<Part>,
    /// What is in it: the name of each file, and which share it is.
    members: Vec<(String, Option<(u32, u32)>)>,
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

impl Join {
    /// Adds a part; `name` is what errors call it.
    ///
    /// # Errors
    /// [`JoinError::Differ`], [`JoinError::Overlap`]; what was gathered before is as it was.
    pub fn add(&mut self, name: &str, part: Part) -> Result<(), JoinError> {
        let share = part.settings.share;
        if let Some(whole) = &mut self.whole {
            let first = self.members[0].0.clone();
            let second = name.to_owned();
            if let Some((what, here, there)) = whole.settings.difference(&part.settings) {
                return Err(JoinError::Differ { first, second, what, here, there });
            }
            let same = |(_, other): &&(String, Option<(u32, u32)>)| *other == share;
            match (whole.film.merge(&part.film), share) {
                (Ok(()), _) => {}
                (Err(MergeError::Overlap(tile)), share) => {
                    let twin = self.members.iter().find(same);
                    let (first, share) = match (twin, share) {
                        (Some((twin, _)), Some((i, n))) => {
                            (twin.clone(), format!("both are share {i}/{n}"))
                        }
                        _ => (first, format!("both have tile {tile}")),
                    };
                    return Err(JoinError::Overlap { first, second, share });
                }
                (Err(MergeError::Differ(what)), _) => {
                    let (here, there) = ("one thing".to_owned(), "another".to_owned());
                    return Err(JoinError::Differ {
                        first,
                        second,
                        what: what.to_owned(),
                        here,
                        there,
                    });
                }
            }
        } else {
            self.whole = Some(part);
        }
        self.members.push((name.to_owned(), share));
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
