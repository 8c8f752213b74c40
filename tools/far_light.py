#!/usr/bin/env python3
"""Measures docs/results/far_light.md: writes far_light.csv beside the page, and its tables between the page's marks.

    tools/far_light.py [--budget MINUTES] [ARGUMENT OF frontier...]     needs a built tree, an idle machine

Points: visibility with ranges that end at a cutoff, without far light and with volumes of several sizes.
"""
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = pathlib.Path(os.environ.get("LIGHTGRID_BUILD", ROOT / "build")) / "src" / "lightgrid"
RESULTS = ROOT / "docs" / "results" / "far_light"
CUTOFFS = ["1", "0.5", "0.2", "0.05", "0.01"]
SAMPLES = ["off", "512", "4096", "32768"]
TABLED = "4096"  # in the page's table
COLUMNS = ["scene", "cutoff", "far_light", "relative_time", "low", "high", "ms", "displayed_flip", "energy_rel",
           "rel_mse_trimmed", "on_front"]


def points():
    for cutoff in CUTOFFS:
        for samples in SAMPLES:
            far = "" if samples == "off" else f",far-light={samples}"
            yield f"visibility:range=cutoff,cutoff={cutoff}{far}"
    yield "visibility:range=infinite"


def measured(arguments):
    with tempfile.TemporaryDirectory() as folder:
        named = [word for point in points() for word in ("-t", point)]
        subprocess.run([PROGRAM, "frontier", *arguments, *named, "-o", folder], check=True, stdout=sys.stderr)
        answer = json.loads((pathlib.Path(folder) / "frontier.json").read_text())
    for point in answer["points"]:
        settings, total = point["settings"], point["error"]["total"]
        time, ms = point["relative_device_time"], point["device_ms"]["median"]
        if not time:  # no device has a clock
            time, ms = point["relative_time"], point["frame_ms"]["median"]
        yield {
            "scene": pathlib.Path(point["scene"]).stem,
            "cutoff": settings["cutoff"] if settings["range"] == "cutoff" else "none",
            "far_light": settings.get("far_light", "off"),
            "relative_time": f"{time['estimate']:.3f}", "low": f"{time['ci95'][0]:.3f}", "high": f"{time['ci95'][1]:.3f}",
            "ms": f"{ms:.3g}",
            "displayed_flip": f"{total['displayed_flip']['mean']:.4f}", "energy_rel": f"{total['energy_rel']:+.4f}",
            "rel_mse_trimmed": f"{total['rel_mse_trimmed']:.3g}",
        }


def mark_front(rows):
    """No other row of the scene has at most the FLIP in at most the time, and less of one."""
    key = lambda r: (float(r["displayed_flip"]), float(r["relative_time"]))
    for r in rows:
        others = [key(o) for o in rows if o["scene"] == r["scene"] and key(o) != key(r)]
        r["on_front"] = not any(f <= key(r)[0] and t <= key(r)[1] for f, t in others)


def table(rows):
    """A row per cutoff without far light and with TABLED samples, a column per scene; the CSV has the others."""
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    of = {(r["cutoff"], r["far_light"], r["scene"]): r for r in rows}
    lines = ["| cutoff | far light | " + " | ".join(f"`{s}`" for s in scenes) + " |",
             "| ---: | ---: | " + " | ".join("---:" for _ in scenes) + " |"]
    for cutoff, far in dict.fromkeys((r["cutoff"], r["far_light"]) for r in rows if r["far_light"] in ("off", TABLED)):
        cells = [of[cutoff, far, s] for s in scenes]
        lines.append(f"| {cutoff} | {far} | " + " | ".join(
            f"{float(r['relative_time']):.2f} / {float(r['displayed_flip']):.3f} / {100 * float(r['energy_rel']):+.0f}" for r in cells) + " |")
    return "\n".join(lines)


def main():
    rows = list(measured(sys.argv[1:] or ["hall", "street", "terrain", "spheres", "--size", "640x360", "--budget", "8"]))
    mark_front(rows)
    with open(RESULTS.with_suffix(".csv"), "w", newline="") as out:
        writer = csv.DictWriter(out, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    page = RESULTS.with_suffix(".md")
    page.write_text(re.sub(r"<!-- table -->.*<!-- /table -->", lambda _: f"<!-- table -->\n{table(rows)}\n<!-- /table -->",
                           page.read_text(), flags=re.S))


main()
