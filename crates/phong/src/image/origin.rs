//! What a file of ours says it is of.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use super::Format;

/// The chunk that ends every PNG, without its length.
const END: &[u8; 8] = b"IEND\xae\x42\x60\x82";

/// The checksum of all that a picture depends on, as its file says it
/// ([`Finishing::picture`](crate::finish::Finishing::picture)); `None`: it says none, is cut short, or
/// is no PNG and no EXR.
///
/// # Errors
/// What the system says of the file, also that there is none.
pub fn picture_of(path: &Path) -> io::Result<Option<u32>> {
    let mut file = BufReader::new(File::open(path)?);
    let said = match Format::of_path(path) {
        Some(Format::Png) => of_png(&mut file),
        #[cfg(feature = "exr")]
        Some(Format::Exr) => super::exr::said(&mut file, "picture"),
        _ => None,
    };
    let sum = said.as_deref().and_then(|said| said.strip_prefix("crc32 "));
    Ok(sum.and_then(|sum| u32::from_str_radix(sum, 16).ok()))
}

fn of_png(file: &mut BufReader<File>) -> Option<String> {
    file.seek(SeekFrom::End(-8)).ok()?;
    let mut end = [0; 8];
    file.read_exact(&mut end).ok()?;
    file.rewind().ok()?;
    if end != *END {
        return None;
    }
    let reader = png::Decoder::new(file).read_info().ok()?;
    let texts = &reader.info().uncompressed_latin1_text;
    texts.iter().find(|said| said.keyword == "Picture").map(|said| said.text.clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{Film, LayerKind, Window};
    use crate::finish::{Finishing, finish};
    use crate::image::{Encoding, save};

    #[test]
    fn a_file_says_which_picture_it_is_unless_it_is_cut_short() {
        let folder = tempfile::tempdir().unwrap();
        let film = Film::new([5, 4], Window::full([5, 4]), 16, &[LayerKind::Picture]);
        for (name, expected) in [("a.png", Some(0xbeef)), ("a.exr", Some(0xbeef)), ("a.pfm", None)]
        {
            let path = folder.path().join(name);
            let finishing = Finishing::default().of_picture(0xbeef);
            save(&finish(&film, &finishing), &path, &Encoding::default()).unwrap();
            assert_eq!(picture_of(&path).unwrap(), expected, "{name}");
            save(&finish(&film, &Finishing::default()), &path, &Encoding::default()).unwrap();
            assert_eq!(picture_of(&path).unwrap(), None, "{name}");
        }
        let path = folder.path().join("b.png");
        save(&finish(&film, &Finishing::default().of_picture(7)), &path, &Encoding::default())
            .unwrap();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 3]).unwrap();
        assert_eq!(picture_of(&path).unwrap(), None);
        assert!(picture_of(&folder.path().join("none.png")).is_err());
    }
}
