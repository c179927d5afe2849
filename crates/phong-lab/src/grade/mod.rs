//! Somebody else's picture of a scene held against ours, and what is wrong with it named.
//!
//! What the centre ray of every pixel meets is known, so the picture that a program with a known
//! mistake would draw can be computed. The mistake whose picture comes nearest is the most likely
//! cause. Pixels at the edges of objects and shadows are left out: there, programs may differ by
//! how they sample.

mod acne;
mod mistakes;
mod picture;
mod points;
mod shade;
mod terms;

use std::sync::Arc;

use phong_scene::Scene;
use thiserror::Error;

use mistakes::{Curve, Kind, Layout};
pub use mistakes::{MISTAKES, Mistake};
use phong::image::Picture;
use phong::look::Look;
use phong::render::{OptionsError, RenderOptions};
use phong::view::{View, ViewError};
pub use picture::Residual;
use picture::{NotNumbers, Theirs, encode};
use points::{Point, gather};
use shade::{Wrong, shade};

/// A picture passes if its rms error is at most this…
const PASS_RMS: f64 = 1.0 / 255.0;
/// …and at most this share of its pixels is more than [`Residual::NOTICED`] off.
const PASS_SHARE: f64 = 5e-4;
/// A mistake is named if it takes the error down to at most this share of what it was.
const EXPLAINS: f64 = 0.4;
/// Pairs of mistakes are tried if no single one comes nearer than this.
const GOOD: f64 = 1.5 / 255.0;
/// How many of the likeliest mistakes are tried in pairs with each other one.
const PAIRED: usize = 6;

/// What is to be said about a picture.
#[derive(Clone, Debug)]
pub struct Grade {
    /// Whether it is the picture of the scene.
    pub pass: bool,
    /// The most likely cause; two, joined by ` + `; `None`: it passes, or nothing known explains it.
    pub cause: Option<String>,
    /// 1 − what is left of the error with the cause taken into account; 1 for a pass.
    pub confidence: f64,
    /// The likeliest causes, the best first, at most five.
    pub candidates: Vec<Candidate>,
    /// How far it is off.
    pub residual: Residual,
    /// How much of each of our terms is in it, by least squares over the linear values: 1 is
    /// right, 0 is missing, below 0 is subtracted. `None`: the scene has no such term.
    pub terms: Vec<(String, Option<f64>)>,
}

/// A possible cause.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Its name, from [`MISTAKES`], or two joined by ` + `.
    pub cause: String,
    /// What is wrong, and what would be right.
    pub says: String,
    /// What speaks for it.
    pub evidence: String,
    /// How far the picture is off if this was done wrong on purpose.
    pub residual: Residual,
}

/// Why a picture cannot be graded.
#[derive(Clone, Debug, Error)]
pub enum GradeError {
    /// It is not of the scene's size: the caller's fault.
    #[error(
        "the picture is {} × {}, but the scene's is {} × {}", theirs[0], theirs[1], ours[0], ours[1]
    )]
    Size {
        /// The picture's size.
        theirs: [u32; 2],
        /// The scene's size.
        ours: [u32; 2],
    },
    /// The scene asks for a picture that cannot be drawn: the caller's fault.
    #[error(transparent)]
    Options(#[from] OptionsError),
    /// It has no colour channels.
    #[error("the picture has no colour channels")]
    NoColor,
    /// The scene cannot be made ready for rays.
    #[error(transparent)]
    View(#[from] ViewError),
}

/// Grades a picture of a scene, drawn by another program with a sample or more a pixel.
///
/// # Errors
/// [`GradeError`].
pub fn grade(scene: &Scene, picture: &Picture) -> Result<Grade, GradeError> {
    let ours = scene.image.size;
    if picture.size != ours {
        return Err(GradeError::Size { theirs: picture.size, ours });
    }
    let theirs = Theirs::new(picture).ok_or(GradeError::NoColor)?;
    let right = Prepared::new(View::of(scene)?, scene)?;
    let residual = right.residual(&theirs, &Fault::default());
    let terms = terms::fit(&right, &theirs);
    let broken = theirs.not_numbers().map(|broken| broken.candidate(ours[0], residual));
    if residual.rms <= PASS_RMS && residual.over <= PASS_SHARE {
        let cause = broken.as_ref().map(|broken| broken.cause.clone());
        let (pass, candidates) = (broken.is_none(), Vec::from_iter(broken));
        return Ok(Grade { pass, cause, confidence: 1.0, candidates, residual, terms });
    }
    let mut tried = singles(scene, &right, &theirs)?;
    tried.sort_by_key(Tried::rank);
    if tried.first().is_some_and(|best| best.residual.rms > GOOD) {
        let pairs = pairs(&right, &theirs, &tried);
        tried.extend(pairs);
        tried.sort_by_key(Tried::rank);
    }
    tried.retain(|one| one.residual.rms < 0.95 * residual.rms);
    tried.truncate(5);
    let mut candidates: Vec<Candidate> =
        tried.iter().map(|tried| tried.candidate(residual)).collect();
    let best = candidates.first();
    let confidence = best.map_or(0.0, |best| 1.0 - best.residual.rms / residual.rms);
    let explained = best.filter(|best| best.residual.rms <= EXPLAINS * residual.rms);
    let causes: Vec<&str> =
        broken.iter().chain(explained).map(|candidate| candidate.cause.as_str()).collect();
    let cause = (!causes.is_empty()).then(|| causes.join(" + "));
    candidates.splice(0..0, broken);
    Ok(Grade { pass: false, cause, confidence, candidates, residual, terms })
}

/// A scene, and what its pixels are made of.
struct Prepared {
    scene: View,
    size: [u32; 2],
    points: Vec<Point>,
    /// Pixels to compare: not at an edge.
    inner: Vec<bool>,
}

/// Something done wrong on purpose.
#[derive(Clone, Copy)]
struct Fault {
    wrong: Wrong,
    curve: Curve,
    layout: Option<Layout>,
}

impl Default for Fault {
    fn default() -> Self {
        Self { wrong: Wrong::default(), curve: Curve::Right, layout: None }
    }
}

impl Fault {
    /// This fault and another mistake; `None` if the mistake is of another kind.
    fn with(mut self, mistake: &Mistake) -> Option<Self> {
        match mistake.kind {
            Kind::Sum(change) => change(&mut self.wrong),
            Kind::Curve(curve) => self.curve = curve,
            Kind::Layout(layout) => self.layout = Some(layout),
            Kind::Scene(_) | Kind::Acne | Kind::NotNumbers => return None,
        }
        Some(self)
    }
}

/// One or two mistakes, tried.
struct Tried {
    mistakes: Vec<&'static Mistake>,
    residual: Residual,
    evidence: Option<String>,
}

impl Tried {
    /// The error in steps too small to tell two mistakes apart: sorting is stable, so of equals
    /// the earlier in the list, and a single mistake before a pair, comes first.
    fn rank(&self) -> u64 {
        (self.residual.rms * 255.0 * 20.0) as u64
    }

    fn candidate(&self, without: Residual) -> Candidate {
        let joined = |f: fn(&Mistake) -> &'static str, by| {
            self.mistakes.iter().map(|m| f(m)).collect::<Vec<_>>().join(by)
        };
        let met = format!(
            "with this mistake our picture differs by {:.2}/255 rms, without it by {:.2}/255",
            255.0 * self.residual.rms,
            255.0 * without.rms
        );
        Candidate {
            cause: joined(|m| m.cause, " + "),
            says: joined(|m| m.says, "; and "),
            evidence: match &self.evidence {
                Some(more) => format!("{met}; {more}"),
                None => met,
            },
            residual: self.residual,
        }
    }
}

impl NotNumbers {
    /// Named for what it is; `residual` is that of the other pixels.
    fn candidate(self, width: u32, residual: Residual) -> Candidate {
        let Self { count, first } = self;
        let (x, y) = (first as u32 % width, first as u32 / width);
        let mistake = MISTAKES.iter().find(|mistake| matches!(mistake.kind, Kind::NotNumbers));
        let told = |f: fn(&Mistake) -> &'static str| mistake.map_or("", f).to_owned();
        let pixels = if count == 1 { "pixel is" } else { "pixels are" };
        Candidate {
            cause: told(|mistake| mistake.cause),
            says: told(|mistake| mistake.says),
            evidence: format!("{count} {pixels} no number, the first at ({x}, {y})"),
            residual,
        }
    }
}

/// Every mistake, tried alone.
fn singles(scene: &Scene, right: &Prepared, theirs: &Theirs) -> Result<Vec<Tried>, GradeError> {
    let mut tried = Vec::with_capacity(MISTAKES.len());
    for mistake in MISTAKES {
        let mut evidence = None;
        let residual = match mistake.kind {
            Kind::Scene(change) => {
                let mut changed = scene.clone();
                change(&mut changed);
                if (&changed.camera, &changed.lights) == (&scene.camera, &scene.lights) {
                    continue;
                }
                // Nothing that rays meet is other.
                let geometry = Arc::clone(right.scene.geometry());
                let view = View::new(geometry, Look::new(&changed))?;
                Prepared::new(view, &changed)?.residual(theirs, &Fault::default())
            }
            Kind::Acne => match acne::look(right, theirs) {
                Some((residual, seen)) => {
                    evidence = Some(seen);
                    residual
                }
                None => continue,
            },
            // Seen without trying.
            Kind::NotNumbers => continue,
            Kind::Sum(_) | Kind::Curve(_) | Kind::Layout(_) => {
                let Some(fault) = Fault::default().with(mistake) else { continue };
                right.residual(theirs, &fault)
            }
        };
        tried.push(Tried { mistakes: vec![mistake], residual, evidence });
    }
    Ok(tried)
}

/// The likeliest mistakes, each with every other one.
fn pairs(right: &Prepared, theirs: &Theirs, singles: &[Tried]) -> Vec<Tried> {
    let likeliest: Vec<&Mistake> = singles
        .iter()
        .filter_map(|tried| tried.mistakes.first())
        .filter(|mistake| Fault::default().with(mistake).is_some())
        .take(PAIRED)
        .copied()
        .collect();
    let mut tried = Vec::new();
    for (i, first) in likeliest.iter().enumerate() {
        for second in MISTAKES {
            if likeliest[..=i].iter().any(|earlier| earlier.cause == second.cause) {
                continue;
            }
            let fault = Fault::default().with(first).and_then(|fault| fault.with(second));
            if let (Some(fault), Some(first)) =
                (fault, MISTAKES.iter().find(|m| m.cause == first.cause))
            {
                let residual = right.residual(theirs, &fault);
                tried.push(Tried { mistakes: vec![first, second], residual, evidence: None });
            }
        }
    }
    tried
}

impl Prepared {
    /// `view` is what the picture of `scene` shows.
    fn new(view: View, scene: &Scene) -> Result<Self, GradeError> {
        let options = RenderOptions::of(&scene.image)?;
        let points = gather(&view, &options);
        let inner = picture::inner(&points, options.size());
        Ok(Self { scene: view, size: options.size(), points, inner })
    }

    /// How far their picture is from ours, drawn with a fault.
    fn residual(&self, theirs: &Theirs, fault: &Fault) -> Residual {
        let ours = |i: usize| {
            let total = shade(&self.points[i], &fault.wrong).total();
            encode(total, fault.curve)
        };
        picture::residual(self.size, &self.inner, ours, |i| theirs.at(i, self.size, fault.layout))
    }
}
