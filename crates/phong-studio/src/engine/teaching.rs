//! For teachers: a picture with a mistake to be found, somebody's picture graded, and class sheets.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use phong::image::Picture;
use phong::scene::{Scene, srgb_decode};
use phong_lab::grade::{self, Grader, Planted};
use serde::Deserialize;
use serde_json::json;

use super::{Emit, Engine, NOTHING, say};
use crate::protocol::{Choice, Exercise, Message, PixelKind, Reply, TileFrame};

/// The most pixels of a picture with a mistake in it: every mistake is tried on all of them.
const MOST_PIXELS: u64 = 150_000;

/// The most pixels of a picture that is graded.
const MOST_GRADED: u64 = 1 << 21;

impl Engine {
    /// Draws the picture with a mistake in it, small enough that all of them can be tried.
    pub(super) fn mistake(
        &mut self,
        seed: u64,
        cause: Option<&str>,
        emit: Emit<'_>,
    ) -> Result<(), String> {
        let shown = self.opened.as_ref().ok_or(NOTHING)?.shown()?;
        let size = small(shown.scene.image.size);
        self.changed(emit, |opened, files| {
            if size == shown.scene.image.size {
                return Ok(());
            }
            opened.lay([("image.size".to_owned(), json!(size))].into_iter().collect(), files)
        })?;
        // The right picture is what is explained, and is not drawn.
        self.stopped = true;
        let planted = plant(&self.opened.as_ref().ok_or(NOTHING)?.scene()?, seed, cause);
        let planted = planted.inspect_err(|_| self.stopped = false)?;
        let picture = self.picture;
        say(emit, &choices(&planted, picture));
        emit(Message::Frame(frame(&planted, picture, self.pixels)));
        say(emit, &Reply::Pass { picture, pass: 0, passes: 1, samples: 1 });
        self.planted = Some(planted);
        Ok(())
    }

    pub(super) fn guess(&mut self, cause: Option<String>, emit: Emit<'_>) -> Result<(), String> {
        let planted = self.planted.as_ref().ok_or("there is no picture with a mistake in it")?;
        say(emit, &judge(planted, cause)?);
        Ok(())
    }

    pub(super) fn grade(&self, name: String, bytes: &str, emit: Emit<'_>) -> Result<(), String> {
        let scene = self.opened.as_ref().ok_or(NOTHING)?.scene()?;
        say(emit, &graded(scene, name, bytes, self.bounds.bytes)?);
        Ok(())
    }
}

/// A size no larger than a picture with a mistake may have, of about the same shape.
fn small(size: [u32; 2]) -> [u32; 2] {
    let pixels = f64::from(size[0]) * f64::from(size[1]);
    let by = (MOST_PIXELS as f64 / pixels).sqrt().min(1.0);
    let [width, height] = size.map(|side| ((f64::from(side) * by) as u32).max(1));
    let most = |other: u32| (MOST_PIXELS / u64::from(other)).max(1) as u32;
    let width = width.min(most(height));
    [width, height.min(most(width))]
}

/// A picture with a mistake in it, and what it may be.
fn plant(scene: &Scene, seed: u64, cause: Option<&str>) -> Result<Planted, String> {
    let planted = match cause {
        Some(cause) => Planted::of(scene, cause),
        None => Planted::new(scene, seed),
    };
    let planted = planted.map_err(|error| error.to_string())?;
    planted.ok_or_else(|| match cause {
        Some(cause) => format!("the mistake `{cause}` cannot be seen in this scene"),
        None => "no mistake can be seen in this scene".to_owned(),
    })
}

/// What is said of it.
fn choices(planted: &Planted, picture: u32) -> Reply {
    let choices = planted.choices().iter();
    let choices = choices.map(|one| Choice { cause: one.cause, says: one.says }).collect();
    Reply::Mistake { picture, choices }
}

/// The whole picture as one tile of its only pass.
fn frame(planted: &Planted, picture: u32, kind: PixelKind) -> Vec<u8> {
    let [width, height] = planted.size();
    let linear = |v: &f32| srgb_decode(f64::from(*v)) as f32;
    let colors: Vec<f32> = planted.values().iter().flatten().map(linear).collect();
    let alphas = vec![1.0; planted.values().len()];
    let (colors, alphas) = (&*colors, &*alphas);
    TileFrame { picture, pass: 0, step: 1, x: 0, y: 0, width, height, colors, alphas }.bytes(kind)
}

/// The levels of a pixel.
pub(super) fn drawn(planted: &Planted, [x, y]: [u32; 2]) -> Option<[u8; 3]> {
    let [width, _] = planted.size();
    planted.values().get(y as usize * width as usize + x as usize).copied().map(levels)
}

fn levels(values: [f32; 3]) -> [u8; 3] {
    values.map(|v| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
}

/// Whether a guess is right; who gives up is told.
fn judge(planted: &Planted, cause: Option<String>) -> Result<Reply, String> {
    let Some(name) = &cause else {
        let says = format!("{}: {}", planted.mistake().cause, planted.mistake().says);
        return Ok(Reply::Verdict { cause, right: false, says: Some(says) });
    };
    let Some(known) = Planted::known(name) else {
        return Err(format!("there is no mistake `{name}`"));
    };
    let right = planted.is_it(name);
    let says = right.then(|| known.says.to_owned());
    Ok(Reply::Verdict { cause, right, says })
}

/// Somebody's picture of a scene, in base 64, graded; `most` bytes are allowed.
fn graded(mut scene: Scene, name: String, bytes: &str, most: u64) -> Result<Reply, String> {
    let bytes = STANDARD.decode(bytes).map_err(|_| "the picture is not in base 64".to_owned())?;
    let picture = Picture::read_within(&bytes, most).map_err(|error| format!("{name}: {error}"))?;
    let [width, height] = picture.size;
    if u64::from(width) * u64::from(height) > MOST_GRADED {
        return Err(format!("{name}: at most {MOST_GRADED} pixels are graded here"));
    }
    scene.image.size = picture.size;
    let grader = Grader::new(&scene).map_err(|error| error.to_string())?;
    let graded = grader.grade(&picture).map_err(|error| format!("{name}: {error}"))?;
    Ok(Reply::Graded { name, told: grade::json(&graded, picture.size) })
}

/// A class sheet.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sheet {
    #[serde(default)]
    title: String,
    #[serde(rename = "exercise")]
    exercises: Vec<Exercise>,
}

/// A text as a class sheet; `None`: it is none, but a scene.
///
/// # Errors
/// What is wrong with it, and where.
pub(super) fn sheet(path: &str, text: &str) -> Result<Option<Reply>, String> {
    let is_header = |line: &str| line.trim_start().starts_with("[[exercise]]");
    if !text.lines().any(is_header) {
        return Ok(None);
    }
    let Sheet { title, exercises } = toml::from_str(text).map_err(|error| {
        let before = error.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
        format!("{path}:{}: {}", before.matches('\n').count() + 1, error.message())
    })?;
    Ok(Some(Reply::Sheet { title, exercises }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_is_told_from_a_scene_and_its_mistakes_are_located() {
        assert_eq!(sheet("a.toml", "version = 1\n").unwrap(), None);
        let text =
            "title = \"Week 3\"\n[[exercise]]\ntitle = \"One\"\nscene = \"a.toml\"\nmistake = 4\n";
        let told = serde_json::to_value(sheet("s.toml", text).unwrap()).unwrap();
        assert_eq!(told["exercises"][0]["mistake"], 4);
        assert_eq!(told["title"], "Week 3");
        let error = sheet("s.toml", &text.replace("scene", "scnee")).unwrap_err();
        assert!(error.starts_with("s.toml:4: ") && error.contains("scnee"), "{error}");
        assert!(sheet("s.toml", "[[exercise]]\ntitle = \"One\"\n").is_err());
    }

    #[test]
    fn a_size_is_made_small_enough_and_keeps_its_shape() {
        assert_eq!(small([320, 180]), [320, 180]);
        let [width, height] = small([1920, 1080]);
        assert!(u64::from(width) * u64::from(height) <= MOST_PIXELS);
        assert!((f64::from(width) / f64::from(height) - 16.0 / 9.0).abs() < 0.02);
        for size in [[1_000_000, 1], [1, 1_000_000], [1 << 20, 1 << 20]] {
            let [width, height] = small(size).map(u64::from);
            assert!(width >= 1 && height >= 1 && width * height <= MOST_PIXELS, "{size:?}");
        }
    }
}
