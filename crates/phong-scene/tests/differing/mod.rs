//! A value as text, without what is as by default: so a new field touches no snapshot but those
//! where it is set.

use std::fmt::Debug;

/// `Type { field: value, .. }` with the fields in which the value is not as `default`.
pub(crate) fn differing<T: Debug>(value: &T, default: &T) -> String {
    let (value, default) = (format!("{value:?}"), format!("{default:?}"));
    let Some((name, own)) = fields(&value) else { return value };
    let default = fields(&default).map_or(Vec::new(), |(_, fields)| fields);
    let differ: Vec<_> = own.into_iter().filter(|field| !default.contains(field)).collect();
    match differ.len() {
        0 => format!("{name} {{ .. }}"),
        _ => format!("{name} {{ {}, .. }}", differ.join(", ")),
    }
}

/// The name and the fields of a struct as `Debug` shows it.
fn fields(text: &str) -> Option<(&str, Vec<&str>)> {
    let (name, inner) = text.split_once(" { ")?;
    let inner = inner.strip_suffix(" }")?;
    let (mut fields, mut depth, mut quoted, mut start) = (Vec::new(), 0, false, 0);
    let mut before = ' ';
    for (i, c) in inner.char_indices() {
        match c {
            '"' if before != '\\' => quoted = !quoted,
            '{' | '[' | '(' if !quoted => depth += 1,
            '}' | ']' | ')' if !quoted => depth -= 1,
            ',' if !quoted && depth == 0 => {
                fields.push(inner[start..i].trim());
                start = i + 1;
            }
            _ => {}
        }
        before = if before == '\\' && c == '\\' { ' ' } else { c };
    }
    fields.push(inner[start..].trim());
    Some((name, fields))
}
