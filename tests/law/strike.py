"""The answer to impacts: impulses for all points of the contacts that meet at one time, together.

Velocities and impulses are Q48 over 2^k; an impulse λ is carried as λ·(1/m_a + 1/m_b), a velocity.
"""

from ints import add, clamp, cross, div, dot, mul, sat64, sat128, sub

LIMIT = 1 << 61
ROUNDS = (32, 256)
ONE = 1 << 48
PASSES, PLAIN = 24, 8


def bounded(v):
    return clamp(v, -LIMIT, LIMIT)


class Line:
    """A direction at a point: arms α, p·τ·α, κ and 1/κ (Q62), the speed it is to have, the impulse."""

    def __init__(self, along, arm, between, mobility, share):
        self.along, self.arm, self.turn = along, [0, 0], [0, 0]
        other = [arm[0] - between[0], arm[1] - between[1]]
        for body, r in ((0, arm), (1, other)):
            if not mobility[body].fixed:
                self.arm[body] = mobility[body].over_sigma(cross(r, along, 30), 32, 48)
            self.turn[body] = mul(mul(share[body], mobility[body].tau_fine, 48), self.arm[body], 48)
        self.kappa = add(share[0] + share[1], self.turned_by(self))
        self.inverse = div(1 << 110, self.kappa)
        self.target = self.impulse = 0

    def speed(self, a, b):
        turning = sub(mul(self.arm[0], a[2], 48), mul(self.arm[1], b[2], 48))
        return add(dot((sub(a[0], b[0]), sub(a[1], b[1])), self.along, 30), turning)

    def turned_by(self, other):
        return add(mul(self.arm[0], other.turn[0], 48), mul(self.arm[1], other.turn[1], 48))


class Strike:
    """A contact at the time of its impact. `bodies`: places among the speeds."""

    def __init__(self, bodies, manifold, points, between, mobility, friction, joined):
        self.bodies, self.count, self.rough, self.brace = bodies, len(points), friction, None
        self.share = share = [mobility[0].part(mobility[1]), mobility[1].part(mobility[0])]
        n = list(manifold.normal)
        t = [-n[1], n[0]]
        arms = [point.arm for point in points] + [[0, 0]] * (2 - len(points))
        line = lambda along, arm: Line(along, arm, between, mobility, share)
        self.points, self.friction = [line(n, arm) for arm in arms], line(t, arms[0])
        if joined:
            # Held at the point and at the centre of one that moves.
            second = [0, 0] if mobility[0].moves() else between
            self.brace, self.count, self.rough = [line(n, second), line(t, second)], 1, 0
        self.couple = add(share[0] + share[1], self.points[0].turned_by(self.points[1]))
        self.determinant = None
        if self.count == 2:
            whole = self.points[0].kappa * self.points[1].kappa
            determinant = whole - self.couple * self.couple
            self.determinant = determinant if determinant > whole >> 30 else None

    def speeds(self, speeds):
        a, b = (speeds[at] for at in self.bodies)
        return [row.speed(a, b) for row in self.points]

    def approach(self, speeds):
        """The fastest approach of its points, not positive."""
        return min(*self.speeds(speeds)[: self.count], 0)

    def parting(self, speeds):
        return max(self.speeds(speeds)[: self.count])

    def aim(self, speeds, restitution):
        """Sets the speeds with which points are to separate."""
        apart = self.speeds(speeds)
        differ = (apart[0] >= 0) != (apart[1] >= 0) or self.determinant is None
        if restitution > 0 and self.count == 2 and differ:
            if apart[0] > apart[1]:
                self.points.reverse()
            self.count, self.determinant = 1, None
        for row, speed in zip(self.points, self.speeds(speeds)):
            row.target = -mul(min(speed, 0), restitution, 48)

    def forget(self):
        for row in [self.friction, *self.points, *(self.brace or [])]:
            row.impulse = 0

    def give(self, row, impulse, speeds):
        if impulse == 0:
            return
        for body, sign in ((0, 1), (1, -1)):
            v = speeds[self.bodies[body]]
            line = mul(sub(0, impulse) if sign < 0 else impulse, self.share[body], 48)
            for axis in (0, 1):
                v[axis] = bounded(v[axis] + mul(line, row.along[axis], 30))
            v[2] = bounded(v[2] + mul(sub(0, impulse) if sign < 0 else impulse, row.turn[body], 48))

    def sweep(self, speeds, enough):
        """Friction and both points until none changes by more than `enough`; the greatest change of an impulse."""
        if self.brace:
            return self.hold(speeds)
        apart = self.speeds(speeds)
        rows = [self.friction, *self.points]
        start = [row.impulse for row in rows]
        if self.rough > 0:
            slip = self.friction.speed(*(speeds[at] for at in self.bodies))
            across = [row.turned_by(self.friction) for row in self.points]
            for done in range(PASSES):
                slide = self.slide(slip, across, done < PLAIN)
                if done > 0 and abs(slide) <= enough:
                    break
                self.friction.impulse = add(self.friction.impulse, slide)
                slip = add(slip, mul(self.friction.kappa, slide, 48))
                apart = [add(apart[at], mul(across[at], slide, 48)) for at in (0, 1)]
                for at, change in enumerate(self.press(apart)):
                    slip = add(slip, mul(across[at], change, 48))
        else:
            self.press(apart)
        changes = [sub(row.impulse, before) for row, before in zip(rows, start)]
        for row, change in zip(rows, changes):
            self.give(row, change, speeds)
        return max(abs(change) for change in changes)

    def hold(self, speeds):
        """Of bodies that go on as one: once through all rows."""
        changed = 0
        for row in [*self.brace, self.friction, self.points[0]]:
            change = -mul(row.speed(*(speeds[at] for at in self.bodies)), row.inverse, 62)
            row.impulse = add(row.impulse, change)
            self.give(row, change, speeds)
            changed = max(changed, abs(change))
        return changed

    def slide(self, slip, across, foresight):
        """By how much friction is to change, so that nothing slips, or within what it may be of the load."""
        now, load = self.friction.impulse, add(self.points[0].impulse, self.points[1].impulse)
        slope = self.slope(across) if foresight and load > 0 else None
        inverse, yields = slope or (self.friction.inverse, 0)
        change = -mul(slip, inverse, 62)
        then = add(now, change)
        if abs(then) <= mul(max(sub(load, mul(yields, change, 48)), 0), self.rough, 48):
            return change
        # It slides: f = ±μ·(N − y·(f − f₀)), for f.
        rough = -self.rough if then < 0 else self.rough
        by = add(mul(rough, yields, 48), 1 << 48)
        bound = sat64(div(rough * add(load, mul(yields, now, 48)), by)) if by > 1 << 45 else mul(rough, load, 48)
        return sub(bound if (bound < 0) == (rough < 0) else 0, now)

    def slope(self, across):
        """How the points that press would answer friction: 1/(κ − what they take of it), and what of load yields."""
        p, q = self.points
        if p.impulse > 0 and q.impulse > 0:
            if self.determinant is None:
                return None
            reply = [
                over(q.kappa * across[0] - self.couple * across[1], self.determinant),
                over(p.kappa * across[1] - self.couple * across[0], self.determinant),
            ]
        elif p.impulse > 0:
            reply = [mul(across[0], p.inverse, 62), 0]
        elif q.impulse > 0:
            reply = [0, mul(across[1], q.inverse, 62)]
        else:
            return None
        left = sub(self.friction.kappa, add(mul(across[0], reply[0], 48), mul(across[1], reply[1], 48)))
        return (sat64(div(1 << 110, left)), add(reply[0], reply[1])) if left > self.friction.kappa >> 6 else None

    def press(self, apart):
        """Gives the points what they want; their speeds `apart` follow."""
        change = self.answer(apart)
        for at, other in ((0, 1), (1, 0)):
            row = self.points[at]
            row.impulse = add(row.impulse, change[at])
            apart[at] = add(add(apart[at], mul(row.kappa, change[at], 48)), mul(self.couple, change[other], 48))
        return change

    def answer(self, apart):
        """The changes of the points' impulses that give them their target speeds, none of them pulling."""
        rows = self.points
        want = [sub(rows[at].target, apart[at]) for at in (0, 1)]
        least = [sub(0, row.impulse) for row in rows]
        alone = lambda at, wanted: max(mul(wanted, rows[at].inverse, 62), least[at])
        if self.determinant is None:
            deeper = int(self.count > 1 and want[1] > want[0])
            change = [0, 0]
            change[deeper] = alone(deeper, want[deeper])
            return change
        both = [over(rows[1 ^ at].kappa * want[at] - self.couple * want[1 ^ at], self.determinant) for at in (0, 1)]
        if both[0] >= least[0] and both[1] >= least[1]:
            return both
        found = []
        for free in (0, 1):
            held = 1 ^ free
            change = list(least)
            change[free] = alone(free, sub(want[free], mul(self.couple, least[held], 48)))
            speed = add(mul(rows[held].kappa, least[held], 48), mul(self.couple, change[free], 48))
            found.append((change, sub(speed, want[held])))
        return found[0][0] if found[0][1] >= found[1][1] else found[1][0]


def over(value, by):
    """A quotient of two Q96, Q48; both are shortened by what does not fit 128 bits."""
    up = min(max(127 - abs(value).bit_length(), 0), 48)
    return sat64(div(value << up, by >> 48 - up))


def gains(weights, before, after):
    """Whether impulses add to the energy of the bodies, beyond what rounding does."""
    top = max((exponent for _, exponent, _ in weights), default=0)
    gain = 0
    for (mantissa, exponent, turning), b, a in zip(weights, before, after):
        if mantissa == 0 and any(b):
            return False
        grown = [((y - x) * (y + x) >> 48) - (abs(x) + abs(y) >> 38) - 1 for x, y in zip(b, a)]
        total = grown[0] + grown[1] + (sat128(grown[2] * turning) >> 48)
        gain += total * mantissa >> min(top - exponent, 120)
    return gain > 0


def rounds(strikes, speeds, enough, most):
    """Goes through contacts until no impulse changes by more than `enough`; false if that takes too long."""
    return any(max((strike.sweep(speeds, enough) for strike in strikes), default=0) <= enough for _ in range(most))


def solve(strikes, restitutions, weights, speeds):
    """Solves the contacts in their order; the speeds before. `speeds` change."""
    before = [list(v) for v in speeds]
    elastic = any(restitution >= ONE for restitution in restitutions)
    approaches = [strike.approach(speeds) for strike in strikes]
    fastest = approaches.index(min(approaches)) if strikes else 0
    enough = 1 if elastic else max(sub(0, min(approaches, default=0)) >> 26, 1)
    for attempt in range(4):
        alone = attempt == 1 or len(strikes) < 2
        if attempt == 1 and len(strikes) < 2:
            continue
        for strike, restitution in zip(strikes, restitutions):
            strike.forget()
            strike.aim(before, restitution if attempt < 2 else 0)
            strike.rough = strike.rough if attempt < 3 else 0
        some = [strikes[fastest]] if alone else strikes
        ended = rounds(some, speeds, enough, ROUNDS[elastic])
        if (ended or alone or not elastic) and not gains(weights, before, speeds):
            break
        if attempt < 3:
            for v, old in zip(speeds, before):
                v[:] = old
    return before
