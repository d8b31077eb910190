"""Ways of bodies through a tick, and who may meet whom on them. Times are Q32 of a tick."""

from heapq import heappush
from types import SimpleNamespace as Row

import narrow
from ints import add, mul, sat64, sub
from meeting import fastest, first_touch
from motion import turn_by
from pairs import free_box, half, may_strike, overlaps, still_box, surface
from ratios import TICK
from shapes import placed
from strike import ONE

SAME = 1 << 12
MOST, PASSED_ON = 320, 8
DEEPER = 21_475
NEVER = (1 << 63) - 1


class Flight:
    """A body's way from `time` to the end of the tick."""

    def __init__(self, slot, state, gain, place, scales):
        self.slot, self.state, self.gain, self.place, self.scales = slot, state, gain, place, scales
        self.weight, self.time, self.pairs, self.strikes = gain[:2], 0, [], 0
        self.aside = self.changed = self.pushed = False
        self.around, self.looked = None, 0

    def way(self, axis, gained, after):
        return mul(mul(add(self.state.v[axis], half(gained)), self.scales.tick, 71), after, 40)

    def at(self, time):
        """Where it is at a time that is not before its own."""
        s, after = self.state, time - self.time
        if after == 0:
            return Row(x=list(s.x), angle=s.angle, v=list(s.v), omega=s.omega)
        gained = [mul(gain, after, 32) for gain in self.gain]
        turned = mul(mul(add(s.omega, half(gained[2])), self.scales.tick_turn, 63), after, 32)
        return Row(
            x=[s.x[axis] + self.way(axis, gained[axis], after) for axis in (0, 1)], angle=turn_by(s.angle, turned)[0],
            v=[sat64(s.v[axis] + gained[axis]) for axis in (0, 1)], omega=sat64(s.omega + gained[2]),
        )

    def surround(self, reach):
        """Notes the box around its way."""
        reach += self.scales.astray if self.place else 0
        start, end = self.state, self.at(TICK)
        left = (TICK - self.time) // 2
        low, high = [], []
        for axis in (0, 1):
            ahead = mul(mul(start.v[axis], self.scales.tick, 71), left, 40) + start.x[axis]
            low.append(min(start.x[axis], end.x[axis], ahead) - reach)
            high.append(max(start.x[axis], end.x[axis], ahead) + reach)
        self.around = [low, high]


class Engaged:
    """A pair of colliders whose bodies may strike each other."""

    def __init__(self, colliders, flights, pair, held):
        self.colliders, self.flights, self.pair, self.held = colliders, flights, pair, held
        self.time, self.answers, self.misses, self.rests, self.met = NEVER, 0, 0, False, False


class Ways:
    """The flights of a tick, and the pairs that are engaged. `movers`: the bodies that rows know."""

    def __init__(self, world, pairs, movers):
        self.world, self.movers, self.scales = world, movers, movers.scales
        self.by_colliders = {tuple(pair.colliders): pair for pair in pairs}
        self.flights, self.by_slot, self.engaged, self.queue = [], {}, [], []
        self.order = self.start = 0

    def mobility(self, place):
        return self.world.mobilities[self.flights[place].slot]

    def smaller(self, colliders):
        return min(self.world.outline(slot).reach for slot in colliders)

    def flight(self, slot):
        """The place of a body's flight, which begins as its free motion."""
        if slot not in self.by_slot:
            s, past = self.world.state, self.movers.past[slot]
            gain = [sub(s.vx[slot], past.v[0]), sub(s.vy[slot], past.v[1]), sub(s.omega[slot], past.omega)]
            copy = Row(x=list(past.x), angle=past.angle, v=list(past.v), omega=past.omega)
            self.by_slot[slot] = len(self.flights)
            self.flights.append(Flight(slot, copy, gain, self.movers.place_of(slot), self.scales))
            self.push(self.by_slot[slot])
        return self.by_slot[slot]

    def push(self, place):
        """Puts a flight on the way of this substep, if rows push its body."""
        flight = self.flights[place]
        if flight.place == 0 or not self.movers.list[flight.place].pushed:
            return False
        flight.state = self.movers.state(flight.place, True)
        flight.time, flight.gain, flight.pushed = self.start, [0, 0, 0], True
        return True

    def engage(self, pair):
        """Takes a pair of the tick in, after bodies have moved freely."""
        self.foresee(self.add(pair.colliders, pair.bodies, pair, False), 0, TICK)

    def bears(self, pair):
        return pair is not None and pair.contact is not None and pair.contact.bears()

    def add(self, colliders, bodies, pair, held):
        flights = [self.flight(slot) for slot in bodies]
        engaged = Engaged(list(colliders), flights, pair, held)
        self.engaged.append(engaged)
        for place in flights:
            self.flights[place].pairs.insert(0, engaged)
        engaged.restitution, engaged.friction = surface(self.world, colliders)
        # Rows would stop what was struck as it crosses a gap. What does not bounce is theirs.
        apart = pair is not None and all(p.separation > self.scales.touching for p in pair.manifold.points)
        if held and engaged.restitution > 0 and not self.bears(pair) and apart:
            engaged.held = False
            pair.contact.retired = True
        borne = held and self.bears(pair)
        engaged.least = self.scales.least_strike(engaged.restitution, borne, self.smaller(colliders))
        engaged.depth = pair.depth if pair else 0
        engaged.at = len(self.engaged) - 1
        return engaged

    def foresee(self, pair, start, end):
        """Looks when a pair meets, from a time on and as far as the ways of its bodies are known."""
        scales, pair.time = self.scales, NEVER
        a, b = (self.flights[place] for place in pair.flights)
        if all(self.flights[p].strikes >= MOST or not self.mobility(p).moves() for p in pair.flights):
            return
        least = pair.least
        if pair.held and max(a.strikes, b.strikes) >= PASSED_ON and pair.restitution < ONE:
            least = max(least, scales.least_strike(0, True, self.smaller(pair.colliders)))
        start = max(start, a.time, b.time)
        until = end if a.pushed or b.pushed else TICK
        if start > until:
            return
        motion = self.motion(a, b, start)
        rest = until - start
        closing = mul(least, scales.tick, 71)
        one, other = (self.world.outline(slot) for slot in pair.colliders)
        if fastest(motion, [one.reach, other.reach], rest) < closing:
            return
        depth = pair.depth + DEEPER
        slack = max(scales.slack, depth) if a.place or b.place else depth
        slack = max(slack, mul(min(least, scales.least_settled), scales.tick, 78))
        after = first_touch(one, other, motion, rest, closing, slack)
        # In the last moments of a tick it is the next one's.
        if after is not None and start + after <= TICK - SAME:
            pair.time = start + after
            heappush(self.queue, (pair.time, *pair.colliders, pair.at))

    def motion(self, a, b, time):
        tick = lambda v: mul(v, self.scales.tick, 71)
        p, q = a.at(time), b.at(time)
        return Row(
            d=narrow.sub(q.x, p.x), v=[tick(sub(c, d)) for c, d in zip(q.v, p.v)],
            a=[tick(sub(c, d)) for c, d in zip(b.gain[:2], a.gain[:2])], angle=[p.angle, q.angle],
            omega=[tick(p.omega), tick(q.omega)], alpha=[tick(a.gain[2]), tick(b.gain[2])],
        )

    def find_again(self, place, left):
        """Takes in pairs of a body with those around its new way; of pairs with rows those not `left` to them."""
        flight, slots = self.flights[place], self.world.state.colliders.slots
        known = [pair.colliders for pair in flight.pairs]
        own = self.world.state.bodies.slots[flight.slot].value.first
        while own is not None:
            for other, row in enumerate(slots):
                colliders = [min(own, other), max(own, other)]
                if row.link != 0xFFFFFFFF or own == other or colliders in known:
                    continue
                if not overlaps(self.way(other), flight.around) or not may_strike(self.world, *colliders):
                    continue
                pair = self.by_colliders.get(tuple(colliders))
                held = pair is not None and pair.contact is not None
                bodies = [slots[slot].value.body for slot in colliders]
                if not (held and left(bodies, pair)):
                    self.add(colliders, bodies, pair, held)
            own = slots[own].value.next

    def way(self, collider):
        """A box around the way of a collider: its body's own, or where impacts sent that."""
        body = self.world.state.colliders.slots[collider].value.body
        place = self.by_slot.get(body)
        if place is not None and self.flights[place].aside:
            return self.flights[place].around
        if self.world.is_still(body):
            return still_box(self.movers.past[body], placed(self.world.outline(collider), self.movers.past[body].angle))
        return free_box(self.world, collider, self.movers.past, self.scales)

    def is_slow(self, bodies, pair):
        """Whether bodies with rows are so slow that these take whatever comes together."""
        least = self.scales.least_strike(pair.restitution, self.bears(pair), self.smaller(pair.colliders))
        return self.fastest(bodies) < least

    def fastest(self, slots):
        """A bound of the speed of points of two bodies against each other, Q48."""
        total, v = 0, []
        for slot in slots:
            known = self.by_slot.get(slot)
            state = self.movers.past[slot] if known is None else self.flights[known].state
            v.append(state.v)
            total += mul(abs(state.omega), self.world.mobilities[slot].reach, 32)
        return sat64(total + abs(v[0][0] - v[1][0]) + abs(v[0][1] - v[1][1]))

    def look_again(self, place, time):
        """Looks again when the pairs of a body that was struck meet."""
        for pair in self.flights[place].pairs:
            other = pair.flights[pair.flights[0] == place]
            # Of two that one answer changed, the first has looked at their pair.
            if self.flights[other].looked != self.order:
                self.foresee(pair, time, self.end)
        self.flights[place].looked = self.order

    def look_aside(self):
        """Who leaves where it was looked for neighbours is looked for them again."""
        for slot in self.movers.turned_aside():
            self.flight(slot)
        for place in range(len(self.flights)):
            flight = self.flights[place]
            if not self.is_astray(flight, place):
                continue
            flight.surround(self.mobility(place).reach)
            flight.aside = True
            self.find_again(place, lambda bodies, pair: True)

    def is_astray(self, flight, place):
        if not flight.pushed or not self.mobility(place).moves():
            return False
        x = [flight.state.x[axis] + self.gone(flight, axis) for axis in (0, 1)]
        if flight.aside:
            reach = self.mobility(place).reach
            low, high = flight.around
            return any(x[axis] - reach < low[axis] or x[axis] + reach > high[axis] for axis in (0, 1))
        if not self.movers.is_aside(flight.place):
            return False
        past = self.movers.past[flight.slot]
        free = Flight(flight.slot, past, [0, 0, 0], 0, self.scales)
        return any(abs(x[axis] - past.x[axis] - self.gone(free, axis)) > self.scales.astray for axis in (0, 1))

    def gone(self, flight, axis):
        after = self.end - flight.time
        return flight.way(axis, mul(flight.gain[axis], after, 32), after)
