//! The difference of two renderings, told apart by the terms of the equation.

use phong::film::{Film, LayerKind};
use phong::terms::Term;

use super::CompareError;

/// How much of the difference of two renderings is in one term; linear values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TermDifference {
    /// Which term.
    pub term: Term,
    /// The term's mean in the first, over all pixels and channels.
    pub mean_a: f64,
    /// The same in the second.
    pub mean_b: f64,
    /// The mean absolute difference.
    pub mean: f64,
    /// The largest absolute difference.
    pub max: f64,
    /// Where it is, the first of several.
    pub worst: [u32; 2],
    /// Its share of the absolute differences of all terms, in [0, 1]; 0 where nothing differs.
    ///
    /// The terms' differences may cancel in the picture, so that the shares are of their sum and
    /// not of the picture's difference.
    pub share: f64,
}

/// Holds the terms of two renderings against each other, in the order of the sum; terms
/// that one film lacks are left out.
///
/// # Errors
/// [`CompareError::Size`]; [`CompareError::Channels`] where the films have no terms.
pub fn terms(a: &Film, b: &Film) -> Result<Vec<TermDifference>, CompareError> {
    let [of_a, of_b] = [a, b].map(|film| [film.width(), film.height()]);
    if of_a != of_b {
        return Err(CompareError::Size { a: of_a, b: of_b });
    }
    let mut all = Vec::new();
    for term in Term::ALL {
        let kind = LayerKind::Term(term);
        let (Some(one), Some(two)) = (a.layer(kind), b.layer(kind)) else { continue };
        all.push(difference(term, &one.values, &two.values, of_a[0]));
    }
    if all.is_empty() {
        return Err(CompareError::Channels);
    }
    let whole: f64 = all.iter().map(|term| term.mean).sum();
    for term in &mut all {
        term.share = if whole > 0.0 { term.mean / whole } else { 0.0 };
    }
    Ok(all)
}

fn difference(term: Term, a: &[f32], b: &[f32], width: u32) -> TermDifference {
    let mut told = TermDifference {
        term,
        mean_a: 0.0,
        mean_b: 0.0,
        mean: 0.0,
        max: 0.0,
        worst: [0, 0],
        share: 0.0,
    };
    for (i, (&a, &b)) in a.iter().zip(b).enumerate() {
        let (a, b) = (f64::from(a), f64::from(b));
        let d = (a - b).abs();
        told.mean_a += a;
        told.mean_b += b;
        told.mean += d;
        if d > told.max {
            let pixel = (i / 3) as u32;
            (told.max, told.worst) = (d, [pixel % width, pixel / width]);
        }
    }
    let count = a.len().max(1) as f64;
    for sum in [&mut told.mean_a, &mut told.mean_b, &mut told.mean] {
        *sum /= count;
    }
    told
}

#[cfg(test)]
mod tests {
    use super::*;
    use phong::film::Window;

    fn film(diffuse: [f32; 6], specular: [f32; 6]) -> Film {
        let kinds =
            [LayerKind::Picture, LayerKind::Term(Term::Diffuse), LayerKind::Term(Term::Specular)];
        let mut film = Film::new([2, 1], Window::full([2, 1]), 16, &kinds);
        film.layers[1].values = diffuse.into_iter().collect();
        film.layers[2].values = specular.into_iter().collect();
        film
    }

    #[test]
    fn shares_are_of_the_absolute_differences_of_all_terms() {
        let a = film([0.5; 6], [0.0; 6]);
        let b = film([0.5, 0.5, 0.5, 0.5, 0.5, 0.2], [0.0, 0.0, 0.0, 0.0, 0.9, 0.0]);
        let told = terms(&a, &b).unwrap();
        assert_eq!(
            told.iter().map(|t| t.term).collect::<Vec<_>>(),
            [Term::Diffuse, Term::Specular]
        );
        let [diffuse, specular] = told[..] else { panic!("two terms") };
        assert!((diffuse.mean - 0.05).abs() < 1e-7 && (diffuse.max - 0.3).abs() < 1e-7);
        assert!((diffuse.share - 0.25).abs() < 1e-6 && (specular.share - 0.75).abs() < 1e-6);
        assert_eq!(specular.worst, [1, 0]);
        assert!((diffuse.mean_a - 0.5).abs() < 1e-12 && (diffuse.mean_b - 0.45).abs() < 1e-7);
    }

    #[test]
    fn what_does_not_differ_has_no_share() {
        let a = film([0.5; 6], [0.25; 6]);
        assert!(terms(&a, &a).unwrap().iter().all(|t| t.share == 0.0 && t.max == 0.0));
    }

    #[test]
    fn films_of_other_sizes_or_without_terms_are_refused() {
        let a = film([0.5; 6], [0.0; 6]);
        let other = Film::new([1, 2], Window::full([1, 2]), 16, &[LayerKind::Term(Term::Diffuse)]);
        assert_eq!(terms(&a, &other), Err(CompareError::Size { a: [2, 1], b: [1, 2] }));
        let bare = Film::new([2, 1], Window::full([2, 1]), 16, &[LayerKind::Picture]);
        assert_eq!(terms(&a, &bare), Err(CompareError::Channels));
    }
}
