//! A scene as read, and its commands as the ticks pass.

use super::error::SceneError;
use super::json::{self, Action, BodyJson, Reference, SceneJson, inertia};
use super::object::Object;
use crate::World;
use crate::body::{Attractor, BodyDef};
use crate::store::{AttractorId, BodyId};
use crate::world::{Command, CommandError, Commands, INPUT_MAX, Reply, WorldDef};
use std::collections::BTreeMap;

/// A scene that has been read and checked.
pub struct Scene {
    file: SceneJson,
    def: WorldDef,
}

impl Scene {
    /// Reads a scene from JSON text.
    ///
    /// Errors: malformed JSON, unknown or missing keys, numbers outside their ranges, bodies that cannot be so, and
    /// references to what the scene does not have, each with its place.
    pub fn parse(text: &str) -> Result<Scene, SceneError> {
        let mut json = serde_json::Deserializer::from_str(text);
        let Object(file): Object<SceneJson> = serde_path_to_error::deserialize(&mut json).map_err(|error| {
            let path = error.path().to_string();
            SceneError::new(if path == "." { String::new() } else { path }, error.inner())
        })?;
        json.end().map_err(|error| SceneError::new("", error))?;
        let def = WorldDef {
            tick_rate: file.tick_rate,
            substeps: file.substeps,
            gravity: file.gravity.0,
            integrator: file.integrator.0,
        };
        def.check().map_err(|error| SceneError::new("", error))?;
        let scene = Scene { file, def };
        scene.start()?.1.check_references()?;
        Ok(scene)
    }

    /// The scene's name.
    pub fn name(&self) -> &str {
        &self.file.name
    }

    /// What the scene shows, for people.
    pub fn about(&self) -> &str {
        &self.file.about
    }

    /// How many ticks a recording of the scene has, if nobody says otherwise.
    pub fn ticks(&self) -> u64 {
        self.file.ticks
    }

    /// The scene's world at tick 0, and the script of what is to be done to it.
    ///
    /// Errors: a body or attractor that the world refuses, with its place.
    pub fn start(&self) -> Result<(World, Script<'_>), SceneError> {
        let mut world = World::new(&self.def).map_err(|error| SceneError::new("", error))?;
        let mut script = Script::new(self);
        for (index, Object(body)) in self.file.bodies.iter().enumerate() {
            let place = || format!("bodies[{index}]");
            script.create_body(&mut world, body, &place)?;
        }
        for (index, Object(attractor)) in self.file.attractors.iter().enumerate() {
            let place = || format!("attractors[{index}]");
            script.create_attractor(&mut world, attractor.name.as_deref(), attractor.attractor(), &place)?;
        }
        Ok((world, script))
    }
}

/// Names of things in order of creation, and their ids.
struct Cast<Id> {
    /// By label: its name, or its index in decimal.
    ids: BTreeMap<String, Id>,
    /// By index.
    order: Vec<Id>,
}

impl<Id: Copy> Cast<Id> {
    fn new() -> Self {
        Cast { ids: BTreeMap::new(), order: Vec::new() }
    }

    /// The label of the next thing created; a name must not be in use already.
    fn label(&self, name: Option<&str>) -> Result<String, String> {
        let label = name.map_or_else(|| self.order.len().to_string(), String::from);
        if label.is_empty() || label.chars().count() > 64 || label.chars().any(char::is_control) {
            return Err("its name must have 1 to 64 characters, none of them a control character".into());
        }
        if self.ids.contains_key(&label) {
            // Also of one that was destroyed: in the tables that a run prints, a name means one body.
            return Err(format!("its name \"{label}\" is in use already"));
        }
        Ok(label)
    }

    fn add(&mut self, label: String, id: Id) {
        self.ids.insert(label, id);
        self.order.push(id);
    }

    fn find(&self, reference: &Reference) -> Option<Id> {
        match reference {
            Reference::Name(name) => self.ids.get(name).copied(),
            Reference::Index(index) => self.order.get(*index as usize).copied(),
        }
    }
}

/// The commands of a scene, to be carried out as the ticks pass, and the names of its bodies.
pub struct Script<'s> {
    scene: &'s Scene,
    /// The commands' places in the file, by tick; those of one tick in the file's order.
    order: Vec<usize>,
    next: usize,
    bodies: Cast<BodyId>,
    attractors: Cast<AttractorId>,
    labels: BTreeMap<BodyId, String>,
}

impl<'s> Script<'s> {
    fn new(scene: &'s Scene) -> Self {
        let commands = &scene.file.commands;
        let mut order: Vec<usize> = (0..commands.len()).collect();
        order.sort_by_key(|&at| commands[at].0.tick);
        Script { scene, order, next: 0, bodies: Cast::new(), attractors: Cast::new(), labels: BTreeMap::new() }
    }

    /// What the scene calls a body: its name, or its index in order of creation.
    pub fn label(&self, body: BodyId) -> &str {
        self.labels.get(&body).map_or("", String::as_str)
    }

    /// Carries out the commands before the step of `tick`. Ticks must come in order.
    ///
    /// Errors: a command that the world refuses, with its place. Those before it have been carried out.
    pub fn apply(&mut self, tick: u64, world: &mut impl Commands) -> Result<(), SceneError> {
        while let Some(&at) = self.order.get(self.next) {
            let Object(command) = &self.scene.file.commands[at];
            if command.tick > tick {
                break;
            }
            self.next = self.next.saturating_add(1);
            let place = || format!("commands[{at}]");
            match &command.action {
                Action::CreateBody(body) => self.create_body(world, body, &place)?,
                Action::CreateAttractor(attractor) => {
                    self.create_attractor(world, attractor.name.as_deref(), attractor.attractor(), &place)?;
                }
                action => {
                    let command = self.command(action).map_err(|error| SceneError::new(place(), error))?;
                    world.apply(command).map_err(|error| SceneError::new(place(), self.in_words(error)))?;
                }
            }
        }
        Ok(())
    }

    /// A refusal, with the scene's own name for a body or attractor that is gone.
    fn in_words(&self, error: CommandError) -> String {
        match error {
            CommandError::NoSuchBody(id) => format!("there is no body \"{}\" any more", self.label(id)),
            error => error.to_string(),
        }
    }

    fn create_body(
        &mut self,
        world: &mut impl Commands,
        body: &BodyJson,
        place: &dyn Fn() -> String,
    ) -> Result<(), SceneError> {
        let label = self.bodies.label(body.name.as_deref()).map_err(|error| SceneError::new(place(), error))?;
        let def: BodyDef = body.def();
        let id = world.create_body(&def).map_err(|error| SceneError::new(place(), error))?;
        self.labels.insert(id, label.clone());
        self.bodies.add(label, id);
        Ok(())
    }

    fn create_attractor(
        &mut self,
        world: &mut impl Commands,
        name: Option<&str>,
        attractor: Attractor,
        place: &dyn Fn() -> String,
    ) -> Result<(), SceneError> {
        let label = self.attractors.label(name).map_err(|error| SceneError::new(place(), error))?;
        let id = world.create_attractor(attractor).map_err(|error| SceneError::new(place(), error))?;
        self.attractors.add(label, id);
        Ok(())
    }

    /// The command that an action is, with its references resolved.
    fn command(&self, action: &Action) -> Result<Command, String> {
        let body = |reference: &Reference| {
            self.bodies.find(reference).ok_or_else(|| format!("there is no body {}", show(reference)))
        };
        let source = |reference: &Reference| {
            self.attractors.find(reference).ok_or_else(|| format!("there is no attractor {}", show(reference)))
        };
        Ok(match action {
            Action::CreateBody(def) => Command::CreateBody { def: def.def() },
            Action::DestroyBody(json::DestroyBody { body: b }) => Command::DestroyBody { body: body(b)? },
            Action::SetKind(json::SetKind { body: b, kind }) => Command::SetKind { body: body(b)?, kind: kind.0 },
            Action::SetPosition(json::SetPosition { body: b, position }) => {
                Command::SetPosition { body: body(b)?, position: position.0 }
            }
            Action::SetAngle(json::SetAngle { body: b, angle }) => Command::SetAngle { body: body(b)?, angle: angle.0 },
            Action::SetVelocity(json::SetVelocity { body: b, velocity }) => {
                Command::SetVelocity { body: body(b)?, velocity: velocity.0 }
            }
            Action::SetAngularVelocity(json::SetAngularVelocity { body: b, angular_velocity }) => {
                Command::SetAngularVelocity { body: body(b)?, angular_velocity: angular_velocity.0 }
            }
            Action::SetForce(json::SetForce { body: b, force }) => Command::SetForce { body: body(b)?, force: force.0 },
            Action::SetTorque(json::SetTorque { body: b, torque }) => {
                Command::SetTorque { body: body(b)?, torque: torque.0 }
            }
            Action::SetMass(json::SetMass { body: b, mass, inertia: given }) => {
                Command::SetMass { body: body(b)?, mass: mass.0, inertia: inertia(*given, mass.0) }
            }
            Action::SetFixedRotation(json::SetFixedRotation { body: b, fixed }) => {
                Command::SetFixedRotation { body: body(b)?, fixed: *fixed }
            }
            Action::SetDamping(json::SetDamping { body: b, linear, angular }) => {
                Command::SetDamping { body: body(b)?, linear: linear.0, angular: angular.0 }
            }
            Action::SetMu(json::SetMu { body: b, mu }) => Command::SetMu { body: body(b)?, mu: mu.0 },
            Action::SetUserData(json::SetUserData { body: b, user_data }) => {
                Command::SetUserData { body: body(b)?, user_data: *user_data }
            }
            Action::ApplyForce(json::ApplyForce { body: b, force, point }) => {
                Command::ApplyForce { body: body(b)?, force: force.0, point: point.map(|p| p.0) }
            }
            Action::ApplyTorque(json::ApplyTorque { body: b, torque }) => {
                Command::ApplyTorque { body: body(b)?, torque: torque.0 }
            }
            Action::ApplyImpulse(json::ApplyImpulse { body: b, impulse, point }) => {
                Command::ApplyImpulse { body: body(b)?, impulse: impulse.0, point: point.map(|p| p.0) }
            }
            Action::ApplyAngularImpulse(json::ApplyAngularImpulse { body: b, impulse }) => {
                Command::ApplyAngularImpulse { body: body(b)?, impulse: impulse.0 }
            }
            Action::CreateAttractor(attractor) => Command::CreateAttractor { attractor: attractor.attractor() },
            Action::SetAttractor(json::SetAttractor { attractor, position, mu }) => Command::SetAttractor {
                id: source(attractor)?,
                attractor: Attractor { position: position.0, mu: mu.0 },
            },
            Action::DestroyAttractor(json::DestroyAttractor { attractor }) => {
                Command::DestroyAttractor { id: source(attractor)? }
            }
            Action::SetGravity(json::SetGravity { gravity }) => Command::SetGravity { gravity: gravity.0 },
            Action::ClearStatus(json::ClearStatus {}) => Command::ClearStatus,
            Action::Input(json::Input { text }) => Command::Input { bytes: text.clone().into_bytes() },
        })
    }

    /// That every command refers to something that is created before it. Whether it still exists then, and takes the
    /// value, the world says when the tick comes.
    fn check_references(mut self) -> Result<(), SceneError> {
        struct Rehearsal(u32);
        impl Commands for Rehearsal {
            fn apply(&mut self, command: Command) -> Result<Reply, CommandError> {
                self.0 = self.0.saturating_add(1);
                let (index, generation) = (self.0, u32::MAX);
                Ok(match command {
                    Command::CreateBody { def } => {
                        def.check()?;
                        Reply::Body(BodyId { index, generation })
                    }
                    Command::Input { bytes } if bytes.len() > INPUT_MAX => {
                        return Err(CommandError::InputTooLong { length: bytes.len() as u64 });
                    }
                    Command::CreateAttractor { .. } => Reply::Attractor(AttractorId { index, generation }),
                    _ => Reply::Done,
                })
            }
        }
        self.apply(u64::MAX, &mut Rehearsal(0))
    }
}

fn show(reference: &Reference) -> String {
    match reference {
        Reference::Name(name) => format!("\"{name}\""),
        Reference::Index(index) => index.to_string(),
    }
}
