"""Bodies that are pressed into each other: by rows they get no faster than they, or what they touch, would have been
without, or than overlaps are pushed apart."""

from ints import clamp, div, hypot, round_shift, sat64

RECOVERY = 1 << 48
BOUND = 1 << 60


def find(held, movers):
    """Before the substeps: who is squeezed, and how fast each of them may be."""
    for pair in held:
        for place in pair.places:
            if pair.squeezes and not movers.is_free(place):
                movers.list[place].most = RECOVERY
    for pair in held:
        both = [movers.list[place] for place in pair.places]
        fastest = max(speed(movers, place) for place in pair.places)
        for mover in both:
            if mover.most:
                mover.most = max(mover.most, fastest)


def speed(movers, place):
    """How fast a body, or its rim, would be at the end of the tick if nothing touched it."""
    if place == 0:
        return 0
    mover = movers.list[place]
    gain = movers.world.drive.gain(mover.slot)
    line = [mover.v[axis] + round_shift(gain[axis], movers.scales.shift) for axis in (0, 1)]
    return max(length(line), abs(scaled(mover.v[2], mover.mobility.reach, mover.mobility.sigma)))


def length(v):
    return sat64(hypot(v[0], v[1]))


def scaled(value, a, b):
    return sat64(div(value * a, max(b, 1)))


def allow(mover, change, seen):
    """An impact changed its velocities."""
    if mover.most:
        seen["struck while squeezed"] += 1
        mover.most = sat64(mover.most + max(length(change), sat64(8 * abs(change[2]))))


def hold(movers):
    """Slows down what rows have made too fast; what they do in a substep stays as it is."""
    for mover in movers.list:
        if not mover.most:
            continue
        fast, (x, y, w) = length(mover.v), mover.v
        if fast > mover.most:
            x, y = (scaled(c, mover.most, fast) for c in (x, y))
        spin = scaled(mover.most, mover.mobility.sigma, mover.mobility.reach)
        kept = [x, y, clamp(w, -spin, spin)]
        movers.world.seen["held back"] += kept != mover.v
        mover.begin = [clamp(b + c - v, -BOUND, BOUND) for b, c, v in zip(mover.begin, kept, mover.v)]
        mover.v = kept
