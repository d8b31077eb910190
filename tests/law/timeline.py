"""The impacts of a tick, in the order of their times: Q32 of a tick."""

from heapq import heappop, heappush
from types import SimpleNamespace as Row

import narrow
from ints import clamp, mul, quotient, round_shift, sat64
from meeting import fastest, first_touch
from motion import FAR, POSITION, turn_by
from movers import CONTACT_SPEED
from pairs import free_box, half, may_strike, overlaps, still_box
from ratios import TICK, weight
from shapes import placed
from strike import LIMIT, ONE, Strike, solve

SAME = 1 << 12
REACH = 860
FLAT = 1 << 16
MANY, MOST = 256, 320
BUDGET, BUDGET_EACH = 2048, 8
OFTEN, AGAIN, PASSED_ON = 8, 2, 8
DEEPER, LEAP, LATER = 21_475, 429_497, TICK >> 6
SOON, BLOCK = 40, 64
NEVER = (1 << 63) - 1
IMPACTS = 6


class Flight:
    """A body's way from `time` to the end of the tick."""

    def __init__(self, slot, state, gain, place, scales):
        self.slot, self.state, self.gain, self.place, self.scales = slot, state, gain, place, scales
        self.weight, self.time, self.pairs, self.strikes = gain[:2], 0, [], 0
        self.aside = self.changed = self.pushed = False
        self.around, self.looked = None, 0

    def way(self, axis, gained, after):
        return mul(mul(self.state.v[axis] + half(gained), self.scales.tick, 71), after, 40)

    def at(self, time):
        """Where it is at a time that is not before its own."""
        s, after = self.state, time - self.time
        if after == 0:
            return Row(x=list(s.x), angle=s.angle, v=list(s.v), omega=s.omega)
        gained = [mul(gain, after, 32) for gain in self.gain]
        turned = mul(mul(s.omega + half(gained[2]), self.scales.tick_turn, 63), after, 32)
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


class Timeline:
    """`pairs`: of the tick. `movers`: the bodies that rows know."""

    def __init__(self, world, pairs, movers, faults):
        self.world, self.pairs, self.movers, self.faults, self.scales = world, pairs, movers, faults, movers.scales
        self.by_colliders = {tuple(pair.colliders): pair for pair in pairs}
        self.flights, self.by_slot, self.engaged, self.queue = [], {}, [], []
        self.struck, self.late, self.settling, self.settled = [], [], [], []
        self.order = self.start = 0

    def mobility(self, place):
        return self.world.mobilities[self.flights[place].slot]

    def smaller(self, colliders):
        return min(self.world.outline(slot).reach for slot in colliders)

    # Who may meet whom.

    def flight(self, slot):
        """The place of a body's flight, which begins as its free motion."""
        if slot not in self.by_slot:
            s, past = self.world.state, self.movers.past[slot]
            gain = [s.vx[slot] - past.v[0], s.vy[slot] - past.v[1], s.omega[slot] - past.omega]
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
        one, other = (self.world.state.colliders.slots[slot].value for slot in colliders)
        engaged.restitution = max(one.restitution, other.restitution)
        engaged.friction = one.friction if one.friction == other.friction else narrow.sqrt(one.friction * other.friction)
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
            d=narrow.sub(q.x, p.x), v=[tick(c) for c in narrow.sub(q.v, p.v)], a=[tick(b.gain[c] - a.gain[c]) for c in (0, 1)],
            angle=[p.angle, q.angle], omega=[tick(p.omega), tick(q.omega)], alpha=[tick(a.gain[2]), tick(b.gain[2])],
        )

    # A substep's impacts.

    def run(self, start, end):
        """Answers the impacts up to a time. `start`: where the substep began."""
        self.start, self.end = start, end
        self.follow()
        while self.queue and self.queue[0][0] <= end:
            self.take_batch()
            while self.gather():
                self.answer()
        self.settle()

    def follow(self):
        """Bodies that rows push go as these have them in this substep."""
        pushed = [self.push(place) for place in range(len(self.flights))]
        self.look_aside()
        if any(pushed):
            for pair in self.engaged:
                moved = any(self.flights[place].pushed for place in pair.flights)
                if moved and (not pair.held or pair.restitution >= ONE):
                    self.foresee(pair, self.start, self.end)

    def take_batch(self):
        """The pairs that meet at a time, in the order of their colliders."""
        time, found = self.queue[0][0], {}
        while self.queue and self.queue[0][0] <= time + SAME:
            at, _, _, index = heappop(self.queue)
            if self.engaged[index].time == at:
                found[index] = (at, self.engaged[index])
        self.batch = sorted(found.values(), key=lambda entry: entry[1].colliders)

    def gather(self):
        """Of what is left of the batch the first pair, and what hangs together with it by bodies that move."""
        self.batch = [(time, pair) for time, pair in self.batch if pair.time == time]
        if not self.batch:
            return False
        self.group = [self.batch.pop(0)[1]]
        for pair in self.group:
            joined = [place for place in pair.flights if self.mobility(place).moves()]
            hangs = [entry for entry in self.batch if any(place in joined for place in entry[1].flights)]
            self.group += [each for _, each in hangs]
            self.batch = [entry for entry in self.batch if entry not in hangs]
        self.group.sort(key=lambda pair: pair.colliders)
        return True

    def overspent(self):
        return self.order // (BUDGET + BUDGET_EACH * len(self.flights))

    def answer(self):
        time = max(pair.time for pair in self.group)
        self.begin(time)
        if not self.strikes:
            # What comes nearer lies beside what it would meet.
            for pair in self.group:
                slots = [self.flights[place].slot for place in pair.flights]
                speed = max(mul(self.fastest(slots), self.scales.tick, 79), 1)
                leap = min(clamp((LEAP << 32) // speed, 1, LATER) << min(pair.misses, 10), LATER)
                pair.misses += 1
                pair.depth = self.scales.slack
                self.foresee(pair, time + leap, self.end)
            return
        met = len(self.members)
        self.lean(time)
        weights = []
        for place in self.locals:
            mobility = self.mobility(place)
            weights.append((mobility.mantissa, mobility.exponent, mobility.turning()))
        before = solve(self.strikes, self.restitutions, weights, self.speeds)
        for pair, restitution in zip(self.members, self.restitutions):
            pair.rests = restitution == 0
            again = pair.rests or pair.answers >= AGAIN
            if again and pair.restitution < ONE and not pair.held and pair.pair is not None:
                self.settling.append(pair)
        for at, place in enumerate(self.locals):
            self.change(at, place, before[at], time)
        self.order += 1
        for pair in self.members[:met]:
            self.note(pair)
        self.rest()
        changed = [place for place in self.locals if self.flights[place].changed]
        for place in changed:
            self.flights[place].surround(self.mobility(place).reach)
        for place in changed:
            self.find_again(place, self.is_slow)
            self.look_again(place, time)

    def begin(self, time):
        """Takes in what of the group touches and closes."""
        self.locals, self.speeds, self.strikes, self.restitutions, self.members = [], [], [], [], []
        spent = self.overspent() > 0
        for pair in self.group:
            pair.time = NEVER
            strike = self.contact(pair, time)
            if strike is None:
                continue
            approach = -strike.approach(self.speeds)
            if approach <= half(pair.least):
                continue
            a, b = (self.flights[place] for place in pair.flights)
            press = max(weight(a.weight), weight(b.weight))
            threshold = self.scales.threshold(pair.restitution, press, a.place != 0 and b.place != 0)
            tired = spent or max(a.strikes, b.strikes) >= MANY or strike.brace is not None
            bounces = approach > threshold and not tired
            if not bounces:
                pair.least = max(pair.least, self.scales.least_settled)
            stays = max(a.strikes, b.strikes) >= MOST
            pair.answers += 1
            pair.misses = 0
            self.take(pair, strike, pair.restitution if bounces else 0)
            if stays:
                a.strikes += SOON
                b.strikes += SOON

    def take(self, pair, strike, restitution):
        self.members.append(pair)
        self.strikes.append(strike)
        self.restitutions.append(restitution)

    def lean(self, time):
        """What an impact of this tick brought to rest against a body that is hit is answered with it."""
        bounces = any(restitution > 0 for restitution in self.restitutions)
        for place in self.locals:
            if not self.mobility(place).moves():
                continue
            for pair in self.flights[place].pairs:
                if len(self.strikes) >= BLOCK:
                    break
                if not pair.rests or pair in self.members:
                    continue
                known = len(self.locals)
                strike = self.contact(pair, time)
                if strike and (not bounces or strike.parting(self.speeds) <= self.scales.still):
                    self.take(pair, strike, 0)
                else:
                    del self.locals[known:], self.speeds[known:]

    def local(self, place, time):
        """The place of a body among those of the answer, to whose time it is brought."""
        if place not in self.locals:
            flight = self.flights[place]
            time = max(time, flight.time)
            flight.state, flight.time, flight.changed = flight.at(time), time, False
            line = [round_shift(c, self.scales.shift) for c in flight.state.v]
            self.speeds.append([*line, self.mobility(place).rim(flight.state.omega, self.scales)])
            self.locals.append(place)
        return self.locals.index(place)

    def contact(self, pair, time):
        """The contact of a pair at a time, if it touches."""
        spent, bodies = self.overspent() > 0, [self.local(place, time) for place in pair.flights]
        a, b = (self.flights[place] for place in pair.flights)
        outlines = [self.world.outline(slot) for slot in pair.colliders]
        there = [placed(of, flight.state.angle) for of, flight in zip(outlines, (a, b))]
        between = narrow.sub(b.state.x, a.state.x)
        reach = REACH * ((max(of.reach for of in outlines) >> 34) + 1)
        manifold = narrow.collide(*there, between, reach + FLAT)
        points = manifold.points
        if not any(point.separation <= reach for point in points):
            return None
        # A point that there is not counts as one at 0.
        pair.depth = max(pair.depth, 0, *(-point.separation for point in points))
        mobility = [self.mobility(place) for place in pair.flights]
        joined = pair.answers >= OFTEN and (pair.restitution < ONE or spent)
        of = lambda points: Strike(bodies, manifold, points, between, mobility, pair.friction, joined)
        if len(points) < 2 or abs(points[0].separation - points[1].separation) <= FLAT:
            return of(points)
        low, high = points if points[0].separation < points[1].separation else reversed(points)
        strike = of([low])
        other = high.separation <= 0 and -strike.approach(self.speeds) <= half(pair.least)
        return of([high]) if other else strike

    def change(self, at, place, before, time):
        """Gives a body the speed that its impacts left it."""
        flight, mobility, overspent, k = self.flights[place], self.mobility(place), self.overspent(), self.scales.shift
        change = [self.speeds[at][axis] - before[axis] for axis in range(3)]
        if not mobility.moves() or not any(change):
            return
        if not flight.aside:
            self.struck.append(place)
        flight.changed = flight.aside = True
        flight.strikes += 1
        if any(abs(speed) >= LIMIT for speed in self.speeds[at]):
            self.faults.append((flight.slot, CONTACT_SPEED))
        if overspent > 1:
            flight.strikes = max(flight.strikes, MOST)
        if flight.strikes >= MANY or overspent > 0:
            self.faults.append((flight.slot, IMPACTS))
        if flight.strikes >= MOST:
            change, flight.gain = [-speed for speed in before], [0, 0, 0]
        state = flight.state
        state.v = [sat64(state.v[axis] + sat64(change[axis] << k)) for axis in (0, 1)]
        state.omega = sat64(state.omega + mobility.over_sigma(change[2], 48 - k, 48))
        self.movers.strike(flight.place, change, self.end - time)

    def rest(self):
        """What came to rest is held: contacts take what of the forces would press them together."""
        strikes = [strike for strike, restitution in zip(self.strikes, self.restitutions) if restitution == 0]
        if not strikes or not any(any(self.flights[place].gain) for place in self.locals):
            return
        k, speeds, weights = self.scales.shift, [], []
        for place in self.locals:
            mobility, (x, y, turning) = self.mobility(place), self.flights[place].gain
            speeds.append([round_shift(x, k), round_shift(y, k), mobility.rim(turning, self.scales)])
            weights.append((mobility.mantissa, mobility.exponent, mobility.turning()))
        for strike in strikes:
            strike.rough = 0
        before = solve(strikes, [0] * len(strikes), weights, speeds)
        for place, then, now in zip(self.locals, before, speeds):
            gain, mobility = self.flights[place].gain, self.mobility(place)
            change = [now[axis] - then[axis] for axis in range(3)]
            gain = [sat64(gain[axis] + sat64(change[axis] << k)) for axis in (0, 1)] + [gain[2]]
            if mobility.moves():
                gain[2] = sat64(gain[2] + mobility.over_sigma(change[2], 48 - k, 48))
            self.flights[place].gain = gain

    def settle(self):
        """What impacts of this substep left at rest between bodies that rows know, rows hold from its end on."""
        pairs = sorted({pair.at: pair for pair in self.settling}.values(), key=lambda pair: pair.colliders)
        self.settling = []
        for pair in pairs:
            ends = [self.flights[place] for place in pair.flights]
            strange = [flight.place == 0 and not self.world.mobilities[flight.slot].fixed for flight in ends]
            if any(strange) and (pair.answers < AGAIN or self.movers.is_empty()):
                continue
            states = [flight.at(self.end) for flight in ends]
            there = [placed(self.world.outline(slot), now.angle) for slot, now in zip(pair.colliders, states)]
            between = narrow.sub(states[1].x, states[0].x)
            manifold = narrow.collide(*there, between, self.scales.base)
            begins = [self.movers.past[flight.slot] for flight in ends]
            far = [odd and not self.movers.may_join(begin, now) for odd, begin, now in zip(strange, begins, states)]
            if not manifold.points or any(far):
                continue
            for flight, begin, now, odd in zip(ends, begins, states, strange):
                if odd:
                    flight.place = self.movers.join(flight.slot, begin, now)
            pair.held = True
            pair.least = self.scales.least_strike(pair.restitution, True, self.smaller(pair.colliders))
            self.settled.append((pair.pair, manifold, between))

    def note(self, pair):
        """Notes that a pair has met."""
        if pair.pair is not None:
            pair.pair.met = True
        elif not pair.met:
            pair.met = True
            self.late.append((pair.colliders, [self.flights[place].slot for place in pair.flights]))

    # New ways.

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
        return total + abs(v[0][0] - v[1][0]) + abs(v[0][1] - v[1][1])

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
            if not flight.aside:
                flight.aside = True
                self.struck.append(place)
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

    def store(self):
        """Bodies that were struck, and that no row pushed, to where their flights end."""
        state = self.world.state
        for flight in self.flights:
            slot = flight.slot
            stays = self.world.is_asleep(slot) or state.bodies.slots[slot].value.kind != 2
            if not flight.strikes or stays or self.movers.keeps(flight.place):
                continue
            there = flight.at(TICK)
            held = [clamp(c, -FAR, FAR) for c in there.x]
            if held != there.x:
                self.faults.append((slot, POSITION))
            state.x[slot], state.y[slot] = held
            state.vx[slot], state.vy[slot] = there.v
            state.angle[slot], state.omega[slot] = there.angle, there.omega
