#!/usr/bin/env python3
"""A frame in Python against the program's own loop: medians in ms of rounds that take turns, on an idle machine.

    LIGHTGRID_LIBRARY=build/src/liblightgrid.so.0 PYTHONPATH=python tests/benchmarks/python_frames.py build/src/lightgrid
"""
import json
import statistics
import subprocess
import sys
import time

import numpy as np

import lightgrid_render as lg

program, frames, size = sys.argv[1], 40, (1280, 720)
device = lg.Device(opengl="none")
view = device.view(lg.Scene("hall", size=size), "visibility")
out = np.empty((size[1], size[0], 4), np.float32)
view.render(out)
rounds = []
for _ in range(5):
    times = []
    for _ in range(frames):
        start = time.perf_counter()
        view.render(out)
        times.append(1e3 * (time.perf_counter() - start))
    ours = statistics.median(times)
    results = subprocess.run([program, "--quiet", "render", "hall", "-t", "visibility", "--warmup", "1", "--frames", str(frames),
                              "-o", "/dev/shm/python_frames.exr", "--json", "-"], check=True, capture_output=True).stdout
    theirs = json.loads(results)["frame_ms"]["median"]
    rounds.append((ours, theirs))
    print(f"Python {ours:.3f}, program {theirs:.3f} (until the host can read the image, which Python's also copies)")
print(f"ratio of medians: {statistics.median(o for o, _ in rounds) / statistics.median(t for _, t in rounds):.4f}")
start = time.perf_counter()
for _ in range(10000):
    view.size
print(f"a small call: {(time.perf_counter() - start) / 10000 * 1e6:.2f} us")
