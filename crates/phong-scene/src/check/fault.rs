//! What is wrong with one thing of a scene, field by field.

use glam::DVec3;

use crate::color::Rgb;
use crate::limits::{LARGEST, Range};

/// What is wrong with a field.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    /// The field, called as its key in the scene text is.
    pub(crate) field: &'static str,
    /// One sentence that names the field and its value.
    pub(crate) message: String,
    /// The way out, if one is known.
    pub(crate) help: Option<String>,
}

/// Everything that is wrong with a thing.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    pub(crate) all: Vec<Fault>,
}

impl Faults {
    /// Says that something is wrong with a field.
    pub(crate) fn say(&mut self, field: &'static str, message: impl Into<String>) -> &mut Fault {
        self.all.push(Fault { field, message: message.into(), help: None });
        let last = self.all.len() - 1;
        &mut self.all[last]
    }

    /// Whether nothing was said of these fields.
    pub(super) fn spare(&self, fields: &[&str]) -> bool {
        !self.all.iter().any(|fault| fields.contains(&fault.field))
    }

    /// Whether a number is one that a scene may hold.
    pub(crate) fn finite(&mut self, field: &'static str, value: f64) -> bool {
        if let Some(wrong) = not_held(value) {
            self.say(field, format!("`{field}` {wrong}"));
            return false;
        }
        true
    }

    /// Whether a number lies in its range.
    pub(crate) fn number(&mut self, field: &'static str, value: f64, range: &Range) -> bool {
        if !self.finite(field, value) {
            return false;
        }
        let held = range.holds(value);
        if !held {
            let words = range.words();
            self.say(field, format!("`{field}` must be a number {words}; this is {value}"));
        }
        held
    }

    /// Whether all three numbers are such as a scene may hold.
    pub(crate) fn vector(&mut self, field: &'static str, v: DVec3) -> bool {
        match v.to_array().into_iter().find_map(not_held) {
            Some(wrong) => {
                self.say(field, format!("`{field}` {wrong}"));
                false
            }
            None => true,
        }
    }

    /// Whether a vector has a direction.
    pub(crate) fn direction(&mut self, field: &'static str, v: DVec3) -> bool {
        let whole = self.vector(field, v);
        if whole && v.try_normalize().is_none() {
            let [x, y, z] = v.to_array();
            self.say(field, format!("`{field}` is [{x}, {y}, {z}], which has no direction"));
            return false;
        }
        whole
    }

    /// Whether a colour is one of light: finite, not below 0, and not above `most`.
    pub(crate) fn color(&mut self, field: &'static str, color: Rgb, most: f64) -> bool {
        let channels = color.to_array().map(f64::from);
        let wrong = if let Some(wrong) = channels.into_iter().find_map(not_held) {
            wrong
        } else if channels.iter().any(|&channel| channel < 0.0) {
            "is negative; there is no light below 0".to_owned()
        } else if channels.iter().any(|&channel| channel > most) {
            format!("is above {most}, more than all light")
        } else {
            return true;
        };
        self.say(field, format!("`{field}` {wrong}"));
        false
    }
}

/// What makes a number one that no scene holds, as the end of "it …".
pub(crate) fn not_held(value: f64) -> Option<String> {
    if value.is_nan() {
        Some("is NaN, not a number".to_owned())
    } else if value.is_infinite() {
        Some("is infinite; it must be a finite number".to_owned())
    } else if value.abs() > LARGEST {
        Some(format!("is too large: numbers go up to {LARGEST:e}"))
    } else {
        None
    }
}
