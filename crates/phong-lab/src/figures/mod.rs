//! The lecture's figures: each drawn from the renderer's own functions, with the numbers it shows.
//!
//! A figure is a function of its setting alone: it renders, measures and draws the same bytes every
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
mod peak;
mod plot;
mod raster;
mod reflection;
mod scattering;
mod shading;
mod shininess;
mod sky;
mod specular;
mod speed;
mod stage;
mod style;
mod svg;
mod symbols;
mod terms;
mod text;
mod vectors;

use drawing::Drawing;
use phong_scene::Rgb;

pub use index::page;
pub use microfacets::{Facets, facets};
pub(crate) use raster::{Lettering, lettering};
pub use shininess::{Falloff, cosine_power};

/// A figure that can be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// What it is asked for by: one lower-case word.
    pub name: &'static str,
    /// What it shows, in a line.
    pub line: &'static str,
    /// What can be set of it, beside dark paper, which all can have.
    pub takes: &'static [Parameter],
    draw: fn(Setting) -> Plate,
}

/// All figures, in the lecture's order.
pub const CATALOGUE: [Entry; 19] = [
    entry("normal", "the normal of a sphere, n = p − c", &[Parameter::Color], normal::draw),
    entry("vectors", "to the eye, and to distant and point lights", &[], vectors::draw),
    entry("shading", "the three vectors at a point of a ball: n, l and e", &[], shading::draw),
    entry("ambient", "the ambient term: flat", &[Parameter::Color], ambient::draw),
    entry(
        "diffuse",
        "the diffuse term: from light to dark, wherever the eye is",
        &[Parameter::Color],
        diffuse::draw,
    ),
    entry(
        "scattering",
        "rough surfaces scatter equally, smooth ones mirror",
        &[Parameter::Theta],
        scattering::draw,
    ),
    entry(
        "cosine",
        "Lambert’s law: why the diffuse term is a cosine",
        &[Parameter::Theta],
        cosine::draw,
    ),
    entry(
        "specular",
        "the specular term: a highlight that moves with the eye",
        &[Parameter::Alpha, Parameter::Color],
        specular::draw,
    ),
    entry(
        "reflection",
        "the reflected vector, constructed, and the trap of its sign",
        &[Parameter::Theta],
        reflection::draw,
    ),
    entry("shininess", "cos(x)^i for i = 1, 2, 4, 8, 16, 32", &[], shininess::draw),
    entry("grid", "specular coefficient against shininess", &[Parameter::Color], grid::draw),
    entry("halfway", "the halfway vector, and β against φ", &[Parameter::Theta], halfway::draw),
    entry("peak", "why n = h is brightest", &[Parameter::Theta, Parameter::Alpha], peak::draw),
    entry("speed", "what the speed hack saved", &[], speed::draw),
    entry(
        "blinn",
        "Phong and Blinn–Phong, in and across the plane of incidence",
        &[Parameter::Theta, Parameter::Alpha, Parameter::Color],
        blinn::draw,
    ),
    entry(
        "terms",
        "ambient + diffuse + specular = Phong",
        &[Parameter::Alpha, Parameter::Color],
        terms::draw,
    ),
    entry("examples", "the model at work: four scenes", &[], examples::draw),
    entry(
        "sky",
        "what the ambient constant stands for: light that is met, of a sky",
        &[],
        sky::draw,
    ),
    entry(
        "microfacets",
        "tiny mirrors, and the lobe they add up to",
        &[Parameter::Theta],
        microfacets::draw,
    ),
];

const fn entry(
    name: &'static str,
    line: &'static str,
    takes: &'static [Parameter],
    draw: fn(Setting) -> Plate,
) -> Entry {
    Entry { name, line, takes, draw }
}

/// What can be set of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// The angle of incidence.
    Theta,
    /// The shininess.
    Alpha,
    /// The colour of the ball.
    Color,
}

/// The figure of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    CATALOGUE.iter().find(|entry| entry.name == name)
}

impl Entry {
    /// Renders, measures and draws, in the current rayon pool. What the figure does not take of the
    /// setting is as if it were not set.
    pub fn draw(&self, setting: impl Into<Setting>) -> Figure {
        let setting = setting.into();
        let takes = |parameter| self.takes.contains(&parameter);
        let mut plate = (self.draw)(Setting {
            theta: setting.theta.filter(|_| takes(Parameter::Theta)),
            alpha: setting.alpha.filter(|_| takes(Parameter::Alpha)),
            color: setting.color.filter(|_| takes(Parameter::Color)),
            ..setting
        });
        if setting.dark {
            plate.drawing = plate.drawing.on_dark();
        }
        Figure { name: self.name, dark: setting.dark, plate }
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

/// How a figure is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// How much work goes into the rendered parts.
    pub finish: Finish,
    /// The angle of incidence, degrees in [5, 80]; `None`: the figure's own.
    pub theta: Option<f64>,
    /// The shininess, in [1, 1000]; `None`: the figure's own.
    pub alpha: Option<f64>,
    /// The colour of the ball, linear, not black; `None`: blue.
    pub color: Option<Rgb>,
    /// Whether the paper is dark.
    pub dark: bool,
}

impl From<Finish> for Setting {
    fn from(finish: Finish) -> Self {
        Self { finish, theta: None, alpha: None, color: None, dark: false }
    }
}

impl Setting {
    /// What the figures' own tests draw.
    #[cfg(test)]
    const DRAFT: Self =
        Self { finish: Finish::Draft, theta: None, alpha: None, color: None, dark: false };

    fn theta_or(self, own: f64) -> f64 {
        self.theta.unwrap_or(own)
    }

    fn alpha_or(self, own: f64) -> f64 {
        self.alpha.unwrap_or(own)
    }
}

/// A figure, drawn.
#[derive(Clone, Debug)]
pub struct Figure {
    /// What it is asked for by.
    pub name: &'static str,
    dark: bool,
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
    use std::sync::OnceLock;

    /// Every figure as it is drawn without any setting, in the catalogue's order; drawn once for all tests.
    fn drafts() -> impl Iterator<Item = (&'static Entry, &'static Figure)> {
        static DRAFTS: OnceLock<Vec<Figure>> = OnceLock::new();
        let draw = || CATALOGUE.iter().map(|entry| entry.draw(Finish::Draft)).collect();
        CATALOGUE.iter().zip(DRAFTS.get_or_init(draw))
    }

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
    fn every_figure_stays_on_its_canvas_and_can_be_lettered() {
        let faces = text::Faces::new();
        for (entry, figure) in drafts() {
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
    fn a_figure_takes_what_it_says_and_is_else_the_same_each_time() {
        let set = Setting {
            theta: Some(35.0),
            alpha: Some(50.0),
            color: Some(Rgb::new(0.8, 0.2, 0.1)),
            ..Setting::DRAFT
        };
        for (entry, figure) in drafts() {
            let differs = entry.draw(set).svg() != figure.svg();
            assert_eq!(differs, !entry.takes.is_empty(), "{}", entry.name);
        }
    }

    #[test]
    fn dark_paper_is_dark_and_has_the_same_numbers() {
        let entry = find("cosine").unwrap();
        let dark = entry.draw(Setting { dark: true, ..Setting::DRAFT });
        assert!(dark.svg().contains("#15181c") && !dark.svg().contains("fill=\"#ffffff\""));
        assert_eq!(dark.numbers(), entry.draw(Finish::Draft).numbers());
    }

    #[test]
    fn a_png_is_two_pixels_a_unit() {
        let png = find("cosine").unwrap().draw(Finish::Draft).png();
        let decoder = png::Decoder::new(std::io::Cursor::new(png));
        let reader = decoder.read_info().unwrap();
        assert_eq!([reader.info().width, reader.info().height], [1920, 1080]);
    }
}
