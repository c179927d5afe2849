//! A value that is laid over what a scene's text says: a parameter of a batch, or `--set`.

use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;

use toml::de::DeValue;

/// One value laid over what a scene's text says for a key, before the text is held against the table
/// of keys: so it is checked like the text, and what is wrong with it is told where it was written.
///
/// The key is given by its path: `camera.eye`, `image.samples`, `materials.red.shininess`,
/// `light.2.color`. Lights and shapes are counted from 1 by kind, includes at their place, as
/// `explain` counts them; a shape may be called by its `name` as well.
///
/// ```
/// use phong_scene::{Change, Limits, Memory, read_changed};
/// let text = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
/// let files = Memory::new().with("a.toml", text.as_bytes());
/// let nearer = Change::parse("camera.eye=[0, 0, 3]").expect("KEY=VALUE");
/// let reading = read_changed("a.toml", None, &files, &Limits::default(), &[nearer]);
/// assert_eq!(reading.scene.expect("a scene").camera.eye.z, 3.0);
/// let misspelt = Change::parse("camera.eey=[0, 0, 3]").expect("KEY=VALUE");
/// let reading = read_changed("a.toml", None, &files, &Limits::default(), &[misspelt]);
/// assert_eq!(
///     reading.diagnostics[0].to_string(),
///     "--set:1:8: error: unknown key \"eey\" in this `camera` (did you mean `eye`?)",
/// );
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// What it is written in, and all of its text.
    pub(crate) file: Arc<str>,
    pub(crate) text: Arc<str>,
    /// The path of the key, and where it stands.
    pub(crate) path: String,
    pub(crate) path_at: usize,
    /// The value as TOML, and where it stands, or what it was made from.
    pub(crate) value: String,
    pub(crate) value_at: usize,
}

impl Change {
    /// A change from `KEY=VALUE`, such as `materials.red.shininess=60`. The value is written as in a
    /// scene; text needs no quotes.
    ///
    /// # Errors
    /// What is wrong with the form. Whether there is such a key is known when a scene is read.
    pub fn parse(words: &str) -> Result<Self, String> {
        let form =
            || "write KEY=VALUE, like camera.fov=30 or materials.red.color=tomato".to_owned();
        let (path, value) = words.split_once('=').ok_or_else(form)?;
        let value_at = path.len() + 1 + (value.len() - value.trim_start().len());
        let (path_at, path, value) =
            (path.len() - path.trim_start().len(), path.trim(), value.trim());
        if path.is_empty() || value.is_empty() {
            return Err(form());
        }
        let is_toml = DeValue::parse(value).is_ok();
        Ok(Self {
            file: "--set".into(),
            text: words.into(),
            path: path.to_owned(),
            path_at,
            value: if is_toml { value.to_owned() } else { toml_string(value) },
            value_at,
        })
    }

    /// The path of the key.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The value, as TOML.
    pub fn value(&self) -> &str {
        &self.value
    }

    /// The value as the only one of a TOML text, `v`, at the very place where it was written.
    pub(crate) fn document(&self) -> String {
        const KEY: &str = "v=";
        let blanks = self.value_at.saturating_sub(KEY.len());
        format!("{KEY}{}{}", " ".repeat(blanks), self.value)
    }

    /// Where the key's path stands.
    pub(crate) fn path_range(&self) -> Range<usize> {
        self.path_at..self.path_at + self.path.len()
    }
}

/// Text as a basic string of TOML.
pub(crate) fn toml_string(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '\n' => quoted.push_str("\\n"),
            '\t' => quoted.push_str("\\t"),
            // Writing to a string does not fail.
            c if c.is_control() => drop(write!(quoted, "\\u{:04X}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_needs_no_quotes_and_a_value_stands_where_it_was_written() {
        let change = |words| Change::parse(words).expect("KEY=VALUE");
        assert_eq!(change("a.b = tomato").value(), "\"tomato\"");
        assert_eq!(change("a.b=[1, 2]").value(), "[1, 2]");
        assert_eq!(change("a.b=1 2").value(), "\"1 2\"");
        assert_eq!(change("mesh.1.file=a\\b.ply").value(), "\"a\\\\b.ply\"");
        assert_eq!(change("a.b = 0.5").document(), "v=    0.5");
        for wrong in ["", "a", "=1", "a=", " = "] {
            assert!(Change::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn quoted_text_reads_back() {
        for text in ["plain", "a \"b\" \\c", "tab\t, line\n, é"] {
            let quoted = toml_string(text);
            let value = DeValue::parse(&quoted).expect("TOML");
            assert_eq!(value.get_ref().as_str(), Some(text));
        }
    }
}
