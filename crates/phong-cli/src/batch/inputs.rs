//! The files that a pattern stands for.

use std::cmp::Ordering;
use std::path::Path;

use glob::{MatchOptions, Pattern};
use phong_scene::{Diagnostic, Written, path_of, path_text};

use crate::input;

/// The files of a path or a pattern, which counts from `folder`; their names sorted as people count.
pub(super) fn files(written: &Written, folder: &Path) -> Result<Vec<String>, Box<Diagnostic>> {
    let wrong = |message: String, help: Option<String>| {
        let error = Diagnostic::error(message, written.span.clone());
        Box::new(Diagnostic { help, ..error })
    };
    if !written.text.contains(['*', '?', '[']) {
        let path = folder.join(path_of(&written.text));
        if let Some((message, help)) = input::missing(&path) {
            return Err(wrong(format!("{}: {message}", path.display()), help));
        }
        return Ok(vec![path_text(path.as_os_str())]);
    }
    let folder = Pattern::escape(&folder.to_string_lossy());
    let pattern = Path::new(&folder).join(&written.text);
    let options = MatchOptions { require_literal_leading_dot: true, ..MatchOptions::new() };
    let found = glob::glob_with(&pattern.to_string_lossy(), options)
        .map_err(|error| wrong(format!("this is no pattern of files: {}", error.msg), None))?;
    // What cannot be looked into has no files for us.
    let files = found.filter_map(Result::ok).filter(|path| path.is_file());
    let mut files: Vec<String> = files.map(|path| path_text(path.as_os_str())).collect();
    if files.is_empty() {
        let help =
            "look at the pattern and the folder; patterns count from the batch file's folder";
        return Err(wrong("no file is called like this".to_owned(), Some(help.to_owned())));
    }
    files.sort_by(|a, b| natural(a, b));
    Ok(files)
}

/// `frame-2` before `frame-10`: digits are compared as numbers, all else letter by letter.
fn natural(a: &str, b: &str) -> Ordering {
    let (mut left, mut right) = (a.as_bytes(), b.as_bytes());
    while let (Some(x), Some(y)) = (left.first(), right.first()) {
        let order = if x.is_ascii_digit() && y.is_ascii_digit() {
            let (m, n) = (number(&mut left), number(&mut right));
            m.len().cmp(&n.len()).then_with(|| m.cmp(n))
        } else {
            (left, right) = (&left[1..], &right[1..]);
            x.cmp(y)
        };
        if order != Ordering::Equal {
            return order;
        }
    }
    left.len().cmp(&right.len()).then_with(|| a.cmp(b))
}

/// The digits in front, taken off, without leading zeros.
fn number<'t>(text: &mut &'t [u8]) -> &'t [u8] {
    let end = text.iter().position(|b| !b.is_ascii_digit()).unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    *text = rest;
    &digits[digits.iter().position(|&b| b != b'0').unwrap_or(digits.len())..]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_are_sorted_as_numbers() {
        let mut names = ["f-10", "f-9", "f-010", "f-1b", "f-1a", "e-99", "f", "f-2", "f-"];
        names.sort_by(|a, b| natural(a, b));
        assert_eq!(names, ["e-99", "f", "f-", "f-1a", "f-1b", "f-2", "f-9", "f-010", "f-10"]);
    }
}
