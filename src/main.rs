//! This is the program `lme-mpm`; the module `cli` has its commands.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
