//! The command line program, run as its users run it: output, exit status, one line on stderr.
#![cfg(feature = "cli")]
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What a run of the program gave.
struct Output {
    status: i32,
    out: String,
    err: String,
}

fn tamias(args: &[&str]) -> Output {
    tamias_with_input(args, "")
}

fn tamias_with_input(args: &[&str], input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tamias2d"))
        .args(args)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // A program that does not read its input may close it first.
    let _ = child.stdin.take().expect("piped").write_all(input.as_bytes());
    let output = child.wait_with_output().expect("the program ends");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    Output { status: output.status.code().expect("no signal"), out: text(output.stdout), err: text(output.stderr) }
}

/// A fresh folder for one test.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).expect("a folder for the test");
    path
}

fn shown(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

const TC2: &str = r#"{ "name": "tc2", "gravity": [0, 0], "tick_rate": 60, "substeps": 4,
  "bodies": [ { "name": "left", "kind": "dynamic", "position": [20, 20], "angle": 0, "velocity": [0, 0], "angular_velocity": 0,
                "force": [100, 0], "torque": 0, "mass": 10, "inertia": 15, "colliders": [] } ],
  "attractors": [] }"#;

fn run(scene: &str, more: &[&str]) -> Output {
    let mut args = vec!["run", "-"];
    args.extend(more);
    tamias_with_input(&args, scene)
}

#[test]
fn help_says_what_each_command_does() {
    for (args, words) in [
        (vec!["--help"], vec!["run", "verify", "info", "scenes", "record", "Exit status", "Examples"]),
        (
            vec!["run", "--help"],
            vec![
                "--ticks",
                "--every",
                "--events",
                "--collisions",
                "--format",
                "--record",
                "radians",
                "turns",
                "polygon",
            ],
        ),
        (vec!["verify", "--help"], vec!["first bad tick", "--json", "--hashes"]),
        (vec!["info", "--help"], vec!["--json"]),
        (vec!["record", "--help"], vec!["GOLDEN.txt", "--all"]),
    ] {
        let output = tamias(&args);
        assert_eq!(output.status, 0, "{args:?}");
        for word in words {
            assert!(output.out.contains(word), "{args:?} does not mention {word}:\n{}", output.out);
        }
    }
}

#[test]
fn run_prints_tc2_as_csv() {
    let output = run(TC2, &["--ticks", "240", "--every", "60"]);
    assert_eq!((output.status, output.err.as_str()), (0, ""));
    let lines: Vec<&str> = output.out.lines().collect();
    assert_eq!(lines[0], "tick,time,body,x,y,angle,turns,vx,vy,omega");
    assert_eq!(lines[1], "0,0.000000000000000,left,20,20,0.000000000000000,0,0,0,0");
    assert_eq!(lines.len(), 6);
    for (second, expected) in [(1, 25.0), (2, 40.0), (3, 65.0), (4, 100.0)] {
        let fields: Vec<&str> = lines[1 + second].split(',').collect();
        assert_eq!(fields[0], (60 * second).to_string());
        assert_eq!(fields[1], format!("{second}.000000000000000"));
        let x: f64 = fields[3].parse().expect("a number");
        assert!((x - expected).abs() < 1e-6, "x at {second} s: {x}");
        assert_eq!(fields[4], "20");
    }
}

#[test]
fn run_prints_json_that_parses_and_agrees_with_csv() {
    let csv = run(TC2, &["--ticks", "3"]);
    let json = run(TC2, &["--ticks", "3", "--format", "json"]);
    assert_eq!(json.status, 0);
    let rows: Vec<serde_json::Value> = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(rows.len(), 4);
    assert_eq!(rows.len(), csv.out.lines().count() - 1);
    assert_eq!(rows[2]["tick"], 2);
    assert_eq!(rows[2]["body"], "left");
    let none = run(r#"{"name":"n","tick_rate":60,"bodies":[]}"#, &["--ticks", "3", "--format", "json"]);
    assert!(serde_json::from_str::<Vec<serde_json::Value>>(&none.out).expect("JSON").is_empty());
}

#[test]
fn numbers_are_taken_from_their_digits_and_printed_exactly() {
    // The velocity lies 1e-60 above the middle of two multiples of 2^-48: through an f64 it would round down.
    let scene = r#"{"name":"n","tick_rate":60,"bodies":[{"position":[0.1,-1e-9],
        "velocity":[0.10000000000000319744231092045083642005920410156250000000001,-1.5E+1]}]}"#;
    let output = run(scene, &["--ticks", "0"]);
    let row = output.out.lines().nth(1).expect("one body");
    assert_eq!(
        row,
        "0,0.000000000000000,0,0.1000000000931322574615478515625,-0.000000000931322574615478515625,0.000000000000000,0,\
         0.100000000000004973799150320701301097869873046875,-15,0"
    );
}

#[test]
fn angle_stays_below_two_pi_and_turns_are_unwrapped() {
    let scene = r#"{"name":"n","tick_rate":60,"bodies":[
        {"angle":6.283185307179586},{"angle":0,"angular_velocity":-0.0000000000001},{"angular_velocity":20}]}"#;
    let output = run(scene, &["--ticks", "60"]);
    for line in output.out.lines().skip(1) {
        let angle: f64 = line.split(',').nth(5).expect("a field").parse().expect("a number");
        assert!((0.0..std::f64::consts::TAU).contains(&angle), "{line}");
    }
    let last = output.out.lines().last().expect("rows");
    let turns: f64 = last.split(',').nth(6).expect("a field").parse().expect("a number");
    assert!((turns * std::f64::consts::TAU - 20.0).abs() < 1e-9, "{last}");
}

#[test]
fn names_are_quoted_where_they_must_be() {
    let scene = r#"{"name":"n","tick_rate":60,"bodies":[{"name":"a, \"b\""},{}]}"#;
    let output = run(scene, &["--ticks", "0"]);
    assert!(output.out.contains("0,0.000000000000000,\"a, \"\"b\"\"\",0"), "{}", output.out);
    assert!(output.out.contains("0,0.000000000000000,1,0"), "{}", output.out);
}

#[test]
fn script_creates_and_destroys() {
    let scene = r#"{"name":"n","tick_rate":60,"bodies":[{"name":"a"}],"commands":[
        {"tick":2,"do":{"destroy_body":{"body":"b"}}},
        {"tick":1,"do":{"create_body":{"name":"b"}}},
        {"tick":1,"do":{"apply_impulse":{"body":"b","impulse":[6,0]}}}]}"#;
    let output = run(scene, &["--ticks", "3"]);
    let bodies: Vec<String> =
        output.out.lines().skip(1).map(|l| l.split(',').step_by(2).take(2).collect::<Vec<_>>().join(":")).collect();
    assert_eq!(bodies, ["0:a", "1:a", "2:a", "2:b", "3:a"]);
    assert!(output.out.contains("2,0.033333333333333,b,0.1000000000931322574615478515625,0"), "{}", output.out);
}

#[test]
fn sleepers_are_shown_where_bodies_sleep() {
    let scene = |sleeping: &str| {
        let bodies = r#"[{"name":"a"},{"name":"b","allow_sleep":false},{"name":"c","position":[9,0]}]"#;
        let commands = r#"[{"tick":4,"do":{"wake":{"body":"a"}}},{"tick":1,"do":{"put_to_sleep":{"body":"c"}}}]"#;
        format!(r#"{{"name":"n","tick_rate":60{sleeping},"bodies":{bodies},"commands":{commands}}}"#)
    };
    for (sleeping, asleep) in [
        (r#","sleeping":{"time":0.05}"#, ["", "", "c", "ac", "ac", "c"]),
        (r#","sleeping":true"#, ["", "", "c", "c", "c", "c"]),
    ] {
        let output = run(&scene(sleeping), &["--ticks", "5"]);
        assert!(output.out.starts_with("tick,time,body,x,y,angle,turns,vx,vy,omega,asleep\n"), "{}", output.out);
        for (tick, asleep) in asleep.into_iter().enumerate() {
            let rows = output.out.lines().filter(|line| line.starts_with(&format!("{tick},")));
            let names: String =
                rows.filter(|row| row.ends_with(",true")).filter_map(|row| row.split(',').nth(2)).collect();
            assert_eq!(names, asleep, "{sleeping}, tick {tick}: {}", output.out);
        }
    }
    let json = run(&scene(r#","sleeping":true"#), &["--ticks", "2", "--format", "json"]);
    assert!(json.out.contains(r#""omega":0,"asleep":true}"#), "{}", json.out);
    // Where nobody sleeps the table is as ever, and the commands say so.
    let output = run(&scene(r#","sleeping":false"#), &["--ticks", "1"]);
    assert!(!output.out.contains("asleep"), "{}", output.out);
}

#[test]
fn bad_scenes_are_refused_with_their_place() {
    let body = |keys: &str| format!(r#"{{"name":"n","tick_rate":60,"bodies":[{{}},{{{keys}}}]}}"#);
    let top = |keys: &str| format!(r#"{{"name":"n","tick_rate":60,"bodies":[],{keys}}}"#);
    let cases = [
        ("".into(), "EOF while parsing"),
        ("[]".into(), "invalid type: sequence, expected an object at line 1 column 0"),
        (r#"{"name":"n","tick_rate":60,"bodies":[["a"]]}"#.into(), "bodies[0]: invalid type: sequence"),
        (r#"{"name":"n","bodies":[]}"#.into(), "missing field `tick_rate`"),
        (r#"{"tick_rate":60,"bodies":[]}"#.into(), "missing field `name`"),
        (r#"{"name":"n","tick_rate":60}"#.into(), "missing field `bodies`"),
        (r#"{"name":"n","tick_rate":0,"bodies":[]}"#.into(), "tick_rate 0 1/s is outside 15 … 1000 1/s"),
        (r#"{"name":"n","tick_rate":60.5,"bodies":[]}"#.into(), "tick_rate: "),
        (r#"{"name":"n","tick_rate":60,"bodies":[]} x"#.into(), "trailing characters"),
        (r#"{"name":"n","tick_rate":60,"bodies":[],"name":"m"}"#.into(), "duplicate field `name`"),
        (top(r#""substeps":65"#), "substeps 65 is outside 1 … 64"),
        (top(r#""gravty":[0,0]"#), "gravty: unknown field `gravty`"),
        (top(r#""gravity":[0]"#), "gravity: invalid length 1"),
        (top(r#""gravity":[0,0,0]"#), "gravity: invalid length 3"),
        (top(r#""gravity":["0",0]"#), "gravity[0]: acceleration is expected to be a number"),
        (top(r#""gravity":[0,1e5]"#), "gravity[1]: acceleration 100000 m/s² is outside ±(32768 − 2⁻⁴⁸) m/s²"),
        (top(r#""gravity":[0,1e999999999999]"#), "gravity[1]: acceleration is not a decimal number"),
        (top(r#""attractors":[{"mu":1}]"#), "attractors[0]: missing field `position`"),
        (
            top(r#""attractors":[{"position":[0,0],"mu":-1}]"#),
            "attractors[0].mu: mu -1 m³/s² is outside 0 … 2e21 m³/s²",
        ),
        (top(r#""commands":[{"tick":0,"do":{"fly":{}}}]"#), "unknown variant `fly`"),
        (top(r#""commands":[{"tick":0,"do":{"set_mu":{"body":0,"mu":1}}}]"#), "commands[0]: there is no body 0"),
        (top(r#""commands":[{"tick":0,"do":{"destroy_attractor":{"attractor":"x"}}}]"#), "there is no attractor \"x\""),
        (
            top(r#""commands":[{"tick":0,"do":{"create_body":{"kind":"static","force":[1,0]}}}]"#),
            "commands[0].do.create_body: a static body has no force",
        ),
        (body(r#""mass":0"#), "bodies[1].mass: mass 0 kg is outside 0.000001 … 2100000000 kg at line 1"),
        (body(r#""mass":-1"#), "mass -1 kg is outside"),
        (body(r#""mass":"1""#), "bodies[1].mass: mass is expected to be a number in kg"),
        (body(r#""inertia":0"#), "bodies[1].inertia: inertia 0 kg m² is outside"),
        (body(r#""kind":"ghost""#), "bodies[1].kind: unknown variant `ghost`"),
        (body(r#""angle":6.2831853072"#), "bodies[1].angle: angle 6.2831853"),
        (body(r#""angle":-0.1"#), "is outside 0 … 2π rad"),
        (body(r#""position":[1000000000.1,0]"#), "bodies[1].position[0]: length 1000000000.1"),
        (body(r#""velocity":[32768,0]"#), "bodies[1].velocity[0]: velocity 32768 m/s is outside ±(32768 − 2⁻⁴⁸) m/s"),
        (body(r#""linear_damping":-1"#), "bodies[1].linear_damping: damping -1 1/s is outside 0 … 1000 1/s"),
        (body(r#""kind":"static","velocity":[1,0]"#), "bodies[1]: a static body has no velocity"),
        (body(r#""kind":"kinematic","force":[1,0]"#), "bodies[1]: a kinematic body has no force"),
        (body(r#""fixed_rotation":true,"torque":1"#), "bodies[1]: a body with fixed rotation has no torque"),
        (body(r#""mass":0.000001,"force":[1,0]"#), "bodies[1]: acceleration"),
        (body(r#""name":"""#), "bodies[1]: its name must have 1 to 64 characters"),
        (body(r#""name":"0""#), "bodies[1]: its name \"0\" is in use already"),
        (body(r#""mass":null"#), "bodies[1].mass: mass is expected to be a number in kg"),
        (body(r#""name":null"#), "bodies[1].name: invalid type: null"),
        (body(r#""kind":{"static":null}"#), "bodies[1].kind: invalid type: map"),
        (top(r#""integrator":{"symplectic_euler":null}"#), "integrator: invalid type: map"),
        (
            top(r#""commands":[{"tick":0,"do":{}}]"#),
            "commands[0].do: invalid length 0, expected an object with one command",
        ),
        (top(r#""commands":[{"tick":0,"do":{"clear_status":[]}}]"#), "invalid type: sequence, expected an object"),
        (top(r#""commands":[{"tick":0,"do":{"clear_status":{},"input":{"text":""}}}]"#), "invalid length 2"),
        (
            top(r#""commands":[{"tick":0,"do":{"set_force":["a",[1,2]]}}]"#),
            "invalid type: sequence, expected an object",
        ),
        (top(r#""commands":[{"tick":0,"do":{"clear_status":{"x":1}}}]"#), "unknown field `x`"),
        (body(r#""\u001b[31mred\r\n\u2028":1"#), "unknown field ` [31mred"),
        (body(&format!(r#""{}":1"#, "k".repeat(5000))), "bodies[1].kkkk"),
        (body(r#""user_data":-1"#), "bodies[1].user_data: invalid value"),
        (top(r#""unit_shift":11"#), "unit_shift 11 is outside 0 … 10"),
        (top(r#""unit_shift":-1"#), "unit_shift: invalid value"),
        (top(r#""sleeping":1"#), "sleeping: invalid type: integer `1`, expected true, false or an object"),
        (top(r#""sleeping":{"sped":1}"#), "sleeping.sped: unknown field `sped`"),
        (top(r#""sleeping":{"time":1,"time":1}"#), "sleeping: duplicate field `time`"),
        (top(r#""sleeping":{"speed":-1}"#), "speed of what falls asleep -1 m/s is outside 0 … 400 m/s"),
        (body(r#""allow_sleep":1"#), "bodies[1].allow_sleep: invalid type"),
    ];
    for (scene, expected) in cases {
        refused(&scene, expected);
    }
}

/// Asserts that a scene is refused with this in the one line on stderr.
#[track_caller]
fn refused(scene: &str, expected: &str) {
    let output = run(scene, &["--ticks", "1"]);
    assert_eq!(output.status, 2, "{scene}\n{}", output.err);
    assert!(output.err.contains(expected), "{scene}\nsays {}\nnot {expected}", output.err);
    assert_eq!(output.err.lines().count(), 1, "{}", output.err);
    assert!(output.err.len() < 4000 && !output.err.trim_end().contains(char::is_control), "{}", output.err);
    assert_eq!(output.out, "", "{scene}");
}

#[test]
fn bad_colliders_are_refused_with_their_place() {
    let body = |keys: &str| format!(r#"{{"name":"n","tick_rate":60,"bodies":[{{}},{{{keys}}}]}}"#);
    for (keys, expected) in [
        (r#""center":[0]"#, "bodies[1].center: invalid length 1"),
        (r#""center":null"#, "bodies[1].center: invalid type: null"),
        (r#""center":[0,16001]"#, "bodies[1]: center coordinate 16001 m is outside ±16000 m"),
        (r#""colliders":{}"#, "bodies[1].colliders: invalid type: map"),
        (r#""colliders":[[1]]"#, "bodies[1].colliders[0]: invalid type: sequence, expected an object"),
        (r#""mass":1,"inertia":1e-5,"colliders":[{"circle":1}]"#, "bodies[1]: a radius of gyration of 0.00316"),
    ] {
        refused(&body(keys), expected);
    }
    // The second collider of the second body.
    for (keys, place, expected) in [
        ("", "", "a collider has exactly one of box, polygon and circle at line 1"),
        (r#""box":[1,1],"circle":1"#, "", "a collider has exactly one of"),
        (r#""circle":1,"polygon":[[0,0],[1,0],[0,1]]"#, "", "a collider has exactly one of"),
        (r#""circle":1,"circle":1"#, "", "duplicate field `circle`"),
        (r#""circle":1,"bouncy":1"#, ".bouncy", "unknown field `bouncy`"),
        (r#""box":1"#, ".box", "invalid type: integer `1`, expected length as a list of two numbers, [x, y], in m"),
        (r#""box":null"#, ".box", "invalid type: null"),
        (r#""box":[1]"#, ".box", "invalid length 1"),
        (r#""box":[1,"1"]"#, ".box[1]", "length is expected to be a number in m"),
        (r#""box":[0,1]"#, ".box", "width 0 m is outside 0.000001 … 16000 m"),
        (r#""box":[1,16001]"#, ".box", "height 16001 m is outside 0.000001 … 16000 m"),
        (r#""circle":[1]"#, ".circle", "length is expected to be a number in m"),
        (r#""circle":-1"#, ".circle", "radius -1 m is outside 0.000001 … 16000 m"),
        (r#""polygon":[[0,0],[1,0]]"#, ".polygon", "2 vertices are outside 3 … 8"),
        (r#""polygon":[[0,0],[1,0],[0]]"#, ".polygon[2]", "invalid length 1"),
        (r#""polygon":[[0,0],[1,0],[0,1e10]]"#, ".polygon[2][1]", "length 10000000000 m is outside"),
        (r#""polygon":[[0,0],[2,0],[0.5,0.5],[0,2]]"#, ".polygon", "the polygon is not convex at vertex 2"),
        (r#""circle":1,"offset":[16001,0]"#, "", "coordinate 16001 m is outside ±16000 m"),
        (r#""circle":500,"offset":[16000,0]"#, "", "the collider reaches 16500.00"),
        (r#""circle":1,"angle":-1"#, ".angle", "angle -1 rad is outside 0 … 2π rad"),
        (r#""circle":1,"density":0"#, ".density", "density 0 kg/m² is outside 0.000000001 … 1e12 kg/m²"),
        (r#""circle":1,"restitution":1.1"#, ".restitution", "restitution 1.1"),
        (r#""circle":1,"restitution":"#, ".restitution", "expected value"),
        (r#""circle":1,"friction":-1"#, ".friction", "friction -1 is outside 0 … 100 at line 1"),
        (r#""circle":1,"friction":null"#, ".friction", "friction is expected to be a number"),
        (r#""circle":1,"filter":[1,2]"#, ".filter", "invalid type: sequence, expected an object"),
        (r#""circle":1,"filter":{"group":1}"#, ".filter.group", "unknown field `group`"),
        (
            r#""circle":1,"filter":{"mask":4294967296}"#,
            ".filter.mask",
            "invalid value: integer `4294967296`, expected u32",
        ),
        (r#""circle":1,"filter":{"category":-1}"#, ".filter.category", "invalid value: integer `-1`, expected u32"),
        (r#""circle":1,"sensor":1"#, ".sensor", "invalid type: integer `1`, expected a boolean"),
    ] {
        let expected = format!("bodies[1].colliders[1]{place}: {expected}");
        refused(&body(&format!(r#""colliders":[{{"circle":1}},{{{keys}}}]"#)), &expected);
    }
    let command = |action: &str| {
        format!(
            r#"{{"name":"n","tick_rate":60,"bodies":[{{"name":"a","colliders":[{{"circle":1}},{{"circle":2}}]}}],
            "commands":[{{"tick":9,"do":{{{action}}}}}]}}"#
        )
    };
    for (action, expected) in [
        (r#""create_body":{"colliders":[{"circle":0}]}"#, "commands[0].do.create_body.colliders[0].circle: radius 0 m"),
        (r#""set_surface":{"body":"b","restitution":0,"friction":0}"#, "commands[0]: there is no body \"b\""),
        (
            r#""set_surface":{"body":"a","collider":2,"restitution":0,"friction":0}"#,
            "commands[0]: body \"a\" has no collider 2",
        ),
        (r#""set_surface":{"body":"a","restitution":0}"#, "commands[0].do.set_surface: missing field `friction`"),
        (
            r#""set_surface":{"body":"a","restitution":2,"friction":0}"#,
            "commands[0].do.set_surface.restitution: restitution 2 is outside 0 … 1",
        ),
        (r#""set_surface":{"body":"a","collider":-1,"restitution":0,"friction":0}"#, "set_surface.collider: invalid"),
        (r#""set_filter":{"body":"a","category":1}"#, "commands[0].do.set_filter: missing field `mask`"),
        (r#""set_filter":{"body":0,"collider":7,"category":1,"mask":1}"#, "commands[0]: body \"a\" has no collider 7"),
        (r#""set_filter":{"body":0,"category":1,"mask":-1}"#, "commands[0].do.set_filter.mask: invalid value"),
    ] {
        refused(&command(action), expected);
    }
}

/// x of the last row that is about `name`.
fn last_x(output: &Output, name: &str) -> f64 {
    let row = output.out.lines().rfind(|line| line.split(',').nth(2) == Some(name));
    row.expect("a row").split(',').nth(3).expect("a field").parse().expect("a number")
}

#[test]
fn every_key_of_a_collider_is_taken() {
    // The centre of mass lies in the middle of equal areas, of which a sensor has none: the impulse at it turns nothing.
    let scene = r#"{"name":"n","tick_rate":60,"unit_shift":1,"bodies":[{"name":"a","colliders":[
        {"box":[2,1],"offset":[3,0],"angle":1.5707963267948966,"density":2,"restitution":0.25,"friction":0.5,
         "filter":{"category":3,"mask":5},"sensor":false},
        {"polygon":[[0,0],[0,1],[2,1],[2,0]],"offset":[0,-0.5],"density":2,"filter":{}},
        {"circle":4,"sensor":true,"filter":{"mask":0}}]}],
        "commands":[{"tick":0,"do":{"apply_impulse":{"body":"a","impulse":[0,8],"point":[2,0]}}}]}"#;
    let output = run(scene, &["--ticks", "60"]);
    assert_eq!((output.status, output.err.as_str()), (0, ""));
    // 8 kg, by areas and densities.
    assert!(output.out.contains("60,1.000000000000000,a,0,"), "{}", output.out);
    let last: Vec<f64> =
        output.out.lines().last().expect("rows").split(',').skip(3).map(|f| f.parse().unwrap()).collect();
    let [x, y, angle, _, vx, vy, omega] = last[..] else { panic!("{last:?}") };
    assert_eq!([x, angle, vx, vy, omega], [0.0, 0.0, 0.0, 1.0, 0.0]);
    assert!((y - 1.0).abs() < 1e-7, "{y}");
    // A given centre, mass and inertia are taken instead.
    let given = scene.replace(r#""name":"a","#, r#""name":"a","center":[2,0],"mass":4,"inertia":100,"#);
    let output = run(&given, &["--ticks", "60"]);
    assert!(output.out.lines().last().expect("rows").ends_with(",0,2,0"), "{}", output.out);
}

/// A ball that falls on a floor, and another that flies through a sensor and is destroyed in it.
const TOUCHING: &str = r#"{"name":"n","tick_rate":60,"gravity":[0,-10],"bodies":[
    {"name":"floor","kind":"static","colliders":[{"circle":1,"offset":[50,0]},{"box":[10,1],"offset":[0,-0.5]}]},
    {"name":"ball, bouncy","position":[0,1],"colliders":[{"circle":0.5,"restitution":0.5}]},
    {"name":"zone","kind":"static","position":[100,0],"colliders":[{"box":[2,2],"sensor":true}]}],
    "commands":[
    {"tick":0,"do":{"create_body":{"name":"late","position":[97,0],"velocity":[30,0],"kind":"kinematic",
                                   "colliders":[{"circle":0.25,"filter":{"category":2}},{"circle":0.5}]}}},
    {"tick":5,"do":{"destroy_body":{"body":"late"}}}]}"#;

#[test]
fn collisions_have_their_times_points_normals_and_impulses() {
    // Boxes of 1 kg and 1 m whose gap of 1 m closes at 2 m/s: at 0.5 s, the left one gives its 2 N s to the other.
    const HEAD_ON: &str = r#"{"name":"head-on","tick_rate":60,"gravity":[0,0],"bodies":[
        {"name":"left","position":[0,0],"velocity":[2,0],"mass":1,"colliders":[{"box":[1,1],"restitution":1}]},
        {"name":"right","position":[2,0],"mass":1,"colliders":[{"box":[1,1],"restitution":1}]}]}"#;
    let output = run(HEAD_ON, &["--ticks", "60", "--collisions"]);
    assert_eq!((output.status, output.err.as_str()), (0, ""));
    let lines: Vec<&str> = output.out.lines().collect();
    assert_eq!(lines[0], "tick,time,order,body_a,collider_a,body_b,collider_b,x,y,nx,ny,jx,jy");
    assert_eq!(lines.len(), 2, "{lines:?}");
    let row: Vec<&str> = lines[1].split(',').collect();
    let number = |at: usize| row[at].parse::<f64>().expect("a number");
    assert_eq!((&row[2..7], &row[9..11]), (&["0", "left", "0", "right", "0"][..], &["-1", "0"][..]));
    for (at, want) in [(1, 0.5), (7, 1.5), (8, 0.0), (11, -2.0), (12, 0.0)] {
        assert!((number(at) - want).abs() < 1e-7, "{lines:?}");
    }
    let json = run(HEAD_ON, &["--ticks", "60", "--collisions", "--format", "json"]);
    let rows: Vec<serde_json::Value> = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(
        (rows.len(), &rows[0]["tick"].to_string(), &rows[0]["body_b"]),
        (1, &row[0].to_string(), &"right".into())
    );
    for (key, at) in [("time", 1), ("x", 7), ("y", 8), ("nx", 9), ("ny", 10), ("jx", 11), ("jy", 12)] {
        assert_eq!(rows[0][key].as_f64(), Some(number(at)), "{key}");
    }
    assert_eq!(run(TC2, &["--ticks", "3", "--collisions", "--events"]).status, 2);
}

#[test]
fn events_name_bodies_and_the_places_of_their_colliders() {
    let output = run(TOUCHING, &["--ticks", "40", "--events"]);
    assert_eq!((output.status, output.err.as_str()), (0, ""));
    let lines: Vec<&str> = output.out.lines().collect();
    assert_eq!(lines[0], "tick,event,body_a,collider_a,body_b,collider_b");
    // The later body's discs, 2 m and 1.75 m from the zone at half a metre a tick, are destroyed in it before the sixth step.
    let sensed: Vec<&&str> = lines.iter().filter(|line| line.contains("sensor")).collect();
    for (row, want) in sensed.iter().zip([",sensor_begin,", ",sensor_begin,", ",sensor_end,", ",sensor_end,"]) {
        assert!(row.contains(want) && row.contains("late") && row.contains("zone,0"), "{sensed:?}");
    }
    assert_eq!(sensed.len(), 4, "{sensed:?}");
    for gone in [",late,0", ",late,1"] {
        assert_eq!(sensed.iter().filter(|row| row.contains(gone)).count(), 2, "{sensed:?}");
    }
    assert!(sensed[2].starts_with("6,") && sensed[3].starts_with("6,"), "{sensed:?}");
    // The ball reaches the floor after √(2·0.5/10) s, 19 ticks.
    let touched: Vec<&&str> = lines.iter().filter(|line| line.contains("contact")).collect();
    assert!(touched.len() >= 2, "{lines:?}");
    for (at, row) in touched.iter().enumerate() {
        let kind = if at % 2 == 0 { "contact_begin" } else { "contact_end" };
        let [tick, rest] = row.splitn(2, ',').collect::<Vec<_>>()[..] else { panic!("{row}") };
        assert_eq!(rest, format!("{kind},floor,1,\"ball, bouncy\",0"));
        let tick: u64 = tick.parse().expect("a number");
        assert!((18..=20).contains(&tick) || at > 0, "{touched:?}");
    }

    let json = run(TOUCHING, &["--ticks", "40", "--events", "--format", "json"]);
    let rows: Vec<serde_json::Value> = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(rows.len(), lines.len() - 1);
    for (row, line) in rows.iter().zip(&lines[1..]) {
        let text = |key: &str| row[key].as_str().expect("text").to_string();
        let quoted = |name: String| if name.contains(',') { format!("\"{name}\"") } else { name };
        let (a, b) = (quoted(text("body_a")), quoted(text("body_b")));
        let want = format!("{},{},{a},{},{b},{}", row["tick"], text("event"), row["collider_a"], row["collider_b"]);
        assert_eq!(&want, line);
    }
    let none = run(TC2, &["--ticks", "3", "--events", "--format", "json"]);
    assert!(serde_json::from_str::<Vec<serde_json::Value>>(&none.out).expect("JSON").is_empty());
    assert_eq!(run(TC2, &["--ticks", "3", "--events", "--every", "2"]).status, 2);
    // What is recorded is the same.
    let folder = folder("events");
    let (a, b) = (folder.join("a.replay"), folder.join("b.replay"));
    assert_eq!(run(TOUCHING, &["--ticks", "40", "--events", "--record", shown(&a)]).out, output.out);
    assert_eq!(run(TOUCHING, &["--ticks", "40", "--record", shown(&b)]).status, 0);
    assert_eq!(std::fs::read(a).expect("written"), std::fs::read(b).expect("written"));
}

#[test]
fn surfaces_and_filters_are_set_by_place() {
    let scene = |commands: &str| {
        format!(
            r#"{{"name":"n","tick_rate":60,"bodies":[
            {{"name":"wall","kind":"static","colliders":[{{"circle":1,"offset":[0,50]}},{{"box":[2,4],"restitution":1}}]}},
            {{"name":"ball","position":[-4,0],"velocity":[6,0],"colliders":[{{"circle":0.5,"friction":0}}]}}],
            "commands":[{commands}]}}"#
        )
    };
    let x = |commands: &str| {
        let output = run(&scene(commands), &["--ticks", "60", "--every", "60"]);
        assert_eq!((output.status, output.err.as_str()), (0, ""), "{commands}");
        last_x(&output, "ball")
    };
    // It meets the wall after 2.5 m and comes back from it, stays at it, or is not stopped.
    let close = |x: f64, want: f64| assert!((x - want).abs() < 0.25, "{x} is not {want}");
    close(x(""), -5.0);
    let set = |index: &str| {
        x(&format!(r#"{{"tick":3,"do":{{"set_surface":{{"body":"wall"{index},"restitution":0,"friction":0.5}}}}}}"#))
    };
    close(set(r#","collider":1"#), -1.5);
    close(set(r#","collider":0"#), -5.0);
    close(set(""), -5.0);
    close(x(r#"{"tick":3,"do":{"set_filter":{"body":0,"collider":1,"category":1,"mask":2}}}"#), 2.0);
    close(x(r#"{"tick":3,"do":{"set_filter":{"body":"ball","category":2,"mask":4}}}"#), 2.0);
    // A command about the collider of a body that is gone.
    let gone = r#"{"tick":1,"do":{"destroy_body":{"body":"wall"}}},
        {"tick":2,"do":{"set_filter":{"body":"wall","collider":1,"category":1,"mask":1}}}"#;
    let output = run(&scene(gone), &["--ticks", "5"]);
    assert_eq!(output.status, 1);
    assert!(output.err.contains("tick 2: commands[1]: there is no body \"wall\" any more"), "{}", output.err);
}

#[test]
fn a_mass_set_without_inertia_brings_that_of_the_colliders() {
    // 3 kg as a box of 1 m by 1 m: I = m·(w² + h²)/12. Without colliders: m times 1 m².
    for (colliders, want) in [(r#"[{"box":[1,1]}]"#, "0.5"), ("[]", "3")] {
        let scene = format!(
            r#"{{"name":"n","tick_rate":60,"bodies":[{{"colliders":{colliders}}}],"commands":[
            {{"tick":0,"do":{{"set_mass":{{"body":0,"mass":3}}}}}},
            {{"tick":0,"do":{{"apply_angular_impulse":{{"body":0,"impulse":1.5}}}}}}]}}"#
        );
        let output = run(&scene, &["--ticks", "1"]);
        let omega: f64 =
            output.out.lines().last().expect("a row").rsplit(',').next().expect("a field").parse().unwrap();
        let inertia: f64 = want.parse().unwrap();
        assert!((omega - 1.5 / inertia).abs() < 1e-9, "{omega} with {want}");
    }
}

#[test]
fn every_key_is_legal_on_each_kind_where_it_means_something() {
    for kind in ["dynamic", "kinematic", "static"] {
        let moving = if kind == "static" { "0" } else { "1" };
        let forced = if kind == "dynamic" { "1" } else { "0" };
        let scene = format!(
            r#"{{"name":"n","tick_rate":60,"bodies":[{{"name":"a","kind":"{kind}","position":[1,2],"angle":1,
            "velocity":[{moving},0],"angular_velocity":{moving},"force":[{forced},0],"torque":{forced},"mass":2,"inertia":3,
            "fixed_rotation":false,"linear_damping":{forced},"angular_damping":{forced},"mu":4,"user_data":5,
            "colliders":[]}}]}}"#
        );
        let output = run(&scene, &["--ticks", "1"]);
        assert_eq!((output.status, output.err.as_str()), (0, ""), "{scene}");
    }
}

#[test]
fn a_command_refused_while_running_fails_with_its_place() {
    let scene = r#"{"name":"n","tick_rate":60,"bodies":[{"name":"a"}],"commands":[
        {"tick":2,"do":{"apply_impulse":{"body":"a","impulse":[40000,0]}}}]}"#;
    let output = run(scene, &["--ticks", "5"]);
    assert_eq!(output.status, 1);
    assert!(
        output.err.contains("tick 2: commands[0]: velocity 40000 m/s is outside ±(32768 − 2⁻⁴⁸) m/s"),
        "{}",
        output.err
    );
}

#[test]
fn wrong_usage_is_2() {
    for args in [
        vec!["run"],
        vec!["run", "-", "--ticks", "-1"],
        vec!["run", "-", "--ticks", "1", "--every", "0"],
        vec!["run", "no/such/scene.json", "--ticks", "1"],
        vec!["fly"],
        vec!["verify"],
        vec!["verify", "no/such/file.replay"],
        vec!["verify", "src"],
        vec!["verify", "Cargo.toml"],
        vec!["info", "Cargo.toml"],
        vec!["record", "no_such_scene"],
        vec!["record"],
        vec!["scenes", "--show", "no_such_scene"],
    ] {
        let output = tamias(&args);
        assert_eq!(output.status, 2, "{args:?}: {}", output.err);
        assert_eq!(output.err.lines().count(), 1, "{args:?}: {}", output.err);
    }
}

#[test]
fn recorded_runs_verify_and_bad_files_are_named() {
    let folder = folder("recorded");
    let good = folder.join("good.replay");
    let output = run(TC2, &["--ticks", "100", "--every", "100", "--record", shown(&good)]);
    assert_eq!((output.status, output.err.as_str()), (0, ""));
    let output = tamias(&["verify", shown(&good)]);
    assert_eq!(output.status, 0);
    assert!(output.out.starts_with("ok ") && output.out.contains(": 100 ticks, 0 commands, hash "), "{}", output.out);

    let bytes = std::fs::read(&good).expect("just written");
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).expect("the test's folder");
        path
    };
    // An idle tick has 9 bytes, the parts after tick 60 have 81, the end 25: cut inside tick 98, and change the hash of tick 50.
    let cut = write("cut.replay", &bytes[..bytes.len() - 25 - 9 * 2 - 3]);
    let mut changed = bytes.clone();
    let at = bytes.len() - 25 - 9 * 51 - 81 + 1;
    changed[at] ^= 1;
    let changed = write("changed.replay", &changed);
    let mut longer = bytes.clone();
    longer.push(0);
    let longer = write("longer.replay", &longer);
    for (path, status, expected) in [
        (&cut, 1, "truncated at byte"),
        (&cut, 1, "after 97 whole ticks"),
        (&changed, 1, "replay corrupt at tick 50, byte"),
        (&longer, 2, "unexpected bytes after the replay's end"),
    ] {
        let output = tamias(&["verify", shown(path)]);
        assert_eq!(output.status, status, "{}", output.err);
        assert!(output.err.contains(expected) && output.err.contains(shown(path)), "{}", output.err);
        assert_eq!(output.err.lines().count(), 1);
    }
    let all = tamias(&["verify", shown(&folder)]);
    assert_eq!((all.status, all.err.lines().count(), all.out.lines().count()), (2, 3, 1), "{}", all.err);
    let json = tamias(&["verify", "--json", shown(&good), shown(&changed)]);
    assert_eq!(json.status, 1);
    let results: Vec<serde_json::Value> = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(results[0]["bad_tick"], 50);
    assert_eq!((results[1]["ok"].clone(), results[1]["ticks"].clone()), (true.into(), 100.into()));

    let info = tamias(&["info", shown(&good)]);
    assert_eq!(info.status, 0);
    assert!(info.out.contains("100 ticks of 1/60 s, 1.666 s"), "{}", info.out);
    let info = tamias(&["info", "--json", shown(&good)]);
    let value: serde_json::Value = serde_json::from_str(&info.out).expect("JSON");
    assert_eq!((value["ticks"].clone(), value["tick_rate"].clone()), (100.into(), 60.into()));
    assert_eq!(tamias(&["info", shown(&cut)]).status, 1);
}

#[test]
fn a_recording_does_not_overwrite_its_scene() {
    let folder = folder("same");
    let path = folder.join("scene.json");
    std::fs::write(&path, TC2).expect("the test's folder");
    let output = tamias(&["run", shown(&path), "--ticks", "1", "--record", shown(&path)]);
    assert_eq!(output.status, 2, "{}", output.err);
    assert_eq!(std::fs::read_to_string(&path).expect("still there"), TC2);
}

#[test]
fn verify_raises_its_alarm_even_when_nobody_reads_its_output() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tamias2d"))
        .args(["verify", "--hashes", "replays", "Cargo.toml"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("Cargo.toml: not a tamias2d replay"));
}

#[test]
fn an_endless_scene_is_refused() {
    if Path::new("/dev/zero").exists() {
        let output = tamias(&["run", "/dev/zero", "--ticks", "1"]);
        assert_eq!(output.status, 2);
        assert!(output.err.contains("a scene of more than 268435456 bytes"), "{}", output.err);
    }
}

#[test]
fn a_body_that_is_gone_is_named_as_the_scene_names_it() {
    let scene = r#"{"name":"n","tick_rate":60,"bodies":[{"name":"a"}],"commands":[
        {"tick":0,"do":{"destroy_body":{"body":"a"}}},{"tick":1,"do":{"set_mu":{"body":"a","mu":1}}}]}"#;
    let output = run(scene, &["--ticks", "5"]);
    assert_eq!(output.status, 1);
    assert!(output.err.contains("commands[1]: there is no body \"a\" any more"), "{}", output.err);
}

#[test]
fn recording_does_not_change_what_is_computed() {
    let folder = folder("twice");
    let (a, b) = (folder.join("a.replay"), folder.join("b.replay"));
    for path in [&a, &b] {
        let recorded = tamias(&["run", "replays/everything.json", "--ticks", "300", "--record", shown(path)]);
        let plain = tamias(&["run", "replays/everything.json", "--ticks", "300"]);
        assert_eq!(recorded.out, plain.out);
    }
    assert_eq!(std::fs::read(a).expect("written"), std::fs::read(b).expect("written"));
}

#[test]
fn the_goldens_are_what_this_build_records() {
    let folder = folder("goldens");
    assert_eq!(tamias(&["record", "--all", "--dir", shown(&folder)]).status, 0);
    let committed = Path::new(env!("CARGO_MANIFEST_DIR")).join("replays");
    let mut compared = 0;
    for entry in folder.read_dir().expect("a folder") {
        let name = entry.expect("an entry").file_name();
        let (new, old) = (std::fs::read(folder.join(&name)), std::fs::read(committed.join(&name)));
        assert!(new.expect("written") == old.expect("committed"), "{name:?} is not what this build records");
        compared += 1;
    }
    let replays = committed.read_dir().expect("a folder").filter_map(Result::ok);
    let replays = replays.filter(|e| e.path().extension().is_some_and(|x| x == "replay")).count();
    assert_eq!(compared, replays + 1, "every committed replay is recorded, and GOLDEN.txt");
}

#[test]
fn scenes_are_listed_and_shown() {
    let list = tamias(&["scenes"]);
    assert_eq!(list.status, 0);
    for line in list.out.lines() {
        let name = line.split_whitespace().next().expect("a name");
        let show = tamias(&["scenes", "--show", name]);
        assert_eq!(run(&show.out, &["--ticks", "1"]).status, 0, "{name}");
    }
}

/// A box that falls on a floor, beside a ball: recorded for as many ticks, with this velocity.
fn falling(folder: &Path, name: &str, velocity: &str, ticks: &str, commands: &str) -> PathBuf {
    let scene = format!(
        r#"{{"name":"n","tick_rate":60,"gravity":[0,-9.8],"bodies":[
            {{"name":"floor","kind":"static","position":[0,-1],"colliders":[{{"box":[50,2]}}]}},
            {{"name":"box","position":[0,2],"velocity":[{velocity},0],"user_data":7,"colliders":[{{"box":[1,1]}}]}},
            {{"name":"ball","position":[3,4],"colliders":[{{"circle":0.5,"restitution":0.5}}]}}],
            "commands":[{commands}]}}"#
    );
    let path = folder.join(name);
    let output = run(&scene, &["--ticks", ticks, "--every", "100000", "--record", shown(&path)]);
    assert_eq!((output.status, output.err.as_str()), (0, ""));
    path
}

#[test]
fn diff_names_what_differs_and_what_to_do() {
    let folder = folder("diff");
    let (a, same) = (falling(&folder, "a.replay", "1", "100", ""), falling(&folder, "same.replay", "1", "90", ""));
    let output = tamias(&["diff", shown(&a), shown(&same)]);
    assert_eq!((output.status, output.err.as_str()), (0, ""));
    assert_eq!(output.out, "same\n  both record the same from tick 0 to tick 90\n");

    // Another world from the beginning on.
    let other = falling(&folder, "b.replay", "1.5", "100", "");
    let output = tamias(&["diff", shown(&a), shown(&other)]);
    assert_eq!(output.status, 1);
    assert_eq!(output.err, format!("tamias2d: {} and {} differ at tick 0\n", shown(&a), shown(&other)));
    let field = "motion: body 1v0 (user data 7): velocity.x\n      A  1 m/s (bits 0x0001000000000000)\n      \
                 B  1.5 m/s (bits 0x0001800000000000)\n";
    assert!(output.out.contains("they begin with different worlds"), "{}", output.out);
    assert!(output.out.contains(field), "{}", output.out);

    // Other commands.
    let command = r#"{"tick":40,"do":{"apply_impulse":{"body":"ball","impulse":[1,0]}}}"#;
    let ordered = falling(&folder, "c.replay", "1", "100", command);
    let output = tamias(&["diff", shown(&a), shown(&ordered)]);
    assert_eq!(output.status, 1);
    assert!(output.out.starts_with("differ at tick 41\n"), "{}", output.out);
    assert!(output.out.contains("different commands"), "{}", output.out);
    assert!(
        output.out.contains("A has no command") && output.out.contains("B has 1 command: ApplyImpulse"),
        "{}",
        output.out
    );
    let json = tamias(&["diff", shown(&a), shown(&ordered), "--json"]);
    let report: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!((json.status, &report["same"], &report["tick"]), (1, &false.into(), &41.into()));

    // Evidence of one tick, from either recording.
    let evidence = |replay: &Path, name: &str| {
        let out = folder.join(name);
        let output = tamias(&["verify", shown(replay), "--evidence", shown(&out), "--tick", "30"]);
        assert_eq!((output.status, output.err.as_str()), (0, ""));
        assert!(output.out.starts_with("evidence of tick 30, hash "), "{}", output.out);
        out
    };
    let (of_a, of_b) = (evidence(&a, "a.evidence"), evidence(&other, "b.evidence"));
    assert_eq!(tamias(&["diff", shown(&of_a), shown(&of_a)]).status, 0);
    for pair in [[&of_a, &of_b], [&a, &of_b], [&of_a, &other]] {
        let json = tamias(&["diff", shown(pair[0]), shown(pair[1]), "--json", "--fields", "3"]);
        let report: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
        if pair[1] == &other {
            // The recording is played for its side.
            assert_eq!(report["same"], false);
        }
        assert_eq!((json.status, &report["tick"], &report["stage"]), (1, &30.into(), &"begin".into()), "{}", json.out);
        assert!(!report["fields"].as_array().expect("a list").is_empty());
        let text = json.out;
        assert!(text.contains("body 1v0 (user data 7)") && text.contains("velocity.x"), "{text}");
    }

    // Evidence that says another hash than its memory has, sealed anew.
    let mut bytes = std::fs::read(&of_a).expect("written");
    bytes[24] ^= 1;
    let end = bytes.len() - 8;
    let seal = twox_hash::XxHash3_64::oneshot(&bytes[..end]).to_le_bytes();
    bytes[end..].copy_from_slice(&seal);
    let forged = folder.join("forged.evidence");
    std::fs::write(&forged, bytes).expect("written");
    let output = tamias(&["diff", shown(&of_a), shown(&forged)]);
    assert_eq!(output.status, 1, "{}", output.out);
    assert!(output.out.contains("agrees, and the hashes do not"), "{}", output.out);

    // What cannot be compared, or read.
    let text = folder.join("text");
    std::fs::write(&text, "no recording at all").expect("written");
    for (args, words) in
        [([shown(&a), shown(&text)], "not a replay, a save or evidence"), ([shown(&a), "missing"], "missing")]
    {
        let output = tamias(&["diff", args[0], args[1]]);
        assert_eq!((output.status, output.out.as_str()), (2, ""));
        assert!(output.err.contains(words) && output.err.lines().count() == 1, "{}", output.err);
    }
    let other_tick = folder.join("c.evidence");
    tamias(&["verify", shown(&a), "--evidence", shown(&other_tick), "--tick", "31"]);
    let output = tamias(&["diff", shown(&of_a), shown(&other_tick)]);
    assert_eq!(output.status, 2);
    assert!(output.err.contains("write both with the same --tick"), "{}", output.err);
    let output = tamias(&["verify", shown(&a), "--evidence", shown(&other_tick), "--tick", "101"]);
    assert_eq!(output.status, 2);
    assert!(output.err.contains("there is no tick 101 in the replay, which has ticks 1 to 100"), "{}", output.err);
    let output = tamias(&["verify", shown(&a), "--evidence", shown(&a), "--tick", "5"]);
    assert_eq!((output.status, output.err.contains("is the replay itself")), (2, true), "{}", output.err);
}

#[test]
fn a_long_recording_is_verified_in_segments() {
    let folder = folder("segments");
    let long = falling(&folder, "long.replay", "1", "8000", "");
    let whole = tamias(&["verify", shown(&long), "--hashes", "--jobs", "1"]);
    let split = tamias(&["verify", shown(&long), "--hashes", "--jobs", "3"]);
    assert_eq!((whole.status, split.status), (0, 0));
    assert_eq!(whole.out.lines().count(), 8001);
    assert!(whole.out == split.out, "however many at a time, the hashes are the same, and in order");
    let info = tamias(&["info", shown(&long)]);
    assert!(info.out.contains("keyframes   2, and 0 ticks with evidence"), "{}", info.out);
    let output = tamias(&["verify", shown(&long), "--jobs", "3"]);
    assert!(output.out.contains(": 8000 ticks, 0 commands, hash "), "{}", output.out);
    // A tick in the second segment that no build computes, in a file that is whole in itself, cannot be made without the format;
    // a damaged one is named.
    let mut bytes = std::fs::read(&long).expect("there");
    let middle = bytes.len() * 5 / 8;
    bytes[middle] ^= 1;
    std::fs::write(&long, &bytes).expect("written");
    let output = tamias(&["verify", shown(&long), "--jobs", "3"]);
    assert_eq!(output.status, 1);
    assert!(output.err.contains("replay corrupt at tick "), "{}", output.err);
    let out = folder.join("none.evidence");
    let output = tamias(&["verify", shown(&folder.join("long.replay")), "--evidence", shown(&out)]);
    assert_eq!((output.status, out.exists()), (1, false));
}
