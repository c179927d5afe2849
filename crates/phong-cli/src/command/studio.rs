//! `phong studio`: the browser studio.

use crate::args::{self, studio_help};
use crate::failure::Failure;

const EXAMPLES: &str = "\
Examples:
  phong studio                       a first scene, in the browser
  phong studio scene.toml            that scene: turn it, change it, ask why a pixel has its colour
  phong studio dragon.ply            a model
  phong studio scene.toml --no-open  print the address alone

It answers on 127.0.0.1, to who has the address, until Ctrl-C. It reads files beside INPUT and below,
no others, and writes none.";

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

    /// Print the address, and open no browser
    #[arg(long)]
    no_open: bool,
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

    let (folder, open) = input::folder_of(args.input.as_deref())?;
    // Several pages may be open, each with a scene and a picture.
    let bytes = (memory::limit() / 8).min(2 << 30);
    let mut bounds = Bounds { bytes, ..Bounds::default() };
    bounds.limits.bytes = bytes;
    let port = args.port.unwrap_or(0);
    let server = Server::bind(ServerOptions { folder, open, port, bounds }).map_err(|error| {
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
