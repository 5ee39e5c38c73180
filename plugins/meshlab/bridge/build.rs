//! Compiles the C++ half of the bridge; its header comes to `<target>/cxxbridge`.

fn main() {
    cxx_build::bridge("src/lib.rs").std("c++17").compile("wovenfit_meshlab_bridge");
    println!("cargo:rerun-if-changed=src/lib.rs");
}
