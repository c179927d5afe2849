//! Whatever an OFF file holds, it is read to a sound scene or to errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check_file, spell};

const WORDS: &[&str] = &[
    "\n",
    " ",
    "\r\n",
    "\t",
    "0",
    "1",
    "2",
    "3",
    "-1",
    "0.5",
    "255",
    "nan",
    "1e39",
    "16777217",
    "#",
    "# a\n",
    "OFF\n",
    "COFF\n",
    "NOFF\n",
    "STCNOFF\n",
    "4OFF\n",
    "OFF BINARY\n",
    "OFF4 2 0\n",
    "4 2 0\n",
    "3 1\n",
    "3 0 0\n",
    "99999999999",
    "0 0 0\n",
    "1 0 0\n",
    "0 1 0\n",
    "1 1 0\n",
    "nan 0 0\n",
    "0 0 0 255 0 0 255\n",
    "0 0 0 0 0 1 0.5 0 0 1 0 1\n",
    "3 0 1 2\n",
    "3 1 3 2 255 0 0\n",
    "4 0 1 3 2 0.5 0 0 0.5\n",
    "3 0 1 2 7\n",
    "2 0 1\n",
    "?",
];

fuzz_target!(|data: &[u8]| {
    let Some((first, rest)) = data.split_first() else { return };
    let mut file = spell(rest, WORDS);
    let words = ["OFF\n", "COFF\n4 2 0\n", "NOFF\n3 1 0\n", "STCNOFF\n3 1 0\n", "OFF\n4 2 0\n"];
    if let Some(word) = words.get(usize::from(first % 6)) {
        file.splice(0..0, word.bytes());
    }
    check_file("a.off", file);
});
