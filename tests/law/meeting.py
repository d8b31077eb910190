"""When two moving outlines first touch within a tick: conservative advancement of second order.

Times are Q32 of a tick, ways Q32 m, rates Q40 a tick, heights Q38 m.
"""

from math import isqrt
from types import SimpleNamespace as Row

from ints import TURN_PER_RADIAN_Q64, clamp, mul
from narrow import add, along, inner, neg, region, sub, unit
from shapes import placed

TOUCH, NEAR = 430 << 6, 42_950 << 6
PATIENCE, ROUNDS = 40, 256
NEVER = (1 << 63) - 1
RATE, CURVE = 1 << 60, 1 << 62


def way(v, a, time, shift):
    """v·τ + ½·a·τ²."""
    return mul(v + mul(a, time, 33), time, shift)


def bound(v):
    """No less than a vector's length."""
    x, y = abs(v[0]), abs(v[1])
    return max(x, y) + (min(x, y) >> 1) + 1


def quarter(v):
    return [-v[1], v[0]]


def component(n, v):
    return inner(n, v) >> 30


def seen(owner, v):
    return neg(v) if owner else v


def fastest(motion, reach, until):
    """A bound of the speed of points of outlines against each other."""
    total = bound(motion.v) + mul(bound(motion.a), until, 32) + 1
    for body in (0, 1):
        spin = abs(motion.omega[body]) + mul(abs(motion.alpha[body]), until, 32)
        total += mul(spin, reach[body], 32) + 1
    return total


# A height h + g·τ + ½·c·τ²: Q38 m, Q40 m a tick, Q36 m a tick².


def height_at(course, time):
    """Q72, rounded down."""
    height, rate, curve = course
    return (height << 34) + ((curve * time >> 29) + rate) * time


def end(course, rest):
    """The first time at which it is 0 or less; NEVER if after `rest`."""
    height, rate, curve = course
    if height <= 0:
        return 0
    if (curve <= 0 and height_at(course, rest) > 0) or (curve > 0 and rate >= 0):
        return NEVER
    square = rate * rate - (curve * height << 7)
    if square < 0:
        return NEVER
    root = isqrt(square)
    time = (height << 35) // (root - rate + 1) if rate < 0 else (root + rate << 28) // -curve
    return time if time <= rest else rest if curve <= 0 else NEVER


def falls(course, closing):
    """When the height may fall by more than `closing`."""
    _, rate, curve = course
    if curve >= 0:
        return NEVER
    return min((max(rate + closing, 0) << 28) // -curve + 1, NEVER)


class Path:
    """A motion, and what of it does not change."""

    def __init__(self, outlines, motion, until):
        self.outlines, self.motion, self.until = outlines, motion, until
        self.arms = [of.reach - of.radius for of in outlines]
        for body in (0, 1):
            if self.arms[body] <= 0:
                motion.omega[body] = motion.alpha[body] = 0
        self.turns = [[mul(rate, TURN_PER_RADIAN_Q64, 56) for rate in rates] for rates in (motion.omega, motion.alpha)]
        self.turning = [motion.omega[body] != 0 or motion.alpha[body] != 0 for body in (0, 1)]

    def place(self, body, time):
        angle = self.motion.angle[body] + way(self.turns[0][body], self.turns[1][body], time, 32)
        return placed(self.outlines[body], angle)

    def before(self, touch):
        """A time before which they cannot touch, by the discs in which outlines turn; none if they never can."""
        reach = sum(of.reach for of in self.outlines)
        overlap = inner(self.motion.d, self.motion.d) <= reach * reach
        if not any(self.turning) or (all(self.turning) and overlap):
            return 0
        hulls = [
            Row(vertices=[[0, 0]], normals=[], radius=self.outlines[body].reach, count=1)
            if self.turning[body] else self.place(body, 0) for body in (0, 1)
        ]
        time = 0
        for _ in range(2):
            moment = Moment(self, hulls, [False, False], time)
            _, separation = moment.widest()
            if separation <= touch:
                break
            step = moment.advance(separation)
            if step == NEVER:
                return None
            time += step
        return time


class Moment:
    """The bodies at a time, and the axes that may separate them."""

    def __init__(self, path, outlines, turning, time):
        motion = path.motion
        self.placed, self.turning, self.arms = outlines, turning, path.arms
        self.rest = path.until - time
        self.a = motion.a
        self.d = [motion.d[axis] + way(motion.v[axis], motion.a[axis], time, 40) for axis in (0, 1)]
        self.v = [motion.v[axis] + mul(motion.a[axis], time, 32) for axis in (0, 1)]
        self.omega, self.alpha, self.spins = [0, 0], [0, 0], [0, 0]
        for body in (0, 1):
            if turning[body]:
                self.omega[body] = motion.omega[body] + mul(motion.alpha[body], time, 32)
                self.alpha[body] = motion.alpha[body]
            self.spins[body] = abs(self.omega[body]) + abs(mul(self.alpha[body], self.rest, 32))
        self.fast = bound(self.v) + mul(bound(self.a), self.rest, 32)
        self.far = bound(self.d) + mul(self.fast, self.rest, 40) + 2
        self.axes = [
            Row(normal=own.normals[edge], owner=owner, start=own.vertices[edge], edge=True)
            for owner, own in enumerate(outlines) if own.count > 1 for edge in range(own.count)
        ]
        self.radial()
        for axis in self.axes:
            self.settle(axis)

    def radial(self):
        """The direction from a circle's centre to the nearest vertex of the other, if that is what it is nearest to."""
        owner = int(self.placed[0].count > 1)
        own, other = self.placed[owner], self.placed[1 ^ owner]
        if own.count > 1:
            return
        start = own.vertices[0]
        shift, vertex = sub(seen(owner, self.d), start), 0
        if other.count > 1:
            center = neg(shift)
            outside = [along(n, sub(center, v)) for n, v in zip(other.normals, other.vertices)]
            what, vertex = region(other, center, outside.index(max(outside)))
            if what == "edge" or max(outside) <= 0:
                return
        found = unit(add(other.vertices[vertex], shift))
        if found:
            self.axes.append(Row(normal=found[0], owner=owner, start=start, edge=False))

    def settle(self, axis):
        """The separation along an axis, and the vertex it is at (ties: lower index)."""
        own, other = self.placed[axis.owner], self.placed[1 ^ axis.owner]
        axis.shift = sub(seen(axis.owner, self.d), axis.start)
        heights = [along(axis.normal, add(q, axis.shift)) for q in other.vertices]
        axis.radii = (other.radius if axis.edge else own.radius + other.radius) << 6
        axis.nearest = heights.index(min(heights))
        axis.separation = min(heights) - axis.radii

    def widest(self):
        """The axis of the greatest separation (ties: the last one), and that."""
        separation = max((axis.separation for axis in self.axes), default=-NEVER - 1)
        return next((axis for axis in reversed(self.axes) if axis.separation == separation), None), separation

    def courses(self, axis):
        """How the heights of the other's vertices over an axis go, bounded from below."""
        owner, normal, edge = axis.owner, axis.normal, axis.edge
        r, o = owner, 1 ^ owner
        d, v, a = (seen(owner, each) for each in (self.d, self.v, self.a))
        rate, curve = component(normal, v), component(normal, a) >> 4
        vertices = self.placed[o].vertices
        if self.turning == [False, False]:
            height = along(normal, add(vertices[axis.nearest], axis.shift)) - axis.radii
            return [(height, rate, curve)]
        spin, at = (self.omega[o] - self.omega[r], d) if edge else (self.omega[o], axis.start)
        alpha = [abs(each) for each in self.alpha]
        change = mul(alpha[o] + (alpha[r] if edge else 0), self.rest, 32)
        most, least = abs(spin) + change, max(abs(spin) - change, 0)
        squares = [least * least >> 48, (most * most >> 48) + 1]
        arm = self.arms[o] << 6
        sway = mul(mul(most, self.rest, 32) + 1, arm, 40) + 1
        curve -= alpha[o] * self.arms[o] >> 36
        if self.turning[r]:
            rate = clamp(rate - (self.omega[r] * along(normal, quarter(at)) >> 38), -RATE, RATE)
            if edge:
                curve -= self.bend(normal, r, d, v)
            else:
                square = self.spins[r] * self.spins[r] >> 44
                curve -= (square * self.arms[r] >> 32) + (alpha[r] * self.arms[r] >> 36)
        curve = clamp(curve - 8, -CURVE, CURVE)
        found = []
        for q in vertices:
            height = along(normal, add(q, axis.shift)) - axis.radii
            own_rate, own_curve = rate, curve
            if squares[1] > 0:
                own_rate = clamp((spin * along(normal, quarter(q)) >> 38) + rate, -RATE, RATE)
                out = min(along(normal, q) + sway + 2, arm)
                own_curve = clamp(curve - (squares[out > 0] * out >> 34), -CURVE, CURVE)
            found.append((height, own_rate, own_curve))
        return found

    def bend(self, normal, r, d, v):
        """What the turning of r's edge takes from second derivatives at most."""
        spin, omega, alpha = self.spins[r], self.omega[r], abs(self.alpha[r])
        push, turned = bound(self.a), mul(spin, self.rest, 32) + 1
        square = (spin * spin >> 48) + 1
        spun, fled = square * self.far >> 28, spin * self.fast >> 44
        least = spun + 2 * fled + (turned * push >> 44)
        if turned < 1 << 40:
            change = ((push * 3 >> 4) + 3 * fled + spun) * turned >> 40
            eased = (alpha * self.rest >> 32) * ((spin * self.far >> 32) + self.fast) >> 43
            now = (omega * omega >> 48) * along(normal, d) >> 34
            now += omega * component(normal, quarter(v)) >> 43
            least = min(least, now + change + eased)
        return least + (alpha * (self.far + self.arms[1 ^ r]) >> 36)

    def first(self, axis):
        """When the first vertex may come to an axis."""
        first = NEVER
        for course in self.courses(axis):
            first = min(first, end(course, min(self.rest, first)))
        return first

    def advance(self, separation):
        """How long they cannot touch, being apart."""
        least = separation * 5 >> 4
        return max((self.first(axis) for axis in self.axes if axis.separation >= least), default=0)

    def look(self, terms):
        """("touch" | "never" | "apart" | "held", how long, how far apart)."""
        widest, separation = self.widest()
        if separation > terms.tolerance:
            step = self.advance(separation)
            return ("never" if step == NEVER else "apart"), step, separation
        band = max(terms.tolerance, terms.slack)
        if separation < -band:
            return "never", 0, separation
        toward = seen(widest.owner, widest.normal)
        waits = []
        for axis in self.axes:
            if axis.separation < -band:
                continue
            # The far side of what is thin is no side to leave by.
            if axis.separation < -terms.tolerance and inner(toward, seen(axis.owner, axis.normal)) < 0:
                continue
            wait = self.wait(axis, terms, band)
            if wait is not None:
                waits.append(wait)
        if not waits:
            return "touch", 0, separation
        step = max(waits)
        return ("never", 0, separation) if step > self.rest else ("held", max(step, 1), separation)

    def wait(self, axis, terms, band):
        """How long an axis on which they touch does not close; none if it does."""
        first = NEVER
        for course in self.courses(axis):
            height, rate, curve = course
            if height > terms.tolerance:
                first = min(first, end(course, min(self.rest, first)))
                continue
            if rate < -terms.closing:
                return None
            lifted = (max(height, 0) + (terms.touch >> 1), rate, curve)
            sunk = (height + band, rate, curve)
            slow = min(falls(course, terms.closing), end(sunk, self.rest))
            first = min(first, max(slow, end(lifted, self.rest)))
        return first


def first_touch(a, b, motion, until, closing, slack):
    """The first time at which two outlines touch and close along every axis that counts; none if there is none."""
    until = clamp(until, 0, 1 << 32)
    limit = lambda v, most: [clamp(c, -most, most) for c in v]
    motion = Row(
        d=list(motion.d), v=limit(motion.v, 1 << 53), a=limit(motion.a, 1 << 53), angle=list(motion.angle),
        omega=limit(motion.omega, 1 << 52), alpha=limit(motion.alpha, 1 << 52),
    )
    for axis in (0, 1):
        far = mul(abs(motion.v[axis]), until, 40) + mul(abs(motion.a[axis]), until, 41) + 2
        if abs(motion.d[axis]) - far > a.reach + b.reach:
            return None
    touch = mul(TOUCH, max(a.reach, b.reach, 4 << 32), 34)
    terms = Row(touch=touch, tolerance=touch, closing=closing, slack=clamp(slack, 0, 1 << 40) << 6)
    path = Path([a, b], motion, until)
    time = path.before(touch)
    if time is None:
        return None
    outlines = [path.place(body, time) for body in (0, 1)]
    for round in range(ROUNDS):
        if round == PATIENCE:
            terms.tolerance = max(terms.tolerance, NEAR)
        what, step, separation = Moment(path, outlines, path.turning, time).look(terms)
        if what == "touch":
            break
        if what == "never":
            return None
        if what == "apart" and step == 0:
            terms.tolerance = separation
            continue
        time += step
        outlines = [path.place(body, time) if path.turning[body] else outlines[body] for body in (0, 1)]
    return time
