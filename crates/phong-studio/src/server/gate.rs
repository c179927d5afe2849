//! Who may come in, and what they get: the page's files and a session.
#![allow(clippy::unused_async, reason = "handlers are async, whether or not they wait")]

use std::sync::Arc;

use axum::Router;
use axum::body::Body;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{Path, Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HOST, ORIGIN, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;

use super::session;
use super::studio::Studio;
use crate::engine::Bounds;
use crate::page;

/// Bytes of the largest message of a client: a scene's text, escaped.
const MOST_BYTES: usize = 2 * Bounds::TEXT as usize;

pub(super) fn router(studio: Arc<Studio>) -> Router {
    Router::new()
        .route("/", get(index))
        .route("/{token}/engine", get(engine))
        .route("/{token}/{file}", get(file))
        .layer(middleware::from_fn_with_state(Arc::clone(&studio), guard))
        .with_state(studio)
}

/// Lets in who knows the token and comes from this page or from no page; what goes out may load
/// nothing from elsewhere.
async fn guard(State(studio): State<Arc<Studio>>, request: Request, next: Next) -> Response {
    let mut response = if studio.lets_in(&request) {
        next.run(request).await
    } else {
        (StatusCode::FORBIDDEN, "403: open the address that `phong studio` printed\n")
            .into_response()
    };
    let policy = format!(
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; \
         connect-src 'self' ws://{}; base-uri 'self'; form-action 'none'; frame-ancestors 'none'",
        studio.address
    );
    let headers = response.headers_mut();
    let mut put = |name: HeaderName, value: &str| {
        if let Ok(value) = HeaderValue::from_str(value) {
            headers.insert(name, value);
        }
    };
    put(CONTENT_SECURITY_POLICY, &policy);
    put(X_CONTENT_TYPE_OPTIONS, "nosniff");
    put(REFERRER_POLICY, "no-referrer");
    put(CACHE_CONTROL, "no-store");
    response
}

impl Studio {
    fn lets_in(&self, request: &Request) -> bool {
        let (uri, headers) = (request.uri(), request.headers());
        let token = if uri.path() == "/" {
            let mut pairs = uri.query().unwrap_or_default().split('&');
            pairs.find_map(|pair| pair.strip_prefix("token="))
        } else {
            uri.path().split('/').nth(1)
        };
        let own = self.address.to_string();
        let is_own = |name, value: &str| match only(headers, &name) {
            Ok(found) => found.map(|found| found == value),
            Err(()) => Some(false),
        };
        is_own(HOST, &own) == Some(true)
            && is_own(ORIGIN, &format!("http://{own}")) != Some(false)
            && token.is_some_and(|token| same(token.as_bytes(), self.token.as_bytes()))
    }
}

/// The only header of this name; none, or an error if there are several or it is no text.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Result<Option<&'a str>, ()> {
    let mut values = headers.get_all(name).iter();
    match (values.next(), values.next()) {
        (None, _) => Ok(None),
        (Some(value), None) => value.to_str().map(Some).map_err(drop),
        _ => Err(()),
    }
}

/// Whether two texts are the same, in a time that does not tell where they differ.
fn same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |differ, (a, b)| differ | (a ^ b)) == 0
}

/// The page, whose files are asked for below the token.
async fn index(State(studio): State<Arc<Studio>>) -> Response {
    let Some(index) = page::file("index.html") else { return missing() };
    let text = String::from_utf8_lossy(index.bytes);
    let text = text.replace("<base href=\"./\">", &format!("<base href=\"/{}/\">", studio.token));
    ([(CONTENT_TYPE, index.media_type)], Body::from(text)).into_response()
}

async fn file(Path((_, name)): Path<(String, String)>) -> Response {
    match page::file(&name) {
        Some(file) => ([(CONTENT_TYPE, file.media_type)], Body::from(file.bytes)).into_response(),
        None => missing(),
    }
}

fn missing() -> Response {
    (StatusCode::NOT_FOUND, "404: the studio has no such file\n").into_response()
}

async fn engine(State(studio): State<Arc<Studio>>, upgrade: WebSocketUpgrade) -> Response {
    let Ok(permit) = Arc::clone(&studio.sessions).try_acquire_owned() else {
        return (StatusCode::SERVICE_UNAVAILABLE, "503: too many pages are open\n").into_response();
    };
    upgrade.max_message_size(MOST_BYTES).max_frame_size(MOST_BYTES).on_upgrade(
        async move |socket| {
            session::run(socket, &studio).await;
            drop(permit);
        },
    )
}
