"""Symmetric positive definite systems as L·D·Lᵀ, each row from its first entry on.

Entries and pivots are Q58, L Q52, 1/D Q44, right sides and solutions Q44.
"""

from ints import round_shift

ROWS = 256
FLOOR = 1 << 44
FAR = 1 << 57


class Envelope:
    """`rows`: (first column, entries left of the diagonal, diagonal)."""

    def __init__(self, rows):
        self.rows, self.lower, self.inverses = rows, [], []

    def work(self):
        """How many products it takes to factor it, at most."""
        return sum(len(entries) * (len(entries) + 1) // 2 for _, entries, _ in self.rows)

    def factor(self):
        """Whether the system is clearly positive definite."""
        if len(self.rows) > ROWS:
            return False
        for i, (first, own, diagonal) in enumerate(self.rows):
            own = list(own)
            for j in range(first, i):
                other = self.rows[j][0]
                k = max(first, other)
                if k < j:
                    pairs = zip(own[k - first : j - first], self.lower[j][k - other :])
                    own[j - first] -= round_shift(sum(a * b for a, b in pairs), 52)
            below = [round_shift(c * self.inverses[first + at], 50) for at, c in enumerate(own)]
            pivot = diagonal - round_shift(sum(a * b for a, b in zip(own, below)), 52)
            if pivot < FLOOR:
                return False
            self.lower.append(below)
            self.inverses.append(((1 << 102) + (pivot >> 1)) // pivot)
        return True

    def solve(self, x):
        """The solution for a right side; none where a number leaves its range."""
        x = list(x)
        for i, (first, _, _) in enumerate(self.rows):
            x[i] -= round_shift(sum(a * b for a, b in zip(self.lower[i], x[first:i])), 52)
            if abs(x[i]) > FAR:
                return None
        x = [round_shift(value * inverse, 44) for value, inverse in zip(x, self.inverses)]
        if any(abs(value) > FAR for value in x):
            return None
        for i in range(len(x) - 1, -1, -1):
            if abs(x[i]) > FAR:
                return None
            first = self.rows[i][0]
            for at, entry in enumerate(self.lower[i]):
                x[first + at] -= round_shift(entry * x[i], 52)
        return x
