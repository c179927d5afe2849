//! What is said to the worker that has the module.

use phong_studio::protocol::Message;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    fn hear(reply: &str);
    fn take(frame: &[u8]) -> bool;
    pub(crate) fn failed(why: &str);
}

/// Says a message; whether to go on drawing.
pub(crate) fn say(message: Message) -> bool {
    match message {
        Message::Text(text) => {
            hear(&text);
            true
        }
        Message::Frame(bytes) => take(&bytes),
        Message::Nothing => take(&[]),
    }
}
