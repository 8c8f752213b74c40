#!/usr/bin/env python3
"""Prints how long frames take if kernels may contract, or use relaxed maths, relative to today's kernels, which
give the same bytes on all devices (docs/devices.md#same-bits).

    price_of_sameness.py LIGHTGRID DEVICE "hall -t visibility" "hall -t visibility --shadows all" ...

The three builds alternate for five rounds, so that other work on the machine disturbs all of them. Medians of
ratios: wall-clock time of a frame, its processor time, and the sum of its kernels.
"""
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

BUILDS = ("exact", "contract", "relaxed")
ROUNDS = 5
FRAMES = "12"


def frame_ms(program, device, words, folder, build="exact"):
    """Medians of one run: wall-clock, processor and kernel milliseconds."""
    record = folder / "frame.json"
    command = [program, "render", *words, "--device", device, "--size", "1280x720", "--frames", FRAMES,
               "--warmup", "2", "--json", record, "-o", folder / "frame.png"]
    maths = {} if build == "exact" else {"LIGHTGRID_CL_MATHS": build}
    subprocess.run(command, env=os.environ | maths, check=True, capture_output=True)
    frame = json.loads(record.read_text())
    kernels = [kernel for one in frame["passes"] for kernel in one.get("kernels", [])]
    return [frame["frame_ms"]["median"], frame["frame_cpu_ms"]["median"],
            sum(kernel["median_ms"] for kernel in kernels)]


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    program, device = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for case in sys.argv[3:]:
            times = {build: [] for build in BUILDS}
            for build in BUILDS:
                frame_ms(program, device, case.split(), folder, build)  # compiles
            for number in range(ROUNDS):
                for build in BUILDS if number % 2 else BUILDS[::-1]:
                    times[build].append(frame_ms(program, device, case.split(), folder, build))
            exact = [statistics.median(column) for column in zip(*times["exact"])]
            print(case, "exact: wall {:.2f} ms, processor {:.2f}, kernels {:.2f}".format(*exact), sep=": ")
            for build in BUILDS[1:]:
                ratios = [[b / a for a, b in zip(*pair)] for pair in zip(times["exact"], times[build])]
                medians = [statistics.median(column) for column in zip(*ratios)]
                print("    {}: wall {:.3f}, processor {:.3f}, kernels {:.3f}".format(build, *medians), flush=True)


if __name__ == "__main__":
    main()
