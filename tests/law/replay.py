"""The bytes of replays, saves and commands, and the hash of the state: replays/FORMAT.md, and nothing else.

A layout is the name of an integer, ("opt", of), ("seq", of), ("vec", of), ("enum", {tag: (name, fields)}) or a list of
fields (name, layout), which is read into an object with these attributes.
"""

from types import SimpleNamespace as Row

from xxh3 import xxh3

REPLAY_VERSION, SAVE_VERSION, LAW = 3, 4, 9
SIZES = {"u8": 1, "bool": 1, "u32": 4, "u64": 8, "i64": 8, "u128": 16, "i128": 16}
WORLD, IDLE, TICK, TAIL, END, ANCILLARY = 0x01, 0x02, 0x03, 0x04, 0x0F, 0x80
M64 = (1 << 64) - 1

ID = [("index", "u32"), ("generation", "u32")]
CONFIG = [
    ("tick_rate", "u32"), ("substeps", "u32"), ("gravity", ("vec", "i64")), ("integrator", "u8"),
    ("unit_shift", "u32"), ("sleeping", ("opt", [("speed", "i64"), ("time", "i64")])),
]
BODY = [
    ("kind", "u8"), ("fixed_rotation", "bool"), ("mass", "i128"), ("inertia", "i128"), ("center", ("vec", "i64")),
    ("reach", "i64"), ("first", ("opt", "u32")), ("force", ("vec", "i128")), ("torque", "i128"),
    ("linear_damping", "i64"), ("angular_damping", "i64"), ("mu", "u128"), ("user_data", "u64"),
    ("allow_sleep", "bool"),
]
SHAPE = ("enum", {
    0: ("circle", [("radius", "i64")]),
    1: ("box", [("width", "i64"), ("height", "i64")]),
    2: ("polygon", [("vertices", ("seq", ("vec", "i64")))]),
})
FILTER = [("category", "u32"), ("mask", "u32")]
COLLIDER = [
    ("body", "u32"), ("next", ("opt", "u32")), ("form", "u32"), ("density", "i128"), ("restitution", "i64"),
    ("friction", "i64"), ("filter", FILTER), ("sensor", "bool"),
]
FORM = [("shape", SHAPE), ("offset", ("vec", "i64")), ("angle", "i64"), ("center", ("vec", "i64")), ("uses", "u32")]
ATTRACTOR = [("position", ("vec", "i64")), ("mu", "u128")]
PUSH = [("slot", "u32"), ("force", ("vec", "i128")), ("torque", "i128")]
CONTACT = [
    ("a", ID), ("b", ID), ("touching", "u8"), ("sensor", "u8"), ("count", "u8"), ("id0", "u8"), ("id1", "u8"),
    ("mode", "u8"), ("zero0", "u8"), ("zero1", "u8"), ("normal0", "i64"), ("normal1", "i64"), ("tangent", "i64"),
]
STATUS = [("tick", "u64"), ("body", ID), ("bound", "u8")]
COLUMNS = ("x", "y", "vx", "vy", "angle", "omega")


def arena(value):
    slot = [("generation", "u32"), ("link", "u32"), ("value", value)]
    return [("free", "u32"), ("live", "u32"), ("slots", ("seq", slot))]


STATE = [
    ("config", CONFIG), ("tick", "u64"), ("bodies", arena(BODY)), *((name, ("seq", "i64")) for name in COLUMNS),
    ("quiet", ("seq", "u32")), ("colliders", arena(COLLIDER)), ("forms", arena(FORM)), ("attractors", arena(ATTRACTOR)),
    ("pushes", ("seq", PUSH)), ("contacts", ("seq", CONTACT)), ("resting", ("seq", CONTACT)),
    ("status", ("seq", STATUS)),
]
COLLIDER_DEF = [
    ("shape", SHAPE), ("offset", ("vec", "i64")), ("angle", "i64"), ("density", "i128"), ("restitution", "i64"),
    ("friction", "i64"), ("filter", FILTER), ("sensor", "bool"),
]
BODY_DEF = [
    ("kind", "u8"), ("position", ("vec", "i64")), ("angle", "i64"), ("velocity", ("vec", "i64")),
    ("angular_velocity", "i64"), ("force", ("vec", "i128")), ("torque", "i128"), ("mass", ("opt", "i128")),
    ("inertia", ("opt", "i128")), ("center", ("opt", ("vec", "i64"))), ("fixed_rotation", "bool"),
    ("linear_damping", "i64"), ("angular_damping", "i64"), ("mu", "u128"), ("user_data", "u64"),
    ("allow_sleep", "bool"), ("colliders", ("seq", COLLIDER_DEF)),
]
COMMAND = ("enum", {
    0: ("create_body", [("definition", BODY_DEF)]),
    1: ("destroy_body", [("id", ID)]),
    2: ("set_kind", [("id", ID), ("kind", "u8")]),
    3: ("set_position", [("id", ID), ("position", ("vec", "i64"))]),
    4: ("set_angle", [("id", ID), ("angle", "i64")]),
    5: ("set_velocity", [("id", ID), ("velocity", ("vec", "i64"))]),
    6: ("set_angular_velocity", [("id", ID), ("omega", "i64")]),
    7: ("set_force", [("id", ID), ("force", ("vec", "i128"))]),
    8: ("set_torque", [("id", ID), ("torque", "i128")]),
    9: ("set_mass", [("id", ID), ("mass", "i128"), ("inertia", "i128")]),
    10: ("set_fixed_rotation", [("id", ID), ("fixed", "bool")]),
    11: ("set_damping", [("id", ID), ("linear", "i64"), ("angular", "i64")]),
    12: ("set_mu", [("id", ID), ("mu", "u128")]),
    13: ("set_user_data", [("id", ID), ("user_data", "u64")]),
    14: ("apply_force", [("id", ID), ("force", ("vec", "i128")), ("point", ("opt", ("vec", "i64")))]),
    15: ("apply_torque", [("id", ID), ("torque", "i128")]),
    16: ("apply_impulse", [("id", ID), ("impulse", ("vec", "i128")), ("point", ("opt", ("vec", "i64")))]),
    17: ("apply_angular_impulse", [("id", ID), ("impulse", "i128")]),
    18: ("create_attractor", [("attractor", ATTRACTOR)]),
    19: ("set_attractor", [("id", ID), ("attractor", ATTRACTOR)]),
    20: ("destroy_attractor", [("id", ID)]),
    21: ("set_gravity", [("gravity", ("vec", "i64"))]),
    22: ("clear_status", []),
    23: ("input", [("bytes", ("seq", "u8"))]),
    24: ("set_surface", [("id", ID), ("restitution", "i64"), ("friction", "i64")]),
    25: ("set_filter", [("id", ID), ("filter", FILTER)]),
    26: ("set_allow_sleep", [("id", ID), ("allow", "bool")]),
    27: ("wake", [("id", ID)]),
    28: ("put_to_sleep", [("id", ID)]),
})


class Bad(Exception):
    """Bytes that are no replay."""


def check(holds, what):
    if not holds:
        raise Bad(what)


class Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def bytes(self, count):
        check(self.at + count <= len(self.data), f"the bytes end at {len(self.data)}")
        self.at += count
        return self.data[self.at - count : self.at]

    def integer(self, name):
        return int.from_bytes(self.bytes(SIZES[name]), "little", signed=name[0] == "i")

    def read(self, layout):
        if isinstance(layout, str):
            return self.integer(layout)
        if isinstance(layout, list):
            return Row(**{name: self.read(of) for name, of in layout})
        what, of = layout
        if what == "opt":
            return self.read(of) if self.integer("bool") else None
        if what == "vec":
            return [self.read(of), self.read(of)]
        if what == "seq":
            return [self.read(of) for _ in range(self.integer("u32"))]
        tag = self.integer("u8")
        check(tag in of, f"tag {tag} before byte {self.at}")
        name, fields = of[tag]
        return Row(name=name, tag=tag, **vars(self.read(fields)))


def put(value, layout, out):
    if isinstance(layout, str):
        out += int(value).to_bytes(SIZES[layout], "little", signed=layout[0] == "i")
    elif isinstance(layout, list):
        for name, of in layout:
            put(getattr(value, name), of, out)
    elif layout[0] == "opt":
        put(value is not None, "bool", out)
        if value is not None:
            put(value, layout[1], out)
    elif layout[0] == "enum":
        put(value.tag, "u8", out)
        put(value, layout[1][value.tag][1], out)
    else:
        if layout[0] == "seq":
            put(len(value), "u32", out)
        for element in value:
            put(element, layout[1], out)


def written(value, layout):
    out = bytearray()
    put(value, layout, out)
    return bytes(out)


def blocks(data):
    """The hash of what may be long: in blocks of 256 bytes, each seeded with the hash of those before."""
    seed = 0
    for at in range(256, len(data), 256):
        seed = xxh3(data[at - 256 : at], seed)
    return xxh3(data[(max(len(data), 1) - 1) // 256 * 256 :], seed)


def words(values):
    return b"".join(value.to_bytes(8, "little") for value in values)


def elements(values, layout):
    return b"".join(written(value, layout) for value in values)


def arena_hash(slots, layout):
    """Kept with the slots until a command changes them, which forgets it."""
    if not hasattr(slots, "hash"):
        slot = dict(layout)["slots"][1]
        digest = sum(blocks(words([at]) + written(one, slot)) for at, one in enumerate(slots.slots)) & M64
        head = words([len(slots.slots)]) + written(slots, layout[:2]) + words([digest])
        slots.hash = blocks(head)
    return slots.hash


def hash_parts(state):
    columns = [xxh3(elements(getattr(state, name), "i64")) for name in COLUMNS]
    forms = [arena_hash(state.colliders, arena(COLLIDER)), arena_hash(state.forms, arena(FORM))]
    sleep = [xxh3(elements(state.quiet, "u32")), xxh3(elements(state.resting, CONTACT))]
    return {
        "configuration": blocks(written(state, STATE[:2])),
        "bodies": arena_hash(state.bodies, arena(BODY)),
        "motion": blocks(words(columns)),
        "colliders": blocks(words(forms)),
        "attractors": arena_hash(state.attractors, arena(ATTRACTOR)),
        "forces": blocks(written(state.pushes, ("seq", PUSH))),
        "contacts": xxh3(elements(state.contacts, CONTACT)),
        "sleep": blocks(words(sleep)),
        "status": blocks(written(state.status, ("seq", STATUS))),
    }


def state_hash(state):
    return blocks(words(hash_parts(state).values()))


def load(data):
    """A save's state."""
    reader = Reader(data)
    check(reader.bytes(8) == b"TAMIAS-W", "no save")
    check(reader.integer("u32") == SAVE_VERSION, "a save of another version")
    check(reader.integer("u32") == LAW, "a save of another law")
    state = reader.read(STATE)
    saved = reader.integer("u64")
    check(reader.at == len(data), "bytes after the save")
    check(state_hash(state) == saved, f"the initial world's hash is not the saved one: {hash_parts(state)}")
    return state


def save(state):
    head = b"TAMIAS-W" + written(SAVE_VERSION, "u32") + written(LAW, "u32")
    return head + written(state, STATE) + words([state_hash(state)])


def commands(reader):
    found = []
    while reader.at < len(reader.data):
        found.append(reader.read(COMMAND))
    return found


def play(data):
    """Yields the initial state, then for each tick (recorded hash, commands before it, whether it steps)."""
    reader = Reader(data)
    head = reader.bytes(24)
    check(head[:8] == b"TAMIAS-R", "no replay")
    version, law = (int.from_bytes(head[at : at + 4], "little") for at in (8, 12))
    check((version, law) == (REPLAY_VERSION, LAW), f"version {version}, law {law}: here {REPLAY_VERSION}, {LAW}")
    chain = reader.integer("u64")
    check(chain == xxh3(head), "the header's hash does not fit it")
    ticks, started = 0, False
    while True:
        start = reader.at
        tag = reader.integer("u8")
        if tag == END:
            break
        length = 8 if tag == IDLE else reader.integer("u32")
        payload = Reader(reader.bytes(length))
        chain = xxh3(data[start : reader.at], chain)
        if tag != IDLE:
            check(reader.integer("u32") == chain & 0xFFFFFFFF, f"the check of the record at byte {start} does not fit it")
        if tag >= ANCILLARY:
            continue
        check(tag in (WORLD, IDLE, TICK, TAIL) and (tag == WORLD) != started, f"record {tag:#x} at byte {start}")
        started = True
        if tag == WORLD:
            yield load(payload.data)
            continue
        ticks += tag != TAIL
        recorded = payload.integer("u64")
        yield recorded, commands(payload), tag != TAIL
    check(reader.integer("u64") == ticks, "the end counts other ticks")
    reader.integer("u64")  # Where the index is.
    chain = xxh3(data[start : reader.at], chain)
    check(reader.integer("u64") == chain and reader.at == len(data), "the end's chain is not that of the records")
