//! Writes the JavaScript beside a WebAssembly module: `limitmesh-bindgen IN.wasm FOLDER NAME`.

use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [input, folder, name] = words.as_slice() else {
        return Err("limitmesh-bindgen IN.wasm FOLDER NAME".into());
    };
    let mut tool = Bindgen::new();
    tool.input_path(input).out_name(name).typescript(true);
    // A module that trapped is left behind: the next call needs another instance.
    tool.web(true)?.reset_state_function(true);
    tool.remove_name_section(std::env::var_os("KEEP_NAMES").is_none());
    tool.remove_producers_section(true);
    Ok(tool.generate(folder)?)
}
