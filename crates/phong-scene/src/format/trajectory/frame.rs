//! A frame of a trajectory, and what may be wrong with its file.

use std::io;

use glam::DVec3;

use crate::molecule::Cell;
use crate::source::Blob;

/// Bytes by which files of trajectories are told.
const LOOK: usize = 8;

/// The frame of a trajectory that is read.
#[derive(Debug)]
pub(crate) struct Frame {
    /// The places, in the order of the topology.
    pub(crate) places: Vec<DVec3>,
    /// The cell, if the frame has one.
    pub(crate) cell: Option<Cell>,
    /// How many frames the file has.
    pub(crate) count: u64,
    /// How many it says to have; 0: it does not say it.
    pub(crate) said: u64,
    /// What is wrong behind these.
    pub(crate) broken: Option<String>,
}

/// What is wrong with a file.
#[derive(Debug)]
pub(crate) enum Fault {
    /// It cannot be read.
    Io(io::Error),
    /// It is not what it should be.
    Broken(String),
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// What begins a file.
pub(super) fn head_of(blob: &dyn Blob) -> io::Result<Vec<u8>> {
    let mut head = vec![0; LOOK];
    let read = blob.read_full(&mut head, 0)?;
    head.truncate(read);
    Ok(head)
}
