//! The network: a UDP socket that loses, doubles, delays and reorders what comes in, and the hello before a session.

use ggrs::{Message, NonBlockingSocket};
use std::collections::BTreeMap;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::time::{Duration, Instant};
use tamias2d::hello::Hello;

/// What a network does to packets.
#[derive(Clone, Copy, Debug)]
pub struct Weather {
    /// Of a thousand packets so many are lost, and so many come twice.
    pub loss: u32,
    pub double: u32,
    /// A packet is held back for as many polls; where these differ, packets overtake each other.
    pub delay: (u32, u32),
}

/// Numbers that only the seed decides.
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self, sides: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 32) % u64::from(sides.max(1))) as u32
    }
}

/// What happened to packets.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    pub received: u64,
    pub lost: u64,
    pub doubled: u64,
    pub overtaken: u64,
}

pub struct Rough {
    socket: UdpSocket,
    weather: Weather,
    dice: Dice,
    hello: Vec<u8>,
    polls: u64,
    /// What is held back: by the poll at which it is due, and its number.
    held: BTreeMap<(u64, u64), (SocketAddr, Message)>,
    newest: u64,
    pub tally: std::rc::Rc<std::cell::Cell<Tally>>,
}

/// Packets of ggrs are far smaller.
const LARGEST: usize = 8192;

impl Rough {
    pub fn bind(seed: u64, weather: Weather) -> std::io::Result<Rough> {
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
        socket.set_nonblocking(true)?;
        Ok(Rough {
            socket,
            weather,
            dice: Dice(seed | 1),
            hello: Vec::new(),
            polls: 0,
            held: BTreeMap::new(),
            newest: 0,
            tally: Default::default(),
        })
    }

    pub fn port(&self) -> std::io::Result<u16> {
        Ok(self.socket.local_addr()?.port())
    }

    /// Sends the hello until all peers have answered with theirs; whether there can be a session.
    pub fn greet(&mut self, hello: &Hello, peers: &[SocketAddr]) -> Result<(), String> {
        self.hello = hello.encode();
        let (mut missing, began) = (peers.to_vec(), Instant::now());
        let mut buffer = [0; LARGEST];
        while !missing.is_empty() {
            if began.elapsed() > Duration::from_secs(30) {
                return Err(format!("no hello from {} within 30 s", missing[0]));
            }
            for peer in &missing {
                let _ = self.socket.send_to(&self.hello, peer);
            }
            std::thread::sleep(Duration::from_millis(5));
            while let Ok((length, from)) = self.socket.recv_from(&mut buffer) {
                // Rough weather for hellos too; and the packets of play of those who are ready already must wait.
                if self.dice.roll(1000) < self.weather.loss || !buffer[..length].starts_with(&self.hello[..8]) {
                    continue;
                }
                if let Err(error) = Hello::decode(&buffer[..length]).and_then(|theirs| hello.check(&theirs)) {
                    // So that the other one can say why as well.
                    for _ in 0..10 {
                        let _ = self.socket.send_to(&self.hello, from);
                        std::thread::sleep(Duration::from_millis(2));
                    }
                    return Err(format!("no session with {from}: {error}"));
                }
                if missing.contains(&from) {
                    missing.retain(|peer| *peer != from);
                    let _ = self.socket.send_to(&self.hello, from);
                }
            }
        }
        Ok(())
    }

    fn hold(&mut self, from: SocketAddr, message: Message, number: u64) {
        let (least, most) = self.weather.delay;
        let delay = least + self.dice.roll(most.saturating_sub(least) + 1);
        self.held.insert((self.polls + u64::from(delay), number), (from, message));
    }
}

impl NonBlockingSocket<SocketAddr> for Rough {
    fn send_to(&mut self, message: &Message, to: &SocketAddr) {
        let bytes = bincode::serde::encode_to_vec(message, bincode::config::standard()).expect("a message has bytes");
        // A full buffer is a lost packet.
        let _ = self.socket.send_to(&bytes, to);
    }

    fn receive_all_messages(&mut self) -> Vec<(SocketAddr, Message)> {
        self.polls += 1;
        let mut tally = self.tally.get();
        let mut buffer = [0; LARGEST];
        while let Ok((length, from)) = self.socket.recv_from(&mut buffer) {
            let bytes = &buffer[..length];
            if bytes.starts_with(&self.hello[..8]) {
                // One who has not heard of this peer yet.
                let _ = self.socket.send_to(&self.hello, from);
                continue;
            }
            let config = bincode::config::standard().with_limit::<LARGEST>();
            let message = match bincode::serde::decode_from_slice::<Message, _>(bytes, config) {
                Ok((message, used)) if used == length => message,
                // Not from a peer.
                _ => continue,
            };
            tally.received += 1;
            if self.dice.roll(1000) < self.weather.loss {
                tally.lost += 1;
                continue;
            }
            if self.dice.roll(1000) < self.weather.double {
                tally.doubled += 1;
                self.hold(from, message.clone(), tally.received * 2);
            }
            self.hold(from, message, tally.received * 2 + 1);
        }
        let later = self.held.split_off(&(self.polls + 1, 0));
        let due = std::mem::replace(&mut self.held, later);
        for (_, number) in due.keys() {
            tally.overtaken += u64::from(*number < self.newest);
            self.newest = self.newest.max(*number);
        }
        self.tally.set(tally);
        due.into_values().collect()
    }
}
