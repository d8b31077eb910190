"""Number kernels against another implementation: reads lines `operation input… = result…`, names what differs."""

import sys

sys.dont_write_bytecode = True

import ints  # noqa: E402

pair = lambda f: lambda ax, ay, bx, by, shift: [f((ax, ay), (bx, by), shift)]
KERNELS = {
    "round_shift": lambda value, shift: [ints.round_shift(value, shift) if shift < 128 else 0],
    "mul": lambda a, b, shift: [ints.mul(a, b, shift)],
    "mul_add": lambda a, b, c, lift, shift: [ints.mul_add(a, b, c, lift, shift)],
    "dot": pair(ints.dot),
    "cross": pair(ints.cross),
    "cross_wide": pair(ints.cross_wide),
    "div": lambda n, d: [ints.div(n, d)],
    "mul_div": lambda a, b, d: [ints.mul_div(a, b, d)],
    "sqrt": lambda value: [ints.sqrt(value)],
    "hypot": lambda x, y: [ints.hypot(x, y)],
    "sin_cos": lambda angle: list(ints.sin_cos(angle)),
}


def main():
    lines = wrong = 0
    for line in sys.stdin:
        left, right = line.split("=")
        operation, *inputs = left.split()
        result = KERNELS[operation](*map(int, inputs))
        lines += 1
        if result != [int(word) for word in right.split()]:
            wrong += 1
            print(f"{line.strip()}, here {result}")
    print(f"{lines} results, {wrong} differ")
    return int(wrong > 0 or lines == 0)


if __name__ == "__main__":
    sys.exit(main())
