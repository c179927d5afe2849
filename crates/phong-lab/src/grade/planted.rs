//! A picture with one mistake in it, for somebody to find.

use phong::view::View;
use phong_scene::Scene;
use rayon::prelude::*;

use super::GradeError;
use super::fault::{Change, Fault};
use super::hypotheses::{Hypothesis, at_points};
use super::mistakes::{MISTAKES, Mistake};
use super::picture::{Layout, Residual};
use super::prepared::Prepared;
use super::shade::shade;
use super::tone::encode;

/// A mistake is planted only if it is notable in this share of the pixels.
const LEAST_SEEN: f64 = 0.003;

/// So many pixels are looked at to see whether it is.
const LOOKED_AT: usize = 1500;

/// So many mistakes are offered to choose from.
const OFFERED: usize = 8;

/// A picture of a scene as a program with one known mistake draws it, a sample a pixel.
///
/// ```
/// use phong_lab::grade::Planted;
/// use phong_scene::{Limits, Memory, read};
/// let text = "version = 1\n[image]\nsize = [32, 18]\n[camera]\neye = [0, 1, 5]\nlook_at = [0, 0, 0]\n\
///             [[light]]\nkind = \"point\"\nposition = [3, 4, 5]\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
/// let files = Memory::new().with("ball.toml", text.as_bytes());
/// let scene = read("ball.toml", None, &files, &Limits::default()).scene.ok_or("broken")?;
/// let planted = Planted::new(&scene, 7)?.ok_or("nothing can be seen in this scene")?;
/// assert!(planted.choices().iter().any(|mistake| planted.is_it(mistake.cause)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Planted {
    right: Prepared,
    /// Every mistake that could have been planted, in each of its ways.
    hypotheses: Vec<Hypothesis>,
    mistake: &'static Mistake,
    choices: Vec<&'static Mistake>,
    values: Vec<[f32; 3]>,
}

impl std::fmt::Debug for Planted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Planted").field("cause", &self.mistake.cause).finish_non_exhaustive()
    }
}

impl Planted {
    /// Plants one of the mistakes that this scene can show; which, `seed` decides. `None`: the scene
    /// shows none.
    ///
    /// # Errors
    /// [`GradeError::Options`], [`GradeError::View`].
    pub fn new(scene: &Scene, seed: u64) -> Result<Option<Self>, GradeError> {
        Self::among(scene, seed, |_| true)
    }

    /// Plants the mistake of this name, which is then the only choice. `None`: the scene does not show it,
    /// or there is none of that name.
    ///
    /// # Errors
    /// As of [`new`](Self::new).
    pub fn of(scene: &Scene, cause: &str) -> Result<Option<Self>, GradeError> {
        Self::among(scene, 0, |mistake| mistake.cause == cause)
    }

    fn among(
        scene: &Scene,
        seed: u64,
        is_wanted: impl Fn(&Mistake) -> bool,
    ) -> Result<Option<Self>, GradeError> {
        let right = Prepared::new(View::of(scene)?, scene)?;
        let mut hypotheses = at_points(scene, &right);
        // Any background explains any background: as a riddle it says nothing.
        hypotheses
            .retain(|one| !matches!(one.change, Change::AnyBackground) && is_wanted(one.mistake));
        let some = &right.some[..right.some.len().min(LOOKED_AT)];
        let least = (LEAST_SEEN * some.len() as f64) as usize;
        let is_seen = |one: &Hypothesis| {
            let fault = Fault::default().with(&one.change);
            let off = some.iter().filter(|&&i| differ(level(&right, &fault, i), right.ours[i]));
            off.count() > least
        };
        let shows: Vec<bool> = hypotheses.par_iter().map(is_seen).collect();
        let mut seen: Vec<(&'static Mistake, usize)> = Vec::new();
        for (i, one) in hypotheses.iter().enumerate().filter(|(i, _)| shows[*i]) {
            if seen.iter().all(|(mistake, _)| mistake.cause != one.mistake.cause) {
                seen.push((one.mistake, i));
            }
        }
        let mut dice = Dice(seed);
        let Some(chosen) = dice.below(seen.len()) else { return Ok(None) };
        let (mistake, which) = seen.remove(chosen);
        let mut choices = vec![mistake];
        while choices.len() < OFFERED
            && let Some(other) = dice.below(seen.len())
        {
            choices.push(seen.remove(other).0);
        }
        choices.sort_by_key(|mistake| mistake.place());
        let values = draw(&right, &hypotheses[which]);
        Ok(Some(Self { right, hypotheses, mistake, choices, values }))
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.right.size
    }

    /// The picture: red, green and blue of each pixel, on the sRGB curve, from 0 to 1, row by row.
    pub fn values(&self) -> &[[f32; 3]] {
        &self.values
    }

    /// What is planted.
    pub fn mistake(&self) -> &'static Mistake {
        self.mistake
    }

    /// Mistakes to choose from, among them the one that is planted, in the order of [`MISTAKES`].
    pub fn choices(&self) -> &[&'static Mistake] {
        &self.choices
    }

    /// Whether a mistake of that name is in the picture: the one that was planted, or one that makes
    /// the same picture of this scene.
    pub fn is_it(&self, cause: &str) -> bool {
        let mut ways = self.hypotheses.iter().filter(|one| one.mistake.cause == cause);
        cause == self.mistake.cause
            || ways.any(|one| apart(&draw(&self.right, one), &self.values) == 0)
    }

    /// The mistake of that name, planted or not.
    pub fn known(cause: &str) -> Option<&'static Mistake> {
        MISTAKES.iter().find(|mistake| mistake.cause == cause)
    }
}

/// The picture as a program with this mistake draws it.
fn draw(right: &Prepared, hypothesis: &Hypothesis) -> Vec<[f32; 3]> {
    let fault = Fault::default().with(&hypothesis.change);
    let all = (0..right.points.len()).into_par_iter().with_min_len(256);
    all.map(|i| level(right, &fault, i)).collect()
}

/// A pixel of it.
fn level(right: &Prepared, fault: &Fault, i: usize) -> [f32; 3] {
    let [width, height] = right.size.map(|side| side as usize);
    let (x, y) = (i % width, i / width);
    let from = match fault.layout {
        Some(Layout::UpsideDown) => (height - 1 - y) * width + x,
        Some(Layout::LeftRight) => y * width + width - 1 - x,
        Some(Layout::Turned) => (height - 1 - y) * width + width - 1 - x,
        Some(Layout::BlueFirst | Layout::Shifted(..)) | None => i,
    };
    let sum = shade(&right.points[from], fault, &right.facts);
    let [r, g, b] = encode(sum.total() * fault.gain, fault.tone);
    if fault.layout == Some(Layout::BlueFirst) { [b, g, r] } else { [r, g, b] }
}

/// How many pixels differ notably.
fn apart(a: &[[f32; 3]], b: &[[f32; 3]]) -> usize {
    a.iter().zip(b).filter(|(a, b)| differ(**a, **b)).count()
}

fn differ(a: [f32; 3], b: [f32; 3]) -> bool {
    a.iter().zip(b).any(|(a, b)| {
        let off = f64::from((a - b).abs());
        off > Residual::NOTICED || off.is_nan()
    })
}

/// Numbers that look random and follow from a seed.
struct Dice(u64);

impl Dice {
    fn below(&mut self, count: usize) -> Option<usize> {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed >> 33) as usize).checked_rem(count)
    }
}

#[cfg(test)]
mod tests {
    use phong_scene::{Limits, Memory, read};

    use super::*;
    use crate::grade::Grader;
    use phong::image::{Picture, Plane, Transfer};

    const SCENE: &str = "version = 1\n[image]\nsize = [64, 36]\nbackground = \"#345\"\n\
        [camera]\neye = [0, 1, 6]\nlook_at = [0, 0.5, 0]\n\
        [[light]]\nkind = \"point\"\nposition = [3, 4, 5]\ncolor = [1, 0.8, 0.6]\n\
        [[light]]\nkind = \"distant\"\ndirection = [2, -3, -1]\ncolor = 0.4\n\
        [materials.red]\ncolor = \"#c0302a\"\nshininess = 20\n\
        [[sphere]]\ncenter = [0, 0.8, 0]\nradius = 0.8\nmaterial = \"red\"\n\
        [[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n";

    fn scene(text: &str) -> Scene {
        let files = Memory::new().with("a.toml", text.as_bytes());
        read("a.toml", None, &files, &Limits::default()).scene.unwrap()
    }

    #[test]
    fn every_planted_mistake_is_found_by_the_grader() {
        let scene = scene(SCENE);
        let grader = Grader::new(&scene).unwrap();
        let mut causes = Vec::new();
        for seed in 0..12 {
            let planted = Planted::new(&scene, seed).unwrap().unwrap();
            assert!(planted.is_it(planted.mistake().cause) && !planted.is_it("no such thing"));
            assert_eq!(planted.choices().len(), OFFERED);
            let plane = |c: usize| Plane {
                name: ["R", "G", "B"][c].to_owned(),
                values: planted.values().iter().map(|v| v[c]).collect(),
            };
            let picture = Picture {
                size: planted.size(),
                planes: (0..3).map(plane).collect(),
                transfer: Transfer::Srgb,
                levels: None,
                lossy: None,
            };
            let graded = grader.grade(&picture).unwrap();
            assert!(!graded.pass);
            let cause = graded.cause.unwrap_or_default();
            let right = planted.is_it(&cause) || graded.tied.iter().any(|tied| planted.is_it(tied));
            assert!(right, "{}: {cause} {:?}", planted.mistake().cause, graded.tied);
            causes.push(planted.mistake().cause);
        }
        causes.sort_unstable();
        causes.dedup();
        assert!(causes.len() > 5, "seeds plant different mistakes: {causes:?}");
    }

    #[test]
    fn a_scene_without_anything_in_it_shows_no_mistake() {
        let empty =
            "version = 1\n[image]\nsize = [8, 8]\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
        assert!(Planted::new(&scene(empty), 1).unwrap().is_none());
    }
}
