//! The program `dtg-passport`: parse, run, print one error, exit code.

fn main() -> std::process::ExitCode {
    dtg_passport::cli::main()
}
