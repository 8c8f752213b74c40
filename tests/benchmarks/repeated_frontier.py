#!/usr/bin/env python3
"""repeated_frontier.py DIR DIR…: whether repeated runs of one `lightgrid frontier` rank the same points the same way.

For each two runs and each two points of a scene that neither run ties (~): do both runs order their ratios alike?
Prints the pairs of points that they order differently, and how many pairs are ranked at all."""
import itertools
import json
import sys
from pathlib import Path


def ranked_pairs(folder):
    """(scene, label, label) -> whether the first is faster, for pairs that are not tied."""
    points = json.loads((Path(folder) / "frontier.json").read_text())["points"]
    tied = {(i, j) for i, p in enumerate(points) for j in p["tied_with"]}
    pairs = {}
    for i, j in itertools.combinations(range(len(points)), 2):
        a, b = points[i], points[j]
        if a["scene"] != b["scene"] or not a["ratio"] or not b["ratio"] or (i, j) in tied or (j, i) in tied:
            continue
        pairs[a["scene"], a["label"], b["label"]] = a["ratio"]["median"] < b["ratio"]["median"]
    return pairs


def main():
    runs = {folder: ranked_pairs(folder) for folder in sys.argv[1:]}
    compared = different = 0
    for (x, a), (y, b) in itertools.combinations(runs.items(), 2):
        for pair in a.keys() & b.keys():
            compared += 1
            if a[pair] != b[pair]:
                different += 1
                print(f"{x} and {y} order differently: {pair[1]} and {pair[2]} in {pair[0]}")
    for folder, pairs in runs.items():
        print(f"{folder}: {len(pairs)} pairs of points ranked")
    print(f"{compared} pairs ranked in both of two runs, {different} of them differently ({100 * different / max(compared, 1):.2f} %)")
    return 0 if different == 0 else 1


sys.exit(main())
