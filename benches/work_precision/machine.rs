//! What the figures were measured on.

use std::process::Command;

/// The first line a program prints.
fn says(program: &str, args: &[&str]) -> String {
    let output = Command::new(program).args(args).output();
    let text = output.map(|out| String::from_utf8_lossy(&out.stdout).into_owned()).unwrap_or_default();
    text.lines().next().unwrap_or("not known").to_string()
}

/// The value behind a name in /proc/cpuinfo.
fn processor(name: &str) -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find(|line| line.split(':').next().is_some_and(|key| key.trim() == name));
    line.and_then(|line| line.split(':').nth(1)).unwrap_or("not known").trim().to_string()
}

/// As a Markdown list; `built` is how.
pub fn describe(built: &str) -> String {
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    let rustc = says(option_env!("RUSTC").unwrap_or("rustc"), &["--version"]);
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split(' ').next().unwrap_or("not known");
    format!(
        "* {} (family {}, model {}), {cores} cores, {}\n* {rustc}, {built}\n* {}, load {load}\n",
        processor("model name"),
        processor("cpu family"),
        processor("model"),
        says("uname", &["-sm"]),
        says("date", &["-u", "+%F"]),
    )
}
