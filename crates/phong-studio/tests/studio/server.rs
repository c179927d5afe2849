//! The server, with clients that mean well and others.

use std::io::{ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::time::Duration;

use phong_studio::engine::Bounds;
use phong_studio::protocol::Message;
use phong_studio::server::{Server, ServerOptions};
use serde_json::{Value, json};
use tempfile::TempDir;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message as Sent, WebSocket};

use crate::SCENE;
use crate::client::Page;

/// A studio on a folder with a scene in it and a secret beside it.
pub(crate) struct Studio {
    address: SocketAddr,
    token: String,
    _folder: TempDir,
}

impl Studio {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("scenes");
        std::fs::create_dir(&inner).unwrap();
        std::fs::write(inner.join("a.toml"), SCENE).unwrap();
        std::fs::write(folder.path().join("secret.toml"), SCENE).unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink("../secret.toml", inner.join("link.toml")).unwrap();
        let server = Self::bind(&inner);
        let token = server.url().split("token=").nth(1).unwrap().to_owned();
        let address = server.address();
        std::thread::spawn(move || server.run());
        Self { address, token, _folder: folder }
    }

    fn bind(folder: &Path) -> Server {
        let (folder, open) = (folder.to_owned(), Some("a.toml".to_owned()));
        Server::bind(ServerOptions { folder, open, look: None, port: 0, bounds: Bounds::default() })
            .unwrap()
    }

    /// What is answered to these bytes.
    fn tell(&self, bytes: &[u8]) -> String {
        let mut stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(40))).unwrap();
        let _ = stream.write_all(bytes); // it may have had enough before the end
        let mut answer = Vec::new();
        match stream.read_to_end(&mut answer) {
            Err(error) if error.kind() != ErrorKind::ConnectionReset => panic!("{error}"),
            _ => String::from_utf8_lossy(&answer).into_owned(),
        }
    }

    fn get(&self, path: &str, headers: &str) -> String {
        self.tell(format!("GET {path} HTTP/1.1\r\n{headers}Connection: close\r\n\r\n").as_bytes())
    }

    fn host(&self) -> String {
        format!("Host: {}\r\n", self.address)
    }

    pub(crate) fn call(&self) -> Result<Client, String> {
        self.call_from(&format!("http://{}", self.address))
    }

    fn call_from(&self, origin: &str) -> Result<Client, String> {
        let url = format!("ws://{}/{}/engine", self.address, self.token);
        let mut request = url.into_client_request().unwrap();
        request.headers_mut().insert("Origin", origin.parse().unwrap());
        let stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
        let (socket, _) =
            tungstenite::client(request, stream).map_err(|error| error.to_string())?;
        Ok(Client { socket, page: Page::default() })
    }
}

pub(crate) struct Client {
    socket: WebSocket<TcpStream>,
    page: Page,
}

impl Client {
    fn ask(&mut self, request: &Value) {
        self.socket.send(Sent::text(request.to_string())).unwrap();
    }

    /// Hears until `enough`.
    pub(crate) fn until(&mut self, enough: impl Fn(&Page) -> bool) {
        while !enough(&self.page) {
            match self.socket.read().unwrap() {
                Sent::Text(text) => self.page.hear(&Message::Text(text.to_string())),
                Sent::Binary(bytes) => self.page.hear(&Message::Frame(bytes.to_vec())),
                _ => {}
            }
        }
    }

    pub(crate) fn open(&mut self, path: &str) {
        self.ask(&json!({ "do": "pixels", "kind": "linear" }));
        self.ask(&json!({ "do": "open", "path": path }));
    }
}

#[test]
fn a_page_is_told_what_there_is_and_draws_it_to_the_end() {
    let studio = Studio::new();
    let mut client = studio.call().unwrap();
    client.until(|page| !page.all("hello").is_empty());
    let hello = client.page.last("hello");
    assert_eq!((&hello["protocol"], &hello["open"]), (&json!(4), &json!("a.toml")));
    assert!(hello["files"].as_array().unwrap().contains(&json!("a.toml")));
    client.open("a.toml");
    client.until(Page::is_done);
    assert!(client.page.pixels.iter().all(|v| v.is_finite()));
    // A hundred turns in a row: each is answered, and the last is drawn to the end.
    for _ in 0..100 {
        client.ask(&json!({ "do": "turn", "by": [0.01, 0] }));
    }
    client.until(|page| page.all("look").len() == 101 && page.is_done());
    // And as by a hand, which waits for the first pass of each: the last is drawn to the end.
    for turn in 0..10 {
        client.ask(&json!({ "do": "turn", "by": [0, 0.01] }));
        client.until(|page| {
            let [looks, passes] = ["look", "pass"].map(|is| page.all(is));
            looks.len() == 102 + turn
                && passes.iter().any(|pass| pass["picture"] == looks[101 + turn]["picture"])
        });
    }
    client.until(Page::is_done);
    assert!(client.page.pixels.iter().all(|v| v.is_finite()));
    client.ask(&json!({ "do": "keys" }));
    client.until(|page| !page.all("keys").is_empty());
    assert!(client.page.last("keys")["schema"]["properties"]["materials"].is_object());
}

#[test]
fn without_the_token_or_from_elsewhere_nothing_is_to_be_had() {
    let studio = Studio::new();
    let (host, token) = (studio.host(), &studio.token);
    let page = studio.get(&format!("/?token={token}"), &host);
    assert!(page.starts_with("HTTP/1.1 200"), "{page}");
    assert!(page.contains(&format!("<base href=\"/{token}/\">")) && !page.contains("<style"));
    let policy = page.to_lowercase();
    assert!(policy.contains("content-security-policy: default-src 'none'; script-src 'self'"));
    assert!(studio.get(&format!("/{token}/studio.js"), &host).starts_with("HTTP/1.1 200"));
    let origin = format!("Origin: http://{}\r\n", studio.address);
    assert!(
        studio
            .get(&format!("/?token={token}"), &(host.clone() + &origin))
            .starts_with("HTTP/1.1 200")
    );

    let forbidden = |path: &str, headers: &str| {
        let answer = studio.get(path, headers);
        assert!(answer.starts_with("HTTP/1.1 403"), "{path} {headers}: {answer}");
    };
    let wrong = "0".repeat(32);
    for path in
        ["/", "/studio.js", "/?token=", &format!("/?token={wrong}"), &format!("/{wrong}/studio.js")]
    {
        forbidden(path, &host);
    }
    let good = format!("/?token={token}");
    let port = studio.address.port();
    for headers in [
        String::new(),
        "Host: example.org\r\n".to_owned(),
        format!("Host: localhost:{port}\r\n"),
        format!("{host}{host}"),
        format!("{host}Origin: http://example.org\r\n"),
        format!("{host}Origin: null\r\n"),
        format!("{host}Origin: http://127.0.0.1:{}\r\n", port.wrapping_add(1)),
    ] {
        let answer = studio.get(&good, &headers);
        assert!(
            answer.starts_with("HTTP/1.1 403") || answer.starts_with("HTTP/1.1 400"),
            "{headers}: {answer}"
        );
    }
    assert!(studio.call_from("http://example.org").is_err());
}

#[test]
fn no_path_leads_out() {
    let studio = Studio::new();
    let (host, token) = (studio.host(), &studio.token);
    for path in ["../secret.toml", "%2e%2e/secret.toml", "..%2fsecret.toml", "a.toml", "engine/x"] {
        let answer = studio.get(&format!("/{token}/{path}"), &host);
        assert!(!answer.starts_with("HTTP/1.1 200"), "{path}: {answer}");
    }
    let mut client = studio.call().unwrap();
    for (i, path) in ["../secret.toml", "/etc/passwd", "link.toml", "x/../../secret.toml", "\u{0}"]
        .iter()
        .enumerate()
    {
        client.ask(&json!({ "do": "open", "path": path }));
        client.until(|page| page.all("error").len() == i + 1);
    }
    client.open("a.toml");
    let text = format!("{SCENE}[[include]]\nfile = \"../secret.toml\"\n");
    client.ask(&json!({ "do": "edit", "text": text }));
    client.until(|page| page.all("checked").len() == 2);
    assert_eq!(client.page.last("checked")["ok"], false);
    let said = client.page.last("checked").to_string();
    assert!(said.contains("outside"), "{said}");
}

#[test]
fn hostile_requests_are_refused_and_the_server_lives() {
    let studio = Studio::new();
    let (host, token) = (studio.host(), &studio.token);
    let long = "x".repeat(1 << 20);
    for bytes in [
        format!("GET /{long} HTTP/1.1\r\n{host}\r\n"),
        format!("GET / HTTP/1.1\r\n{host}X: {long}\r\n\r\n"),
        format!(
            "POST /?token={token} HTTP/1.1\r\n{host}Content-Length: 1048576\r\nConnection: close\r\n\r\n{long}"
        ),
        "\u{0}\u{1}\u{2}\r\n\r\n".to_owned(),
        "GET".to_owned() + &" ".repeat(9000),
    ] {
        let answer = studio.tell(bytes.as_bytes());
        assert!(!answer.starts_with("HTTP/1.1 2"), "{answer}");
    }
    let mut client = studio.call().unwrap();
    for text in ["", "{}", "[[[[", "{\"do\":\"open\"}", "\u{7f}"] {
        client.socket.send(Sent::text(text)).unwrap();
    }
    client.socket.send(Sent::binary(vec![0; 1000])).unwrap();
    client.until(|page| page.all("error").len() == 6);
    client.ask(&json!({ "do": "edit", "text": "version = 1" }));
    client.until(|page| page.all("error").len() == 7);
    // More than a message may have: the connection ends.
    let huge = json!({ "do": "edit", "text": "x".repeat(9 << 20) });
    let _ = client.socket.send(Sent::text(huge.to_string()));
    while client.socket.read().is_ok() {}
    let mut other = studio.call().unwrap();
    other.open("a.toml");
    other.until(Page::is_done);
}

#[test]
fn a_client_that_goes_or_says_nothing_leaves_its_place_to_others() {
    let studio = Studio::new();
    // Half-open: they connect, and say nothing or half a word.
    let mut silent: Vec<TcpStream> =
        (0..70).map(|_| TcpStream::connect(studio.address).unwrap()).collect();
    silent.iter_mut().take(9).for_each(|stream| stream.write_all(b"GET / HT").unwrap());
    let mut client = studio.call().unwrap();
    client.open("a.toml");
    client.until(Page::is_done);
    // All places are taken, then left in the middle of a picture.
    let mut clients: Vec<_> = (0..7).map(|_| studio.call().unwrap()).collect();
    assert!(studio.call().is_err(), "a ninth session");
    for client in &mut clients {
        client.open("a.toml");
        client.ask(&json!({ "do": "look", "set": { "image.size": [640, 360] } }));
    }
    drop(clients);
    let mut again = None;
    for _ in 0..200 {
        again = studio.call().ok();
        if again.is_some() {
            break;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let mut again = again.expect("a place that was left");
    again.open("a.toml");
    again.until(Page::is_done);
    drop(silent);
}
