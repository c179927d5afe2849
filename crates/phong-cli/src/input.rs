//! Reading what the command line names: files, pipes, standard input.

use std::fs::{self, File, FileType};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

use glam::DVec3;
use phong_lab::furniture;
use phong_scene::{
    Batch, BatchReading, Blob, CameraKind, CameraPath, CameraPathReading, Diagnostic, Folder,
    Format, FrameRange, Frames, Framing, Jail, Limits, Memory, Reading, Scene, Severity, Side,
    Source, closest, path_of, read_stream, trouble,
};

use crate::args::{InputArgs, View, ViewArgs};
use crate::failure::Failure;
use crate::{memory, report};

/// The most that is read from a pipe, which does not say how long it is, whatever memory there is.
const MAX_PIPED: u64 = 4 << 30;

/// The most names of a folder that a misspelt one is compared with.
const MOST_COMPARED: usize = 10_000;

/// The folder that nothing is read outside of; none: there is none.
static JAIL: OnceLock<Jail> = OnceLock::new();

/// Reads nothing outside this folder from now on.
pub(crate) fn keep_within(folder: &Path) -> Result<(), Failure> {
    let jail = Jail::new(folder).map_err(|error| {
        Failure::usage(format!("--jail {}: {}", folder.display(), trouble(&error)))
    })?;
    // It is set once, and the first counts.
    let _ = JAIL.set(jail);
    Ok(())
}

/// Where a path leads, if nothing keeps it from being read.
fn allowed(path: &Path) -> io::Result<PathBuf> {
    JAIL.get().map_or_else(|| Ok(path.to_owned()), |jail| jail.resolve(path))
}

/// The files that INPUT may be made of; remembers what was opened.
#[derive(Debug, Default)]
pub(crate) struct Files {
    /// INPUT as it was typed: it alone may be standard input or a pipe.
    input: String,
    opened: Mutex<Vec<PathBuf>>,
    /// All that the pipe held: it is read once.
    piped: Mutex<Option<Memory>>,
}

impl Source for Files {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        let is_input = path == self.input;
        if is_input && path == "-" {
            return self.piped(path, || Ok(io::stdin().lock()));
        }
        let file = allowed(&path_of(path))?;
        let kind = fs::metadata(&file)?.file_type();
        self.opened.lock().unwrap_or_else(PoisonError::into_inner).push(file.clone());
        if is_input && is_pipe(kind) {
            return self.piped(path, || File::open(file));
        }
        match JAIL.get() {
            Some(jail) => jail.open(path),
            None => Folder.open(path),
        }
    }
}

#[cfg(unix)]
fn is_pipe(kind: FileType) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&kind)
}

#[cfg(not(unix))]
fn is_pipe(kind: FileType) -> bool {
    !kind.is_file() && !kind.is_dir()
}

impl Files {
    /// Those of INPUT, none opened yet.
    fn of(args: &InputArgs) -> Result<Self, Failure> {
        if args.input == "-" && args.format.is_none() {
            return Err(Failure::usage("standard input has no name that says what it is")
                .with_help("say it: `phong ... - --format toml`"));
        }
        Ok(Self { input: args.input.clone(), ..Self::default() })
    }

    /// Those that were opened, each once.
    fn opened(&self) -> Vec<PathBuf> {
        let opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        let mut all = Vec::with_capacity(opened.len());
        for file in &*opened {
            if !all.contains(file) {
                all.push(file.clone());
            }
        }
        all
    }

    /// All that a pipe holds: readers want to know a file's length, and to read it anywhere.
    fn piped<R: Read>(
        &self,
        path: &str,
        pipe: impl FnOnce() -> io::Result<R>,
    ) -> io::Result<Box<dyn Blob>> {
        let mut piped = self.piped.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(files) = &*piped {
            return files.open(path);
        }
        let bytes = read_stream(pipe()?, MAX_PIPED.min(memory::limit()))?;
        piped.insert(Memory::new().with(path, bytes)).open(path)
    }
}

/// A scene that was read.
#[derive(Debug)]
pub(crate) struct Input {
    pub(crate) scene: Scene,
    pub(crate) bare: bool,
    pub(crate) warnings: Vec<Diagnostic>,
    files: Vec<PathBuf>,
    /// Whether nothing is told.
    pub(crate) quiet: bool,
}

impl Input {
    /// Whether this file is part of the input.
    pub(crate) fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Tells warnings that what was asked for gives rise to; if `strict`, they are errors.
    pub(crate) fn tell(&mut self, mut said: Vec<Diagnostic>, strict: bool) -> Result<(), Failure> {
        if strict && !said.is_empty() {
            for one in &mut said {
                one.severity = Severity::Error;
            }
            return Err(Failure::Input(said));
        }
        if !self.quiet {
            report::diagnostics(&said);
        }
        self.warnings.append(&mut said);
        Ok(())
    }
}

/// What INPUT is, by `--format`, by what it begins with or by its name, for telling.
pub(crate) fn format(args: &InputArgs) -> Option<Format> {
    // A pipe is read once.
    let is_file = allowed(&path_of(&args.input)).is_ok_and(|path| path.is_file());
    let files = Files { input: args.input.clone(), ..Files::default() };
    args.format.or_else(|| {
        if is_file { Format::of_file(&args.input, &files) } else { Format::of_path(&args.input) }
    })
}

/// A file that cannot be read, with the way out.
pub(crate) fn unreadable(path: &Path, error: &io::Error) -> Failure {
    let failure = Failure::usage(format!("{}: {}", path.display(), trouble(error)));
    match way_out(path, error) {
        Some(help) => failure.with_help(help),
        None => failure,
    }
}

/// What keeps a file from being read, and the way out; `None`: nothing does.
pub(crate) fn missing(path: &Path) -> Option<(String, Option<String>)> {
    let error = hindrance(path)?;
    Some((trouble(&error), way_out(path, &error)))
}

/// Opens a file that must be there.
pub(crate) fn open_file(path: &Path) -> Result<File, Failure> {
    if let Some(error) = hindrance(path) {
        return Err(unreadable(path, &error));
    }
    allowed(path).and_then(File::open).map_err(|error| unreadable(path, &error))
}

/// The folder of INPUT, and INPUT's name in it; without one the folder one is in, or the jail.
#[cfg(feature = "studio")]
pub(crate) fn folder_of(input: Option<&str>) -> Result<(PathBuf, Option<String>), Failure> {
    let Some(input) = input else {
        let jail = JAIL.get().map(|jail| jail.resolve(Path::new(".")));
        let folder = jail.unwrap_or_else(|| Path::new(".").canonicalize());
        return folder.map(|folder| (folder, None)).map_err(|e| unreadable(Path::new("."), &e));
    };
    if input == "-" {
        return Err(Failure::usage("the studio reads a file, not standard input"));
    }
    let path = path_of(input);
    open_file(&path)?;
    if Format::of_path(input).is_none_or(|format| !Format::readable().contains(&format)) {
        return Err(Failure::usage(format!("{input}: its name does not say what it is"))
            .with_help("the studio opens scenes (.toml) and models"));
    }
    let name = path.file_name().map(phong_scene::path_text);
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    Ok((folder.unwrap_or(Path::new(".")).to_owned(), name))
}

/// Why a file cannot be opened; `None`: it can, or it is a pipe, which is not opened a second time.
fn hindrance(path: &Path) -> Option<io::Error> {
    match allowed(path).and_then(fs::metadata) {
        Err(error) => Some(error),
        Ok(meta) if meta.is_dir() => Some(io::ErrorKind::IsADirectory.into()),
        Ok(meta) if meta.is_file() => File::open(path).err(),
        Ok(_) => None,
    }
}

/// What to do about a file that cannot be opened: for a missing one, the name of one like it.
fn way_out(path: &Path, error: &io::Error) -> Option<String> {
    match error.kind() {
        // Names of files outside are not given away.
        _ if JAIL.get().is_some() => None,
        io::ErrorKind::NotFound => {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            let folder = folder.unwrap_or(Path::new("."));
            let Ok(files) = fs::read_dir(folder) else {
                return Some(format!("there is no folder {} either", folder.display()));
            };
            let name = path.file_name()?.to_string_lossy();
            let files: Vec<_> = files
                .filter_map(|file| Some(file.ok()?.file_name().to_string_lossy().into_owned()))
                .take(MOST_COMPARED)
                .collect();
            // An ending in common is no likeness.
            let stem = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned();
            let alike = |file: &&str| closest(&stem(&name), [&*stem(file)]).is_some();
            let near = closest(&name, files.iter().map(String::as_str).filter(alike));
            Some(near.map_or_else(
                || "look at its name and its folder".to_owned(),
                |near| format!("did you mean `{}`?", path.with_file_name(near).display()),
            ))
        }
        io::ErrorKind::PermissionDenied => Some("look at its permissions".to_owned()),
        io::ErrorKind::IsADirectory => Some("name a file in it".to_owned()),
        _ => None,
    }
}

/// How far reading goes.
fn limits(args: &InputArgs) -> Limits {
    Limits { lenient: args.lenient, bytes: memory::limit(), ..Limits::default() }
}

/// Reads INPUT, and all there is to say about it; the files it is made of.
pub(crate) fn read(args: &InputArgs) -> Result<(Reading, Vec<PathBuf>), Failure> {
    let files = Files::of(args)?;
    let limits = limits(args);
    let reading = phong_scene::read_changed(&args.input, args.format, &files, &limits, &args.set);
    Ok((judged(args, reading), files.opened()))
}

/// Reads INPUT, and all there is to say about it and its picture.
pub(crate) fn check(args: &InputArgs) -> Result<Reading, Failure> {
    let (mut reading, _) = read(args)?;
    reading.diagnostics.extend(reading.scene.iter().flat_map(furniture::crowded));
    Ok(strictly(args, reading))
}

/// What was read, by how strict the command line is.
fn judged(args: &InputArgs, mut reading: Reading) -> Reading {
    // Of a file that cannot be opened nothing else is said.
    if let ([only], false) = (&mut reading.diagnostics[..], args.input == "-") {
        let path = &path_of(&args.input);
        let way_out = hindrance(path).and_then(|error| way_out(path, &error));
        only.help = way_out.or_else(|| only.help.take());
    }
    reading.diagnostics.extend(reading.scene.iter().flat_map(furniture::warnings));
    strictly(args, reading)
}

/// What was read; with `--strict`, warnings are errors.
fn strictly(args: &InputArgs, mut reading: Reading) -> Reading {
    if args.strict {
        for diagnostic in reading.diagnostics.iter_mut().filter(|one| !one.is_note()) {
            diagnostic.severity = Severity::Error;
            reading.scene = None;
        }
    }
    reading
}

/// Does something with the frames of INPUT's trajectories.
pub(crate) fn with_frames<T>(
    args: &InputArgs,
    range: FrameRange,
    work: impl FnOnce(&FramesOf<'_>) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let files = Files::of(args)?;
    let limits = limits(args);
    let frames = Frames::new(&files, &limits, range);
    work(&FramesOf { args, files: &files, frames })
}

/// The frames of INPUT's trajectories.
#[derive(Debug)]
pub(crate) struct FramesOf<'a> {
    args: &'a InputArgs,
    files: &'a Files,
    frames: Frames<'a>,
}

impl FramesOf<'_> {
    /// Reads a frame for use: errors end here, warnings are told unless `quiet`. Notes are for the
    /// `first` one.
    pub(crate) fn open(&self, number: u64, first: bool, quiet: bool) -> Result<Input, Failure> {
        let Self { args, files, frames } = self;
        let reading = frames.read(number, &args.input, args.format, &args.set);
        let Reading { scene, bare, mut diagnostics } = judged(args, reading);
        let Some(scene) = scene else { return Err(Failure::Input(diagnostics)) };
        diagnostics.retain(|diagnostic| first || !diagnostic.is_note());
        if !quiet {
            report::diagnostics(&diagnostics);
        }
        Ok(Input { scene, bare, warnings: diagnostics, files: files.opened(), quiet })
    }

    /// The numbers of those that are wanted, once one was read.
    pub(crate) fn numbers(&self) -> Result<Vec<u64>, Failure> {
        Ok(self.frames.numbers()?)
    }
}

/// Reads a batch file: errors end here, warnings are told.
pub(crate) fn read_batch(path: &str) -> Result<Batch, Failure> {
    let file = path_of(path);
    if let Some(error) = hindrance(&file) {
        return Err(unreadable(&file, &error));
    }
    let files = Files { input: path.to_owned(), ..Files::default() };
    let limits = Limits { bytes: memory::limit(), ..Limits::default() };
    let BatchReading { batch, diagnostics } = phong_scene::read_batch(path, &files, &limits);
    let Some(batch) = batch else { return Err(Failure::Input(diagnostics)) };
    report::diagnostics(&diagnostics);
    Ok(batch)
}

/// Reads a file with a camera's way: errors end here, and warnings too if `strict`.
pub(crate) fn read_camera_path(
    path: &str,
    strict: bool,
    quiet: bool,
) -> Result<CameraPath, Failure> {
    let file = path_of(path);
    if let Some(error) = hindrance(&file) {
        return Err(unreadable(&file, &error));
    }
    let files = Files { input: path.to_owned(), ..Files::default() };
    let limits = Limits { bytes: memory::limit(), ..Limits::default() };
    let CameraPathReading { path, mut diagnostics } =
        phong_scene::read_camera_path(path, &files, &limits);
    if strict {
        let all = diagnostics.iter_mut().filter(|one| !one.is_note());
        all.for_each(|one| one.severity = Severity::Error);
    }
    let sound = !diagnostics.iter().any(Diagnostic::is_error);
    let Some(path) = path.filter(|_| sound) else { return Err(Failure::Input(diagnostics)) };
    if !quiet {
        report::diagnostics(&diagnostics);
    }
    Ok(path)
}

/// Reads INPUT for use: errors end here, warnings are told unless `quiet`.
pub(crate) fn open(args: &InputArgs, quiet: bool) -> Result<Input, Failure> {
    let (Reading { scene, bare, diagnostics }, files) = read(args)?;
    let Some(scene) = scene else {
        return Err(Failure::Input(diagnostics));
    };
    if !quiet {
        report::diagnostics(&diagnostics);
    }
    Ok(Input { scene, bare, warnings: diagnostics, files, quiet })
}

/// How the command line looks at a bare model.
fn framing(args: &ViewArgs) -> Framing {
    let default = Framing::default();
    Framing {
        side: args.view.map_or(default.side, Side::from),
        up: args.up.map_or(default.up, DVec3::from_array),
        eye: args.eye.map(DVec3::from_array),
        look_at: args.look_at.map(DVec3::from_array),
        fov: args.fov,
        color: args.color,
    }
}

/// Makes a camera that was looked for ready to go once around what it looks at, in so many steps: a
/// bare model is then seen from so far that it stays in the picture. The axis that it goes about.
pub(crate) fn turn_around(input: &mut Input, args: &ViewArgs, steps: u32) -> DVec3 {
    if !input.bare {
        return input.scene.camera.up;
    }
    let framing = framing(args);
    input.scene.frame_all_around(&framing, steps);
    framing.up
}

/// Looks at a scene as the command line says; a bare model is framed anew for its picture's size.
pub(crate) fn look(input: &mut Input, args: &ViewArgs) -> Result<(), Failure> {
    let Input { scene, bare, .. } = input;
    let bare = *bare;
    let eye = args.eye.map(DVec3::from_array);
    let look_at = args.look_at.map(DVec3::from_array);
    let up = args.up.map(DVec3::from_array);
    let is_fisheye = !bare && matches!(scene.camera.kind, CameraKind::Fisheye { .. });
    if args.fov.is_some_and(|degrees| degrees >= 180.0 && !is_fisheye) {
        return Err(Failure::usage("--fov: this camera sees less than 180 degrees")
            .with_help("a scene's camera of kind \"fisheye\" sees up to 360"));
    }
    if bare {
        let said = scene.frame(&framing(args));
        input.tell(said, false)?;
    } else {
        for (given, option) in [(args.view.is_some(), "--view"), (args.color.is_some(), "--color")]
        {
            if given {
                return Err(Failure::usage(format!("{option} is for bare models"))
                    .with_help("a scene says itself where it is seen from, and in which colours"));
            }
        }
        let camera = &mut scene.camera;
        camera.eye = eye.unwrap_or(camera.eye);
        camera.look_at = look_at.unwrap_or(camera.look_at);
        camera.up = up.unwrap_or(camera.up);
        if let Some(degrees) = args.fov {
            match &mut camera.kind {
                CameraKind::Perspective { fov } | CameraKind::Fisheye { fov } => *fov = degrees,
                CameraKind::Orthographic { .. } | CameraKind::Panorama => {
                    return Err(Failure::usage("this scene's camera has no --fov"));
                }
            }
        }
        scene.fit_guessed();
    }
    let camera = &input.scene.camera;
    let forward = camera.look_at - camera.eye;
    if forward == DVec3::ZERO {
        return Err(Failure::usage("--eye and --look-at are the same point"));
    }
    let sine = forward.cross(camera.up).length() / (forward.length() * camera.up.length());
    if sine.is_nan() || sine < 1e-9 {
        return Err(Failure::usage("the camera looks along --up")
            .with_help("choose an --up across the view, like x, y or z"));
    }
    Ok(())
}

impl From<View> for Side {
    fn from(view: View) -> Self {
        match view {
            View::Front => Self::Front,
            View::Back => Self::Back,
            View::Left => Self::Left,
            View::Right => Self::Right,
            View::Top => Self::Top,
            View::Bottom => Self::Bottom,
            View::Iso => Self::Iso,
        }
    }
}

/// The name of an input without folder and ending: what its picture is called.
pub(crate) fn stem(input: &str) -> String {
    let stem = path_of(input).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    stem.filter(|stem| input != "-" && !stem.is_empty()).unwrap_or_else(|| "picture".to_owned())
}
