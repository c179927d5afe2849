//! What finishes a picture after its film, and before it is written.
//!
//! Nothing does so far: the finished picture is the film's. What belongs here is drawn onto a
//! picture (outlines, labels, tone) and is no term: the film is always the sum of its terms.

use crate::film::{Film, LayerKind};

/// How a picture is to be finished. The default leaves it as its film has it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Finishing {
    /// The scene's [`fingerprint`](crate::part::fingerprint()): PNG and EXR files then say which
    /// scene they are of. `None`: they do not.
    pub scene: Option<u32>,
    /// The checksum of all that the picture depends on
    /// ([`Settings::checksum`](crate::part::Settings::checksum)): PNG and EXR files then say which
    /// picture they are ([`picture_of`](crate::image::picture_of)). `None`: they do not.
    pub picture: Option<u32>,
}

impl Finishing {
    /// The same, of the scene with this [`fingerprint`](crate::part::fingerprint()).
    #[must_use]
    pub fn of_scene(self, fingerprint: u32) -> Self {
        Self { scene: Some(fingerprint), ..self }
    }

    /// The same, of the picture with this checksum.
    #[must_use]
    pub fn of_picture(self, checksum: u32) -> Self {
        Self { picture: Some(checksum), ..self }
    }
}

/// A film, and the picture that it is finished to.
#[derive(Clone, Debug)]
pub struct Finished<'a> {
    film: &'a Film,
    scene: Option<u32>,
    picture: Option<u32>,
}

/// Finishes a film's picture.
pub fn finish<'a>(film: &'a Film, finishing: &Finishing) -> Finished<'a> {
    let Finishing { scene, picture } = *finishing;
    Finished { film, scene, picture }
}

impl<'a> Finished<'a> {
    /// The film, as it was rendered.
    pub fn film(&self) -> &'a Film {
        self.film
    }

    /// What a file says of its origin: the program with its version, the scene's fingerprint, and the
    /// picture's checksum.
    pub(crate) fn origin(&self) -> [Option<(&'static str, String)>; 3] {
        let program = concat!("phong ", env!("CARGO_PKG_VERSION")).to_owned();
        let sum = |sum: u32| format!("crc32 {sum:08x}");
        [
            Some(("Software", program)),
            self.scene.map(|scene| ("Scene", sum(scene))),
            self.picture.map(|picture| ("Picture", sum(picture))),
        ]
    }

    /// The values of a layer as they are to be seen; `None` if the film has no such layer.
    pub fn values(&self, kind: LayerKind) -> Option<&'a [f32]> {
        self.film.layer(kind).map(|layer| &*layer.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Window;

    #[test]
    fn a_picture_that_nothing_finishes_is_its_film() {
        let size = [3, 2];
        let mut film = Film::new(size, Window::full(size), 16, &[LayerKind::Picture]);
        film.layers[0].values[4] = 0.25;
        let finished = finish(&film, &Finishing::default());
        assert_eq!(finished.film(), &film);
        assert_eq!(finished.values(LayerKind::Picture), Some(&*film.layers[0].values));
        assert_eq!(finished.values(LayerKind::Alpha), None);
    }
}
