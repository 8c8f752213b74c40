#!/usr/bin/env python3
"""Trebilco's experiment: 255 small lights over hills, light-indexed deferred rendering against a forward pass for each
light, and every other technique. Prints the figures of docs/results/terrain.md as a table and writes the lines of its CSV.

    tools/terrain.py [--program FILE] [--frames N] [--article] [--samples N] [--csv FILE] [MORE OPTIONS OF compare …]
    tools/terrain.py --json results.json [--csv FILE]      of a run made elsewhere

--article takes only what the article's figure 2.9.1 compares. --samples adds each of these once more with N samples a pixel, as
the setting `samples` has them, for techniques that read it.

A ratio is forward_multipass's median over the technique's, both of one interleaved run and with as many samples. The error is
that of the picture of every light, of one sample or, in rows with several, of as many.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
OVERLAPS = ["lidr:lidr-overlap=1", "lidr:lidr-overlap=2", "lidr:lidr-overlap=4", "lidr:lidr-overlap=8",
            "lidr:lidr-overlap=16", "lidr:lidr-overlap=2,lidr-packing=maxblend", "lidr:lidr-overlap=4,lidr-packing=sort",
            "lidr:lidr-overlap=4,lidr-packing=maxblend-sort", "lidr:lidr-overlap=4,lidr-packing=sort,lidr-passes=16",
            "lidr:lidr-overlap=16,lidr-volumes=front-faces", "lidr:lidr-overlap=16,lidr-volumes=no-prepass"]
# The article's figure 2.9.1: one, two and four overlaps against a pass for each light.
ARTICLE = ["forward_multipass", "lidr:lidr-overlap=1", "lidr:lidr-overlap=2", "lidr:lidr-overlap=4"]
TECHNIQUES = ["forward", "forward_multipass", "forward_zprepass", "forward_plus", "clustered", "forward_plus_compute",
              "deferred", "deferred_tiled", *OVERLAPS]
COLUMNS = ["commit", "cl", "gl", "technique", "runs", "min_ms", "median_ms", "max_ms", "ratio", "listed", "lit", "lost",
           "wrong", "max_rel"]


def contestants(o):
    names = ARTICLE if o.article else TECHNIQUES
    if o.samples == 1:
        return names
    return names + [name + ("," if ":" in name else ":") + f"samples={o.samples}" for name in ARTICLE]


def samples_of(row):
    return int(row["settings"].get("samples", 1))


def measured(o, more):
    if o.json:
        with open(o.json) as file:
            return json.load(file)
    with tempfile.TemporaryDirectory() as folder:
        # Status 1: lights were lost, as expected of LIDR past its overlaps.
        run = subprocess.run([o.program, "compare", "terrain", "--size", "1024x768", "-t", ",".join(contestants(o)), "--frames",
                              str(o.frames), "--json", "-", "-o", folder, "--quiet", *more], stdout=subprocess.PIPE, text=True)
        if run.returncode not in (0, 1):
            sys.exit(run.returncode)
        return json.loads(run.stdout)


def largest_error(row):
    error = row["error"] if samples_of(row) == 1 else row["same_surfaces"]
    return error["max_rel"] if error else None


def name_of(row):
    s = row["settings"]
    name = row["technique"]
    if name == "lidr":
        name = f"lidr, {s['lidr_overlap']} of {s['lidr_packing']}"
        name += f", {s['lidr_passes']} passes" if str(s.get("lidr_passes", 1)) != "1" else ""
        name += f", {s['lidr_volumes']}" if s["lidr_volumes"] != "stencil" else ""
    return name + (f", {samples_of(row)} samples" if samples_of(row) > 1 else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "src", "lightgrid"))
    parser.add_argument("--frames", type=int, default=7)
    parser.add_argument("--article", action="store_true")
    parser.add_argument("--samples", type=int, default=1)
    parser.add_argument("--json")
    parser.add_argument("--csv")
    o, more = parser.parse_known_args()
    results = measured(o, more)
    results = results.get("views", [results])[0]
    rows = [row for row in results["rows"] if not row.get("refused")]
    base = {samples_of(row): row["frame_ms"]["median"] for row in rows if row["technique"] == "forward_multipass"}
    lines = []
    for row in rows:
        ms, pairs = row["frame_ms"], row["pairs"]
        lines.append([results["commit"], results["devices"]["cl"], results["devices"]["gl"], name_of(row), ms["runs"],
                      round(ms["min"], 3), round(ms["median"], 3), round(ms["max"], 3), round(base[samples_of(row)] / ms["median"], 2),
                      pairs["listed"], pairs["lit"], pairs["lost"], pairs["wrong"], largest_error(row)])
    if o.csv:
        fresh = not os.path.exists(o.csv)
        with open(o.csv, "a", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows(([COLUMNS] if fresh else []) + lines)
    print(f"Commit {results['commit']}; {results['devices']['cl']}; {results['devices']['gl']}.\n")
    print("| technique | ms | speed relative to forward_multipass | lost pairs of all lit | largest error |\n| --- | ---: | ---: | ---: | ---: |")
    for line in lines:
        lost = "0" if line[11] == 0 else f"{100 * line[11] / line[10]:.2g} %"
        error = "" if line[13] is None else f"{line[13]:.1e}"
        print(f"| {line[3]} | {line[6]:.3g} | {line[8]:.2f} | {lost} | {error} |")


main()
