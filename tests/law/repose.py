"""Repose: islands that a tick leaves as they are."""

from pairs import lasts, outcome

LEAST = 16


def settle(world, pairs, movers, faults, ends):
    """Finds the islands that end the tick as they began it, and leaves them so; of these, faults from `ends` on are none."""
    state, past, moving = world.state, movers.past, {}
    for place, mover in enumerate(movers.list):
        if place and not movers.is_free(place) and not world.is_asleep(mover.slot):
            began, slot = past[mover.slot], mover.slot
            stays = pose(state, slot) == [*began.x, began.angle]
            if mover.hit:
                stays = all(abs(way) <= LEAST * movers.scales.substeps for way in mover.sum)
            moving[place] = stays and all(abs(v) <= LEAST << 28 for v in mover.v)
    up = {place for place, calm in moving.items() if not calm}
    # What is beside each other, and what contacts press together.
    edges, presses, held = {}, {}, set()
    for pair in pairs:
        if pair.sensor:
            continue
        places = [movers.place_of(slot) for slot in pair.bodies]
        own = [place for place in places if place in moving]
        moved = any(
            place and place not in moving and any([*past[slot].v, past[slot].omega])
            for place, slot in zip(places, pair.bodies)
        )
        if pair.met or pair.contact and moved or not same(pair):
            up |= set(own)
        pushed = pair.contact and pair.contact.spent()
        if len(own) == 1 and not moved and pushed:
            held |= set(own)
        if pair.contact and len(own) == 2:
            for table in (edges, presses) if pushed else (edges,):
                table.setdefault(own[0], []).append(own[1])
                table.setdefault(own[1], []).append(own[0])
    spread(held, presses)
    # What nothing holds goes on.
    up |= {place for place in moving if place not in held and goes(state, past, movers.list[place].slot)}
    spread(up, edges)
    calm = {movers.list[place].slot for place in moving if place not in up}
    for slot in calm:
        world.seen["in repose"] += any((state.vx[slot], state.vy[slot], state.omega[slot]))
        (state.x[slot], state.y[slot]), state.angle[slot] = past[slot].x, past[slot].angle
        state.vx[slot] = state.vy[slot] = state.omega[slot] = 0
    for mover in movers.list[1:]:
        if mover.slot in calm:
            mover.d[:] = [0, 0, 0]
    faults[ends:] = [fault for fault in faults[ends:] if fault[0] not in calm]
    for pair in pairs:
        pair.stays = bool(not pair.sensor and pair.contact and calm & set(pair.bodies))


def pose(state, slot):
    return [state.x[slot], state.y[slot], state.angle[slot]]


def goes(state, past, slot):
    """Whether a body is not where it was, or has a velocity that it had not."""
    began, velocity = past[slot], [state.vx[slot], state.vy[slot], state.omega[slot]]
    faster = any(velocity) and velocity != [*began.v, began.omega]
    return faster or pose(state, slot) != [*began.x, began.angle]


def spread(places, edges):
    """Adds what hangs together with them."""
    open_ = list(places)
    while open_:
        for other in edges.get(open_.pop(), []):
            if other not in places:
                places.add(other)
                open_.append(other)


def same(pair):
    """Whether a contact is what it was but for its impulses."""
    found, last = outcome(pair), pair.known and pair.known.record
    # None is like one that does not touch and was swept.
    before = (bool(last.touching), last.mode) if last else (False, 0)
    return bool(lasts(found)) == bool(last) and (bool(found.touching), found.mode) == before
