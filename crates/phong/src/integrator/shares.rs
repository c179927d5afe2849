//! The shares of the light that lights bring, each kept beside the sum of all.
//!
//! They are traced together with the whole: the rays are the same, and so is what each light sends. What a share
//! has not brought is black in it, so that it has the bits of a picture in which all else is dark.

use phong_bvh::lanes;
use phong_scene::Rgb;

use super::bundle::Radiance8;
use super::interactions::Interactions;
use crate::math::lanes::{get, set};
use crate::terms::{Term, Terms8};

/// Which shares are kept beside all light: those of some lights, then perhaps that of none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Shares {
    /// The number of the first light whose share is kept.
    pub(crate) first: u32,
    /// Of how many lights from there on; 0: of none.
    pub(crate) lights: u32,
    /// Whether what no light brings is kept behind those.
    pub(crate) unlit: bool,
}

impl Shares {
    /// None.
    pub(crate) const NONE: Self = Self { first: 0, lights: 0, unlit: false };

    /// How many there are.
    fn len(self) -> usize {
        self.lights as usize + usize::from(self.unlit)
    }

    /// Where a light's share is among them; `None`: it is not kept.
    pub(super) fn place(self, light: usize) -> Option<usize> {
        let place = light.checked_sub(self.first as usize)?;
        (place < self.lights as usize).then_some(place)
    }

    /// Whether the share at this place is of what no light brings.
    pub(super) fn is_unlit(self, place: usize) -> bool {
        place == self.lights as usize
    }

    /// Begins the shares of a bundle with what is there before any light is asked: what rays see of the lights
    /// themselves, and the rest of it in the share of none.
    pub(super) fn begin(
        self,
        interactions: &Interactions,
        all: &[Radiance8],
        to: &mut Vec<Vec<Radiance8>>,
    ) {
        to.resize_with(self.len(), Vec::new);
        for (place, share) in to.iter_mut().enumerate() {
            share.clear();
            if self.is_unlit(place) {
                share.extend_from_slice(all);
            } else {
                share.extend(all.iter().map(|all| Radiance8 { terms: Terms8::NONE, ..*all }));
            }
        }
        if to.is_empty() {
            return;
        }
        for (i, (lamps, all)) in interactions.lamps.iter().zip(all).enumerate() {
            for lane in lanes(lamps.seen) {
                let emission = get(&all.terms[Term::Emission], lane);
                if let Some(place) = self.place(lamps.light[lane] as usize) {
                    set(&mut to[place][i].terms[Term::Emission], lane, emission);
                }
                if let Some(unlit) = to.get_mut(self.lights as usize) {
                    set(&mut unlit[i].terms[Term::Emission], lane, Rgb::BLACK.to_array());
                }
            }
        }
    }
}
