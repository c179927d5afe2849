//! Where the frames of a trajectory begin and end: found by reading it once, line by line, in bounded
//! memory.

use std::io;
use std::ops::Range;

use crate::format::lammps::is_dump;
use crate::format::table::Format;
use crate::format::trajectory::{Sections, sections};
use crate::source::Blob;

/// Bytes that are read at a time.
const PIECE: usize = 1 << 20;

/// Bytes of a line that are looked at.
const LOOK: usize = 256;

/// A run of whole lines of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Section {
    /// The first byte, and the first behind it.
    pub(super) start: u64,
    pub(super) end: u64,
    /// The number of the first line, from 1.
    pub(super) line: u64,
    /// How many lines there are.
    pub(super) lines: u64,
}

/// What is wrong with a frame, so that the next cannot be found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Broken {
    /// The frame's number, from 0.
    pub(super) frame: u64,
    /// The number of the line, from 1; 0 if there are none.
    pub(super) line: u64,
    pub(super) message: String,
}

/// What stands before all frames and behind them, and belongs to each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Around {
    pub(super) head: Option<Section>,
    pub(super) tail: Option<Section>,
    /// The first frame, where others are told by it.
    pub(super) first: Option<Section>,
}

/// Finds the frames of a file, and hands them over in order, until `take` says `false`. A file that is no
/// trajectory has one frame or none.
pub(super) fn scan(
    format: Format,
    blob: &dyn Blob,
    take: &mut dyn FnMut(Section) -> bool,
) -> io::Result<Result<Around, Broken>> {
    let mut lines = Lines::new(blob);
    match format {
        Format::Xyz => counted(&mut lines, false, take),
        Format::Gro => counted(&mut lines, true, take),
        Format::Pdb => models(&mut lines, take),
        Format::Lammps => time_steps(&mut lines, take),
        Format::Trajectory => of_trajectory(blob, take),
        _ => Ok(Ok(Around::default())),
    }
}

/// Frames that begin with how many atoms they have: of an XYZ file behind the count a comment and the
/// atoms, of a GRO file a title before it, and behind it the atoms and the box.
fn counted(
    lines: &mut Lines<'_>,
    titled: bool,
    take: &mut dyn FnMut(Section) -> bool,
) -> io::Result<Result<Around, Broken>> {
    for frame in 0.. {
        let mut first = lines.next()?;
        while first.is_some() && lines.is_blank() && !(titled && lines.counts_next()?) {
            first = lines.next()?;
        }
        let Some(mut section) = first else { break };
        let there = !titled || lines.read_into(&mut section)?;
        let Some(count) = lines.count().filter(|_| there) else {
            if frame == 0 {
                // Plain points, or nothing that is known: the reader says it.
                break;
            }
            let line = section.line + section.lines - 1;
            let message = if titled {
                "this is not how many atoms the frame has, as its second line must be"
            } else {
                "this is not how many atoms the frame has; perhaps the one before has not as many as it says"
            };
            return Ok(Err(Broken { frame, line, message: message.to_owned() }));
        };
        // A box behind the atoms, or a comment before them.
        let mut rest = if titled { count.saturating_add(1) } else { count };
        let mut more = titled || lines.read_into(&mut section)?;
        while more && rest > 0 {
            more = lines.read_into(&mut section)?;
            // Lines of an XYZ file may be blank, and do not count then.
            rest -= u64::from(titled || !lines.is_blank());
        }
        if !take(section) {
            break;
        }
    }
    Ok(Ok(Around::default()))
}

/// Models between `MODEL` and `ENDMDL`, or, without these, up to an `END` each.
fn models(
    lines: &mut Lines<'_>,
    take: &mut dyn FnMut(Section) -> bool,
) -> io::Result<Result<Around, Broken>> {
    let mut around = Around::default();
    let (mut model, mut between) = (None::<Section>, Section::default());
    let (mut any, mut atoms, mut wanted) = (false, false, true);
    while let Some(line) = lines.next()? {
        let record = lines.record();
        if record == b"MODEL" {
            if let Some(unended) = model.take() {
                wanted = wanted && take(unended);
            } else if !any {
                around.head = (between.lines > 0).then_some(between);
            }
            (any, model) = (true, Some(line));
            continue;
        }
        match &mut model {
            Some(model) => model.add(line),
            None if between.lines == 0 => between = line,
            None => between.add(line),
        }
        atoms |= matches!(record, b"ATOM" | b"HETATM");
        if record == b"ENDMDL"
            && let Some(whole) = model.take()
        {
            wanted = wanted && take(whole);
            between = Section::default();
        } else if record == b"END" && !any && atoms {
            wanted = wanted && take(between);
            (between, atoms) = (Section::default(), false);
        }
        if !wanted && !any {
            return Ok(Ok(Around::default()));
        }
    }
    if let Some(unended) = model {
        let _ = wanted && take(unended);
    } else if any {
        around.tail = (between.lines > 0).then_some(between);
    } else if atoms {
        let _ = wanted && take(between);
    }
    Ok(Ok(if any { around } else { Around::default() }))
}

/// Time steps of a dump: from the first `ITEM:` behind a table of atoms to the next.
fn time_steps(
    lines: &mut Lines<'_>,
    take: &mut dyn FnMut(Section) -> bool,
) -> io::Result<Result<Around, Broken>> {
    let (mut step, mut atoms) = (None::<Section>, false);
    while let Some(line) = lines.next()? {
        if step.is_none() && !is_dump(&lines.text) {
            // A data file, which has no frames.
            return Ok(Ok(Around::default()));
        }
        let is_item = lines.text.starts_with(b"ITEM: ");
        if is_item && atoms {
            if step.take().is_some_and(|step| !take(step)) {
                return Ok(Ok(Around::default()));
            }
            atoms = false;
        }
        atoms |= is_item && lines.text.starts_with(b"ITEM: ATOMS");
        match &mut step {
            Some(step) => step.add(line),
            None => step = Some(line),
        }
    }
    let _ = step.is_some_and(take);
    Ok(Ok(Around::default()))
}

/// Frames of binary files, which have no lines.
fn of_trajectory(
    blob: &dyn Blob,
    take: &mut dyn FnMut(Section) -> bool,
) -> io::Result<Result<Around, Broken>> {
    let bytes =
        |range: Range<u64>| Section { start: range.start, end: range.end, line: 0, lines: 0 };
    let found = sections(blob, &mut |range| take(bytes(range)))?;
    let around = |found: Sections| Around {
        head: found.head.map(bytes),
        tail: None,
        first: found.first.map(bytes),
    };
    Ok(found.map(around).map_err(|(frame, message)| Broken { frame, line: 0, message }))
}

impl Section {
    /// The section with what follows it.
    fn add(&mut self, more: Self) {
        self.end = more.end;
        self.lines += more.lines;
    }
}

/// The lines of a file, one after another.
struct Lines<'a> {
    blob: &'a dyn Blob,
    /// Where in the file the buffer begins.
    base: u64,
    buffer: Vec<u8>,
    at: usize,
    /// How many lines were gone to.
    number: u64,
    /// The beginning of the last of them.
    text: Vec<u8>,
}

impl<'a> Lines<'a> {
    fn new(blob: &'a dyn Blob) -> Self {
        let text = Vec::with_capacity(LOOK);
        Self { blob, base: 0, buffer: Vec::new(), at: 0, number: 0, text }
    }

    /// Goes to the next line, if there is one.
    fn next(&mut self) -> io::Result<Option<Section>> {
        let start = self.base + self.at as u64;
        self.text.clear();
        let mut ended = false;
        while !ended && self.fill()? {
            let rest = &self.buffer[self.at..];
            let length = rest.iter().position(|b| *b == b'\n');
            let text = &rest[..length.unwrap_or(rest.len())];
            self.text.extend_from_slice(&text[..text.len().min(LOOK - self.text.len())]);
            self.at += length.map_or(rest.len(), |length| length + 1);
            ended = length.is_some();
        }
        let end = self.base + self.at as u64;
        if end == start {
            return Ok(None);
        }
        self.number += 1;
        Ok(Some(Section { start, end, line: self.number, lines: 1 }))
    }

    /// Goes to the next line, and adds it to a section; whether there is one.
    fn read_into(&mut self, section: &mut Section) -> io::Result<bool> {
        let line = self.next()?;
        if let Some(line) = line {
            section.add(line);
        }
        Ok(line.is_some())
    }

    fn is_blank(&self) -> bool {
        self.text.trim_ascii().is_empty()
    }

    /// The number of atoms that the line says, if it says nothing else.
    fn count(&self) -> Option<u64> {
        str::from_utf8(self.text.trim_ascii()).ok()?.parse().ok()
    }

    /// The name of a PDB record.
    fn record(&self) -> &[u8] {
        self.text[..self.text.len().min(6)].trim_ascii()
    }

    /// Whether the next line is a count.
    fn counts_next(&mut self) -> io::Result<bool> {
        let start = self.base + self.at as u64;
        let mut head = [0; 32];
        let read = self.blob.read_full(&mut head, start)?;
        let line = head[..read].split(|b| *b == b'\n').next().unwrap_or_default();
        let number = str::from_utf8(line.trim_ascii()).ok();
        Ok(number.is_some_and(|number| number.parse::<u64>().is_ok()))
    }

    /// Reads on where all is used; whether there is anything.
    fn fill(&mut self) -> io::Result<bool> {
        if self.at == self.buffer.len() {
            self.base += self.at as u64;
            self.at = 0;
            self.buffer.resize(PIECE, 0);
            let read = self.blob.read_full(&mut self.buffer, self.base)?;
            self.buffer.truncate(read);
        }
        Ok(self.at < self.buffer.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Memory, Source};

    /// The text of every frame with the number of its first line, and what is around them.
    fn frames(format: Format, text: &str) -> (Vec<(u64, String)>, Result<Around, Broken>) {
        let blob = Memory::new().with("a", text.as_bytes()).open("a").expect("memory");
        let mut all = Vec::new();
        let around = scan(format, &*blob, &mut |section| {
            let text = &text[section.start as usize..section.end as usize];
            assert_eq!(section.lines as usize, text.lines().count(), "{text}");
            all.push((section.line, text.to_owned()));
            true
        });
        (all, around.expect("memory"))
    }

    #[test]
    fn an_xyz_file_has_a_frame_for_each_count() {
        let (all, _) = frames(Format::Xyz, "\n1\nfirst\nH 0 0 0\n2\n\nH 0 0 0\n\nH 1 0 0\n");
        assert_eq!(all[0], (2, "1\nfirst\nH 0 0 0\n".to_owned()));
        assert_eq!(all[1], (5, "2\n\nH 0 0 0\n\nH 1 0 0\n".to_owned()));
        assert_eq!(frames(Format::Xyz, "0 0 0\n1 1 1\n").0, [], "points have no frames");
        let (all, around) = frames(Format::Xyz, "1\n\nH 0 0 0\n1\n\nH 0 0 0\nH 0 0 1\n");
        let broken = around.expect_err("one atom too many");
        assert_eq!((all.len(), broken.frame, broken.line), (2, 2, 7));
    }

    #[test]
    fn a_gro_file_has_a_title_a_count_and_a_box_for_each_frame() {
        let atom = "    1SOL     OW    1   0.1   0.1   0.1\n";
        let frame = |title: &str| format!("{title}\n1\n{atom}1 1 1\n");
        let text = [frame("t= 0"), frame(""), frame("t= 2")].concat() + "\n\n";
        let (all, _) = frames(Format::Gro, &text);
        assert_eq!(all, [(1, frame("t= 0")), (5, frame("")), (9, frame("t= 2"))]);
    }

    #[test]
    fn models_share_what_is_before_and_behind_them() {
        let model = |n: u32| format!("MODEL        {n}\nATOM  {n}\nENDMDL\n");
        let text = format!("CRYST1\n{}{}CONECT    1\nEND\n", model(1), model(2));
        let (all, around) = frames(Format::Pdb, &text);
        assert_eq!(all, [(2, model(1)), (5, model(2))]);
        let around = around.expect("no fault");
        assert_eq!(around.head.map(|head| (head.line, head.lines)), Some((1, 1)));
        assert_eq!(around.tail.map(|tail| (tail.line, tail.lines)), Some((8, 2)));
        let (all, around) = frames(Format::Pdb, "CRYST1\nATOM  1\nEND\nATOM  1\nEND\n");
        assert_eq!(all, [(1, "CRYST1\nATOM  1\nEND\n".into()), (4, "ATOM  1\nEND\n".into())]);
        assert_eq!(around, Ok(Around::default()));
    }

    #[test]
    fn a_time_step_begins_at_the_first_item_behind_the_atoms() {
        let step = |n: u32| format!("ITEM: TIMESTEP\n{n}\nITEM: ATOMS x y z\n{n} 0 0\n");
        let text = format!("ITEM: UNITS\nlj\n{}ITEM: TIME\n7\n{}", step(1), step(2));
        let (all, _) = frames(Format::Lammps, &text);
        assert_eq!(all[0], (1, format!("ITEM: UNITS\nlj\n{}", step(1))));
        assert_eq!(all[1], (7, format!("ITEM: TIME\n7\n{}", step(2))));
        assert_eq!(frames(Format::Lammps, "LAMMPS data\n\n3 atoms\n").0, []);
    }

    #[test]
    fn lines_longer_than_a_piece_are_lines() {
        let comment = "x".repeat(3 * PIECE);
        let text = format!("1\n{comment}\nH 0 0 0\n1\n{comment}\nH 0 0 0");
        let (all, around) = frames(Format::Xyz, &text);
        assert_eq!((all.len(), all[1].0, around), (2, 4, Ok(Around::default())));
    }
}
