//! A rendering as a conversation: passes, events, cancelling and going on, always to the same bits.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use std::collections::BTreeMap;
use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{LazyLock, Mutex, mpsc};
use std::time::Duration;

use phong::aov::Aov;
use phong::explain::{Sample, explain};
use phong::film::{Film, LayerKind, Window};
use phong::image::Encoding;
use phong::part::{self, Part, Settings};
use phong::render::{
    Cancel, Event, Pass, Passes, RenderError, RenderOptions, Rendering, render, resume,
};
use phong::terms::{Term, TermSet, Terms};
use phong::view::View;
use phong_scene::{FilterKind, Limits, Memory, Rgb, Scene};

/// A few spheres, a mirror, glass and a floor.
static SCENE: LazyLock<View> = LazyLock::new(|| {
    let source = Memory::new().with("scene.toml", include_bytes!("agreement/few.toml").to_vec());
    let reading = phong_scene::read("scene.toml", None, &source, &Limits::default());
    View::of(&reading.scene.unwrap()).unwrap()
});

/// Signed weights, an odd number of samples, tiles that do not fit: three by two of them.
fn options() -> RenderOptions {
    let options = RenderOptions::new([21, 13]).unwrap().with_tile(8).unwrap();
    let options = options.with_samples(7).unwrap().with_filter(FilterKind::Mitchell);
    options.with_terms(TermSet::ALL).with_aovs(&[Aov::Depth, Aov::Normal])
}

fn in_passes(options: &RenderOptions) -> RenderOptions {
    options.clone().with_passes(Passes::CoarseToFine)
}

fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn drawn(options: &RenderOptions) -> Film {
    render(&SCENE, options, &|_| {}, &Cancel::new()).film
}

/// Every layer, bit for bit.
#[track_caller]
fn assert_same(name: &str, a: &Film, b: &Film) {
    assert_eq!(a.done, b.done, "{name}");
    for (p, q) in a.layers.iter().zip(&b.layers) {
        assert_eq!((p.kind, p.values.len()), (q.kind, q.values.len()), "{name}");
        let apart = p.values.iter().zip(&*q.values).filter(|(x, y)| x.to_bits() != y.to_bits());
        assert_eq!(apart.count(), 0, "{name}: values of `{}` differ", p.kind.name());
    }
}

/// A tile event, kept.
type Told = (u32, usize, Vec<Vec<f32>>);

/// What is told of the tiles, in the order of the telling.
fn told(options: &RenderOptions, threads: usize) -> (Vec<Told>, Film) {
    let tiles = Mutex::new(Vec::new());
    let listen = |event: Event<'_>| {
        if let Event::Tile { pass, index, values, .. } = event {
            tiles.lock().unwrap().push((pass, index, values.to_vec()));
        }
    };
    let film = on(threads, || render(&SCENE, options, &listen, &Cancel::new()).film);
    (tiles.into_inner().unwrap(), film)
}

/// The film after a pass, put together from what was told of it.
fn film_after(pass: u32, told: &[Told], options: &RenderOptions) -> Film {
    let kinds = options.layers();
    let mut film = Film::new(options.size(), options.window(), options.tile(), &kinds);
    for (_, index, values) in told.iter().filter(|(of, ..)| *of == pass) {
        film.put(*index, values);
    }
    film
}

#[test]
fn passes_end_in_the_bits_of_a_render_in_one_go() {
    for samples in [1, 2, 3, 5, 8] {
        for filter in [FilterKind::Mitchell, FilterKind::Box] {
            let options = options().with_samples(samples).unwrap().with_filter(filter);
            let whole = drawn(&options);
            for (tile, threads) in [(1, 2), (3, 7), (16, 1), (64, 3)] {
                let options = in_passes(&options).with_tile(tile).unwrap();
                let film = on(threads, || drawn(&options));
                let name = format!("{samples} samples, {filter:?}, tiles of {tile}");
                for (p, q) in film.layers.iter().zip(&whole.layers) {
                    let same =
                        p.values.iter().zip(&*q.values).all(|(a, b)| a.to_bits() == b.to_bits());
                    assert!(same, "{name}: {}", p.kind.name());
                }
                assert!(film.is_complete(), "{name}");
            }
        }
    }
}

#[test]
fn a_crop_and_shares_in_passes_have_the_bits_of_one_go() {
    let window = Window { x0: 5, y0: 3, x1: 18, y1: 11 };
    let crop = options().with_window(window).unwrap();
    assert_same("crop", &drawn(&in_passes(&crop)), &drawn(&crop));
    let mut whole = drawn(&in_passes(&options().with_share(0, 2).unwrap()));
    assert!(!whole.is_complete());
    whole.merge(&drawn(&in_passes(&options().with_share(1, 2).unwrap()))).unwrap();
    assert_same("shares", &whole, &drawn(&options()));
}

#[test]
fn a_pass_is_the_picture_of_the_samples_so_far() {
    let options = in_passes(&options());
    let (told, last) = told(&options, 2);
    let passes = Passes::CoarseToFine.of(options.samples());
    for (number, pass) in passes.iter().enumerate().skip(1) {
        let film = film_after(number as u32, &told, &options);
        assert!(film.is_complete());
        for [x, y] in [[0, 0], [10, 6], [7, 8], [12, 5], [20, 12], [3, 11]] {
            let explained = explain(&SCENE, &options, [x, y]).unwrap();
            let terms = sum(&explained.samples[..pass.samples() as usize]);
            let drawn = film.at(LayerKind::Picture, x, y).unwrap();
            assert_eq!(drawn, terms.total().to_array(), "{pass:?} at ({x}, {y})");
        }
        let depth = LayerKind::Aov(Aov::Depth);
        assert_eq!(film.layer(depth), last.layer(depth), "variables are there from the first on");
    }
}

/// What the film makes of some samples of a pixel.
fn sum(samples: &[Sample]) -> Terms {
    let weight: f64 = samples.iter().map(|sample| f64::from(sample.weight)).sum();
    let weight = weight.max(0.25 * samples.len() as f64);
    Terms::from_fn(|term: Term| {
        let sum = samples.iter().fold([0.0; 3], |mut sum, sample| {
            for (sum, value) in sum.iter_mut().zip(sample.terms[term].to_array()) {
                *sum += f64::from(sample.weight) * f64::from(value);
            }
            sum
        });
        Rgb::from(sum.map(|value| (value / weight) as f32))
    })
}

#[test]
fn the_coarse_pass_repeats_what_a_picture_of_one_sample_has_in_the_middle_of_each_square() {
    let one = drawn(&options().one_sample());
    for (tile, window) in [
        (8, Window::full([21, 13])),
        (5, Window::full([21, 13])),
        (1, Window { x0: 2, y0: 1, x1: 20, y1: 12 }),
    ] {
        let options = options().with_tile(tile).unwrap().with_window(window).unwrap();
        let options = in_passes(&options);
        let coarse = film_after(0, &told(&options, 2).0, &options);
        let edge = Pass::COARSE;
        for (x, y) in
            (window.y0..window.y1).flat_map(|y| (window.x0..window.x1).map(move |x| (x, y)))
        {
            let middle = |n: u32, side: u32| (n / edge * edge + edge / 2).min(side - 1);
            let [mx, my] = [middle(x, 21), middle(y, 13)];
            for kind in options.layers() {
                let (a, b) = (coarse.at(kind, x, y).unwrap(), one.at(kind, mx, my).unwrap());
                let bits = |v: &[f32]| v.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(a), bits(b), "{} at ({x}, {y}), tiles of {tile}", kind.name());
            }
        }
    }
}

#[test]
fn of_a_tile_the_passes_are_told_in_order_and_a_pass_after_all_its_tiles() {
    let options = in_passes(&options());
    let events = Mutex::new(Vec::new());
    let listen = |event: Event<'_>| match event {
        Event::Tile { pass, index, .. } => events.lock().unwrap().push((pass, Some(index))),
        Event::Pass { pass, passes, .. } => {
            assert_eq!(passes, 5);
            events.lock().unwrap().push((pass, None));
        }
        Event::Progress(_) => {}
    };
    on(3, || render(&SCENE, &options, &listen, &Cancel::new()));
    let events = events.into_inner().unwrap();
    let mut had: BTreeMap<usize, u32> = BTreeMap::new();
    let mut passed = 0;
    for (pass, tile) in events {
        if let Some(tile) = tile {
            assert_eq!(pass, *had.get(&tile).unwrap_or(&0), "tile {tile}");
            had.insert(tile, pass + 1);
        } else {
            assert_eq!(pass, passed, "passes end in order");
            assert!(had.len() == 6 && had.values().all(|&next| next > pass), "{had:?}");
            passed += 1;
        }
    }
    assert_eq!(passed, 5);
}

#[test]
fn a_rendering_can_be_looked_into_from_an_event() {
    let options = in_passes(&options());
    let rendering = Rendering::new(&SCENE, &options);
    let looks = Mutex::new(0);
    let listen = |event: Event<'_>| {
        // This would hang if a lock were held while events are told.
        let film = rendering.film();
        if let Event::Tile { index, values, .. } = event {
            assert_eq!(film.take(index), values);
            *looks.lock().unwrap() += 1;
        }
    };
    on(2, || rendering.run(&listen, &Cancel::new()));
    assert_eq!(*looks.lock().unwrap(), 6 * 5);
    let progress = rendering.progress();
    assert_eq!((progress.tiles_done, progress.tiles), (6, 6));
    assert_eq!((progress.samples_done, progress.samples), (21 * 13 * 7, 21 * 13 * 7));
}

#[test]
fn a_listener_that_takes_its_time_holds_up_one_tile_and_no_other() {
    let options = options();
    let (done, all_others) = mpsc::channel();
    let (done, all_others) = (Mutex::new(done), Mutex::new(all_others));
    let listen = |event: Event<'_>| {
        if let Event::Tile { index, .. } = event {
            if index == 0 {
                // Until all the others are done, by the other thread.
                let waits = all_others.lock().unwrap();
                (1..6).for_each(|_| waits.recv().unwrap());
            } else {
                done.lock().unwrap().send(()).unwrap();
            }
        }
    };
    let film = on(2, || render(&SCENE, &options, &listen, &Cancel::new()).film);
    assert_same("a slow listener", &film, &drawn(&options));
}

#[test]
fn a_listener_that_panics_stops_the_rendering_and_spoils_nothing() {
    let options = in_passes(&options());
    let rendering = Rendering::new(&SCENE, &options);
    let listen = |event: Event<'_>| {
        if let Event::Tile { pass: 1, index: 2, .. } = event {
            std::panic::resume_unwind(Box::new("enough"));
        }
    };
    let cancel = Cancel::new();
    let panic = catch_unwind(AssertUnwindSafe(|| on(2, || rendering.run(&listen, &cancel))));
    assert_eq!(panic.unwrap_err().downcast_ref(), Some(&"enough"));
    assert!(!cancel.is_cancelled(), "that is the caller's");
    on(2, || rendering.run(&|_| {}, &cancel));
    let outcome = rendering.finish();
    assert!(outcome.complete);
    assert_same("gone on with", &outcome.film, &drawn(&options));
}

#[test]
fn what_was_done_when_it_was_cancelled_is_handed_back() {
    let options = options();
    let (cancel, tiles) = (Cancel::new(), Mutex::new(0));
    let listen = |event: Event<'_>| {
        if let Event::Tile { .. } = event {
            *tiles.lock().unwrap() += 1;
            if *tiles.lock().unwrap() == 4 {
                cancel.cancel();
            }
        }
    };
    let outcome = on(1, || render(&SCENE, &options, &listen, &cancel));
    assert!(!outcome.complete);
    assert_eq!(outcome.film.done, [true, true, true, true, false, false]);
    let whole = drawn(&options);
    for tile in 0..4 {
        assert_eq!(outcome.film.take(tile), whole.take(tile));
    }
    let rest = resume(&SCENE, &options, outcome.film, &|_| {}, &Cancel::new()).unwrap();
    assert!(rest.complete);
    assert_same("resumed", &rest.film, &whole);
    let both = outcome.rays.primary + rest.rays.primary;
    assert_eq!(both, 21 * 13 * 7, "nothing was drawn twice");
}

#[test]
fn nothing_is_done_where_it_was_cancelled_before() {
    let cancel = Cancel::new();
    cancel.cancel();
    let outcome = render(&SCENE, &options(), &|_| {}, &cancel);
    assert!(!outcome.complete && outcome.film.done.iter().all(|&done| !done));
    assert_eq!(outcome.rays.total(), 0);
}

#[test]
fn a_part_kept_after_any_pass_goes_on_to_the_same_bits() {
    let (in_passes, whole) = (in_passes(&options()), drawn(&options()));
    let settings = Settings::of(&Scene::default(), &in_passes, Encoding::default());
    for last in 0..5 {
        let cancel = Cancel::new();
        let listen = |event: Event<'_>| {
            if matches!(event, Event::Pass { pass, .. } if pass == last) {
                cancel.cancel();
            }
        };
        let outcome = on(2, || render(&SCENE, &in_passes, &listen, &cancel));
        let mut file = Vec::new();
        part::write(outcome.film.film_tiles(), &settings, &mut file).unwrap();
        let part = Part::read(&mut &*file, in_passes.film_bytes()).unwrap();
        // A checkpoint goes on with or without passes.
        for options in [&in_passes, &options()] {
            let (film, cancel) = (part.film.clone(), Cancel::new());
            let rest = resume(&SCENE, options, film, &|_| {}, &cancel).unwrap();
            assert!(rest.complete);
            assert_same(&format!("after pass {last}"), &rest.film, &whole);
            let drawn = rest.rays.primary;
            assert!(last == 0 || drawn < 21 * 13 * 7, "after pass {last}: {drawn} drawn again");
        }
    }
}

#[test]
fn a_part_taken_while_the_rendering_goes_on_is_whole() {
    let options = in_passes(&options());
    let settings = Settings::of(&Scene::default(), &options, Encoding::default());
    let rendering = Rendering::new(&SCENE, &options);
    let parts = Mutex::new(Vec::new());
    let listen = |event: Event<'_>| {
        if let Event::Tile { .. } = event {
            let tiles = (0..rendering.tiles()).filter_map(|tile| rendering.film_tile(tile));
            let mut file = Vec::new();
            part::write(tiles, &settings, &mut file).unwrap();
            parts.lock().unwrap().push(file);
        }
    };
    on(2, || rendering.run(&listen, &Cancel::new()));
    let whole = rendering.finish().film;
    for file in parts.into_inner().unwrap().iter().step_by(4) {
        let part = Part::read(&mut &**file, u64::MAX).unwrap();
        let rest = resume(&SCENE, &options, part.film, &|_| {}, &Cancel::new()).unwrap();
        assert_same("taken meanwhile", &rest.film, &whole);
    }
}

#[test]
fn a_film_of_other_options_is_refused() {
    let film = drawn(&options());
    for (other, what) in [
        (options().with_size([20, 13]).unwrap(), "size"),
        (options().with_window(Window { x0: 1, y0: 0, x1: 21, y1: 13 }).unwrap(), "window"),
        (options().with_tile(9).unwrap(), "tile size"),
        (options().with_terms(TermSet::NONE), "layers"),
    ] {
        let refused = resume(&SCENE, &other, film.clone(), &|_| {}, &Cancel::new());
        assert_eq!(refused.unwrap_err(), RenderError::Differ(what));
    }
    let mut cut = film;
    cut.layers[0].values = [0.0; 5].into_iter().collect();
    let refused = resume(&SCENE, &options(), cut, &|_| {}, &Cancel::new());
    assert_eq!(refused.unwrap_err(), RenderError::Differ("the number of their values"));
}

#[test]
fn a_film_with_more_samples_than_asked_for_is_refused() {
    let options = in_passes(&options());
    let cancel = Cancel::new();
    let listen = |event: Event<'_>| {
        if let Event::Pass { samples: 4, .. } = event {
            cancel.cancel();
        }
    };
    let film = on(1, || render(&SCENE, &options, &listen, &cancel)).film;
    let fewer = options.with_samples(4).unwrap();
    let refused = resume(&SCENE, &fewer, film, &|_| {}, &Cancel::new());
    assert!(matches!(refused.unwrap_err(), RenderError::Samples(_)));
}

#[test]
fn a_rendering_is_cancelled_in_the_middle_of_a_tile() {
    // Shells of glass within one another, right of the middle: every ray there doubles at each, so
    // that the second tile has more rays than can ever be traced. The first is empty.
    let mut text = "version = 1\n[camera]\nkind = \"orthographic\"\nheight = 16\n\
                    eye = [0, 0, 9]\nlook_at = [0, 0, 0]\n[[light]]\nkind = \"point\"\n\
                    position = [3, 4, 5]\n[materials.glass]\nreflection = 1\n\
                    transmission = 1\nfresnel = false\n"
        .to_owned();
    for radius in 1..=30 {
        let radius = f64::from(radius) * 0.1;
        let _ = writeln!(
            text,
            "[[sphere]]\ncenter = [8, 0, 0]\nradius = {radius}\nmaterial = \"glass\""
        );
    }
    let source = Memory::new().with("glass.toml", text.into_bytes());
    let reading = phong_scene::read("glass.toml", None, &source, &Limits::default());
    let scene = View::of(&reading.scene.unwrap()).unwrap();
    let options = RenderOptions::new([32, 16]).unwrap().with_depth(100).unwrap();
    let (begun, begins) = mpsc::channel();
    let begun = Mutex::new(begun);
    let listen = |event: Event<'_>| {
        if let Event::Tile { .. } = event {
            begun.lock().unwrap().send(()).unwrap();
        }
    };
    let cancel = Cancel::new();
    let outcome = std::thread::scope(|scope| {
        let cancel = &cancel;
        scope.spawn(move || {
            begins.recv().unwrap();
            std::thread::sleep(Duration::from_millis(50));
            cancel.cancel();
        });
        on(1, || render(&scene, &options, &listen, cancel))
    });
    assert_eq!(outcome.film.done, [true, false], "the second came to an end by itself");
}
