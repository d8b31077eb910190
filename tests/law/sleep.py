"""Falling asleep and waking: who, when, and what goes with it."""

from ints import mul

ASLEEP = 0xFFFFFFFF
LIVE = 0xFFFFFFFF
STATIC, KINEMATIC, DYNAMIC = range(3)
AGAIN = 8


def limits(config):
    """The speed up to which a body is quiet, and for how many ticks."""
    speed, time = config.sleeping.speed, config.sleeping.time
    return speed << config.unit_shift, max(time * config.tick_rate + (1 << 47) >> 48, 1)


def kind(world, slot):
    return world.state.bodies.slots[slot].value.kind


def moves(world, slot):
    s = world.state
    return any((s.vx[slot], s.vy[slot], s.omega[slot]))


def rests(world, colliders, bodies):
    """Whether a pair is left as it is: one of its bodies sleeps, and the other does as well or stays."""
    asleep = [world.is_asleep(slot) for slot in bodies]
    if not any(asleep):
        return False
    sensor = any(world.state.colliders.slots[slot].value.sensor for slot in colliders)

    def stays(slot):
        return kind(world, slot) == STATIC or (kind(world, slot) == KINEMATIC and not sensor and not moves(world, slot))

    return all(asleep[at] or stays(slot) for at, slot in enumerate(bodies))


def bodies_of(world, contact):
    """The bodies of a contact; none if a collider is gone."""
    slots, found = world.state.colliders.slots, []
    for end in (contact.a, contact.b):
        row = slots[end.index]
        if row.link != LIVE or row.generation != end.generation:
            return None
        found.append(row.value.body)
    return found


def settle(world):
    """Every contact on its list: of what is awake, or of what sleeps."""
    state = world.state
    every = {(c.a.index, c.b.index): c for c in state.contacts + state.resting}
    state.contacts, state.resting = [], []
    for _, contact in sorted(every.items()):
        bodies = bodies_of(world, contact)
        asleep = bodies and rests(world, (contact.a.index, contact.b.index), bodies)
        (state.resting if asleep else state.contacts).append(contact)


def island(world, slot, contacts, connects):
    """What hangs together with a body by contacts of bodies that connect."""
    edges = {}
    for contact in contacts:
        bodies = None if contact.sensor else bodies_of(world, contact)
        if bodies and all(connects(body) for body in bodies):
            edges.setdefault(bodies[0], []).append(bodies[1])
            edges.setdefault(bodies[1], []).append(bodies[0])
    found, open_ = {slot}, [slot]
    while open_:
        for other in edges.get(open_.pop(), []):
            if other not in found:
                found.add(other)
                open_.append(other)
    return sorted(found)


def wake(world, slots):
    """Wakes the islands of bodies, of those that sleep."""
    for slot in slots:
        if world.is_asleep(slot):
            for other in island(world, slot, world.state.resting, world.is_asleep):
                world.state.quiet[other] = 0
            world.drive = None


def wake_all(world):
    wake(world, range(len(world.state.quiet)))


def lull(world, slots):
    """Puts bodies to sleep."""
    state = world.state
    for slot in slots:
        if not world.is_asleep(slot):
            state.quiet[slot] = ASLEEP
            state.vx[slot] = state.vy[slot] = state.omega[slot] = 0
    if slots:
        world.drive = None
        settle(world)


def disturb(world, slot):
    """A body counts anew, and wakes with its island, or with what lies on it."""
    wake(world, [slot])
    world.state.quiet[slot] = 0
    on = [bodies_of(world, contact) for contact in world.state.resting]
    wake(world, [other for bodies in on if bodies and slot in bodies for other in bodies if world.is_asleep(other)])


def is_quiet(world, slot, speed):
    s, reach = world.state, world.state.bodies.slots[slot].value.reach
    vx, vy = s.vx[slot], s.vy[slot]
    return vx * vx + vy * vy <= speed * speed and mul(abs(s.omega[slot]), reach or 1 << 32, 32) <= speed


def lull_quiet(world):
    """After a tick: islands that have been quiet for long enough fall asleep."""
    state, (speed, enough) = world.state, limits(world.state.config)
    slots = state.bodies.slots
    # What moves may pull what sleeps elsewhere.
    if any(row.value.mu and row.value.kind != STATIC for row in slots):
        return
    awake = [slot for slot in range(len(slots)) if not world.is_asleep(slot)]
    for slot in awake:
        quiet = kind(world, slot) == DYNAMIC and is_quiet(world, slot, speed)
        state.quiet[slot] = min(state.quiet[slot] + 1, enough) if quiet else 0
    if all(state.quiet[slot] != enough for slot in awake):
        return
    dynamic = lambda slot: kind(world, slot) == DYNAMIC
    up = {slot for slot in awake if dynamic(slot) and (state.quiet[slot] < enough or not slots[slot].value.allow_sleep)}
    for contact in state.contacts:
        bodies = None if contact.sensor else bodies_of(world, contact)
        if bodies and any(kind(world, slot) == KINEMATIC and moves(world, slot) for slot in bodies):
            up |= {slot for slot in bodies if dynamic(slot)}
    found, seen = [], set()
    for slot in awake:
        if dynamic(slot) and slot not in seen:
            hang = island(world, slot, state.contacts, dynamic)
            seen |= set(hang)
            if not up & set(hang):
                found += hang
    lull(world, sorted(found))
