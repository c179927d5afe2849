//! No value of a public type makes the renderer panic, hang or recurse for ever.

#[path = "../../phong-scene/tests/broken/mod.rs"]
mod broken;

use std::cell::Cell;
use std::sync::Arc;

use phong::geometry::{Geometry, GeometryOptions};
use phong::look::Look;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Diagnostic, Light, Object, Scene};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

#[test]
fn a_broken_scene_is_an_error_and_any_other_is_drawn() {
    let config = Config { failure_persistence: None, ..Config::with_cases(1024) };
    let drawn = Cell::new(0);
    let judged = TestRunner::new(config).run(&broken::any_scene(), |scene| {
        let sound = !scene.check().iter().any(Diagnostic::is_error);
        match View::of(&scene) {
            Ok(view) if sound => {
                let image = phong_scene::Image { size: [8, 8], ..scene.image.clone() };
                let options = RenderOptions::of(&image)?;
                let outcome = render(&view, &options, &|_| {}, &Cancel::new());
                prop_assert!(outcome.complete);
                drawn.set(drawn.get() + 1);
            }
            Ok(_) => {} // the picture's own settings are not part of a view
            Err(error) => prop_assert!(!sound, "{error}"),
        }
        // A look may be put on any geometry.
        let other = Scene { lights: vec![Light::default()], ..Scene::default() };
        if let Ok(geometry) = Geometry::new(&scene, GeometryOptions::default()) {
            let _ = View::new(Arc::new(geometry), Look::new(&other));
        }
        let ball = Scene { objects: vec![Object::default()], ..Scene::default() };
        let geometry = Geometry::new(&ball, GeometryOptions::default())?;
        let _ = View::new(Arc::new(geometry), Look::new(&scene));
        Ok(())
    });
    if let Err(error) = judged {
        panic!("{error}");
    }
    assert!(drawn.get() > 200, "only {} of 1024 scenes were sound", drawn.get());
}
