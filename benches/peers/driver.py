#!/usr/bin/env python3
"""Runs the engines' programs on the scenes, interleaved and on one processor; each line they print is kept in $PEERS/raw.

usage: driver.py [--rounds N] [--only speed,accuracy,hard,snapshot,rollback] [--scenes a,b] [--engines a,b] [--cpu 0] [--keep]

In each round every engine has its turn, in an order that alternates. Speed scenes have N rounds (5), those of more than 2000
bodies 3; scenes with a known outcome 3, at every setting; hard ones 1, snapshots 2, rollbacks N.
"""
import argparse
import glob
import json
import os
import shutil
import subprocess
import time

HERE = os.path.dirname(os.path.abspath(__file__))
PEERS = os.environ["PEERS"]
CHIPMUNK = [f"{PEERS}/venv/bin/python", f"{HERE}/chipmunk/peer_chipmunk.py", "--scene-dir", f"{PEERS}/scenes-json"]

# Name: command, groups, and the settings to go through: substeps, solver iterations; the engine's default first.
ENGINES = {
    "ours": ([f"{PEERS}/bin/ours"], {"speed", "accuracy", "hard", "snapshot", "rollback"}, [10, 1, 2, 4, 8, 16]),
    "box2d": ([f"{PEERS}/bin/box2d"], {"speed", "accuracy", "hard", "snapshot", "rollback"}, [4, 1, 2, 8, 16]),
    "box2d-double": ([f"{PEERS}/bin/box2d-double"], {"accuracy"}, [4]),
    "rapier": ([f"{PEERS}/bin/rapier"], {"speed", "accuracy", "hard", "snapshot", "rollback"}, [4, 1, 2, 8, 16]),
    "chipmunk": (CHIPMUNK, {"speed", "accuracy", "hard", "snapshot"}, [10, 1, 2, 4, 8, 16]),
}
SNAPSHOTS = {"s1_pyramid40", "s2_pile1000"}
TIMEOUT = 900


def scenes(group):
    for path in sorted(glob.glob(f"{PEERS}/scenes-json/*.json")):
        with open(path) as file:
            scene = json.load(file)
        if scene["group"] == ("speed" if group == "snapshot" else group):
            if group != "snapshot" or scene["name"] in SNAPSHOTS:
                yield scene["name"], len(scene["bodies"])


def call(command, cpu):
    pin = ["taskset", "-c", str(cpu)] if shutil.which("taskset") else []
    begin = time.time()
    try:
        done = subprocess.run(pin + command, capture_output=True, text=True, timeout=TIMEOUT)
        lines = done.stdout.strip().splitlines()
        line = json.loads(lines[-1]) if lines else {"error": f"exit {done.returncode}: {done.stderr[-300:]}"}
    except subprocess.TimeoutExpired:
        line = {"error": f"no end after {TIMEOUT} s"}
    return line, time.time() - begin


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("--rounds", type=int, default=5)
    ap.add_argument("--only", default="speed,accuracy,hard,snapshot,rollback")
    ap.add_argument("--scenes")
    ap.add_argument("--engines")
    ap.add_argument("--cpu", type=int, default=0)
    ap.add_argument("--keep", action="store_true", help="keep the lines of earlier runs, to add to them")
    a = ap.parse_args()
    raw = f"{PEERS}/raw"
    if not a.keep:
        shutil.rmtree(raw, ignore_errors=True)
    os.makedirs(raw, exist_ok=True)
    names = a.engines.split(",") if a.engines else list(ENGINES)
    for group in a.only.split(","):
        for scene, bodies in scenes(group):
            if a.scenes and scene not in a.scenes.split(","):
                continue
            rounds = {"speed": min(a.rounds, 3) if bodies > 2000 else a.rounds, "accuracy": 3, "hard": 1, "rollback": a.rounds}.get(group, 2)
            runs = [(n, s) for n in names if group in ENGINES[n][1]
                    for s in (ENGINES[n][2] if group == "accuracy" else ENGINES[n][2][:1])]
            for turn in range(rounds):
                for name, setting in runs if turn % 2 == 0 else runs[::-1]:
                    if group == "snapshot" and name == "chipmunk" and turn > 0:
                        continue
                    command = ENGINES[name][0] + ["--group", "speed" if group == "snapshot" else group,
                                                  "--scene", scene, "--substeps", str(setting)]
                    if group == "snapshot":
                        command += ["--steps", "30", "--snapshot", "300"]
                    if group == "rollback":
                        command += ["--steps", "30", "--rollback", "900"]
                    line, took = call(command, a.cpu)
                    if turn > 0:
                        line.pop("samples", None)  # those of the first round, if the hash is the same
                    line.update(group=group, scene=scene, name=name, setting=setting, round=turn,
                                default=setting == ENGINES[name][2][0])
                    with open(f"{raw}/{group}.{scene}.{name}.{setting:02}.{turn}.json", "w") as file:
                        json.dump(line, file)
                    if took > 5 or "error" in line:
                        print(group, scene, name, setting, f"{took:.1f} s", line.get("error", ""), flush=True)
            print(group, scene, "done", flush=True)


main()
