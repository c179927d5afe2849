//! From parameters to files: names that say something, and a table of all pictures.

use std::fs;
use std::io;
use std::path::Path;

use phong_scene::{Change, trouble};
use serde_json::{Map, Value, json};

use super::{CONTENT, Picture, Tasks};
use crate::failure::Failure;
use crate::output::Output;

/// Calls the files of a picture of this content by its name as well.
pub(crate) fn link(tasks: &Tasks, picture: &Picture, digest: &str) -> Result<(), Failure> {
    let ending = tasks.format.extension();
    let stem = picture.name.trim_end_matches(ending);
    let folder = tasks.output.join(CONTENT);
    let failed = |path: &Path, error: &io::Error| {
        Failure::System(format!("cannot write {}: {}", path.display(), trouble(error)))
    };
    let mut files = vec![format!("{digest}.{ending}")];
    if tasks.options.iter().any(|word| word.starts_with("--terms") || word.starts_with("--aov")) {
        // Layers of a PNG are files beside it: DIGEST.TERM.png.
        let entries = fs::read_dir(&folder).map_err(|error| failed(&folder, &error))?;
        files = entries.flatten().filter_map(|e| e.file_name().into_string().ok()).collect();
    }
    for file in files {
        let layer = file.strip_prefix(digest).and_then(|rest| rest.strip_prefix('.'));
        let Some(layer) = layer.filter(|layer| layer.ends_with(ending)) else { continue };
        let name = tasks.output.join(format!("{stem}{layer}"));
        let target = Path::new(CONTENT).join(&file);
        if fs::read_link(&name).is_ok_and(|now| now == target) {
            continue;
        }
        if cfg!(unix) && name.symlink_metadata().is_ok_and(|there| !there.is_symlink()) {
            let message =
                format!("{} is there already, and is no picture of this batch", name.display());
            return Err(Failure::usage(message).with_help("give another `output` or `name`"));
        }
        // Under another name first, so that there is always the former picture or this one.
        let draft = tasks.records().join(format!("link-{}-{digest}.{layer}", std::process::id()));
        let _ = fs::remove_file(&draft);
        make_link(&target, &folder.join(&file), &draft).map_err(|error| failed(&name, &error))?;
        fs::rename(&draft, &name).map_err(|error| failed(&name, &error))?;
    }
    Ok(())
}

#[cfg(unix)]
fn make_link(target: &Path, _file: &Path, name: &Path) -> io::Result<()> {
    std::os::unix::fs::symlink(target, name)
}

#[cfg(not(unix))]
fn make_link(_target: &Path, file: &Path, name: &Path) -> io::Result<()> {
    fs::hard_link(file, name).or_else(|_| fs::copy(file, name).map(drop))
}

/// Writes `index.tsv` and `index.json`: every picture with its parameters and its file.
pub(crate) fn write_index(tasks: &Tasks, digests: &[String]) -> Result<(), Failure> {
    let file = |digest: &String| {
        let path = tasks.picture_file(digest);
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        format!("{CONTENT}/{name}")
    };
    let mut head = ["picture", "name", "file", "input"].map(str::to_owned).to_vec();
    head.extend(tasks.parameters.iter().map(|(path, _)| path.text.clone()));
    let mut rows = vec![head];
    let mut list = Vec::with_capacity(tasks.pictures.len());
    for (picture, digest) in tasks.pictures.iter().zip(digests) {
        let Picture { number, input, name, changes, .. } = picture;
        let mut row = vec![number.to_string(), name.clone(), file(digest), plain(input)];
        row.extend(changes.iter().map(|change| plain(change.value())));
        rows.push(row);
        list.push(json!({
            "picture": number,
            "name": name,
            "file": file(digest),
            "input": input,
            "parameters": parameters(picture),
        }));
    }
    let json = format!("{:#}\n", Value::Array(list));
    let table = rows.iter().map(|row| row.join("\t") + "\n").collect::<String>();
    let mut outputs = Vec::new();
    for (name, text) in [("index.tsv", table), ("index.json", json)] {
        let mut output = Output::create(&tasks.output.join(name))?;
        output.write(|out| out.write_all(text.as_bytes()))?;
        outputs.push(output);
    }
    Output::commit(outputs)
}

/// The value of each parameter of a picture, by its path.
pub(crate) fn parameters(picture: &Picture) -> Value {
    let value = |change: &Change| {
        // Numbers, lists and plain text are written alike in both; the rest stays as it is.
        serde_json::from_str(change.value()).unwrap_or_else(|_| json!(change.value()))
    };
    let values = picture.changes.iter().map(|c| (c.path().to_owned(), value(c)));
    Value::Object(values.collect::<Map<_, _>>())
}

/// On one line, without a tabulator.
fn plain(text: &str) -> String {
    text.replace(char::is_whitespace, " ")
}
