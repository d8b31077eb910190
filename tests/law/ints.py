"""The number kernels: rounding to nearest with ties away from zero, and saturation. Plain integers."""

from functools import reduce
from math import isqrt

I64, I128 = (1 << 63) - 1, (1 << 127) - 1
TAU_Q60 = 7_244_019_458_077_122_842
TURN_PER_RADIAN_Q64 = 2_935_890_503_282_001_226
TURN = 1 << 48


def clamp(value, low, high):
    return low if value < low else high if value > high else value


def sat64(value):
    """Limited to the symmetric range of 64 bits."""
    return clamp(value, -I64, I64)


def add(a, b):
    """A sum of two numbers of 64 bits, limited to these."""
    return clamp(a + b, -I64 - 1, I64)


def sub(a, b):
    return clamp(a - b, -I64 - 1, I64)


def total(values):
    """Of many, which are added one by one."""
    return reduce(add, values, 0)


def sat128(value):
    return clamp(value, -I128 - 1, I128)


def fits(value, bits):
    """The value itself, which the range tables say has so many bits."""
    assert -(1 << bits - 1) <= value < 1 << bits - 1, (value, bits)
    return value


def round_shift(value, shift):
    """value / 2^shift."""
    if shift == 0:
        return value
    half = 1 << shift - 1
    return value + half >> shift if value >= 0 else -(half - value >> shift)


def shifted(value, shift):
    """As round_shift, for negative shifts to the left."""
    return round_shift(value, shift) if shift > 0 else value << -shift


def mul(a, b, shift):
    return sat64(round_shift(a * b, shift))


def mul_add(a, b, c, lift, shift):
    return sat64(round_shift(a * b + (c << lift), shift))


def dot(a, b, shift):
    return sat64(round_shift(sat128(a[0] * b[0] + a[1] * b[1]), shift))


def cross(a, b, shift):
    return sat64(round_shift(sat128(a[0] * b[1] - a[1] * b[0]), shift))


def signed(negative, magnitude):
    magnitude = min(magnitude, I128)
    return -magnitude if negative else magnitude


def mul_div(a, b, d):
    """a·b/d; saturates, by 0 as well."""
    product = abs(a * b)
    negative = ((a < 0) != (b < 0)) != (d < 0)
    if d == 0:
        return signed(negative, I128 if product else 0)
    whole, rest = divmod(product, abs(d))
    return signed(negative, whole + (2 * rest >= abs(d)))


def div(n, d):
    return mul_div(n, 1, d)


def quotient(n, d):
    """Towards zero."""
    return abs(n) // abs(d) * (-1 if (n < 0) != (d < 0) else 1)


def cross_wide(a, b, shift):
    """a × b / 2^shift of 128 bits each."""
    limit = (1 << 126) - 1
    (ax, ay), (bx, by) = ([clamp(c, -limit, limit) for c in v] for v in (a, b))
    return clamp(round_shift(ax * by - ay * bx, shift), -I128, I128)


def sqrt(value):
    root = isqrt(value)
    return min(root + (value - root * root > root), (1 << 64) - 1)


def hypot(x, y):
    return sqrt(x * x + y * y)


Q = 62
ONE = 1 << Q


def series(r2, divisors):
    """1 − r²/d·(1 − r²/d'·(…)), products floored: the innermost divisor first."""
    value = ONE
    for at, divisor in enumerate(divisors):
        term = r2 * (ONE // divisor) >> Q
        value = ONE - (term if at == 0 else term * value >> Q)
    return value


def sin_cos(angle):
    """(cos, sin), Q30, of an angle in turns, Q48."""
    fraction = angle & TURN - 1
    quadrant = fraction + (TURN >> 3) >> 46
    r = round_shift((fraction - quadrant * (TURN >> 2)) * TAU_Q60, 46)
    r2 = r * r >> Q
    sin = round_shift(r * series(r2, (110, 72, 42, 20, 6)), 2 * Q - 30)
    cos = round_shift(series(r2, (132, 90, 56, 30, 12, 2)), Q - 30)
    return ((cos, sin), (-sin, cos), (-cos, -sin), (sin, -cos))[quadrant & 3]


def rotate(v, rot):
    """A vector turned by (cos, sin); rounded once per component, saturating."""
    return [dot(v, (rot[0], -rot[1]), 30), dot(v, (rot[1], rot[0]), 30)]
