#!/usr/bin/env python3
"""Measures docs/results/samples.md: writes samples.csv beside the page, and its table between the page's marks.

    tests/benchmarks/samples.py [SCENE...]        about six minutes on two cores; needs a built tree
"""
import csv
import io
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("LIGHTGRID_BUILD", ROOT / "build"))
RESULTS = ROOT / "docs" / "results" / "samples"


def table(rows):
    lines = ["| scene | technique | samples | error at edges | inside | a frame, ms | one sample = 1 | more bytes a pixel |",
             "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |"]
    for r in rows:
        if r["samples"] == "1" and sum(o["technique"] == r["technique"] and o["scene"] == r["scene"] for o in rows) == 1:
            continue  # takes no other number
        lines.append(f"| `{r['scene']}` | `{r['technique']}` | {r['samples']} | {float(r['edge_error']):.3f} | "
                     f"{float(r['inside_error']):.3f} | {r['frame_ms']} | {r['time_of_one']} | {r['more_bytes_a_pixel']} |")
    return "\n".join(lines)


def main():
    subprocess.run(["cmake", "--build", BUILD, "-t", "samples"], check=True, stdout=subprocess.DEVNULL)
    text = subprocess.run([BUILD / "tests" / "samples", *sys.argv[1:]], check=True, stdout=subprocess.PIPE,
                          text=True).stdout
    RESULTS.with_suffix(".csv").write_text(text)
    page = RESULTS.with_suffix(".md")
    made = table(list(csv.DictReader(io.StringIO(text))))
    page.write_text(re.sub(r"<!-- table -->.*<!-- /table -->", f"<!-- table -->\n{made}\n<!-- /table -->",
                           page.read_text(), flags=re.S))


main()
