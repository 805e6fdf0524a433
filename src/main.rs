//! The program `dtg-passport`: parse, run, print one error, exit code.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
