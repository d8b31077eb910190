//! The game: discs with players in them, who roll, jump and throw, in a room full of boxes.

use serde::{Deserialize, Serialize};
use tamias2d::lockstep::{Game, Turn};
use tamias2d::{
    BodyDef, BodyId, BodyKind, ColliderDef, Commands, Impulse, Length, Shape, Vec2, Velocity, World, WorldDef,
};

/// Changes with the rules below and with the packets of `net.rs`.
pub const VERSION: u64 = 1;

/// Buttons, as bits of an input.
pub const LEFT: u8 = 1;
pub const RIGHT: u8 = 2;
pub const JUMP: u8 = 4;
pub const THROW: u8 = 8;

/// For how long a thrown ball lives, in ticks, and how long a player waits before the next.
const LIFE: u16 = 90;
const PAUSE: u8 = 20;

/// What of a player is state beside the body in the world.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Player {
    body: BodyId,
    /// Ticks until the next throw.
    pause: u8,
    faces_right: bool,
    /// How often something thrown has hit another player.
    hits: u32,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Ball {
    body: BodyId,
    thrower: u8,
    life: u16,
}

/// All state beside the world.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Arena {
    players: Vec<Player>,
    balls: Vec<Ball>,
}

fn metres(x: f64, y: f64) -> Vec2<Length> {
    Vec2::from_f64(x, y).expect("a literal in range")
}

fn rectangle(width: f64, height: f64) -> ColliderDef {
    let [width, height] = [width, height].map(|side| Length::from_f64(side).expect("a literal in range"));
    ColliderDef::new(Shape::Box { width, height })
}

fn disc(radius: f64) -> ColliderDef {
    ColliderDef::new(Shape::Circle { radius: Length::from_f64(radius).expect("a literal in range") })
}

impl Arena {
    /// The room with so many players; `other` is another room, for showing that it is refused.
    pub fn new(players: usize, other: bool) -> (Arena, World) {
        let gravity = Vec2::from_f64(0.0, -9.8).expect("a literal in range");
        let mut world = World::new(&WorldDef { gravity, ..WorldDef::default() }).expect("a good definition");
        let mut add = |kind, x: f64, y: f64, collider: ColliderDef| {
            let def = BodyDef { kind, position: metres(x, y), colliders: vec![collider], ..BodyDef::default() };
            world.create_body(&def).expect("a good definition")
        };
        for (x, y, width, height) in [(0.0, -0.5, 30.0, 1.0), (-15.0, 5.0, 1.0, 12.0), (15.0, 5.0, 1.0, 12.0)] {
            add(BodyKind::Static, x, y, rectangle(width, height));
        }
        for row in 0..5 {
            for column in 0..5 - row {
                let x = f64::from(column) * 1.1 + f64::from(row) * 0.55 - 2.2;
                add(BodyKind::Dynamic, x, 0.5 + f64::from(row) + if other { 0.01 } else { 0.0 }, rectangle(1.0, 1.0));
            }
        }
        let place = |player: usize| (player as f64 - (players as f64 - 1.0) / 2.0) * 7.0 + 0.3;
        let players = (0..players)
            .map(|player| Player {
                body: add(BodyKind::Dynamic, place(player), 7.0, disc(0.6)),
                pause: 0,
                faces_right: place(player) < 0.0,
                hits: 0,
            })
            .collect();
        (Arena { players, balls: Vec::new() }, world)
    }

    /// What each player has hit.
    pub fn hits(&self) -> Vec<u32> {
        self.players.iter().map(|player| player.hits).collect()
    }

    fn throw(&mut self, thrower: usize, turn: &mut Turn<'_>) {
        let player = &mut self.players[thrower];
        let Some(body) = turn.world().body(player.body) else { return };
        let side = if player.faces_right { 1.0 } else { -1.0 };
        let mut ball = disc(0.2);
        ball.restitution = "0.5".parse().expect("a literal in range");
        let mut position = body.position();
        position.x = Length::from_bits(position.x.to_bits().saturating_add(metres(side * 0.9, 0.0).x.to_bits()));
        let velocity = Vec2::from_f64(side * 15.0, 3.0).expect("a literal in range");
        let def = BodyDef { position, velocity, colliders: vec![ball], ..BodyDef::default() };
        // The world refuses what is out of range, on all peers alike: then nothing was thrown.
        if let Ok(body) = turn.create_body(&def) {
            player.pause = PAUSE;
            self.balls.push(Ball { body, thrower: thrower as u8, life: LIFE });
        }
    }
}

impl Game for Arena {
    type Input = u8;

    fn act(&mut self, inputs: &[Option<u8>], turn: &mut Turn<'_>) {
        for (player, input) in inputs.iter().enumerate().take(self.players.len()) {
            // Who was cut off does nothing any more.
            let buttons = input.unwrap_or(0);
            let body = self.players[player].body;
            let push = match (buttons & LEFT != 0, buttons & RIGHT != 0) {
                (true, false) => -1.0,
                (false, true) => 1.0,
                _ => 0.0,
            };
            if push != 0.0 {
                self.players[player].faces_right = push > 0.0;
                let force = Vec2::from_f64(push * 12.0, 0.0).expect("a literal in range");
                let _ = turn.apply_force(body, force, None);
            }
            let speed = turn.world().body(body).map_or(Velocity::ZERO, |body| body.velocity().y);
            let slow = Velocity::from_f64(0.05).expect("a literal in range");
            if buttons & JUMP != 0 && speed <= slow && speed.to_bits() >= -slow.to_bits() {
                let impulse: Vec2<Impulse> = Vec2::from_f64(0.0, 5.0).expect("a literal in range");
                let _ = turn.apply_impulse(body, impulse, None);
            }
            self.players[player].pause = self.players[player].pause.saturating_sub(1);
            if buttons & THROW != 0 && self.players[player].pause == 0 {
                self.throw(player, turn);
            }
        }
        for ball in &mut self.balls {
            ball.life = ball.life.saturating_sub(1);
            if ball.life == 0 {
                let _ = turn.destroy_body(ball.body);
            }
        }
        self.balls.retain(|ball| ball.life > 0);
    }

    /// A hit is told by an event, which only the step that it happened in has.
    fn watch(&mut self, world: &World) {
        for event in world.events() {
            if event.kind != tamias2d::EventKind::ContactBegin {
                continue;
            }
            let [a, b] = [event.a, event.b].map(|collider| world.collider(collider).map(|collider| collider.body()));
            let (Some(a), Some(b)) = (a, b) else { continue };
            for (ball, target) in [(a, b), (b, a)] {
                let Some(ball) = self.balls.iter().find(|known| known.body == ball) else { continue };
                let target = self.players.iter().position(|player| player.body == target);
                if target.is_some_and(|target| target != usize::from(ball.thrower)) {
                    let hits = &mut self.players[usize::from(ball.thrower)].hits;
                    *hits = hits.saturating_add(1);
                }
            }
        }
    }
}
