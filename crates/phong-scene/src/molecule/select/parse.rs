//! The text of a selection, read by recursive descent.

use std::ops::Range;

use super::super::names;
use super::{Expression, Kind, Order, Value};
use crate::wording::{closest, list, quoted};

/// Parentheses and `not`s within one another, at most.
const DEEPEST: usize = 64;

/// What is wrong with the text of a selection.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Misspelt {
    /// The bytes of the text that are meant.
    pub(crate) at: Range<usize>,
    /// What it is.
    pub(crate) message: String,
    /// The way out.
    pub(crate) help: Option<String>,
}

/// Fields by the words for them.
const FIELDS: [(&str, &str); 24] = [
    ("element", "element"),
    ("elem", "element"),
    ("index", "index"),
    ("x", "x"),
    ("y", "y"),
    ("z", "z"),
    ("name", names::NAME),
    ("residue", names::RESIDUE),
    ("resname", names::RESIDUE),
    ("resn", names::RESIDUE),
    ("number", names::NUMBER),
    ("resid", names::NUMBER),
    ("resi", names::NUMBER),
    ("resseq", names::NUMBER),
    ("chain", names::CHAIN),
    ("segment", names::SEGMENT),
    ("segid", names::SEGMENT),
    ("b-factor", names::B_FACTOR),
    ("bfactor", names::B_FACTOR),
    ("beta", names::B_FACTOR),
    ("occupancy", names::OCCUPANCY),
    ("charge", names::CHARGE),
    ("type", names::TYPE),
    ("molecule", names::MOLECULE),
];

const WORDS: [&str; 5] = ["and", "or", "not", "all", "none"];

/// A word, a comparison or a parenthesis of the text.
#[derive(Clone, Debug, PartialEq)]
struct Token {
    text: String,
    at: Range<usize>,
    quoted: bool,
}

pub(super) fn parse(text: &str) -> Result<Expression, Misspelt> {
    let tokens = tokens(text)?;
    let mut parser = Parser { tokens: &tokens, next: 0, end: text.len() };
    if tokens.is_empty() {
        return Err(parser.wrong("nothing is selected", Some("`all` selects everything")));
    }
    let expression = parser.either(0)?;
    if let Some(token) = parser.peek() {
        let message = match token.text.as_str() {
            ")" => "this `)` closes nothing".to_owned(),
            word => format!("{} stands where `and` or `or` is wanted", quoted(word)),
        };
        return Err(parser.wrong(message, None));
    }
    Ok(expression)
}

fn tokens(text: &str) -> Result<Vec<Token>, Misspelt> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = match first {
            _ if first.is_whitespace() => {
                at += first.len_utf8();
                continue;
            }
            '"' | '\'' if rest[1..].contains(first) => {
                let inner = rest[1..].find(first).unwrap_or(0);
                let text = rest[1..=inner].to_owned();
                tokens.push(Token { text, at: at..at + inner + 2, quoted: true });
                at += inner + 2;
                continue;
            }
            '(' | ')' => 1,
            '<' | '>' | '=' | '!' => 1 + usize::from(rest[1..].starts_with('=')),
            _ => {
                let ends = |c: char| c.is_whitespace() || "()<>=!".contains(c);
                rest.find(ends).unwrap_or(rest.len())
            }
        };
        tokens.push(Token { text: rest[..length].to_owned(), at: at..at + length, quoted: false });
        at += length;
        if tokens.len() > 10_000 {
            return Err(Misspelt {
                at: at..text.len(),
                message: "the selection is too long".to_owned(),
                help: None,
            });
        }
    }
    Ok(tokens)
}

struct Parser<'a> {
    tokens: &'a [Token],
    next: usize,
    end: usize,
}

impl<'a> Parser<'a> {
    fn peek(&self) -> Option<&'a Token> {
        self.tokens.get(self.next)
    }

    /// Takes the next token if it is this word.
    fn take(&mut self, word: &str) -> bool {
        let is = self.peek().is_some_and(|t| !t.quoted && t.text.eq_ignore_ascii_case(word));
        self.next += usize::from(is);
        is
    }

    /// Something is wrong with the next token, or with the end.
    fn wrong(&self, message: impl Into<String>, help: Option<&str>) -> Misspelt {
        let at = self.peek().map_or(self.end..self.end, |token| token.at.clone());
        Misspelt { at, message: message.into(), help: help.map(str::to_owned) }
    }

    fn either(&mut self, depth: usize) -> Result<Expression, Misspelt> {
        let mut left = self.both(depth)?;
        while self.take("or") {
            left = Expression::Or(Box::new(left), Box::new(self.both(depth)?));
        }
        Ok(left)
    }

    fn both(&mut self, depth: usize) -> Result<Expression, Misspelt> {
        let mut left = self.one(depth)?;
        while self.take("and") {
            left = Expression::And(Box::new(left), Box::new(self.one(depth)?));
        }
        Ok(left)
    }

    fn one(&mut self, depth: usize) -> Result<Expression, Misspelt> {
        if depth > DEEPEST {
            return Err(self.wrong("the selection is nested too deeply", None));
        }
        if self.take("not") {
            return Ok(Expression::Not(Box::new(self.one(depth + 1)?)));
        }
        if self.take("(") {
            let inner = self.either(depth + 1)?;
            if !self.take(")") {
                return Err(self.wrong("a `)` is missing", None));
            }
            return Ok(inner);
        }
        let Some(token) = self.peek() else {
            return Err(self.wrong("the selection ends where more is wanted", None));
        };
        let lower = token.text.to_ascii_lowercase();
        if ["and", "or", ")", "<", ">", "<=", ">=", "=", "==", "!", "!="].contains(&lower.as_str())
        {
            let message = format!("`{lower}` stands where atoms are wanted");
            return Err(self.wrong(message, None));
        }
        for (word, simple) in [("all", Expression::All), ("none", Expression::None)] {
            if self.take(word) {
                return Ok(simple);
            }
        }
        if let Some((_, kind)) = Kind::WORDS.iter().find(|(word, _)| *word == lower) {
            self.next += 1;
            return Ok(Expression::Kind(*kind));
        }
        self.field(token, &lower)
    }

    /// A field and its values, or a comparison.
    fn field(&mut self, token: &Token, lower: &str) -> Result<Expression, Misspelt> {
        let known = FIELDS.iter().find(|(word, _)| *word == lower);
        let field = known.map_or(token.text.clone(), |(_, field)| (*field).to_owned());
        let at = token.at.clone();
        self.next += 1;
        if let Some(order) = self.order() {
            let number = self.peek().and_then(|token| token.text.parse::<f64>().ok());
            let word = self.peek().map(|token| token.text.clone());
            return match (number.filter(|n| !n.is_nan()), word) {
                (Some(number), _) => {
                    self.next += 1;
                    Ok(Expression::Compare { field, at, order, number })
                }
                // `chain = A` is as good as `chain A`.
                (None, Some(word)) if matches!(order, Order::Equal | Order::NotEqual) => {
                    self.next += 1;
                    let is = Expression::Values { field, at, values: vec![Value::Word(word)] };
                    Ok(if order == Order::Equal { is } else { Expression::Not(Box::new(is)) })
                }
                _ => Err(self.wrong("a number is wanted here", None)),
            };
        }
        let mut values = Vec::new();
        while let Some(token) = self.peek() {
            let ends = |word: &str| token.text.eq_ignore_ascii_case(word);
            if !token.quoted && (["and", "or", "not", ")", "("].into_iter().any(ends)) {
                break;
            }
            values.push(value(token));
            self.next += 1;
        }
        if values.is_empty() {
            self.next -= 1;
            if known.is_some() {
                let message = format!("`{lower}` is followed by no value");
                return Err(self.wrong(message, Some("as in `chain A B` or `x < 10`")));
            }
            let words = || {
                let kinds = Kind::WORDS.iter().map(|(word, _)| *word);
                WORDS.into_iter().chain(kinds).chain(FIELDS.iter().map(|(word, _)| *word))
            };
            let help = match closest(lower, words()) {
                Some(meant) => format!("did you mean `{meant}`?"),
                None => format!("known are {}", list(words().take(14), "and")),
            };
            let message = format!("{} selects nothing that is known", quoted(&token.text));
            return Err(self.wrong(message, Some(&help)));
        }
        Ok(Expression::Values { field, at, values })
    }

    fn order(&mut self) -> Option<Order> {
        let order = match self.peek()?.text.as_str() {
            "<" => Order::Less,
            "<=" => Order::LessOrEqual,
            ">" => Order::Greater,
            ">=" => Order::GreaterOrEqual,
            "=" | "==" => Order::Equal,
            "!=" => Order::NotEqual,
            _ => return None,
        };
        self.next += 1;
        Some(order)
    }
}

fn value(token: &Token) -> Value {
    let text = &token.text;
    if token.quoted {
        return Value::Word(text.clone());
    }
    let number = |text: &str| text.parse::<f64>().ok().filter(|n| n.is_finite());
    if let Some(number) = number(text) {
        return Value::Numbers(number, number, text.clone());
    }
    // A range: the sign of its first number stands at the beginning.
    let between = |separator: char| {
        let at = text.char_indices().skip(1).find(|(_, c)| *c == separator)?.0;
        Some((number(&text[..at])?, number(&text[at + 1..])?))
    };
    match between('-').or_else(|| between(':')) {
        Some((first, last)) => Value::Numbers(first, last, text.clone()),
        None => Value::Word(text.clone()),
    }
}
