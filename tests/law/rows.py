"""The rows of contacts: preparation, and what a sweep does.

A contact has a row of friction and one for each of its two points. Velocities are Q48 over 2^k, impulses Q20,
coefficients Q28, separations Q26. `fits` says what the range tables promise.
"""

from ints import clamp, fits, mul, round_shift, shifted
from ratios import SLOP, SOFT_IMPULSE, SOFT_MASS

ONE = 1 << 28
LIMIT = (8 << 28) - 1
IMPULSE_MAX = 1 << 29
HELD = 1 << 57
FAR = (1 << 31) - 1
LOAD, BLOW = 1 << 13, 1 << 14
PUSHES = -(1 << 44)
ROUNDS = 8


def limit(value):
    return clamp(value, -(1 << 30), 1 << 30)


def scale(coefficient, v):
    return round_shift(coefficient * v, 28)


class Line:
    """One direction at one point: arms α, 1/κ, p·τ·α/κ of both bodies, and the impulse λ̂."""

    __slots__ = ("arm", "line", "turn", "impulse", "kappa")

    def __init__(self, arm=None, inertia=(0, 0)):
        self.arm, self.line, self.turn, self.impulse, self.kappa = arm or (0, 0), 0, (0, 0), 0, 0
        if arm is None:
            return
        turn = [scale(arm[0], inertia[0]), scale(arm[1], inertia[1])]
        self.kappa = ONE + scale(arm[0], turn[0]) + scale(arm[1], turn[1])
        self.line = ((1 << 56) + (self.kappa >> 1)) // self.kappa
        self.turn = [fits(scale(self.line, turn[0]), 32), fits(scale(self.line, turn[1]), 32)]

    def start(self, carried):
        """λ̂ = κ·(λ·S), of what the last tick left."""
        self.impulse = clamp(mul(carried, self.kappa, 56), -IMPULSE_MAX, IMPULSE_MAX) if carried else 0

    def carried(self):
        return self.impulse * self.line

    def turns(self, arm):
        """What an impulse of it adds by turning to the speed of a row with other arms, Q27."""
        return clamp(round_shift(self.turn[0] * arm[0] + self.turn[1] * arm[1], 29), -(11 << 27), 11 << 27)


class Contact:
    """A contact's rows. `places`: of its bodies among the movers; the same twice once it is taken out."""

    def __init__(self, pair, between, mobility, old, scales):
        self.heavy = self.pushes = self.retired = False
        self.write(pair, [between] * 2, mobility, old, scales)

    def write(self, pair, betweens, mobility, old, scales):
        """`betweens`: for each point, from a's centre to b's. `old`: what the last tick left."""
        manifold, friction = pair.manifold, pair.friction
        first = mobility[0].share(mobility[1])
        share = [first, ONE - first if mobility[1].moves() else 0]
        inertia = [scale(share[body], mobility[body].tau) for body in (0, 1)]
        self.places = list(pair.places)
        self.normal = n = [round_shift(c, 2) for c in manifold.normal]
        self.reply = [[round_shift(share[0] * c, 28) for c in n], [-round_shift(share[1] * c, 28) for c in n]]
        points = manifold.points
        arms = [self.arms(p, between, manifold.normal, mobility) for p, between in zip(points, betweens)]
        arms += [None] * (2 - len(arms))
        lower = int(len(points) > 1 and points[1].separation < points[0].separation)
        self.friction = Line(arms[lower] and arms[lower][1], inertia)
        self.points, self.limit, self.separation, carried = [], [0, 0], [FAR, FAR], 0
        for at in (0, 1):
            row = Line(arms[at] and arms[at][0], inertia)
            self.points.append(row)
            if at < len(points):
                known = [k for k in range(old.count) if old.ids[k] == points[at].id]
                if known:
                    carried = old.tangent
                    row.start(old.normal[known[0]])
                self.limit[at] = min(mul(scale(row.line, self.friction.kappa), friction, 48), FAR)
                self.separation[at] = limit(shifted(points[at].separation, scales.shift + 6))
        self.peak = [row.impulse for row in self.points]
        self.friction.start(carried)
        self.couple = [self.friction.turns(self.points[at].arm) for at in (0, 1)]
        self.couple.append(self.points[0].turns(self.points[1].arm))

    def arms(self, point, between, normal, mobility):
        """α of both bodies along the normal and along the tangent: each has the point on its own surface."""
        half = max(point.separation, 0) >> 1
        out = [mul(half, c, 30) for c in normal]
        nx, ny = self.normal
        along, across = [0, 0], [0, 0]
        for body in (0, 1):
            if self.places[body] == 0:
                continue
            if body == 0:
                r = [point.arm[axis] + out[axis] for axis in (0, 1)]
            else:
                r = [point.arm[axis] - between[axis] - out[axis] for axis in (0, 1)]
            x, y = mobility[body].relative(r)
            along[body] = clamp(round_shift(x * ny - y * nx, 28), -LIMIT, LIMIT)
            across[body] = clamp(round_shift(x * nx + y * ny, 28), -LIMIT, LIMIT)
        return along, across

    def is_out(self):
        return self.places[0] == self.places[1]

    def retire(self):
        self.places = [0, 0]

    def bears(self):
        return any(row.impulse for row in (self.friction, *self.points))

    def spent(self):
        return self.peak[0] > 0 or self.peak[1] > 0

    def moved(self, at, a, b):
        """How much farther apart a point is than when the tick began, Q26."""
        arm = self.points[at].arm
        apart = self.normal[0] * (a.d[0] - b.d[0]) + self.normal[1] * (a.d[1] - b.d[1])
        return round_shift(apart + arm[0] * a.d[2] - arm[1] * b.d[2], 28)

    def backdate(self, movers):
        """Separations of now to those with which the tick would have begun."""
        a, b = (movers[place] for place in self.places)
        for at in (0, 1):
            if self.separation[at] < FAR:
                self.separation[at] = limit(self.separation[at] - self.moved(at, a, b))

    def impulses(self):
        return [self.friction.impulse, self.points[0].impulse, self.points[1].impulse]

    def renew(self, movers, write):
        """Written anew between sweeps: impulses are taken back along old directions, given along new ones."""
        peak = self.peak
        self.give(movers, [-impulse for impulse in self.impulses()])
        write(self)
        self.give(movers, self.impulses())
        self.peak = [max(old, new) for old, new in zip(peak, self.peak)]
        self.backdate(movers)

    def give(self, movers, change):
        """Changes of the impulses of friction and of both points, to the bodies."""
        slide, first, second = change
        f, (p, q) = self.friction, self.points
        push = round_shift(p.line * first + q.line * second, 28)
        drag = round_shift(f.line * slide, 28)
        for body, sign in ((0, 1), (1, -1)):
            x, y = self.reply[body]
            v = movers[self.places[body]].v
            turn = f.turn[body] * slide + p.turn[body] * first + q.turn[body] * second
            gain = (x * push - y * drag, y * push + x * drag, sign * turn)
            for axis in (0, 1, 2):
                v[axis] = clamp(v[axis] + gain[axis], -HELD, HELD)

    def solve(self, biased, movers, scales):
        """A sweep over one contact; a blow goes round between the points."""
        blow, self.pushes = self.once(biased, True, movers, scales)
        for _ in range(ROUNDS - 1):
            if not blow:
                break
            blow, _ = self.once(biased, False, movers, scales)

    def look(self, movers):
        """What the rows read: the slip and the speeds of the points, Q48, and how far these are from touching."""
        a, b = (movers[place] for place in self.places)
        nx, ny = self.normal
        vx, vy = (fits(round_shift(a.v[axis] - b.v[axis], 28), 32) for axis in (0, 1))
        wa, wb = round_shift(a.v[2], 28), round_shift(b.v[2], 28)
        along, across = nx * vx + ny * vy, nx * vy - ny * vx
        slip, *speed = (row.arm[0] * wa - row.arm[1] * wb for row in (self.friction, *self.points))
        separation = [limit(self.separation[at] + self.moved(at, a, b)) for at in (0, 1)]
        return across + slip, [along + speed[0], along + speed[1]], separation

    def hold(self, load):
        """What friction holds at most under these loads."""
        return min(round_shift(self.limit[0] * load[0] + self.limit[1] * load[1], 28), IMPULSE_MAX)

    def once(self, biased, slides, movers, scales):
        """Friction, then the points; whether an impulse changed much, and whether a row pushed."""
        if self.is_out():
            return False, False
        slip, speed, separation = self.look(movers)
        load = [row.impulse for row in self.points]
        slide = 0
        if slides:
            hold = self.hold(load)
            impulse = clamp(self.friction.impulse - round_shift(slip, 28), -hold, hold)
            slide = impulse - self.friction.impulse
            self.friction.impulse = impulse
            speed = [speed[at] + 2 * self.couple[at] * slide for at in (0, 1)]
        first, pushes_first = answer(biased, speed[0], load[0], separation[0], scales)
        change = first - load[0]
        speed[1] += 2 * self.couple[2] * change + self.points[0].line * change
        second, pushes_second = answer(biased, fits(speed[1], 64), load[1], separation[1], scales)
        for at, impulse in enumerate((first, second)):
            self.points[at].impulse = impulse
            self.peak[at] = max(self.peak[at], impulse)
        changes = [slide, change, second - load[1]]
        if any(changes):
            self.give(movers, changes)
        return max(abs(changes[1]), abs(changes[2])) >= BLOW, pushes_first or pushes_second


def answer(biased, speed, load, separation, scales):
    """The impulse with which a point answers its speed, and whether that pushes an overlap apart."""
    speed = round_shift(speed, 28)
    gap = separation > 0
    if not biased:
        # What approaches is stopped; what is not there yet is left alone.
        return clamp(load - (0 if gap and speed < 0 else speed), 0, IMPULSE_MAX), False
    if gap:
        way, rate, mass, give = separation, scales.close_rate, 1 << 30, 0
    else:
        way, rate, mass, give = min(separation + SLOP, 0), scales.push_rate, SOFT_MASS, SOFT_IMPULSE
    bias = min(limit(way * rate >> 20), (1 << 30) - 1)
    # What the load leaves of the bias opens the overlap, and not too fast.
    opens = mass * bias + give * min(load, (load >> 2) + scales.firm)
    pushes = bias < 0 and (opens < PUSHES or load < LOAD)
    answers = fits(mass * limit(speed) + max(opens, SOFT_MASS * scales.push), 64)
    return clamp(load - round_shift(answers, 30), 0, IMPULSE_MAX), pushes
