//! One value of the text, as its key's kind says it must be.

use glam::{DAffine3, DMat4, DVec2, DVec3, DVec4};
use toml::Spanned;
use toml::de::DeValue;

use super::notes::Notes;
use super::text::Spot;
use crate::color::{Rgb, maps};
use crate::keys::{Key, Kind, Value, of_word};
use crate::limits::{LARGEST, Range};
use crate::scene::{Background, Image};
use crate::transform::is_regular;
use crate::wording::{closest, list, quoted};

/// What was found, as the end of "…; this is …".
fn found(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text {}", quoted(text)),
        DeValue::Integer(number) => format!("{number}"),
        DeValue::Float(number) => format!("{number}"),
        DeValue::Boolean(flag) => format!("`{flag}`"),
        DeValue::Datetime(_) => "a date or time".to_owned(),
        DeValue::Array(items) if items.iter().all(|item| item.get_ref().is_table()) => {
            match items.len() {
                0 => "an empty list".to_owned(),
                _ => "a list of tables".to_owned(),
            }
        }
        DeValue::Array(items) => match items.len() {
            1 => "a list of one".to_owned(),
            n => format!("a list of {n}"),
        },
        DeValue::Table(_) => "a table".to_owned(),
    }
}

/// Whether a list that should hold `wanted` numbers holds more, all of them whole.
fn are_decimal_commas(value: &DeValue<'_>, wanted: usize) -> bool {
    let DeValue::Array(items) = value else { return false };
    let whole = items.iter().all(|item| matches!(item.get_ref(), DeValue::Integer(_)));
    whole && items.len() > wanted && items.len() <= 2 * wanted
}

/// Reads values of one key, and says what is wrong with them.
pub(super) struct ValueReader<'n> {
    pub(super) notes: &'n mut Notes,
    pub(super) file: u32,
    /// The table that the key is of.
    pub(super) table: &'static str,
    pub(super) key: &'static Key,
}

impl ValueReader<'_> {
    /// The value, if it is what the key's kind wants; else that has been said.
    pub(super) fn read(&mut self, value: &Spanned<DeValue<'_>>) -> Option<Value> {
        match self.key.kind {
            Kind::Flag => match value.get_ref() {
                DeValue::Boolean(flag) => Some(Value::Flag(*flag)),
                _ => self.mismatch(value),
            },
            Kind::Integer(min, max) => match whole(value.get_ref()) {
                Some(n) if (min..=max).contains(&n) => Some(Value::Integer(n)),
                _ => self.mismatch(value),
            },
            Kind::NumberOr(_, word) if value.get_ref().as_str() == Some(word) => {
                Some(Value::Word(word))
            }
            Kind::Number(range) | Kind::NumberOr(range, _) => {
                self.in_range(value, &range).map(Value::Number)
            }
            Kind::Point => self.numbers(value).map(|v| Value::Vector(v.into())),
            Kind::Direction => self.direction(value).map(Value::Vector),
            Kind::Reflectance => self.color(value, 1.0).map(Value::Color),
            Kind::ColorOrObject if value.get_ref().as_str() == Some("object") => {
                Some(Value::Word("object"))
            }
            Kind::Color | Kind::ColorOrObject => self.color(value, LARGEST).map(Value::Color),
            Kind::Background => self.background(value).map(Value::Background),
            Kind::Word(words) => self.word(value, words).map(Value::Word),
            Kind::Text | Kind::File | Kind::Material | Kind::Group | Kind::Texture => {
                self.text(value)
            }
            Kind::TwoColors => self.two_colors(value).map(Value::Colors),
            Kind::Stops => self.stops(value).map(Value::Stops),
            Kind::Size => self.size(value).map(Value::Size),
            Kind::Attenuation => self.attenuation(value).map(Value::Vector),
            Kind::Points => self
                .triple::<3, _>(value, Self::numbers)
                .map(|p| Value::Vectors(p.map(DVec3::from))),
            Kind::Directions => self.triple::<3, _>(value, Self::direction).map(Value::Vectors),
            Kind::Pair => self.numbers(value).map(|v| Value::Pair(v.into())),
            Kind::Uvs => {
                self.triple::<2, _>(value, Self::numbers).map(|uv| Value::Uvs(uv.map(DVec2::from)))
            }
            Kind::Smooth => match value.get_ref() {
                DeValue::Boolean(flag) => Some(Value::Flag(*flag)),
                _ => self.in_range(value, &Range::closed(0.0, 180.0)).map(Value::Number),
            },
            Kind::Scale => self.scale(value).map(Value::Vector),
            Kind::Rotate => self.rotations(value).map(Value::Rotations),
            Kind::Matrix => self.matrix(value).map(Value::Matrix),
            Kind::Cap => match value.get_ref() {
                DeValue::Boolean(flag) => Some(Value::Flag(*flag)),
                DeValue::String(_) => self.text(value),
                _ => self.mismatch(value),
            },
            Kind::Names if !value.get_ref().is_array() => self.mismatch(value),
            Kind::Files | Kind::Names => self.files(value).map(Value::Texts),
            Kind::Numbers => self.some_numbers(value).map(Value::Numbers),
            Kind::Counts(most) => {
                let counts = self.numbers::<3>(value)?;
                let fits = |n: &f64| n.fract() == 0.0 && (1.0..=f64::from(most)).contains(n);
                if !counts.iter().all(fits) {
                    return self.mismatch(value);
                }
                Some(Value::Numbers(counts.to_vec()))
            }
            Kind::Interval if value.get_ref().as_str() == Some("auto") => Some(Value::Word("auto")),
            Kind::Interval => self.numbers::<2>(value).map(|range| Value::Numbers(range.to_vec())),
            Kind::Map => self.mismatch(value),
            Kind::Table(_) | Kind::Tables(_) | Kind::Named(_) | Kind::Values | Kind::Options => {
                None
            }
        }
    }

    fn spot(&self, value: &Spanned<DeValue<'_>>) -> Spot {
        Spot::new(self.file, value.span())
    }

    /// Says what the key wants and what it got.
    fn mismatch<T>(&mut self, value: &Spanned<DeValue<'_>>) -> Option<T> {
        let spot = self.spot(value);
        self.mismatch_helped(spot, value, false)
    }

    /// The same; `commas`: decimal commas are the likely reason.
    fn mismatch_helped<T>(
        &mut self,
        spot: Spot,
        value: &Spanned<DeValue<'_>>,
        commas: bool,
    ) -> Option<T> {
        let message = format!(
            "`{}` must be {}; this is {}",
            self.key.name,
            self.key.kind.words(),
            found(value.get_ref())
        );
        let help = "decimals are written with a point, like 1.5: a comma begins the next number";
        self.notes.error(spot, message).help = commas.then(|| help.to_owned());
        None
    }

    /// Says something else about it.
    fn wrong<T>(&mut self, value: &Spanned<DeValue<'_>>, message: &str) -> Option<T> {
        let message = format!("`{}` {message}", self.key.name);
        let spot = self.spot(value);
        self.notes.error(spot, message);
        None
    }

    /// A finite number of sane size.
    fn number(&mut self, value: &Spanned<DeValue<'_>>) -> Option<f64> {
        let number = match value.get_ref() {
            DeValue::Integer(number) if number.radix() == 10 => number.as_str().parse().ok(),
            DeValue::Integer(number) => {
                u128::from_str_radix(number.as_str(), number.radix()).ok().map(|n| n as f64)
            }
            DeValue::Float(number) => number.as_str().parse().ok(),
            _ => return self.mismatch(value),
        };
        match number {
            Some(number) if f64::is_nan(number) => self.wrong(value, "is NaN, not a number"),
            Some(number) if f64::abs(number) <= LARGEST => Some(number),
            Some(_) if found(value.get_ref()).contains("inf") => {
                self.wrong(value, "is infinite; it must be a finite number")
            }
            _ => self.wrong(value, &format!("is too large: numbers go up to {LARGEST:e}")),
        }
    }

    fn in_range(&mut self, value: &Spanned<DeValue<'_>>, range: &Range) -> Option<f64> {
        let number = self.number(value)?;
        if range.holds(number) { Some(number) } else { self.mismatch(value) }
    }

    /// Exactly `N` values in a list.
    fn items<'v, 'i, const N: usize>(
        &mut self,
        value: &'v Spanned<DeValue<'i>>,
    ) -> Option<&'v [Spanned<DeValue<'i>>; N]> {
        let items = value.get_ref().as_array();
        let items = items.and_then(|items| items.first_chunk().filter(|_| items.len() == N));
        if items.is_none() {
            let spot = self.spot(value);
            let commas = N == 3 && are_decimal_commas(value.get_ref(), N);
            return self.mismatch_helped(spot, value, commas);
        }
        items
    }

    /// Exactly `N` numbers in a list.
    fn numbers<const N: usize>(&mut self, value: &Spanned<DeValue<'_>>) -> Option<[f64; N]> {
        let items = self.items::<N>(value)?;
        let mut numbers = [0.0; N];
        let mut good = true;
        for (number, item) in numbers.iter_mut().zip(items) {
            match self.number(item) {
                Some(n) => *number = n,
                None => good = false,
            }
        }
        good.then_some(numbers)
    }

    fn triple<const N: usize, T>(
        &mut self,
        value: &Spanned<DeValue<'_>>,
        read: fn(&mut Self, &Spanned<DeValue<'_>>) -> Option<T>,
    ) -> Option<[T; 3]> {
        let items @ [a, b, c] = self.items::<3>(value)?;
        // One complaint about the form is enough; about numbers, one a number.
        let of_form = |item: &&Spanned<DeValue<'_>>| {
            item.get_ref().as_array().is_some_and(|numbers| numbers.len() == N)
        };
        if let Some(item) = items.iter().find(|item| !of_form(item)) {
            return self.mismatch(item);
        }
        let (a, b, c) = (read(self, a), read(self, b), read(self, c));
        Some([a?, b?, c?])
    }

    fn direction(&mut self, value: &Spanned<DeValue<'_>>) -> Option<DVec3> {
        let v = DVec3::from(self.numbers::<3>(value)?);
        if v == DVec3::ZERO {
            return self.wrong(value, "is [0, 0, 0], which has no direction");
        }
        Some(v)
    }

    fn color(&mut self, value: &Spanned<DeValue<'_>>, largest: f64) -> Option<Rgb> {
        let channels = match value.get_ref() {
            DeValue::String(text) => match text.parse() {
                Ok(color) => return Some(color),
                Err(crate::color::ColorError { message, help }) => {
                    let spot = self.spot(value);
                    self.notes.error(spot, message).help = help;
                    return None;
                }
            },
            DeValue::Array(_) => self.numbers::<3>(value)?,
            _ => [self.number(value)?; 3],
        };
        if channels.iter().any(|&channel| channel < 0.0) {
            return self.wrong(value, "is negative; there is no light below 0");
        }
        if channels.iter().any(|&channel| channel > largest) {
            return self.wrong(value, &format!("is above {largest}, more than all light"));
        }
        Some(Rgb::from(channels.map(|channel| channel as f32)))
    }

    fn two_colors(&mut self, value: &Spanned<DeValue<'_>>) -> Option<[Rgb; 2]> {
        let [a, b] = self.items::<2>(value)?;
        let (a, b) = (self.color(a, LARGEST), self.color(b, LARGEST));
        Some([a?, b?])
    }

    /// At least one `[t, colour]`, t from 0 to 1 and never falling.
    fn stops(&mut self, value: &Spanned<DeValue<'_>>) -> Option<Vec<(f32, Rgb)>> {
        if let Some(name) = value.get_ref().as_str() {
            return self.color_map(value, name);
        }
        let DeValue::Array(items) = value.get_ref() else { return self.mismatch(value) };
        if items.is_empty() {
            return self.wrong(value, "is empty; a gradient has at least one stop");
        }
        let (mut stops, mut good) = (Vec::with_capacity(items.len()), true);
        let mut before = 0.0;
        for item in items {
            let Some([t, color]) = self.items::<2>(item) else {
                good = false;
                continue;
            };
            match (self.number(t), self.color(color, LARGEST)) {
                (Some(at), _) if !(0.0..=1.0).contains(&at) => {
                    good = false;
                    self.wrong::<()>(t, "have t from 0 to 1");
                }
                (Some(at), _) if at < before => {
                    good = false;
                    self.wrong::<()>(t, "must not fall: each t is at least the one before");
                }
                (Some(at), Some(color)) => {
                    before = at;
                    stops.push((at as f32, color));
                }
                _ => good = false,
            }
        }
        good.then_some(stops)
    }

    /// The stops of a colour map.
    fn color_map(&mut self, value: &Spanned<DeValue<'_>>, name: &str) -> Option<Vec<(f32, Rgb)>> {
        let spot = self.spot(value);
        let Some(stops) = maps::named(name) else {
            let message = format!("there is no colour map {}", quoted(name));
            let help = match closest(name, maps::NAMES) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", list(maps::NAMES.into_iter(), "and")),
            };
            self.notes.error(spot, message).help = Some(help);
            return None;
        };
        if name == "turbo" {
            let message = "the colours of `turbo` rise and fall in brightness: steps are seen where \
                           the numbers have none";
            let help =
                "`viridis` and `cividis` rise evenly, and do in print and to the colour-blind";
            self.notes.warning(spot, message).help = Some(help.to_owned());
        }
        Some(stops)
    }

    fn background(&mut self, value: &Spanned<DeValue<'_>>) -> Option<Background> {
        match value.get_ref() {
            DeValue::String(text) if text == "transparent" => Some(Background::Transparent),
            _ => self.color(value, LARGEST).map(Background::Color),
        }
    }

    fn word(
        &mut self,
        value: &Spanned<DeValue<'_>>,
        words: &[&'static str],
    ) -> Option<&'static str> {
        let Some(text) = value.get_ref().as_str() else { return self.mismatch(value) };
        if let Some(word) = words.iter().find(|&&word| word == text) {
            return Some(word);
        }
        let Key { name, kind, later, .. } = self.key;
        let spot = self.spot(value);
        if later.contains(&text) {
            let message = format!("`{name} = {}` is not built yet", quoted(text));
            self.notes.error(spot, message).help =
                Some(format!("so far there is {}", kind.words()));
            return None;
        }
        let message = format!("`{name}` must be {}; this is {}", kind.words(), quoted(text));
        let near = || closest(text, words.iter().chain(*later).copied());
        let hint = of_word(self.table, name, text).map(str::to_owned);
        self.notes.error(spot, message).help =
            hint.or_else(|| near().map(|word| format!("did you mean `{word}`?")));
        None
    }

    fn text(&mut self, value: &Spanned<DeValue<'_>>) -> Option<Value> {
        match value.get_ref().as_str() {
            Some("") => self.wrong(value, "is empty"),
            Some(text) => Some(Value::Text(text.to_owned())),
            None => self.mismatch(value),
        }
    }

    /// Texts, each with its place.
    fn files(
        &mut self,
        value: &Spanned<DeValue<'_>>,
    ) -> Option<Vec<(String, std::ops::Range<usize>)>> {
        let DeValue::Array(items) = value.get_ref() else {
            let Value::Text(text) = self.text(value)? else { return None };
            return Some(vec![(text, value.span())]);
        };
        if items.is_empty() {
            return self.wrong(value, "is empty");
        }
        let read = items.iter().map(|item| match self.text(item)? {
            Value::Text(text) => Some((text, item.span())),
            _ => None,
        });
        let read: Vec<_> = read.collect();
        read.into_iter().collect()
    }

    /// One number or more.
    fn some_numbers(&mut self, value: &Spanned<DeValue<'_>>) -> Option<Vec<f64>> {
        let DeValue::Array(items) = value.get_ref() else {
            return self.number(value).map(|number| vec![number]);
        };
        if items.is_empty() {
            return self.mismatch(value);
        }
        let read: Vec<_> = items.iter().map(|item| self.number(item)).collect();
        read.into_iter().collect()
    }

    fn size(&mut self, value: &Spanned<DeValue<'_>>) -> Option<[u32; 2]> {
        let [w, h] = self.items(value)?;
        let pixels = |v: &Spanned<DeValue<'_>>| {
            whole(v.get_ref())
                .filter(|n| (1..=u64::from(Image::LARGEST)).contains(n))
                .map(|n| n as u32)
        };
        match (pixels(w), pixels(h)) {
            (Some(w), Some(h)) => Some([w, h]),
            (None, _) => self.mismatch(w),
            (_, None) => self.mismatch(h),
        }
    }

    fn attenuation(&mut self, value: &Spanned<DeValue<'_>>) -> Option<DVec3> {
        let v = DVec3::from(self.numbers::<3>(value)?);
        match v.min_element() {
            min if min < 0.0 => self.wrong(value, "is negative; `[c, l, q]` are 0 or above"),
            _ if v == DVec3::ZERO => self.wrong(value, "is [0, 0, 0], a division by 0"),
            _ => Some(v),
        }
    }

    fn scale(&mut self, value: &Spanned<DeValue<'_>>) -> Option<DVec3> {
        let v = match value.get_ref() {
            DeValue::Array(_) => DVec3::from(self.numbers::<3>(value)?),
            _ => DVec3::splat(self.number(value)?),
        };
        if v.to_array().contains(&0.0) {
            return self.wrong(value, "is 0, which leaves nothing of the shape");
        }
        Some(v)
    }

    fn rotations(&mut self, value: &Spanned<DeValue<'_>>) -> Option<Vec<DVec4>> {
        let DeValue::Array(items) = value.get_ref() else { return self.mismatch(value) };
        if items.first().is_some_and(|item| !item.get_ref().is_array()) {
            return self.rotation(value).map(|rotation| vec![rotation]);
        }
        let read: Vec<_> = items.iter().map(|item| self.rotation(item)).collect();
        read.into_iter().collect()
    }

    fn rotation(&mut self, value: &Spanned<DeValue<'_>>) -> Option<DVec4> {
        let v = DVec4::from(self.numbers::<4>(value)?);
        if v.truncate() == DVec3::ZERO {
            return self.wrong(value, "is about the axis [0, 0, 0], which has no direction");
        }
        Some(v)
    }

    fn matrix(&mut self, value: &Spanned<DeValue<'_>>) -> Option<DAffine3> {
        let rows = self.items::<4>(value)?;
        let [x, y, z, w] = rows.each_ref().map(|row| self.numbers::<4>(row));
        let (x, y, z, w) = (x?, y?, z?, w?);
        if w != [0.0, 0.0, 0.0, 1.0] {
            return self.wrong(&rows[3], "must end with the row [0, 0, 0, 1]");
        }
        let rows = DMat4::from_cols_array_2d(&[x, y, z, w]).transpose();
        let matrix = DAffine3::from_mat4(rows);
        if !is_regular(matrix.matrix3) {
            return self.wrong(value, "is singular: it leaves nothing of the shape");
        }
        Some(matrix)
    }
}

/// A whole number, 0 or above.
fn whole(value: &DeValue<'_>) -> Option<u64> {
    let number = value.as_integer()?;
    u64::from_str_radix(number.as_str(), number.radix()).ok()
}
