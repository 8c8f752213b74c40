#!/usr/bin/env python3
"""Measures docs/results/samples.md: writes samples.csv beside the page, and its table between the page's marks.

    tools/samples.py [SCENE...]        about six minutes on two cores; needs a built tree
"""
import csv
import io
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = pathlib.Path(os.environ.get("LIGHTGRID_BUILD", ROOT / "build"))
RESULTS = ROOT / "docs" / "results" / "samples"


def span(values):
    low, high = min(values, key=int), max(values, key=int)
    return low if low == high else f"{low} to {high}"


def table(rows):
    """By technique and number of samples: in each scene the error at edges of one sample and of so many, and the frame's time relative to one."""
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    of = {(r["technique"], r["samples"], r["scene"]): r for r in rows}
    lines = ["| technique | samples | " + " | ".join(f"`{s}`" for s in scenes) + " | more bytes per pixel |",
             "| --- | ---: | " + " | ".join("---:" for _ in scenes) + " | ---: |"]
    for technique, samples in dict.fromkeys((r["technique"], r["samples"]) for r in rows if r["samples"] != "1"):
        cells = []
        for scene in scenes:
            one, more = of[technique, "1", scene], of[technique, samples, scene]
            cells.append(f"{float(one['edge_error']):.3f} → {float(more['edge_error']):.3f}, {more['time_of_one']}x")
        bytes_ = span([of[technique, samples, scene]["more_bytes_a_pixel"] for scene in scenes])
        lines.append(f"| `{technique}` | {samples} | {' | '.join(cells)} | {bytes_} |")
    return "\n".join(lines)


def main():
    subprocess.run(["cmake", "--build", BUILD, "-t", "samples"], check=True, stdout=subprocess.DEVNULL)
    text = subprocess.run([BUILD / "tools" / "samples", *sys.argv[1:]], check=True, stdout=subprocess.PIPE,
                          text=True).stdout
    RESULTS.with_suffix(".csv").write_text(text)
    page = RESULTS.with_suffix(".md")
    made = table(list(csv.DictReader(io.StringIO(text))))
    page.write_text(re.sub(r"<!-- table -->.*<!-- /table -->", f"<!-- table -->\n{made}\n<!-- /table -->",
                           page.read_text(), flags=re.S))


main()
