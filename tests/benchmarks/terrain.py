#!/usr/bin/env python3
"""Trebilco's experiment: 255 small lights over hills, light-indexed deferred rendering against a forward pass for each
light, and every other technique beside them. Prints docs/results/terrain.md's table and the lines of its CSV.

    tests/benchmarks/terrain.py [--program FILE] [--frames N] [--csv FILE] [MORE OPTIONS OF compare …]
    tests/benchmarks/terrain.py --json results.json [--csv FILE]      of a run made elsewhere

A ratio is forward_multipass's median over the technique's, both of one interleaved run.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
OVERLAPS = ["lidr:lidr-overlap=1", "lidr:lidr-overlap=2", "lidr:lidr-overlap=4", "lidr:lidr-overlap=8",
            "lidr:lidr-overlap=16", "lidr:lidr-overlap=2,lidr-packing=maxblend", "lidr:lidr-overlap=4,lidr-packing=sort"]
TECHNIQUES = ["forward", "forward_multipass", "forward_zprepass", "forward_plus", "clustered", "forward_plus_compute",
              "deferred", "deferred_tiled", *OVERLAPS]
COLUMNS = ["commit", "cl", "gl", "technique", "runs", "min_ms", "median_ms", "max_ms", "ratio", "listed", "lit", "lost",
           "wrong", "max_rel"]


def measured(o, more):
    if o.json:
        with open(o.json) as file:
            return json.load(file)
    with tempfile.TemporaryDirectory() as folder:
        # Status 1: lights were lost, as expected of LIDR past its overlaps.
        run = subprocess.run([o.program, "compare", "terrain", "--size", "1024x768", "-t", ",".join(TECHNIQUES), "--frames",
                              str(o.frames), "--json", "-", "-o", folder, "--quiet", *more], stdout=subprocess.PIPE, text=True)
        if run.returncode not in (0, 1):
            sys.exit(run.returncode)
        return json.loads(run.stdout)


def name_of(row):
    if row["technique"] != "lidr":
        return row["technique"]
    return f"lidr, {row['settings']['lidr_overlap']} of {row['settings']['lidr_packing']}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "src", "lightgrid"))
    parser.add_argument("--frames", type=int, default=7)
    parser.add_argument("--json")
    parser.add_argument("--csv")
    o, more = parser.parse_known_args()
    results = measured(o, more)
    results = results.get("views", [results])[0]
    rows = [row for row in results["rows"] if not row.get("refused")]
    base = next(row for row in rows if row["technique"] == "forward_multipass")["frame_ms"]["median"]
    lines = []
    for row in rows:
        ms, pairs = row["frame_ms"], row["pairs"]
        lines.append([results["commit"], results["devices"]["cl"], results["devices"]["gl"], name_of(row), ms["runs"],
                      round(ms["min"], 3), round(ms["median"], 3), round(ms["max"], 3), round(base / ms["median"], 2),
                      pairs["listed"], pairs["lit"], pairs["lost"], pairs["wrong"], row["error"]["max_rel"]])
    if o.csv:
        fresh = not os.path.exists(o.csv)
        with open(o.csv, "a", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows(([COLUMNS] if fresh else []) + lines)
    print(f"Commit {results['commit']}; {results['devices']['cl']}; {results['devices']['gl']}.\n")
    print("| technique | ms | times forward_multipass | lost pairs of all lit | largest error |\n| --- | ---: | ---: | ---: | ---: |")
    for line in lines:
        lost = "0" if line[11] == 0 else f"{100 * line[11] / line[10]:.2g} %"
        print(f"| {line[3]} | {line[6]:.3g} | {line[8]:.2f} | {lost} | {line[13]:.1e} |")


main()
