//! What URIs name: bytes of their own, and files.

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::bytes::Bytes;
use super::json::{At, Result};
use crate::source::{Source, trouble};

/// What a URI names: the bytes that it holds itself, or those of a file, which may be `kept` open.
pub(super) fn load(
    uri: &At<'_>,
    path: &str,
    source: &dyn Source,
    length: u64,
    kept: bool,
) -> Result<Bytes> {
    let text = uri.text()?;
    if let Some(data) = text.strip_prefix("data:") {
        let (kind, data) = data.split_once(',').unwrap_or_default();
        let bytes = if kind.ends_with(";base64") { base64(data) } else { Some(unescaped(data)) };
        return bytes.map(Bytes::Held).ok_or_else(|| uri.fault("it is no base64"));
    }
    let name = unescaped(text);
    let name = String::from_utf8_lossy(&name);
    let folder = path.rfind(['/', '\\']).map_or("", |end| &path[..=end]);
    let file = if name.starts_with('/') { name.into_owned() } else { format!("{folder}{name}") };
    let cannot = |error| uri.fault(format!("`{file}` cannot be read: {}", trouble(&error)));
    let blob = source.open(&file).map_err(cannot)?;
    let length = blob.len().min(length);
    Bytes::of(blob, 0, length, kept).map_err(cannot)
}

/// Text with `%20` and the like as what they stand for.
fn unescaped(text: &str) -> Vec<u8> {
    let hex = |byte: u8| char::from(byte).to_digit(16);
    let mut bytes = text.bytes();
    let mut plain = Vec::with_capacity(text.len());
    while let Some(byte) = bytes.next() {
        let mut ahead = bytes.clone();
        let pair = (ahead.next().and_then(hex), ahead.next().and_then(hex));
        if let (b'%', (Some(high), Some(low))) = (byte, pair) {
            plain.push((16 * high + low) as u8);
            bytes = ahead;
        } else {
            plain.push(byte);
        }
    }
    plain
}

/// The bytes that base64 stands for, of either alphabet, with spaces or without its end; `None`: it is none.
fn base64(text: &str) -> Option<Vec<u8>> {
    let config = GeneralPurposeConfig::new()
        .with_decode_allow_trailing_bits(true)
        .with_decode_padding_mode(DecodePaddingMode::RequireNone);
    let letter = |byte: u8| match byte {
        b'-' => b'+',
        b'_' => b'/',
        other => other,
    };
    let said = text.bytes().filter(|b| !b.is_ascii_whitespace() && *b != b'=');
    let mut letters: Vec<u8> = said.map(letter).collect();
    // One letter alone is no byte; with another it is one too many.
    let is_alone = letters.len() % 4 == 1;
    letters.extend(is_alone.then_some(b'A'));
    let mut bytes = GeneralPurpose::new(&STANDARD, config).decode(letters).ok()?;
    bytes.truncate(bytes.len() - usize::from(is_alone));
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_and_escapes_become_bytes() {
        assert_eq!(base64("TWFu\nTWE=").as_deref(), Some(&b"ManMa"[..]));
        assert_eq!(base64("T").as_deref(), Some(&b""[..]));
        assert_eq!(base64("T*"), None);
        assert_eq!(unescaped("a%20b%C3%a9%2"), "a bé%2".as_bytes());
    }
}
