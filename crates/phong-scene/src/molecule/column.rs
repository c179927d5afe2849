//! Columns: a value an atom, numbers or words.

use std::collections::BTreeMap;

/// A value an atom, under a name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    /// What it is called.
    pub(crate) name: String,
    /// The values.
    pub(crate) values: Values,
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Values {
    /// Numbers; NaN: none.
    Numbers(Vec<f32>),
    /// Words.
    Words(Words),
}

/// Words, each kept once.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Words {
    /// The words, in the order they first come.
    pub(crate) names: Vec<String>,
    /// For every atom the number of its word.
    pub(crate) numbers: Vec<u32>,
    /// Their numbers, once there are many.
    known: BTreeMap<String, u32>,
}

/// Words that are looked for one by one.
const FEW: usize = 8;

impl Column {
    /// A column of words, empty yet.
    pub(crate) fn of_words(name: &str) -> Self {
        Self { name: name.to_owned(), values: Values::Words(Words::default()) }
    }

    /// A column of numbers, empty yet.
    pub(crate) fn of_numbers(name: &str) -> Self {
        Self { name: name.to_owned(), values: Values::Numbers(Vec::new()) }
    }
}

impl Values {
    /// Appends a number, written as it is where the column holds words.
    pub(crate) fn push_number(&mut self, number: f32) {
        match self {
            Self::Numbers(numbers) => numbers.push(number),
            Self::Words(words) => words.push(number.to_string().as_bytes()),
        }
    }

    /// Appends a word; where the column holds numbers, none.
    pub(crate) fn push_word(&mut self, word: &[u8]) {
        match self {
            Self::Numbers(numbers) => numbers.push(f32::NAN),
            Self::Words(words) => words.push(word),
        }
    }

    /// Appends the values of a later piece.
    pub(crate) fn append(&mut self, later: Self) {
        match (self, later) {
            (Self::Numbers(mine), Self::Numbers(mut theirs)) => mine.append(&mut theirs),
            (Self::Words(mine), Self::Words(theirs)) => {
                let new: Vec<u32> =
                    theirs.names.iter().map(|name| mine.number(name.as_bytes())).collect();
                mine.numbers.extend(theirs.numbers.iter().map(|number| new[*number as usize]));
            }
            // Pieces of one file have the same columns.
            (Self::Numbers(mine), Self::Words(theirs)) => {
                mine.resize(mine.len() + theirs.numbers.len(), f32::NAN);
            }
            (mine @ Self::Words(_), Self::Numbers(theirs)) => {
                for number in theirs {
                    mine.push_number(number);
                }
            }
        }
    }
}

impl Words {
    /// Appends a word.
    #[inline]
    pub(crate) fn push(&mut self, word: &[u8]) {
        let last = self.numbers.last().copied();
        let same = last.filter(|last| self.names[*last as usize].as_bytes() == word);
        let number = same.unwrap_or_else(|| self.number(word));
        self.numbers.push(number);
    }

    /// The number of a word, which it gets if it has none.
    fn number(&mut self, word: &[u8]) -> u32 {
        if self.names.len() <= FEW
            && let Some(known) = self.names.iter().position(|name| name.as_bytes() == word)
        {
            return known as u32;
        }
        let word = String::from_utf8_lossy(word);
        if self.known.len() < self.names.len() {
            self.known = (0..).zip(&self.names).map(|(i, name)| (name.clone(), i)).collect();
        }
        if let Some(number) = self.known.get(&*word) {
            return *number;
        }
        let number = self.names.len() as u32;
        self.known.insert(word.to_string(), number);
        self.names.push(word.into_owned());
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_kept_once_and_put_together_over_pieces() {
        let words = |all: &[&str]| {
            let mut words = Words::default();
            for word in all {
                words.push(word.as_bytes());
            }
            Values::Words(words)
        };
        let many: Vec<String> = (0..40).map(|i| format!("w{}", i % 20)).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        let mut all = words(&many);
        all.append(words(&["w19", "new", "w0"]));
        let Values::Words(all) = all else { panic!() };
        assert_eq!(all.names.len(), 21);
        let word = |atom: usize| all.names[all.numbers[atom] as usize].as_str();
        assert_eq!([40, 41, 42, 25, 3].map(word), ["w19", "new", "w0", "w5", "w3"]);
    }
}
