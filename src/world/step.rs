//! One tick.

use super::sleep::Sleepers;
use super::stage::Stage;
use crate::World;
use crate::contact::name;
use crate::motion::{Fault, integrate};
use crate::solver::Substep;
use crate::threads::{Crew, Threads};

/// Who looks at a tick from inside.
pub(crate) trait Watch {
    /// Whether it does look.
    const LOOKS: bool = true;

    /// After each stage. May do anything to the world: a fault, in tests.
    fn stage(&mut self, stage: Stage, world: &mut World);

    /// After each substep of [`Stage::Solve`], from 1 on.
    fn substep(&mut self, _at: u32, _substep: Substep<'_>) {}
}

/// Costs nothing.
struct Nobody;

impl Watch for Nobody {
    const LOOKS: bool = false;

    #[inline(always)]
    fn stage(&mut self, _: Stage, _: &mut World) {}
}

impl World {
    /// Advances the world by one tick, 1/tick_rate s.
    ///
    /// Never fails, panics or wraps: a value that would leave its range is limited to it, and
    /// [`World::status`] names the body and the quantity. The same state and commands give the same bits on every
    /// machine.
    pub fn step(&mut self) {
        self.step_through(&mut Nobody, Crew::ALONE);
    }

    /// As [`World::step`], by several threads: the same bits, however many there are. Stages that go body by body, contact by
    /// contact or pair by pair are cut up where a world is large enough; what hangs together stays with one thread.
    pub fn step_on(&mut self, threads: &Threads) {
        threads.work(self.effort(), |crew| self.step_through(&mut Nobody, crew));
    }

    /// About how many nanoseconds a tick takes, by what is awake: 25 a body that flies, 80 a body and source of gravity, 250 a
    /// contact.
    pub(crate) fn effort(&self) -> usize {
        let World { bodies, contacts, drive, .. } = self;
        let awake: usize = bodies.rest.all_runs().map(|run| run.len()).fold(0, usize::saturating_add);
        let body = drive.sources.len().saturating_mul(80).saturating_add(25);
        awake.saturating_mul(body).saturating_add(contacts.len().saturating_mul(250))
    }

    /// As [`World::step`], and `watch` sees the world after each stage. To watch changes no bit; but all of it is computed, also
    /// what is known to stay as it is, so a tick of heaps at rest takes as long as one in which they move.
    ///
    /// ```
    /// use tamias2d::{Stage, World, WorldDef};
    /// let mut world = World::new(&WorldDef::default())?;
    /// let mut stages = Vec::new();
    /// world.step_watched(|stage, _| stages.push(stage));
    /// assert_eq!((stages[0], stages.last()), (Stage::Forces, Some(&Stage::Close)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn step_watched(&mut self, watch: impl FnMut(Stage, &World)) {
        struct Looks<F>(F);
        impl<F: FnMut(Stage, &World)> Watch for Looks<F> {
            fn stage(&mut self, stage: Stage, world: &mut World) {
                (self.0)(stage, world);
            }
        }
        self.step_through(&mut Looks(watch), Crew::ALONE);
    }

    /// The stages of a tick, in order.
    pub(crate) fn step_through<W: Watch>(&mut self, watch: &mut W, crew: Crew) {
        self.begin_forces();
        watch.stage(Stage::Forces, self);
        self.sort_sleepers();
        watch.stage(Stage::Sort, self);
        let mut attempt = 0;
        loop {
            if W::LOOKS {
                // All is to be seen.
                self.solver.repose.clear();
            }
            self.find_pairs(crew);
            watch.stage(Stage::Find, self);
            self.prepare_rows(crew);
            watch.stage(Stage::Prepare, self);
            self.integrate_freely(crew);
            watch.stage(Stage::Integrate, self);
            self.solve_contacts(watch, crew);
            watch.stage(Stage::Solve, self);
            // A tick that may touch what it left out is computed anew, with that; one that touches what sleeps, with that awake.
            if self.take_back_disturbed() {
                continue;
            }
            if !self.wake_touched(attempt) {
                break;
            }
            attempt = attempt.saturating_add(1);
            watch.stage(Stage::Wake, self);
        }
        self.keep_contacts(crew);
        watch.stage(Stage::Contacts, self);
        self.end_forces();
        watch.stage(Stage::Release, self);
        self.fall_asleep();
        watch.stage(Stage::Sleep, self);
        self.close_tick();
        watch.stage(Stage::Close, self);
    }

    /// Forces of this tick: into the prepared motion, and out of it again by [`World::end_forces`].
    fn begin_forces(&mut self) {
        let World { config, bodies, pushes, drive, .. } = self;
        for push in pushes.iter() {
            let slot = push.slot as usize;
            drive.set(slot, bodies.cold.value(slot), config.gravity, Some(push));
        }
    }

    /// Contacts on their list, of what is awake or of what sleeps, and the runs of slots that are awake.
    fn sort_sleepers(&mut self) {
        let World { bodies, colliders, contacts, resting, .. } = self;
        resting.settle(contacts, bodies, colliders);
        bodies.rest.settle();
    }

    fn find_pairs(&mut self, crew: Crew) {
        let World { bodies, colliders, contacts, drive, touch, solver, .. } = self;
        touch.find(bodies, colliders, contacts, drive, solver.scales.margins, crew);
    }

    fn prepare_rows(&mut self, crew: Crew) {
        let World { bodies, contacts, drive, touch, solver, .. } = self;
        solver.prepare(touch, contacts, bodies, drive, crew);
    }

    /// Every body as if nothing touched it.
    fn integrate_freely(&mut self, crew: Crew) {
        let World { bodies, resting, drive, solver, faults, .. } = self;
        // Who sleeps, or is left as he is, may be touched: then the tick is taken back.
        if bodies.rest.any_asleep() || !solver.repose.is_empty() {
            bodies.remember(&mut resting.before);
        }
        integrate(bodies, drive, faults, crew);
    }

    fn solve_contacts(&mut self, watch: &mut impl Watch, crew: Crew) {
        let World { bodies, colliders, contacts, drive, touch, solver, faults, .. } = self;
        let watch = |at, substep: Substep<'_>| watch.substep(at, substep);
        solver.run(touch, bodies, colliders, contacts, drive, faults, watch, crew);
    }

    /// Whether the tick may have touched what it left out: then it is taken back, and leaves nothing out.
    fn take_back_disturbed(&mut self) -> bool {
        let World { bodies, resting, solver, faults, .. } = self;
        let disturbs = solver.disturbs();
        if disturbs {
            bodies.take_back(&resting.before);
            solver.repose.clear();
            faults.clear();
        }
        disturbs
    }

    /// Whether the tick touched what sleeps: then it is taken back, and that is awake.
    fn wake_touched(&mut self, attempt: u32) -> bool {
        let World { config, bodies, colliders, contacts, resting, drive, touch, solver, faults, .. } = self;
        let mut sleepers = Sleepers { bodies, colliders, contacts, resting, touch, drive, gravity: config.gravity };
        let woken = sleepers.wake_touched(solver, attempt);
        if woken {
            faults.clear();
        }
        woken
    }

    /// The contacts that last, and what began and ended to touch.
    fn keep_contacts(&mut self, crew: Crew) {
        let World { colliders, contacts, touch, solver, events, next, .. } = self;
        touch.finish(contacts, next, colliders, events, |pair| solver.outcome(pair), crew);
    }

    fn end_forces(&mut self) {
        let World { config, bodies, pushes, drive, .. } = self;
        for push in pushes.drain(..) {
            let slot = push.slot as usize;
            drive.push_at[slot] = u32::MAX;
            drive.set(slot, bodies.cold.value(slot), config.gravity, None);
        }
    }

    /// Counts who is quiet; islands that have been for long enough fall asleep.
    fn fall_asleep(&mut self) {
        let World { config, bodies, colliders, contacts, resting, drive, touch, solver, .. } = self;
        let Some(sleeping) = config.sleeping else { return };
        let limits = sleeping.limits(config.tick_rate, config.unit_shift);
        for slot in solver.shifted(limits.0) {
            if !bodies.rest.is_asleep(slot) {
                bodies.rest.note(slot, 0);
            }
        }
        Sleepers { bodies, colliders, contacts, resting, touch, drive, gravity: config.gravity }.lull_quiet(limits);
    }

    /// What went out of range, into the status; events and collisions get their ids, and the tick is over.
    fn close_tick(&mut self) {
        let World { tick, bodies, resting, status, solver, events, faults, .. } = self;
        for Fault { slot, bound } in faults.drain(..) {
            if let Some(body) = bodies.id(slot) {
                status.note(*tick, body, bound);
            }
        }
        name(*tick, events, solver.collisions_mut(), &mut resting.found);
        *tick = tick.saturating_add(1);
    }
}
