"""A tick of a world with colliders: pairs, rows, free motion, substeps, impacts."""

import direct
import narrow
import repose
import squeeze
from ints import add, cross, dot, mul, rotate, sat64, sin_cos, sub, total
from motion import integrate
from movers import Movers, state_of
from pairs import ROUNDING, Pair, find, lasts, old, outcome, strikes, swings, turns, vote
from ratios import TICK, Mobility, Scales
from rows import Contact
from shapes import placed
from timeline import Timeline

RELAX = 5
LANES = 8
GROUND, COLORS = 20, 32
HEAVY = 1 << 48


def step(world, faults):
    scales = Scales(world.state.config)
    world.mobilities = [Mobility(row.value) for row in world.state.bodies.slots]
    movers = Movers(world, scales)
    pairs = find(world, movers.past, scales) if world.state.colliders.live else []
    fast, held, islands = prepare(world, pairs, movers)
    integrate(world, faults)
    timeline = Timeline(world, pairs, movers, faults)
    for pair in fast:
        timeline.engage(pair)
    if held:
        substeps(world, held, islands, movers, timeline)
    else:
        timeline.run(0, TICK)
    ends = len(faults)
    if held:
        movers.store(faults)
    timeline.store()
    for colliders, bodies in timeline.late:
        pair = Pair(world, colliders, bodies, narrow.manifold([0, 0], []), None)
        pair.met = True
        pairs.append(pair)
    repose.settle(world, pairs, movers, faults, ends)
    return sorted(pairs, key=lambda pair: pair.colliders), movers


def touched(world, pairs):
    """The sleeping bodies that the tick has touched."""
    found = []
    for pair in pairs:
        asleep = [slot for slot in pair.bodies if world.is_asleep(slot)]
        if asleep and not pair.sensor and lasts(outcome(pair)):
            found += asleep
    return found


def prepare(world, pairs, movers):
    """Which pairs may strike, and which have rows."""
    past, scales = movers.past, movers.scales
    fast = []
    for pair in (pair for pair in pairs if not pair.sensor):
        points = pair.manifold.points
        if not points or strikes(world, pair, past, scales, False) or swings(world, pair, past, scales):
            fast.append(pair)
        else:
            for slot in pair.bodies:
                movers.place(slot)
    # Among others, what does not bounce is stopped by rows as well, and in piles for less.
    stay = []
    for pair in fast:
        among = all(movers.place_of(slot) for slot in pair.bodies)
        bounces = lambda: strikes(world, pair, past, scales, True) or swings(world, pair, past, scales)
        if not among or not pair.manifold.points or (pair.restitution > 0 and bounces()):
            stay.append(pair)
    for pair in stay:
        deepest = pair.overlap()
        pair.met = deepest is not None and deepest >= 0
        pair.depth = max(deepest or 0, 0) + ROUNDING
        pair.manifold = narrow.manifold([0, 0], [])
    held = [pair for pair in pairs if pair.manifold.points]
    for pair in held:
        pair.places = [movers.place(slot) for slot in pair.bodies]
        last = pair.known or old()
        pair.heavy, pair.mode = last.normal[0] + last.normal[1] >= HEAVY, last.mode
        pair.squeezes = scales.is_squeezed(last.normal, pair.overlap())
        pair.turning = movers.turns and turns(world, pair, past, scales)
    movers.look_brisk()
    squeeze.find(held, movers)
    hard = direct.find([vote(world, pair, past, scales) for pair in held], held, movers)
    for pair in held:
        between = narrow.sub(past[pair.bodies[1]].x, past[pair.bodies[0]].x)
        pair.contact = Contact(pair, between, masses(world, pair), pair.known or old(), scales)
        pair.contact.heavy = pair.heavy
    islands = [direct.Island(members, depth, movers, scales) for members, depth in hard]
    for island, (members, _) in zip(islands, hard):
        for pair in members:
            pair.island = island
    return stay, held, islands


def masses(world, pair):
    return [world.mobilities[slot] for slot in pair.bodies]


def ordered(held, movers):
    """Contacts by colour: two of one share no body that moves. Those without one come last, heavy ones first."""
    used, colored, rest = {}, {}, []
    for pair in held:
        moving = [place for place in pair.places if not movers.is_free(place)]
        taken = 0
        for place in moving:
            taken |= used.get(place, 0)
        color = 0 if len(moving) == 2 else GROUND
        while taken >> color & 1 and color < COLORS:
            color += 1
        if color < COLORS:
            for place in moving:
                used[place] = used.get(place, 0) | 1 << color
            colored.setdefault(color, []).append(pair)
        else:
            rest.append(pair)
    rest.sort(key=lambda pair: not pair.heavy)
    return [pair.contact for color in sorted(colored) for pair in colored[color]] + [pair.contact for pair in rest]


def seat(late, contact, movers):
    """Contacts of the tick's middle: into the first block of eight of which none shares a body that moves."""
    for block in late:
        taken = {place for other in block for place in other.places if not movers.is_free(place)}
        if len(block) < LANES and not taken & set(contact.places):
            block.append(contact)
            return
    late.append([contact])


def substeps(world, held, islands, movers, timeline):
    scales = movers.scales
    movers.take_kicks()
    swept = [pair for pair in held if pair.island is None]
    apart = sorted((pair for pair in held if pair.island), key=lambda pair: not pair.heavy)
    first, late, turning = ordered(swept, movers), [], [pair for pair in held if pair.turning]
    # All contacts of the tick, with their bodies, also those that are taken out.
    rows = [(pair.contact, pair.places) for pair in held]
    for contact in first + [pair.contact for pair in apart]:
        contact.give(movers.list, contact.impulses())
    for substep in range(1, scales.substeps + 1):
        movers.begin(substep == 1)
        for pair in turning:
            if pair.island is None and not pair.contact.is_out():
                renew(world, pair, movers)
        for contact in first + [each for block in late for each in block]:
            contact.solve(True, movers.list, scales)
        for island in islands:
            island.run(True)
        squeeze.hold(movers)
        movers.drift()
        timeline.run(*scales.span(substep))
        for contact, _ in rows:
            if contact.retired:
                contact.retire()
        for pair, manifold, between in timeline.settled:
            now = [state_of(world, slot) for slot in range(len(world.state.x))]
            if pair not in turning and turns(world, pair, now, scales):
                turning.append(pair)
            # One that was taken out may be in again.
            pair.island, pair.mode, pair.manifold = None, 0, manifold
            pair.places = [movers.place_of(slot) for slot in pair.bodies]
            pair.contact = Contact(pair, between, masses(world, pair), old(), scales)
            pair.contact.backdate(movers.list)
            seat(late, pair.contact, movers)
            rows.append((pair.contact, pair.places))
        timeline.settled.clear()
        everything = substep % RELAX == 0 or substep == scales.substeps
        for contact in first + [each for block in late for each in block]:
            if everything or contact.pushes or contact.heavy:
                contact.solve(False, movers.list, scales)
        for island in islands:
            island.run(False)
    squeeze.hold(movers)
    for contact, places in rows:
        if contact.spent():
            for place in places:
                movers.list[place].hit = True


def renew(world, pair, movers):
    """Makes the rows of a pair that turns fast anew, in a substep that has begun."""
    contact, scales = pair.contact, movers.scales
    last = old()
    last.count, last.ids = len(pair.manifold.points), [point.id for point in pair.manifold.points]
    last.normal, last.tangent = [row.carried() for row in contact.points], contact.friction.carried()
    states = []
    for slot, place in zip(pair.bodies, pair.places):
        state = movers.state(place, False) if place else state_of(world, slot)
        if not place:
            state.v, state.omega = [0, 0], 0
        states.append(state)
    there = [placed(world.outline(slot), state.angle) for slot, state in zip(pair.colliders, states)]
    between = narrow.sub(states[1].x, states[0].x)
    line = [sat64(abs(states[0].v[axis] - states[1].v[axis])) for axis in (0, 1)]
    rims = [mul(abs(state.omega), world.mobilities[slot].reach, 32) for state, slot in zip(states, pair.bodies)]
    speed = total(line + rims)
    pair.met |= contact.spent()
    pair.manifold = narrow.collide(*there, between, scales.base + mul(speed, scales.line, 79))
    betweens = half_on(pair.manifold, there, states, between, scales)
    contact.renew(movers.list, lambda c: c.write(pair, betweens, masses(world, pair), last, scales))


def half_on(manifold, there, states, between, scales):
    """Turns a contact on to the middle of the substep. For each point, from a's centre to b's as its arms have it."""
    n = manifold.normal
    sides = [[-n[0], -n[1]], n]
    edge = next((body for body in (1, 0) if there[body].count > 1 and sides[body] in there[body].normals), None)

    def turned(body, v):
        return rotate(v, sin_cos(mul(states[body].omega, scales.turn, 64)))

    t = [-n[1], n[0]]
    then = n if edge is None else turned(edge, n)
    manifold.normal, betweens = then, [between, between]
    for at, point in enumerate(manifold.points):
        arms = [point.arm, narrow.sub(point.arm, between)]
        moved = []
        for body in (0, 1):
            if body == edge:
                own, other = states[body], states[1 ^ body]
                turning = mul(other.omega, cross(arms[1 ^ body], t, 30), 32)
                slide = sub(add(dot(other.v, t, 30), turning), dot(own.v, t, 30))
                gone = mul(slide, scales.line, 80)
                moved.append([arms[body][axis] + mul(gone, t[axis], 30) for axis in (0, 1)])
                continue
            # Of a circle its centre goes round.
            radius = -there[body].radius if body else there[body].radius
            center = turned(body, [arms[body][axis] + mul(radius, n[axis], 30) for axis in (0, 1)])
            moved.append([center[axis] - mul(radius, then[axis], 30) for axis in (0, 1)])
        point.arm = moved[0]
        betweens[at] = narrow.sub(moved[0], moved[1])
    return betweens
