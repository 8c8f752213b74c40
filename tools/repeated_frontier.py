#!/usr/bin/env python3
"""repeated_frontier.py DIR DIR…: whether repeated runs of one `lightgrid frontier` agree in what they state.

Prints how many controls (the baseline against itself) passed; of each two runs the share of the points' intervals in the
first that hold the estimate of the second; the deviation between runs; and of each claim that a point is on the front,
by its probability, in how many of the other runs it is."""
import itertools
import json
import math
import statistics
import sys
from pathlib import Path


def read(folder):
    answer = json.loads((Path(folder) / "frontier.json").read_text())
    points = {(p["scene"], p["label"], p["frames"]): p for p in answer["points"] if p["relative_time"]["runs"] > 0}
    return answer["controls"], points


def main():
    runs = [read(folder) for folder in sys.argv[1:]]
    controls = [control for of_run, _ in runs for control in of_run]
    print(f"controls: {sum(c['passed'] for c in controls)} of {len(controls)} passed, estimates "
          + ", ".join(f"{c['relative_time']['estimate']:.4f}" for c in controls))
    held = compared = 0
    for (_, a), (_, b) in itertools.permutations(runs, 2):
        for key in a.keys() & b.keys():
            low, high = a[key]["relative_time"]["ci95"]
            compared += 1
            held += low <= b[key]["relative_time"]["estimate"] <= high
    print(f"intervals of one run that hold the estimate of another: {held} of {compared} "
          f"({100 * held / max(compared, 1):.1f} %; of 95 % intervals of equal width 83 % would)")
    deviations = []
    for key in set.intersection(*(set(points) for _, points in runs)):
        logs = [math.log(points[key]["relative_time"]["estimate"]) for _, points in runs]
        if len(logs) > 1:
            deviations.append(statistics.stdev(logs))
    if deviations:
        print(f"standard deviation between runs: median {100 * statistics.median(deviations):.2f} %, "
              f"largest {100 * max(deviations):.2f} %")
    bins = {}
    for (_, a), (_, b) in itertools.permutations(runs, 2):
        for key in a.keys() & b.keys():
            bins.setdefault(min(int(a[key]["fronts"]["total"]["probability"] * 5), 4), []).append(b[key]["fronts"]["total"]["on"])
    for number, fronts in sorted(bins.items()):
        print(f"probability {number / 5:.1f} to {(number + 1) / 5:.1f}: on the front of another run in "
              f"{100 * statistics.fmean(fronts):.0f} % of {len(fronts)}")


main()
