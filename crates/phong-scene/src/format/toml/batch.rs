//! Batch files: read as scenes are, by their table of keys.

use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::change::Target;
use super::notes::Notes;
use super::syntax;
use super::table::{Values, read_value};
use super::text::{self, Spot};
use crate::batch::{Batch, BatchReading, ChangeSource, Parameter, ParameterValues, Written};
use crate::change::Change;
use crate::diagnostic::Diagnostic;
use crate::keys::{BATCH, FILES, Kind, RANGE};
use crate::limits::Limits;
use crate::source::Source;
use crate::wording::quoted;

/// Options of `sbatch` that the job script sets itself.
const SET_BY_THE_SCRIPT: &[&str] =
    &["array", "dependency", "kill-on-invalid-dep", "wrap", "parsable"];

/// Reads a batch file, and everything there is to say about it; no file that it names is opened.
///
/// ```
/// use phong_scene::{Limits, Memory, read_batch};
/// let text = "version = 1\ninputs = \"a.toml\"\n[parameters]\n\"camera.fovv\" = [20, 40]\n";
/// let files = Memory::new().with("a-batch.toml", text.as_bytes());
/// let reading = read_batch("a-batch.toml", &files, &Limits::default());
/// assert_eq!(
///     reading.diagnostics[0].to_string(),
///     "a-batch.toml:4:9: error: unknown key \"fovv\" in this `camera` (did you mean `fov`?)",
/// );
/// ```
pub fn read_batch(path: &str, source: &dyn Source, limits: &Limits) -> BatchReading {
    let text = match text::open(path, source, limits) {
        Ok(text) => text,
        Err(error) => return BatchReading { batch: None, diagnostics: vec![*error] },
    };
    let mut notes = Notes::default();
    let file = notes.add(Arc::clone(&text));
    let mut mended = String::new();
    let document = syntax::parse(&text.text, file, &mut mended, &mut notes);
    let source = (Arc::clone(&text.file), Arc::from(text.text.as_str()));
    let mut reader = Reader { notes, file, source };
    let batch = reader.batch(document.get_ref());
    let batch = batch.filter(|_| !reader.notes.has_errors());
    BatchReading { batch, diagnostics: reader.notes.into_diagnostics() }
}

struct Reader {
    notes: Notes,
    file: u32,
    /// The file's name and its text, for the changes.
    source: (Arc<str>, Arc<str>),
}

impl Reader {
    fn spot(&self, range: Range<usize>) -> Spot {
        Spot::new(self.file, range)
    }

    fn written(&self, text: String, range: Range<usize>) -> Written {
        Written { text, span: self.notes.span(self.spot(range)) }
    }

    fn batch(&mut self, document: &DeTable<'_>) -> Option<Batch> {
        let head = self.spot(0..0);
        let values = Values::read(&BATCH, document, head, &mut self.notes);
        self.notes.miss_version(document, head);
        let table = |name| document.get(name);
        let parameters = table("parameters").map(|value| self.parameters(value));
        let slurm = table("slurm").map(|value| self.slurm(value));
        let text = |name: &str| {
            let spot = values.spot_of(name);
            values.text(name).map(|text| self.written(text, spot.start..spot.end))
        };
        Some(Batch {
            inputs: values
                .texts("inputs")?
                .into_iter()
                .map(|(text, range)| self.written(text, range))
                .collect(),
            output: text("output"),
            name: text("name"),
            options: text("options"),
            zip: values.word("combine") == Some("zip"),
            shares: values.integer("shares")? as u32,
            threads: values.integer("threads").map(|threads| threads as u32),
            parameters: parameters.unwrap_or_default(),
            slurm: slurm.unwrap_or_default(),
        })
    }

    fn must_be_a_table(&mut self, name: &str, value: &Spanned<DeValue<'_>>) {
        let at = self.spot(value.span());
        self.notes.error(at, format!("`{name}` must be one table")).help =
            Some(format!("write `[{name}]`"));
    }

    /// Options of `sbatch`: its own words, so only their form is looked at.
    fn slurm(&mut self, value: &Spanned<DeValue<'_>>) -> Vec<(Written, String)> {
        let Some(table) = value.get_ref().as_table() else {
            self.must_be_a_table("slurm", value);
            return Vec::new();
        };
        let mut options = Vec::new();
        for (name, value) in table {
            let at = self.spot(name.span());
            let name: &str = name.get_ref();
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(plain) {
                let message = format!("{} is no option of sbatch", quoted(name));
                self.notes.error(at, message).help =
                    Some("write its long name without the dashes, like `time`".to_owned());
                continue;
            }
            if SET_BY_THE_SCRIPT.contains(&name) {
                self.notes.error(at, format!("the script sets `{name}` itself")).help =
                    Some("leave it out".to_owned());
                continue;
            }
            let text = match value.get_ref() {
                DeValue::String(text) => text.to_string(),
                DeValue::Integer(number) => number.to_string(),
                DeValue::Float(number) => number.to_string(),
                DeValue::Boolean(true) => String::new(),
                DeValue::Boolean(false) => continue,
                _ => "\n".to_owned(),
            };
            if text.chars().any(char::is_control) {
                let at = self.spot(value.span());
                let message = format!("`{name}` must be text, a number or `true`, on one line");
                self.notes.error(at, message);
                continue;
            }
            options.push((self.written(name.to_owned(), at.start..at.end), text));
        }
        options.sort_by_key(|(name, _)| (name.span.place.line, name.span.place.column));
        options
    }

    fn parameters(&mut self, value: &Spanned<DeValue<'_>>) -> Vec<Parameter> {
        let Some(table) = value.get_ref().as_table() else {
            self.must_be_a_table("parameters", value);
            return Vec::new();
        };
        let mut found = Vec::new();
        paths(table, "", 0, &mut found);
        found.sort_by_key(|(_, at, _)| *at);
        let mut all: Vec<Parameter> = Vec::with_capacity(found.len());
        for (path, at, value) in found {
            if let Some(first) = all.iter().find(|first| first.path.text == path) {
                let label = first.path.span.clone();
                let range = at..at + path.len();
                let span = self.notes.span(self.spot(range.clone()));
                let error = Diagnostic::error(format!("`{path}` has values already"), span);
                self.notes.say(self.spot(range), error.with_label("first here", label));
                continue;
            }
            all.extend(self.parameter(&path, at, value));
        }
        all
    }

    fn parameter(
        &mut self,
        path: &str,
        path_at: usize,
        value: &Spanned<DeValue<'_>>,
    ) -> Option<Parameter> {
        let target = match Target::of(path) {
            Ok(target) => target,
            Err((from, message, help)) => {
                let at = self.spot(path_at + from..path_at + path.len());
                self.notes.error(at, message).help = help;
                return None;
            }
        };
        let (file, text) = self.source.clone();
        let source = ChangeSource { file, text, path_at, value_at: value.span() };
        let at = self.spot(value.span());
        let values = match value.get_ref() {
            DeValue::Array(items) if items.is_empty() => {
                self.notes.error(at, format!("`{path}` has no values"));
                return None;
            }
            DeValue::Array(items) => {
                let check = |item| self.literal(target, path, &source, item);
                let read: Vec<_> = items.iter().map(check).collect();
                ParameterValues::Changes(read.into_iter().collect::<Option<_>>()?)
            }
            DeValue::Table(table) if is_range(table) => {
                let range = Values::read(&RANGE, table, at, &mut self.notes);
                ParameterValues::Changes(self.range(target, path, &source, &range)?)
            }
            DeValue::Table(table) if table.contains_key("files") => {
                let files = Values::read(&FILES, table, at, &mut self.notes);
                if !matches!(target.key.kind, Kind::File) {
                    self.notes.error(at, format!("`{path}` names no file")).help =
                        Some("give a list of values".to_owned());
                    return None;
                }
                let at = files.spot_of("files");
                ParameterValues::Files(self.written(files.text("files")?, at.start..at.end))
            }
            _ => ParameterValues::Changes(vec![self.literal(target, path, &source, value)?]),
        };
        let path = self.written(path.to_owned(), path_at..path_at + path.len());
        Some(Parameter { path, values, source })
    }

    /// A value as it is written.
    fn literal(
        &mut self,
        target: Target<'_>,
        path: &str,
        source: &ChangeSource,
        value: &Spanned<DeValue<'_>>,
    ) -> Option<Change> {
        let good = !target.is_single() || self.is_good(target, value);
        let written = source.text.get(value.span()).unwrap_or_default();
        good.then(|| source.change(path, written.to_owned(), value.span().start))
    }

    /// Values at equal distances.
    fn range(
        &mut self,
        target: Target<'_>,
        path: &str,
        source: &ChangeSource,
        range: &Values,
    ) -> Option<Vec<Change>> {
        let (from, to) = (range.numbers("from")?, range.numbers("to")?);
        if from.len() != to.len() {
            let message = format!("`from` has {} numbers, `to` has {}", from.len(), to.len());
            self.notes.error(range.spot_of("to"), message);
            return None;
        }
        let steps = range.integer("steps")?;
        (0..steps)
            .map(|step| {
                let t = if steps > 1 { step as f64 / (steps - 1) as f64 } else { 0.0 };
                let number = |(from, to): (&f64, &f64)| {
                    // Beyond the twelfth digit is the noise of this very sum.
                    let rough = format!("{:.12e}", from * (1.0 - t) + to * t);
                    rough.parse::<f64>().unwrap_or(*from).to_string()
                };
                let numbers: Vec<_> = from.iter().zip(&to).map(number).collect();
                let value = match &numbers[..] {
                    [only] => only.clone(),
                    all => format!("[{}]", all.join(", ")),
                };
                let change = source.change(path, value, source.value_at.start);
                let document = change.document();
                let parsed = DeTable::parse(&document).ok()?;
                let parsed = parsed.get_ref().get("v")?;
                (!target.is_single() || self.is_good(target, parsed)).then_some(change)
            })
            .collect()
    }

    /// Whether a value is one of the key's; else that is said.
    fn is_good(&mut self, target: Target<'_>, value: &Spanned<DeValue<'_>>) -> bool {
        let Target { table, key, .. } = target;
        read_value(table, key, value, self.file, &mut Vec::new(), &mut self.notes).is_some()
    }
}

fn is_range(table: &DeTable<'_>) -> bool {
    ["from", "to", "steps"].iter().any(|key| table.contains_key(*key))
}

/// The paths in a table of parameters, each with where its last word stands so that the path ends
/// there: `"camera.eye" = ..`, `camera.eye = ..` and `camera = { eye = .. }` are one.
fn paths<'t>(
    table: &'t DeTable<'t>,
    before: &str,
    from: usize,
    found: &mut Vec<(String, usize, &'t Spanned<DeValue<'t>>)>,
) {
    for (name, value) in table {
        let path = format!("{before}{}", name.get_ref());
        // A quoted key begins behind its quotation mark.
        let own = name.span().start + usize::from(name.span().len() > name.get_ref().len());
        let at = if before.is_empty() { own } else { from };
        match value.get_ref() {
            DeValue::Table(inside)
                if Target::of(&path).is_err()
                    && !is_range(inside)
                    && !inside.contains_key("files") =>
            {
                paths(inside, &format!("{path}."), at, found);
            }
            _ => found.push((path, at, value)),
        }
    }
}
