//! The house rules, read off the source: floors, no floats, nothing that differs between runs, no addresses in the
//! state, one door to `bincode`, short files, nothing left to do. Each rule is also fed a source that breaks it.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The modules of the library, lowest floor first. A module sees its own floor and those below.
const FLOORS: [&[&str]; 13] = [
    &["num", "geom", "threads"],
    &["store"],
    &["shape"],
    &["body"],
    &["motion", "broad", "narrow"],
    &["contact"],
    &["solver"],
    &["world"],
    &["snapshot"],
    &["rollback"],
    &["replay"],
    &["scene", "guide", "hello"],
    &["lockstep"],
];
/// The one file with floats.
const FLOAT_FILE: &str = "num/float.rs";
/// The files that know the codec's library: for the bytes of stored state, and for a game's own state in a match.
const CODEC_FILES: [&str; 2] = ["store/codec.rs", "store/serial.rs"];
/// The files with `unsafe`: the words of lanes side by side.
const UNSAFE_FILES: [&str; 2] = ["solver/avx2.rs", "solver/avx512.rs"];
/// Names whose value or order differs between two runs, and what a lockstep engine has no use for.
const FORBIDDEN: [&str; 6] = ["HashMap", "HashSet", "Instant", "SystemTime", "thread_local", "unsafe"];
/// What a field of saved state is not made of: what differs in size or value between machines, and what is shared.
const UNPORTABLE: [&str; 8] = ["usize", "isize", "Rc", "Arc", "NonNull", "Cell", "RefCell", "&"];
const UNFINISHED: [&str; 7] = ["TODO", "FIXME", "XXX", "HACK", "todo", "unimplemented", "dbg"];
const LONGEST: usize = 420;

/// Paths below `src/` and their text.
type Tree = BTreeMap<String, String>;

// Reading Rust.

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Word,
    Integer,
    Float,
    Lifetime,
    Text,
    Mark,
}

/// A piece of code: never of a comment; a string or character literal has no text.
#[derive(Clone, Debug)]
struct Token {
    kind: Kind,
    text: String,
    line: usize,
}

impl Token {
    fn is(&self, text: &str) -> bool {
        self.text == text
    }
}

struct Lexer {
    chars: Vec<char>,
    at: usize,
    line: usize,
    tokens: Vec<Token>,
}

impl Lexer {
    fn peek(&self, ahead: usize) -> char {
        self.chars.get(self.at + ahead).copied().unwrap_or('\0')
    }

    fn step(&mut self) -> char {
        let c = self.peek(0);
        self.at += 1;
        self.line += usize::from(c == '\n');
        c
    }

    fn while_word(&mut self) -> String {
        let mut word = String::new();
        while self.peek(0).is_alphanumeric() || self.peek(0) == '_' {
            word.push(self.step());
        }
        word
    }

    fn push(&mut self, kind: Kind, text: impl Into<String>, line: usize) {
        self.tokens.push(Token { kind, text: text.into(), line });
    }

    fn block_comment(&mut self) {
        let mut depth = 0;
        while self.at < self.chars.len() {
            match (self.step(), self.peek(0)) {
                ('/', '*') => depth += 1,
                ('*', '/') => depth -= 1,
                _ => continue,
            }
            self.step();
            if depth == 0 {
                break;
            }
        }
    }

    /// From the opening quote to the closing one.
    fn quoted(&mut self, quote: char) {
        self.step();
        while self.at < self.chars.len() {
            match self.step() {
                '\\' => {
                    self.step();
                }
                c if c == quote => break,
                _ => {}
            }
        }
    }

    /// From the `#` marks or the quote behind `r` to the closing quote and as many marks.
    fn raw_quoted(&mut self) {
        let mut marks = 0;
        while self.peek(0) == '#' {
            self.step();
            marks += 1;
        }
        self.step();
        while self.at < self.chars.len() {
            if self.step() == '"' && (0..marks).all(|ahead| self.peek(ahead) == '#') {
                self.at += marks;
                break;
            }
        }
    }

    fn number(&mut self) {
        let line = self.line;
        // Behind a point, a number is a tuple's field.
        let is_field = self.tokens.last().is_some_and(|token| token.is("."));
        if self.peek(0) == '0' && matches!(self.peek(1), 'x' | 'o' | 'b') {
            let text = self.while_word();
            return self.push(Kind::Integer, text, line);
        }
        let (mut text, mut float) = (String::new(), false);
        let digits = |lexer: &mut Self, text: &mut String| {
            while lexer.peek(0).is_ascii_digit() || lexer.peek(0) == '_' {
                text.push(lexer.step());
            }
        };
        digits(self, &mut text);
        let next = self.peek(1);
        if !is_field && self.peek(0) == '.' && next != '.' && next != '_' && !next.is_alphabetic() {
            float = true;
            text.push(self.step());
            digits(self, &mut text);
        }
        let signed = usize::from(matches!(self.peek(1), '+' | '-'));
        if !is_field && matches!(self.peek(0), 'e' | 'E') && self.peek(1 + signed).is_ascii_digit() {
            float = true;
            text.push(self.step());
            text.extend((signed == 1).then(|| self.step()));
        }
        let suffix = self.while_word();
        float |= suffix.ends_with("f32") || suffix.ends_with("f64");
        text.push_str(&suffix);
        self.push(if float { Kind::Float } else { Kind::Integer }, text, line);
    }

    fn token(&mut self) {
        let (line, here, next) = (self.line, self.peek(0), self.peek(1));
        match here {
            '/' if next == '/' => {
                while self.at < self.chars.len() && self.peek(0) != '\n' {
                    self.step();
                }
            }
            '/' if next == '*' => self.block_comment(),
            '"' => {
                self.quoted('"');
                self.push(Kind::Text, "", line);
            }
            // 'a' and '\n' are characters, 'a is a lifetime.
            '\'' if next == '\\' || self.peek(2) == '\'' => {
                self.quoted('\'');
                self.push(Kind::Text, "", line);
            }
            '\'' => {
                self.step();
                let name = self.while_word();
                self.push(Kind::Lifetime, format!("'{name}"), line);
            }
            ':' if next == ':' => {
                self.at += 2;
                self.push(Kind::Mark, "::", line);
            }
            _ if here.is_ascii_digit() => self.number(),
            _ if here.is_alphabetic() || here == '_' => {
                let word = self.while_word();
                let raw = matches!(word.as_str(), "r" | "br" | "cr")
                    && (self.peek(0) == '"' || (self.peek(0) == '#' && matches!(self.peek(1), '"' | '#')));
                match (raw, word.as_str(), self.peek(0)) {
                    (true, ..) => {
                        self.raw_quoted();
                        self.push(Kind::Text, "", line);
                    }
                    (false, "b" | "c", quote @ ('"' | '\'')) => {
                        self.quoted(quote);
                        self.push(Kind::Text, "", line);
                    }
                    _ => self.push(Kind::Word, word, line),
                }
            }
            _ => {
                self.step();
                if !here.is_whitespace() {
                    self.push(Kind::Mark, here, line);
                }
            }
        }
    }
}

/// The code of a source text.
fn tokens(source: &str) -> Vec<Token> {
    let mut lexer = Lexer { chars: source.chars().collect(), at: 0, line: 1, tokens: Vec::new() };
    while lexer.at < lexer.chars.len() {
        lexer.token();
    }
    lexer.tokens
}

/// Where the bracket that opens at `open` closes.
fn closing(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate().skip(open) {
        match token.text.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at;
        }
    }
    tokens.len()
}

fn reads(tokens: &[Token], at: usize, pattern: &[&str]) -> bool {
    tokens.len() >= at + pattern.len() && tokens[at..].iter().zip(pattern).all(|(token, text)| token.is(text))
}

/// The code without its `#[cfg(test)] mod … { … }`, and how many lines those take.
fn without_tests(source: &str) -> (Vec<Token>, usize) {
    const GATE: [&str; 8] = ["#", "[", "cfg", "(", "test", ")", "]", "mod"];
    let (all, mut kept, mut lines, mut at) = (tokens(source), Vec::new(), 0, 0);
    while at < all.len() {
        let brace = at + GATE.len() + 1;
        if reads(&all, at, &GATE) && reads(&all, brace, &["{"]) {
            let end = closing(&all, brace).min(all.len() - 1);
            lines += all[end].line - all[at].line + 1;
            at = end + 1;
        } else {
            kept.push(all[at].clone());
            at += 1;
        }
    }
    (kept, lines)
}

// The tree.

/// A source file, read.
struct File<'a> {
    path: &'a str,
    source: &'a str,
    code: Vec<Token>,
    lines: usize,
}

impl File<'_> {
    /// The module a file is, from the crate's root.
    fn module(&self) -> Vec<String> {
        let path = self.path.trim_end_matches(".rs").trim_end_matches("/mod");
        path.split('/').map(str::to_owned).collect()
    }

    /// The command line program: a user of the library like any other.
    fn is_program(&self) -> bool {
        self.path == "main.rs" || self.path.starts_with("cli/")
    }

    fn is_tests(&self) -> bool {
        self.path.ends_with("/tests.rs") || self.path.contains("/tests/")
    }

    fn at(&self, line: usize, finding: impl core::fmt::Display) -> String {
        format!("src/{}:{line}: {finding}", self.path)
    }
}

fn files(tree: &Tree) -> Vec<File<'_>> {
    let mut files = Vec::new();
    for (path, source) in tree {
        let (code, test_lines) = without_tests(source);
        files.push(File { path, source, code, lines: source.lines().count() - test_lines });
    }
    files
}

/// Every breach of every rule, as `src/file:line: what`.
fn findings(tree: &Tree) -> Vec<String> {
    let files = files(tree);
    let reexports = files.iter().find(|file| file.path == "lib.rs").map(|file| reexports(&file.code));
    let reexports = reexports.unwrap_or_default();
    let mut found = Vec::new();
    for file in &files {
        found.extend(words(file, &UNFINISHED, "is unfinished work"));
        if !CODEC_FILES.contains(&file.path) {
            found.extend(words(file, &["bincode"], "is named outside store/codec.rs"));
        }
        if file.is_tests() {
            continue;
        }
        if file.lines > LONGEST {
            found.push(file.at(file.lines, format_args!("the file is longer than {LONGEST} lines")));
        }
        if file.is_program() {
            continue;
        }
        if file.path != FLOAT_FILE {
            found.extend(floats(file));
        }
        found.extend(nondeterminism(file));
        if file.path != "lib.rs" {
            found.extend(upward_paths(file, &reexports));
        }
        found.extend(unportable_records(file, &files));
    }
    found
}

/// Whole words anywhere in the text, comments too.
fn words(file: &File<'_>, denied: &[&str], why: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (index, line) in file.source.lines().enumerate() {
        for word in line.split(|c: char| !(c.is_alphanumeric() || c == '_')) {
            if denied.contains(&word) {
                found.push(file.at(index + 1, format_args!("`{word}` {why}")));
            }
        }
    }
    found
}

fn floats(file: &File<'_>) -> Vec<String> {
    let is_float = |token: &&Token| token.kind == Kind::Float || token.is("f32") || token.is("f64");
    let floats = file.code.iter().filter(is_float);
    floats.map(|token| file.at(token.line, format_args!("`{}` is a float", token.text))).collect()
}

fn nondeterminism(file: &File<'_>) -> Vec<String> {
    let mut found = Vec::new();
    for (at, token) in file.code.iter().enumerate() {
        let allowed = token.is("unsafe") && UNSAFE_FILES.contains(&file.path);
        if FORBIDDEN.contains(&token.text.as_str()) && !allowed {
            found.push(file.at(token.line, format_args!("`{}` has no place in the engine", token.text)));
        }
        if reads(&file.code, at, &["static", "mut"]) {
            found.push(file.at(token.line, "`static mut` has no place in the engine"));
        }
    }
    found
}

// Floors.

fn floor(module: &str) -> Option<usize> {
    FLOORS.iter().position(|floor| floor.contains(&module))
}

/// The names that `pub use module::…` gives to the crate's root, with their module.
fn reexports(lib: &[Token]) -> BTreeMap<String, String> {
    let mut names = BTreeMap::new();
    for (at, token) in lib.iter().enumerate() {
        if !token.is("use") {
            continue;
        }
        let end = lib[at..].iter().position(|token| token.is(";")).map_or(lib.len(), |length| at + length);
        let path: Vec<&Token> =
            lib[at + 1..end].iter().filter(|token| !token.is("crate") && !token.is("self")).collect();
        let Some(module) = path.iter().find(|token| token.kind == Kind::Word) else { continue };
        for (token, next) in path.iter().zip(path.iter().skip(1).map(Some).chain([None])) {
            // A leaf ends at a comma, a brace or the statement's end.
            let is_leaf = next.is_none_or(|next| next.is(",") || next.is("}"));
            if token.kind == Kind::Word && is_leaf {
                names.insert(token.text.clone(), module.text.clone());
            }
        }
    }
    names
}

/// The first names of the paths that begin at `at`, behind `crate::`: one, or those of a group.
fn heads(code: &[Token], at: usize) -> Vec<&Token> {
    if !reads(code, at, &["{"]) {
        return code.get(at).into_iter().collect();
    }
    let (mut heads, mut depth) = (Vec::new(), 0);
    for inner in at..closing(code, at) {
        match code[inner].text.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            _ if depth == 1 && (code[inner - 1].is("{") || code[inner - 1].is(",")) => heads.push(&code[inner]),
            _ => {}
        }
    }
    heads
}

fn upward_paths(file: &File<'_>, reexports: &BTreeMap<String, String>) -> Vec<String> {
    let (code, mut module, mut found) = (&file.code, file.module(), Vec::new());
    let Some(own) = floor(&module[0]) else {
        return vec![file.at(1, format_args!("`{}` has no floor", module[0]))];
    };
    // Braces of inline modules, with the depth they close at.
    let (mut depth, mut inline) = (0, Vec::new());
    let mut at = 0;
    while at < code.len() {
        match code[at].text.as_str() {
            "mod" if reads(code, at + 2, &["{"]) => {
                module.push(code[at + 1].text.clone());
                inline.push(depth);
            }
            "{" => depth += 1,
            "}" => {
                depth -= 1;
                if inline.last() == Some(&depth) {
                    inline.pop();
                    module.pop();
                }
            }
            _ => {}
        }
        let mut up = 0;
        let mut next = at;
        while reads(code, next, &["super", "::"]) {
            up += 1;
            next += 2;
        }
        let from_root = if reads(code, at, &["crate", "::"]) {
            next = at + 2;
            true
        } else {
            up > 0 && up >= module.len()
        };
        if from_root {
            for head in heads(code, next) {
                let target = reexports.get(&head.text).unwrap_or(&head.text);
                let told = if *target == head.text { target.clone() } else { format!("{} of {target}", head.text) };
                match floor(target) {
                    Some(floor) if floor <= own => {}
                    Some(_) => {
                        found.push(file.at(head.line, format_args!("{} sees {told}, which is above it", module[0])))
                    }
                    None => found.push(file.at(head.line, format_args!("`{told}` is no module and no name of lib.rs"))),
                }
            }
        }
        at = next.max(at + 1);
    }
    found
}

// Saved state.

/// The body of the `struct` or `enum` named `name`, with attributes.
fn definition<'a>(code: &'a [Token], name: &str) -> Option<&'a [Token]> {
    let is_item = |at: &usize| reads(code, *at, &["struct", name]) || reads(code, *at, &["enum", name]);
    let start = (0..code.len()).find(is_item)?;
    let open = (start..code.len()).find(|&at| ["{", "(", ";"].iter().any(|mark| code[at].is(mark)))?;
    let end = if code[open].is(";") { open } else { closing(code, open) };
    Some(&code[open..end])
}

/// Fields of recorded types that are no plain, portable values.
fn unportable_records(file: &File<'_>, files: &[File<'_>]) -> Vec<String> {
    let mut found = Vec::new();
    for at in 0..file.code.len() {
        let is_record =
            ["record", "record_copy", "record_enum"].iter().any(|name| reads(&file.code, at, &[name, "!", "("]));
        let Some(name) = file.code.get(at + 3).filter(|token| is_record && token.kind == Kind::Word) else { continue };
        // The type is declared beside its field list, or elsewhere under a name of its own.
        let here = definition(&file.code, &name.text).map(|body| (file, body));
        let elsewhere = || files.iter().find_map(|other| Some((other, definition(&other.code, &name.text)?)));
        let Some((owner, body)) = here.or_else(elsewhere) else {
            found.push(file.at(name.line, format_args!("`{}` is recorded and nowhere defined", name.text)));
            continue;
        };
        for (index, token) in body.iter().enumerate() {
            let pointer = token.is("*") && body.get(index + 1).is_some_and(|next| next.is("const") || next.is("mut"));
            if pointer || UNPORTABLE.contains(&token.text.as_str()) {
                let finding = format_args!("`{}` in the recorded type `{}`", token.text, name.text).to_string();
                found.push(owner.at(token.line, finding));
            }
        }
    }
    found
}

// The house itself.

fn read(folder: &Path, under: &str, tree: &mut Tree) {
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let entry = entry.expect("a readable entry");
        let name = format!("{under}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            read(&entry.path(), &format!("{name}/"), tree);
        } else if name.ends_with(".rs") {
            tree.insert(name, fs::read_to_string(entry.path()).expect("readable text"));
        }
    }
}

fn house() -> Tree {
    let mut tree = Tree::new();
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), "", &mut tree);
    tree
}

#[test]
fn the_house_keeps_its_rules() {
    let found = findings(&house());
    assert!(found.is_empty(), "\n{}\n", found.join("\n"));
}

#[test]
fn the_whole_house_is_read() {
    let tree = house();
    for path in [
        "lib.rs",
        FLOAT_FILE,
        CODEC_FILES[0],
        UNSAFE_FILES[0],
        UNSAFE_FILES[1],
        "store/record.rs",
        "snapshot.rs",
        "world/step.rs",
    ] {
        assert!(tree.contains_key(path), "{path} is missing");
    }
    let files = files(&tree);
    let lib = files.iter().find(|file| file.path == "lib.rs").expect("lib.rs");
    let names = reexports(&lib.code);
    for (name, module) in [("World", "world"), ("Vec2", "geom"), ("LAW", "snapshot"), ("BodyId", "store")] {
        assert_eq!(names.get(name).map(String::as_str), Some(module));
    }
    // Every module of the library has a floor, and every floor a module.
    let declared: Vec<&str> =
        lib.code.windows(2).filter(|pair| pair[0].is("mod")).map(|pair| pair[1].text.as_str()).collect();
    for module in &declared {
        assert!(floor(module).is_some(), "{module} has no floor");
    }
    for module in FLOORS.iter().copied().flatten() {
        assert!(declared.contains(module), "{module} is on a floor and not in lib.rs");
    }
}

#[test]
fn a_breach_put_into_the_house_is_found() {
    let breaches = [
        ("use crate::replay::Player;\n", "body sees replay, which is above it"),
        ("fn f() -> crate::World { loop {} }\n", "body sees World of world, which is above it"),
        ("const X: f32 = 1;\n", "`f32` is a float"),
        ("use std::time::Instant;\n", "`Instant` has no place in the engine"),
        ("// FIXME\n", "`FIXME` is unfinished work"),
        ("use bincode::Encode;\n", "`bincode` is named outside store/codec.rs"),
        ("struct Bad { at: usize }\nrecord!(Bad { at });\n", "`usize` in the recorded type `Bad`"),
    ];
    for (breach, finding) in breaches {
        let mut tree = house();
        let before = findings(&tree);
        let source = tree.get_mut("body/def.rs").expect("body/def.rs");
        let line = source.lines().count() + 1;
        source.push_str(breach);
        let expected = format!("src/body/def.rs:{line}: {finding}");
        let new: Vec<_> = findings(&tree).into_iter().filter(|found| !before.contains(found)).collect();
        assert_eq!(new, [expected]);
    }
}

// The rules can fail.

/// The findings in a tree of one file beside a small lib.rs.
fn check(path: &str, source: &str) -> Vec<String> {
    let lib = "mod body; pub use world::{World, step::Step as Stage}; pub use geom::Vec2;\n";
    let tree = [("lib.rs", lib), (path, source)].map(|(path, source)| (path.to_owned(), source.to_owned()));
    findings(&tree.into_iter().collect())
}

#[test]
fn code_is_told_from_comments_and_literals() {
    let source = r####"
        // f64 in a comment
        /// and in docs /* unopened
        /* block f64 /* nested */ f64 */
        const TEXT: &'static str = "f64 \" f64 // f64"; let c = '"'; let d = '\''; let e = b'"';
        let raw = r#"f64 " f64"#; let plain = r"f64 \"; let bytes = b"f64"; let longer = br##"f64 "# f64"##;
        let 'a' = 'f';
    "####;
    let code = tokens(source);
    assert!(code.iter().all(|token| !token.is("f64")), "{code:?}");
    let lifetimes: Vec<_> = code.iter().filter(|token| token.kind == Kind::Lifetime).map(|t| &t.text).collect();
    assert_eq!(lifetimes, ["'static"]);
    let lines: Vec<_> = code.iter().filter(|token| token.is("let")).map(|token| token.line).collect();
    assert_eq!(lines, [5, 5, 5, 6, 6, 6, 6, 7]);
}

#[test]
fn a_path_that_points_up_is_found() {
    let up = |path: &str, source: &str| check(path, source);
    assert_eq!(
        up("body/a.rs", "//! use crate::world;\nuse crate::world::World;"),
        ["src/body/a.rs:2: body sees world, which is above it"]
    );
    let through_lib = ["src/motion/a.rs:1: motion sees World of world, which is above it"];
    assert_eq!(up("motion/a.rs", "use crate::World;"), through_lib);
    assert_eq!(up("motion/a.rs", "fn f(w: &crate::World) {}"), through_lib);
    assert_eq!(
        up("motion/a.rs", "fn f(w: crate::Stage) {}"),
        ["src/motion/a.rs:1: motion sees Stage of world, which is above it"]
    );
    assert_eq!(
        up("store/mod.rs", "use crate::{\n    num::{Length, sqrt},\n    body::Bodies,\n    Vec2,\n    World,\n};"),
        [
            "src/store/mod.rs:3: store sees body, which is above it",
            "src/store/mod.rs:5: store sees World of world, which is above it"
        ]
    );
    assert_eq!(up("num/mod.rs", "use super::store::put;"), ["src/num/mod.rs:1: num sees store, which is above it"]);
    assert_eq!(up("num/a.rs", "use super::super::store::put;"), ["src/num/a.rs:1: num sees store, which is above it"]);
    assert_eq!(
        up("num/a.rs", "mod inner { fn f() { super::super::super::motion::go() } }"),
        ["src/num/a.rs:1: num sees motion, which is above it"]
    );
    assert_eq!(
        up("store/a.rs", "macro_rules! m { () => { $crate::body::X } }"),
        ["src/store/a.rs:1: store sees body, which is above it"]
    );
    assert_eq!(up("world/a.rs", "use crate::*;"), ["src/world/a.rs:1: `*` is no module and no name of lib.rs"]);
    assert_eq!(up("world/a.rs", "use crate::Gone;"), ["src/world/a.rs:1: `Gone` is no module and no name of lib.rs"]);
    assert_eq!(up("attic/a.rs", "fn f() {}"), ["src/attic/a.rs:1: `attic` has no floor"]);
}

#[test]
fn a_path_that_points_down_or_sideways_is_no_finding() {
    for (path, source) in [
        ("world/a.rs", "use crate::World; use super::b; use crate::world::c; use crate::{num::x, body::{self, y}};"),
        ("num/float.rs", "use crate::geom::{Rot, Vec2}; use super::quantity::Length;"),
        ("geom/rot.rs", "use crate::num::Angle;"),
        ("store/record.rs", "use crate::Vec2; pub(crate) mod sealed { use super::Quantity; } use super::codec;"),
        ("snapshot.rs", "use crate::World; use super::world::b;"),
        (
            "num/a.rs",
            "/// [`Status`](crate::Status)\n#[cfg(test)]\nmod tests { use crate::World; const X: f64 = 1.5; }",
        ),
        ("main.rs", "mod cli; fn main() { let t = 1.5; crate::cli::run() }"),
        ("cli/run.rs", "use std::time::Instant; use crate::anything;"),
    ] {
        assert_eq!(check(path, source), [""; 0], "{path}");
    }
}

#[test]
fn a_float_is_found() {
    for literal in ["1.5", "2.", "1e5", "1E-5", "1_0.0_1", "3f32", "4_f64", "1.0e+3", "5e3f64"] {
        let found = check("world/a.rs", &format!("\nlet x = {literal};"));
        assert_eq!(found, [format!("src/world/a.rs:2: `{literal}` is a float")]);
    }
    assert_eq!(check("num/a.rs", "fn f(x: f64) {}"), ["src/num/a.rs:1: `f64` is a float"]);
    assert_eq!(check("num/a.rs", "fn f(x: f32) {}"), ["src/num/a.rs:1: `f32` is a float"]);
    assert_eq!(check(FLOAT_FILE, "fn f(x: f64) { x + 1.5 }"), [""; 0]);
    // Ranges, tuple fields, methods, hexadecimal digits and names are none.
    let none = "for i in 0..8 {} x.0.1; pair.1.0; 1.max(2); 0x1e5; 0xf32; 1_u64; to_f64(); FromF64; 0..=9; \"1.5\"";
    assert_eq!(check("world/a.rs", none), [""; 0]);
}

#[test]
fn what_differs_between_runs_is_found() {
    for word in FORBIDDEN {
        let found = check("world/a.rs", &format!("//! {word}\nuse x::{word};"));
        assert_eq!(found, [format!("src/world/a.rs:2: `{word}` has no place in the engine")]);
    }
    assert_eq!(
        check("world/a.rs", "static mut COUNT: u32 = 0;"),
        ["src/world/a.rs:1: `static mut` has no place in the engine"]
    );
    assert_eq!(check(UNSAFE_FILES[1], "unsafe fn f() {}"), [""; 0]);
    assert_eq!(
        check(UNSAFE_FILES[0], "use x::HashMap;"),
        [format!("src/{}:1: `HashMap` has no place in the engine", UNSAFE_FILES[0])]
    );
    assert_eq!(check("world/a.rs", "#![deny(unsafe_code)] fn f(x: &'static mut u8, y: HashMapLike) {}"), [""; 0]);
}

#[test]
fn an_unportable_field_of_a_record_is_found() {
    for (kind, field) in
        [("usize", "usize"), ("isize", "Vec<isize>"), ("&", "&'static str"), ("*", "*const u8"), ("Rc", "Rc<u8>")]
    {
        let source = format!("pub struct Row<T> {{\n    a: u8,\n    b: {field},\n}}\nrecord!(Row {{ a, b }});");
        assert_eq!(check("body/a.rs", &source), [format!("src/body/a.rs:3: `{kind}` in the recorded type `Row`")]);
    }
    assert_eq!(
        check("body/a.rs", "struct Pair(u8, usize);\nrecord_copy!(Pair { 0, 1 });"),
        ["src/body/a.rs:1: `usize` in the recorded type `Pair`"]
    );
    assert_eq!(
        check("body/a.rs", "enum Kind {\n A {},\n B { at: usize } }\nrecord_enum!(Kind { 0 => A {}, 1 => B { at } });"),
        ["src/body/a.rs:3: `usize` in the recorded type `Kind`"]
    );
    assert_eq!(check("body/a.rs", "record!(Gone { a });"), ["src/body/a.rs:1: `Gone` is recorded and nowhere defined"]);
    // A type that is not recorded may count; a macro's definition is no use of it; the type may live elsewhere.
    let fine = "struct Free { at: usize } struct Row { a: u8 } record!(Row { a }); \
                macro_rules! m { () => { record!($t {}) } }";
    assert_eq!(check("body/a.rs", fine), [""; 0]);
    let tree = [("body/a.rs", "\nstruct Row { a: usize }"), ("body/b.rs", "record!(Row { a });")];
    let tree = tree.map(|(path, source)| (path.to_owned(), source.to_owned())).into_iter().collect();
    assert_eq!(findings(&tree), ["src/body/a.rs:2: `usize` in the recorded type `Row`"]);
}

#[test]
fn the_codec_library_outside_its_door_is_found() {
    for source in ["use bincode::Encode;", "// as bincode does", "bincode::encode();"] {
        let expected = ["src/world/a.rs:1: `bincode` is named outside store/codec.rs"];
        assert_eq!(check("world/a.rs", source), expected);
        assert_eq!(check(CODEC_FILES[0], source), [""; 0]);
    }
    assert_eq!(check("cli/a.rs", "use bincode;"), ["src/cli/a.rs:1: `bincode` is named outside store/codec.rs"]);
}

#[test]
fn a_file_that_is_too_long_is_found() {
    let long = "fn f() {}\n".repeat(LONGEST + 1);
    assert_eq!(check("world/a.rs", &long), ["src/world/a.rs:421: the file is longer than 420 lines"]);
    assert_eq!(check("cli/a.rs", &long), ["src/cli/a.rs:421: the file is longer than 420 lines"]);
    // Tests at the end of a file do not count.
    let tested =
        format!("{}#[cfg(test)]\nmod tests {{\n{}}}\n", "fn f() {}\n".repeat(LONGEST), "fn t() {}\n".repeat(50));
    assert_eq!(check("world/a.rs", &tested), [""; 0]);
}

#[test]
fn unfinished_work_is_found() {
    for word in UNFINISHED {
        let expected = [format!("src/cli/a.rs:2: `{word}` is unfinished work")];
        assert_eq!(check("cli/a.rs", &format!("\n// {word}: later")), expected);
        assert_eq!(check("cli/a.rs", &format!("\nfn f() {{ {word}!() }}")), expected);
    }
    assert_eq!(check("cli/a.rs", "// TODOS, mytodo, hacks"), [""; 0]);
}
