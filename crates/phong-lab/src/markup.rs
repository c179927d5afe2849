//! Text and bytes as they may stand in SVG and HTML.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// Words as they may stand in XML and HTML, in quotes too. Control characters, which XML has no way to
/// write, are left out; tabs and line ends stay.
pub(crate) fn escaped(words: &str) -> String {
    let is_written = |c: &char| !matches!(c, '\0'..'\t' | '\x0b' | '\x0c' | '\x0e'..' ' | '\u{fffe}' | '\u{ffff}');
    let words: String = words.chars().filter(is_written).collect();
    words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Bytes as an address that holds them; `mime` says what they are.
pub(crate) fn data_url(mime: &str, bytes: &[u8]) -> String {
    format!("data:{mime};base64,{}", base64(bytes))
}

/// Bytes as text of RFC 4648, padded.
pub(crate) fn base64(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_that_holds_bytes_says_what_they_are() {
        assert_eq!(data_url("image/png", b"foob"), "data:image/png;base64,Zm9vYg==");
    }

    #[test]
    fn words_cannot_end_an_element_or_an_attribute() {
        assert_eq!(escaped("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
    }

    #[test]
    fn characters_that_xml_does_not_have_are_left_out() {
        assert_eq!(escaped("a\u{1}\0b\x0b\x1f\u{ffff}\tc\nÄ"), "ab\tc\nÄ");
    }
}
