//! A scene as read, and its commands as the ticks pass.

use super::error::SceneError;
use super::json::{self, Action, BodyJson, Reference, SceneJson};
use super::object::Object;
use super::stage::Stage;
use crate::World;
use crate::body::{Attractor, BodyDef};
use crate::geom::Vec2;
use crate::num::{Inertia, Mass};
use crate::shape::Filter;
use crate::store::{AttractorId, BodyId, ColliderId};
use crate::world::{Command, CommandError, Commands, Reply, WorldDef};
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
            // "." is the scene itself, "?" a place that the reader did not come to: neither says anything.
            let path = error.path().to_string();
            SceneError::new(if path == "." || path == "?" { String::new() } else { path }, error.inner())
        })?;
        json.end().map_err(|error| SceneError::new("", error))?;
        let def = WorldDef {
            tick_rate: file.tick_rate,
            substeps: file.substeps,
            gravity: file.gravity.0,
            integrator: file.integrator.0,
            unit_shift: file.unit_shift,
            sleeping: file.sleeping,
        };
        def.check().map_err(|error| SceneError::new("", error))?;
        let scene = Scene { file, def };
        scene.rehearse()?;
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

    /// That every command refers to something that is created before it. Whether it still exists then, and takes the
    /// value, the world says when the tick comes.
    fn rehearse(&self) -> Result<(), SceneError> {
        let (world, mut script) = self.start()?;
        script.apply(u64::MAX, &mut Rehearsal(world))
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
    /// Whose each collider is or was, and its place in the list of that body.
    colliders: BTreeMap<ColliderId, (BodyId, u32)>,
}

impl<'s> Script<'s> {
    fn new(scene: &'s Scene) -> Self {
        let commands = &scene.file.commands;
        let mut order: Vec<usize> = (0..commands.len()).collect();
        order.sort_by_key(|&at| commands[at].0.tick);
        Script {
            scene,
            order,
            next: 0,
            bodies: Cast::new(),
            attractors: Cast::new(),
            labels: BTreeMap::new(),
            colliders: BTreeMap::new(),
        }
    }

    /// What the scene calls a body: its name, or its index in order of creation.
    pub fn label(&self, body: BodyId) -> &str {
        self.labels.get(&body).map_or("", String::as_str)
    }

    /// Whose a collider is, or was before it was destroyed, and its index in the list of that body; `None` if the script
    /// did not create it.
    pub fn collider(&self, collider: ColliderId) -> Option<(BodyId, u32)> {
        self.colliders.get(&collider).copied()
    }

    /// Carries out the commands before the step of `tick`. Ticks must come in order.
    ///
    /// Errors: a command that the world refuses, with its place. Those before it have been carried out.
    pub fn apply(&mut self, tick: u64, stage: &mut impl Stage) -> Result<(), SceneError> {
        while let Some(&at) = self.order.get(self.next) {
            let Object(command) = &self.scene.file.commands[at];
            if command.tick > tick {
                break;
            }
            self.next = self.next.saturating_add(1);
            let place = || format!("commands[{at}]");
            match &command.action {
                Action::CreateBody(body) => {
                    self.create_body(stage, body, &|| format!("{}.do.create_body", place()))?;
                }
                Action::CreateAttractor(attractor) => {
                    self.create_attractor(stage, attractor.name.as_deref(), attractor.attractor(), &place)?;
                }
                action => {
                    let command = self.command(stage.world(), action);
                    let command = command.map_err(|error| SceneError::new(place(), error))?;
                    stage.apply(command).map_err(|error| SceneError::new(place(), self.in_words(error)))?;
                }
            }
        }
        Ok(())
    }

    /// A refusal, with the scene's own name for a body or attractor that is gone.
    fn in_words(&self, error: CommandError) -> String {
        match error {
            CommandError::NoSuchBody(id) => self.gone(id),
            error => error.to_string(),
        }
    }

    fn gone(&self, body: BodyId) -> String {
        format!("there is no body \"{}\" any more", self.label(body))
    }

    fn create_body(
        &mut self,
        stage: &mut impl Stage,
        body: &BodyJson,
        place: &dyn Fn() -> String,
    ) -> Result<(), SceneError> {
        let label = self.bodies.label(body.name.as_deref()).map_err(|error| SceneError::new(place(), error))?;
        let def: BodyDef = body.def();
        let id = stage.create_body(&def).map_err(|error| SceneError::new(place(), error))?;
        for (collider, index) in stage.world().body(id).iter().flat_map(|body| body.colliders()).zip(0..) {
            self.colliders.insert(collider.id(), (id, index));
        }
        self.labels.insert(id, label.clone());
        self.bodies.add(label, id);
        Ok(())
    }

    fn create_attractor(
        &mut self,
        stage: &mut impl Stage,
        name: Option<&str>,
        attractor: Attractor,
        place: &dyn Fn() -> String,
    ) -> Result<(), SceneError> {
        let label = self.attractors.label(name).map_err(|error| SceneError::new(place(), error))?;
        let id = stage.create_attractor(attractor).map_err(|error| SceneError::new(place(), error))?;
        self.attractors.add(label, id);
        Ok(())
    }

    /// The command that an action is, with its references resolved.
    fn command(&self, world: &World, action: &Action) -> Result<Command, String> {
        let body = |reference: &Reference| {
            self.bodies.find(reference).ok_or_else(|| format!("there is no body {}", show(reference)))
        };
        let source = |reference: &Reference| {
            self.attractors.find(reference).ok_or_else(|| format!("there is no attractor {}", show(reference)))
        };
        let collider = |reference: &Reference, index: u32| {
            let id = body(reference)?;
            let present = world.body(id).ok_or_else(|| self.gone(id))?;
            let found = present.colliders().nth(index as usize).map(|collider| collider.id());
            found.ok_or_else(|| format!("body \"{}\" has no collider {index}", self.label(id)))
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
                let (body, mass) = (body(b)?, mass.0);
                let inertia = given.map_or_else(|| self.inertia(world, body, mass), |given| Ok(given.0))?;
                Command::SetMass { body, mass, inertia }
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
            Action::SetSurface(json::SetSurface { body, collider: index, restitution, friction }) => {
                Command::SetSurface {
                    collider: collider(body, *index)?,
                    restitution: restitution.0,
                    friction: friction.0,
                }
            }
            Action::SetFilter(json::SetFilter { body, collider: index, category, mask }) => {
                let filter = Filter { category: *category, mask: *mask };
                Command::SetFilter { collider: collider(body, *index)?, filter }
            }
            Action::SetAllowSleep(json::SetAllowSleep { body: b, allow }) => {
                Command::SetAllowSleep { body: body(b)?, allow: *allow }
            }
            Action::Wake(json::Wake { body: b }) => Command::Wake { body: body(b)? },
            Action::PutToSleep(json::PutToSleep { body: b }) => Command::PutToSleep { body: body(b)? },
            Action::ClearStatus(json::ClearStatus {}) => Command::ClearStatus,
            Action::Input(json::Input { text }) => Command::Input { bytes: text.clone().into_bytes() },
        })
    }

    /// The inertia that a body would have with this mass, were none given.
    fn inertia(&self, world: &World, body: BodyId, mass: Mass) -> Result<Inertia, String> {
        let present = world.body(body).ok_or_else(|| self.gone(body))?;
        let def = BodyDef { mass: Some(mass), inertia: None, position: Vec2::default(), ..present.def() };
        def.data().map(|data| data.inertia).map_err(|error| error.to_string())
    }
}

/// A world in which things are only created: whatever a command may refer to is there.
struct Rehearsal(World);

impl Stage for Rehearsal {
    fn world(&self) -> &World {
        &self.0
    }

    fn step(&mut self) {}
}

impl Commands for Rehearsal {
    fn apply(&mut self, command: Command) -> Result<Reply, CommandError> {
        match command {
            Command::CreateBody { .. } | Command::CreateAttractor { .. } | Command::Input { .. } => {
                self.0.apply(command)
            }
            _ => Ok(Reply::Done),
        }
    }
}

fn show(reference: &Reference) -> String {
    match reference {
        Reference::Name(name) => format!("\"{name}\""),
        Reference::Index(index) => index.to_string(),
    }
}
