//! The studio's engine: one scene, one picture, and whoever looks at it.
//!
//! It does what it is told at once, all but drawing: that is done in portions by
//! [`Engine::advance`], so that whoever runs it may hear the next request in between. A request that
//! changes the picture takes the place of the one under way.

mod exporting;
mod hands;
mod lines;
mod look;
mod opened;
mod painting;
mod sharing;

use phong::render::Cancel;
use phong::scene::{Limits, Source, schema_json};
use phong_lab::figures::{self, Facets};
use serde_json::Value;

use crate::protocol::{MOST_EXPLAINED, MOST_FACETS, Message, PixelKind, Reply, Request, VERSION};
use opened::Opened;
use painting::Painting;

/// A scene to begin with.
pub const EXAMPLE: &str = include_str!("two-balls.toml");

/// The name of [`EXAMPLE`].
pub const EXAMPLE_NAME: &str = "two-balls.toml";

/// What an engine may use.
#[derive(Clone, Debug)]
pub struct Bounds {
    /// What readers may use.
    pub limits: Limits,
    /// Bytes that the geometry may take, and the picture as well.
    pub bytes: u64,
}

impl Bounds {
    /// The most bytes of a scene's text.
    pub const TEXT: u64 = 4 << 20;
}

impl Default for Bounds {
    /// A gibibyte for the scene, and one for the picture.
    fn default() -> Self {
        let bytes = 1 << 30;
        Self { limits: Limits { bytes, text_bytes: Self::TEXT, ..Limits::default() }, bytes }
    }
}

/// Takes what the engine says; false: it should stop after this tile, and be asked to go on later.
pub type Emit<'a> = &'a (dyn Fn(Message) -> bool + Sync);

/// One scene, one picture.
#[derive(Debug)]
pub struct Engine {
    source: Box<dyn Source>,
    bounds: Bounds,
    /// Which share of each picture is drawn, of how many; `None`: all of it.
    share: Option<(u32, u32)>,
    opened: Option<Opened>,
    pixels: PixelKind,
    /// The number of the newest picture.
    picture: u32,
    painting: Option<Painting>,
    /// Whether drawing was stopped by request.
    stopped: bool,
}

impl Engine {
    /// An engine that has opened nothing yet.
    pub fn new(source: impl Source + 'static, bounds: Bounds) -> Self {
        let source = Box::new(source);
        Self {
            source,
            bounds,
            share: None,
            opened: None,
            pixels: PixelKind::default(),
            picture: 0,
            painting: None,
            stopped: false,
        }
    }

    /// The same, which draws share `index` of `count` of every picture; they count from 0. The first
    /// draws the first pass alone, and all of it.
    #[must_use]
    pub fn with_share(self, index: u32, count: u32) -> Self {
        Self { share: (index < count && count > 1).then_some((index, count)), ..self }
    }

    /// The first message to a page: what there is to open.
    pub fn hello(open: &str, files: Vec<String>) -> Message {
        let version = env!("CARGO_PKG_VERSION").to_owned();
        (&Reply::Hello { protocol: VERSION, version, open: open.to_owned(), files }).into()
    }

    /// Does what a message asks for. What is no request is answered with an error.
    pub fn receive(&mut self, text: &str, emit: Emit<'_>) {
        match serde_json::from_str(text) {
            Ok(request) => self.answer(request, emit),
            Err(error) => self.refuse(&error.to_string(), emit),
        }
    }

    /// Answers what is no request, and why it is none.
    pub fn refuse(&self, why: &str, emit: Emit<'_>) {
        say(emit, &error_reply(format!("this is no request: {why}")));
    }

    /// Does what is asked for, and says what comes of it.
    pub fn answer(&mut self, request: Request, emit: Emit<'_>) {
        let done = match request {
            Request::Open { path } => self.open(&path, emit),
            Request::Edit { text } => self.edit(text, emit),
            Request::Look { set } => self.changed(emit, |opened| opened.lay(set)),
            Request::Reset => self.changed(emit, Opened::reset),
            Request::Turn { by } => self.changed(emit, |opened| opened.turn(by)),
            Request::Move { by } => self.changed(emit, |opened| opened.shift(by)),
            Request::Zoom { by } => self.changed(emit, |opened| opened.zoom(by)),
            Request::Pixels { kind } => {
                self.pixels = kind;
                Ok(())
            }
            Request::Explain { id, pixel, samples } => self.explain(id, pixel, samples, emit),
            Request::Cancel => {
                self.stopped = true;
                Ok(())
            }
            Request::Resume => {
                self.stopped = false;
                Ok(())
            }
            Request::Export { format } => self.export(format, emit),
            Request::Keys => {
                let schema = serde_json::from_str(&schema_json()).unwrap_or(Value::Null);
                say(emit, &Reply::Keys { schema });
                Ok(())
            }
            Request::Facets { id, theta, count } => facets(id, theta, count, emit),
        };
        if let Err(message) = done {
            say(emit, &error_reply(message));
        }
    }

    /// Whether there is something to draw.
    pub fn has_work(&self) -> bool {
        !self.stopped && self.painting.as_ref().is_some_and(|painting| !painting.is_done())
    }

    /// Draws until `cancel` is used, `emit` wants to stop, or nothing is left to do. What is drawn
    /// stays, and is gone on with the next time.
    pub fn advance(&mut self, cancel: &Cancel, emit: Emit<'_>) {
        if self.has_work()
            && let Some(painting) = &mut self.painting
            && let Err(message) = painting.advance(self.pixels, cancel, emit)
        {
            self.painting = None;
            say(emit, &error_reply(message));
        }
    }

    /// Says that a request or a picture came to a bad end that nobody foresaw, and forgets the picture.
    pub fn broken(&mut self, emit: Emit<'_>) {
        self.painting = None;
        let message = "the studio failed at this: please report it, with the scene".to_owned();
        say(emit, &error_reply(message));
    }

    /// Its share of the picture as a part file; `None` as long as that is not finished.
    #[must_use]
    pub fn part(&self) -> Option<Vec<u8>> {
        sharing::part(self.opened.as_ref()?, self.painting.as_ref()?)
    }

    /// Takes the share that another engine's [`part`](Self::part) is.
    pub fn join(&mut self, part: &[u8], emit: Emit<'_>) {
        if let (Some(opened), Some(painting)) = (&self.opened, &mut self.painting)
            && let Err(message) = sharing::join(part, opened, painting, self.bounds.bytes)
        {
            say(emit, &error_reply(message));
        }
    }

    fn open(&mut self, path: &str, emit: Emit<'_>) -> Result<(), String> {
        let (opened, text) = Opened::of_file(path, &*self.source, &self.bounds)?;
        say(emit, &Reply::Scene { path: path.to_owned(), text });
        self.painting = None;
        self.opened = Some(opened);
        self.begin(emit)
    }

    fn edit(&mut self, text: String, emit: Emit<'_>) -> Result<(), String> {
        if text.len() as u64 > Bounds::TEXT {
            return Err(format!("a text of more than {} bytes", Bounds::TEXT));
        }
        let opened = self.opened.as_mut().ok_or("nothing is open")?;
        opened.edit(text, &*self.source, &self.bounds)?;
        self.begin(emit)
    }

    /// Changes what is laid over the scene, and draws that; where it cannot be, all is as it was.
    fn changed(
        &mut self,
        emit: Emit<'_>,
        change: impl FnOnce(&mut Opened) -> Result<(), String>,
    ) -> Result<(), String> {
        let opened = self.opened.as_mut().ok_or("nothing is open")?;
        let before = opened.set().clone();
        change(opened)?;
        let painted = self.paint(emit);
        if let (Err(_), Some(opened)) = (&painted, &mut self.opened) {
            opened.put_back(before);
        }
        painted
    }

    /// Says what was read, and begins the picture of it if there is one.
    fn begin(&mut self, emit: Emit<'_>) -> Result<(), String> {
        let opened = self.opened.as_ref().ok_or("nothing is open")?;
        let (ok, diagnostics) = opened.diagnostics();
        say(emit, &Reply::Checked { ok, diagnostics });
        if ok { self.paint(emit) } else { Ok(()) }
    }

    /// Begins the picture of what is open now.
    fn paint(&mut self, emit: Emit<'_>) -> Result<(), String> {
        let opened = self.opened.as_ref().ok_or("nothing is open")?;
        let shown = opened.shown()?;
        let picture = self.picture.wrapping_add(1);
        let (bytes, share) = (self.bounds.bytes, self.share);
        let painting = Painting::new(picture, shown.view, &shown.image, bytes, share)?;
        self.picture = picture;
        self.stopped = false;
        self.painting = Some(painting);
        say(
            emit,
            &Reply::Look {
                picture,
                size: shown.image.size,
                samples: shown.image.samples,
                values: shown.values,
                wells: shown.wells,
                set: opened.set().clone(),
                command: opened.command(),
            },
        );
        Ok(())
    }

    fn explain(
        &self,
        id: u64,
        pixel: [u32; 2],
        samples: u32,
        emit: Emit<'_>,
    ) -> Result<(), String> {
        let painting = self.painting.as_ref().ok_or("there is no picture")?;
        if !(1..=MOST_EXPLAINED).contains(&samples) {
            return Err(format!("{samples} samples: 1 to {MOST_EXPLAINED} are told"));
        }
        let options = painting.options().clone().with_samples(samples);
        let options = options.map_err(|error| error.to_string())?;
        let told = phong::explain::explain(painting.view(), &options, pixel);
        let told = told.map_err(|outside| outside.to_string())?;
        let lines = lines::of(&told, painting.view());
        let told = phong_lab::tell::json(&told);
        say(emit, &Reply::Explanation { id, picture: painting.number(), told, lines });
        Ok(())
    }

    fn export(&self, format: crate::protocol::FileKind, emit: Emit<'_>) -> Result<(), String> {
        let opened = self.opened.as_ref().ok_or("nothing is open")?;
        let file = exporting::file(format, opened, self.painting.as_ref())?;
        say(emit, &Reply::File { name: file.name, bytes: file.bytes.len() });
        emit(Message::Frame(crate::protocol::file_frame(&file.bytes)));
        Ok(())
    }
}

/// Draws tiny mirrors, and says what they send out.
fn facets(id: u64, theta: f64, count: u32, emit: Emit<'_>) -> Result<(), String> {
    if !(1..=MOST_FACETS).contains(&count) || !(5.0..=80.0).contains(&theta) {
        return Err(format!("1 to {MOST_FACETS} facets are drawn, under 5 to 80 degrees"));
    }
    let Facets { range, counted, alike, lobe, error } = figures::facets(theta, count);
    say(emit, &Reply::Facets { id, count, range, counted, alike, lobe, error });
    Ok(())
}

fn error_reply(message: String) -> Reply {
    Reply::Error { message }
}

fn say(emit: Emit<'_>, reply: &Reply) {
    emit(reply.into());
}
