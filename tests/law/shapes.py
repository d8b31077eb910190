"""Outlines of forms, their places in the world, and their masses."""

from types import SimpleNamespace as Row

from ints import I128, clamp, div, hypot, mul_div, round_shift, sat64, sat128, sin_cos

PI_Q120 = 4_175_892_906_503_776_358_826_876_457_663_557_747
ONE_Q92 = 1 << 92
UNIT = 1 << 30


def canonical(shape):
    """A polygon's vertices counter-clockwise, from the same first one."""
    if shape.name == "polygon":
        first, *rest = vertices = shape.vertices
        arms = [[v[0] - first[0], v[1] - first[1]] for v in vertices]
        if sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(arms, arms[1:])) < 0:
            return Row(name=shape.name, tag=shape.tag, vertices=[first, *reversed(rest)])
    return shape


def turn(v, rot):
    (x, y), (cos, sin) = v, rot
    return [sat64(round_shift(x * cos - y * sin, 30)), sat64(round_shift(x * sin + y * cos, 30))]


def turn_unit(v, rot):
    return [clamp(c, -UNIT, UNIT) for c in turn(v, rot)]


def normal(edge):
    """The unit vector to the right of an edge, Q30."""
    greatest = max(abs(edge[0]), abs(edge[1]))
    scale = clamp(61 - greatest.bit_length(), 0, 60)
    dx, dy = edge[0] << scale, edge[1] << scale
    length = hypot(dx, dy)
    return [clamp(div(c << 30, length), -UNIT, UNIT) for c in (dy, -dx)]


def outline(shape, offset, angle, center):
    """In the body's axes about its centre of mass."""
    shape, radius = canonical(shape), 0
    if shape.name == "circle":
        corners, radius = [[0, 0]], shape.radius
    elif shape.name == "box":
        x, y = round_shift(shape.width, 1), round_shift(shape.height, 1)
        corners = [[-x, -y], [x, -y], [x, y], [-x, y]]
    else:
        corners = shape.vertices
    rot, vertices, normals, reach = sin_cos(angle), [], [], 0
    for at, corner in enumerate(corners):
        turned = turn(corner, rot)
        vertex = [turned[axis] - center[axis] + offset[axis] for axis in (0, 1)]
        vertices.append(vertex)
        distance = hypot(*vertex)
        reach = max(reach, distance + ((distance >> 29) + 2 if distance else 0) + radius)
        following = corners[(at + 1) % len(corners)]
        if len(corners) > 1:
            normals.append(turn_unit(normal([following[axis] - corner[axis] for axis in (0, 1)]), rot))
    return Row(vertices=vertices, normals=normals, radius=radius, reach=reach, count=len(vertices))


def placed(of, angle):
    """An outline turned into the world's axes, about its body's centre of mass, with the box around it."""
    rot = sin_cos(angle)
    vertices = [turn(v, rot) for v in of.vertices]
    low, high = ([pick(v[axis] for v in vertices) for axis in (0, 1)] for pick in (min, max))
    return Row(
        vertices=vertices, normals=[turn_unit(n, rot) for n in of.normals], radius=of.radius, count=of.count,
        min=[c - of.radius for c in low], max=[c + of.radius for c in high],
    )


def polygon_mass(vertices):
    """Area Q92, centre Q64, squared radius of gyration Q92: by the triangles of vertex 0 and each edge."""
    first = vertices[0]
    arms = [[v[0] - first[0], v[1] - first[1]] for v in vertices]
    triangles = [(a, b, a[0] * b[1] - a[1] * b[0]) for a, b in zip(arms, arms[1:])]
    total = sum(c for _, _, c in triangles)
    center = [sum(mul_div(c, a[axis] + b[axis] << 32, 3 * total) for a, b, c in triangles) for axis in (0, 1)]
    about = 0
    for a, b, c in triangles:
        squares = sum(p[0] * q[0] + p[1] * q[1] for p, q in ((a, a), (a, b), (b, b)))
        about += mul_div(c, squares << 28, 6 * total)
    moved = sum(mul_div(g, g, 1 << 36) for g in center)
    return abs(total) << 27, [center[axis] + (first[axis] << 32) for axis in (0, 1)], about - moved


def form_mass(shape):
    if shape.name == "circle":
        square = shape.radius * shape.radius
        return mul_div(square, PI_Q120, ONE_Q92), [0, 0], square << 27
    if shape.name == "box":
        w, h = shape.width, shape.height
        return w * h << 28, [0, 0], div(w * w + h * h << 28, 12)
    return polygon_mass(shape.vertices)


def part(collider, up):
    """Mass Q64, centre Q64 and squared radius of gyration Q92 of a collider, its density times 2^up."""
    area, (x, y), gyration = form_mass(collider.shape)
    cos, sin = sin_cos(collider.angle)
    center = [
        round_shift(x * cos - y * sin, 30) + (collider.offset[0] << 32),
        round_shift(x * sin + y * cos, 30) + (collider.offset[1] << 32),
    ]
    return mul_div(collider.density << up, area, ONE_Q92), center, gyration


def carried(mass, arm):
    """mass·|arm|², Q64."""
    return sat128(sum(mul_div(mul_div(mass, d, 1 << 64), d, 1 << 64) for d in arm))


def mass_of(colliders, up=0):
    """(mass, centre Q32, inertia about it) of the colliders that are not sensors."""
    parts = [part(c, up) for c in colliders if not c.sensor]
    mass = min(sum(m for m, _, _ in parts), I128)
    center = [0, 0]
    if mass:
        center = [sat64(round_shift(sum(mul_div(m, c[axis], mass) for m, c, _ in parts), 32)) for axis in (0, 1)]
    inertia = 0
    for m, c, gyration in parts:
        arm = [c[axis] - (center[axis] << 32) for axis in (0, 1)]
        inertia = sat128(sat128(inertia + mul_div(m, gyration, ONE_Q92)) + carried(m, arm))
    return mass, center, inertia


def resolved(definition):
    """Mass, inertia and centre of mass of a body: what is given, and the rest from its colliders."""
    colliders = definition.colliders
    solid, middle, _ = mass_of(colliders)
    mass = definition.mass if definition.mass is not None else solid if solid > 0 else 1 << 64
    center = definition.center
    if center is None:
        center = [0, 0] if definition.mass is not None and definition.inertia is not None else middle
    inertia = definition.inertia
    if inertia is None and solid > 0:
        # With densities made greater by a power of two, so that a small body keeps its digits.
        densest = max(c.density for c in colliders)
        up = min(max(90 - solid.bit_length(), 0), max(126 - densest.bit_length(), 0))
        more, middle, own = mass_of(colliders, up)
        arm = [center[axis] - middle[axis] << 32 for axis in (0, 1)]
        inertia = mul_div(sat128(own + carried(more, arm)), mass, more)
    elif inertia is None:
        inertia = mass
    return mass, inertia, center


def reach_of(colliders, center):
    return max((outline(c.shape, c.offset, c.angle, center).reach for c in colliders if not c.sensor), default=0)
