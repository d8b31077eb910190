//! What each process does: play, watch, or join late.

use crate::Options;
use crate::game::{Arena, JUMP, LEFT, RIGHT, THROW, VERSION};
use crate::net::{Dice, Rough, Tally};
use ggrs::{DesyncDetection, GgrsError, GgrsEvent, P2PSession, PlayerType, SessionBuilder};
use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tamias2d::hello::Hello;
use tamias2d::lockstep::{Confirmed, Lockstep, Net};
use tamias2d::replay::Recorder;
use tamias2d::{Commands, Velocity};

type Failure = Box<dyn std::error::Error>;

/// Who a process is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    Player(usize),
    Spectator,
    Joiner,
}

impl Role {
    pub fn name(self) -> String {
        match self {
            Role::Player(number) => format!("player{number}"),
            Role::Spectator => "spectator".into(),
            Role::Joiner => "joiner".into(),
        }
    }

    pub fn parse(name: &str) -> Option<Role> {
        match name {
            "spectator" => Some(Role::Spectator),
            "joiner" => Some(Role::Joiner),
            name => name.strip_prefix("player")?.parse().ok().map(Role::Player),
        }
    }
}

/// Where the others are: the ports that the parent has collected.
struct Ports {
    players: Vec<SocketAddr>,
    spectator: Option<SocketAddr>,
    tcp: u16,
}

/// Says where this process listens, and hears where the others do. Then waits in the background for the end of the match.
fn meet(udp: u16, tcp: u16) -> Result<(Ports, Arc<AtomicBool>), Failure> {
    println!("ready {udp} {tcp}");
    let mut input = BufReader::new(std::io::stdin());
    let mut line = String::new();
    input.read_line(&mut line)?;
    let ports: Vec<u16> = line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    let [tcp, spectator, players @ ..] = ports.as_slice() else { return Err("the parent is gone".into()) };
    let address = |port: u16| SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let over = Arc::new(AtomicBool::new(false));
    let flag = over.clone();
    std::thread::spawn(move || {
        // A line, or the parent's end.
        let _ = input.read_line(&mut String::new());
        flag.store(true, Ordering::Relaxed);
    });
    let players = players.iter().map(|port| address(*port)).collect();
    let spectator = (*spectator > 0).then(|| address(*spectator));
    Ok((Ports { players, spectator, tcp: *tcp }, over))
}

/// The confirmed states as this process has computed them: a line a tick, for the parent to compare.
struct Stream {
    file: BufWriter<File>,
    last: u64,
}

impl Stream {
    fn create(options: &Options, role: Role) -> Result<Stream, Failure> {
        let file = File::create(options.out.join(format!("{}.hashes", role.name())))?;
        Ok(Stream { file: BufWriter::new(file), last: 0 })
    }

    fn write(&mut self, options: &Options, tick: u64, hashes: [u64; 2]) -> Result<(), Failure> {
        if tick <= options.ticks {
            writeln!(self.file, "{tick} {:016x} {:016x}", hashes[0], hashes[1])?;
            self.last = tick;
        }
        Ok(())
    }
}

pub fn run(options: &Options, role: Role) -> Result<(), Failure> {
    match role {
        Role::Player(number) => play(options, number),
        Role::Spectator => watch(options),
        Role::Joiner => join(options),
    }
}

/// Buttons held for a while, as a player's: then repeating the last input is often a good prediction.
struct Bot {
    dice: Dice,
    buttons: u8,
}

impl Bot {
    fn press(&mut self) -> u8 {
        if self.dice.roll(12) == 0 {
            self.buttons = match self.dice.roll(5) {
                0 | 1 => LEFT,
                2 | 3 => RIGHT,
                _ => 0,
            };
            for button in [JUMP, THROW] {
                if self.dice.roll(3) == 0 {
                    self.buttons |= button;
                }
            }
        }
        self.buttons
    }
}

fn session(options: &Options, own: usize, ports: &Ports, socket: Rough) -> Result<P2PSession<Net<Arena>>, Failure> {
    let mut builder = SessionBuilder::new()
        .with_num_players(ports.players.len())?
        .with_max_prediction_window(options.window)
        .with_input_delay(options.delay)
        .with_desync_detection_mode(DesyncDetection::On { interval: 1 })
        // The processes share a machine with others: nobody is lost because he had to wait.
        .with_disconnect_timeout(Duration::from_secs(60))
        .with_disconnect_notify_delay(Duration::from_secs(30));
    for (number, address) in ports.players.iter().enumerate() {
        let player = if number == own { PlayerType::Local } else { PlayerType::Remote(*address) };
        builder = builder.add_player(player, number)?;
    }
    if let (0, Some(address)) = (own, ports.spectator) {
        builder = builder.add_player(PlayerType::Spectator(address), ports.players.len())?;
    }
    Ok(builder.start_p2p_session(socket)?)
}

/// Plays the match; player 0 also serves the spectator and whoever joins late.
fn play(options: &Options, number: usize) -> Result<(), Failure> {
    let role = Role::Player(number);
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
    listener.set_nonblocking(true)?;
    let mut socket =
        Rough::bind(options.seed.wrapping_mul(31).wrapping_add(number as u64 * 7919 + 1), options.weather)?;
    let (ports, over) = meet(socket.port()?, listener.local_addr()?.port())?;

    let (arena, world) = Arena::new(ports.players.len(), options.other_scene == Some(number));
    let mut hello = Hello::new(&world, VERSION);
    hello.law += u32::from(options.other_law == Some(number));
    let mut others: Vec<SocketAddr> = ports.players.clone();
    others.remove(number);
    others.extend(ports.spectator.filter(|_| number == 0));
    socket.greet(&hello, &others)?;

    let mut recorder = Recorder::new(world.clone(), BufWriter::new(File::create(file(options, role, "replay"))?))?;
    let mut lockstep = Lockstep::new(arena, world)?;
    if options.evidence {
        lockstep.keep_evidence(64);
    }
    let tally = socket.tally.clone();
    let mut session = session(options, number, &ports, socket)?;
    let mut bot = Bot { dice: Dice(options.seed.wrapping_add(number as u64 * 104_729 + 1) << 8 | 1), buttons: 0 };
    let (mut stream, mut frame, mut late) = (Stream::create(options, role)?, -1, None);
    let (mut fault, mut alarm, mut waits) = (Fault::new(options, number), None, 0u64);
    while stream.last < options.ticks {
        if over.load(Ordering::Relaxed) {
            return Err("the match was ended from outside".into());
        }
        if session.current_frame() != frame {
            frame = session.current_frame();
            bot.press();
        }
        session.add_local_input(number, bot.buttons)?;
        if !lockstep.advance(&mut session)? {
            waits += 1;
            std::thread::sleep(Duration::from_micros(100));
        }
        if number == 0 && late.is_none() && options.join > 0 && lockstep.settled() >= options.join {
            late = welcome(&listener, &lockstep, &hello)?;
        }
        while let Some(confirmed) = lockstep.confirmed() {
            stream.write(options, confirmed.tick, [confirmed.world, confirmed.own])?;
            record(&mut recorder, &confirmed, &mut fault)?;
            if let Some((link, after)) = &mut late {
                send(link, *after, &confirmed)?;
            }
        }
        fault.strike(&mut lockstep);
        for event in session.events() {
            match event {
                GgrsEvent::DesyncDetected { frame, local_checksum, remote_checksum, addr } if alarm.is_none() => {
                    let told = lockstep.alarm(frame, local_checksum, remote_checksum);
                    println!("alarm, by {addr}: {told}");
                    alarm = Some(told.tick);
                }
                GgrsEvent::Disconnected { addr } => return Err(format!("{addr} was cut off").into()),
                _ => {}
            }
        }
        // A few ticks later, so that the ticks about the alarm are not predictions any more.
        if alarm.is_some_and(|tick| lockstep.settled() >= tick.saturating_add(4)) {
            alarm = Some(u64::MAX);
            keep_evidence(options, role, &lockstep)?;
        }
        pace(&mut session, ports.spectator.filter(|_| number == 0).map(|_| ports.players.len()), &over);
    }
    stream.file.flush()?;
    recorder.finish()?.flush()?;
    drop(late);
    report(role, &lockstep, waits, tally.get());
    // Others may lack inputs of this player yet.
    while !over.load(Ordering::Relaxed) {
        session.poll_remote_clients();
        std::thread::sleep(Duration::from_millis(1));
    }
    Ok(())
}

fn file(options: &Options, role: Role, extension: &str) -> std::path::PathBuf {
    options.out.join(format!("{}.{extension}", role.name()))
}

/// Records a confirmed tick. The recorder has a world of its own, which computes the same commands without rollbacks: where the
/// two differ, this machine has a fault, whatever the others say.
fn record(
    recorder: &mut Recorder<BufWriter<File>>,
    confirmed: &Confirmed<'_, u8>,
    fault: &mut Fault,
) -> Result<(), Failure> {
    for command in confirmed.commands {
        recorder.apply(command.clone())?;
    }
    recorder.step();
    if recorder.world().hash() != confirmed.world && !fault.stuck {
        fault.stuck = true;
        println!("this machine's world is not that of its recording from tick {} on", confirmed.tick);
    }
    Ok(())
}

/// One bit of one velocity, flipped in memory. A rollback may undo that; then it is flipped again.
struct Fault {
    at: Option<u64>,
    struck: u64,
    stuck: bool,
}

impl Fault {
    fn new(options: &Options, number: usize) -> Fault {
        Fault { at: options.fault.filter(|(who, _)| *who == number).map(|(_, tick)| tick), struck: 0, stuck: false }
    }

    fn strike(&mut self, lockstep: &mut Lockstep<Arena>) {
        let tick = lockstep.world().tick();
        if self.stuck || self.at.is_none_or(|at| tick < at) || lockstep.settled() <= self.struck {
            return;
        }
        self.struck = tick;
        lockstep.tamper(|world| {
            let Some(body) = world.bodies().nth(5) else { return };
            let (id, mut velocity) = (body.id(), body.velocity());
            velocity.x = Velocity::from_bits(velocity.x.to_bits() ^ 1 << 20);
            let _ = world.set_velocity(id, velocity);
        });
    }
}

/// Writes the evidence of the last ticks, for comparing with another peer's.
fn keep_evidence(options: &Options, role: Role, lockstep: &Lockstep<Arena>) -> Result<(), Failure> {
    for tick in lockstep.settled().saturating_sub(24)..=lockstep.settled() {
        if let Some(evidence) = lockstep.evidence(tick) {
            std::fs::write(file(options, role, &format!("{tick}.evidence")), evidence.encode())?;
        }
    }
    Ok(())
}

/// The match must not run away from a spectator. ggrs answers only what it can decode, and for that keeps the inputs of the last 16
/// frames (twice the window that a spectator's session has by default): if he gets more than that at once and the one answer to
/// it is lost, host and spectator wait for each other for ever. So fewer are under way.
fn pace(session: &mut P2PSession<Net<Arena>>, spectator: Option<usize>, over: &AtomicBool) {
    let Some(handle) = spectator else { return };
    loop {
        match session.network_stats(handle) {
            Ok(stats) if stats.send_queue_len < 14 => return,
            Ok(_) if !over.load(Ordering::Relaxed) => {
                std::thread::sleep(Duration::from_micros(200));
                session.poll_remote_clients();
            }
            // Not known in the first second.
            Err(GgrsError::NotEnoughData) => return std::thread::sleep(Duration::from_millis(10)),
            _ => return,
        }
    }
}

fn report(role: Role, lockstep: &Lockstep<Arena>, waits: u64, tally: Tally) {
    let Tally { received, lost, doubled, overtaken } = tally;
    println!(
        "{}: {} ticks by {} steps, {waits} waits, hits {:?} by tick {}; {received} packets, {lost} lost, {doubled} doubled, {overtaken} overtaken",
        role.name(),
        lockstep.settled(),
        lockstep.steps(),
        // Of the state that is shown, which is some predicted ticks ahead: by how many, and of what, peers differ.
        lockstep.game().hits(),
        lockstep.world().tick(),
    );
    println!("done");
}

/// Watches by a spectator's session of ggrs.
fn watch(options: &Options) -> Result<(), Failure> {
    let mut socket = Rough::bind(options.seed ^ 0x5eed_0001, options.weather)?;
    let (ports, over) = meet(socket.port()?, 0)?;
    let (arena, world) = Arena::new(ports.players.len(), false);
    socket.greet(&Hello::new(&world, VERSION), &ports.players[..1])?;
    let tally = socket.tally.clone();
    let mut session = SessionBuilder::<Net<Arena>>::new()
        .with_num_players(ports.players.len())?
        .with_max_frames_behind(5)?
        .with_catchup_speed(59)?
        .with_disconnect_timeout(Duration::from_secs(60))
        .start_spectator_session(ports.players[0], socket);
    let (mut lockstep, mut stream, mut waits) =
        (Lockstep::new(arena, world)?, Stream::create(options, Role::Spectator)?, 0);
    while stream.last < options.ticks {
        if over.load(Ordering::Relaxed) {
            return Err("the match was ended from outside".into());
        }
        if !lockstep.advance(&mut session)? {
            waits += 1;
            std::thread::sleep(Duration::from_micros(200));
        }
        if session.events().any(|event| matches!(event, GgrsEvent::Disconnected { .. })) {
            return Err("the host is gone".into());
        }
        while let Some(confirmed) = lockstep.confirmed() {
            stream.write(options, confirmed.tick, [confirmed.world, confirmed.own])?;
        }
    }
    stream.file.flush()?;
    report(Role::Spectator, &lockstep, waits, tally.get());
    while !over.load(Ordering::Relaxed) {
        session.poll_remote_clients();
        std::thread::sleep(Duration::from_millis(1));
    }
    Ok(())
}

/// A late joiner's link, and the tick of the snapshot that was sent.
type Late = (BufWriter<TcpStream>, u64);

/// Sends the running match to one who knocks, if there is one.
fn welcome(listener: &TcpListener, lockstep: &Lockstep<Arena>, hello: &Hello) -> Result<Option<Late>, Failure> {
    let Ok((link, _)) = listener.accept() else { return Ok(None) };
    link.set_nonblocking(false)?;
    let snapshot = lockstep.snapshot(hello).ok_or("the settled tick is kept")?;
    let mut link = BufWriter::new(link);
    link.write_all(&(snapshot.len() as u32).to_le_bytes())?;
    link.write_all(&snapshot)?;
    Ok(Some((link, lockstep.settled())))
}

/// The inputs of a confirmed tick: how many players there are, then for each whether he is there, and his buttons.
fn send(link: &mut BufWriter<TcpStream>, after: u64, confirmed: &Confirmed<'_, u8>) -> Result<(), Failure> {
    if confirmed.tick > after {
        link.write_all(&[confirmed.inputs.len() as u8])?;
        for input in confirmed.inputs {
            link.write_all(&[u8::from(input.is_some()), input.unwrap_or(0)])?;
        }
    }
    Ok(())
}

/// Joins late: a snapshot, then the inputs since.
fn join(options: &Options) -> Result<(), Failure> {
    let (ports, _) = meet(0, 0)?;
    let mut link = BufReader::new(TcpStream::connect((Ipv4Addr::LOCALHOST, ports.tcp))?);
    let (_, world) = Arena::new(ports.players.len(), false);
    let mut length = [0; 4];
    link.read_exact(&mut length)?;
    let mut snapshot = vec![0; u32::from_le_bytes(length) as usize];
    link.read_exact(&mut snapshot)?;
    let mut lockstep = Lockstep::<Arena>::join(&Hello::new(&world, VERSION), &snapshot)?;
    println!("joins at tick {} by a snapshot of {} bytes", lockstep.settled(), snapshot.len());
    let mut stream = Stream::create(options, Role::Joiner)?;
    let mut inputs = Vec::new();
    while stream.last < options.ticks {
        let mut count = [0];
        link.read_exact(&mut count)?;
        inputs.clear();
        for _ in 0..count[0] {
            let mut input = [0; 2];
            link.read_exact(&mut input)?;
            inputs.push((input[0] != 0).then_some(input[1]));
        }
        lockstep.follow(&inputs)?;
        while let Some(confirmed) = lockstep.confirmed() {
            stream.write(options, confirmed.tick, [confirmed.world, confirmed.own])?;
        }
    }
    stream.file.flush()?;
    report(Role::Joiner, &lockstep, 0, Tally::default());
    Ok(())
}
