"""Plays recorded replays by a second implementation of the arithmetic law, in plain integers, and compares the hash of
the complete state after every tick: `python3 tests/law/run.py [--all | replay…]`. Without arguments the goldens below,
which take some seconds; with --all those in replays/, which take half an hour. The exit status is 1 if any differs.
"""

import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True

from replay import Bad, hash_parts, play, save, state_hash  # noqa: E402
from world import World  # noqa: E402

REPLAYS = Path(__file__).resolve().parent.parent.parent / "replays"
GOLDENS = (
    "free_flight", "spin", "orbit", "tc10c", "tc11c", "everything", "sensors", "pusher", "churn", "pixels", "sleep"
)


def differs(path, state, recorded):
    """What is known of a difference. The recorded state is not: the world here is saved, for the engine to compare."""
    file = Path(tempfile.gettempdir()) / f"{path.stem}-{state.tick}.save"
    file.write_bytes(save(state))
    parts = "".join(f"\n  {name} {value:016x}" for name, value in hash_parts(state).items())
    place = f"DIFFERS\t{path}\t{state.tick}\t{file}"
    return f"tick {state.tick} has {state_hash(state):016x}, recorded {recorded:016x}; by parts:{parts}\n{place}"


def run(path):
    """How many ticks were the same, what was not, and how often the law's rarer paths were gone."""
    ticks, seen = 0, {}
    try:
        records = play(path.read_bytes())
        world = World(next(records))
        seen = world.seen
        for recorded, commands, steps in records:
            for command in commands:
                world.command(command)
            if steps:
                world.step()
            if state_hash(world.state) != recorded:
                return ticks, differs(path, world.state, recorded), seen
            ticks += steps
    except (Bad, OSError) as error:
        return ticks, f"{type(error).__name__}: {error}", seen
    return ticks, None if ticks else "there is no tick", seen


def main(arguments):
    paths = [Path(a) for a in arguments] or [REPLAYS / f"{name}.replay" for name in GOLDENS]
    if arguments == ["--all"]:
        paths = sorted(REPLAYS.glob("*.replay"))
    failed = not paths
    for path in paths:
        start = time.monotonic()
        ticks, wrong, seen = run(path)
        failed |= wrong is not None
        rare = "".join(f", {count} {what}" for what, count in sorted(seen.items()) if count)
        print(f"{path.stem}: {ticks} ticks the same, {time.monotonic() - start:.1f} s{rare}", flush=True)
        if wrong:
            print(f"  {wrong}", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
