//! Where a line crosses the surface of a shape.

use glam::DVec3;

/// The points `o + t · d` for every `t`, in a shape's own space; `o` is near the shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// The point at `t` = 0.
    pub(crate) o: DVec3,
    /// What `t` grows along; of any length, not zero.
    pub(crate) d: DVec3,
}

impl Line {
    /// The point at `t`.
    pub(crate) fn at(&self, t: f64) -> DVec3 {
        self.o + t * self.d
    }
}

/// One crossing of a line and a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    /// Where along the line.
    pub(crate) t: f64,
    /// Which part of the surface, numbered by the shape's file.
    pub(crate) face: u8,
}

/// All crossings of a line and a surface, by growing `t`: at most four, the degree of the torus.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossings {
    list: [Crossing; 4],
    len: usize,
}

impl Crossings {
    /// No crossing.
    pub(crate) const NONE: Self = Self { list: [Crossing { t: 0.0, face: 0 }; 4], len: 0 };

    /// Adds a crossing no nearer than those before it.
    pub(crate) fn push(&mut self, t: f64, face: u8) {
        self.list[self.len] = Crossing { t, face };
        self.len += 1;
    }

    /// The crossings by growing `t`.
    pub(crate) fn as_slice(&self) -> &[Crossing] {
        &self.list[..self.len]
    }

    /// The crossing nearest to `t`.
    pub(crate) fn nearest(&self, t: f64) -> Option<Crossing> {
        let away = |c: &&Crossing| (c.t - t).abs();
        self.as_slice().iter().min_by(|a, b| away(a).total_cmp(&away(b))).copied()
    }
}

impl From<Option<Span>> for Crossings {
    fn from(span: Option<Span>) -> Self {
        let mut crossings = Self::NONE;
        if let Some(Span { enter, leave }) = span {
            crossings.push(enter.t, enter.face);
            crossings.push(leave.t, leave.face);
        }
        crossings
    }
}

/// The part of a line inside a convex body, ends included.
///
/// A body that is the intersection of simpler ones is met in the intersection of their spans. So
/// a ray cannot slip through between a side and a cap: both ends of the span lie on some face,
/// whatever the rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    enter: Crossing,
    leave: Crossing,
}

impl Span {
    /// The whole line: what is inside a body without a surface.
    pub(crate) const WHOLE: Self = Self {
        enter: Crossing { t: f64::NEG_INFINITY, face: 0 },
        leave: Crossing { t: f64::INFINITY, face: 0 },
    };

    /// From `enter` to `leave`, both on the same face.
    pub(crate) const fn new(enter: f64, leave: f64, face: u8) -> Self {
        Self { enter: Crossing { t: enter, face }, leave: Crossing { t: leave, face } }
    }

    /// Inside `low ≤ o + t d ≤ high` of one coordinate; `faces` number the two ends.
    pub(crate) fn slab(o: f64, d: f64, [low, high]: [f64; 2], faces: [u8; 2]) -> Option<Self> {
        if d == 0.0 {
            return (low <= o && o <= high).then_some(Self::WHOLE);
        }
        let at_low = Crossing { t: (low - o) / d, face: faces[0] };
        let at_high = Crossing { t: (high - o) / d, face: faces[1] };
        Some(if d > 0.0 {
            Self { enter: at_low, leave: at_high }
        } else {
            Self { enter: at_high, leave: at_low }
        })
    }

    /// Inside both; touching is inside.
    pub(crate) fn and(self, other: Self) -> Option<Self> {
        let enter = if other.enter.t > self.enter.t { other.enter } else { self.enter };
        let leave = if other.leave.t < self.leave.t { other.leave } else { self.leave };
        (enter.t <= leave.t).then_some(Self { enter, leave })
    }

    /// From where the line first is inside one of the two to where it last is.
    pub(crate) fn or(self, other: Self) -> Self {
        let enter = if other.enter.t < self.enter.t { other.enter } else { self.enter };
        let leave = if other.leave.t > self.leave.t { other.leave } else { self.leave };
        Self { enter, leave }
    }

    /// How far it reaches in `t`.
    pub(crate) fn length(&self) -> f64 {
        self.leave.t - self.enter.t
    }

    /// Its two ends.
    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.enter.t, self.leave.t]
    }
}

/// The roots of `a t² + 2 b t + c`, the lesser first, given `discriminant` = b² − a c; none where it
/// is negative. a ≠ 0.
///
/// Of `(−b ± √(b² − ac)) / a` one root subtracts nearly equal numbers when a is small. With
/// `q = −b ∓ √(b² − ac)`, the sign that adds, the roots are `q / a` and `c / q`: neither does.
pub(crate) fn quadratic(a: f64, b: f64, c: f64, discriminant: f64) -> Option<[f64; 2]> {
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let q = if b > 0.0 { -b - root } else { -b + root };
    if q == 0.0 {
        return Some([0.0, 0.0]);
    }
    let (s, t) = (q / a, c / q);
    Some([s.min(t), s.max(t)])
}
