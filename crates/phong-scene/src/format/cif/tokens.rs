//! The words of a CIF file: bare ones, quoted ones, and texts between lines that begin with `;`.

/// A word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Token<'a> {
    /// Without quotes.
    pub(super) text: &'a [u8],
    /// The line it begins on.
    pub(super) line: u64,
    /// Whether it stood in quotes, so that it is a value whatever it says.
    pub(super) quoted: bool,
}

impl Token<'_> {
    /// Whether it is a name of a value.
    pub(super) fn is_name(&self) -> bool {
        !self.quoted && self.text.starts_with(b"_")
    }

    /// Whether it begins so, in capitals or not.
    pub(super) fn is_heading(&self, word: &[u8]) -> bool {
        let text = self.text;
        !self.quoted && text.len() >= word.len() && text[..word.len()].eq_ignore_ascii_case(word)
    }

    /// Whether it is this word, in capitals or not.
    pub(super) fn is_word(&self, word: &[u8]) -> bool {
        !self.quoted && self.text.eq_ignore_ascii_case(word)
    }

    /// Whether it is a value, not a name or a word of the language.
    pub(super) fn is_value(&self) -> bool {
        let heading = |word| self.is_heading(word);
        !self.is_name()
            && !self.is_word(b"loop_")
            && !heading(b"data_")
            && !heading(b"save_")
            && !self.is_word(b"stop_")
            && !self.is_word(b"global_")
    }
}

/// Walks over the words of a text.
#[derive(Debug)]
pub(super) struct Tokens<'a> {
    text: &'a [u8],
    at: usize,
    line: u64,
    /// Where a text begins that does not end.
    pub(super) unclosed: Option<u64>,
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { text, at: 0, line: 1, unclosed: None }
    }

    /// The rest of the text.
    fn rest(&self) -> &'a [u8] {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Goes over blanks and comments.
    fn skip_blanks(&mut self) {
        while let Some(byte) = self.rest().first() {
            match byte {
                b'\n' => self.line += 1,
                ..=b' ' => {}
                b'#' => {
                    let rest = self.rest();
                    self.at += rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
                    continue;
                }
                _ => return,
            }
            self.at += 1;
        }
    }

    /// Takes `count` bytes as a word and goes over `quotes` more.
    fn take(&mut self, count: usize, quotes: usize) -> Token<'a> {
        let (rest, line) = (self.rest(), self.line);
        let start = quotes.min(1);
        let text = &rest[start..start + count];
        self.line += text.iter().map(|b| u64::from(*b == b'\n')).sum::<u64>();
        self.at += count + quotes;
        Token { text, line, quoted: quotes > 0 }
    }
}

impl<'a> Iterator for Tokens<'a> {
    type Item = Token<'a>;

    fn next(&mut self) -> Option<Token<'a>> {
        self.skip_blanks();
        let rest = self.rest();
        let first = *rest.first()?;
        let at_line = self.at == 0 || self.text[self.at - 1] == b'\n';
        if first == b';' && at_line {
            let ends = |pair: &[u8]| pair == b"\n;";
            let Some(end) = rest.windows(2).position(ends) else {
                self.unclosed = Some(self.line);
                self.at = self.text.len();
                return None;
            };
            let token = self.take(end - 1, 1);
            // The line feed and the semicolon.
            self.at += 2;
            self.line += 1;
            return Some(token);
        }
        if first == b'\'' || first == b'"' {
            let line = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
            let closes = |at: &usize| {
                rest[*at] == first && rest.get(at + 1).is_none_or(|next| *next <= b' ')
            };
            if let Some(end) = (1..line).find(closes) {
                return Some(self.take(end - 1, 2));
            }
        }
        let end = rest.iter().position(|b| *b <= b' ').unwrap_or(rest.len());
        Some(self.take(end, 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_bare_quoted_or_between_semicolons() {
        let text = b"data_x # comment\n_a 'it''s' \"O5'\" a'b\n;text\nof lines\n;\nloop_\n_b\n";
        let words: Vec<_> = Tokens::new(text)
            .map(|t| (String::from_utf8_lossy(t.text).into_owned(), t.line))
            .collect();
        let expected = [
            ("data_x", 1),
            ("_a", 2),
            ("it''s", 2),
            ("O5'", 2),
            ("a'b", 2),
            ("text\nof lines", 3),
            ("loop_", 6),
            ("_b", 7),
        ];
        assert_eq!(words, expected.map(|(word, line)| (word.to_owned(), line)));
    }

    #[test]
    fn a_text_without_an_end_is_told() {
        let mut tokens = Tokens::new(b"_a\n;never\nends");
        assert_eq!(tokens.by_ref().count(), 1);
        assert_eq!(tokens.unclosed, Some(2));
        assert_eq!(Tokens::new(b";").count(), 0);
    }
}
