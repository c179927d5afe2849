//! Colours that are not said to be bytes or not: all of them together show it.

use std::sync::Arc;

use crate::color::{Rgb, are_bytes, srgb_decode};
use crate::format::text::{Findings, whole};
use crate::material::PLAIN;

/// What stands for a colour that a line does not have.
const NO_COLOR: Rgb = Rgb::grey(f32::NAN);

/// The colours of things that follow one another, as they stand in the file.
#[derive(Debug, Default)]
pub(super) struct Colors {
    /// One each, up to the last that has one.
    stored: Vec<Rgb>,
    /// The least and the largest alpha; `None`: there is none.
    alphas: Option<[f32; 2]>,
    /// How many of them are negative, infinite or NaN.
    wrong: u64,
}

impl Colors {
    /// Whether nothing has a colour.
    pub(super) fn is_empty(&self) -> bool {
        self.stored.is_empty()
    }

    /// Gives the things from the last that has a colour up to number `end` this one, of three numbers
    /// or four.
    pub(super) fn set(&mut self, start: usize, end: usize, numbers: &[f32]) {
        let [r, g, b, ref alpha @ ..] = *numbers else { return };
        self.stored.resize(start, NO_COLOR);
        let sound = numbers.iter().all(|c| c.is_finite() && *c >= 0.0);
        self.wrong += u64::from(!sound);
        self.stored.resize(end, if sound { Rgb::new(r, g, b) } else { NO_COLOR });
        for &alpha in alpha.iter().filter(|_| sound) {
            self.see_alphas([alpha; 2]);
        }
    }

    fn see_alphas(&mut self, [least, most]: [f32; 2]) {
        let [low, high] = self.alphas.unwrap_or([least, most]);
        self.alphas = Some([low.min(least), high.max(most)]);
    }

    /// Adds those of later things, before which there are so many.
    pub(super) fn append(&mut self, before: usize, later: Self) {
        self.wrong += later.wrong;
        if let Some(alphas) = later.alphas {
            self.see_alphas(alphas);
        }
        if !later.stored.is_empty() {
            self.stored.resize(before, NO_COLOR);
            self.stored.extend(later.stored);
        }
    }

    /// Bytes that they take in memory.
    pub(super) fn bytes(&self) -> u64 {
        12 * self.stored.len() as u64
    }

    /// The linear colours of so many things; none if no thing has one.
    pub(super) fn finish(
        self,
        count: usize,
        things: &str,
        file: &Arc<str>,
        findings: &mut Findings,
    ) -> Vec<Rgb> {
        let Self { mut stored, alphas, wrong } = self;
        if stored.is_empty() {
            return stored;
        }
        stored.resize(count, NO_COLOR);
        let mut warn =
            |plural, message: String| findings.warning(plural, || whole(file), || message);
        let is_color = |color: &Rgb| !color.r.is_nan();
        let alpha = alphas.map(|[_, most]| Rgb::grey(most));
        let bytes = are_bytes(stored.iter().copied().filter(is_color).chain(alpha));
        let opaque = if bytes { 255.0 } else { 1.0 };
        if alphas.is_some_and(|[least, _]| least < opaque) {
            warn("alphas", format!("{things} are less than opaque, which is not drawn"));
        }
        let without =
            (stored.iter().filter(|color| !is_color(color)).count() as u64).saturating_sub(wrong);
        if without > 0 {
            let message = format!(
                "{things} without a colour beside some that have one: {without}; they are grey"
            );
            warn("things without a colour", message);
        }
        if wrong > 0 {
            let message = format!(
                "colours of {things} that are NaN, infinite or below 0: {wrong}; they are grey"
            );
            warn("colours that are none", message);
        }
        let linear = |c: f32| if bytes { srgb_decode(f64::from(c) / 255.0) as f32 } else { c };
        for color in &mut stored {
            *color = if is_color(color) { color.map(linear) } else { PLAIN };
        }
        stored
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finished(colors: &[&[f32]], count: usize) -> (Vec<Rgb>, String) {
        let mut all = Colors::default();
        for (i, color) in colors.iter().enumerate() {
            all.set(i, i + 1, color);
        }
        let (file, mut findings, mut out) = ("a".into(), Findings::default(), Vec::new());
        let colors = all.finish(count, "vertices", &file, &mut findings);
        findings.tell(&file, &mut out);
        (colors, out.iter().map(|d| d.to_string() + "\n").collect())
    }

    #[test]
    fn whole_numbers_above_one_are_bytes_and_others_linear() {
        assert_eq!(finished(&[&[255.0, 0.0, 128.0]], 1).0, [Rgb::from_srgb8([255, 0, 128])]);
        assert_eq!(finished(&[&[1.0, 0.0, 0.0]], 1).0, [Rgb::new(1.0, 0.0, 0.0)]);
        assert_eq!(finished(&[&[0.5, 0.0, 0.0]], 1).0, [Rgb::new(0.5, 0.0, 0.0)]);
        // The alpha says what the colour does not.
        assert_eq!(finished(&[&[1.0, 0.0, 0.0, 255.0]], 1).0, [Rgb::from_srgb8([1, 0, 0])]);
    }

    #[test]
    fn what_is_no_colour_is_grey_and_counted() {
        let (colors, told) =
            finished(&[&[0.5; 3], &[f32::NAN, 0.0, 0.0], &[0.1, 0.2, 0.3, 0.5]], 5);
        assert_eq!((colors.len(), colors[1], colors[4]), (5, Rgb::grey(0.8), Rgb::grey(0.8)));
        for said in ["below 0: 1", "without a colour beside some that have one: 2", "opaque"] {
            assert!(told.contains(said), "{told}");
        }
    }
}
