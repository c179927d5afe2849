//! What the speed hack saved: operations that each highlight takes, counted from its formula.

use super::drawing::Drawing;
use super::mark::{Anchor, Ink, Path, Point};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "What the speed hack saved";
const EQUATION: &str = "operations for each pixel and light, up to the cosine";

/// A way to the cosine, with what it takes.
struct Way {
    name: &'static str,
    steps: &'static [(&'static str, Count)],
}

/// Operations on single numbers.
#[derive(Clone, Copy, Default)]
struct Count {
    products: u32,
    sums: u32,
    /// Square roots and divisions.
    slow: u32,
}

const fn count(products: u32, sums: u32, slow: u32) -> Count {
    Count { products, sums, slow }
}

/// The diffuse term needs l·n anyway, so it is not counted.
const WAYS: [Way; 3] = [
    Way {
        name: "Phong: *r*·*e*",
        steps: &[("*r* = 2(*l*·*n*)*n* − *l*", count(4, 3, 0)), ("*r*·*e*", count(3, 2, 0))],
    },
    Way {
        name: "Blinn: *n*·*h*, *h* for each pixel",
        steps: &[
            ("*l* + *e*", count(0, 3, 0)),
            ("divided by its length", count(3, 2, 4)),
            ("*n*·*h*", count(3, 2, 0)),
        ],
    },
    Way {
        name: "Blinn: *n*·*h*, light and eye far away",
        steps: &[("*h* once for the picture", count(0, 0, 0)), ("*n*·*h*", count(3, 2, 0))],
    },
];

impl Way {
    fn total(&self) -> Count {
        self.steps.iter().fold(Count::default(), |sum, (_, step)| {
            count(sum.products + step.products, sum.sums + step.sums, sum.slow + step.slow)
        })
    }
}

pub(super) fn draw(_: Setting) -> Plate {
    let mut numbers = Vec::new();
    for (way, name) in WAYS.iter().zip(["Phong", "Blinn, h a pixel", "Blinn, h once"]) {
        let Count { products, sums, slow } = way.total();
        numbers.push(Number::new(format!("{name}: multiplications"), f64::from(products), ""));
        numbers.push(Number::new(format!("{name}: additions"), f64::from(sums), ""));
        numbers.push(Number::new(format!("{name}: roots and divisions"), f64::from(slow), ""));
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "With light and eye far away, the halfway vector is the same for the whole picture, \
                  and a highlight costs one dot product; near ones need a square root for each pixel, \
                  and then Blinn’s vector saves nothing.",
        drawing: drawing(),
        numbers,
    }
}

fn drawing() -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let (left, unit) = (344.0, 32.0);
    for (row, way) in WAYS.iter().enumerate() {
        let top = 112.0 + 132.0 * row as f64;
        let at = |dy: f64| Point::new(44.0, top + dy);
        drawing.text(at(16.0), Anchor::Start, style::HEADING, style::TEXT, way.name);
        for (line, (step, _)) in way.steps.iter().enumerate() {
            let below = at(42.0 + 22.0 * line as f64);
            drawing.text(below, Anchor::Start, style::NOTE, style::MUTED, step);
        }
        let Count { products, sums, slow } = way.total();
        let kinds = [(products, style::NORMAL), (sums, style::EYE), (slow, style::MIRROR)];
        let mut x = left;
        for (number, ink) in kinds {
            for _ in 0..number {
                tile(&mut drawing, Point::new(x, top + 22.0), unit - 5.0, ink);
                x += unit;
            }
        }
        let words = format!("{}", products + sums + slow);
        let beyond = Point::new(x + 10.0, top + 43.0);
        drawing.text(beyond, Anchor::Start, style::HEADING, style::TEXT, &words);
    }
    let legend = [
        (style::NORMAL, "multiplication"),
        (style::EYE, "addition"),
        (style::MIRROR, "square root or division"),
    ];
    for (column, (ink, words)) in legend.into_iter().enumerate() {
        let at = Point::new(348.0 + 176.0 * column as f64, 500.0);
        tile(&mut drawing, at - Point::new(0.0, 13.0), 15.0, ink);
        let beside = at + Point::new(24.0, 0.0);
        drawing.text(beside, Anchor::Start, style::NOTE, style::TEXT, words);
    }
    drawing
}

/// One operation.
fn tile(drawing: &mut Drawing, at: Point, side: f64, ink: Ink) {
    let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
    drawing.fill(Path::polygon(corners.map(|(x, y)| at + Point::new(x, y))), ink.fade(0.8));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_halfway_vector_that_stays_saves_anything() {
        let values: [f64; 9] = draw(Setting::DRAFT).values();
        let total = |way: usize| values[3 * way..3 * way + 3].iter().sum::<f64>();
        assert_eq!([total(0), total(1), total(2)], [12.0, 17.0, 5.0]);
    }
}
