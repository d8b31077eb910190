"""Where two outlines touch: a normal and at most two points.

Vectors are pairs of Q32 m, normals of Q30. `d` leads from a's centre to b's.
"""

from types import SimpleNamespace as Row

from ints import div, mul, quotient, sqrt

START = [sqrt((1 << 127) // (2 * index + 33) * 16) for index in range(112)]


def along(n, v):
    """n·v, Q38, rounded down."""
    return n[0] * v[0] + n[1] * v[1] >> 24


def rounded(value):
    """Q38 to Q32, to nearest, ties up."""
    return value + 32 >> 6


def add(a, b):
    return [a[0] + b[0], a[1] + b[1]]


def sub(a, b):
    return [a[0] - b[0], a[1] - b[1]]


def neg(v):
    return [-v[0], -v[1]]


def inner(a, b):
    return a[0] * b[0] + a[1] * b[1]


def scaled(n, by):
    """n·by/2, for a `by` that is twice the length."""
    return [mul(n[0], by, 31), mul(n[1], by, 31)]


def unit(v):
    """The direction of v and its length, or none: two rounds for 1/√a from a table."""
    if v == [0, 0]:
        return None
    up = 62 - max(abs(v[0]), abs(v[1])).bit_length()
    x, y = abs(v[0]) << up, abs(v[1]) << up
    a = x * x + y * y >> 61
    root = START[min(max((a >> 57) - 16, 0), 111)]
    for _ in range(2):
        error = (1 << 59) - (a * (root * root >> 64) >> 64)
        short = error >> 28
        root += root * ((error >> 1) + ((short * short >> 3) * 3 >> 3)) >> 59
    parts = [(c * root >> 64) + (1 << 29) >> 30 for c in (x, y)]
    long = a * root >> 63
    length = (long >> up) + (long >> up - 1 & 1 if up else 0)
    return [-part if c < 0 else part for part, c in zip(parts, v)], length


def region(polygon, p, start):
    """The edge or the vertex of a polygon that a point outside is nearest to, walking from an edge."""
    vertices, count = polygon.vertices, polygon.count

    def ahead(edge, vertex):
        return inner(sub(p, vertices[vertex]), sub(vertices[(edge + 1) % count], vertices[edge]))

    edge = start
    for _ in range(count):
        to = (edge + 1) % count
        if ahead(edge, to) <= 0:
            break
        if ahead(to, to) < 0:
            return "vertex", to
        edge = to
    for _ in range(count):
        if ahead(edge, edge) >= 0:
            break
        before = (edge - 1) % count
        if ahead(before, edge) > 0:
            return "vertex", edge
        edge = before
    return "edge", edge


def point(arm, separation, id=0):
    return Row(arm=arm, separation=separation, id=id)


def polygon_circle(polygon, circle, shift, limit):
    """The normal from the polygon to the circle, and the point from the polygon's centre."""
    reach = limit + circle.radius
    center = add(circle.vertices[0], shift)
    outside = [rounded(along(n, sub(center, v))) for n, v in zip(polygon.normals, polygon.vertices)]
    distance = max(outside)
    if distance > reach:
        return None
    face = outside.index(distance)
    normal = polygon.normals[face]
    if distance > 0:
        what, at = region(polygon, center, face)
        if what == "edge":
            normal, distance = polygon.normals[at], outside[at]
        else:
            found = unit(sub(center, polygon.vertices[at]))
            if found is None:
                return None
            normal, distance = found
    if distance > reach:
        return None
    separation = distance - circle.radius
    return normal, point(sub(center, scaled(normal, 2 * circle.radius + separation)), separation)


def circle_circle(a, b, d, limit):
    start, end = a.vertices[0], add(b.vertices[0], d)
    radii = a.radius + b.radius
    centers = sub(end, start)
    if inner(centers, centers) > (radii + limit + 1) ** 2:
        return None
    normal, distance = unit(centers) or ([0, -(1 << 30)], 0)
    separation = distance - radii
    both = [quotient(c + (c > 0) - (c < 0), 2) for c in add(start, end)]
    if separation > limit:
        return None
    return normal, point(add(both, scaled(normal, a.radius - b.radius)), separation)


class View:
    """Two polygons as one of them sees them, from its own centre."""

    def __init__(self, own, other, shift):
        self.own, self.other, self.shift = own, other, shift

    def separation(self, edge):
        """How far the other is outside an edge, and its nearest vertex (ties: lower index)."""
        normal = self.own.normals[edge]
        heights = [along(normal, v) for v in self.other.vertices]
        least = min(heights)
        return rounded(least + along(normal, sub(self.shift, self.own.vertices[edge]))), heights.index(least)

    def greatest(self, limit):
        """(separation, edge, nearest vertex) of the greatest (ties: lower edge); none if it is beyond the limit."""
        found = [(*self.separation(edge), edge) for edge in range(self.own.count)]
        separation = max(s for s, _, _ in found)
        if separation > limit:
            return None
        return next((s, edge, nearest) for s, nearest, edge in found if s == separation)

    def clip(self, separation, edge, nearest, alone):
        """The edge that faces `edge`, clipped to it: which edge that is, the two ends, and which of them there are."""
        own, other = self.own, self.other
        normal = own.normals[edge]
        before = (nearest - 1) % other.count
        incident = before if inner(normal, other.normals[before]) < inner(normal, other.normals[nearest]) else nearest
        # From the reference edge's first vertex; the incident edge runs against it.
        origin = own.vertices[edge]
        base = sub(self.shift, origin)
        corners = [[0, 0], sub(own.vertices[(edge + 1) % own.count], origin)]
        vertices = [add(other.vertices[at], base) for at in ((incident + 1) % other.count, incident)]
        side = int(incident == nearest)
        tangent = [-normal[1], normal[0]]
        width = rounded(along(tangent, corners[1]))
        at = [rounded(along(tangent, v)) for v in vertices]
        gaps = [rounded(along(normal, v)) for v in vertices]
        if at[0] >= at[1]:
            at, gaps = [at[side]] * 2, [gaps[side]] * 2
        overlap = [max(at[0], 0), min(at[1], width)]
        if overlap[0] < overlap[1]:
            found = [True, True]
        elif overlap[0] == overlap[1]:
            found = [(end == side) == (at[side] == overlap[0]) for end in (0, 1)]
        else:
            found = [False, False]
        if alone:
            overlap = [at[side]] * 2
            gaps[side] = separation
            found = [side == 0, side == 1]
        ends = []
        for end in (0, 1):
            apart = between(gaps[0], gaps[1], overlap[end] - at[0], at[1] - at[0])
            back = overlap[end] == at[end]
            start = vertices[end] if back else corners[end]
            ends.append((add(add(start, origin), scaled(normal, -apart if back else apart)), apart))
        return incident, ends, found


def between(a, b, part, whole):
    """a + (b − a)·part/whole."""
    return a + (div((b - a) * part, whole) if whole else 0)


def clipped(views, owner, edge, clip, d, limit):
    """The points of a clip within the limit."""
    incident, ends, found = clip
    first, second = (edge, incident) if owner == 0 else (incident, edge)
    pair = first << 4 | second << 1
    points = []
    for bit in (0, 1):
        arm, separation = ends[bit ^ owner]
        if found[bit ^ owner] and separation <= limit:
            points.append(point(add(arm, d) if owner else arm, separation, pair | bit))
    normal = views[owner].own.normals[edge]
    return manifold(normal if owner else neg(normal), points)


def manifold(normal, points):
    return Row(normal=normal if points else [0, 0], points=points)


def polygons(a, b, d, limit):
    views = [View(a, b, d), View(b, a, neg(d))]
    best = [view.greatest(limit) for view in views]
    if None in best:
        return None
    owner = int(best[1][0] > best[0][0])
    separation, edge, nearest = best[owner]
    clip = views[owner].clip(separation, edge, nearest, False)
    found = clipped(views, owner, edge, clip, d, limit)
    if found.points:
        return found
    # Where the best edge has no point: another as good up to rounding, if nothing is over this one.
    extent = max(p.max[axis] - p.min[axis] for p in (a, b) for axis in (0, 1))
    tolerance = (extent >> 28) + 4
    if clip[2] == [False, False]:
        for at in (0, 1):
            for other in range(views[at].own.count):
                apart, closest = views[at].separation(other)
                if apart >= separation - tolerance:
                    beside = clipped(views, at, other, views[at].clip(apart, other, closest, False), d, limit)
                    if beside.points:
                        return beside
    if separation > 0:
        return manifold([0, 0], [])
    return clipped(views, owner, edge, views[owner].clip(separation, edge, nearest, True), d, limit)


def near(a, b, d, limit):
    """The manifold with the points within the limit; none where an axis separates the outlines by more."""
    if a.count == 1 and b.count == 1:
        found = circle_circle(a, b, d, limit)
        return found and manifold(neg(found[0]), [found[1]])
    for axis in (0, 1):
        if b.min[axis] + d[axis] - a.max[axis] > limit or a.min[axis] - d[axis] - b.max[axis] > limit:
            return None
    if b.count == 1:
        found = polygon_circle(a, b, d, limit)
        return found and manifold(neg(found[0]), [found[1]])
    if a.count == 1:
        found = polygon_circle(b, a, neg(d), limit)
        if found:
            found[1].arm = add(found[1].arm, d)
        return found and manifold(found[0], [found[1]])
    return polygons(a, b, d, limit)


def collide(a, b, d, limit):
    return near(a, b, d, limit) or manifold([0, 0], [])


def overlap(a, b, d):
    """Whether two outlines have a point in common: less than 2^-38 m apart is touching."""
    for axis in (0, 1):
        if b.min[axis] + d[axis] > a.max[axis] or a.min[axis] - d[axis] > b.max[axis]:
            return False
    if a.count > 1 and b.count > 1:
        return not separated(a, b, d) and not separated(b, a, neg(d))
    if a.count > 1:
        return within(a, add(b.vertices[0], d), b.radius)
    if b.count > 1:
        return within(b, sub(a.vertices[0], d), a.radius)
    centers = sub(add(b.vertices[0], d), a.vertices[0])
    return inner(centers, centers) <= (a.radius + b.radius) ** 2


def separated(own, other, shift):
    """Whether the other is wholly outside one of the edges."""
    return any(
        all(along(n, add(q, sub(shift, v))) > 0 for q in other.vertices) for n, v in zip(own.normals, own.vertices)
    )


def within(polygon, p, radius):
    """Whether a point is at most so far from a polygon."""
    outside = [along(n, sub(p, v)) for n, v in zip(polygon.normals, polygon.vertices)]
    if max(outside) <= 0:
        return True
    what, at = region(polygon, p, outside.index(max(outside)))
    if what == "edge":
        return outside[at] <= radius << 6
    way = sub(p, polygon.vertices[at])
    return inner(way, way) <= radius * radius
