//! All known mistakes, tried: alone, on one light or some objects, and two at a time.

use std::sync::Arc;

use phong_scene::Scene;
use rayon::prelude::*;

use super::acne;
use super::elsewhere::{Elsewhere, Way};
use super::fault::{Change, Fault};
use super::fitted::fitted;
use super::hypotheses::{Hypothesis, at_points, elsewhere, of_single_lights, swapped};
use super::judge::{FEW, Judge, Tally, Traced};
use super::mistakes::{MISTAKES, Mistake};
use super::picture::{Layout, Residual};
use super::points::Point;
use super::prepared::Prepared;
use super::shade::shade;
use super::tone::encode;
use super::wrong::Wrong;

/// One or two mistakes, tried.
#[derive(Clone, Debug)]
pub(super) struct Tried {
    pub(super) mistakes: Vec<&'static Mistake>,
    /// What it is about, where that is not all.
    pub(super) of: Option<String>,
    pub(super) tally: Tally,
    /// What is left without it of the same pixels.
    pub(super) without: Tally,
    pub(super) explains: bool,
    pub(super) evidence: Option<String>,
}

impl Tried {
    fn new(hypothesis: &Hypothesis, tally: Tally, without: Tally) -> Self {
        Self {
            mistakes: vec![hypothesis.mistake],
            of: hypothesis.of.clone(),
            explains: tally.explains(&without, false),
            tally,
            without,
            evidence: None,
        }
    }

    /// The causes, joined by ` + `.
    pub(super) fn cause(&self) -> String {
        self.mistakes.iter().map(|m| m.cause).collect::<Vec<_>>().join(" + ")
    }

    /// How many mistakes it is.
    pub(super) fn count(&self) -> usize {
        self.mistakes.iter().map(|m| if m.cause == "clamp-missing-both" { 2 } else { 1 }).sum()
    }

    /// Its place in the table.
    pub(super) fn place(&self) -> usize {
        self.mistakes.first().map_or(0, |m| m.place())
    }
}

/// What was tried.
pub(super) struct Search {
    pub(super) tried: Vec<Tried>,
    /// The objects that differ notably, by number; `None`: all do, or none.
    pub(super) objects: Option<Vec<bool>>,
}

/// The library of mistakes, made ready for one scene.
pub(super) struct Library {
    pub(super) scene: Scene,
    pub(super) right: Prepared,
    /// What changes the right picture notably.
    hypotheses: Vec<Hypothesis>,
    ways: Vec<(&'static Mistake, Way)>,
    /// What the first few rays of each of these ways meet.
    few: Vec<Vec<Option<Point>>>,
    /// Causes that change nothing in the picture of this scene.
    pub(super) unrevealed: Vec<&'static str>,
}

impl Library {
    pub(super) fn new(scene: Scene, right: Prepared) -> Self {
        let hypotheses = at_points(&scene, &right);
        let seen: Vec<bool> = hypotheses.par_iter().map(|one| is_seen(&right, one)).collect();
        let ways = elsewhere(&scene);
        let unrevealed = unrevealed(&right, &hypotheses, &seen, &ways);
        let seen = hypotheses.into_iter().zip(seen).filter(|(_, seen)| *seen);
        let hypotheses: Vec<Hypothesis> = seen.map(|(one, _)| one).collect();
        let few = &right.some[..right.some.len().min(FEW)];
        let trace = |(_, way): &(&Mistake, Way)| Elsewhere::new(&right, &scene, way).trace(few);
        let few = ways.iter().map(trace).collect();
        Self { scene, right, hypotheses, ways, few, unrevealed }
    }

    /// The ways in which rays go elsewhere, traced as far as they look likely.
    fn traced(&self, judge: &Judge) -> Vec<(&'static Mistake, Traced<'_>)> {
        let mut traced = Vec::with_capacity(self.ways.len());
        for ((mistake, way), few) in self.ways.iter().zip(&self.few) {
            let tracer = Elsewhere::new(&self.right, &self.scene, way);
            traced.push((*mistake, judge.trace_on(tracer, few)));
        }
        traced
    }
}

/// Whether a mistake changes the right picture notably in any pixel.
fn is_seen(right: &Prepared, hypothesis: &Hypothesis) -> bool {
    let fault = Fault::default().with(&hypothesis.change);
    match hypothesis.change {
        Change::AnyBackground => {
            return right.some_inner.iter().any(|&i| right.points[i].surface.is_none());
        }
        Change::Layout(_) => return true,
        _ => {}
    }
    let differs = |i: &usize| {
        let sum = shade(&right.points[*i], &fault, &right.facts);
        let drawn = encode(sum.total() * fault.gain, fault.tone);
        let apart = |(a, b): (f32, f32)| f64::from((a - b).abs()) > Residual::NOTICED;
        drawn.into_iter().zip(right.ours[*i]).any(apart)
    };
    right.some_inner.iter().any(differs)
}

/// Whether one of them explains the picture.
fn explained(tried: &[Tried]) -> bool {
    tried.iter().any(|one| one.explains)
}

/// Tries them all, until one explains the picture.
pub(super) fn search(library: &Library, judge: &Judge) -> Search {
    let Library { scene, hypotheses, .. } = library;
    let mut tried = alone(judge, hypotheses);
    let wrong = wrong_objects(judge);
    let suspects = wrong.clone().unwrap_or_else(|| vec![true; judge.right.view.objects().len()]);
    let of_numbers = fitted(judge);
    let is_rest = |h: &Hypothesis| {
        h.mistake.cause.ends_with("e-factor") || h.mistake.cause == "specular-factor"
    };
    let (rest, numbers): (Vec<_>, Vec<_>) = of_numbers.into_iter().partition(is_rest);
    tried.extend(alone(judge, &numbers));
    tried.extend(alone(judge, &swapped(scene, judge.right, &suspects)));
    let tracers = library.traced(judge);
    tried.extend(tracers.iter().map(|(mistake, traced)| {
        let (tally, without, at_edges) = judge.elsewhere(traced, &Fault::default());
        Tried {
            mistakes: vec![mistake],
            of: None,
            explains: tally.explains(&without, at_edges),
            tally,
            without,
            evidence: None,
        }
    }));
    tried.push(shifted(judge));
    if !explained(&tried) {
        tried.extend(strewn(judge));
    }
    if !explained(&tried) {
        tried.extend(alone(judge, &of_single_lights(scene)));
        if let Some(wrong) = &wrong {
            tried.extend(on_objects(judge, hypotheses, wrong));
        }
    }
    if !explained(&tried) {
        tried.extend(alone(judge, &rest));
        tried.extend(by_factors(judge, &rest));
    }
    if !explained(&tried) {
        let mut changes = hypotheses.clone();
        changes.extend(numbers);
        tried.extend(pairs(judge, &changes, &tracers));
    }
    Search { tried, objects: wrong }
}

/// Only what moves the picture by half a pixel, or whole ones: what shows at edges alone.
pub(super) fn search_edges(library: &Library, judge: &Judge) -> Search {
    let mut tried = Vec::new();
    if judge.without[1].share_over() > MOST_OFF_AT_EDGES {
        tried.push(shifted(judge));
        for (mistake, traced) in library.traced(judge) {
            let (tally, without, at_edges) = judge.elsewhere(&traced, &Fault::default());
            let explains = at_edges && tally.explains(&without, true);
            let mistakes = vec![mistake];
            tried.push(Tried { mistakes, of: None, explains, tally, without, evidence: None });
        }
    }
    Search { tried, objects: None }
}

/// A picture that agrees but at its edges, where more of its pixels than these are off, may be
/// moved by less than a pixel.
const MOST_OFF_AT_EDGES: f64 = 0.005;

fn alone(judge: &Judge, hypotheses: &[Hypothesis]) -> Vec<Tried> {
    let one = |hypothesis: &Hypothesis| {
        let tally = judge.with(&Fault::default().with(&hypothesis.change));
        Tried::new(hypothesis, tally, judge.without[0])
    };
    hypotheses.par_iter().map(one).collect()
}

/// Causes that change nothing notable of the right picture, in whichever way they are made, or that are
/// not looked for in this scene.
fn unrevealed(
    right: &Prepared,
    hypotheses: &[Hypothesis],
    are_seen: &[bool],
    ways: &[(&'static Mistake, Way)],
) -> Vec<&'static str> {
    let seen = |cause: &str| {
        let ways = hypotheses.iter().zip(are_seen);
        ways.into_iter().any(|(one, seen)| *seen && one.mistake.cause == cause)
    };
    let materials = right.view.written_materials();
    let hidden = |cause: &str| match cause {
        // Told from the picture itself, or seen in every picture that shows something.
        "not-a-number" | "shadow-acne" | "exposure" | "shifted" => false,
        "half-pixel" | "fov-half" | "far-root" => ways.is_empty(),
        "fov-horizontal" | "aspect-ignored" | "up-ignored" if ways.is_empty() => true,
        "fov-horizontal" | "aspect-ignored" => right.size[0] == right.size[1],
        "up-ignored" => {
            let up = right.view.look().camera.up;
            up.normalize_or(glam::DVec3::Y) == glam::DVec3::Y
        }
        "materials-swapped" => materials.len() < 2,
        "ambient-factor" => !seen("ambient-missing"),
        "diffuse-factor" => !seen("diffuse-missing"),
        "specular-factor" => !seen("specular-missing"),
        _ => !seen(cause),
    };
    MISTAKES.iter().map(|mistake| mistake.cause).filter(|cause| hidden(cause)).collect()
}

/// Which objects differ notably; `None` where all do, or none.
fn wrong_objects(judge: &Judge) -> Option<Vec<bool>> {
    let mut counts = vec![[0_usize; 2]; judge.right.view.objects().len()];
    for &i in judge.inner {
        let Some(surface) = &judge.right.points[i].surface else { continue };
        let Some(drawn) = judge.theirs.at(i, judge.right.size, None) else { continue };
        let noticed = drawn
            .iter()
            .zip(judge.right.ours[i])
            .any(|(drawn, ours)| drawn.apart(ours) > Residual::NOTICED);
        let count = &mut counts[surface.object as usize];
        count[0] += 1;
        count[1] += usize::from(noticed);
    }
    let wrong: Vec<bool> =
        counts.iter().map(|[all, off]| *off as f64 > (NOTED * *all as f64).max(2.0)).collect();
    let right = counts.iter().zip(&wrong).any(|(count, wrong)| !wrong && count[0] >= ENOUGH);
    (right && wrong.contains(&true)).then_some(wrong)
}

/// An object is wrong if more of its pixels than these are notably off.
const NOTED: f64 = 0.005;
/// An object of fewer pixels says nothing.
const ENOUGH: usize = 40;

/// Every mistake, on the objects that are wrong alone.
fn on_objects(judge: &Judge, hypotheses: &[Hypothesis], wrong: &[bool]) -> Vec<Tried> {
    let objects = Arc::new(wrong.to_vec());
    let of = named(judge, wrong);
    let one = |hypothesis: &Hypothesis| {
        if !matches!(hypothesis.change, Change::Sum(_) | Change::Look(_)) {
            return None;
        }
        let mut fault = Fault::default().with(&hypothesis.change);
        fault.objects = Some(Arc::clone(&objects));
        let mut tried = Tried::new(hypothesis, judge.with(&fault), judge.without[0]);
        tried.of = Some(of.clone());
        Some(tried)
    };
    hypotheses.par_iter().filter_map(one).collect()
}

/// Some objects by their names.
pub(super) fn named(judge: &Judge, which: &[bool]) -> String {
    let objects = judge.right.view.objects().iter().zip(which).filter(|(_, which)| **which);
    let names: Vec<String> = objects.map(|(object, _)| format!("`{}`", object.name)).collect();
    match names.len() {
        0..4 => names.join(", "),
        n => format!("{}, and {} more objects", names[..2].join(", "), n - 2),
    }
}

fn shifted(judge: &Judge) -> Tried {
    let (layout, tally) = judge.shifted();
    let mut hypothesis = Hypothesis::new("shifted", Change::Layout(layout));
    if let Layout::Shifted(x, y) = layout {
        hypothesis.of = Some(format!("by {x} to the right and {y} down"));
    }
    let mut tried = Tried::new(&hypothesis, tally, judge.without[1]);
    tried.explains = tally.explains(&judge.without[1], true);
    tried
}

fn strewn(judge: &Judge) -> Option<Tried> {
    let (dark, seen) = acne::look(judge.right, judge.theirs, judge.inner)?;
    let tally = judge.held_against(|i| dark[i].unwrap_or(judge.right.ours[i]));
    let hypothesis = Hypothesis::new("shadow-acne", Change::Gain(1.0));
    let mut tried = Tried::new(&hypothesis, tally, judge.without[0]);
    tried.evidence = Some(seen);
    Some(tried)
}

/// Two terms, each multiplied by a factor of its own.
fn by_factors(judge: &Judge, rest: &[Hypothesis]) -> Option<Tried> {
    let terms = super::terms::fit(judge.right, judge.theirs);
    let factor = |name: &str| terms.iter().find(|(n, _)| n == name).and_then(|(_, f)| *f);
    let (ambient, diffuse, specular) = (factor("ambient"), factor("diffuse"), factor("specular"));
    let near = |f: Option<f64>| f.is_none_or(|f| (f - 1.0).abs() < 0.02);
    let (diffuse, specular) = (diffuse?, specular?);
    let [first, second] = [Some(diffuse), Some(specular)].map(near);
    if rest.is_empty() || !near(ambient) || first || second || diffuse < 0.02 || specular < 0.02 {
        return None;
    }
    let by: fn(&mut Wrong, f32) = |w, by| w.diffuse_factor = by;
    let and: fn(&mut Wrong, f32) = |w, by| w.specular_factor = by;
    let fault = Fault::default()
        .with(&Change::Fitted(by, diffuse as f32))
        .with(&Change::Fitted(and, specular as f32));
    let tally = judge.with(&fault);
    Some(Tried {
        mistakes: ["diffuse-factor", "specular-factor"].map(Mistake::named).to_vec(),
        of: Some(format!("diffuse × {diffuse:.2}, specular × {specular:.2}")),
        explains: tally.explains(&judge.without[0], false),
        tally,
        without: judge.without[0],
        evidence: None,
    })
}

/// Every two mistakes that each change something.
fn pairs(judge: &Judge, changes: &[Hypothesis], ways: &[(&'static Mistake, Traced)]) -> Vec<Tried> {
    let seen: Vec<&Hypothesis> = changes.iter().collect();
    let of = |one: &Hypothesis, other: Option<&Hypothesis>| {
        let both: Vec<&str> =
            one.of.as_deref().into_iter().chain(other.and_then(|o| o.of.as_deref())).collect();
        (!both.is_empty()).then(|| both.join(", "))
    };
    let with = |(k, first): (usize, &&Hypothesis)| -> Vec<Tried> {
        let others = seen[k + 1..].iter().filter(|o| o.mistake.cause != first.mistake.cause);
        others
            .filter_map(|second| {
                let tally = judge.with_both(&first.change, &second.change);
                let explains = tally.explains(&judge.without[0], false);
                let mistakes = vec![first.mistake, second.mistake];
                let without = judge.without[0];
                explains.then(|| {
                    let of = of(first, Some(second));
                    Tried { mistakes, of, tally, without, explains, evidence: None }
                })
            })
            .collect()
    };
    let mut tried: Vec<Tried> = seen.par_iter().enumerate().flat_map_iter(with).collect();
    for (mistake, way) in ways {
        let also = |other: &&Hypothesis| {
            let fault = Fault::default().with(&other.change);
            let (tally, without) = judge.elsewhere_few(way, &fault)?;
            let explains = tally.explains(&without, true);
            let mistakes = vec![*mistake, other.mistake];
            explains.then(|| Tried {
                mistakes,
                of: of(other, None),
                tally,
                without,
                explains,
                evidence: None,
            })
        };
        tried.extend(seen.par_iter().filter_map(also).collect::<Vec<_>>());
    }
    // One mistake may be made in many ways: each two causes are told once.
    tried.sort_by(|a, b| a.tally.score().total_cmp(&b.tally.score()));
    let mut told: Vec<String> = Vec::new();
    tried.retain(|one| {
        let new = !told.contains(&one.cause());
        told.push(one.cause());
        new
    });
    tried
}
