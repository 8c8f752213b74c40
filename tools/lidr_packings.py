#!/usr/bin/env python3
"""The thirteen rows of table 2.9.1 of light-indexed deferred rendering, by each packing: bytes a pixel, lost pairs and time. Prints the table of
docs/results/lidr_packings.md.

    tools/lidr_packings.py [--program FILE] [--frames N] [--size WxH] [--csv FILE] [MORE OPTIONS OF compare …]

A ratio is the row's median time over that of forward_plus in the same, interleaved run. Rows of one number of lights are one run: 15 and 255 lights
scattered in terrain, and 4,096 for the rows of 65,535.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
ROWS = {15: [2, 4, 8, 16], 255: [1, 2, 4, 8, 16], 65535: [1, 2, 4, 8]}
LIGHTS = {15: 15, 255: 255, 65535: 4096}
PACKINGS = ["bitshift", "maxblend", "sort", "maxblend-sort"]
COLUMNS = ["commit", "cl", "gl", "lights", "overlap", "packing", "bytes_per_pixel", "runs", "time_of_forward_plus", "listed", "lit", "lost", "wrong"]


def run(o, more, lights):
    names = [f"lidr:lidr-lights={lights},lidr-overlap={n},lidr-packing={p}" for n in ROWS[lights] for p in PACKINGS
             if p != "maxblend" or n <= 4]
    # Without lost pairs: as many passes over the surfaces as the lights take.
    names += [f"lidr:lidr-lights={lights},lidr-overlap={n},lidr-packing={p},lidr-passes=16" for n in ROWS[lights] if n in (4, 8)
              for p in ("sort", "maxblend-sort")]
    with tempfile.TemporaryDirectory() as folder:
        # Status 1: lights were lost, as expected past a row's overlaps.
        done = subprocess.run([o.program, "compare", "terrain", "--lights", str(LIGHTS[lights]), "--size", o.size, "-t",
                               ",".join(["forward_plus", *names]), "--frames", str(o.frames), "--json", "-", "-o", folder, "--quiet",
                               *more], stdout=subprocess.PIPE, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.returncode)
    results = json.loads(done.stdout)
    return results.get("views", [results])[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "src", "lightgrid"))
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--csv")
    o, more = parser.parse_known_args()
    width, height = map(int, o.size.split("x"))
    lines = []
    for lights in ROWS:
        results = run(o, more, lights)
        base = next(r for r in results["rows"] if r["technique"] == "forward_plus")["frame_ms"]["median"]
        for r in results["rows"]:
            if r["technique"] != "lidr" or r.get("refused"):
                continue
            s, pairs = r["settings"], r["pairs"]
            passes = str(s["lidr_passes"])
            packing = s["lidr_packing"] + (f", {passes} passes" if passes != "1" else "")
            lines.append([results["commit"], results["devices"]["cl"], results["devices"]["gl"], lights, s["lidr_overlap"], packing,
                          r["memory_bytes"]["light_grid"] / (width * height), r["frame_ms"]["runs"],
                          round(r["frame_ms"]["median"] / base, 2), pairs["listed"], pairs["lit"],
                          pairs["lost"], pairs["wrong"]])
    if o.csv:
        with open(o.csv, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS] + lines)
    # A cell: time of forward_plus's, bytes a pixel, lost pairs of all lit.
    print(f"Pairs wrong in all rows: {sum(line[12] for line in lines)}.\n")
    columns = [*PACKINGS, "sort, 16 passes", "maxblend-sort, 16 passes"]
    print("| a pixel | of lights | " + " | ".join(columns) + " |")
    print("| ---: | ---: |" + " --- |" * len(columns))
    for lights in ROWS:
        for overlap in ROWS[lights]:
            cells = []
            for column in columns:
                found = [li for li in lines if li[3] == lights and str(li[4]) == str(overlap) and li[5] == column]
                cells.append("–" if not found else f"{found[0][8]:.2f}; {found[0][6]:g}; " + (
                    "0" if found[0][11] == 0 else f"{100 * found[0][11] / found[0][10]:.2g} %"))
            print(f"| {overlap} | {lights:,} | " + " | ".join(cells) + " |")


main()
