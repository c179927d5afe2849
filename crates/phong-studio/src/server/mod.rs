//! The studio's server: the page, and an engine for everybody who opens it, on 127.0.0.1 alone.
//!
//! A token in the address keeps other users and other pages out; `Host` and `Origin` keep out pages
//! of the web that have this browser ask. What is opened lies in one folder, and nothing outside it
//! is read. Connections, sessions, messages and memory are bounded, and nothing waits for a client
//! that does not read.

mod bundle;
mod gate;
mod session;
mod studio;

use std::fmt::Write as _;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use phong::scene::NamedLook;
use tokio::sync::Semaphore;
use tokio::time::timeout;

use crate::engine::Bounds;
use crate::folder::Shelf;
use studio::Studio;

/// Connections at once; more wait.
const CONNECTIONS: usize = 64;

/// Sessions at once; more are refused.
const SESSIONS: usize = 8;

/// How long a client may take for the head of a request.
const HEAD: Duration = Duration::from_secs(5);

/// How long a connection may last that asks for files.
const CONNECTION: Duration = Duration::from_secs(30);

/// What is served.
#[derive(Clone, Debug)]
pub struct ServerOptions {
    /// The folder that scenes are read from; nothing outside it is.
    pub folder: PathBuf,
    /// The file in it to open first; `None`: a scene of the studio's own.
    pub open: Option<String>,
    /// The look to put on it; `None`: none.
    pub look: Option<NamedLook>,
    /// The port; 0: any that is free.
    pub port: u16,
    /// What each session may use.
    pub bounds: Bounds,
}

/// A server that is bound to its port, and does not answer yet.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    studio: Arc<Studio>,
}

impl Server {
    /// Takes a port, and draws a token.
    ///
    /// # Errors
    /// What the system says of the folder, the port, or its source of randomness.
    pub fn bind(options: ServerOptions) -> io::Result<Self> {
        let ServerOptions { folder, open, look, port, bounds } = options;
        let shelf = Shelf::new(&folder, open)?;
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let mut random = [0_u8; 16];
        getrandom::fill(&mut random).map_err(io::Error::other)?;
        let mut token = String::new();
        for byte in random {
            // Writing to a string does not fail.
            let _ = write!(token, "{byte:02x}");
        }
        let address = listener.local_addr()?;
        let sessions = Arc::new(Semaphore::new(SESSIONS));
        let studio = Studio { token, address, shelf, bounds, look, sessions };
        Ok(Self { listener, studio: Arc::new(studio) })
    }

    /// Where the page is, with its token.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/?token={}", self.studio.address, self.studio.token)
    }

    /// Its address.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.studio.address
    }

    /// Answers, for as long as the process lives.
    ///
    /// # Errors
    /// What the system says where it gives no threads.
    pub fn run(self) -> io::Result<()> {
        let runtime =
            tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build()?;
        runtime.block_on(self.answer())
    }

    async fn answer(self) -> io::Result<()> {
        let listener = tokio::net::TcpListener::from_std(self.listener)?;
        let service = TowerToHyperService::new(gate::router(self.studio));
        let connections = Arc::new(Semaphore::new(CONNECTIONS));
        loop {
            let Ok(permit) = Arc::clone(&connections).acquire_owned().await else { return Ok(()) };
            let Ok((stream, _)) = listener.accept().await else {
                // Too many files are open, or the client is gone already.
                tokio::time::sleep(Duration::from_millis(20)).await;
                continue;
            };
            // A short message is not held back until the one before it was acknowledged, which may take 40 ms.
            let _ = stream.set_nodelay(true);
            let service = service.clone();
            tokio::spawn(async move {
                let connection = http1::Builder::new()
                    .timer(TokioTimer::new())
                    .header_read_timeout(HEAD)
                    .max_buf_size(16 << 10)
                    .serve_connection(TokioIo::new(stream), service)
                    .with_upgrades();
                // A session takes its connection over, and this ends.
                let _ = timeout(CONNECTION, connection).await;
                drop(permit);
            });
        }
    }
}
