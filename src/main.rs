//! The program `lme-mpm`; see the module `cli`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
