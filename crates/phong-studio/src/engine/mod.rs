//! The studio's engine: one scene, one picture, and whoever looks at it.
//!
//! It does what it is told at once, all but drawing: that is done in portions by
//! [`Engine::advance`], so that whoever runs it may hear the next request in between. A request that
//! changes the picture takes the place of the one under way.

mod asking;
mod dressing;
mod exporting;
mod finishing;
mod frames;
mod handles;
mod hands;
mod lines;
mod lobe;
mod look;
mod opened;
mod painting;
mod recipe;
mod saving;
mod sharing;
mod teaching;
mod writing;

use phong::render::Cancel;
use phong::scene::{Format, Limits, NamedLook, Source, closest, schema_json};
use phong::terms::{Term, TermSet};
use phong_lab::grade::Planted;
use serde_json::{Map, Value};

use crate::protocol::{Message, PixelKind, Reply, Request, VERSION};
use opened::{Files, Opened, Shown};
use painting::Painting;
pub use saving::Keep;

/// A scene to begin with.
pub const EXAMPLE: &str = include_str!("two-balls.toml");

/// The name of [`EXAMPLE`].
pub const EXAMPLE_NAME: &str = "two-balls.toml";

/// What is said where a request needs a scene.
const NOTHING: &str = "nothing is open";

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

/// How much of a picture was shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Nothing yet.
    Begun,
    /// Its first pass, at an eighth of the size, and perhaps tiles of the next.
    Coarse,
    /// A pass of its full size.
    Fine,
}

/// One scene, one picture.
#[derive(Debug)]
pub struct Engine {
    source: Box<dyn Source>,
    bounds: Bounds,
    /// Where texts are saved; `None`: nowhere.
    keeper: Option<Box<dyn Keep>>,
    /// Which share of each picture is drawn, of how many; `None`: all of it.
    share: Option<(u32, u32)>,
    opened: Option<Opened>,
    /// A look that is tried on, and what is open with it on.
    tried: Option<(NamedLook, Opened)>,
    pixels: PixelKind,
    /// The number of the newest picture.
    picture: u32,
    painting: Option<Painting>,
    /// Whether drawing was stopped by request.
    stopped: bool,
    /// The terms that are left out of what is drawn.
    off: TermSet,
    /// What is shown with a mistake in it.
    planted: Option<Planted>,
}

impl Engine {
    /// An engine that has opened nothing yet.
    pub fn new(source: impl Source + 'static, bounds: Bounds) -> Self {
        let source = Box::new(source);
        Self {
            source,
            bounds,
            keeper: None,
            share: None,
            opened: None,
            tried: None,
            pixels: PixelKind::default(),
            picture: 0,
            painting: None,
            stopped: false,
            off: TermSet::NONE,
            planted: None,
        }
    }

    /// The same, which draws share `index` of `count` of every picture; they count from 0. The first
    /// draws the first pass alone, and all of it.
    #[must_use]
    pub fn with_share(self, index: u32, count: u32) -> Self {
        Self { share: (index < count && count > 1).then_some((index, count)), ..self }
    }

    /// The first message to a page: what there is to open, and the look that is then put on; `None`: none.
    pub fn hello(&self, open: &str, files: Vec<String>, look: Option<NamedLook>) -> Message {
        let version = env!("CARGO_PKG_VERSION").to_owned();
        let reply = Reply::Hello {
            protocol: VERSION,
            version,
            open: open.to_owned(),
            files,
            look: look.map(NamedLook::name),
            looks: NamedLook::ALL.map(NamedLook::name).to_vec(),
            saves: self.keeper.is_some(),
        };
        (&reply).into()
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
            Request::Edit { text, set } => self.edit(text, set, emit),
            Request::Write { set } => self.write(&set, emit),
            Request::Look { set } => self.changed(emit, |opened, files| opened.lay(set, files)),
            Request::Reset => self.changed(emit, Opened::reset),
            Request::Turn { by } => self.changed(emit, |opened, files| opened.turn(by, files)),
            Request::Move { by } => self.changed(emit, |opened, files| opened.shift(by, files)),
            Request::Zoom { by } => self.changed(emit, |opened, files| opened.zoom(by, files)),
            Request::PutOn { look } => self.put_on(look.as_deref(), emit),
            Request::TryOn { look } => self.try_on(look.as_deref(), emit),
            Request::Frame { number } => self.show_frame(number, emit),
            Request::Save { over, text } => self.save(over, text.as_deref(), emit),
            Request::CheckFile => {
                self.check_file(emit);
                Ok(())
            }
            Request::TakeFile => self.take_file(emit),
            Request::Drag { path, from, to, keep } => self.drag(&path, [from, to], keep, emit),
            Request::Terms { off } => self.leave_out(&off, emit),
            Request::Pixels { kind } => {
                self.pixels = kind;
                Ok(())
            }
            Request::Explain { id, pixel, samples, set } => {
                self.explain(id, pixel, samples, &set, emit)
            }
            Request::Lobe { id, pixel, light, set } => self.lobe(id, pixel, light, &set, emit),
            Request::Mistake { seed, cause } => self.mistake(seed, cause.as_deref(), emit),
            Request::Guess { cause } => self.guess(cause, emit),
            Request::Grade { name, bytes } => self.grade(name, &bytes, emit),
            Request::Cancel => {
                self.stopped = true;
                Ok(())
            }
            Request::Resume => {
                self.stopped = false;
                self.planted = None;
                Ok(())
            }
            Request::Finish { picture } => {
                self.finish(picture, emit);
                Ok(())
            }
            Request::Export { format } => self.export(format, emit),
            Request::Keys => {
                let schema = serde_json::from_str(&schema_json()).unwrap_or(Value::Null);
                say(emit, &Reply::Keys { schema });
                Ok(())
            }
            Request::Facets { id, theta, count } => asking::facets(id, theta, count, emit),
            Request::CosinePower { id, exponent } => asking::cosine_power(id, exponent, emit),
        };
        if let Err(message) = done {
            say(emit, &error_reply(message));
        }
    }

    /// The number of the newest picture; 0: there was none yet.
    pub fn picture(&self) -> u32 {
        self.picture
    }

    /// Whether there is something to draw.
    pub fn has_work(&self) -> bool {
        !self.stopped && self.painting.as_ref().is_some_and(|painting| !painting.is_done())
    }

    /// How much of the newest picture was shown.
    pub fn stage(&self) -> Stage {
        self.painting.as_ref().map_or(Stage::Begun, Painting::stage)
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
        sharing::part(self.drawn()?, self.painting.as_ref()?)
    }

    /// Takes the share that another engine's [`part`](Self::part) is.
    pub fn join(&mut self, part: &[u8], emit: Emit<'_>) {
        // Not `drawn`, which would hold on to the painting as well.
        let tried = self.tried.as_ref().map(|(_, tried)| tried);
        if let (Some(opened), Some(painting)) = (tried.or(self.opened.as_ref()), &mut self.painting)
            && let Err(message) = sharing::join(part, opened, painting, self.bounds.bytes)
        {
            say(emit, &error_reply(message));
        }
    }

    fn open(&mut self, path: &str, emit: Emit<'_>) -> Result<(), String> {
        if let Some(sheet) = self.sheet(path)? {
            say(emit, &sheet);
            return Ok(());
        }
        let (opened, text) = Opened::of_file(path, self.files())?;
        say(emit, &Reply::Scene { path: path.to_owned(), text });
        (self.painting, self.tried) = (None, None);
        self.opened = Some(opened);
        self.begin(emit)
    }

    /// What is at this path, if it is a class sheet.
    fn sheet(&self, path: &str) -> Result<Option<Reply>, String> {
        if Format::of_path(path) != Some(Format::Toml) {
            return Ok(None);
        }
        teaching::sheet(path, &opened::text_of(path, self.files())?)
    }

    fn files(&self) -> Files<'_> {
        Files { source: &*self.source, bounds: &self.bounds }
    }

    fn edit(
        &mut self,
        text: String,
        set: Option<Map<String, Value>>,
        emit: Emit<'_>,
    ) -> Result<(), String> {
        if text.len() as u64 > Bounds::TEXT {
            return Err(format!("a text of more than {} bytes", Bounds::TEXT));
        }
        let files = Files { source: &*self.source, bounds: &self.bounds };
        self.opened.as_mut().ok_or(NOTHING)?.edit(text, set, files)?;
        self.begin(emit)
    }

    fn write(&mut self, set: &Map<String, Value>, emit: Emit<'_>) -> Result<(), String> {
        let files = Files { source: &*self.source, bounds: &self.bounds };
        let opened = self.opened.as_mut().ok_or(NOTHING)?;
        let before = opened.clone();
        let mut done = opened.write(set, files);
        if done.is_ok() {
            done = self.ready(self.opened.as_ref()).map(drop);
        }
        if let Err(message) = done {
            self.opened = Some(before);
            // What the text has no place for is laid over it, where that can be.
            let _ = self.changed(emit, |opened, files| opened.lay(set.clone(), files));
            return Err(message);
        }
        let opened = self.opened.as_ref().ok_or(NOTHING)?;
        let text = opened.text().unwrap_or_default().to_owned();
        say(emit, &Reply::Text { text, note: None, from_file: false });
        self.begin(emit)
    }

    /// Puts a look on: into the text, or on a bare model, from which `None` takes it off.
    fn put_on(&mut self, name: Option<&str>, emit: Emit<'_>) -> Result<(), String> {
        let look = name.map(dressing::look_of).transpose()?;
        let files = Files { source: &*self.source, bounds: &self.bounds };
        let opened = self.opened.as_mut().ok_or(NOTHING)?;
        let before = opened.clone();
        let is_bare = opened.text().is_none();
        let done = match look {
            look if is_bare => opened.dress(look, files).map(|()| None),
            None => Err("a look that stands in a text is taken back by undo".to_owned()),
            Some(look) => opened.put_on(look, files),
        };
        let done = done.and_then(|note| self.ready(self.opened.as_ref()).map(|_| note));
        let note = done.inspect_err(|_| self.opened = Some(before))?;
        let text = self.opened.as_ref().and_then(|opened| opened.text().map(str::to_owned));
        if let Some(text) = text {
            let note = note.map(str::to_owned);
            say(emit, &Reply::Text { text, note, from_file: false });
        }
        self.begin(emit)
    }

    /// Shows another frame of what is open.
    fn show_frame(&mut self, number: u64, emit: Emit<'_>) -> Result<(), String> {
        let files = Files { source: &*self.source, bounds: &self.bounds };
        let opened = self.opened.as_mut().ok_or(NOTHING)?;
        let before = opened.clone();
        let done = opened.show_frame(number, files).and_then(|()| self.begin(emit));
        done.inspect_err(|_| self.opened = Some(before))
    }

    /// Draws what is open with a look on, which stays as it is; `None`: without.
    fn try_on(&mut self, name: Option<&str>, emit: Emit<'_>) -> Result<(), String> {
        let tried = match name.map(dressing::look_of).transpose()? {
            None => None,
            Some(look) => {
                let opened = self.opened.as_ref().ok_or(NOTHING)?;
                Some((look, opened.with_look(look, self.files())?))
            }
        };
        let before = std::mem::replace(&mut self.tried, tried);
        self.paint_what_is_tried(emit).inspect_err(|_| self.tried = before)
    }

    fn drag(
        &mut self,
        path: &str,
        way: [[f64; 2]; 2],
        keep: bool,
        emit: Emit<'_>,
    ) -> Result<(), String> {
        if !keep {
            return self.changed(emit, |opened, files| opened.drag(path, way, files));
        }
        let files = Files { source: &*self.source, bounds: &self.bounds };
        let opened = self.opened.as_mut().ok_or(NOTHING)?;
        let before = opened.before();
        if let Err(message) = opened.drag(path, way, files) {
            opened.put_back(before);
            return Err(message);
        }
        let keys = opened.let_go();
        self.write(&keys, emit)
    }

    fn leave_out(&mut self, names: &[String], emit: Emit<'_>) -> Result<(), String> {
        let mut off = TermSet::NONE;
        for name in names {
            let term = Term::from_name(name).ok_or_else(|| {
                let known = closest(name, Term::ALL.map(Term::name));
                let known =
                    known.map_or_else(String::new, |name| format!(" (did you mean `{name}`?)"));
                format!("there is no term `{name}`{known}")
            })?;
            off = off.with(term);
        }
        let before = std::mem::replace(&mut self.off, off);
        self.paint(emit).inspect_err(|_| self.off = before)
    }

    /// Changes what is laid over the scene, and draws that; where it cannot be, all is as it was.
    fn changed(
        &mut self,
        emit: Emit<'_>,
        change: impl FnOnce(&mut Opened, Files<'_>) -> Result<(), String>,
    ) -> Result<(), String> {
        let files = Files { source: &*self.source, bounds: &self.bounds };
        let opened = self.opened.as_mut().ok_or(NOTHING)?;
        let before = opened.before();
        change(opened, files)?;
        let painted = self.paint(emit);
        if let (Err(_), Some(opened)) = (&painted, &mut self.opened) {
            opened.put_back(before);
        }
        painted
    }

    /// Says what was read, and begins the picture of it if there is one.
    fn begin(&mut self, emit: Emit<'_>) -> Result<(), String> {
        let opened = self.opened.as_ref().ok_or(NOTHING)?;
        let (ok, diagnostics) = opened.diagnostics();
        say(emit, &Reply::Checked { ok, diagnostics });
        if ok { self.paint(emit) } else { Ok(()) }
    }

    /// What is drawn: what is open, with the look on that is tried.
    fn drawn(&self) -> Option<&Opened> {
        self.tried.as_ref().map(|(_, tried)| tried).or(self.opened.as_ref())
    }

    /// The next picture, of this.
    fn ready(&self, opened: Option<&Opened>) -> Result<(u32, Painting, Shown), String> {
        let shown = opened.ok_or(NOTHING)?.shown()?;
        let picture = self.picture.wrapping_add(1);
        let (bytes, share, view) = (self.bounds.bytes, self.share, shown.view.clone());
        let painting = Painting::new(picture, view, &shown.scene, self.off, bytes, share)?;
        Ok((picture, painting, shown))
    }

    /// Begins the picture of what is open now. No look is tried on any more.
    fn paint(&mut self, emit: Emit<'_>) -> Result<(), String> {
        let tried = self.tried.take();
        self.paint_what_is_tried(emit).inspect_err(|_| self.tried = tried)
    }

    fn paint_what_is_tried(&mut self, emit: Emit<'_>) -> Result<(), String> {
        let (picture, painting, shown) = self.ready(self.drawn())?;
        self.picture = picture;
        self.stopped = false;
        self.planted = None;
        let finished = painting.draws();
        self.painting = Some(painting);
        let opened = self.drawn().ok_or(NOTHING)?;
        say(
            emit,
            &Reply::Look {
                picture,
                size: shown.scene.image.size,
                samples: shown.scene.image.samples,
                values: shown.values,
                wells: shown.wells,
                set: opened.set().clone(),
                command: opened.command(),
                dressed: opened.dressed.map(NamedLook::name),
                frame: opened.frame.number,
                frames: opened.frame.count,
                tried: self.tried.as_ref().map(|(look, _)| look.name()),
                handles: shown.handles,
                terms: shown.terms.iter().map(Term::name).collect(),
                off: self.off.iter().map(Term::name).collect(),
                finished,
            },
        );
        Ok(())
    }
}

fn error_reply(message: String) -> Reply {
    Reply::Error { message }
}

fn say(emit: Emit<'_>, reply: &Reply) {
    emit(reply.into());
}
