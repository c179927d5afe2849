//! A session: a client, an engine on a thread of its own, and what is on its way between them.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::extract::ws::{Message as Sent, WebSocket};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt as _, StreamExt as _, stream};
use phong::render::Cancel;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::time::{interval, sleep_until, timeout};

use super::bundle::{self, Bundle};
use super::studio::Studio;
use crate::engine::{Emit, Engine, Stage};
use crate::protocol::{Message, Request};

/// Requests that may wait for the engine; a client that sends more is dropped.
const MOST_WAITING: usize = 1024;

/// Bytes that may wait for the client; over that nothing is drawn until it has taken some.
const MOST_QUEUED: usize = 8 << 20;

/// How long a client may take for one message.
const SENDING: Duration = Duration::from_secs(10);

/// How long another change is waited for after the first pass of a picture, where the one before was given up with
/// nothing more: as long as a page takes to show a first pass and to send what a hand did meanwhile. So a processor that a
/// browser needs as well draws nothing that would be thrown away, while a picture that is done sooner is shown.
const PAUSE: Duration = Duration::from_millis(50);

/// How often a client is asked whether it is still there.
const PING: Duration = Duration::from_secs(20);

/// How long it may be silent.
const SILENCE: Duration = Duration::from_mins(1);

/// What comes from the client.
enum Heard {
    Request(Request),
    /// What was no request.
    Nonsense(String),
}

/// Runs until the client is gone.
pub(super) async fn run(socket: WebSocket, studio: &Arc<Studio>) {
    let (sink, stream) = socket.split();
    let (out, queue) = unbounded_channel();
    let (to_engine, heard) = sync_channel(MOST_WAITING);
    let shared = Arc::new(Shared::new(out));
    let (engine_side, engine_studio) = (Arc::clone(&shared), Arc::clone(studio));
    let engine = tokio::task::spawn_blocking(move || work(&engine_studio, &heard, &engine_side));
    let writer = tokio::spawn(write(sink, queue, Arc::clone(&shared)));
    read(stream, to_engine, &shared).await;
    shared.end();
    writer.abort();
    let _ = engine.await;
}

/// Hears the client until it is gone or says too much.
async fn read(mut stream: SplitStream<WebSocket>, to_engine: SyncSender<Heard>, shared: &Shared) {
    while let Ok(Some(Ok(message))) = timeout(SILENCE, stream.next()).await {
        let text = match message {
            Sent::Text(text) => text,
            Sent::Close(_) => return,
            Sent::Ping(_) | Sent::Pong(_) => continue,
            Sent::Binary(_) => "".into(),
        };
        let heard = match serde_json::from_str(&text) {
            Ok(request) => Heard::Request(request),
            Err(error) => Heard::Nonsense(error.to_string()),
        };
        let patient = match &heard {
            Heard::Request(request) => can_wait(request),
            Heard::Nonsense(_) => true,
        };
        if shared.is_over() || to_engine.try_send(heard).is_err() {
            return;
        }
        shared.interrupt(patient);
    }
}

/// Whether a request leaves the picture as it is: then the tiles under way are finished first, so
/// that a pointer that asks all the time does not keep the picture from ever being done.
fn can_wait(request: &Request) -> bool {
    matches!(
        request,
        Request::Explain { .. }
            | Request::Facets { .. }
            | Request::CosinePower { .. }
            | Request::Lobe { .. }
            | Request::Guess { .. }
            | Request::Grade { .. }
            | Request::Pixels { .. }
            | Request::Finish { .. }
            | Request::Export { .. }
            | Request::Save { .. }
            | Request::CheckFile
            | Request::Keys
    )
}

/// Sends what is queued, and asks now and then whether anybody is there. Tiles of one moment go together, and none
/// of a picture that another has taken the place of.
async fn write(
    mut sink: SplitSink<WebSocket, Sent>,
    mut queue: UnboundedReceiver<Message>,
    shared: Arc<Shared>,
) {
    let mut ping = interval(PING);
    ping.tick().await; // the first is at once
    let mut tiles = Bundle::new();
    loop {
        let next = tokio::select! {
            next = queue.recv() => match next {
                Some(Message::Frame(frame)) if bundle::picture(&frame).is_some() => {
                    tiles.push(frame);
                    if !tiles.is_full() {
                        continue;
                    }
                    None
                }
                Some(Message::Frame(frame)) => Some(Sent::Binary(frame.into())),
                Some(Message::Text(text)) => Some(Sent::Text(text.into())),
                Some(Message::Nothing) => continue,
                None => break,
            },
            () = sleep_until(tiles.due()), if !tiles.is_empty() => None,
            _ = ping.tick() => Some(Sent::Ping(Vec::new().into())),
        };
        // What was queued behind tiles is sent behind them.
        let tiles = tiles.take();
        let bytes = tiles.len() + next.as_ref().map_or(0, length);
        let seen = bundle::picture(&tiles).is_some_and(|picture| !shared.is_old(picture));
        let tiles = seen.then(|| Sent::Binary(tiles.into()));
        let mut all = stream::iter(tiles.into_iter().chain(next).map(Ok));
        if !matches!(timeout(SENDING, sink.send_all(&mut all)).await, Ok(Ok(()))) {
            break;
        }
        shared.sent(bytes);
    }
    shared.end();
}

/// The bytes of a message that count as queued.
fn length(message: &Sent) -> usize {
    match message {
        Sent::Text(text) => text.len(),
        Sent::Binary(bytes) => bytes.len(),
        _ => 0,
    }
}

/// The engine's side, on a thread of its own.
fn work(studio: &Studio, heard: &Receiver<Heard>, shared: &Shared) {
    let engine = Engine::new(studio.shelf.clone(), studio.bounds.clone());
    let mut engine = engine.with_keeper(studio.shelf.clone());
    let emit: Emit<'_> = &|message| shared.queue(message);
    shared.queue(engine.hello(studio.shelf.first(), studio.shelf.names(), studio.look));
    // Whether the picture before was given up with nothing but its first pass, and when the newest had that.
    let (mut hasty, mut seen) = (false, Instant::now());
    loop {
        let cancel = shared.begin();
        let next = if !engine.has_work() {
            heard.recv().map_err(|_| RecvTimeoutError::Disconnected)
        } else if hasty && engine.stage() == Stage::Coarse {
            heard.recv_timeout(PAUSE.saturating_sub(seen.elapsed()))
        } else {
            heard.recv_timeout(Duration::ZERO)
        };
        let next = match next {
            Ok(next) => Some(next),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        let (picture, stage) = (engine.picture(), engine.stage());
        if shared.is_over() {
            return;
        }
        let done = catch_unwind(AssertUnwindSafe(|| match next {
            Some(Heard::Request(request)) => engine.answer(request, emit),
            Some(Heard::Nonsense(text)) => engine.refuse(&text, emit),
            None if shared.has_room() => engine.advance(&cancel, emit),
            None => {}
        }));
        if done.is_err() {
            engine.broken(emit);
        }
        if engine.picture() == picture {
            if (stage, engine.stage()) == (Stage::Begun, Stage::Coarse) {
                seen = Instant::now();
            }
        } else if stage != Stage::Begun {
            hasty = stage == Stage::Coarse;
        }
        shared.picture.store(engine.picture(), Ordering::SeqCst);
    }
}

/// What the threads of a session share.
struct Shared {
    out: UnboundedSender<Message>,
    /// Bytes that wait for the client.
    queued: Mutex<usize>,
    taken: Condvar,
    /// Stops what is being drawn at once.
    cancel: Mutex<Arc<Cancel>>,
    /// Asks to stop after the tiles under way.
    soon: AtomicBool,
    /// The number of the newest picture.
    picture: AtomicU32,
    over: AtomicBool,
}

impl Shared {
    fn new(out: UnboundedSender<Message>) -> Self {
        Self {
            out,
            queued: Mutex::default(),
            taken: Condvar::new(),
            cancel: Mutex::default(),
            soon: AtomicBool::new(false),
            picture: AtomicU32::new(0),
            over: AtomicBool::new(false),
        }
    }

    /// From now on an interrupt stops what is drawn next.
    fn begin(&self) -> Arc<Cancel> {
        self.soon.store(false, Ordering::SeqCst);
        let cancel = Arc::new(Cancel::new());
        *held(&self.cancel) = Arc::clone(&cancel);
        cancel
    }

    fn interrupt(&self, patient: bool) {
        self.soon.store(true, Ordering::SeqCst);
        if !patient {
            held(&self.cancel).cancel();
        }
        self.taken.notify_all();
    }

    /// Queues a message for the client; whether to go on drawing.
    fn queue(&self, message: Message) -> bool {
        let bytes = match &message {
            Message::Text(text) => text.len(),
            Message::Frame(frame) => frame.len(),
            Message::Nothing => 0,
        };
        let queued = {
            let mut queued = held(&self.queued);
            *queued += bytes;
            *queued
        };
        if queued - bytes > 4 * MOST_QUEUED {
            // It asks for more and more, and takes nothing.
            self.end();
            return false;
        }
        let sent = matches!(message, Message::Nothing) || self.out.send(message).is_ok();
        sent && queued < MOST_QUEUED && !self.soon.load(Ordering::SeqCst)
    }

    fn sent(&self, bytes: usize) {
        *held(&self.queued) -= bytes;
        self.taken.notify_all();
    }

    /// Waits until the client has taken half of what may wait, or something else is to be done.
    fn has_room(&self) -> bool {
        let mut queued = held(&self.queued);
        while *queued > MOST_QUEUED / 2 && !self.is_over() && !self.soon.load(Ordering::SeqCst) {
            let waited = self.taken.wait_timeout(queued, SENDING);
            queued = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        *queued <= MOST_QUEUED / 2
    }

    /// Whether another picture has taken the place of the one of this number. Numbers begin anew after the
    /// largest.
    fn is_old(&self, picture: u32) -> bool {
        let newest = self.picture.load(Ordering::SeqCst);
        picture != newest && newest.wrapping_sub(picture) <= u32::MAX / 2
    }

    fn end(&self) {
        self.over.store(true, Ordering::SeqCst);
        self.interrupt(false);
    }

    fn is_over(&self) -> bool {
        self.over.load(Ordering::SeqCst)
    }
}

/// Nothing that can panic is done under these locks.
fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
