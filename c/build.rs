//! Gives the shared library the name by which programs that are linked with it look for it.

fn main() {
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "linux") {
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libdtg_passport.so");
    }
}
