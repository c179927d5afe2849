//! `phong studio`: the browser studio.

#[cfg(feature = "studio")]
use std::path::{Path, PathBuf};

use crate::args::{self, studio_help};
use crate::failure::Failure;

const EXAMPLES: &str = "\
Examples:
  phong studio                       a first scene, in the browser
  phong studio scene.toml            that scene: turn it, change it, ask why a pixel has its colour
  phong studio dragon.ply            a model
  phong studio dragon.ply --look clay
  phong studio scene.toml --no-open  print the address alone
  phong studio scenes --static web   the page as files for any web server, with all scenes of a folder

It answers on 127.0.0.1, to who has the address, until Ctrl-C. It reads files beside INPUT and below,
no others, and writes one when you save: the scene that is open.

With --static nothing is served: DIR gets the page, the scenes with all that they read, and the renderer
as WebAssembly, which has to be built first: `bash .ci/wasm` does it.";

/// A scene in the browser: turn it, change it, and see why each pixel has its colour
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
#[cfg_attr(not(feature = "studio"), allow(dead_code, reason = "this build is without the studio"))]
pub(crate) struct Args {
    #[arg(help = studio_help(), value_parser = args::path())]
    input: Option<String>,

    /// Port to answer on [default: any that is free]
    #[arg(long, value_name = "N", value_parser = args::whole(1_u16, u16::MAX))]
    port: Option<u16>,

    /// Put this look on what is opened first; what it changes of a scene's text is taken back by undo
    #[arg(long, value_name = "NAME", value_parser = args::look)]
    look: Option<phong_scene::NamedLook>,

    /// Print the address, and open no browser
    #[arg(long)]
    no_open: bool,

    /// Write the page into this folder, to be served without the program; INPUT may be a folder of scenes
    #[arg(long, value_name = "DIR", value_parser = args::path(), conflicts_with_all = ["port", "no_open"])]
    r#static: Option<String>,

    /// Where the WebAssembly is [default: `wasm` beside the program]
    #[arg(long, value_name = "DIR", value_parser = args::path(), requires = "static")]
    wasm: Option<String>,
}

#[cfg(not(feature = "studio"))]
pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::usage("this build is without the studio")
        .with_help("build with the feature `studio`, which is on by default"))
}

#[cfg(feature = "studio")]
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    use phong_studio::engine::Bounds;
    use phong_studio::server::{Server, ServerOptions};

    use crate::{input, memory, report};

    if let Some(site) = &args.r#static {
        return write_site(args, Path::new(site));
    }
    let (folder, open) = input::folder_of(args.input.as_deref())?;
    // Several pages may be open, each with a scene and a picture.
    let bytes = (memory::limit() / 8).min(2 << 30);
    let mut bounds = Bounds { bytes, ..Bounds::default() };
    bounds.limits.bytes = bytes;
    let port = args.port.unwrap_or(0);
    let options = ServerOptions { folder, open, look: args.look, port, bounds };
    let server = Server::bind(options).map_err(|error| {
        let trouble = phong_scene::trouble(&error);
        match args.port {
            Some(port) => Failure::usage(format!("--port {port}: {trouble}"))
                .with_help("leave it out, and any port that is free is taken"),
            None => Failure::System(format!("the studio cannot answer: {trouble}")),
        }
    })?;
    let url = server.url();
    report::data(format!("{url}\n").as_bytes())?;
    if !args.no_open && open::that_detached(&url).is_err() {
        report::say("there is no browser to open: open the address in one");
    }
    server.run().map_err(|error| Failure::System(phong_scene::trouble(&error)))
}

/// Writes the page as a folder of static files.
#[cfg(feature = "studio")]
fn write_site(args: &Args, site: &Path) -> Result<(), Failure> {
    use phong_studio::engine::Bounds;
    use phong_studio::folder::Shelf;
    use phong_studio::site::{self, SiteError};

    use crate::{input, output::Output, report};

    let input = args.input.as_deref();
    let modules = modules(args.wasm.as_deref())?;
    if holds_something_else(site) {
        let message = format!("{} holds something else", site.display());
        return Err(Failure::usage(message).with_help("name a folder of its own for the page"));
    }
    let folder = input.map(phong_scene::path_of).filter(|path| path.is_dir());
    let (folder, open) = match folder {
        Some(folder) => (folder, None),
        None => input::folder_of(input)?,
    };
    let shelf = Shelf::new(&folder, open.clone());
    let shelf = shelf.map_err(|error| input::unreadable(&folder, &error))?;
    let scenes = match (input, open) {
        (_, Some(open)) => vec![open],
        (Some(_), None) => shelf.names(),
        (None, None) => Vec::new(),
    };
    let names: Vec<&str> = modules.iter().map(|(name, _)| *name).collect();
    let files = site::files(&scenes, &shelf, &Bounds::default().limits, &names, args.look);
    let files = files.map_err(|error| match error {
        SiteError::Scene(diagnostics) => Failure::Input(diagnostics),
        SiteError::Outside(_) => Failure::usage(error.to_string()),
    })?;
    let mut outputs = Vec::new();
    let mut bytes = 0;
    let files = files.into_iter().map(|file| (file.path, file.bytes));
    let modules = modules.into_iter().map(|(name, bytes)| (name.to_owned(), bytes));
    for (path, content) in files.chain(modules) {
        let path = site.join(path);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|error| input::unreadable(folder, &error))?;
        }
        let mut output = Output::create(&path)?;
        output.write(|out| out.write_all(&content))?;
        outputs.push(output);
        bytes += content.len() as u64;
    }
    let count = outputs.len();
    Output::commit(outputs)?;
    let size = report::readable(bytes);
    report::say(&format!("{}: {count} files, {size}; any web server serves them", site.display()));
    Ok(())
}

/// The modules of WebAssembly, by name; the one without vector instructions where it is.
#[cfg(feature = "studio")]
fn modules(folder: Option<&str>) -> Result<Vec<(&'static str, Vec<u8>)>, Failure> {
    use phong_studio::site::{MODULES, PLAIN_MODULES};

    let beside = || {
        let program = std::env::current_exe().unwrap_or_default();
        program.parent().unwrap_or(Path::new(".")).join("wasm")
    };
    let folder = folder.map_or_else(beside, PathBuf::from);
    let module = |name: &'static str| {
        let path = folder.join(name);
        let bytes = std::fs::read(&path).map_err(|error| {
            let trouble = phong_scene::trouble(&error);
            Failure::usage(format!("the renderer as WebAssembly: {}: {trouble}", path.display()))
                .with_help("`bash .ci/wasm` builds it; `--wasm DIR` says where it is")
        })?;
        Ok((name, bytes))
    };
    let plain = PLAIN_MODULES.into_iter().filter(|name| folder.join(name).is_file());
    MODULES.into_iter().chain(plain).map(module).collect()
}

/// Whether a folder holds anything but a page that was written before.
#[cfg(feature = "studio")]
fn holds_something_else(folder: &Path) -> bool {
    let is_empty = folder.read_dir().map_or(true, |mut files| files.next().is_none());
    let is_page = folder.join("files.json").is_file() && folder.join("workers.js").is_file();
    !is_empty && !is_page
}
