//! Tiny mirrors: the lobe they add up to, and how a count of their reflections converges to it.

mod experiment;

use phong::math::{Dir3, wide};

use super::drawing::Drawing;
use super::mark::{Anchor, Path, Point, Stroke, heading};
use super::plot::{Plot, fixed, ticks};
use super::symbols::{drawn, surface, unit};
use super::{Number, Plate, Setting, style};
use experiment::{BANDS, Experiment, RANGE, THETA, Tally, facet_slope, lobe};

const TITLE: &str = "Microfacets";
const EQUATION: &str = "*D*(*h*) / (4 *n*·*l*)";

pub(super) fn draw(setting: Setting) -> Plate {
    let experiment = Experiment::new(setting.theta_or(THETA));
    let errors: Vec<(u32, f64)> =
        COUNTS.iter().map(|&count| (count, experiment.error(count))).collect();
    let many = experiment.tally(MANY, 0);
    let mut numbers: Vec<Number> = errors
        .iter()
        .map(|(count, error)| {
            Number::new(format!("error with {count} facets"), *error, "of the peak")
        })
        .collect();
    numbers.push(Number::new("slope of error against facets", slope(&errors), ""));
    let apart = experiment.distance(&many.weighted);
    numbers.push(Number::new("distance of the weighted count from the lobe", apart, "of the peak"));
    let apart = experiment.distance(&many.plain);
    numbers.push(Number::new("distance of the plain count from the lobe", apart, "of the peak"));
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "A surface of tiny mirrors, counted one by one and weighted by the light that each \
                  catches, sends out D(h)/(4 n·l), with an error that falls as 1/√count.",
        numbers,
        drawing: drawing(&experiment, &many, &errors),
    }
}

/// What so many tiny mirrors send out near the plane of incidence, beside what they should add up to.
///
/// Directions are counted in bands of equal width, by their angle from the normal; all values are per
/// steradian.
#[derive(Clone, Debug, PartialEq)]
pub struct Facets {
    /// The first and the last angle, degrees; negative on the light's side.
    pub range: [f64; 2],
    /// For each band, the facets by the light that each catches.
    pub counted: Vec<f64>,
    /// For each band, the facets counted alike.
    pub alike: Vec<f64>,
    /// `D(h)/(4 n·l)` from the first angle to the last, at equal distances, averaged over a band's width.
    pub lobe: Vec<f64>,
    /// The root mean square distance of `counted` from the lobe, in units of its peak.
    pub error: f64,
}

/// Draws the first `count` facets of the figure's surface, under light that comes in at `theta` degrees.
/// More facets begin with the same ones.
#[must_use]
pub fn facets(theta: f64, count: u32) -> Facets {
    let experiment = Experiment::new(theta);
    let Tally { weighted, plain } = experiment.tally(count, 0);
    let step = (RANGE[1] - RANGE[0]) / f64::from(CURVE);
    let lobe = (0..=CURVE).map(|i| experiment.smooth(RANGE[0] + step * f64::from(i))).collect();
    let error = experiment.distance(&weighted);
    Facets { range: RANGE, counted: weighted.to_vec(), alike: plain.to_vec(), lobe, error }
}

/// Pieces of the lobe's curve.
const CURVE: u32 = 150;

/// How many facets are drawn for each point of the error plot.
const COUNTS: [u32; 4] = [100, 1_000, 10_000, 100_000];
/// How many facets are drawn for the histogram.
const MANY: u32 = 1_000_000;

/// The slope of a straight line through the points, both axes logarithmic.
fn slope(points: &[(u32, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> =
        points.iter().map(|&(x, y)| (wide::ln(f64::from(x)), wide::ln(y))).collect();
    let count = logs.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| logs.iter().map(f).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let over: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    over / logs.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>()
}

fn drawing(experiment: &Experiment, many: &Tally, errors: &[(u32, f64)]) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    afar(&mut drawing, Point::new(236.0, 262.0), 150.0, experiment.theta());
    mirrors(&mut drawing, Point::new(40.0, 448.0), 400.0, experiment.theta());
    histogram(&mut drawing, experiment, many);
    convergence(&mut drawing, errors);
    drawing
}

/// A cut through a surface of tiny mirrors, and what each does with the same light.
fn mirrors(drawing: &mut Drawing, left: Point, width: f64, theta: f64) {
    let count = 16;
    let step = width / f64::from(count);
    let mut profile = vec![left];
    for facet in 0..count {
        let Some(&from) = profile.last() else { break };
        profile.push(from + Point::new(step, -step * facet_slope(facet)));
    }
    // Level the ends, so that the surface is flat as a whole.
    let tilt = (profile[profile.len() - 1].y - left.y) / f64::from(count);
    for (index, p) in profile.iter_mut().enumerate() {
        p.y -= tilt * index as f64;
    }
    let bottom = left.y + 40.0;
    let mut body = profile.clone();
    body.extend([Point::new(left.x + width, bottom), Point::new(left.x, bottom)]);
    drawing.fill(Path::polygon(body), style::BODY);
    let l = unit(90.0 + theta);
    // A ray that a neighbour stops is none of the lobe's: its facet is passed over.
    let free = |from: Point, to: Point| {
        profile.windows(2).all(|facet| !crosses([from, to], [facet[0], facet[1]]))
    };
    let mut wait = 1;
    for facet in profile.windows(2) {
        if wait > 0 {
            wait -= 1;
            continue;
        }
        let along = (facet[1] - facet[0]).normalize_or_zero();
        let Some(m) = Dir3::new(glam::Vec3::new(along.y as f32, along.x as f32, 0.0)) else {
            continue;
        };
        let middle = 0.5 * (facet[0] + facet[1]);
        let (towards, out) = (drawn(l.to_vec()), drawn(m.mirror(l).to_vec()));
        let ends = [62.0 * towards, 74.0 * out].map(|end| middle + end);
        // From just above the facet itself.
        let starts = [0.5 * towards, 0.5 * out].map(|start| middle + start);
        if out.y > -0.08 || !free(starts[0], ends[0]) || !free(starts[1], ends[1]) {
            continue;
        }
        drawing.arrow(ends[0], middle, style::LIGHT.fade(0.8), 1.3);
        drawing.arrow(middle, ends[1], style::MIRROR, 1.6);
        wait = 1;
    }
    drawing.stroke(Path::polyline(profile), Stroke::new(style::SURFACE, 2.4));
    let under = left + Point::new(0.5 * width, 68.0);
    drawing.note(under, "close up: tiny mirrors, their slopes drawn from *D*");
}

/// Whether two straight lines between points cross.
fn crosses([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let side = |p: Point, q: Point, r: Point| (q - p).perp_dot(r - p);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// The same surface from afar, with the lobe of its reflections.
fn afar(drawing: &mut Drawing, o: Point, length: f64, theta: f64) {
    surface(drawing, o, 180.0);
    let peak = (0..=180).map(|psi| lobe(theta, f64::from(psi) - 90.0)).fold(0.0, f64::max);
    let tip = |psi: f64| o + 1.1 * length * lobe(theta, psi) / peak * heading(90.0 - psi);
    let petal = Path::polygon((0..=720).map(|step| tip(0.25 * f64::from(step) - 90.0)));
    let edge = Some(Stroke::new(style::NORMAL, style::CURVE));
    drawing.shape(petal, Some(style::NORMAL.fade(0.15)), edge);
    let place = |degrees: f64| o + length * heading(degrees);
    drawing.vector(o, place(90.0), style::NORMAL, "*n*");
    drawing.vector(o, place(90.0 + theta), style::LIGHT, "*l*");
    let r = place(90.0 - theta);
    drawing.line(o, r + 0.25 * (r - o), Stroke::new(style::MIRROR, 2.0).dashed());
    drawing.label(r + 0.35 * (r - o), style::LETTER, style::MIRROR, "*r*");
    drawing.note(o + Point::new(0.0, 46.0), "from afar: a surface with a lobe");
}

/// What the facets reflect, by the angle from the mirror direction.
fn histogram(drawing: &mut Drawing, experiment: &Experiment, many: &Tally) {
    let corners = [Point::new(544.0, 100.0), Point::new(916.0, 262.0)];
    let peak = experiment.lobe.iter().copied().fold(0.0, f64::max);
    let top = 1.15 * peak;
    let plot = Plot { corners, x: RANGE, y: [0.0, top] };
    let step = [0.05, 0.1, 0.2, 0.5, 1.0].into_iter().find(|step| top / step < 4.0).unwrap_or(2.0);
    let values: Vec<f64> = (0..=(top / step) as u32)
        .map(|tick| (100.0 * step * f64::from(tick)).round() / 100.0)
        .collect();
    let degrees = ticks(&[-30.0, 0.0, 30.0, 60.0, 90.0, 120.0], "°");
    plot.axes(drawing, &degrees, &ticks(&values, ""));
    plot.names(drawing, "direction, from the normal", "per steradian", 44.0);
    let horizon = Stroke::new(style::SURFACE, style::THIN).dashed();
    drawing.line(plot.at(90.0, 0.0), plot.at(90.0, top), horizon);
    let beside = plot.at(92.0, 0.92 * top);
    drawing.text(beside, Anchor::Start, style::TICK, style::MUTED, "horizon");
    let psi = |band: f64| RANGE[0] + (RANGE[1] - RANGE[0]) * band / BANDS as f64;
    for (band, value) in many.weighted.iter().enumerate() {
        let band = band as f64;
        let bar = [(0.08, 0.0), (0.08, *value), (0.92, *value), (0.92, 0.0)];
        let bar = bar.map(|(x, y)| plot.at(psi(band + x), y.min(top)));
        drawing.fill(Path::polygon(bar), style::MIRROR.fade(0.35));
    }
    // Counts are steps, a band each; the lobe is a curve.
    let steps =
        many.plain.iter().enumerate().flat_map(|(band, &y)| {
            [0.0, 1.0].map(|side| plot.at(psi(band as f64 + side), y.min(top)))
        });
    drawing.stroke(Path::polyline(steps), Stroke::new(style::MUTED, style::LINE));
    let curve = Stroke::new(style::NORMAL, style::CURVE);
    plot.curve(drawing, RANGE, 300, |psi| experiment.smooth(psi).min(top), curve);
    let words = [
        (style::NORMAL, "*D*(*h*) / (4 *n*·*l*)"),
        (style::MIRROR, "facets, by the light"),
        (style::MIRROR, "that they catch"),
        (style::MUTED, "facets, counted alike"),
    ];
    for (row, (ink, words)) in words.into_iter().enumerate() {
        let at = Point::new(556.0, 116.0 + 20.0 * row as f64);
        drawing.text(at, Anchor::Start, style::TICK, ink, words);
    }
}

/// The error against the count, both logarithmic, and the line of 1/√count.
fn convergence(drawing: &mut Drawing, errors: &[(u32, f64)]) {
    let log = |value: f64| wide::ln(value) / wide::ln(10.0);
    let corners = [Point::new(576.0, 346.0), Point::new(916.0, 474.0)];
    let plot = Plot { corners, x: [1.7, 5.3], y: [-3.0, 0.0] };
    let power = |exponent: f64| format!("10^{{{}}}", fixed(exponent, 0));
    let marks = |exponents: &[f64]| -> Vec<(f64, String)> {
        exponents.iter().map(|&exponent| (exponent, power(exponent))).collect()
    };
    plot.axes(drawing, &marks(&[2.0, 3.0, 4.0, 5.0]), &marks(&[-3.0, -2.0, -1.0, 0.0]));
    plot.names(drawing, "facets", "error", 52.0);
    if let Some(&(count, error)) = errors.first() {
        let start = log(error) + 0.5 * log(f64::from(count));
        let line = Stroke::new(style::NORMAL, style::CURVE);
        plot.curve(drawing, [1.9, 5.2], 1, |x| start - 0.5 * x, line);
        let at = plot.at(3.8, start - 0.5 * 3.4);
        drawing.text(at, Anchor::Start, style::NOTE, style::NORMAL, "1/√count");
    }
    for &(count, error) in errors {
        plot.dot(drawing, log(f64::from(count)), log(error), style::MIRROR);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_facets_come_nearer_to_the_lobe() {
        let errors = [1, 100, 10_000, 1_000_000].map(|count| facets(THETA, count).error);
        assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
        let facets = facets(40.0, 1);
        assert_eq!(facets.counted.iter().filter(|&&value| value > 0.0).count(), 1);
        assert_eq!((facets.counted.len(), facets.lobe.len()), (BANDS, 151));
    }

    #[test]
    fn weighted_facets_converge_to_the_lobe_as_one_over_root_n_and_plain_ones_do_not() {
        let [first, .., last, slope, weighted, plain] = draw(Setting::DRAFT).values::<7>();
        assert!(last < 0.05 * first, "{first} {last}");
        assert!((slope + 0.5).abs() < 0.05, "{slope}");
        assert!(weighted < 0.01, "{weighted}");
        assert!(plain > 10.0 * weighted, "{plain} {weighted}");
    }
}
