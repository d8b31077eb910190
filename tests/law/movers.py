"""Bodies as rows have them for a tick: velocities in full, positions as what changed since the tick began."""

from types import SimpleNamespace as Row

import squeeze
from ints import clamp, div, mul, round_shift, sat64, sub
from motion import FAR, POSITION, TURNS, turn_by
from ratios import SPEED_MAX
from rows import HELD

CONTACT_SPEED = 5
TURNING = 1 << 44
EIGHTH_TURN = 843_314_857
BOUND = 1 << 60


def bounded(v):
    return [clamp(c, -BOUND, BOUND) for c in v]


def held(v):
    return [clamp(c, -HELD, HELD) for c in v]


def state_of(world, slot):
    """Where a body is and how it moves."""
    s = world.state
    return Row(x=[s.x[slot], s.y[slot]], angle=s.angle[slot], v=[s.vx[slot], s.vy[slot]], omega=s.omega[slot])


class Mover:
    """`v`: x, y and w = σ·ω, Q48 over 2^k. `d`: ways x, y and φ = σ·θ since the tick began, Q26 over 2^k."""

    def __init__(self, slot, start, mobility, scales):
        self.slot, self.mobility, self.start = slot, mobility, start
        self.begin = bounded(start)
        self.v, self.d = list(self.begin), [0, 0, 0]
        self.kick, self.cut, self.sum = [0, 0, 0], [0, 0, 0], [0, 0, 0]
        self.hit = self.pushed = self.slowed = False
        # How fast it may be while it is squeezed, Q48 over 2^k; 0: as fast as it likes.
        self.most = 0
        if mobility:
            fast = div(mobility.sigma * SPEED_MAX << 48, max(mobility.reach, 1))
            eighth = round_shift(mobility.sigma * scales.rate * EIGHTH_TURN, scales.shift + 14)
            self.spin_max = min(fast, eighth)

    def go(self, scales):
        self.d = [clamp(round_shift(scales.coarse * c, 24), -(1 << 30), 1 << 30) for c in self.sum]

    def read(self):
        return [round_shift(c, 28) for c in self.v]


class Movers:
    """The bodies of this tick's contacts; the first stands for all that are static."""

    def __init__(self, world, scales):
        self.world, self.scales, self.list, self.places = world, scales, [Mover(None, [0, 0, 0], None, scales)], {}
        self.turns = self.brisk = False
        self.past = [state_of(world, slot) for slot in range(len(world.state.x))]

    def speeds(self, state, slot):
        line = [round_shift(c, self.scales.shift) for c in state.v]
        return [*line, self.world.mobilities[slot].rim(state.omega, self.scales)]

    def place(self, slot):
        """The place of a body, which is taken in."""
        mobility = self.world.mobilities[slot]
        if slot in self.places or mobility.fixed:
            return self.places.get(slot, 0)
        self.turns |= abs(self.past[slot].omega) >= TURNING
        return self.enter(slot, self.speeds(self.past[slot], slot))

    def enter(self, slot, start):
        self.places[slot] = len(self.list)
        self.list.append(Mover(slot, start, self.world.mobilities[slot], self.scales))
        return self.places[slot]

    def place_of(self, slot):
        return self.places.get(slot, 0)

    def is_free(self, place):
        """Whether impulses leave it as it is."""
        return place == 0 or not self.list[place].mobility.moves()

    def is_empty(self):
        return len(self.list) < 2

    def kick(self, start, slot):
        """What forces add in a substep."""
        after = self.speeds(state_of(self.world, slot), slot)
        return bounded([div(after[axis] - start[axis], self.scales.substeps) for axis in range(3)])

    def take_kicks(self):
        for mover in self.list[1:]:
            mover.kick = self.kick(mover.start, mover.slot)

    def look_brisk(self):
        """Whether one is so fast that rows may send others aside."""
        most = self.scales.aside // 2
        for mover in self.list[1:]:
            gain = self.world.drive.gain(mover.slot)
            fast = any(abs(c) > most for c in mover.start)
            self.brisk |= fast or any(abs(c) >> self.scales.shift > most for c in gain)

    def begin(self, first):
        """Forces, and the impulses of the last substep once more."""
        for mover in self.list[1:]:
            change = mover.kick
            if not first:
                change = [mover.v[axis] - mover.begin[axis] + mover.cut[axis] for axis in range(3)]
                mover.begin = list(mover.v)
            mover.v = held([mover.v[axis] + change[axis] for axis in range(3)])

    def drift(self):
        for mover in self.list[1:]:
            limits = [SPEED_MAX << 48, SPEED_MAX << 48, mover.spin_max]
            mover.pushed |= any(mover.v[axis] - mover.begin[axis] != mover.kick[axis] for axis in range(3))
            kept = [clamp(mover.v[axis], -limits[axis], limits[axis]) for axis in range(3)]
            mover.cut = [mover.v[axis] - kept[axis] for axis in range(3)]
            mover.slowed |= any(mover.cut)
            mover.v = kept
            mover.sum = [total + read for total, read in zip(mover.sum, mover.read())]
            mover.go(self.scales)

    def may_join(self, begin, now):
        """Whether rows can follow a body that they did not know."""
        k = self.scales.shift
        fast = any(abs(c) >> k >= SPEED_MAX << 48 for c in now.v)
        return not fast and all(abs(now.x[axis] - begin.x[axis]) <= 1 << 35 + k for axis in (0, 1))

    def join(self, slot, begin, now):
        """Takes a body in at the end of a substep."""
        scales, k = self.scales, self.scales.shift
        place = self.enter(slot, self.speeds(begin, slot))
        mover = self.list[place]
        mover.kick = self.kick(mover.start, slot)
        mover.v = held(self.speeds(now, slot))
        mover.begin = bounded([mover.v[axis] - mover.kick[axis] for axis in range(3)])
        mover.sum = [div(now.x[axis] - begin.x[axis] << 51 - k, scales.line) for axis in (0, 1)]
        rolled = mul(now.angle - begin.angle, mover.mobility.sigma, k + 30)
        most = div((1 << 63) - (1 << 60), scales.coarse)
        mover.sum.append(max(-most, min(most, div(rolled << 33, scales.turn))))
        mover.pushed = mover.hit = True
        mover.go(scales)
        return place

    def is_aside(self, place):
        """Whether rows have changed its velocity so much that it may come to where it was not looked for neighbours."""
        mover = self.list[place]
        return mover.pushed and any(abs(mover.v[axis] - mover.start[axis]) > self.scales.aside for axis in (0, 1))

    def turned_aside(self):
        return [m.slot for place, m in enumerate(self.list) if self.brisk and place and self.is_aside(place)]

    def shifted(self, speed):
        """The slots of those that went farther in this tick than a speed would bring them."""
        way, bits = mul(speed, self.scales.tick, 79), self.scales.shift + 6
        return [m.slot for m in self.list[1:] if any(abs(c << bits) > way for c in m.d[:2])]

    def keeps(self, place):
        """Whether the rows say where it ends."""
        return place != 0 and (self.list[place].hit or self.list[place].slowed)

    def state(self, place, given):
        """Where it is when the way of this substep begins, which it has been given or not, and how it goes it."""
        mover, k = self.list[place], self.scales.shift
        read, begin = mover.read(), self.past[mover.slot]
        gone = [mover.sum[axis] - (read[axis] if given else 0) for axis in range(3)]
        turned = mover.mobility.over_sigma(mul(gone[2], self.scales.turn, 33), 50 - k, 48)
        return Row(
            x=[begin.x[axis] + mul(gone[axis], self.scales.line, 51 - k) for axis in (0, 1)],
            angle=turn_by(begin.angle, turned)[0], v=[sat64(read[axis] << 28 + k) for axis in (0, 1)],
            omega=mover.mobility.over_sigma(read[2], 20 - k, 48),
        )

    def strike(self, place, change, left):
        """An impact changed its velocities, with so much of the tick left of the substep."""
        if place == 0:
            return
        mover, scales = self.list[place], self.scales
        squeeze.allow(mover, change, self.world.seen)
        then = held([mover.v[axis] + change[axis] for axis in range(3)])
        for axis in range(3):
            by = then[axis] - mover.v[axis]
            # Warm starting does not repeat it.
            mover.begin[axis] = clamp(mover.begin[axis] + by, -BOUND, BOUND)
            mover.sum[axis] += round_shift(by * left * scales.substeps, 60)
        mover.v = then
        mover.go(scales)

    def store(self, faults):
        """Bodies that contacts pushed, to where contacts bring them."""
        state, scales, k = self.world.state, self.scales, self.scales.shift
        for mover in self.list[1:]:
            slot, begin = mover.slot, self.past[mover.slot]
            if not (mover.hit or mover.slowed) or not mover.mobility.moves() or self.world.is_asleep(slot):
                continue
            if mover.slowed:
                faults.append((slot, CONTACT_SPEED))
            way = mover.sum
            for axis, column in enumerate((state.x, state.y)):
                moved = begin.x[axis] + mul(way[axis], scales.line, 51 - k)
                column[slot] = clamp(moved, -FAR, FAR)
                if column[slot] != moved:
                    faults.append((slot, POSITION))
            rolled = mul(way[2], scales.turn, 33)
            state.angle[slot], over = turn_by(begin.angle, mover.mobility.over_sigma(rolled, 50 - k, 48))
            if over:
                faults.append((slot, TURNS))
            for axis, column in enumerate((state.vx, state.vy)):
                column[slot] = sat64(begin.v[axis] + (mover.v[axis] - mover.start[axis] << k))
            spun = mover.mobility.over_sigma(sub(mover.v[2], mover.start[2]), 48 - k, 48)
            state.omega[slot] = sat64(begin.omega + spun)
