#!/usr/bin/env python3
"""A frame in Python against the program's own loop: medians in ms of rounds that take turns, on an idle machine.

    LIGHTGRID_LIBRARY=build/src/liblightgrid.so.0 PYTHONPATH=python tools/python_frames.py build/src/lightgrid

Both count until the host can read the image. view.draw() leaves it where it is, as the program's loop does; view.render(out)
copies it."""
import json
import statistics
import subprocess
import sys
import time

import numpy as np

import lightgrid_render as lg

program, frames, size, rounds = sys.argv[1], 40, (1280, 720), 7
device = lg.Device(opengl="none")
view = device.view(lg.Scene("hall", size=size), "visibility")
out = np.empty((size[1], size[0], 4), np.float32)


def median_ms(draw):
    times = []
    draw()
    for _ in range(frames):
        start = time.perf_counter()
        draw()
        times.append(1e3 * (time.perf_counter() - start))
    return statistics.median(times)


def of_program():
    results = subprocess.run([program, "--quiet", "render", "hall", "--gl", "none", "-t", "visibility", "--warmup", "1",
                              "--frames", str(frames), "-o", "/dev/shm/python_frames.exr", "--json", "-"], check=True,
                             capture_output=True).stdout
    return json.loads(results)["frame_ms"]["median"]


sides = {"draw": lambda: median_ms(view.draw), "program": of_program, "render": lambda: median_ms(lambda: view.render(out))}
taken = {name: [] for name in sides}
for i in range(rounds):
    for name in list(sides) if i % 2 == 0 else list(sides)[::-1]:
        taken[name].append(sides[name]())
    print(", ".join(f"{name} {times[-1]:.3f}" for name, times in taken.items()), "ms")
for name in ("draw", "render"):
    ratios = [ours / theirs for ours, theirs in zip(taken[name], taken["program"])]
    print(f"{name} / program: median of rounds {statistics.median(ratios):.4f}, {min(ratios):.4f} to {max(ratios):.4f}")
start = time.perf_counter()
for _ in range(10000):
    view.size
print(f"a small call: {(time.perf_counter() - start) / 10000 * 1e6:.2f} us")
