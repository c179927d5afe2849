//! The MTL files that an OBJ file names.

use std::collections::{BTreeMap, BTreeSet};

use crate::diagnostic::{Diagnostic, Span};
use crate::format::input::Input;
use crate::format::mtl::{Images, Library, locate};
use crate::format::text::Findings;
use crate::material::Material;
use crate::texture::Texture;

/// The MTL files that are read; of materials of one name, the first counts.
pub(super) struct Libraries<'a> {
    all: Vec<Library>,
    /// What their materials take from images.
    images: Images<'a>,
    /// The first of them that defines a material of this name.
    first: BTreeMap<String, usize>,
}

impl<'a> Libraries<'a> {
    /// Reads all files behind `mtllib`.
    ///
    /// A name may hold blanks, and one statement may name several files: the whole is tried as one
    /// name, then as names that end in `.mtl`, then as words. Back-slashes are slashes. What is not
    /// found where it is said to be may lie beside the OBJ file: exporters write the paths of the
    /// machine they ran on.
    pub(super) fn read(
        statements: Vec<(String, Span)>,
        input: &Input<'a>,
        findings: &mut Findings,
        told: &mut Vec<Diagnostic>,
    ) -> Self {
        let Input { path, source, limits, .. } = *input;
        let images = Images::new(source, limits);
        let mut libraries = Self { all: Vec::new(), images, first: BTreeMap::new() };
        let mut read = BTreeSet::new();
        for (names, span) in statements {
            for choice in
                [vec![names.clone()], split_at_extensions(&names), split_at_blanks(&names)]
            {
                let found: Vec<_> = choice.iter().map(|name| locate(name, path, source)).collect();
                let last_choice = choice.iter().all(|name| !name.contains(char::is_whitespace));
                if found.iter().any(Option::is_none) && !last_choice {
                    continue;
                }
                for (name, at) in choice.iter().zip(found) {
                    match at {
                        Some(at) if read.contains(&at) => {}
                        Some(at) => {
                            libraries.all.extend(Library::read(&at, source, limits, told));
                            read.insert(at);
                        }
                        None => {
                            // Of a name with blanks, the words say nothing.
                            let whole = choice.len() > 1 && !name.contains('.');
                            let name = if whole { &names } else { name };
                            findings.warning(
                                "material files that are not there",
                                || span.clone(),
                                || format!("there is no material file `{name}`"),
                            );
                        }
                    }
                }
                break;
            }
        }
        for (number, library) in libraries.all.iter().enumerate() {
            for name in library.names() {
                libraries.first.entry(name.clone()).or_insert(number);
            }
        }
        libraries
    }

    /// The material of this name; `None`: no file defines it.
    pub(super) fn material(&mut self, name: &str) -> Option<Material> {
        self.all[*self.first.get(name)?].material(name, &mut self.images)
    }

    /// The textures of the materials that were asked for.
    pub(super) fn textures(&mut self) -> Vec<Texture> {
        std::mem::take(&mut self.images.textures)
    }

    /// Everything there is to say about the materials that were asked for.
    pub(super) fn tell(self, out: &mut Vec<Diagnostic>) {
        self.all.into_iter().for_each(|library| library.tell(out));
    }
}

fn split_at_blanks(names: &str) -> Vec<String> {
    names.split_whitespace().map(str::to_owned).collect()
}

/// `a b.mtl c.mtl` is `a b.mtl` and `c.mtl`.
fn split_at_extensions(names: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut start = 0;
    let mut from = 0;
    let lower = names.to_ascii_lowercase();
    while let Some(at) = lower[from..].find(".mtl") {
        from += at + 4;
        if names[from..].chars().next().is_none_or(char::is_whitespace) {
            found.push(names[start..from].trim().to_owned());
            start = from;
        }
    }
    if !names[start..].trim().is_empty() {
        found.push(names[start..].trim().to_owned());
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_statement_may_name_several_files_with_blanks_in_their_names() {
        assert_eq!(split_at_extensions("a b.mtl c.MTL"), ["a b.mtl", "c.MTL"]);
        assert_eq!(split_at_extensions("a.mtl.mtl d"), ["a.mtl.mtl", "d"]);
        assert_eq!(split_at_extensions(""), [""; 0]);
    }
}
