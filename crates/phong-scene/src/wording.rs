//! The words that diagnostics share: near misses, cut quotes, lists.

use strsim::damerau_levenshtein;

/// Longest text, in characters, that a message repeats or a near miss is looked for.
const LONGEST: usize = 60;

/// The known word that `word` most likely means: differs in about a third of its letters at most.
///
/// Case counts for nothing, and neither do dashes, blanks and underlines. `None`: none is near.
///
/// ```
/// assert_eq!(phong_scene::closest("fong", ["lambert", "phong"]), Some("phong"));
/// assert_eq!(phong_scene::closest("gouraud", ["lambert", "phong"]), None);
/// ```
pub fn closest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.chars().count() > LONGEST {
        return None; // comparing takes time and memory by the product of the lengths
    }
    let plain = |text: &str| text.to_lowercase().replace(['-', ' '], "_");
    known
        .into_iter()
        .map(|candidate| (damerau_levenshtein(&plain(word), &plain(candidate)), candidate))
        .filter(|&(distance, candidate)| distance <= ((candidate.chars().count() + 1) / 3).max(1))
        .filter(|&(distance, candidate)| distance < candidate.chars().count())
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// What is one of some words in the scene text.
pub(crate) trait Word: Sized + 'static {
    /// All of them, in the order that they are listed.
    const WORDS: &'static [&'static str];

    /// Its word.
    fn word(&self) -> &'static str;

    /// What a word means; of a kind that holds more, with values for the reader to replace.
    fn of_word(word: &str) -> Option<Self>;
}

/// Gives each kind of an enum its word: `words!(Viewer { "local" = Local, "distant" = Distant })`.
macro_rules! words {
    ($type:ty { $($word:literal = $kind:ident $({ $($field:ident: $value:expr),+ $(,)? })? $(($inner:expr))?),+ $(,)? }) => {
        impl $crate::wording::Word for $type {
            const WORDS: &'static [&'static str] = &[$($word),+];

            fn word(&self) -> &'static str {
                match self {
                    $(Self::$kind { .. } => $word),+
                }
            }

            fn of_word(word: &str) -> Option<Self> {
                Some(match word {
                    $($word => Self::$kind $({ $($field: $value),+ })? $(($inner))?,)+
                    _ => return None,
                })
            }
        }
    };
}
pub(crate) use words;

/// `text` between quotes, cut to a sane length.
pub(crate) fn quoted(text: &str) -> String {
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{:?}…", &text[..end]),
        None => format!("{text:?}"),
    }
}

/// A path in a sentence; of a very long one the end.
pub(crate) fn path(text: &str) -> String {
    match text.char_indices().rev().nth(4 * LONGEST) {
        Some((start, _)) => format!("`…{}`", &text[start..]),
        None => format!("`{text}`"),
    }
}

/// `a`, `b` or `c`, each cut to a sane length.
pub(crate) fn list<'a>(words: impl IntoIterator<Item = &'a str>, last: &str) -> String {
    let cut = |word: &'a str| match word.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("`{}…`", &word[..end]),
        None => format!("`{word}`"),
    };
    let words: Vec<_> = words.into_iter().map(cut).collect();
    match words.split_last() {
        None => String::new(),
        Some((only, [])) => only.clone(),
        Some((end, rest)) if last == "," => format!("{}, {end}", rest.join(", ")),
        Some((end, rest)) => format!("{} {last} {end}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_near_miss_finds_its_word() {
        let known = ["center", "radius", "material"];
        assert_eq!(closest("centre", known), Some("center"));
        assert_eq!(closest("radus", known), Some("radius"));
        assert_eq!(closest("colour", known), None);
        assert_eq!(closest("fong", ["lambert", "phong", "ggx"]), Some("phong"));
        assert_eq!(closest("file", ["size", "seed"]), None);
    }

    #[test]
    fn case_and_dashes_hardly_count() {
        assert_eq!(closest("Look-At", ["look_at"]), Some("look_at"));
    }

    #[test]
    fn a_short_key_is_not_the_answer_to_everything() {
        assert_eq!(closest("x", ["k", "up"]), None);
    }

    #[test]
    fn a_very_long_word_is_not_compared_and_quoted_cut() {
        let long = "é".repeat(1_000_000);
        assert_eq!(closest(&long, ["center"]), None);
        assert!(quoted(&long).chars().count() < 70);
        assert!(path(&long).chars().count() < 250);
        assert!(list([long.as_str()], "or").chars().count() < 70);
    }

    #[test]
    fn lists_read_as_sentences() {
        assert_eq!(list([], "or"), "");
        assert_eq!(list(["a"], "or"), "`a`");
        assert_eq!(list(["a", "b", "c"], "and"), "`a`, `b` and `c`");
    }
}
