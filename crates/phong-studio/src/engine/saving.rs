//! The text in its file: saved in place, or taken from there again.

use std::fmt;

use super::opened::{Files, Opened, text_of};
use super::{Emit, Engine, NOTHING, say};
use crate::protocol::Reply;

/// Where texts are kept.
pub trait Keep: fmt::Debug + Send + Sync {
    /// Writes a text in the place of what the file of this path holds, whole or not at all; the path is
    /// one that was opened.
    ///
    /// # Errors
    /// Why it cannot be written, in one sentence.
    fn keep(&self, path: &str, text: &str) -> Result<(), String>;
}

impl Engine {
    /// The same, which saves texts there.
    #[must_use]
    pub fn with_keeper(self, keeper: impl Keep + 'static) -> Self {
        Self { keeper: Some(Box::new(keeper)), ..self }
    }

    /// Writes the text into its file; over one that was changed by somebody else only if that is `over`.
    /// Where another text is `meant`, because this engine has refused that one, nothing is written.
    pub(super) fn save(
        &mut self,
        over: bool,
        meant: Option<&str>,
        emit: Emit<'_>,
    ) -> Result<(), String> {
        let keeper = self.keeper.as_ref().ok_or("this page has no folder to save in")?;
        let files = Files { source: &*self.source, bounds: &self.bounds };
        let opened = self.opened.as_mut().ok_or(NOTHING)?;
        let text = opened.text().ok_or("a bare model has no text to save")?.to_owned();
        let path = opened.path().to_owned();
        if meant.is_some_and(|meant| meant != text) {
            return Err(format!("{path} is not saved: the text of the page was not taken"));
        }
        if !over && let Some(changed) = changed(opened, files) {
            say(emit, &changed);
            return Ok(());
        }
        keeper.keep(&path, &text)?;
        opened.as_read = Some(text);
        say(emit, &Reply::Saved { path });
        Ok(())
    }

    /// Says whether the file was changed by somebody else; nothing where it was not.
    pub(super) fn check_file(&self, emit: Emit<'_>) {
        if let Some(changed) = self.opened.as_ref().and_then(|opened| changed(opened, self.files()))
        {
            say(emit, &changed);
        }
    }

    /// Takes the text that the file has now.
    pub(super) fn take_file(&mut self, emit: Emit<'_>) -> Result<(), String> {
        let files = Files { source: &*self.source, bounds: &self.bounds };
        let opened = self.opened.as_mut().ok_or(NOTHING)?;
        let text = text_of(opened.path(), files)?;
        opened.edit(text.clone(), None, files)?;
        opened.as_read = Some(text.clone());
        say(emit, &Reply::Text { text, note: None, from_file: true });
        self.begin(emit)
    }
}

/// What is said where the file of a text is not as it was read.
fn changed(opened: &Opened, files: Files<'_>) -> Option<Reply> {
    let as_read = opened.as_read.as_deref()?;
    let there = text_of(opened.path(), files).ok();
    (there.as_deref() != Some(as_read))
        .then(|| Reply::FileChanged { path: opened.path().to_owned(), gone: there.is_none() })
}
