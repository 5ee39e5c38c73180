//! Any bytes as the text of a design file.

#![no_main]

use std::ffi::CString;
use std::ptr::null_mut;

use libfuzzer_sys::fuzz_target;
use walk::{go, honest};
use wovenfit::*;

#[allow(dead_code, reason = "the other target's part")]
#[path = "../../ffi/tests/hostile/walk.rs"]
mod walk;

fuzz_target!(|bytes: &[u8]| {
    let text: Vec<u8> = bytes.iter().copied().filter(|&byte| byte != 0).collect();
    let Ok(json) = CString::new(text) else { return };
    let mut design = null_mut();
    if go!(wovenfit_design_from_json(json.as_ptr(), 1.0, &raw mut design)) != Status::Ok {
        return;
    }
    // What was read is written and read again.
    let mut needed = 0;
    go!(wovenfit_design_json(design, null_mut(), 0, &raw mut needed));
    let mut again = vec![0u8; needed];
    go!(wovenfit_design_json(design, again.as_mut_ptr().cast(), needed, &raw mut needed));
    let mut copy = null_mut();
    let status = go!(wovenfit_design_from_json(again.as_ptr().cast(), 1.0, &raw mut copy));
    assert_eq!(status, Status::Ok, "{}", String::from_utf8_lossy(&again));
    // SAFETY: made above, freed once.
    unsafe {
        wovenfit_design_free(copy);
        wovenfit_design_free(design);
    }
});
