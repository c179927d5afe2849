//! The order of groups: each after those whose instances it holds.

use super::draft::{Draft, DraftShape, Named, say_unknown_name};
use super::notes::Notes;
use super::text::Spot;
use crate::check::MOST_OBJECTS;
use crate::limits::Limits;
use crate::wording::list;

/// Most groups that a message names.
const MOST_NAMED: usize = 8;

/// An instance: the number of its group, and where its name stands.
type Edge = (usize, Spot);

/// The groups' numbers in such an order that each holds instances of earlier ones only; else a
/// cycle has been said, as has a name that there is not, and nesting or numbers that no machine
/// could hold.
pub(super) fn order(
    groups: &Named<Vec<Draft>>,
    drafts: &[Draft],
    limits: &Limits,
    notes: &mut Notes,
) -> Vec<usize> {
    let top = edges(groups, drafts, notes);
    let inside: Vec<_> = groups
        .items
        .iter()
        .map(|(.., drafts)| edges(groups, drafts.as_deref().unwrap_or_default(), notes))
        .collect();

    let mut order = Vec::with_capacity(inside.len());
    let mut state = vec![State::New; inside.len()];
    for start in 0..inside.len() {
        // Depth first without recursion: a chain of groups may be long.
        let mut path = Vec::new();
        if state[start] == State::New {
            state[start] = State::Open;
            path.push((start, 0));
        }
        while let Some((group, next)) = path.last_mut() {
            let group = *group;
            let Some(&(inner, spot)) = inside[group].get(*next) else {
                state[group] = State::Done;
                order.push(group);
                path.pop();
                continue;
            };
            *next += 1;
            match state[inner] {
                State::New => {
                    state[inner] = State::Open;
                    path.push((inner, 0));
                }
                State::Open => {
                    let from = path.iter().position(|&(g, _)| g == inner).unwrap_or(0);
                    let round = path[from..].iter().map(|&(g, _)| groups.items[g].0.as_str());
                    let message = match path.len() - from {
                        1 => "the group holds itself".to_owned(),
                        many if many > MOST_NAMED => {
                            let first = list(round.take(MOST_NAMED), ",");
                            format!("{many} groups hold one another: {first}, …")
                        }
                        _ => format!("groups hold one another: {}", list(round, "and")),
                    };
                    notes.error(spot, message);
                    // Which of them is at fault nobody can say; none is unfolded below.
                    return Vec::new();
                }
                State::Done => {}
            }
        }
    }
    check_size(&order, &inside, groups, (&top, drafts.len()), limits, notes);
    order
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    Open,
    Done,
}

/// The instances among `drafts`; says which groups there are not.
fn edges(groups: &Named<Vec<Draft>>, drafts: &[Draft], notes: &mut Notes) -> Vec<Edge> {
    let mut edges = Vec::new();
    for draft in drafts {
        let DraftShape::Instance(name, spot) = &draft.shape else { continue };
        if let Some(group) = groups.find(name) {
            edges.push((group as usize, *spot));
        } else {
            let known = groups.items.iter().map(|(name, ..)| name.as_str());
            say_unknown_name(notes, "group", name, known, *spot);
        }
    }
    edges
}

/// Says if groups nest too deep, or unfold into too many objects.
fn check_size(
    order: &[usize],
    inside: &[Vec<Edge>],
    groups: &Named<Vec<Draft>>,
    (top, top_count): (&[Edge], usize),
    limits: &Limits,
    notes: &mut Notes,
) {
    let mut depths = vec![1_u32; inside.len()];
    let mut counts = vec![0_u64; inside.len()];
    // The number of objects that `count` of them, some instances, unfold into.
    let unfolded = |counts: &[u64], count: usize, edges: &[Edge]| {
        let plain = (count - edges.len()) as u64;
        edges.iter().fold(plain, |sum, &(group, _)| sum.saturating_add(counts[group]))
    };
    for &group in order {
        let edges = &inside[group];
        let held = groups.items[group].2.as_ref().map_or(0, Vec::len);
        counts[group] = unfolded(&counts, held, edges);
        for &(inner, spot) in edges {
            depths[group] = depths[group].max(depths[inner] + 1);
            if depths[inner] == limits.nesting {
                notes.error(spot, format!("groups go deeper than {}", limits.nesting));
            }
        }
    }
    if let Some(&(_, spot)) = top.first()
        && unfolded(&counts, top_count, top) > MOST_OBJECTS
    {
        let message = format!("the instances unfold into more than {MOST_OBJECTS} objects");
        notes.error(spot, message);
    }
}
