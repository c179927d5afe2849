//! What is asked of the engine and changes nothing: pixels explained, lobes, files, and figures of the
//! lecture.

use phong::explain::Explanation;
use phong::view::View;
use phong_lab::figures::{self, Facets, Falloff};
use serde_json::{Map, Value};

use super::{Emit, Engine, NOTHING, exporting, lines, lobe, say, teaching};
use crate::protocol::{
    FileKind, MOST_EXPLAINED, MOST_EXPONENT, MOST_FACETS, Message, Reply, file_frame,
};

impl Engine {
    pub(super) fn explain(
        &self,
        id: u64,
        pixel: [u32; 2],
        samples: u32,
        set: &Map<String, Value>,
        emit: Emit<'_>,
    ) -> Result<(), String> {
        let (mut told, view, picture) = self.told(pixel, samples, set)?;
        let painting = self.painting.as_ref();
        let furniture = painting.map(|painting| painting.furniture_over(pixel));
        told.furniture = furniture.unwrap_or_default();
        let lines = lines::of(&told, &view);
        let told = phong_lab::tell::json(&told);
        let planted = self.planted.as_ref();
        let drawn = planted.and_then(|planted| teaching::drawn(planted, pixel));
        say(emit, &Reply::Explanation { id, picture, told, drawn, lines });
        Ok(())
    }

    pub(super) fn lobe(
        &self,
        id: u64,
        pixel: [u32; 2],
        light: usize,
        set: &Map<String, Value>,
        emit: Emit<'_>,
    ) -> Result<(), String> {
        let (told, view, _) = self.told(pixel, 1, set)?;
        say(emit, &lobe::of(id, &told, light, &view)?);
        Ok(())
    }

    /// A pixel of the picture under way explained, with values laid over the scene for it alone.
    fn told(
        &self,
        pixel: [u32; 2],
        samples: u32,
        set: &Map<String, Value>,
    ) -> Result<(Explanation, View, u32), String> {
        let painting = self.painting.as_ref().ok_or("there is no picture")?;
        if !(1..=MOST_EXPLAINED).contains(&samples) {
            return Err(format!("{samples} samples: 1 to {MOST_EXPLAINED} are told"));
        }
        let options = painting.options().clone().with_samples(samples);
        let options = options.map_err(|error| error.to_string())?;
        let view = if set.is_empty() {
            painting.view().clone()
        } else {
            self.drawn().ok_or(NOTHING)?.view_with(set)?
        };
        let told = phong::explain::explain(&view, &options, pixel);
        let mut told = told.map_err(|outside| outside.to_string())?;
        let finished = painting.finish_told(&mut told, &view, &options);
        finished.map_err(|error| error.to_string())?;
        Ok((told, view, painting.number()))
    }

    pub(super) fn finish(&self, picture: u32, emit: Emit<'_>) {
        let asked = self.painting.as_ref().filter(|painting| painting.number() == picture);
        if let Some(painting) = asked {
            painting.say_finished(self.pixels, emit);
        }
    }

    pub(super) fn export(&self, format: FileKind, emit: Emit<'_>) -> Result<(), String> {
        // The text is as it is, whatever look is tried on.
        let is_text = format == FileKind::Toml;
        let opened = if is_text { self.opened.as_ref() } else { self.drawn() };
        let opened = opened.ok_or(NOTHING)?;
        let file = exporting::file(format, opened, self.painting.as_ref())?;
        say(emit, &Reply::File { name: file.name, bytes: file.bytes.len() });
        emit(Message::Frame(file_frame(&file.bytes)));
        Ok(())
    }
}

/// Draws tiny mirrors, and says what they send out.
pub(super) fn facets(id: u64, theta: f64, count: u32, emit: Emit<'_>) -> Result<(), String> {
    if !(1..=MOST_FACETS).contains(&count) || !(5.0..=80.0).contains(&theta) {
        return Err(format!("1 to {MOST_FACETS} facets are drawn, under 5 to 80 degrees"));
    }
    let Facets { range, counted, alike, lobe, error } = figures::facets(theta, count);
    say(emit, &Reply::Facets { id, count, range, counted, alike, lobe, error });
    Ok(())
}

/// Says how a highlight falls off with this exponent.
pub(super) fn cosine_power(id: u64, exponent: f64, emit: Emit<'_>) -> Result<(), String> {
    if !(0.0..=MOST_EXPONENT).contains(&exponent) {
        return Err(format!("an exponent is from 0 to {MOST_EXPONENT}"));
    }
    let Falloff { range, curve, half_width } = figures::cosine_power(exponent);
    say(emit, &Reply::CosinePower { id, exponent, range, curve, half_width });
    Ok(())
}
