//! Help and manual pages say what is there.
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use support::given;

fn told(words: &str) -> String {
    String::from_utf8(given(&[]).done(words).out).unwrap()
}

#[test]
fn only_what_is_read_is_listed_as_an_input() {
    for command in ["render", "explain", "check", "info", "convert", "grade", "bench"] {
        let help = told(&format!("{command} --help"));
        let words = help.split_whitespace().collect::<Vec<_>>().join(" ");
        for read in
            [".obj .ply .stl .off .gltf .pdb .cif", "off, gltf, pdb, cif, xyz, gro, lammpstrj, dat"]
        {
            assert!(words.contains(read), "{command}: {read}: {help}");
        }
        for ending in ["pov", "fbx"] {
            assert!(!help.contains(&format!(".{ending}")), "{command}: {ending}");
        }
    }
}

#[test]
fn options_stand_under_the_heading_they_belong_to() {
    let help = told("convert --help");
    let [options, view] = ["--json", "View:"].map(|words| help.find(words).unwrap());
    assert!(options < view, "{help}");
}

#[test]
fn usage_says_what_must_be_there() {
    let help = told("explain --help");
    assert!(help.contains("<INPUT> <X> <Y>") && help.contains("<INPUT> --html <FILE>"), "{help}");
    given(&[]).when("explain a.toml").is_refused(&["<X>", "<Y>"]);
    assert!(told("studio --help").contains("[INPUT]"));
}

#[test]
fn a_manual_page_has_its_name_and_version() {
    let version = env!("CARGO_PKG_VERSION");
    let page = told("man render");
    assert!(page.contains(&format!(".TH phong-render 1  \"phong {version}\"")), "{page}");
    assert!(page.contains("phong\\-render \\- A picture of a scene"), "{page}");
    assert!(told("man").contains(&format!(".TH phong 1  \"phong {version}\"")));
}
