//! Vertices: which property is what, and how rows become positions or spheres.

#![expect(clippy::needless_bitwise_bool, reason = "a branch for each number would cost more")]

use std::array::from_fn;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::header::{Element, Type};
use super::names::{ALPHA, COLOR, FIELD, NAMES, NORMAL, RADIUS, Row, UV, WIDTH};
use crate::color::{Rgb, srgb_decode};
use crate::diagnostic::{Diagnostic, Severity, Span};
use crate::format::input::Input;
use crate::format::text::Findings;
use crate::material::Material;
use crate::mesh::{Field, Mesh, PIECE, Points};

/// Which properties are used, for what.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    /// For every place of a row the property that it comes from.
    pub(super) columns: [Option<usize>; WIDTH],
    /// How colours become linear.
    color: Transfer,
    /// Whether vertices become spheres.
    pub(super) spheres: bool,
    /// The radius of spheres that bring none; 0 if it is to be found yet.
    pub(super) radius: f32,
    /// Subtracted from every position.
    pub(super) origin: DVec3,
    /// Whether damage is a warning where something is left to be drawn.
    pub(super) lenient: bool,
    /// What alpha is where nothing shows through.
    opaque: f64,
    /// Whether any vertex is less than opaque.
    pub(super) transparent: Arc<AtomicBool>,
    /// The properties that maps show, by place from [`FIELD`] on.
    fields: Vec<Arc<str>>,
}

/// How a stored colour becomes linear.
#[derive(Clone, Debug)]
pub(super) enum Transfer {
    /// It is.
    Linear,
    /// sRGB, this many steps: one linear value each.
    Srgb(Box<[f32]>),
}

impl Transfer {
    /// Of colours that are stored in numbers of these kinds; `None`: there are none.
    pub(super) fn of(kinds: [Option<Type>; 3]) -> Self {
        if kinds[0].is_none() || kinds.iter().all(|k| k.is_some_and(Type::is_float)) {
            return Self::Linear;
        }
        let steps = if kinds.contains(&Some(Type::U16)) { 65536 } else { 256 };
        let decode = |i| srgb_decode(f64::from(i) / f64::from(steps - 1)) as f32;
        Self::Srgb((0..steps).map(decode).collect())
    }

    /// The linear colour that three numbers stand for; `None`: they are no colour.
    pub(super) fn linear(&self, stored: &[f64]) -> Option<Rgb> {
        let channel = |i: usize| match self {
            Self::Linear => Some(stored[i] as f32).filter(|c| c.is_finite() && *c >= 0.0),
            Self::Srgb(table) => table_entry(table, stored[i]),
        };
        Some(Rgb::from([channel(0)?, channel(1)?, channel(2)?]))
    }

    /// What its numbers must be, as the end of "is not …".
    pub(super) fn words(&self) -> String {
        match self {
            Self::Linear => "of finite numbers from 0 on".to_owned(),
            Self::Srgb(table) => format!("of whole numbers from 0 to {}", table.len() - 1),
        }
    }
}

impl Plan {
    /// Finds out what the properties are; `None` if `findings` hold an error about them.
    pub(super) fn new(
        element: &Element,
        spheres: bool,
        input: &Input<'_>,
        findings: &mut Findings,
    ) -> Option<Self> {
        let splat = ["f_dc_0", "scale_0", "rot_0"].iter().find_map(|name| element.find(name));
        if let Some(property) = splat {
            let property = &element.properties[property];
            findings.error(
                "Gaussian splats",
                || property.span.clone(),
                || {
                    "the file holds Gaussian splats (it has `".to_owned()
                        + &property.name
                        + "`), which have no surface to shade"
                },
            );
            return None;
        }
        let mut columns: [Option<usize>; WIDTH] =
            from_fn(|place| NAMES[place].iter().find_map(|name| element.find(name)));
        // Half a normal, colour or texture coordinate is none.
        for group in [NORMAL..COLOR, COLOR..UV, UV..ALPHA] {
            if columns[group.clone()].contains(&None) {
                columns[group].fill(None);
            }
        }
        let mut fields = Vec::new();
        for name in input.fields {
            if fields.len() == Field::MOST {
                break;
            }
            // What is drawn anyway may be shown by a map as well.
            if let Some(property) = element.find(name)
                && element.properties[property].list.is_none()
            {
                columns[FIELD + fields.len()] = Some(property);
                fields.push(Arc::from(name.as_str()));
            }
        }
        if spheres {
            // Nothing of a sphere is turned or textured by the file.
            columns[NORMAL..COLOR].fill(None);
            columns[UV..ALPHA].fill(None);
        } else {
            columns[RADIUS] = None;
        }
        for axis in 0..3 {
            if columns[axis].is_none() {
                findings.error(
                    "missing coordinates",
                    || element.span.clone(),
                    || format!("the vertices have no property `{}`", NAMES[axis][0]),
                );
            }
        }
        let kinds = [0, 1, 2].map(|i| columns[COLOR + i].map(|p| element.properties[p].kind));
        let color = Transfer::of(kinds);
        let radius = input.radius.unwrap_or(0.0);
        let opaque = match columns[ALPHA].map(|p| element.properties[p].kind) {
            Some(kind) if kind.is_float() => 1.0,
            Some(Type::U16) => 65535.0,
            _ => 255.0,
        };
        (!findings.any_error()).then_some(Self {
            columns,
            color,
            spheres,
            radius,
            origin: DVec3::ZERO,
            lenient: input.limits.lenient,
            opaque,
            transparent: Arc::default(),
            fields,
        })
    }

    /// What damage is that leaves something to be drawn.
    pub(super) fn damage(&self) -> Severity {
        if self.lenient { Severity::Warning } else { Severity::Error }
    }

    fn has(&self, place: usize) -> bool {
        self.columns[place].is_some()
    }

    /// Bytes that a vertex takes in memory.
    pub(super) fn bytes(&self) -> u64 {
        let position = if self.spheres { 16 } else { 12 };
        let normal = if self.has(NORMAL) { 12 } else { 0 };
        let color = if self.has(COLOR) { 12 } else { 0 };
        let fields = 4 * self.fields.len() as u64;
        position + normal + color + if self.has(UV) { 8 } else { 0 } + fields
    }

    /// What is wrong with a vertex, and what becomes of it; `None`: nothing.
    pub(super) fn blame(&self, row: &Row) -> Option<String> {
        for (place, name) in NAMES.iter().enumerate().take(ALPHA) {
            let stored = row[place];
            let origin = if place < 3 { self.origin[place] } else { 0.0 };
            if self.has(place) && !((stored - origin) as f32).is_finite() {
                let what = if stored.is_nan() { "NaN" } else { "infinite or too large" };
                return Some(format!("its `{}` is {what}; {}", name[0], self.without(place)));
            }
        }
        let radius = row[RADIUS];
        if self.has(RADIUS) && radius as f32 <= 0.0 {
            let without = self.without(RADIUS);
            return Some(format!("its radius is {radius}, but must be above 0; {without}"));
        }
        if !self.has(COLOR) {
            return None;
        }
        let mut colors = row[COLOR..UV].iter();
        let without = self.without(COLOR);
        match &self.color {
            Transfer::Srgb(table) => {
                let wrong = colors.find(|c| table_entry(table, **c).is_none())?;
                let most = table.len() - 1;
                Some(format!("its colour {wrong} is not from 0 to {most}; {without}"))
            }
            Transfer::Linear => {
                let wrong = colors.find(|c| **c < 0.0)?;
                Some(format!("its colour {wrong} is below 0; {without}"))
            }
        }
    }

    /// What becomes of a vertex without its number at a place of the row.
    fn without(&self, place: usize) -> &'static str {
        match place {
            0..NORMAL if self.spheres => "it is left out",
            0..NORMAL => "its faces are left out",
            NORMAL..COLOR => "the geometric normal stands in for its own",
            COLOR..UV => "it is grey",
            _ => "0 stands in for it",
        }
    }

    /// Remembers whether a vertex is less than opaque.
    fn see_alpha(&self, alpha: f64) {
        if alpha != self.opaque {
            self.transparent.store(true, Ordering::Relaxed);
        }
    }
}

/// The linear value of an sRGB step; `None` if it is no step.
fn table_entry(table: &[f32], value: f64) -> Option<f32> {
    // Tables are short, and this is the conversion that processors have.
    let step = value as i32;
    let entry = table.get(usize::try_from(step).ok()?).copied();
    entry.filter(|_| f64::from(step) == value)
}

/// Vertices read so far, in arrays that become a mesh's or a cloud's without a copy.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    positions: Vec<Vec3>,
    spheres: Vec<[f32; 4]>,
    normals: Vec<Vec3>,
    colors: Vec<Rgb>,
    uvs: Vec<Vec2>,
    /// One for each of the plan's.
    fields: [Vec<f32>; Field::MOST],
}

impl Vertices {
    /// `count` vertices to be filled in.
    pub(super) fn zeros(plan: &Plan, count: usize) -> Self {
        let count_if = |wanted: bool| if wanted { count } else { 0 };
        Self {
            positions: vec![Vec3::ZERO; count_if(!plan.spheres)],
            spheres: vec![[0.0; 4]; count_if(plan.spheres)],
            normals: vec![Vec3::ZERO; count_if(plan.has(NORMAL))],
            colors: vec![Rgb::BLACK; count_if(plan.has(COLOR))],
            uvs: vec![Vec2::ZERO; count_if(plan.has(UV))],
            fields: from_fn(|i| vec![0.0; count_if(plan.has(FIELD + i))]),
        }
    }

    /// All of them, to be filled in by parts.
    pub(super) fn rest(&mut self) -> Part<'_> {
        Part {
            positions: &mut self.positions,
            spheres: &mut self.spheres,
            normals: &mut self.normals,
            colors: &mut self.colors,
            uvs: &mut self.uvs,
            fields: self.fields.each_mut().map(Vec::as_mut_slice),
        }
    }

    /// Appends a vertex; what is wrong with it is left out later.
    pub(super) fn push(&mut self, plan: &Plan, row: &Row) {
        if plan.has(ALPHA) {
            plan.see_alpha(row[ALPHA]);
        }
        let xyz = (DVec3::new(row[0], row[1], row[2]) - plan.origin).as_vec3();
        if plan.spheres {
            let radius = if plan.has(RADIUS) { row[RADIUS] as f32 } else { plan.radius };
            self.spheres.push([xyz.x, xyz.y, xyz.z, radius]);
        } else {
            self.positions.push(xyz);
        }
        let three = |at: usize| [row[at] as f32, row[at + 1] as f32, row[at + 2] as f32];
        if plan.has(NORMAL) {
            self.normals.push(Vec3::from(three(NORMAL)));
        }
        if plan.has(COLOR) {
            self.colors.push(Rgb::from(match &plan.color {
                Transfer::Linear => three(COLOR),
                Transfer::Srgb(table) => {
                    [0, 1, 2].map(|i| table_entry(table, row[COLOR + i]).unwrap_or(f32::NAN))
                }
            }));
        }
        if plan.has(UV) {
            self.uvs.push(Vec2::new(row[UV] as f32, row[UV + 1] as f32));
        }
        for (i, values) in self.fields.iter_mut().enumerate().take(plan.fields.len()) {
            values.push(row[FIELD + i] as f32);
        }
    }

    /// Appends those of a later piece.
    pub(super) fn append(&mut self, mut later: Self) {
        self.positions.append(&mut later.positions);
        self.spheres.append(&mut later.spheres);
        self.normals.append(&mut later.normals);
        self.colors.append(&mut later.colors);
        self.uvs.append(&mut later.uvs);
        for (values, later) in self.fields.iter_mut().zip(&mut later.fields) {
            values.append(later);
        }
    }

    /// The vertices of a mesh; some positions may be no numbers.
    pub(super) fn into_mesh(mut self, plan: &Plan) -> Mesh {
        mend_colors(&mut self.colors);
        let fields = named(&plan.fields, self.fields);
        let Self { positions, normals, colors, mut uvs, .. } = self;
        uvs.iter_mut().filter(|uv| !uv.is_finite()).for_each(|uv| *uv = Vec2::ZERO);
        Mesh {
            origin: plan.origin,
            positions: positions.into(),
            normals: normals.into(),
            colors: colors.into(),
            uvs: uvs.into(),
            fields,
            ..Mesh::default()
        }
    }

    /// All spheres, which may have no place or no radius, their colours and fields.
    pub(super) fn into_ends(mut self, plan: &Plan) -> (Vec<[f32; 4]>, Vec<Rgb>, Vec<Field>) {
        mend_colors(&mut self.colors);
        (self.spheres, self.colors, named(&plan.fields, self.fields))
    }

    /// The spheres, without those that have no place or no radius.
    pub(super) fn into_points(mut self, plan: &Plan) -> Points {
        mend_colors(&mut self.colors);
        let radii = plan.has(RADIUS);
        let sound = |&[x, y, z, radius]: &[f32; 4]| {
            let radius = !radii | (radius.is_finite() & (radius > 0.0));
            radius & are_all(&[x, y, z], |c| c.is_finite())
        };
        if !self.spheres.par_chunks(PIECE).all(|piece| are_all(piece, sound)) {
            let mut kept = self.spheres.iter().map(sound);
            self.colors.retain(|_| kept.next().unwrap_or(true));
            for values in &mut self.fields {
                let mut kept = self.spheres.iter().map(sound);
                values.retain(|_| kept.next().unwrap_or(true));
            }
            self.spheres.retain(sound);
        }
        Points {
            origin: plan.origin,
            spheres: self.spheres.into(),
            colors: self.colors.into(),
            fields: named(&plan.fields, self.fields),
            ..Points::default()
        }
    }
}

/// Numbers with their names.
fn named(names: &[Arc<str>], fields: [Vec<f32>; Field::MOST]) -> Vec<Field> {
    let field = |(name, values): (&Arc<str>, Vec<f32>)| Field {
        name: Arc::clone(name),
        values: values.into(),
    };
    names.iter().zip(fields).map(field).collect()
}

/// Makes grey what is no colour.
fn mend_colors(colors: &mut [Rgb]) {
    colors.par_chunks_mut(PIECE).filter(|piece| !are_all(piece, is_color)).for_each(|piece| {
        let wrong = piece.iter_mut().filter(|color| !is_color(color));
        wrong.for_each(|color| *color = Material::default().color);
    });
}

fn is_color(color: &Rgb) -> bool {
    are_all(&color.to_array(), |c| c.is_finite() & (*c >= 0.0))
}

/// Whether all values are `sound`, which is plain arithmetic: without a branch for each.
fn are_all<T>(values: &[T], sound: impl Fn(&T) -> bool) -> bool {
    values.iter().fold(true, |all, value| all & sound(value))
}

/// Vertices to be filled in; what the file has none of is empty.
#[derive(Debug)]
pub(super) struct Part<'a> {
    positions: &'a mut [Vec3],
    spheres: &'a mut [[f32; 4]],
    normals: &'a mut [Vec3],
    colors: &'a mut [Rgb],
    uvs: &'a mut [Vec2],
    fields: [&'a mut [f32]; Field::MOST],
}

impl Part<'_> {
    pub(super) fn len(&self) -> usize {
        self.positions.len().max(self.spheres.len())
    }

    /// Takes the first `count` away.
    pub(super) fn take(&mut self, count: usize) -> Self {
        macro_rules! take {
            ($array:ident) => {{
                let count = count.min(self.$array.len());
                self.$array.split_off_mut(..count).unwrap_or_default()
            }};
        }
        Self {
            positions: take!(positions),
            spheres: take!(spheres),
            normals: take!(normals),
            colors: take!(colors),
            uvs: take!(uvs),
            fields: self.fields.each_mut().map(|all| {
                let count = count.min(all.len());
                let (part, rest) = std::mem::take(all).split_at_mut(count);
                *all = rest;
                part
            }),
        }
    }

    /// Fills everything in, column by column; whether all of it is sound.
    pub(super) fn fill(&mut self, plan: &Plan, columns: &impl Columns) -> bool {
        let mut sound = true;
        for axis in 0..3 {
            let origin = plan.origin[axis];
            let Some(column) = plan.columns[axis] else { continue };
            // One of the two is empty.
            columns.fill(column, self.positions, |p, v| p[axis] = (v - origin) as f32);
            columns.fill(column, self.spheres, |p, v| p[axis] = (v - origin) as f32);
        }
        match plan.columns[RADIUS] {
            Some(column) => columns.fill(column, self.spheres, |p, v| p[3] = v as f32),
            None => self.spheres.iter_mut().for_each(|p| p[3] = plan.radius),
        }
        for i in 0..3 {
            if let Some(column) = plan.columns[NORMAL + i] {
                columns.fill(column, self.normals, |n, v| n[i] = v as f32);
            }
            let Some(column) = plan.columns[COLOR + i] else { continue };
            let channel =
                [|c: &mut Rgb, v| c.r = v, |c: &mut Rgb, v| c.g = v, |c: &mut Rgb, v| c.b = v][i];
            match &plan.color {
                Transfer::Linear => columns.fill(column, self.colors, |c, v| channel(c, v as f32)),
                Transfer::Srgb(table) => columns.fill(column, self.colors, |c, v| {
                    let entry = table_entry(table, v);
                    sound &= entry.is_some();
                    channel(c, entry.unwrap_or(f32::NAN));
                }),
            }
        }
        for i in 0..2 {
            if let Some(column) = plan.columns[UV + i] {
                columns.fill(column, self.uvs, |uv, v| uv[i] = v as f32);
            }
        }
        for (i, values) in self.fields.iter_mut().enumerate() {
            let Some(column) = plan.columns[FIELD + i] else { continue };
            columns.fill(column, values, |value, v| *value = v as f32);
        }
        if let Some(column) = plan.columns[ALPHA] {
            // One of the two is empty.
            columns.fill(column, self.positions, |_, alpha| plan.see_alpha(alpha));
            columns.fill(column, self.spheres, |_, alpha| plan.see_alpha(alpha));
        }
        let radii = plan.has(RADIUS);
        let is_sphere = |p: &[f32; 4]| are_all(p, |c| c.is_finite()) & !(radii & (p[3] <= 0.0));
        sound
            && are_all(self.positions, |p| p.is_finite())
            && are_all(self.spheres, is_sphere)
            && are_all(self.normals, |n| n.is_finite())
            && are_all(self.colors, is_color)
            && are_all(self.uvs, |uv| uv.is_finite())
    }
}

/// Rows of numbers that can be walked column by column.
pub(super) trait Columns {
    /// Calls `set` for every row with the number of that row in `column`.
    fn fill<T>(&self, column: usize, rows: &mut [T], set: impl FnMut(&mut T, f64));
}

/// Says of a row of `element` what is wrong with it: a warning if it does without.
pub(super) fn tell(
    findings: &mut Findings,
    severity: Severity,
    span: impl FnOnce() -> Span,
    element: &str,
    number: u64,
    message: &str,
) {
    let plural = match (element, severity) {
        ("vertex", Severity::Note | Severity::Warning) => "vertices of which something is left out",
        ("vertex", Severity::Error) => "vertices that cannot be read",
        ("edge", Severity::Note | Severity::Warning) => "edges that are left out",
        ("edge", Severity::Error) => "edges that cannot be drawn",
        (_, Severity::Note | Severity::Warning) => "faces that are left out",
        (_, Severity::Error) => "faces that cannot be drawn",
    };
    let left_out = element != "vertex" && severity == Severity::Warning;
    let end = if left_out { "; it is left out" } else { "" };
    let message = || format!("{element} {number} (counted from 0): {message}{end}");
    findings.add(severity, plural, || Diagnostic {
        severity,
        message: message(),
        span: Some(span()),
        ..Diagnostic::default()
    });
}
