//! The command line program. It uses the library's public interface only.
#![allow(clippy::disallowed_types, reason = "speeds are shown to people; nothing here reaches the engine")]

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
