//! What a reader may use at most, so that no input can exhaust the machine.

/// The largest magnitude of any number in a scene: its square still fits an f32.
pub(crate) const LARGEST: f64 = 1e18;

/// Upper bounds that every reader takes; going over one is an error at its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes that all geometry read may take in memory. Default: no limit but `u64::MAX`; the
    /// program sets it from `--max-memory`. Counts that a file declares are checked against the
    /// file's own length before anything is allocated, whatever this says.
    pub bytes: u64,
    /// Bytes of one text file (TOML, MTL) that is read whole. Default 256 MiB.
    pub text_bytes: u64,
    /// Vertices of one file. Default and maximum `u32::MAX − 1`.
    pub vertices: u64,
    /// Triangles of one file. Default and maximum `u32::MAX − 1`.
    pub triangles: u64,
    /// Includes and groups within one another. Default 32.
    pub nesting: u32,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            bytes: u64::MAX,
            text_bytes: 256 << 20,
            vertices: u64::from(u32::MAX) - 1,
            triangles: u64::from(u32::MAX) - 1,
            nesting: 32,
        }
    }
}
