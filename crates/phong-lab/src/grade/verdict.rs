//! What is said of all that was tried.

use super::Grade;
use super::mistakes::Mistake;
use super::picture::{NotNumbers, Residual};
use super::search::{Library, Search, Tried};

/// A possible cause.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Its name, from [`MISTAKES`](super::MISTAKES), or two joined by ` + `.
    pub cause: String,
    /// What is wrong, and what would be right.
    pub says: String,
    /// What speaks for it.
    pub evidence: String,
    /// How far the picture is off if this was done wrong on purpose: root of the mean square of
    /// encoded values, 1 is white.
    pub rms: f64,
    /// Whether it explains the picture.
    pub explains: bool,
}

/// Two explanations are told apart if one leaves more than the other by this, on the whole: squared
/// steps of 8 bits, of which rounding alone makes no more than a third of it…
const APART: f64 = 12.0;
/// …and by this share of what the better one leaves, which is mostly rounding.
const APART_SHARE: f64 = 0.005;
/// So many candidates are told.
const CANDIDATES: usize = 5;

/// What is to be said; how far the picture is off is for the caller to say.
pub(super) fn verdict(library: &Library, search: Search, agrees: bool) -> Grade {
    let Search { mut tried, objects } = search;
    tried.sort_by(|a, b| a.tally.score().total_cmp(&b.tally.score()));
    // Each cause is told in its best way.
    let mut told: Vec<String> = Vec::new();
    let (explaining, others): (Vec<Tried>, Vec<Tried>) =
        tried.into_iter().partition(|one| one.explains);
    let mut best_ways = Vec::new();
    for one in explaining.into_iter().chain(others) {
        if !told.contains(&one.cause()) {
            told.push(one.cause());
            best_ways.push(one);
        }
    }
    let equals = best_ways.iter().take_while(|one| one.explains && !apart(&best_ways[0], one));
    let mut equals = equals.count();
    // One mistake is preferred to two.
    let fewest = best_ways[..equals].iter().map(Tried::count).min().unwrap_or(0);
    let more: Vec<Tried> = best_ways.extract_if(..equals, |one| one.count() > fewest).collect();
    equals -= more.len();
    best_ways[..equals].sort_by_key(Tried::place);
    let confidence = match best_ways.first().filter(|_| equals > 0) {
        Some(best) => confidence(best, best_ways.get(equals), equals),
        None => f64::from(u8::from(agrees)),
    };
    let causes: Vec<String> = best_ways[..equals].iter().map(Tried::cause).collect();
    let told_apart_by = (equals > 1).then(|| best_ways[0].mistakes[0].needs.to_owned());
    let pass = agrees && equals == 0;
    let worth = |one: &&Tried| one.explains || one.tally.score() < 0.9 * one.without.score();
    let count = if pass { 0 } else { equals.max(CANDIDATES) };
    let candidates = best_ways.iter().filter(worth).take(count).map(candidate).collect();
    let names = library.right.view.objects().iter().map(|object| object.name.clone());
    let wrong = objects.unwrap_or_default();
    Grade {
        pass,
        cause: causes.first().cloned(),
        tied: causes.into_iter().skip(1).collect(),
        told_apart_by,
        confidence,
        candidates,
        unrevealed: library.unrevealed.clone(),
        objects: names.zip(wrong).filter(|(_, wrong)| *wrong).map(|(name, _)| name).collect(),
        residual: Residual::default(),
        terms: Vec::new(),
    }
}

/// How much more the second leaves than the first, and how much that must be for the first to explain
/// the picture clearly better: both on the whole.
fn margin(first: &Tried, second: &Tried) -> (f64, f64) {
    let pixels = first.tally.pixels.min(second.tally.pixels) as f64;
    let more = second.tally.score() - first.tally.score();
    (more * pixels, APART.max(APART_SHARE * first.tally.score() * pixels))
}

fn apart(first: &Tried, second: &Tried) -> bool {
    let (more, needed) = margin(first, second);
    more > needed
}

/// The share of the error that the best explains, less where the next comes near, and divided among
/// equals.
fn confidence(best: &Tried, next: Option<&Tried>, equals: usize) -> f64 {
    // Two mistakes have more ways to be right by chance.
    let trust = if best.mistakes.len() > 1 { 0.9 } else { 0.99 };
    let fit = trust * best.tally.fit(&best.without);
    if equals > 1 {
        return fit / equals as f64;
    }
    let near = next.map_or(0.0, |next| {
        let (more, needed) = margin(best, next);
        needed / (needed + more.max(0.0))
    });
    fit * (1.0 - 0.4 * near)
}

fn candidate(tried: &Tried) -> Candidate {
    let says: Vec<&str> = tried.mistakes.iter().map(|m| m.says).collect();
    let mut evidence = format!(
        "with this mistake our picture differs by {:.2}/255 rms, without it by {:.2}/255",
        255.0 * tried.tally.rms(),
        255.0 * tried.without.rms()
    );
    if let Some(more) = &tried.evidence {
        evidence = format!("{evidence}; {more}");
    }
    let says = says.join("; and ");
    Candidate {
        cause: tried.cause(),
        says: match &tried.of {
            Some(of) => format!("{says} ({of})"),
            None => says,
        },
        evidence,
        rms: tried.tally.rms(),
        explains: tried.explains,
    }
}

/// Adds that values are no numbers, which is seen without trying.
pub(super) fn add_not_numbers(grade: &mut Grade, broken: NotNumbers, width: u32) {
    let NotNumbers { count, first } = broken;
    let (x, y) = (first as u32 % width, first as u32 / width);
    let mistake = Mistake::named("not-a-number");
    let pixels = if count == 1 { "pixel is" } else { "pixels are" };
    let candidate = Candidate {
        cause: mistake.cause.to_owned(),
        says: mistake.says.to_owned(),
        evidence: format!("{count} {pixels} no number, the first at ({x}, {y})"),
        rms: grade.residual.rms,
        explains: true,
    };
    grade.cause = Some(match &grade.cause {
        Some(other) => format!("{} + {other}", mistake.cause),
        None => mistake.cause.to_owned(),
    });
    if grade.candidates.iter().all(|one| !one.explains) {
        grade.confidence = 1.0;
    }
    grade.candidates.insert(0, candidate);
    grade.pass = false;
}
