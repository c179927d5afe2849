//! What is wrong with how a molecule is to be drawn.

use super::{Column, Molecule};
use crate::wording::{closest, list, quoted};

/// What is wrong with a key of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wrong {
    /// What it is.
    pub(crate) message: String,
    /// The way out.
    pub(crate) help: Option<String>,
}

impl Molecule {
    /// The column of this name.
    pub(super) fn known(&self, name: &str) -> Result<&Column, Wrong> {
        self.column(name).ok_or_else(|| {
            let known = self.columns.iter().map(|column| column.name.as_str());
            let help = closest(name, known).map(|meant| format!("did you mean `{meant}`?"));
            Wrong {
                message: format!("the file has no column {}", quoted(name)),
                help: help.or_else(|| self.known_columns()),
            }
        })
    }

    /// The names of all columns, as a way out; `None`: there are none.
    pub(super) fn known_columns(&self) -> Option<String> {
        let known = self.columns.iter().map(|column| column.name.as_str());
        (!self.columns.is_empty()).then(|| format!("its columns are {}", list(known, "and")))
    }
}
