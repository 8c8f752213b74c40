#!/usr/bin/env python3
"""Prints the table of docs/capped_lists.md and writes docs/results/capped_lists.csv: lists that end as engines' do.

    tools/capped_lists.py                     compares, a few minutes a scene
    tools/capped_lists.py --sponza FILE.gltf  Sponza too, which is not in this checkout
    tools/capped_lists.py --keep FOLDER       keeps results.json of each scene there, and reads what is there

Needs a built tree (build/, or LIGHTGRID_BUILD). No times: a list is built whole and then cut, which no engine does.
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = pathlib.Path(os.environ.get("LIGHTGRID_BUILD", ROOT / "build")) / "src" / "lightgrid"
CAPS = [("visibility", "list_cap", 64, "64 a tile"), ("visibility", "list_cap", 32, "32 a tile"),
        ("clustered", "list_cap", 32, "32 a cell"), ("forward_zprepass", "list_cap", 8, "8 a mesh"),
        ("visibility", "view_cap", 256, "256 a view"), ("visibility", "view_cap", 64, "64 a view")]
ORDERS = ["index", "distance", "brightest"]
# Name, and arguments of compare besides the scene.
SCENES = [("hall", []), ("street", []), ("terrain", []), ("gallery", []),
          ("hall", ["--lights", "1024", "--light-radius", "2,4"]),
          ("street", ["--lights", "1024", "--light-radius", "8,18"]),
          ("terrain", ["--lights", "1024", "--light-radius", "8,16"]),
          ("gallery", ["--lights", "1024", "--light-radius", "2,4"]),
          ("sponza", ["--lights", "1024", "--light-radius", "2,4"])]


def contestants():
    names = ["forward"]
    for technique, key, cap, _ in CAPS:
        setting = f"{technique}:{key.replace('_', '-')}={cap}"
        names += [setting] if key == "view_cap" else [f"{setting},list-cap-order={order}" for order in ORDERS]
    return ",".join(names)


def results_of(name, scene, more, folder):
    file = pathlib.Path(folder) / f"{name}.json"
    if not file.exists():
        done = subprocess.run([PROGRAM, "compare", scene, *more, "--size", "1280x720", "--frames", "1", "--warmup", "0",
                               "--reference", "full", "-t", contestants(), "-o", pathlib.Path(folder) / name, "--json", file])
        if done.returncode not in (0, 1):  # 1: lost pairs, which the table shows
            sys.exit(f"capped_lists: compare {scene} ended with status {done.returncode}")
    return json.load(open(file))["rows"]


def figures(row):
    error = row["same_surfaces"] or row["error"]
    limited, pairs = row["limited"], row["pairs"]
    return {"lost": pairs["lost"], "lit": pairs["lit"], "lost_light": limited["lost_light"],
            "visible_share": error["displayed_flip"]["visible_share"], "flip_mean": error["displayed_flip"]["mean"],
            "step_at_borders": limited["step_at_borders"], "step_inside": limited["step_inside"]}


def percent(value):
    return "0" if value == 0 else f"{100 * value:.2g}" if abs(value) < 0.0995 else f"{100 * value:.0f}"


def cell(f):
    return f"{percent(float(f['lost_light']))} / {percent(float(f['visible_share']))}"


def table(rows):
    """Lost light and visibly different pixels, by order; without caps of which at most 1 % of the pixels look different."""
    lines = ["| scene, lights, lit per pixel | list | `index` | `distance` | `brightest` |", "| --- | --- | ---: | ---: | ---: |"]
    for scene, lights, words in dict.fromkeys((r["scene"], r["lights"], r["cap"]) for r in rows):
        found = {r["order"]: r for r in rows if (r["scene"], r["lights"], r["cap"]) == (scene, lights, words)}
        if words == "64 a view" or all(float(r["visible_share"]) <= 0.01 for r in found.values()):
            continue
        lit = int(next(iter(found.values()))["lit"]) / (1280 * 720)
        cells = [cell(found[order]) if order in found else "" for order in ORDERS]
        lines.append(f"| `{scene}`, {lights}, {lit:.1f} | {words.replace(' a ', ' per ')} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--sponza")
    parser.add_argument("--keep")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        for scene, more in SCENES:
            file = options.sponza if scene == "sponza" else scene
            if not file:
                continue
            lights = more[1] if more else "own"
            name = scene + (f"_{lights}" if more else "")
            of_scene = [r for r in results_of(name, file, more, options.keep or temporary) if "limited" in r]
            for technique, key, cap, words in CAPS:
                found = {}
                for r in of_scene:
                    if r["technique"] == technique and r["settings"][key] == cap:
                        found[r["settings"].get("list_cap_order", "distance")] = figures(r)
                for order, f in found.items():
                    rows.append({"scene": scene, "lights": lights, "technique": technique, "cap": words, "order": order, **f})
    print(table(rows))
    with open(ROOT / "docs" / "results" / "capped_lists.csv", "w", newline="") as out:
        writer = csv.DictWriter(out, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


main()
