"""The constants of a world's contact solver, and bodies as ratios: no reciprocal of a mass or an inertia."""

from ints import I64, TURN_PER_RADIAN_Q64, clamp, div, fits, mul, mul_div, round_shift, sat64, shifted, sqrt

SOFT_BIAS, SOFT_MASS, SOFT_IMPULSE = 48_321_781, 1_021_964_838, 51_776_986
SPEED_MAX = 400
SLOP = 6711
FIRM = 1 << 17
HEAVY = 1 << 48
HARD = 3 << 46
SQUEEZED = 6 << 48
MARGIN, SLACK = 85_899_346, 4_294_967
SPEED = 1 << 48
TICK = 1 << 32
DYNAMIC = 2


class Scales:
    """What a world's configuration makes of the constants."""

    def __init__(self, config):
        self.shift, self.substeps = k, n = config.unit_shift, config.substeps
        self.rate = rate = config.tick_rate * n
        self.line, self.turn = div(1 << 63, rate), div(TURN_PER_RADIAN_Q64, 2 * rate)
        self.coarse = div(1 << 30, rate)
        self.close_rate, self.push_rate = rate << 14, round_shift(SOFT_BIAS * rate, 16)
        self.rigid_rate, self.push = config.tick_rate << 12, -(1 << 20)
        self.firm = div((FIRM * self.push_rate * SOFT_MASS >> 20) * 3, SOFT_IMPULSE * 4)
        self.base, self.tick = MARGIN << k, div(1 << 63, config.tick_rate)
        self.tick_turn = div(TURN_PER_RADIAN_Q64, 2 * config.tick_rate)
        self.slack, self.deep, self.touching = SLACK << k, 10 * (SLACK << k), SLOP << k + 6
        self.aside = MARGIN // 2 * config.tick_rate << 16
        self.astray = self.base // 2
        self.swinging, self.still, self.least_settled = SPEED << k, SPEED // 1000 << k, SPEED // 10 << k

    def span(self, substep):
        """When a substep begins and ends, from 1 on; Q32 of the tick."""
        return [(n << 32) // self.substeps for n in (substep - 1, substep)]

    def is_squeezed(self, normal, overlap):
        """Whether bodies that overlap so much, with these impulses of the last tick, are squeezed."""
        return normal[0] + normal[1] >= SQUEEZED and overlap > 2 * self.slack

    def threshold(self, restitution, press, among):
        """The speed of approach from which on a pair strikes."""
        if restitution >= SPEED:
            return 0
        most = SPEED << self.shift
        if restitution == 0:
            return most
        fast = clamp(div(press << 47, restitution), most // 100, most)
        return max(fast, 4 * press) if among else fast

    def least_strike(self, restitution, borne, reach):
        """The least speed of approach that is answered as an impact."""
        if restitution >= SPEED:
            return SPEED // 1_000_000
        plain = SPEED // (100 if restitution else 2) << self.shift
        if not borne:
            return plain
        most = SPEED * (2 if restitution else 8) << self.shift
        return max(min(most, sat64(reach * self.rate << 13)), plain)

    def parting(self, restitution, gap, threshold, press):
        """The speed beyond which a near pair parts."""
        if restitution >= SPEED:
            return -1 if gap else SPEED // 100 << self.shift
        return threshold if press == 0 else SPEED << self.shift


def weight(gain):
    """What forces add in a tick to a body's speed, in whatever direction."""
    x, y = abs(gain[0]), abs(gain[1])
    return max(x, y) + (min(x, y) >> 1)


class Mobility:
    """The length σ of a body, its τ = σ²·m/I, and its mass as a mantissa of 34 bits and an exponent."""

    def __init__(self, body):
        self.reach, self.fixed = body.reach, body.kind == 0
        self.mantissa = self.exponent = self.sigma = self.tau = self.tau_fine = 0
        self.inverse = self.inverse_shift = self.scale = self.scale_shift = 0
        if body.reach == 0:
            return
        rho = min(sqrt(abs(mul_div(body.inertia, 1 << 64, body.mass))), I64)
        least = (body.reach * 10 + 78) // 79
        self.sigma = sigma = body.reach if body.fixed_rotation else max(min(max(rho, least), body.reach), 1)
        if body.kind == DYNAMIC:
            self.exponent = max(body.mass.bit_length() - 34, 0)
            self.mantissa = round_shift(body.mass, self.exponent)
            if not body.fixed_rotation:
                self.tau_fine = mul_div(sigma * sigma, body.mass, body.inertia) >> 16
        self.tau = self.tau_fine >> 20
        log = sigma.bit_length() - 1
        self.inverse_shift, self.scale_shift = 62 + log, log - 28
        self.inverse = div(1 << self.inverse_shift, sigma)
        self.scale = div(1 << 58, shifted(sigma, self.scale_shift))

    def moves(self):
        return self.mantissa != 0

    def turning(self):
        """What w² weighs of v², Q48."""
        return div(1 << 96, self.tau_fine) if self.tau_fine > 0 else 0

    def share(self, other):
        """The part p = m_b/(m_a + m_b) of the first of two bodies, Q28."""
        if not self.moves():
            return 0
        if not other.moves():
            return 1 << 28
        top = max(self.exponent, other.exponent)
        a, b = (m.mantissa >> min(top - m.exponent, 63) for m in (self, other))
        return ((b << 28) + (a + b >> 1)) // (a + b)

    def part(self, other):
        """The same, Q48 and finer."""
        if not self.moves() or not other.moves():
            return (1 << 48) if self.moves() else 0
        top = max(self.exponent, other.exponent)
        a, b = ((m.mantissa << 40) >> min(top - m.exponent, 100) for m in (self, other))
        return div(b << 48, a + b)

    def relative(self, arm):
        """An arm over σ, Q28."""
        most, limit = self.sigma << 3, (8 << 28) - 1
        found = []
        for r in arm:
            r = shifted(clamp(r, -most, most), self.scale_shift)
            found.append(clamp(round_shift(fits(r * self.scale, 64), 30), -limit, limit))
        return found

    def over_sigma(self, value, start, to):
        """value / 2^start m over σ, with `to` fraction bits."""
        return sat64(round_shift(value * self.inverse, self.inverse_shift + start - to - 32))

    def rim(self, omega, scales):
        """w = σ·ω over 2^k, Q48."""
        return mul(omega, self.sigma, scales.shift + 32)
