"""The impacts of a tick, in the order of their times: Q32 of a tick."""

from heapq import heappop

import narrow
from ints import clamp, mul, round_shift, sat64, sub
from motion import FAR, POSITION
from movers import CONTACT_SPEED
from pairs import half
from ratios import TICK, weight
from shapes import placed
from strike import LIMIT, ONE, Strike, solve
from ways import MOST, NEVER, SAME, Ways

REACH = 860
FLAT = 1 << 16
MANY = 256
BUDGET, BUDGET_EACH = 2048, 8
OFTEN, AGAIN = 8, 2
LEAP, LATER = 429_497, TICK >> 6
SOON, BLOCK = 40, 64
IMPACTS = 6


class Timeline(Ways):
    def __init__(self, world, pairs, movers, faults):
        super().__init__(world, pairs, movers)
        self.faults, self.late, self.settling, self.settled = faults, [], [], []

    def run(self, start, end):
        """Answers the impacts up to a time. `start`: where the substep began."""
        self.start, self.end = start, end
        self.follow()
        while self.first() <= end:
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

    def first(self):
        """When the next pair meets, whose time it still is."""
        while self.queue and self.engaged[self.queue[0][-1]].time != self.queue[0][0]:
            heappop(self.queue)
        return self.queue[0][0] if self.queue else NEVER

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
            approach = sub(0, strike.approach(self.speeds))
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
        change = [sub(self.speeds[at][axis], before[axis]) for axis in range(3)]
        if not mobility.moves() or not any(change):
            return
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
            change = [sub(now[axis], then[axis]) for axis in range(3)]
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
