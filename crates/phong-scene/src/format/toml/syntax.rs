//! Syntax errors: all of them, each at its own place, and the text that is left without them.
//!
//! A parser that meets `center = [0, 1` reads on for the `]` through half the file and then
//! complains about everything it met there. So when a text does not parse, it is cut into
//! statements (a header, or a key with its value), each is parsed alone, and those that fail are
//! blanked out; what remains parses as before, with every byte still at its place, and everything
//! else that is wrong with the scene can be said in the same go.

use std::collections::BTreeSet;
use std::ops::Range;

use toml::Spanned;
use toml::de::DeTable;

use super::notes::Notes;
use super::text::Spot;
use crate::wording::quoted;

/// Most syntax errors that are told of one file.
const MOST: usize = 20;

/// A text without its faulty statements.
#[derive(Debug)]
struct Mended {
    /// The text; blanks stand where statements were taken out.
    text: String,
    /// Where the tables begin that lost a statement: nothing can be said to be missing there.
    lost: BTreeSet<usize>,
}

/// Parses the text of a file; one with syntax errors without what is faulty, as it is in `mended`.
pub(super) fn parse<'t>(
    text: &'t str,
    file: u32,
    mended: &'t mut String,
    notes: &mut Notes,
) -> Spanned<DeTable<'t>> {
    if let Ok(document) = DeTable::parse(text) {
        return document;
    }
    let Mended { text, lost } = mend(file, notes);
    notes.lose(file, lost);
    *mended = text;
    DeTable::parse_recoverable(mended).0
}

/// Says the syntax errors of a text that does not parse, and takes the faulty statements out.
fn mend(file: u32, notes: &mut Notes) -> Mended {
    let text = std::sync::Arc::clone(notes.text(file));
    let text = text.text.as_str();
    let mut bytes = text.as_bytes().to_vec();
    let mut lost = BTreeSet::new();
    let (mut errors, mut count) = (Vec::new(), 0);
    let sections = sections(text);
    for section in &sections {
        if DeTable::parse(&text[section.clone()]).is_ok() {
            continue;
        }
        for Statement { range, unclosed } in statements(text, section.clone()) {
            let start = range.start;
            if bytes[range.clone()].iter().all(u8::is_ascii_whitespace) {
                continue; // lost with its header
            }
            let Err(error) = DeTable::parse(&text[range.clone()]) else { continue };
            // A table whose header cannot be read is lost wholly: its keys belong to no other.
            let header = range.start == section.start && text[range.clone()].starts_with('[');
            blank(&mut bytes, if header { section.clone() } else { range.clone() });
            lost.insert(section.start);
            count += 1;
            if errors.len() == MOST {
                continue;
            }
            errors.push(match unclosed {
                Some(open) => {
                    let message = format!("this `{}` is never closed", &text[open.clone()]);
                    (open, message, None)
                }
                None => foreign(text, range).unwrap_or_else(|| told(&error, text, start)),
            });
        }
    }
    // What is left are keys and tables written twice. The second is taken out as well, so that
    // the first is read as if it stood alone; beyond those that are told the parser decides.
    let rest = String::from_utf8_lossy(&bytes).into_owned();
    let twice = DeTable::parse_recoverable(&rest).1;
    count += twice.len();
    for error in twice.iter().take(MOST) {
        let at = error.span().map_or(0, |span| span.start);
        let section = sections[sections.partition_point(|s| s.start <= at).max(1) - 1].clone();
        let range = match statements(&rest, section.clone()).find(|s| s.range.contains(&at)) {
            Some(Statement { range, .. }) if range.start != section.start => range,
            _ if section.start == 0 && !rest.starts_with('[') => at..at,
            _ => section.clone(),
        };
        blank(&mut bytes, range);
        lost.insert(section.start);
        errors.push(told(error, text, 0));
    }
    errors.sort_by_key(|(range, ..)| range.start);
    for (i, (range, message, help)) in errors.into_iter().take(MOST).enumerate() {
        let message = if i + 1 == MOST && count > MOST {
            format!("{message} ({} more syntax errors are not shown)", count - MOST)
        } else {
            message
        };
        notes.error(Spot::new(file, range), message).help = help;
    }
    Mended { text: String::from_utf8_lossy(&bytes).into_owned(), lost }
}

type Told = (Range<usize>, String, Option<String>);

/// A value as it is written elsewhere: `(0, 1, 0)` for a list, `1,5` for a decimal number.
fn foreign(text: &str, statement: Range<usize>) -> Option<Told> {
    let (key, value) = text.get(statement.clone())?.split_once('=')?;
    let at = statement.start + key.len() + 1 + (value.len() - value.trim_start().len());
    let value = value.trim();
    if let Some(rest) = value.strip_prefix('(') {
        let end = rest.find(')')?;
        let help = format!("a list stands in square brackets: `[{}]`", rest.get(..end)?.trim());
        let message = "round brackets hold nothing here".to_owned();
        return Some((at..at + end + 2, message, Some(cut(help))));
    }
    let number = |c: char| c.is_ascii_digit() || "+-.,".contains(c);
    let end = value.find(|c: char| !number(c)).unwrap_or(value.len());
    let (number, rest) = value.split_at(end);
    let parts: Vec<&str> = number.split(',').collect();
    let digits = |part: &&str| part.parse::<f64>().is_ok();
    if parts.len() < 2
        || !parts.iter().all(digits)
        || !(rest.is_empty() || rest.starts_with([' ', '#']))
    {
        return None;
    }
    let help = match parts[..] {
        [whole, part] => format!("a decimal number has a point: `{whole}.{part}`"),
        _ => format!("a list stands in square brackets: `[{}]`", parts.join(", ")),
    };
    let message = format!("{} is no value", quoted(number));
    Some((at..at + end, message, Some(cut(help))))
}

/// A help of sane length.
fn cut(mut help: String) -> String {
    if let Some((end, _)) = help.char_indices().nth(120) {
        help.truncate(end);
        help.push('…');
    }
    help
}

/// The parser's error, its place counted from the beginning of the text.
///
/// Where its words are about the grammar, ours are about what to write.
fn told(error: &toml::de::Error, text: &str, from: usize) -> Told {
    let span = error.span().unwrap_or(0..0);
    let range = from + span.start..from + span.end;
    let here = text.get(range.clone()).unwrap_or_default();
    let (message, expected) =
        error.message().split_once(", expected ").unwrap_or((error.message(), ""));
    let (message, help) = match message {
        "duplicate key" => return (range, format!("{} is there already", quoted(here)), None),
        "string values must be quoted" if here.is_empty() => {
            ("a value is missing".to_owned(), None)
        }
        "string values must be quoted" => {
            let number = here.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
            let help = if number {
                "numbers are written like 12, -0.5 or 1e3, in a list with commas between".to_owned()
            } else {
                format!("text stands in quotes: {}", quoted(here))
            };
            (format!("{} is no value", quoted(here)), Some(help))
        }
        "invalid basic string" | "invalid literal string" if !expected.is_empty() => {
            (format!("the text has no closing {expected}"), None)
        }
        _ if expected.is_empty() || expected == "nothing" => (message.to_owned(), None),
        _ => (message.to_owned(), Some(format!("expected {expected}"))),
    };
    (range, message, help)
}

/// Overwrites with blanks, keeping the line breaks.
fn blank(bytes: &mut [u8], range: Range<usize>) {
    for byte in &mut bytes[range] {
        if *byte != b'\n' && *byte != b'\r' {
            *byte = b' ';
        }
    }
}

/// The text cut before every line that looks like a table's header.
fn sections(text: &str) -> Vec<Range<usize>> {
    let mut starts = vec![0];
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let trimmed = line.trim_start_matches([' ', '\t']);
        let name = trimmed.trim_start_matches('[');
        if trimmed.len() > name.len()
            && name.trim_start().starts_with(|c: char| c.is_alphabetic() || "_\"'".contains(c))
            && at > 0
        {
            starts.push(at + line.len() - trimmed.len());
        }
        at += line.len();
    }
    let ends = starts.iter().skip(1).copied().chain([text.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

/// A header, or a key with its value.
struct Statement {
    range: Range<usize>,
    /// What opens an array, table or long text that the statement does not end.
    unclosed: Option<Range<usize>>,
}

/// A section cut into statements, over line breaks only inside brackets and long strings.
fn statements(text: &str, section: Range<usize>) -> impl Iterator<Item = Statement> {
    let mut at = section.start;
    std::iter::from_fn(move || {
        if at >= section.end {
            return None;
        }
        let start = at;
        let mut open = Vec::new();
        let mut quote: Option<Range<usize>> = None;
        for line in text[start..section.end].split_inclusive('\n') {
            // A key in the middle of an array: the array was never closed.
            let inside_array = open.last().is_some_and(|&i| text.as_bytes()[i] == b'[');
            if at > start && quote.is_none() && inside_array && looks_like_a_key(line) {
                break;
            }
            let header = at == section.start && line.starts_with('[');
            if !header {
                scan_line(text, at..at + line.len(), &mut open, &mut quote);
            }
            at += line.len();
            if open.is_empty() && quote.is_none() {
                break;
            }
        }
        let bracket = open.first().map(|&at| at..at + 1);
        Some(Statement { range: start..at, unclosed: bracket.or(quote) })
    })
}

/// Follows brackets and long texts through one line: what is open, and the quotes of a long text.
fn scan_line(
    text: &str,
    line: Range<usize>,
    open: &mut Vec<usize>,
    quote: &mut Option<Range<usize>>,
) {
    let mut at = line.start;
    while let Some(c) = text[at..line.end].chars().next() {
        let rest = &text[at..line.end];
        let long = (rest.starts_with("\"\"\"") || rest.starts_with("'''")).then(|| at..at + 3);
        let mut step = c.len_utf8();
        match (quote.clone().map(|quote| &text[quote]), c) {
            (Some("\"\"\""), '\\') => step += rest[1..].chars().next().map_or(0, char::len_utf8),
            (Some(quotes), _) if rest.starts_with(quotes) => (*quote, step) = (None, 3),
            (None, '#') => return,
            (None, '"' | '\'') if long.is_some() => (*quote, step) = (long, 3),
            (None, '"' | '\'') => step = short_string(rest, c),
            (None, '[' | '{') => open.push(at),
            (None, ']' | '}') => drop(open.pop()),
            _ => {}
        }
        at += step;
    }
}

/// The bytes of the string that `rest` begins with; it ends with its line.
fn short_string(rest: &str, quote: char) -> usize {
    let mut escaped = false;
    for (i, c) in rest.char_indices().skip(1) {
        if c == quote && !escaped {
            return i + 1;
        }
        escaped = quote == '"' && c == '\\' && !escaped;
    }
    rest.len()
}

/// Whether a line begins `key =`.
fn looks_like_a_key(line: &str) -> bool {
    let word = |c: char| c.is_alphanumeric() || "_-.\"' \t".contains(c);
    let line = line.trim_start();
    let rest = line.trim_start_matches(word);
    line.starts_with(|c: char| c.is_alphanumeric() || "_\"'".contains(c)) && rest.starts_with('=')
}
