//! The example `p2p`, shorter: processes over UDP on the loopback, in rough weather. `cargo test` builds it before it runs this.
#![cfg(feature = "ggrs")]
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use std::process::{Command, Output};

fn p2p(arguments: &str) -> (String, Output) {
    let here = std::env::current_exe().expect("a test");
    let folder = here.parent().and_then(|deps| deps.parent()).expect("target/PROFILE/deps").join("examples");
    let program = folder.join(format!("p2p{}", std::env::consts::EXE_SUFFIX));
    assert!(program.exists(), "{} is not built: cargo build --features ggrs --example p2p", program.display());
    let output = Command::new(program).args(arguments.split_whitespace()).output().expect("it starts");
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (text, output)
}

/// All peers have computed the same states, these among them.
fn equal(arguments: &str, peers: &[&str]) {
    let (text, output) = p2p(arguments);
    assert!(output.status.success(), "{arguments}\n{text}");
    for peer in peers {
        let line = text.lines().find(|line| line.starts_with(peer) && line.ends_with("are equal to player0's"));
        assert!(line.is_some(), "{peer}\n{text}");
    }
}

#[test]
fn three_players_a_spectator_and_one_who_joins_late() {
    equal("--ticks 600 --spectator --join 200", &["player1", "player2", "spectator", "joiner"]);
}

#[test]
fn four_players_in_a_storm() {
    let storm = "--players 4 --ticks 300 --loss 200 --double 100 --hold 1-7 --delay 2 --seed 5";
    equal(storm, &["player1", "player2", "player3"]);
}

#[test]
fn lockstep_by_input_delay() {
    for window in [0, 1] {
        let arguments = format!("--players 2 --ticks 300 --window {window} --delay 5 --spectator --join 100");
        equal(&arguments, &["player1", "spectator", "joiner"]);
    }
}

/// The number behind a word.
fn number(text: &str, word: &str) -> u64 {
    let (_, rest) = text.split_once(word).unwrap_or_else(|| panic!("{word:?} is not in\n{text}"));
    rest.split(|c: char| !c.is_ascii_digit()).next().expect("a number").parse().expect("a number")
}

/// The alarm's own test: one bit of one peer's memory.
#[test]
fn a_flipped_bit_raises_the_alarm_and_is_named() {
    let (text, output) = p2p("--ticks 400 --fault 1:200 --evidence");
    assert_eq!(output.status.code(), Some(1), "{text}");
    let parted = number(&text, "p2p: the worlds part at tick ");
    assert!((200..300).contains(&parted), "{text}");
    // The first checksums that were compared: reports are lost as other packets are.
    let alarm = number(&text, "desync at tick ");
    assert!((parted..parted + 20).contains(&alarm), "{text}");
    assert!(text.contains(&format!("player1: differs from player0 from tick {parted} on")), "{text}");
    assert!(text.contains("player2: ticks 1 to 400 are equal to player0's"), "{text}");
    assert!(
        text.contains(&format!("this machine's world is not that of its recording from tick {parted} on")),
        "{text}"
    );
    // Flipped between two ticks: it shows when the next one begins, and nothing else does.
    let told = format!(
        "evidence of player0 (A) and player1 (B): tick {}, begin\n  motion: body 5v0: velocity.x: ",
        parted + 1
    );
    let (_, findings) = text.split_once(&told).unwrap_or_else(|| panic!("{told}\n{text}"));
    let finding = findings.lines().next().expect("a line");
    let bits: Vec<u64> = finding
        .split("(bits 0x")
        .skip(1)
        .map(|rest| u64::from_str_radix(rest.split(')').next().expect("a bracket"), 16).expect("bits"))
        .collect();
    assert!(matches!(bits[..], [a, b] if a ^ b == 1 << 20), "{finding}");
    assert!(!findings.lines().nth(1).is_some_and(|line| line.starts_with("  ")), "one field differs\n{text}");
}

#[test]
fn another_law_and_another_scene_are_refused() {
    for (arguments, told) in [
        ("--other-law 1", ": their worlds would part; give both the same release of the game"),
        ("--other-scene 1", ": load the same scene, or take its snapshot"),
    ] {
        let (text, output) = p2p(&format!("--players 2 --ticks 60 {arguments}"));
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(text.contains("no session with 127.0.0.1:") && text.contains(told), "{text}");
    }
}

#[test]
fn usage() {
    let (text, output) = p2p("--help");
    assert!(output.status.success() && text.contains("--spectator"), "{text}");
    for wrong in ["--players 5", "--ticks many", "--hold 3", "--frobnicate 1", "--loss"] {
        let (text, output) = p2p(wrong);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.ends_with("; --help has all that can be said\n"), "{text}");
    }
}
