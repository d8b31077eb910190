"""The pairs of a tick, which of them strike, and the contacts that last."""

from types import SimpleNamespace as Row

import narrow
import sleep
from ints import add, cross, dot, mul, sat64, sqrt, sub, total
from ratios import weight
from shapes import placed

DYNAMIC = 2
ROUNDING = 43
CALM = 1 << 46
GIVEN_UP = 255
BESIDE = (4_294_967, 34_359_738)
TURNING = 1 << 44
LIVE = 0xFFFFFFFF


def old(contact=None):
    """What the last tick left of a contact."""
    if contact is None:
        return Row(ids=[0, 0], count=0, normal=[0, 0], tangent=0, mode=0, record=None)
    c = contact
    return Row(
        ids=[c.id0, c.id1], count=c.count, normal=[c.normal0, c.normal1], tangent=c.tangent, mode=c.mode, record=c
    )


def way(velocity, scales):
    """A velocity's way in a tick, Q32 m."""
    return mul(velocity, scales.tick, 79)


def half(value):
    """Halved, towards zero."""
    return value // 2 if value >= 0 else -(-value // 2)


def rim_speed(omega, reach):
    return mul(abs(omega), reach, 32)


def swept(at, v, gain, low, high, scales):
    """The box around a box from `low` to `high` about a point that moves for a tick."""
    box = [[0, 0], [0, 0]]
    for axis in (0, 1):
        ahead = half(way(v[axis], scales))
        whole = way(sat64(v[axis] + half(gain[axis])), scales)
        box[0][axis] = at[axis] + low[axis] + min(ahead, whole, 0)
        box[1][axis] = at[axis] + high[axis] + max(ahead, whole, 0)
    return box


def overlaps(a, b):
    return all(a[0][axis] <= b[1][axis] and b[0][axis] <= a[1][axis] for axis in (0, 1))


def surface(world, colliders):
    """C_R and the coefficient of friction of two colliders."""
    a, b = (world.state.colliders.slots[slot].value for slot in colliders)
    friction = a.friction if a.friction == b.friction else sqrt(a.friction * b.friction)
    return max(a.restitution, b.restitution), friction


class Pair:
    def __init__(self, world, colliders, bodies, manifold, known):
        a, b = (world.state.colliders.slots[slot].value for slot in colliders)
        self.colliders, self.bodies, self.manifold, self.known = colliders, bodies, manifold, known
        self.sensor = bool(a.sensor or b.sensor)
        self.restitution, self.friction = surface(world, colliders)
        self.contact, self.mode, self.island = None, 0, None
        self.depth, self.met, self.stays = 0, False, False

    def overlap(self):
        """By how much it overlaps, Q32 m; negative by the gap; none without points."""
        return max((-point.separation for point in self.manifold.points), default=None)


def wanted(world, a, b):
    """Whether two colliders have anything to do with each other."""
    one, other = (world.state.colliders.slots[slot].value for slot in (a, b))
    meets = one.filter.category & other.filter.mask and other.filter.category & one.filter.mask
    if one.body == other.body or not meets or (one.sensor and other.sensor):
        return False
    kinds = [world.state.bodies.slots[each.body].value.kind for each in (one, other)]
    return bool(one.sensor or other.sensor or DYNAMIC in kinds)


def may_strike(world, a, b):
    sensor = any(world.state.colliders.slots[slot].value.sensor for slot in (a, b))
    return not sensor and wanted(world, a, b)


def free_box(world, collider, past, scales):
    """A box around the free way of a collider in this tick."""
    body = world.state.colliders.slots[collider].value.body
    reach = world.outline(collider).reach
    state = past[body]
    return swept(state.x, state.v, world.drive.gain(body), [-reach] * 2, [reach] * 2, scales)


def still_box(state, of):
    return [[state.x[axis] + side[axis] for axis in (0, 1)] for side in (of.min, of.max)]


def boxes(world, past, scales):
    """By collider in use: its outline in the world's axes, and the box in which it is in this tick."""
    found = {}
    for slot, row in enumerate(world.state.colliders.slots):
        if row.link != LIVE:
            continue
        body, outline = row.value.body, world.outline(slot)
        state, of = past[body], placed(outline, past[body].angle)
        low, high = of.min, of.max
        if world.is_still(body):
            box = still_box(state, of)
        else:
            # The disc in which it may turn, but for what it cannot turn to in a tick.
            rim, out = way(rim_speed(state.omega, outline.reach), scales), outline.reach + scales.base
            box = swept(state.x, state.v, world.drive.gain(body), [-out] * 2, [out] * 2, scales)
            for axis in (0, 1):
                box[0][axis] += max(outline.reach - (-low[axis] + rim), 0)
                box[1][axis] -= max(outline.reach - (high[axis] + rim), 0)
        found[slot] = (of, box)
    return found


def find(world, past, scales):
    """The pairs of this tick, by the slots of a, then of b."""
    found, slots = boxes(world, past, scales), world.state.colliders.slots
    known = {(c.a.index, c.b.index): c for c in world.state.contacts}
    pairs = []
    for a in found:
        for b in found:
            if a >= b or not overlaps(found[a][1], found[b][1]) or not wanted(world, a, b):
                continue
            bodies = [slots[slot].value.body for slot in (a, b)]
            # Of two that stay where they are, one may be a sensor: nothing is looked at.
            if all(world.is_still(slot) for slot in bodies) or sleep.rests(world, (a, b), bodies):
                continue
            manifold = meet(world, (a, b), bodies, (found[a][0], found[b][0]), past, scales)
            if manifold is None:
                continue
            last = known.get((a, b))
            same = last and (last.a.generation, last.b.generation) == (slots[a].generation, slots[b].generation)
            pairs.append(Pair(world, [a, b], bodies, manifold, old(last) if same else None))
    return pairs


def meet(world, colliders, bodies, placed, past, scales):
    """The manifold of two colliders; one without points for two that are not near but may meet in this tick."""
    a, b = (past[body] for body in bodies)
    d = narrow.sub(b.x, a.x)
    if any(world.state.colliders.slots[slot].value.sensor for slot in colliders):
        return narrow.manifold([0, 0], []) if narrow.overlap(*placed, d) else None
    v = [sub(a.v[axis], b.v[axis]) for axis in (0, 1)]
    reach = [world.outline(slot).reach for slot in colliders]
    fastest = total([sat64(abs(v[0])), sat64(abs(v[1])), rim_speed(a.omega, reach[0]), rim_speed(b.omega, reach[1])])
    gain = [world.drive.gain(body) for body in bodies]
    pressed = total(sat64(abs(gain[0][axis] - gain[1][axis])) for axis in (0, 1)) // 2
    ahead = way(add(fastest, pressed), scales)
    manifold = narrow.near(*placed, d, scales.base + ahead)
    if manifold is None:
        return None
    if not manifold.points:
        # Corner before corner.
        return narrow.near(*placed, d, ahead)
    if all(point.separation > scales.base for point in manifold.points):
        return narrow.manifold([0, 0], [])
    # Of the points beyond the margin, those that the ways of this tick bring near.
    n, kept = manifold.normal, []
    for point in manifold.points:
        if point.separation > scales.base:
            nearer = way(dot(v, n, 30), scales)
            for body, state, arm, side in ((0, a, point.arm, 1), (1, b, narrow.sub(point.arm, d), -1)):
                speed = mul(state.omega, cross(arm, n, 30), 32) * side
                nearer += max(way(speed, scales), -max(reach[body] + dot(arm, n, 30) * side, 0))
            if point.separation + nearer > scales.base >> 3:
                continue
        kept.append(point)
    manifold.points = kept
    return manifold


def strikes(world, pair, past, scales, among):
    """Whether a near pair comes together so fast that it strikes, or parts so fast that it needs no row."""
    a, b = (past[body] for body in pair.bodies)
    n, v, between = pair.manifold.normal, [sub(p, q) for p, q in zip(a.v, b.v)], narrow.sub(b.x, a.x)
    gain = [world.drive.gain(body) for body in pair.bodies]
    press = [dot(each, n, 30) for each in gain]
    closest = min(point.separation for point in pair.manifold.points)
    slowest = min(
        sub(
            add(dot(v, n, 30), mul(a.omega, cross(point.arm, n, 30), 32)),
            mul(b.omega, cross(narrow.sub(point.arm, between), n, 30), 32),
        )
        for point in pair.manifold.points
    )
    heaviest = max(weight(gain[0]), weight(gain[1]))
    threshold = scales.threshold(pair.restitution, heaviest, among)
    gap, pressed = closest > scales.touching, max(press[1] - press[0], 0)
    fast = add(max(-slowest, 0), pressed if gap else 0) > threshold
    parts = sub(slowest, pressed) > scales.parting(pair.restitution, gap, threshold, heaviest)
    return (fast or parts) and closest > -scales.slack


def swings(world, pair, past, scales):
    """Whether another corner may swing in across the gap, and nothing presses the pair together."""
    rims = sum(rim_speed(past[body].omega, world.mobilities[body].reach) for body in pair.bodies)
    return (
        all(point.separation > scales.touching for point in pair.manifold.points)
        and rims > scales.swinging
        and all(world.drive.gain(body) == [0, 0] for body in pair.bodies)
    )


def turns(world, pair, past, scales):
    """Whether it turns so fast that its rows would be beside its contact before the tick ends."""
    a, b = (past[body] for body in pair.bodies)
    omega = [abs(a.omega), abs(b.omega)]
    if sum(omega) < TURNING:
        return False
    mobility = [world.mobilities[body] for body in pair.bodies]
    line = [sat64(abs(a.v[axis] - b.v[axis])) for axis in (0, 1)]
    speed = total(line + [mul(omega[body], mobility[body].reach, 32) for body in (0, 1)])
    for body in (0, 1):
        turn, gone = (mul(rate, scales.tick, 79) for rate in (omega[body], speed))
        beside = min(mul(turn, gone, 33), mobility[body].reach << 1)
        if beside > BESIDE[mobility[body].moves()] << scales.shift:
            return True
    return False


def vote(world, pair, past, scales):
    """What a pair says of its island: "hard", "sweep" or nothing."""
    last = pair.known or old()
    load = last.normal[0] + last.normal[1]
    hard = load >= (3 << 46) >> (last.mode > 0) or pair.overlap() > scales.deep
    a, b = (past[body] for body in pair.bodies)
    passing = max(abs(a.v[axis] - b.v[axis]) >> scales.shift for axis in (0, 1))
    if last.mode == GIVEN_UP or passing > CALM << 1:
        return "sweep"
    if not hard or passing >= CALM:
        return None
    # What a kinematic body presses while it moves may have no solution.
    mobility = world.mobilities
    driven = [past[body] for body in pair.bodies if not mobility[body].moves() and not mobility[body].fixed]
    return "sweep" if any([*state.v, state.omega] != [0, 0, 0] for state in driven) else "hard"


def outcome(pair):
    """What became of a contact, for the next tick."""
    points = pair.manifold.points
    found = Row(
        touching=pair.met or pair.sensor, sensor=pair.sensor, count=len(points), id0=0, id1=0, mode=0, zero0=0, zero1=0,
        normal0=0, normal1=0, tangent=0,
    )
    rows = pair.contact
    if rows is None:
        return found
    for at, point in enumerate(points):
        setattr(found, f"id{at}", point.id)
        found.touching |= rows.peak[at] > 0 or point.separation <= 0
    found.normal0, found.normal1 = (row.carried() for row in rows.points)
    found.tangent = rows.friction.carried()
    if points and pair.island:
        found.mode = 1 if rows.is_out() else pair.island.outcome()
    elif points:
        found.mode = GIVEN_UP if pair.mode == GIVEN_UP else 0
    return found


def lasts(found):
    """Whether a contact is kept."""
    return found.touching or found.normal0 or found.normal1 or found.tangent


def finish(world, pairs):
    """The contacts after the tick: those that touch or push."""
    contacts = []
    for pair in pairs:
        if pair.stays:
            if pair.known:
                contacts.append(pair.known.record)
            continue
        found = outcome(pair)
        if lasts(found):
            slots = world.state.colliders.slots
            found.a, found.b = (Row(index=slot, generation=slots[slot].generation) for slot in pair.colliders)
            contacts.append(found)
    world.state.contacts = contacts
