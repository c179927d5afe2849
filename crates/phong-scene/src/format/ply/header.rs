//! The header: which elements follow, how many, and what each is made of.

use std::io;
use std::sync::Arc;

use super::names::is_used;
use crate::diagnostic::Span;
use crate::format::text::{Cursor, Decimal, Findings, Piece, name_of, whole};
use crate::source::Blob;

/// Bytes that a header may take.
const LONGEST: usize = 1 << 20;

/// How the body is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The type of a number in the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            // As pyntcloud writes what is true or false.
            b"uchar" | b"uint8" | b"bool" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary body.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }
}

/// One number, or a list of them, in every row of an element.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    /// The type of the count that precedes a list; `None`: a single number.
    pub(super) list: Option<Type>,
    /// The type of the number, or of a list's.
    pub(super) kind: Type,
    pub(super) span: Span,
}

/// Rows of one make.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    pub(super) span: Span,
}

impl Element {
    /// Bytes of a row in a binary body; `None` if it holds a list, whose length varies.
    pub(super) fn stride(&self) -> Option<usize> {
        self.properties.iter().map(|p| p.list.is_none().then_some(p.kind.size())).sum()
    }

    /// The fewest bytes that a row may take.
    pub(super) fn least(&self, encoding: Encoding) -> u64 {
        let least = |p: &Property| match encoding {
            // A digit, and a blank or the line's end.
            Encoding::Ascii => 2,
            Encoding::Little | Encoding::Big => p.list.unwrap_or(p.kind).size() as u64,
        };
        self.properties.iter().map(least).sum()
    }

    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|p| p.name == name && p.list.is_none())
    }
}

/// What a header says.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// The names of images, and where they stand.
    pub(super) textures: Vec<(String, Span)>,
    /// Where the body begins: bytes into the file, and its first line.
    pub(super) body: u64,
    pub(super) line: u64,
}

impl Header {
    /// Reads the header; `None` if `findings` hold an error about it.
    ///
    /// # Errors
    /// What the blob says.
    pub(super) fn read(
        blob: &dyn Blob,
        file: &Arc<str>,
        findings: &mut Findings,
    ) -> io::Result<Option<Self>> {
        let mut text = vec![0; (4 << 10).min(blob.len() as usize).max(4)];
        let mut filled = 0;
        let end = loop {
            filled += blob.read_full(&mut text[filled..], filled as u64)?;
            text.truncate(filled);
            if !text.starts_with(b"ply") || text.get(3).is_some_and(|b| *b > b' ') {
                let message = "is no PLY file: it does not begin with `ply`".to_owned();
                findings.error("files of another kind", || whole(file), || message);
                return Ok(None);
            }
            // Classic Mac OS ended lines with carriage returns, and some writers end them with
            // both; which it is must be known, because binary data may begin with any byte.
            let end = if text.get(3) == Some(&b'\r') && text.get(4) != Some(&b'\n') {
                b'\r'
            } else {
                b'\n'
            };
            if let Some(end) = header_end(&text, end) {
                break end;
            }
            if filled >= LONGEST || filled as u64 >= blob.len() {
                let message = "the header does not end: there is no `end_header`".to_owned();
                findings.error("headers without an end", || whole(file), || message);
                return Ok(None);
            }
            text.resize((2 * filled).min(LONGEST), 0);
        };
        text.truncate(end);
        if text[3] == b'\r' && text.get(4) != Some(&b'\n') {
            text.iter_mut().filter(|b| **b == b'\r').for_each(|b| *b = b'\n');
        }
        Ok(parse(&text, file, findings))
    }
}

/// Just behind the line that says `end_header`.
fn header_end(text: &[u8], line_end: u8) -> Option<usize> {
    let mut start = 0;
    while let Some(length) = text[start..].iter().position(|&b| b == line_end) {
        let line = &text[start..start + length];
        start += length + 1;
        if line.trim_ascii() == b"end_header" {
            return Some(start);
        }
    }
    None
}

fn parse(text: &[u8], file: &Arc<str>, findings: &mut Findings) -> Option<Header> {
    let piece = Piece { text, offset: 0, line: 1, rows: 0 };
    let mut cursor = Cursor::new(piece, false);
    let mut parser =
        Parser { file, findings, encoding: None, elements: Vec::new(), textures: Vec::new() };
    cursor.next_line();
    while !cursor.is_done() {
        parser.line(&mut cursor);
        cursor.next_line();
    }
    let Parser { findings, encoding, elements, textures, .. } = parser;
    if encoding.is_none() {
        findings.error(
            "headers without a format",
            || whole(file),
            || "the header has no `format` statement".to_owned(),
        );
    }
    let (body, line) = (text.len() as u64, cursor.line);
    let encoding = encoding.filter(|_| !findings.any_error())?;
    Some(Header { encoding, elements, textures, body, line })
}

struct Parser<'a> {
    file: &'a Arc<str>,
    findings: &'a mut Findings,
    encoding: Option<Encoding>,
    elements: Vec<Element>,
    textures: Vec<(String, Span)>,
}

impl Parser<'_> {
    fn line(&mut self, cursor: &mut Cursor<'_>) {
        let here = cursor.clone();
        match cursor.word() {
            b"" | b"obj_info" | b"end_header" => {}
            b"comment" => {
                if cursor.more() && cursor.rest().starts_with(b"TextureFile") {
                    cursor.word();
                    let name = name_of(cursor.rest_of_line());
                    self.textures.push((name, here.here(self.file)));
                }
            }
            b"format" => self.format(cursor),
            b"element" => self.element(cursor, &here),
            b"property" => self.property(cursor),
            // Old versions of Blender sign the header without saying that it is a comment.
            _ => {
                let quoted = here.quote();
                self.findings.warning(
                    "lines in the header that are not known",
                    || here.here(self.file),
                    || format!("`{quoted}` is no statement of a PLY header: the line is ignored"),
                );
            }
        }
    }

    fn format(&mut self, cursor: &mut Cursor<'_>) {
        cursor.more();
        let here = cursor.clone();
        self.encoding = match cursor.word() {
            b"ascii" => Some(Encoding::Ascii),
            b"binary_little_endian" => Some(Encoding::Little),
            b"binary_big_endian" => Some(Encoding::Big),
            _ => {
                self.error(&here, |word| {
                    format!("there is no format `{word}`: it is `ascii`, `binary_little_endian` or `binary_big_endian`")
                });
                return;
            }
        };
        cursor.more();
        let here = cursor.clone();
        if cursor.word() != b"1.0" {
            self.error(&here, |word| format!("version `{word}` is not known, only 1.0 is"));
        }
    }

    fn element(&mut self, cursor: &mut Cursor<'_>, start: &Cursor<'_>) {
        let name = name_of(cursor.word());
        cursor.more();
        let here = cursor.clone();
        let count = cursor.decimal().and_then(Decimal::to_integer);
        let count = count.and_then(|n| u64::try_from(n).ok());
        if count.is_none() {
            self.error(&here, |word| format!("`{word}` is no number of elements"));
        }
        if self.elements.iter().any(|e| e.name == name) {
            self.error(start, |_| format!("there is an element `{name}` already"));
        }
        let span = start.here(self.file);
        let count = count.unwrap_or(0);
        self.elements.push(Element { name, count, properties: Vec::new(), span });
    }

    fn property(&mut self, cursor: &mut Cursor<'_>) {
        cursor.more();
        let here = cursor.clone();
        let list = if cursor.word() == b"list" {
            let Some(list) = self.kind(cursor) else { return };
            if list.is_float() {
                self.error(&here, |_| "the length of a list must be an integer".to_owned());
            }
            Some(list)
        } else {
            *cursor = here;
            None
        };
        if let Some(kind) = self.kind(cursor) {
            self.push(cursor, list, kind);
        }
    }

    fn push(&mut self, cursor: &mut Cursor<'_>, list: Option<Type>, kind: Type) {
        cursor.more();
        let here = cursor.clone();
        let name = name_of(cursor.word());
        let span = here.here(self.file);
        let Some(element) = self.elements.last_mut() else {
            self.error(&here, |word| format!("the property `{word}` belongs to no element"));
            return;
        };
        if name.is_empty() {
            self.error(&here, |_| "the property has no name".to_owned());
        } else if is_used(&name) && element.properties.iter().any(|p| p.name == name) {
            self.error(&here, |word| format!("there is a property `{word}` already"));
        } else {
            element.properties.push(Property { name, list, kind, span });
        }
    }

    fn kind(&mut self, cursor: &mut Cursor<'_>) -> Option<Type> {
        cursor.more();
        let here = cursor.clone();
        let kind = Type::from_name(cursor.word());
        if kind.is_none() {
            self.error(&here, |word| format!("there is no type `{word}`"));
        }
        kind
    }

    fn error(&mut self, at: &Cursor<'_>, tell: impl FnOnce(String) -> String) {
        self.findings.error("errors in the header", || at.here(self.file), || tell(at.quote()));
    }
}
