//! Whatever an NFF scene holds, it is read to a sound scene or to errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check_file, spell};

const WORDS: &[&str] = &[
    "\n",
    " ",
    "0",
    "1",
    "-1",
    "0.5",
    "nan",
    "1e39",
    "99999999999",
    "# a\n",
    "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 6\n",
    "v\nfrom 0 0 5\nat 0 0 0\nup 0 0 1\n",
    "b 0 0 1\n",
    "l 1 2 3\n",
    "l 1 2 3 1 0 0\n",
    "f 1 0 0 0.5 0.5 9 0 1\n",
    "f 1 1 1 0 0.5 9 0.5 1.5\n",
    "s 0 0 0 1\n",
    "s 0 0 0 -1\n",
    "c 0 0 0 1 0 1 0 0.5\n",
    "c 0 0 0 1 0 1 0 1\n",
    "p 3 0 0 0 1 0 0 0 1 0\n",
    "p 4 0 0 0 1 0 0 0.2 0.2 0 0 1 0\n",
    "p 2 0 0 0 1 0 0\n",
    "pp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1\n",
    "nff\n",
    "q\n",
];

fuzz_target!(|data: &[u8]| {
    check_file("a.nff", spell(data, WORDS));
});
