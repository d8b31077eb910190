#!/usr/bin/env python3
"""Chipmunk (Munk2D through pymunk) behind the peers' protocol. --substeps N: other iterations than its default of 10.

Chipmunk multiplies the friction of two shapes, and their elasticity: each shape gets the square root. Its collision_slop of
0.1 is meant for pixels; here it is 5 mm, as in Box2D.
"""
import argparse
import json
import math
import pickle
import struct
import time

import pymunk


def area_inertia(p):
    """Area, centroid, and second moment about the centroid for unit mass of a convex polygon."""
    a = cx = cy = i = 0.0
    for k in range(len(p)):
        (x0, y0), (x1, y1) = p[k], p[(k + 1) % len(p)]
        c = x0 * y1 - x1 * y0
        a += c
        cx += (x0 + x1) * c
        cy += (y0 + y1) * c
        i += c * (x0 * x0 + x0 * x1 + x1 * x1 + y0 * y0 + y0 * y1 + y1 * y1)
    cx, cy = cx / (3 * a), cy / (3 * a)
    return a / 2, (cx, cy), i / 6 / a - cx * cx - cy * cy


def outline(shape):
    """Kind, points or radius, area, centroid, second moment for unit mass."""
    if "circle" in shape:
        r = shape["circle"]
        return "circle", r, math.pi * r * r, (0.0, 0.0), r * r / 2
    if "box" in shape:
        x, y = shape["box"]
        points = [(-x, -y), (x, -y), (x, y), (-x, y)]
    else:
        points = [tuple(p) for p in shape["poly"]]
    return "poly", points, *area_inertia(points)


class World:
    def __init__(self, scene, iterations):
        space = pymunk.Space()
        space.gravity = tuple(scene["gravity"])
        space.iterations = iterations
        space.collision_slop = 0.005
        self.space, self.dt, self.bodies = space, scene["dt"], []
        friction, elasticity = math.sqrt(scene["friction"]), math.sqrt(scene["restitution"])
        for b in scene["bodies"]:
            shapes = [outline(shape) for shape in b["shapes"]]
            if b["kind"] == "dynamic":
                [(_, _, area, centroid, moment)] = shapes
                mass = area * b["density"]
                body = pymunk.Body(mass, moment * mass)
                body.center_of_gravity = centroid
            else:
                static = b["kind"] == "static"
                body = pymunk.Body(body_type=pymunk.Body.STATIC if static else pymunk.Body.KINEMATIC)
            body.position, body.angle = tuple(b["pos"]), b["angle"]
            if b["kind"] != "static":
                body.velocity, body.angular_velocity = tuple(b["vel"]), b["omega"]
            space.add(body)
            for kind, form, *_ in shapes:
                shape = pymunk.Circle(body, form) if kind == "circle" else pymunk.Poly(body, form)
                shape.friction, shape.elasticity = friction, elasticity
                if not b["collide"]:
                    shape.filter = pymunk.ShapeFilter(categories=0, mask=0)
                space.add(shape)
            self.bodies.append(body)
        for h in scene["hinges"]:
            joint = pymunk.PivotJoint(self.bodies[h["a"]], self.bodies[h["b"]], tuple(h["la"]), tuple(h["lb"]))
            joint.collide_bodies = False
            space.add(joint)

    def step(self):
        self.space.step(self.dt)


def state(b):
    return [b.position.x, b.position.y, b.angle, b.velocity.x, b.velocity.y, b.angular_velocity]


def fnv(rows):
    h = 0xCBF29CE484222325
    for row in rows:
        for byte in struct.pack("<6d", *row):
            h = ((h ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return f"{h:016x}"


def numbers(rows):
    """JSON has no NaN."""
    return [[v if math.isfinite(v) else None for v in row] for row in rows]


def snapshot(world, warm):
    for _ in range(warm):
        world.step()
    now, copies, saves, loads = time.perf_counter_ns, [], [], []
    for _ in range(3):
        t = now(); copy = world.space.copy(); copies.append(now() - t)
        t = now(); raw = pickle.dumps(world.space, protocol=5); saves.append(now() - t)
        t = now(); loaded = pickle.loads(raw); loads.append(now() - t)

    def on(space):
        for _ in range(60):
            space.step(world.dt)
        return fnv([state(b) for b in space.bodies])

    straight = on(world.space)
    cost = lambda op, ns, size: {"op": op, "median_ns": sorted(ns)[1], "min_ns": min(ns), "reps": 3, "bytes": size}
    return {
        "warm": warm,
        "costs": [cost("save", saves, len(raw)), cost("load", loads, len(raw)), cost("copy", copies, 0)],
        "facts": {"goes on the same from a copy": straight == on(copy),
                  "goes on the same from bytes": straight == on(loaded)},
    }


def windows(world, scene):
    """Nanoseconds for which this thread had the processor in each window."""
    done, ns = 0, []
    for _, start, end in scene["windows"]:
        for _ in range(start - done):
            world.step()
        t = time.thread_time_ns()
        for _ in range(end - start):
            world.step()
        ns.append(time.thread_time_ns() - t)
        done = end
    return ns


def steps_of(world, scene, steps):
    bodies, every, now = [world.bodies[i] for i in scene["tracked"]], scene["track_every"], time.perf_counter_ns
    ns, samples, cpu, window = [], [[0, numbers(map(state, bodies))]], [], 0
    starts, ends = {w[1] + 1 for w in scene["windows"]}, {w[2] for w in scene["windows"]}
    for k in range(1, steps + 1):
        if k in starts:
            window = time.thread_time_ns()
        t = now()
        world.step()
        ns.append(now() - t)
        if k in ends:
            cpu.append(time.thread_time_ns() - window)
        if k % every == 0 or k == steps:
            samples.append([k, numbers(map(state, bodies))])
    return {"cpu_ns": cpu, "final_hash": fnv(map(state, bodies)), "samples": samples, "step_ns": ns[:20_000]}


def main():
    ap = argparse.ArgumentParser()
    ap.add_argument("--group", required=True)
    ap.add_argument("--scene", required=True)
    ap.add_argument("--scene-dir", required=True)
    ap.add_argument("--steps", type=int)
    ap.add_argument("--snapshot", type=int)
    ap.add_argument("--substeps", type=int, default=10)
    a = ap.parse_args()
    with open(f"{a.scene_dir}/{a.group}.{a.scene}.json") as file:
        scene = json.load(file)
    steps = scene["steps"] if a.steps is None else a.steps
    world = World(scene, a.substeps)
    if a.snapshot is not None:
        rest = snapshot(world, a.snapshot)
    else:
        # What tells its states at every step is timed by a run of its own.
        alone = {"cpu_ns": windows(World(scene, a.substeps), scene)} if scene["track_every"] == 1 else {}
        rest = steps_of(world, scene, steps) | alone
    version = f"Munk2D {pymunk.chipmunk_version}, pymunk {pymunk.version}"
    line = {"protocol": 2, "engine": "chipmunk", "version": version, "scene": a.scene, "steps": steps,
            "bodies": len(scene["bodies"])}
    print(json.dumps(line | rest))


main()
