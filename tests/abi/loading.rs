//! What goes wrong when a host loads the library is said.

use std::path::Path;

use support::cli::library;

use crate::host::{ABI, Host};

fn refused(path: &Path, abi: u32) -> String {
    Host::load(path, abi).err().expect("it is refused")
}

#[test]
fn a_wrong_path_is_named() {
    let text = refused(Path::new("/nowhere/libwovenfit.so"), ABI);
    assert!(text.contains("/nowhere/libwovenfit.so"), "{text}");
}

#[test]
fn a_library_that_is_another_misses_a_symbol_by_name() {
    // Every system that runs this has the C library.
    let text = refused(Path::new("libm.so.6"), ABI);
    assert!(text.contains("wovenfit_check_abi is missing"), "{text}");
    let host = Host::load(library(), ABI).unwrap();
    let text = host.find::<unsafe extern "C" fn()>("wovenfit_fold").unwrap_err();
    assert!(text.contains("wovenfit_fold is missing"), "{text}");
}

#[test]
fn another_abi_is_refused_with_both_numbers() {
    let text = refused(library(), ABI + 1);
    let both = format!("ABI {} of wovenfit", ABI + 1);
    assert!(text.contains(&both) && text.contains(&format!("has ABI {ABI}")), "{text}");
}

#[test]
fn the_version_is_the_programs() {
    let host = Host::load(library(), ABI).unwrap();
    let said = support::cli::run(["--version"]).stdout;
    assert_eq!(said.trim(), format!("wovenfit {}", host.version()));
}
