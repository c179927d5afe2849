//! Writes the JavaScript that goes with a module of WebAssembly: `bindings MODULE FOLDER NAME`. The module is to be
//! parted in two (`split.py`): what its first part lacks is asked for with `globalThis.rest()`, which gives the other.

use std::error::Error;
use std::path::Path;

use wasm_bindgen_cli_support::Bindgen;

/// Where the JavaScript has what it gives the module.
const IMPORTS: &str = "const imports = __wbg_get_imports();";

/// Functions that stand for those of the other part. The first that is called puts all of them in their places.
const PLACEHOLDERS: &str = "
    imports.placeholder = new Proxy({}, {
        get: (_, place) => (...values) => {
            new WebAssembly.Instance(new WebAssembly.Module(globalThis.rest()), { primary: wasm });
            return wasm['%table'].get(Number(place))(...values);
        },
    });";

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [module, folder, name] = words.as_slice() else {
        return Err("usage: bindings MODULE FOLDER NAME".into());
    };
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).web(true)?.out_name(name).typescript(false);
    // The page says where its module is.
    bindgen.omit_default_module_path(true);
    // The functions are parted by their names, which the parts lose.
    bindgen.demangle(false).remove_producers_section(true);
    bindgen.generate(folder)?;
    let script = Path::new(folder).join(format!("{name}.js"));
    let text = std::fs::read_to_string(&script)?;
    if !text.contains(IMPORTS) {
        return Err("the JavaScript gives imports in a way that is not known".into());
    }
    Ok(std::fs::write(script, text.replace(IMPORTS, &format!("{IMPORTS}{PLACEHOLDERS}")))?)
}
