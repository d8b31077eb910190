//! `tamias2d diff`

use super::verify::open_file;
use super::{Failure, quoted};
use std::fmt::Write as _;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use tamias2d::replay::{Account, Comparison, Divergence, Evidence, FieldValue, Finding, Origin, compare, recompute};
use tamias2d::{Command, World};

/// Say where two recordings, saves or pieces of evidence part: tick, stage, object, field, both values.
///
/// Of two recordings of one game the first tick is found at which their hashes or commands differ. Where both sides have
/// evidence of that tick (recorded on an alarm, or written by `verify --evidence`), the first stage of the tick after which
/// memory differs is named, and every field that differs then, in decimal and in raw bits: fields that the stage does not
/// change first, then those that differ in a single bit. Where one side has evidence and this build computes what the other
/// side recorded, this build stands in for that side. Where neither is so, it says how far it can go, and which command to
/// run on the other machine.
#[derive(clap::Args)]
#[command(after_help = "Exit status: 0 they agree; 1 they differ; 2 wrong usage, unreadable, or not to be compared.")]
pub(crate) struct Diff {
    /// A replay, a save or evidence
    a: PathBuf,
    /// Another one
    b: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print so many fields at most
    #[arg(long, value_name = "N", default_value_t = 12)]
    fields: usize,
}

/// What a file is.
enum Side {
    Replay,
    Save(Box<World>),
    Evidence(Box<Evidence>),
}

/// What is known in the end.
#[derive(Default)]
struct Report {
    same: bool,
    tick: Option<u64>,
    /// Sentences, in order.
    lines: Vec<String>,
    hashes: Vec<(String, u64)>,
    divergence: Option<Divergence>,
    /// The commands to run next, on which machine.
    next: Vec<String>,
}

/// The most bytes of a save or of evidence that are read: a world of 10⁵ bodies takes an eighth of it.
const FILE_MAX: u64 = 1 << 30;

impl Diff {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let (a, b) = (read(&self.a)?, read(&self.b)?);
        let report = match (a, b) {
            (Side::Replay, Side::Replay) => self.replays()?,
            (Side::Save(a), Side::Save(b)) => self.states(&Evidence::of_state(&a), &Evidence::of_state(&b))?,
            (Side::Evidence(a), Side::Evidence(b)) => self.evidence(&a, &b)?,
            (Side::Evidence(a), Side::Replay) => self.evidence(&a, &self.of_replay(&self.b, a.tick())?)?,
            (Side::Replay, Side::Evidence(b)) => self.evidence(&self.of_replay(&self.a, b.tick())?, &b)?,
            (Side::Save(_), _) | (_, Side::Save(_)) => {
                return Err(Failure::usage("a save is compared with a save: one side is one, the other is not"));
            }
        };
        self.print(&report)?;
        let Report { same, tick, .. } = report;
        let tick = tick.map_or(String::new(), |tick| format!(" at tick {tick}"));
        if same {
            Ok(())
        } else {
            Err(Failure::failed(format_args!("{} and {} differ{tick}", shown(&self.a), shown(&self.b))))
        }
    }

    /// Two worlds as they are.
    fn states(&self, a: &Evidence, b: &Evidence) -> Result<Report, Failure> {
        let mut report = Report { divergence: self.parted(a, b)?, ..Report::default() };
        report.same = report.divergence.is_none() && a.hash() == b.hash();
        if report.divergence.is_none() && !report.same {
            let line = "all that memory holds agrees, and the hashes do not: one of the files was changed";
            report.lines.push(line.into());
        }
        report.hashes = vec![("A".into(), a.hash()), ("B".into(), b.hash())];
        Ok(report)
    }

    /// Evidence of one tick.
    fn evidence(&self, a: &Evidence, b: &Evidence) -> Result<Report, Failure> {
        let (of_a, of_b) = (a.tick(), b.tick());
        if of_a != of_b {
            return Err(Failure::usage(format_args!(
                "evidence of tick {of_a} and of tick {of_b} cannot be compared: write both with the same --tick"
            )));
        }
        let mut report = self.states(a, b)?;
        report.tick = Some(of_a);
        for (side, evidence) in [("A", a), ("B", b)] {
            report.lines.push(format!("{side} is {}", describe(evidence)));
        }
        Ok(report)
    }

    /// What this build makes of a tick of a replay, the world's.
    fn of_replay(&self, path: &Path, tick: u64) -> Result<Evidence, Failure> {
        let begun = super::verify::open(path)?.world().tick();
        let recorded = tick.checked_sub(begun).filter(|&recorded| recorded > 0).ok_or_else(|| {
            Failure::usage(format_args!("{}: begins at tick {begun}, and the evidence is of tick {tick}", shown(path)))
        })?;
        recompute(&mut open_file(path)?, recorded).map_err(|error| super::verify::failure(path, &error))
    }

    fn replays(&self) -> Result<Report, Failure> {
        let paths = [&self.a, &self.b];
        let (mut a, mut b) = (open_file(&self.a)?, open_file(&self.b)?);
        let comparison =
            compare([&mut a, &mut b]).map_err(|(side, error)| super::verify::failure(paths[side], &error))?;
        match comparison {
            Comparison::Same { from, to } => {
                let lines = vec![format!("both record the same from tick {from} to tick {to}")];
                Ok(Report { same: true, lines, ..Report::default() })
            }
            Comparison::Apart { begins: [a, b] } => Err(Failure::usage(format_args!(
                "the recordings have no tick in common: A begins at tick {a}, B at tick {b}"
            ))),
            Comparison::Parted { tick, by_commands, accounts } => self.parting(tick, by_commands, &accounts),
        }
    }

    /// Two recordings that part at a tick.
    fn parting(&self, tick: u64, by_commands: bool, accounts: &[Account; 2]) -> Result<Report, Failure> {
        let [a, b] = accounts;
        let mut report = Report { tick: Some(tick), ..Report::default() };
        report.hashes = vec![("A".into(), a.hash), ("B".into(), b.hash)];
        if tick == 0 || a.recorded_tick == 0 && b.recorded_tick == 0 {
            report.lines.push("they begin with different worlds".into());
            let worlds = [&self.a, &self.b].map(|path| super::verify::open(path).map(|player| player.into_world()));
            let [a, b] = worlds;
            report.divergence = self.parted(&Evidence::of_state(&a?), &Evidence::of_state(&b?))?;
            return Ok(report);
        }
        if by_commands {
            report.lines.push(
                "the game gave its worlds different commands before this tick: that is not the engine's doing".into(),
            );
            for (side, account) in [("A", a), ("B", b)] {
                report.lines.push(format!("{side} has {}", list(&account.commands)));
            }
            return Ok(report);
        }
        // What this build makes of it, from what both had in common.
        let paths = [&self.a, &self.b];
        let ours = accounts.iter().zip(paths).find_map(|(account, path)| {
            let mut file = open_file(path).ok()?;
            recompute(&mut file, account.recorded_tick).ok()
        });
        if let Some(ours) = &ours {
            report.hashes.push(("this build".into(), ours.hash()));
        }
        self.judge(&mut report, accounts, ours.as_ref())?;
        Ok(report)
    }

    /// As far as evidence, keyframes and parts go.
    fn judge(&self, report: &mut Report, accounts: &[Account; 2], ours: Option<&Evidence>) -> Result<(), Failure> {
        let [a, b] = accounts;
        let tick = report.tick.unwrap_or(0);
        // A side without evidence is stood in for by this build where that computes what the side recorded.
        let of = |account: &Account| match (&account.evidence, ours) {
            (Some(own), _) => Some((own.clone(), true)),
            (None, Some(ours)) if ours.hash() == account.hash => Some((ours.clone(), false)),
            _ => None,
        };
        let sides = [of(a), of(b)];
        for (name, side) in ["A", "B"].iter().zip(&sides) {
            match side {
                Some((evidence, true)) => report.lines.push(format!("{name} holds {}", describe(evidence))),
                Some((_, false)) => {
                    report.lines.push(format!("{name} is what this build computes, which stands in for it"))
                }
                None => report
                    .lines
                    .push(format!("{name} holds no evidence of this tick, and this build computes something else")),
            }
        }
        if let [Some((a, own_a)), Some((b, own_b))] = &sides {
            if *own_a || *own_b {
                let (a, b) =
                    if a.is_of_state() == b.is_of_state() { (a.clone(), b.clone()) } else { (a.ending(), b.ending()) };
                report.divergence = self.parted(&a, &b)?;
                if report.divergence.is_some() {
                    return Ok(());
                }
                report.lines.push(
                    "the evidence of both sides agrees: what differs came about outside of this tick's memory".into(),
                );
            }
        }
        self.parts(report, accounts, ours);
        for (side, (account, path)) in ["A", "B"].iter().zip(accounts.iter().zip([&self.a, &self.b])) {
            if account.evidence.is_none() {
                let (path, recorded) = (shown(path), account.recorded_tick);
                report.next.push(format!(
                    "on the machine that recorded {side}: tamias2d verify --evidence {side}.evidence --tick {recorded} {path}"
                ));
            }
        }
        report.next.push("then anywhere: tamias2d diff A.evidence B.evidence".into());
        if ours.is_some_and(|ours| ours.hash() == a.hash || ours.hash() == b.hash) {
            report.next.push(format!(
                "if both files agree, tick {tick} went wrong in memory and is not repeated: record with evidence (Recording::flight_ticks)"
            ));
        }
        Ok(())
    }

    /// The parts that differ, where both recorded them.
    fn parts(&self, report: &mut Report, [a, b]: &[Account; 2], ours: Option<&Evidence>) {
        let names: Vec<&str> = World::new(&tamias2d::WorldDef::default())
            .map(|world| world.hash_parts().iter().map(|part| part.name).collect())
            .unwrap_or_default();
        let (Some((at, a)), Some((also, b))) = (a.parts, b.parts) else {
            report.lines.push("the parts of the state were not recorded at it or after it".into());
            return;
        };
        if at == also {
            let differing: Vec<&str> =
                names.iter().zip(a.iter().zip(&b)).filter(|(_, (a, b))| a != b).map(|(name, _)| *name).collect();
            let which = if differing.is_empty() { "no part".into() } else { differing.join(", ") };
            report.lines.push(format!("at tick {at}, the next at which parts were recorded, {which} differs"));
        }
        if let Some(world) = ours.and_then(|ours| World::load(ours.after()).ok()) {
            let parts: Vec<String> =
                world.hash_parts().iter().map(|part| format!("{} {:016x}", part.name, part.hash)).collect();
            report.lines.push(format!("this build's parts after the tick: {}", parts.join(", ")));
        }
    }

    fn parted(&self, a: &Evidence, b: &Evidence) -> Result<Option<Divergence>, Failure> {
        a.first_difference(b).map_err(|error| Failure::usage(format_args!("the evidence cannot be read: {error}")))
    }

    fn print(&self, report: &Report) -> std::io::Result<()> {
        let text = if self.json { json(report, self.fields) } else { prose(report, self.fields) };
        let mut out = std::io::stdout().lock();
        out.write_all(text.as_bytes())?;
        out.flush()
    }
}

fn shown(path: &Path) -> std::path::Display<'_> {
    path.display()
}

/// What a file is, by its first bytes; what is small enough is read whole.
fn read(path: &Path) -> Result<Side, Failure> {
    let refused = |error: &dyn std::fmt::Display| Failure::usage(format_args!("{}: {error}", shown(path)));
    let mut file = std::fs::File::open(path).map_err(|error| refused(&error))?;
    let mut magic = [0; 8];
    file.read_exact(&mut magic).map_err(|_| refused(&"not a replay, a save or evidence of tamias2d"))?;
    if &magic == b"TAMIAS-R" {
        return Ok(Side::Replay);
    }
    let mut bytes = magic.to_vec();
    file.take(FILE_MAX).read_to_end(&mut bytes).map_err(|error| refused(&error))?;
    match &magic {
        b"TAMIAS-W" => World::load(&bytes).map(|world| Side::Save(world.into())).map_err(|error| refused(&error)),
        b"TAMIAS-E" => {
            Evidence::decode(&bytes).map(|found| Side::Evidence(found.into())).map_err(|error| refused(&error))
        }
        _ => Err(refused(&"not a replay, a save or evidence of tamias2d")),
    }
}

fn describe(evidence: &Evidence) -> String {
    match evidence.origin() {
        Origin::Taken => format!("evidence taken as it happened, by {}", evidence.build()),
        Origin::Recomputed => format!("evidence computed again, by {}", evidence.build()),
    }
}

fn list(commands: &[Command]) -> String {
    const SHOWN: usize = 4;
    let mut text = match commands.len() {
        0 => return "no command".into(),
        1 => "1 command:".into(),
        count => format!("{count} commands:"),
    };
    for command in commands.iter().take(SHOWN) {
        let _ = write!(text, " {command:?};");
    }
    if commands.len() > SHOWN {
        text.push_str(" …");
    }
    text
}

/// The moment of a divergence in words.
fn moment(divergence: &Divergence, is_tick: bool) -> String {
    let Divergence { stage, substep, findings, causes, .. } = divergence;
    let fields =
        if findings.len() == 1 { "1 field differs".into() } else { format!("{} fields differ", findings.len()) };
    let when = match substep {
        _ if !is_tick => String::new(),
        0 if stage.number() == 0 => " before the tick began".into(),
        0 => format!(" after stage {stage}"),
        substep => format!(" in stage {stage} after substep {substep}"),
    };
    let which = match causes {
        0 => "all of it made by the stage".into(),
        _ if *causes == findings.len() => "none of it made by the stage: memory, or what came before".into(),
        causes => format!("the first {causes} not made by the stage: causes, of which the rest may follow"),
    };
    format!("{fields}{when}, {which}")
}

fn prose(report: &Report, most: usize) -> String {
    let Report { same, tick, lines, hashes, divergence, next } = report;
    let mut text = String::new();
    // Writing to a String does not fail.
    match (same, tick) {
        (true, _) => text.push_str("same\n"),
        (false, Some(tick)) => drop(writeln!(text, "differ at tick {tick}")),
        (false, None) => text.push_str("differ\n"),
    }
    for (who, hash) in hashes {
        let _ = writeln!(text, "  hash {hash:016x}  {who}");
    }
    for line in lines {
        let _ = writeln!(text, "  {line}");
    }
    if let Some(divergence) = divergence {
        let _ = writeln!(text, "  {}", moment(divergence, tick.is_some()));
        for Finding { table, object, field, a, b, .. } in divergence.findings.iter().take(most) {
            if field.is_empty() {
                let who = if a.is_some() { "A" } else { "B" };
                let _ = writeln!(text, "    {table}: {object}, in {who} only");
                continue;
            }
            let _ = writeln!(text, "    {table}: {object}: {field}");
            for (who, value) in [("A", a), ("B", b)] {
                let value = value.as_ref().map_or("absent".into(), |value| value.to_string());
                let _ = writeln!(text, "      {who}  {value}");
            }
        }
        let rest = divergence.findings.len().saturating_sub(most);
        if rest > 0 {
            let _ = writeln!(text, "    and {rest} more");
        }
    }
    for line in next {
        let _ = writeln!(text, "  next, {line}");
    }
    text
}

fn json(report: &Report, most: usize) -> String {
    let Report { same, tick, lines, hashes, divergence, next } = report;
    let value = |value: &Option<FieldValue>| match value {
        Some(FieldValue { decimal, bits, unit }) => {
            format!("{{\"decimal\":{},\"bits\":{},\"unit\":{}}}", quoted(decimal), quoted(bits), quoted(unit))
        }
        None => "null".into(),
    };
    let strings = |list: &[String]| list.iter().map(|line| quoted(line)).collect::<Vec<_>>().join(",");
    let tick = tick.map_or("null".into(), |tick| tick.to_string());
    let hashes: Vec<String> = hashes.iter().map(|(who, hash)| format!("{}:\"{hash:016x}\"", quoted(who))).collect();
    let mut text = format!(
        "{{\"same\":{same},\"tick\":{tick},\"hashes\":{{{}}},\"notes\":[{}],",
        hashes.join(","),
        strings(lines)
    );
    match divergence {
        None => text.push_str("\"stage\":null,\"substep\":null,\"causes\":0,\"differing\":0,\"fields\":[],"),
        Some(Divergence { stage, substep, findings, causes, .. }) => {
            let fields: Vec<String> = findings
                .iter()
                .take(most)
                .map(|finding| {
                    let Finding { table, object, field, a, b, .. } = finding;
                    format!(
                        "{{\"table\":{},\"object\":{},\"field\":{},\"a\":{},\"b\":{},\"one_bit\":{}}}",
                        quoted(table),
                        quoted(object),
                        quoted(field),
                        value(a),
                        value(b),
                        finding.is_one_bit()
                    )
                })
                .collect();
            let _ = write!(
                text,
                "\"stage\":\"{stage}\",\"substep\":{substep},\"causes\":{causes},\"differing\":{},\"fields\":[{}],",
                findings.len(),
                fields.join(",\n")
            );
        }
    }
    let _ = writeln!(text, "\"next\":[{}]}}", strings(next));
    text
}
