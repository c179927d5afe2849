//! Somebody else's picture of a scene held against ours, and what is wrong with it named.
//!
//! What the centre ray of every pixel meets is known, so the picture that a program with a known
//! mistake would draw can be computed. A mistake is named if it explains the picture: if with it
//! ours would pass. What explains it as well is told as tied, and where nothing explains it,
//! nothing is named. Pixels at the edges of objects and shadows are left out, except to see whether
//! the whole picture is moved: there, programs may differ by how they sample.

mod acne;
mod elsewhere;
mod fault;
mod fitted;
mod hypotheses;
mod json;
mod judge;
mod lossy;
mod mistakes;
mod picture;
mod planted;
mod points;
mod prepared;
mod search;
mod shade;
mod terms;
mod tone;
mod verdict;
mod wrong;

use phong_scene::{LightKind, Material, Scene, ShadowRule, Tone};
use thiserror::Error;

pub use json::json;
use judge::Judge;
pub use mistakes::{MISTAKES, Mistake};
use phong::image::Picture;
use phong::render::OptionsError;
use phong::view::{View, ViewError};
pub use picture::Residual;
use picture::Theirs;
pub use planted::Planted;
use prepared::Prepared;
use search::Library;
pub use verdict::Candidate;

/// A picture passes if its rms error is at most this…
const PASS_RMS: f64 = judge::MOST_RMS;
/// …and at most this share of its pixels is more than [`Residual::NOTICED`] off.
const PASS_SHARE: f64 = 5e-4;

/// What is to be said about a picture.
#[derive(Clone, Debug)]
pub struct Grade {
    /// Whether it is the picture of the scene.
    pub pass: bool,
    /// What explains it; two, joined by ` + `; `None`: it passes, or nothing known explains it.
    pub cause: Option<String>,
    /// Other causes that explain it as well: the pictures cannot be told apart in this scene.
    pub tied: Vec<String>,
    /// What a scene has in which those that are tied can be told apart: to be read after "a scene
    /// with". `None`: nothing is tied.
    pub told_apart_by: Option<String>,
    /// In [0, 1]: the share of the error that the cause explains, less where another one comes near,
    /// divided among those that are tied; 0 without a cause; 1 for a pass.
    pub confidence: f64,
    /// The likeliest causes, the best first, at most five and those that are tied.
    pub candidates: Vec<Candidate>,
    /// Causes that this scene cannot reveal: they change nothing notable in its picture, or send rays
    /// elsewhere, which is not looked for in scenes with a sky, fog or ambient occlusion.
    pub unrevealed: Vec<&'static str>,
    /// The objects that differ, where others do not; else empty.
    pub objects: Vec<String>,
    /// How far it is off.
    pub residual: Residual,
    /// How much of each of our terms is in it, by least squares over the linear values: 1 is
    /// right, 0 is missing, below 0 is subtracted. `None`: the scene has no such term.
    pub terms: Vec<(String, Option<f64>)>,
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
    /// The scene has something that mistakes are not known of yet.
    #[error("scenes with {0} cannot be graded yet")]
    NotYet(&'static str),
    /// The scene cannot be made ready for rays.
    #[error(transparent)]
    View(#[from] ViewError),
}

/// A scene, ready to have pictures graded.
///
/// What its pixels are made of is found out once, for all pictures.
pub struct Grader {
    library: Library,
}

impl std::fmt::Debug for Grader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Grader").field("size", &self.library.right.size).finish_non_exhaustive()
    }
}

impl Grader {
    /// Makes a scene ready, at the size it asks for.
    ///
    /// # Errors
    /// [`GradeError::Options`], [`GradeError::NotYet`], [`GradeError::View`].
    pub fn new(scene: &Scene) -> Result<Self, GradeError> {
        let lets_light_through =
            |m: &Material| m.is_see_through() || m.shadow == Some(ShadowRule::Filtered);
        if scene.tone.is_some_and(|tone| tone != Tone::default()) {
            return Err(GradeError::NotYet(
                "exposure, white balance or a curve of their own (`[tone]`)",
            ));
        }
        if scene.lights.iter().any(|light| matches!(light.kind, LightKind::Mesh { .. })) {
            return Err(GradeError::NotYet("meshes that shine"));
        }
        if scene.image.cel.is_some() {
            return Err(GradeError::NotYet("luminance in steps (`cel`)"));
        }
        if !scene.clips.is_empty() {
            return Err(GradeError::NotYet("what is cut away"));
        }
        if scene.materials.iter().any(lets_light_through) {
            return Err(GradeError::NotYet("materials that let light through in a straight line"));
        }
        let right = Prepared::new(View::of(scene)?, scene)?;
        Ok(Self { library: Library::new(scene.clone(), right) })
    }

    /// Width and height of the pictures that it grades.
    pub fn size(&self) -> [u32; 2] {
        self.library.right.size
    }

    /// Grades a picture, drawn by another program with a sample or more a pixel.
    ///
    /// # Errors
    /// [`GradeError::Size`], [`GradeError::NoColor`].
    pub fn grade(&self, picture: &Picture) -> Result<Grade, GradeError> {
        let right = &self.library.right;
        if picture.size != right.size {
            return Err(GradeError::Size { theirs: picture.size, ours: right.size });
        }
        let mut theirs = Theirs::new(picture).ok_or(GradeError::NoColor)?;
        if let Some(compression) = &picture.lossy {
            theirs.allow(&lossy::allowance(&right.ours, right.size, compression));
        }
        let residual = picture::residual(right.size, &right.inner, &right.ours, &theirs);
        let judge = Judge::new(right, &theirs);
        let agrees = residual.rms <= PASS_RMS && residual.over <= PASS_SHARE;
        let found = if agrees {
            search::search_edges(&self.library, &judge)
        } else {
            search::search(&self.library, &judge)
        };
        let mut grade = verdict::verdict(&self.library, found, agrees);
        grade.residual = residual;
        grade.terms = terms::fit(right, &theirs);
        if let Some(broken) = theirs.not_numbers() {
            verdict::add_not_numbers(&mut grade, broken, right.size[0]);
        }
        Ok(grade)
    }
}

/// Grades one picture of a scene, drawn by another program with a sample or more a pixel.
///
/// # Errors
/// [`GradeError`].
pub fn grade(scene: &Scene, picture: &Picture) -> Result<Grade, GradeError> {
    Grader::new(scene)?.grade(picture)
}
