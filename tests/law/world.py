"""The state: slots, commands, and one tick."""

from collections import Counter
from itertools import count
from types import SimpleNamespace as Row

import motion
import sleep
import solver
from ints import cross_wide, mul_div, rotate, sin_cos
from movers import state_of
from pairs import finish, overlaps, still_box
from shapes import canonical, outline, placed, reach_of, resolved

LIVE, CHAIN_END = 0xFFFFFFFF, 0xFFFFFFFE
STATIC, KINEMATIC, DYNAMIC = range(3)
COLUMNS = ("x", "y", "vx", "vy", "angle", "omega")
# Commands that wake a body if they change it, and what of it wakes others as well.
CHANGE = (
    "set_kind", "set_position", "set_angle", "set_velocity", "set_angular_velocity", "set_force", "set_torque",
    "set_mass", "set_fixed_rotation", "set_damping", "set_mu", "set_allow_sleep",
)
PLACE = ("x", "y", "angle", "kind", "mu")


def nothing(**given):
    """The value of a free body's slot."""
    blank = dict(
        kind=0, fixed_rotation=0, mass=0, inertia=0, center=[0, 0], reach=0, first=None, force=[0, 0], torque=0,
        linear_damping=0, angular_damping=0, mu=0, user_data=0, allow_sleep=0,
    )
    return Row(**{**blank, **given})


def no_collider():
    blank = Row(category=1, mask=LIVE)
    return Row(body=0, next=None, form=0, density=0, restitution=0, friction=0, filter=blank, sensor=0)


def no_form():
    return Row(shape=Row(name="circle", tag=0, radius=0), offset=[0, 0], angle=0, center=[0, 0], uses=0)


def no_attractor():
    return Row(position=[0, 0], mu=0)


def touch(slots):
    """A command has changed the slots: their hash is to be computed anew."""
    vars(slots).pop("hash", None)
    return slots.slots


def insert(slots, value):
    """Into the slot freed last, or a new one."""
    rows = touch(slots)
    slots.live += 1
    if slots.free == CHAIN_END:
        rows.append(Row(generation=0, link=LIVE, value=value))
        return len(rows) - 1
    at = slots.free
    slots.free = rows[at].link
    rows[at].link, rows[at].value = LIVE, value
    return at


def remove(slots, at, blank):
    row = touch(slots)[at]
    row.value, row.link = blank, CHAIN_END
    if row.generation < 0xFFFFFFFF:
        row.generation += 1
        row.link, slots.free = slots.free, at
    slots.live -= 1


def center_at(origin, center, angle):
    if center == [0, 0]:
        return list(origin)
    arm = rotate(center, sin_cos(angle))
    return [origin[0] + arm[0], origin[1] + arm[1]]


class World:
    def __init__(self, state):
        self.state, self.drive, self.outlines = state, None, {}
        # How often what is rare was computed: tests ask for it.
        self.seen = Counter()

    def is_asleep(self, slot):
        return bool(self.state.quiet) and self.state.quiet[slot] == sleep.ASLEEP

    def is_still(self, slot):
        """Whether a body stays where it is in every tick."""
        return self.state.bodies.slots[slot].value.kind == STATIC or self.is_asleep(slot)

    # Commands. A replay has accepted ones only: what is refused is not this module's.

    def command(self, c):
        self.drive = None
        if self.state.config.sleeping is None:
            return getattr(self, c.name)(c)
        if c.name in ("set_surface", "set_filter"):
            slot = self.state.colliders.slots[c.id.index].value.body
        elif c.name in CHANGE or c.name in ("destroy_body", "wake") or c.name.startswith("apply"):
            slot = c.id.index
        if c.name in CHANGE:
            before = self.portrait(slot)
            getattr(self, c.name)(c)
            after = self.portrait(slot)
            if before != after:
                sleep.disturb(self, slot)
            if [before[name] for name in PLACE] != [after[name] for name in PLACE]:
                self.disturb_around(slot, before["mu"])
            return
        if c.name == "destroy_body":
            pulls = self.state.bodies.slots[slot].value.mu
            sleep.disturb(self, slot)
            self.destroy_body(c)
            return sleep.wake_all(self) if pulls else None
        gravity = self.state.config.gravity
        getattr(self, c.name)(c)
        if c.name == "create_body":
            self.disturb_around(self.created, 0)
        elif c.name.endswith("attractor") or (c.name == "set_gravity" and c.gravity != gravity):
            sleep.wake_all(self)
        elif c.name.startswith("apply") or c.name in ("wake", "set_surface", "set_filter"):
            sleep.disturb(self, slot)
            if c.name == "set_filter":
                self.disturb_around(slot, 0)

    def portrait(self, slot):
        """A body as commands see it."""
        columns = {name: getattr(self.state, name)[slot] for name in COLUMNS}
        return {**columns, **vars(self.state.bodies.slots[slot].value)}

    def disturb_around(self, slot, mu):
        """What sleeps where a body is wakes, if a step would not find out; and everybody if it pulls, or did."""
        body = self.state.bodies.slots[slot].value
        if body.mu or mu:
            sleep.wake_all(self)
        if body.kind != DYNAMIC:
            rows = [(at, row.value.body) for at, row in enumerate(self.state.colliders.slots) if row.link == LIVE]
            box = lambda at, of: still_box(state_of(self, of), placed(self.outline(at), self.state.angle[of]))
            own = [box(at, of) for at, of in rows if of == slot]
            found = [of for at, of in rows if self.is_asleep(of) and any(overlaps(box(at, of), each) for each in own)]
            sleep.wake(self, found)

    def put_to_sleep(self, c):
        slot, state = c.id.index, self.state
        if self.is_asleep(slot):
            return
        dynamic = lambda of: state.bodies.slots[of].value.kind == DYNAMIC
        found = sleep.island(self, slot, state.resting + state.contacts, dynamic)
        for other in found:
            self.drop_push(other)
        sleep.lull(self, found)

    def body(self, c):
        """A body that is about to be changed."""
        return touch(self.state.bodies)[c.id.index].value

    def create_body(self, c):
        of, state = c.definition, self.state
        mass, inertia, center = resolved(of)
        slot = insert(state.bodies, nothing(
            kind=of.kind, fixed_rotation=of.fixed_rotation, mass=mass, inertia=inertia, center=center,
            reach=reach_of(of.colliders, center), force=of.force, torque=of.torque, linear_damping=of.linear_damping,
            angular_damping=of.angular_damping, mu=of.mu, user_data=of.user_data, allow_sleep=of.allow_sleep,
        ))
        values = [*center_at(of.position, center, of.angle), *of.velocity, of.angle, of.angular_velocity]
        for name, value in zip(COLUMNS, values):
            column = getattr(state, name)
            column += [0] * (slot + 1 - len(column))
            column[slot] = value
        if state.config.sleeping is not None:
            state.quiet += [0] * (slot + 1 - len(state.quiet))
        self.created = slot
        following = None
        for each in reversed(of.colliders):
            following = insert(state.colliders, Row(
                body=slot, next=following, form=self.share(each, center), density=each.density,
                restitution=each.restitution, friction=each.friction, filter=each.filter, sensor=each.sensor,
            ))
        state.bodies.slots[slot].value.first = following

    def share(self, of, center):
        """The slot of a form like this, which has one use more now."""
        rows = touch(self.state.forms)
        form = Row(shape=canonical(of.shape), offset=of.offset, angle=of.angle, center=center, uses=1)
        for at, row in enumerate(rows):
            if row.link == LIVE and vars(row.value) == {**vars(form), "uses": row.value.uses}:
                row.value.uses += 1
                return at
        return insert(self.state.forms, form)

    def destroy_body(self, c):
        slot, state = c.id.index, self.state
        at = self.body(c).first
        while at is not None:
            row = state.colliders.slots[at].value
            form = touch(state.forms)[row.form].value
            form.uses -= 1
            if form.uses == 0:
                remove(state.forms, row.form, no_form())
                self.outlines.pop(row.form, None)
            remove(state.colliders, at, no_collider())
            at = row.next
        remove(state.bodies, slot, nothing())
        for name in COLUMNS:
            getattr(state, name)[slot] = 0
        if state.quiet:
            state.quiet[slot] = 0
        self.drop_push(slot)

    def drop_push(self, slot):
        self.state.pushes = [push for push in self.state.pushes if push.slot != slot]

    def set_kind(self, c):
        slot, body, state = c.id.index, self.body(c), self.state
        body.kind = c.kind
        if c.kind != DYNAMIC:
            self.drop_push(slot)
            body.force, body.torque, body.linear_damping, body.angular_damping = [0, 0], 0, 0, 0
        if c.kind == STATIC:
            state.vx[slot] = state.vy[slot] = state.omega[slot] = 0

    def set_position(self, c):
        slot, state = c.id.index, self.state
        state.x[slot], state.y[slot] = center_at(c.position, self.body(c).center, state.angle[slot])

    def set_angle(self, c):
        slot, state, center = c.id.index, self.state, self.body(c).center
        origin = center_at([state.x[slot], state.y[slot]], [-center[0], -center[1]], state.angle[slot])
        state.x[slot], state.y[slot] = center_at(origin, center, c.angle)
        state.angle[slot] = c.angle

    def set_velocity(self, c):
        self.state.vx[c.id.index], self.state.vy[c.id.index] = c.velocity

    def set_angular_velocity(self, c):
        self.state.omega[c.id.index] = c.omega

    def set_force(self, c):
        self.body(c).force = c.force

    def set_torque(self, c):
        self.body(c).torque = c.torque

    def set_mass(self, c):
        body = self.body(c)
        body.mass, body.inertia = c.mass, c.inertia

    def set_fixed_rotation(self, c):
        body = self.body(c)
        body.fixed_rotation = c.fixed
        if c.fixed:
            body.torque = self.state.omega[c.id.index] = 0
            for push in self.state.pushes:
                push.torque = 0 if push.slot == c.id.index else push.torque

    def set_damping(self, c):
        body = self.body(c)
        body.linear_damping, body.angular_damping = c.linear, c.angular

    def set_mu(self, c):
        self.body(c).mu = c.mu

    def set_user_data(self, c):
        self.body(c).user_data = c.user_data

    def set_allow_sleep(self, c):
        self.body(c).allow_sleep = c.allow

    def moment(self, slot, point, v):
        """r × v about the centre of mass, Q64."""
        return cross_wide([point[0] - self.state.x[slot], point[1] - self.state.y[slot]], v, 32)

    def push(self, slot, force, torque):
        """Adds to the forces of this tick on a body."""
        for push in self.state.pushes:
            if push.slot == slot:
                push.force = [push.force[0] + force[0], push.force[1] + force[1]]
                push.torque += torque
                return
        self.state.pushes.append(Row(slot=slot, force=list(force), torque=torque))

    def apply_force(self, c):
        turns = c.point is not None and not self.body(c).fixed_rotation
        self.push(c.id.index, c.force, self.moment(c.id.index, c.point, c.force) if turns else 0)

    def apply_torque(self, c):
        self.push(c.id.index, [0, 0], c.torque)

    def apply_impulse(self, c):
        slot, body, state = c.id.index, self.body(c), self.state
        state.vx[slot] += mul_div(c.impulse[0], 1 << 48, body.mass)
        state.vy[slot] += mul_div(c.impulse[1], 1 << 48, body.mass)
        if c.point is not None and not body.fixed_rotation:
            state.omega[slot] += mul_div(self.moment(slot, c.point, c.impulse), 1 << 48, body.inertia)

    def apply_angular_impulse(self, c):
        self.state.omega[c.id.index] += mul_div(c.impulse, 1 << 48, self.body(c).inertia)

    def create_attractor(self, c):
        insert(self.state.attractors, c.attractor)

    def set_attractor(self, c):
        touch(self.state.attractors)[c.id.index].value = c.attractor

    def destroy_attractor(self, c):
        remove(self.state.attractors, c.id.index, no_attractor())

    def set_gravity(self, c):
        self.state.config.gravity = c.gravity

    def clear_status(self, c):
        self.state.status.clear()

    def input(self, c):
        pass

    def set_surface(self, c):
        row = touch(self.state.colliders)[c.id.index].value
        row.restitution, row.friction = c.restitution, c.friction

    def set_filter(self, c):
        touch(self.state.colliders)[c.id.index].value.filter = c.filter

    def wake(self, c):
        pass

    # The tick.

    def outline(self, collider):
        """That of the collider in a slot."""
        at = self.state.colliders.slots[collider].value.form
        if at not in self.outlines:
            form = self.state.forms.slots[at].value
            self.outlines[at] = outline(form.shape, form.offset, form.angle, form.center)
        return self.outlines[at]

    def step(self):
        state, faults = self.state, []
        if state.config.sleeping is not None:
            sleep.settle(self)
        columns = {name: list(getattr(state, name)) for name in COLUMNS}
        for attempt in count():
            if self.drive is None:
                self.drive = motion.Drive(self)
            pairs, movers = solver.step(self, faults)
            touched = solver.touched(self, pairs)
            if not touched:
                break
            # A tick that touches what sleeps is computed anew, with that awake.
            for name, column in columns.items():
                getattr(state, name)[:] = column
            sleep.wake(self, touched if attempt < sleep.AGAIN else range(len(state.quiet)))
            sleep.settle(self)
            faults.clear()
        finish(self, pairs)
        if state.pushes:
            state.pushes.clear()
            self.drive = None
        if state.config.sleeping is not None:
            for slot in movers.shifted(sleep.limits(state.config)[0]):
                if not self.is_asleep(slot):
                    state.quiet[slot] = 0
            sleep.lull_quiet(self)
        for slot, bound in faults:
            row = state.bodies.slots[slot]
            if row.link == LIVE and all(entry.bound != bound for entry in state.status):
                body = Row(index=slot, generation=row.generation)
                state.status.append(Row(tick=state.tick, body=body, bound=bound))
        state.tick += 1
