//! The lecture's figures: each drawn from the renderer's own functions, with the numbers it shows.
//!
//! A figure is a function of its finish alone: it renders, measures and draws the same bytes every
//! time, on any number of threads.
//! [`CATALOGUE`] lists them in the lecture's order.
//!
//! ```
//! use phong_lab::figures::Finish;
//! let figure = phong_lab::figures::find("shininess").unwrap().draw(Finish::Draft);
//! assert!(figure.svg().starts_with("<svg"));
//! let half_width = figure.number("half width, i = 2").unwrap();
//! assert!((half_width - 45.0).abs() < 1e-3);
//! ```

mod ambient;
mod blinn;
mod cosine;
mod diffuse;
mod drawing;
mod examples;
mod grid;
mod halfway;
mod index;
mod mark;
mod microfacets;
mod normal;
mod plot;
mod raster;
mod reflection;
mod shininess;
mod specular;
mod stage;
mod style;
mod svg;
mod symbols;
mod terms;
mod text;
mod vectors;

use drawing::Drawing;
pub use index::page;

/// A figure that can be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// What it is asked for by: one lower-case word.
    pub name: &'static str,
    /// What it shows, in a line.
    pub line: &'static str,
    draw: fn(Finish) -> Plate,
}

/// All figures, in the lecture's order.
pub const CATALOGUE: [Entry; 14] = [
    Entry { name: "normal", line: "the normal of a sphere, n = p − c", draw: normal::draw },
    Entry {
        name: "vectors",
        line: "to the eye, and to distant and point lights",
        draw: vectors::draw,
    },
    Entry { name: "ambient", line: "the ambient term: flat", draw: ambient::draw },
    Entry {
        name: "diffuse",
        line: "the diffuse term: from light to dark, wherever the eye is",
        draw: diffuse::draw,
    },
    Entry {
        name: "cosine",
        line: "Lambert’s law: why the diffuse term is a cosine",
        draw: cosine::draw,
    },
    Entry {
        name: "specular",
        line: "the specular term: a highlight that moves with the eye",
        draw: specular::draw,
    },
    Entry {
        name: "reflection",
        line: "the reflected vector, constructed, and the trap of its sign",
        draw: reflection::draw,
    },
    Entry { name: "shininess", line: "cos(x)^i for i = 1, 2, 4, 8, 16, 32", draw: shininess::draw },
    Entry { name: "grid", line: "specular coefficient against shininess", draw: grid::draw },
    Entry { name: "halfway", line: "the halfway vector, and β against φ", draw: halfway::draw },
    Entry {
        name: "blinn",
        line: "Phong and Blinn–Phong, in and across the plane of incidence",
        draw: blinn::draw,
    },
    Entry { name: "terms", line: "ambient + diffuse + specular = Phong", draw: terms::draw },
    Entry { name: "examples", line: "the model at work: four scenes", draw: examples::draw },
    Entry {
        name: "microfacets",
        line: "tiny mirrors, and the lobe they add up to",
        draw: microfacets::draw,
    },
];

/// The figure of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    CATALOGUE.iter().find(|entry| entry.name == name)
}

impl Entry {
    /// Renders, measures and draws, in the current rayon pool.
    pub fn draw(&self, finish: Finish) -> Figure {
        Figure { name: self.name, plate: (self.draw)(finish) }
    }
}

/// How much work goes into the rendered parts. The numbers are the same for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// One sample for every unit of the canvas: for a glance, and for tests.
    Draft,
    /// 16 samples for every pixel of the PNG, four pixels for every square unit.
    Slide,
}

/// A figure, drawn.
#[derive(Clone, Debug)]
pub struct Figure {
    /// What it is asked for by.
    pub name: &'static str,
    plate: Plate,
}

/// What a figure's own file makes.
#[derive(Clone, Debug)]
struct Plate {
    title: &'static str,
    /// Markup, as in [`text::runs`].
    equation: &'static str,
    caption: &'static str,
    numbers: Vec<Number>,
    drawing: Drawing,
}

#[cfg(test)]
impl Plate {
    /// The values of its numbers, of which there are `N`.
    fn values<const N: usize>(&self) -> [f64; N] {
        assert_eq!(self.numbers.len(), N, "{:?}", self.numbers);
        std::array::from_fn(|i| self.numbers[i].value)
    }
}

/// A number that a figure shows, computed by the functions that render.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// What it is a number of, unique within its figure.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
}

impl Number {
    fn new(name: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self { name: name.into(), value, unit }
    }
}

impl Figure {
    /// A few words.
    pub fn title(&self) -> &'static str {
        self.plate.title
    }

    /// What it shows, in one sentence.
    pub fn caption(&self) -> &'static str {
        self.plate.caption
    }

    /// The numbers it shows.
    pub fn numbers(&self) -> &[Number] {
        &self.plate.numbers
    }

    /// The number of that name.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.plate.numbers.iter().find(|number| number.name == name).map(|number| number.value)
    }

    /// As an SVG file, its fonts and pictures inside.
    pub fn svg(&self) -> String {
        svg::document(&self.plate.drawing, self.plate.title, self.plate.caption)
    }

    /// As a PNG file, two pixels a unit: 1920 wide.
    pub fn png(&self) -> Vec<u8> {
        raster::png(&self.plate.drawing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mark::Mark;

    #[test]
    fn every_figure_is_found_by_a_name_of_its_own() {
        for (i, entry) in CATALOGUE.iter().enumerate() {
            let first = CATALOGUE.iter().position(|other| other.name == entry.name);
            assert_eq!(first, Some(i));
            assert_eq!(find(entry.name).map(|found| found.line), Some(entry.line));
        }
        assert!(find("none").is_none());
    }

    #[test]
    fn every_figure_stays_on_its_canvas_and_can_be_lettered_and_is_the_same_each_time() {
        let faces = text::Faces::new();
        for entry in CATALOGUE {
            let figure = entry.draw(Finish::Draft);
            for mark in &figure.plate.drawing.marks {
                let Mark::Text(line) = mark else { continue };
                assert!(faces.cover(&line.runs, line.bold), "{}: {line:?}", entry.name);
                let [left, right] = faces.extent(line);
                let within = left >= 8.0 && right <= figure.plate.drawing.size.x - 8.0;
                assert!(within || line.upright, "{}: {line:?} at {left}..{right}", entry.name);
            }
            let names = figure.numbers().iter().map(|number| &number.name);
            assert!(names.clone().all(|name| names.clone().filter(|n| *n == name).count() == 1));
            assert!(figure.numbers().iter().all(|number| number.value.is_finite()));
            assert_eq!(entry.draw(Finish::Draft).svg(), figure.svg(), "{}", entry.name);
        }
    }

    #[test]
    fn a_page_holds_every_figure_and_asks_nothing_of_the_network() {
        let figures = ["cosine", "shininess"].map(|name| find(name).unwrap().draw(Finish::Draft));
        let page = page(&figures);
        assert_eq!(page.matches("<svg").count(), 2);
        assert_eq!(page.matches("@font-face").count(), 3);
        assert!(page.contains("<th>half width, i = 8</th><td>23.508°</td>"));
        let addresses = page.matches("http").count();
        assert_eq!(addresses, page.matches("http://www.w3.org/2000/svg").count());
    }

    #[test]
    fn a_png_is_two_pixels_a_unit() {
        let png = find("cosine").unwrap().draw(Finish::Draft).png();
        let decoder = png::Decoder::new(std::io::Cursor::new(png));
        let reader = decoder.read_info().unwrap();
        assert_eq!([reader.info().width, reader.info().height], [1920, 1080]);
    }
}
