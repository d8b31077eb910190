"""Forces to velocities to positions: what a tick does to bodies that nothing touches."""

from math import isqrt

from ints import I64, TURN, TURN_PER_RADIAN_Q64, clamp, div, mul, mul_add, mul_div, round_shift, sat64, sat128, shifted

DYNAMIC = 2
POSITION, TURNS, VELOCITY, SPIN, ACCELERATION = range(5)
FAR = 1_000_000_000 << 32
ONE = 1 << 62
XI, CHI, LAMBDA = 823_729_652_908_425_552, -305_591_449_415_327_722, -979_253_853_438_687_736


class Span:
    """A time 1/n s as multipliers Q63: to metres, and to turns."""

    def __init__(self, per_second=None, line=0, turn=0):
        self.line, self.turn = line, turn
        if per_second:
            self.line, self.turn = div(1 << 63, per_second), div(TURN_PER_RADIAN_Q64, 2 * per_second)

    def part(self, part):
        return Span(line=mul(self.line, part, 62), turn=mul(self.turn, part, 62))


def decay(rate, per_second):
    """(e^−y, φ₁, φ₂) of y = rate/per_second, Q62."""
    if rate == 0:
        return ONE, ONE, ONE >> 1
    y = div(rate << 14, per_second)
    halvings = next((k for k in range(8) if y >> k < ONE), 8)
    small = round_shift(y, halvings)
    phi2 = ONE
    for k in range(24, 2, -1):
        phi2 = ONE - div(mul(small, phi2, 62), k)
    phi2 >>= 1
    phi1 = ONE - mul(small, phi2, 62)
    exp = ONE - mul(small, phi1, 62)
    if halvings:
        for _ in range(halvings):
            exp = mul(exp, exp, 62)
        phi1 = div(ONE - exp << 62, y)
        phi2 = div(ONE - phi1 << 62, y)
    return exp, phi1, phi2


def stages(config, attraction):
    """The stages of a step, how many steps a tick has, and the span of a glide or a decay in parts of a second."""
    if config.integrator == 0 and not attraction:
        return [("glide", None)], 1, config.tick_rate
    if config.integrator == 0:
        steps = -(-config.substeps // 4)
        step = Span(config.tick_rate * steps)
        half = [("drift", XI), ("kick", ONE // 2 - LAMBDA), ("drift", CHI), ("kick", LAMBDA)]
        scheme = half + [("drift", ONE - 2 * (CHI + XI))] + half[::-1]
        composed = [(what, step.part(part)) for what, part in scheme]
        return [("decay", None), *composed, ("decay", None)], steps, config.tick_rate * steps * 2
    rate = config.tick_rate * config.substeps
    return [("kick", Span(rate)), ("decay", None), ("drift", Span(rate))], config.substeps, rate


def acceleration(body, gravity, push):
    """m/s² and rad/s², Q48, not limited."""
    if body.kind != DYNAMIC:
        return [0, 0, 0]
    force, torque = body.force, body.torque
    if push:
        force, torque = [sat128(force[axis] + push.force[axis]) for axis in (0, 1)], sat128(torque + push.torque)
    along = [sat128(mul_div(force[axis], 1 << 48, body.mass) + gravity[axis]) for axis in (0, 1)]
    return [*along, 0 if body.fixed_rotation else mul_div(torque, 1 << 48, body.inertia)]


class Drive:
    """What forces and damping do to each body in a step of the scheme. Derived from the state."""

    def __init__(self, world):
        state = world.state
        config, slots = state.config, state.bodies.slots
        self.sources = [(None, a.value.position, a.value.mu) for a in state.attractors.slots if a.value.mu]
        self.sources += [(slot, None, b.value.mu) for slot, b in enumerate(slots) if b.value.mu]
        self.stages, self.steps, self.span = stages(config, bool(self.sources))
        self.glides = self.stages[0][0] == "glide"
        self.tick = div(1 << 63, config.tick_rate)
        self.kicks, self.bows, self.damped, self.limited = [], [], {}, []
        pushes = {push.slot: push for push in state.pushes}
        # What sleeps is left out.
        self.awake = [slot for slot in range(len(slots)) if not world.is_asleep(slot)]
        for slot, body in enumerate(slots):
            self.kicks.append([0, 0, 0])
            self.bows.append([0, 0, 0])
            if not world.is_asleep(slot):
                self.prepare(slot, body.value, config.gravity, pushes.get(slot))

    def prepare(self, slot, body, gravity, push):
        span = Span(self.span)
        rates = (body.linear_damping, body.angular_damping)
        line, turn = (decay(rate, self.span) for rate in rates)
        wide = acceleration(body, gravity, push)
        a = [sat64(c) for c in wide]
        if a != wide:
            self.limited.append(slot)
        if self.glides:
            square = mul(span.line, span.line, 63), mul(span.turn, span.line, 63)
            kick = [mul(span.line, factors[1], 62) for factors in (line, turn)]
            bow = [mul(square[at], factors[2], 62) for at, factors in enumerate((line, turn))]
            # A way has 48 + 63 fraction bits, a bow 56.
            self.kicks[slot] = [mul(a[0], kick[0], 63), mul(a[1], kick[0], 63), mul(a[2], kick[1], 63)]
            self.bows[slot] = [mul(a[0], bow[0], 55), mul(a[1], bow[0], 55), mul(a[2], bow[1], 55)]
        else:
            self.kicks[slot] = a
        if any(rates):
            spans = Span(line=mul(span.line, line[1], 62), turn=mul(span.turn, turn[1], 62))
            self.damped[slot] = (line[0], turn[0], spans)

    def gain(self, slot):
        """What forces add to the velocity in a tick, without attraction, Q48 m/s."""
        kick = self.kicks[slot][:2]
        return kick if self.glides else [mul(a, self.tick, 63) for a in kick]


def turn_by(angle, by):
    """The angle turned further, its whole turns limited; whether they had to be."""
    total = angle + by
    if -I64 <= total <= I64:
        return total, False
    # The fraction of the magnitude stays; the turns stop at the last one that fits.
    magnitude = I64 - (TURN - 1) | abs(total) & TURN - 1
    return (magnitude if by > 0 else -magnitude), True


def faster(column, slot, by, bound, faults):
    total = column[slot] + by
    column[slot] = sat64(total)
    if column[slot] != total:
        faults.append((slot, bound))


def drift(state, drive, slots, span, faults):
    for axis, (place, velocity) in enumerate(((state.x, state.vx), (state.y, state.vy))):
        for slot in slots:
            moved = place[slot] + mul_add(velocity[slot], span.line, drive.bows[slot][axis], 55, 79)
            place[slot] = clamp(moved, -FAR, FAR)
            if place[slot] != moved:
                faults.append((slot, POSITION))
    for slot in slots:
        by = mul_add(state.omega[slot], span.turn, drive.bows[slot][2], 55, 63)
        state.angle[slot], over = turn_by(state.angle[slot], by)
        if over:
            faults.append((slot, TURNS))


def damp(state, drive):
    for slot, (line, turn, _) in drive.damped.items():
        for column, factor in ((state.vx, line), (state.vy, line), (state.omega, turn)):
            column[slot] = mul(column[slot], factor, 62)


def kick(state, drive, faults, span):
    for axis, (column, bound) in enumerate(((state.vx, VELOCITY), (state.vy, VELOCITY), (state.omega, SPIN))):
        for slot in drive.awake:
            kicks = drive.kicks[slot]
            faster(column, slot, kicks[axis] if span is None else mul(kicks[axis], span.line, 63), bound, faults)


def runs(slots):
    """Slots in order, as runs without a gap."""
    found = []
    for slot in slots:
        if found and found[-1][-1] == slot - 1:
            found[-1].append(slot)
        else:
            found.append([slot])
    return found


def glide(state, drive, faults):
    """Who is damped has spans of its own; those between are done together, which orders what is told of bounds."""
    span = Span(drive.span)
    for run in runs(drive.awake):
        part = []
        for slot in run:
            if slot in drive.damped:
                drift(state, drive, part, span, faults)
                drift(state, drive, [slot], drive.damped[slot][2], faults)
                part = []
            else:
                part.append(slot)
        drift(state, drive, part, span, faults)
    damp(state, drive)
    kick(state, drive, faults, None)


def attraction(mu, d):
    """One source's pull towards d, Q48."""
    distance2 = d[0] * d[0] + d[1] * d[1]
    if distance2 == 0:
        return [0, 0]
    zeros = 128 - mu.bit_length()
    mantissa = mu << zeros >> 64
    even = 128 - distance2.bit_length() & ~1
    root = isqrt(distance2 << even)
    inverse = ((1 << 127) - 1) // root
    cube = (inverse * inverse >> 64) * inverse >> 64
    factor = cube * mantissa >> 64
    exponent = 3 * even // 2 - zeros - 69
    return [clamp(shifted(c * factor, -exponent), -(1 << 100), 1 << 100) for c in d]


def attract(state, drive, span, faults):
    """Velocities by the pulls at the present positions: of attractors by slot, then of bodies by slot."""
    if not drive.sources:
        return
    places = [(slot, at or [state.x[slot], state.y[slot]], mu) for slot, at, mu in drive.sources]
    for slot in drive.awake:
        if state.bodies.slots[slot].value.kind != DYNAMIC:
            continue
        pulls = [
            attraction(mu, [at[0] - state.x[slot], at[1] - state.y[slot]])
            for carrier, at, mu in places if carrier != slot
        ]
        wide = [sum(pull[axis] for pull in pulls) for axis in (0, 1)]
        pull = [sat64(c) for c in wide]
        if pull != wide:
            faults.append((slot, ACCELERATION))
        faster(state.vx, slot, mul(pull[0], span.line, 63), VELOCITY, faults)
        faster(state.vy, slot, mul(pull[1], span.line, 63), VELOCITY, faults)


def integrate(world, faults):
    state, drive = world.state, world.drive
    faults += [(slot, ACCELERATION) for slot in drive.limited]
    for _ in range(drive.steps):
        for what, span in drive.stages:
            if what == "glide":
                glide(state, drive, faults)
            elif what == "drift":
                for run in runs(drive.awake):
                    drift(state, drive, run, span, faults)
            elif what == "decay":
                damp(state, drive)
            else:
                kick(state, drive, faults, span)
                attract(state, drive, span, faults)
