//! How to draw what is shown elsewhere: as a command line, and as a program in Python.

use serde_json::Value;

use super::look;
use super::opened::Opened;
use super::writing::written;

impl Opened {
    /// The command line that draws what is shown.
    pub(super) fn command(&self) -> Option<String> {
        let frame = self.frame.number;
        // No command sees a frame of a bare model as another frame is.
        if self.text.is_none() && (!self.set.is_empty() || frame > 0) {
            return None;
        }
        let mut command = format!("phong render {}", quoted(&self.path));
        if frame > 0 {
            command.push_str(" --frames ");
            command.push_str(&frame.to_string());
        }
        if let Some(look) = self.dressed {
            command.push_str(" --look ");
            command.push_str(look.name());
        }
        for change in look::changes(&self.set) {
            command.push_str(" --set ");
            command.push_str(&quoted(&change));
        }
        Some(command)
    }

    /// A program in Python that draws what is shown: from the file if it is the file that is shown,
    /// else from the text with what is laid over it written in.
    pub(super) fn python(&self) -> Result<String, String> {
        let frame = match self.frame.number {
            0 => String::new(),
            number => format!(", frame={number}"),
        };
        // Text of JSON is text of Python.
        let read = match (&self.text, self.set.is_empty()) {
            (text, true) if *text == self.as_read => {
                format!("phong.Scene.read({}{frame})", Value::from(self.path.as_str()))
            }
            (None, _) => return Err("a bare model that was changed has no text to copy".to_owned()),
            (Some(text), _) => {
                let text = written(text, &self.set)?
                    .replace('\\', "\\\\")
                    .replace("\"\"\"", "\\\"\\\"\\\"");
                format!("phong.Scene.parse(\"\"\"\\\n{text}\"\"\"{frame})")
            }
        };
        let camera = self.camera_of_first()?;
        let look = self.dressed.map(|look| format!("scene.look(\"{}\")\n", look.name()));
        let look = look.unwrap_or_default();
        Ok(format!(
            "import phong\n\nscene = {read}\n{camera}{look}phong.render(scene).save(\"picture.png\")\n"
        ))
    }

    /// The line of Python after which a later frame of a bare model is seen as the first is; its lights follow the
    /// camera. Nothing where that is so without it.
    fn camera_of_first(&self) -> Result<String, String> {
        if self.text.is_some() || self.frame.number == 0 {
            return Ok(String::new());
        }
        if self.frame.guesses() {
            let why = "the balls of this frame are as large as was guessed for the first, and Python guesses anew";
            return Err(format!("{why}: copy the first, and read another with `frame=` in it"));
        }
        let path = Value::from(self.path.as_str());
        Ok(format!(
            "# Seen as the first frame is.\nscene.camera = phong.Scene.read({path}).camera\n"
        ))
    }
}

/// A word for a shell: in single quotes where it holds anything but plain letters.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}
