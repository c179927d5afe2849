//! JSON values that know where they stand, so that what is wrong with one says it as a JSON pointer.

use serde_json::Value;

use crate::wording::quoted;

/// What is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    /// A JSON pointer; empty: the whole file.
    pub(super) pointer: String,
    pub(super) message: String,
}

pub(super) type Result<T> = std::result::Result<T, Fault>;

/// A value and its pointer.
#[derive(Clone, Debug)]
pub(super) struct At<'a> {
    pub(super) value: &'a Value,
    pub(super) pointer: String,
}

impl<'a> At<'a> {
    /// The value of the whole document.
    pub(super) fn root(value: &'a Value) -> Self {
        Self { value, pointer: String::new() }
    }

    /// Something wrong with this value.
    pub(super) fn fault(&self, message: impl Into<String>) -> Fault {
        Fault { pointer: self.pointer.clone(), message: message.into() }
    }

    /// A member of an object; `None`: there is none, or it is null.
    pub(super) fn get(&self, key: &str) -> Option<At<'a>> {
        let value = self.value.get(key).filter(|value| !value.is_null())?;
        let key = key.replace('~', "~0").replace('/', "~1");
        Some(At { value, pointer: format!("{}/{key}", self.pointer) })
    }

    /// A member that must be there.
    pub(super) fn need(&self, key: &str) -> Result<At<'a>> {
        self.get(key).ok_or_else(|| self.fault(format!("`{key}` is missing")))
    }

    /// A member of an extension of this object.
    pub(super) fn extension(&self, name: &str) -> Option<At<'a>> {
        self.get("extensions")?.get(name)
    }

    /// The items of an array.
    pub(super) fn items(&self) -> Result<Vec<At<'a>>> {
        let Value::Array(items) = self.value else { return Err(self.wrong("an array")) };
        let at = |(i, value)| At { value, pointer: format!("{}/{i}", self.pointer) };
        Ok(items.iter().enumerate().map(at).collect())
    }

    /// The items of a member that is an array; none where there is no member.
    pub(super) fn list(&self, key: &str) -> Result<Vec<At<'a>>> {
        self.get(key).map_or(Ok(Vec::new()), |list| list.items())
    }

    /// The item of this number of a list at the root.
    pub(super) fn item(&self, list: &str, number: usize) -> Result<At<'a>> {
        let all = self.get(list);
        let item = all.as_ref().and_then(|all| all.value.get(number));
        item.map(|value| At { value, pointer: format!("/{list}/{number}") }).ok_or_else(|| {
            let count = all.and_then(|all| all.value.as_array().map(Vec::len)).unwrap_or(0);
            self.fault(format!("it names number {number} of `{list}`, of which there are {count}"))
        })
    }

    pub(super) fn text(&self) -> Result<&'a str> {
        self.value.as_str().ok_or_else(|| self.wrong("a text"))
    }

    pub(super) fn flag(&self) -> Result<bool> {
        self.value.as_bool().ok_or_else(|| self.wrong("true or false"))
    }

    pub(super) fn number(&self) -> Result<f64> {
        let number = self.value.as_f64().filter(|n| n.is_finite());
        number.ok_or_else(|| self.wrong("a number"))
    }

    /// A whole number from 0 on, which may be written `3.0`.
    pub(super) fn whole(&self) -> Result<u64> {
        let float = || self.value.as_f64().filter(|n| n.fract() == 0.0 && (0.0..9e15).contains(n));
        let whole = self.value.as_u64().or_else(|| float().map(|n| n as u64));
        whole.ok_or_else(|| self.wrong("a whole number from 0 on"))
    }

    pub(super) fn index(&self) -> Result<usize> {
        Ok(usize::try_from(self.whole()?).unwrap_or(usize::MAX))
    }

    /// The numbers of an array of this length.
    pub(super) fn numbers<const N: usize>(&self) -> Result<[f64; N]> {
        let items = self.items()?;
        let wrong = || self.fault(format!("there are {} numbers; it takes {N}", items.len()));
        let mut numbers = [0.0; N];
        if items.len() != N {
            return Err(wrong());
        }
        for (number, item) in numbers.iter_mut().zip(&items) {
            *number = item.number()?;
        }
        Ok(numbers)
    }

    /// The number of a member, or what it is where there is none.
    pub(super) fn number_or(&self, key: &str, default: f64) -> Result<f64> {
        self.get(key).map_or(Ok(default), |at| at.number())
    }

    /// The numbers of a member, or what they are where there is none.
    pub(super) fn numbers_or<const N: usize>(
        &self,
        key: &str,
        default: [f64; N],
    ) -> Result<[f64; N]> {
        self.get(key).map_or(Ok(default), |at| at.numbers())
    }

    /// The whole number of a member, or 0.
    pub(super) fn whole_or_zero(&self, key: &str) -> Result<u64> {
        self.get(key).map_or(Ok(0), |at| at.whole())
    }

    /// Its `name`, or what it is called without.
    pub(super) fn name(&self, kind: &str) -> String {
        let name = self.value.get("name").and_then(Value::as_str).filter(|name| !name.is_empty());
        let number = self.pointer.rsplit('/').next().unwrap_or_default();
        name.map_or_else(|| format!("{kind} {number}"), ToOwned::to_owned)
    }

    fn wrong(&self, wanted: &str) -> Fault {
        let found = match self.value {
            Value::Null => "nothing".to_owned(),
            Value::Bool(value) => value.to_string(),
            Value::Number(number) => number.to_string(),
            Value::String(text) => quoted(text),
            Value::Array(_) => "an array".to_owned(),
            Value::Object(_) => "an object".to_owned(),
        };
        self.fault(format!("it must be {wanted}, but is {found}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_said_with_its_pointer() {
        let value = serde_json::json!({"a/b": [1, "x", 2.0, -1], "nodes": [{}]});
        let root = At::root(&value);
        let items = root.need("a/b").unwrap().items().unwrap();
        assert_eq!((items[0].whole(), items[2].index()), (Ok(1), Ok(2)));
        let fault = items[1].number().unwrap_err();
        assert_eq!(fault.pointer, "/a~1b/1");
        assert_eq!(fault.message, "it must be a number, but is \"x\"");
        assert!(items[3].whole().is_err() && root.need("c").is_err());
        assert_eq!(root.item("nodes", 0).unwrap().name("node"), "node 0");
        let fault = root.item("nodes", 7).unwrap_err();
        assert_eq!(fault.message, "it names number 7 of `nodes`, of which there are 1");
    }
}
