//! `include/wovenfit.h` is what cbindgen makes of the sources. To write it anew:
//!
//! ```sh
//! WRITE_HEADER=1 cargo test -p wovenfit-ffi --test header
//! ```

use std::path::Path;

/// The header, without the Rust comments' "# Safety": the preamble states once what it asks.
fn generated(folder: &Path) -> String {
    let mut config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).unwrap();
    config.header = Some(std::fs::read_to_string(folder.join("preamble.h")).unwrap());
    let bindings = cbindgen::generate_with_config(folder, config).unwrap();
    let mut bytes = Vec::new();
    bindings.write(&mut bytes);
    let text = String::from_utf8(bytes).unwrap();
    let mut lines: Vec<&str> = Vec::new();
    let mut safety = false;
    for line in text.lines() {
        let comment = line.trim_start().starts_with("//");
        if line.trim_start() == "// # Safety" {
            safety = true;
            // The empty line before it.
            if lines.last().is_some_and(|last| last.trim() == "//") {
                lines.pop();
            }
        }
        safety &= comment;
        if !safety {
            lines.push(line);
        }
    }
    lines.join("\n") + "\n"
}

#[test]
fn the_header_is_what_the_sources_say() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = folder.join("../include/wovenfit.h");
    let fresh = generated(folder);
    if std::env::var_os("WRITE_HEADER").is_some() {
        std::fs::write(&path, &fresh).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap();
    assert!(
        committed == fresh,
        "include/wovenfit.h is not that of the sources: \
         WRITE_HEADER=1 cargo test -p wovenfit-ffi --test header"
    );
    for wanted in ["wovenfit_check_abi", "WOVENFIT_ABI_VERSION", "WOVENFIT_STATUS_INTERNAL = 100"] {
        assert!(fresh.contains(wanted), "{wanted}");
    }
}
