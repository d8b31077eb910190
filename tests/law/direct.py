"""Hard islands: all normals and all friction that holds as one system of equations, by projected Newton steps."""

from envelope import ROWS, Envelope
from ints import clamp, div, quotient, round_shift
from rows import HELD, IMPULSE_MAX, SLOP, limit

MOST = 80
ROUNDS, HALVINGS, HOLDS, SWEEPS = 8, 12, 4, 4
STILL, CUT = 16, 1 << 18
PATIENCE, GIVEN_UP = 30, 255
SHARE, LABOUR, STEP = 12_000_000, 1_000_000, 128
RATIO, YIELD = 16, 10
EASE = (13, YIELD, YIELD)
FAR_UP = 0xFFFFFFFF


def find(votes, held, movers):
    """The hard islands: (contacts from what does not move on, the highest level)."""
    leader = list(range(len(movers.list)))

    def of(place):
        while leader[place] != place:
            place = leader[place]
        return place

    for pair in held:
        a, b = pair.places
        if not movers.is_free(a) and not movers.is_free(b):
            leader[max(of(a), of(b))] = min(of(a), of(b))
    islands = {}
    for at, (pair, said) in enumerate(zip(held, votes)):
        moving = [place for place in pair.places if not movers.is_free(place)]
        if moving:
            islands.setdefault(of(moving[0]), []).append((at, pair, said))
    found = []
    for members in islands.values():
        said = [vote for _, _, vote in members]
        if "hard" in said and "sweep" not in said and len(members) <= MOST:
            found.append(by_levels([(at, pair) for at, pair, _ in members], movers))
    return found


def by_levels(members, movers):
    """Contacts by how many lie between their bodies and what does not move."""
    level = {}
    of = lambda place: 0 if movers.is_free(place) else level.get(place, FAR_UP)
    if not any(movers.is_free(place) for _, pair in members for place in pair.places):
        level[members[0][1].places[0]] = 1
    changed = True
    while changed:
        changed = False
        for _, pair in members:
            a, b = pair.places
            over = [of(b) + 1, of(a) + 1]
            for place, up in zip((a, b), over):
                if up < of(place):
                    level[place], changed = up, True
    levels = lambda pair: sorted(of(place) for place in pair.places)
    members = sorted(members, key=lambda member: (*levels(member[1])[::-1], member[0]))
    return [pair for _, pair in members], levels(members[-1][1])[1]


class Joined:
    """A contact in an island. Its rows: friction, and its points."""

    def __init__(self, rows):
        self.rows = rows
        self.places = list(rows.places)
        self.present = [any(rows.limit), True, rows.points[1].line > 0]
        self.active, self.number = [False] * 3, [None] * 3
        nx, ny = rows.normal
        along = ([-ny, nx], [nx, ny], [nx, ny])
        # Direction and arms of each row, Q28.
        self.jacobian = list(zip(along, (row.arm for row in self.lines())))

    def lines(self):
        return [self.rows.friction, *self.rows.points]

    def impulse(self, row):
        return self.lines()[row].impulse

    def limits(self, row):
        return (-self.hold, self.hold) if row == 0 else (0, IMPULSE_MAX)

    def equations(self):
        return [row for row in range(3) if self.active[row]]


class Island:
    def __init__(self, members, depth, movers, scales):
        self.movers, self.scales = movers, scales
        self.push, self.mode = quotient(scales.push, depth), max([pair.mode for pair in members] + [1])
        self.pushes = self.tired = self.over = False
        self.work, self.factored, self.contacts = 0, None, []
        self.bodies = {}
        for place in (place for pair in members for place in pair.places):
            if not movers.is_free(place) and place not in self.bodies:
                mobility = movers.list[place].mobility
                self.bodies[place] = [div(1 << 82, mobility.mantissa), mobility.exponent, mobility.tau]
        least = min(shift for _, shift, _ in self.bodies.values())
        for weight in self.bodies.values():
            weight[1] -= least
        for pair in members:
            joined = Joined(pair.contact)
            joined.shift = []
            for row in range(3):
                k = sum(self.coupled(joined, row, body, joined, row, body, 0) for body in (0, 1))
                joined.shift.append(max(max(k, 1).bit_length() - 1 - 58, 0) >> 1)
            self.couple(joined)
            self.contacts.append(joined)
        lowest = min(j.shift[row] for j in self.contacts for row in range(3) if j.present[row])
        for joined in self.contacts:
            joined.shift = [max(shift - lowest, 0) for shift in joined.shift]
            self.tired |= any(joined.present[row] and joined.shift[row] > RATIO for row in range(3))

    def coupled(self, a, i, body, b, j, other, shift):
        """J_i·M⁻¹·J_jᵀ of a body that two rows share, over 2^shift."""
        weight = self.bodies.get(a.places[body])
        if weight is None or a.places[body] != b.places[other]:
            return 0
        (p, arm), (q, lever) = a.jacobian[i], b.jacobian[j]
        around = round_shift(arm[body] * lever[other] * weight[2], 28)
        return round_shift((around + p[0] * q[0] + p[1] * q[1]) * weight[0], weight[1] + shift)

    def entries(self, a, b):
        found = [[0] * 3 for _ in range(3)]
        for i in range(3):
            for j in range(3):
                shift = a.shift[i] + b.shift[j]
                for body in (0, 1):
                    for other in (0, 1):
                        sign = 1 if body == other else -1
                        found[i][j] += sign * self.coupled(a, i, body, b, j, other, shift)
        return found

    def couple(self, joined):
        """With those before it, and with itself."""
        joined.couplings = [
            (earlier, self.entries(joined, earlier)) for earlier in self.contacts
            if any(place in self.bodies and place in earlier.places for place in joined.places)
        ]
        own = self.entries(joined, joined)
        joined.couplings.append((joined, own))
        joined.diagonal = [own[row][row] for row in range(3)]
        joined.inverse = [div(1 << 88, diagonal) for diagonal in joined.diagonal]

    def outcome(self):
        """How its contacts were solved, for the next tick."""
        if self.work > LABOUR:
            return GIVEN_UP if self.mode >= PATIENCE else self.mode + 1
        return 1

    # A pass.

    def run(self, biased):
        if not biased and not self.pushes:
            return
        if self.tired or not self.solve(biased):
            self.pushes = True
            for _ in range(SWEEPS):
                for joined in self.contacts:
                    joined.rows.once(biased, True, self.movers.list, self.scales)

    def solve(self, biased):
        """Whether all stayed in its range; all is as before if not."""
        self.pushes &= not biased
        self.over = False
        before = {place: list(self.movers.list[place].v) for place in self.bodies}
        for joined in self.contacts:
            joined.before = [joined.impulse(row) for row in range(3)]
            joined.hold = joined.rows.hold(joined.before[1:])
        self.look(biased)
        for again in range(HOLDS - 1, -1, -1):
            if not self.rounds(biased) or self.over:
                break
            cut, most = self.hold()
            if cut <= CUT or (again == 0 and cut <= most >> 3):
                return True
            self.look(biased)
        for place, v in before.items():
            self.movers.list[place].v = v
        for joined in self.contacts:
            for line, impulse in zip(joined.lines(), joined.before):
                line.impulse = impulse
        self.tired = True
        return False

    def rounds(self, biased):
        """Newton steps with the limits that friction has; false if there is no solution in range."""
        whole = False
        for _ in range(ROUNDS):
            if not self.choose() and whole:
                break
            if not self.direct():
                return False
            leads = False
            for shorter in range(HALVINGS):
                whole = self.step(shorter)
                self.look(biased)
                leads = whole or not self.rises()
                if leads:
                    break
            if not leads:
                self.step(63)
                break
        return True

    def look(self, biased):
        """What the rows lack."""
        scales = self.scales
        for joined in self.contacts:
            slip, speeds, separations = joined.rows.look(self.movers.list)
            joined.lack = [limit(round_shift(slip, 28))]
            for at, (speed, separation) in enumerate(zip(speeds, separations)):
                bears, gap = joined.impulse(at + 1), separation > 0
                bias = 0
                if gap:
                    bias = separation * scales.close_rate >> 20
                elif biased:
                    bias = max(min(separation + SLOP, 0) * scales.rigid_rate >> 20, self.push)
                yields = round_shift(bears, YIELD) if biased else 0
                joined.lack.append(limit(round_shift(speed, 28) + bias) + yields)
                self.pushes |= biased and bears > 0 and not gap

    def choose(self):
        """Which rows are equations. Whether they are others than before."""
        changed = False
        for joined in self.contacts:
            joined.lacked = list(joined.lack)
            joined.start = [joined.impulse(row) for row in range(3)]
            active = []
            for row in range(3):
                least, most = joined.limits(row)
                up = joined.start[row] > least or joined.lack[row] < -STILL
                down = joined.start[row] < most or joined.lack[row] > STILL
                # An impact may have taken the contact.
                present = joined.present[row] and not joined.rows.is_out()
                active.append(bool(present and least < most and up and down))
            changed |= active != joined.active
            joined.active = active
        if changed:
            self.renumber()
        return changed

    def renumber(self):
        count, self.factored = 0, None
        for joined in self.contacts:
            joined.number = [None] * 3
            for row in joined.equations():
                joined.number[row] = count
                count += 1

    def direct(self):
        """Solves the equations, without rows at a limit that a step would push beyond it."""
        while True:
            if not self.factor():
                return False
            every = [(joined, row) for joined in self.contacts for row in joined.equations()]
            lacks = [round_shift(-joined.lack[row] << 24, joined.shift[row]) for joined, row in every]
            self.solution = self.factored.solve(lacks)
            if self.solution is None:
                return False
            beyond = False
            for joined in self.contacts:
                for row in joined.equations():
                    least, most = joined.limits(row)
                    x = self.solution[joined.number[row]]
                    if (joined.start[row] <= least and x < 0) or (joined.start[row] >= most and x > 0):
                        joined.active[row], beyond = False, True
            if not beyond:
                return True
            self.renumber()

    def factor(self):
        if self.factored is not None:
            return True
        rows = []
        for joined in self.contacts:
            first = min((at for other, _ in joined.couplings for at in other.number if at is not None), default=0)
            for row in joined.equations():
                own = joined.number[row]
                start, diagonal = min(first, own), joined.diagonal[row]
                entries = [0] * (own - start)
                for other, coupling in joined.couplings:
                    for column, at in enumerate(other.number):
                        if at is not None and at < own:
                            entries[at - start] = coupling[row][column]
                rows.append((start, entries, diagonal + (diagonal >> EASE[row])))
        if len(rows) > ROWS:
            return False
        envelope = Envelope(rows)
        self.work += envelope.work()
        if self.work > SHARE or not envelope.factor():
            return False
        self.factored = envelope
        return True

    def step(self, shorter):
        """Goes a 2^shorter-th of the way from where the round began, within the limits. Whether that is all of it."""
        whole = shorter == 0
        self.work += len(self.contacts) * STEP
        for joined in self.contacts:
            change = [0, 0, 0]
            for row in joined.equations():
                x = self.solution[joined.number[row]]
                way = round_shift(x * joined.diagonal[row], 82 - joined.shift[row] + shorter)
                then = joined.start[row] + way
                least, most = joined.limits(row)
                whole &= least <= then <= most
                change[row] = clamp(then, least, most) - joined.impulse(row)
            self.give(joined, change)
        return whole

    def give(self, joined, change):
        if not any(change):
            return
        joined.rows.give(self.movers.list, change)
        self.over |= any(abs(c) >= HELD for place in joined.rows.places for c in self.movers.list[place].v)
        for line, by in zip(joined.lines(), change):
            line.impulse += by
        joined.rows.peak = [max(peak, line.impulse) for peak, line in zip(joined.rows.peak, joined.rows.points)]

    def rises(self):
        """Whether the last step leads away from the solution."""
        work = 0
        for joined in self.contacts:
            for row in joined.equations():
                speeds = joined.lack[row] + joined.lacked[row]
                change = joined.impulse(row) - joined.start[row]
                work += round_shift(speeds * change * joined.inverse[row], 2 * joined.shift[row])
        return work > 0

    def hold(self):
        """Limits friction by the loads as they are now; how much that takes away at most, and the greatest load."""
        most_cut = most = 0
        for joined in self.contacts:
            loads = [line.impulse for line in joined.rows.points]
            joined.hold = joined.rows.hold(loads)
            drag = joined.impulse(0)
            cut = clamp(drag, -joined.hold, joined.hold) - drag
            most_cut, most = max(most_cut, abs(cut)), max(most, *loads)
            self.give(joined, [cut, 0, 0])
        return most_cut, most
