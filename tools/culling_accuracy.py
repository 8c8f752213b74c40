#!/usr/bin/env python3
"""Accuracy of the light lists against time, for every cull test, depth bounds and tile size.

    tools/culling_accuracy.py --frames DIR [--only RE] [--rounds N] [--runs N] [--threads N]
                                         [--program FILE] [--csv FILE] [--doc FILE] [--from-csv]

DIR holds one folder a frame. Those that are missing are made: the standard frames floor with 256, 1024 and 4096 lights
and spheres with 1024 at 1920x1080, and captures at 1280x720 of the built-in scenes spheres and hall with 1024 lights
and, where ../shared has it, of Sponza with 1024. Frames of other names in DIR are left alone.

Accuracy is counted once, since the lists are the same bytes each time (`lightgrid inspect --compare`, the oracle in
double). Times are those of `lightgrid bench --compare`, settings in turn, least of all rounds. The CSV has one line a
setting of a frame; --doc puts the tables between the markers of that page; --from-csv only does that.
"""
import argparse
import csv
import json
import os
import re
import statistics
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TESTS = ["sphere", "planes", "aabb", "planes+aabb", "exact"]
BOUNDS = ["none", "minmax", "halfz", "halfz-modified", "mask32"]
TILES = [8, 16, 32, 64]
SHADING_NS = [0.85, 3.5]  # a listed (pixel, light) pair: as a 16-wide OpenCL kernel, as an OpenGL shader on a CPU
CHOICE_NS = [0, 0.1, *SHADING_NS]
TILED = ["floor1024", "spheres-scene", "hall-scene"]  # in the page's table of tile sizes; the CSV has all frames
STANDARD = {"floor256": "floor-256", "floor1024": "floor-1024", "floor4096": "floor-4096", "spheres1024": "spheres-1024"}
SPONZA = os.path.join(ROOT, "..", "shared", "scenes", "large", "Sponza", "Sponza.gltf")
SPONZA_LIGHTS = os.path.join(ROOT, "..", "shared", "bench", "sponza_lights.json")
COLUMNS = ["commit", "device", "threads", "frame", "width", "height", "tile", "cull_test", "depth_bounds", "listed",
           "lit", "lost", "perfect", "tiles_lit", "tiles_in_vain", "tile_p99", "tile_worst", "runs", "min_ms"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames")
    parser.add_argument("--only", default="")
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--runs", type=int, default=15)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "src", "lightgrid"))
    parser.add_argument("--csv", default=os.path.join(ROOT, "docs", "results", "culling_accuracy.csv"))
    parser.add_argument("--doc", default=os.path.join(ROOT, "docs", "results", "culling.md"))
    parser.add_argument("--from-csv", action="store_true")
    args = parser.parse_args()
    if not args.frames and not args.from_csv:
        parser.error("--frames is missing")
    return args


def run(command, threads=0):
    environment = dict(os.environ)
    if threads:
        environment.update(POCL_AFFINITY="1", POCL_MAX_PTHREAD_COUNT=str(threads))
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode:  # inspect ends with 1 where a light is lost
        sys.exit(f"culling_accuracy: {' '.join(command)} ended with {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def captures():
    """Arguments of `capture`, by frame."""
    found = {f"{name}-scene": [name, "--lights", "1024"] for name in ("spheres", "hall")}
    if os.path.isfile(SPONZA) and os.path.isfile(SPONZA_LIGHTS):
        found["sponza"] = [SPONZA, "--lights-file", SPONZA_LIGHTS]
    else:
        print("culling_accuracy: no Sponza in ../shared; left out", file=sys.stderr)
    return found


def make_frames(args):
    """Folders of frames by name, in the order of the tables."""
    folders = {}
    for name, case in STANDARD.items():
        folder = os.path.join(args.frames, name)
        if not os.path.isdir(folder):
            run([args.program, "bench", "--filter", f"^{case}/", "--write-frames", args.frames])
            folder = os.path.join(args.frames, case)
        folders[name] = folder
    for name, scene in captures().items():
        folders[name] = os.path.join(args.frames, name)
        if not os.path.isdir(folders[name]):
            run([args.program, "capture", *scene, "--size", "1280x720", "-o", folders[name]])
    return {name: folder for name, folder in folders.items() if re.search(args.only, name)}


def comparison():
    return ["--compare", "cull-test=" + ",".join(TESTS), "--compare", "depth-bounds=" + ",".join(BOUNDS)]


def measure_accuracy(args, folder):
    """{(tile, test, bounds): row}."""
    tiles = ",".join(str(tile) for tile in TILES)
    report = json.loads(run([args.program, "inspect", folder, *comparison(), "--compare", f"tile={tiles}", "--json", "-"]))
    rows = {}
    for found in report["rows"]:
        chosen = dict(part.split("=") for part in found["compared"].split())
        key = (int(chosen["tile"]), chosen["cull-test"], chosen["depth-bounds"])
        pairs, tiles_of = found["pairs"], found["tiles"]
        rows[key] = {"width": report["size"][0], "height": report["size"][1], "tile": key[0], "cull_test": key[1],
                     "depth_bounds": key[2], **pairs, "tiles_lit": tiles_of["lit"], "tiles_in_vain": tiles_of["in_vain"],
                     "tile_p99": round(tiles_of["p99"], 4), "tile_worst": round(tiles_of["worst"], 4)}
    return rows


def measure_time(args, folder, rows):
    for number in range(args.rounds):
        for tile in TILES[::1 if number % 2 == 0 else -1]:
            report = json.loads(run([args.program, "bench", "--replay", folder, "--filter", "/pipeline$", "--set",
                                     f"tile={tile}", *comparison(), "--frames", str(args.runs), "--json", "-"],
                                    args.threads))
            for found in report["rows"]:
                chosen = dict(part.split("=") for part in found["params"]["compared"].split())
                row = rows[(tile, chosen["cull-test"], chosen["depth-bounds"])]
                row["min_ms"] = round(min(row.get("min_ms", found["min_ms"]), found["min_ms"]), 4)
                row["runs"] = row.get("runs", 0) + found["runs"]
                row["commit"] = report["machine"]["commit"]
                row["device"] = f"{report['machine']['device']} ({report['machine']['driver']})"


def measure(args):
    rows = []
    for name, folder in make_frames(args).items():
        of_frame = measure_accuracy(args, folder)
        measure_time(args, folder, of_frame)
        rows += [{"frame": name, "threads": args.threads, **row} for row in of_frame.values()]
        print(f"culling_accuracy: {name}", file=sys.stderr)
    with open(args.csv, "w", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        out.writeheader()
        out.writerows(rows)


class Results:
    def __init__(self, path):
        self.at = {}
        with open(path) as file:
            for row in csv.DictReader(file):
                self.at[(row["frame"], int(row["tile"]), row["cull_test"], row["depth_bounds"])] = row
        self.frames = list(dict.fromkeys(key[0] for key in self.at))

    def ratio(self, *place, of="listed"):
        row = self.at[place]
        return int(row[of]) / int(row["lit"])

    def ms(self, *place, shading_ns=0.0):
        row = self.at[place]
        return float(row["min_ms"]) + int(row["listed"]) * shading_ns * 1e-6


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1),
            *("| " + " | ".join(row) + " |" for row in rows)]


def mean(values):
    return statistics.geometric_mean(list(values))


def bounds_table(found):
    """Every test and every bound at 16 pixels: listed / lit and milliseconds, geometric means over the frames."""
    def cell(test, bounds):
        places = [(frame, 16, test, bounds) for frame in found.frames]
        return f"{mean(found.ratio(*p) for p in places):.2f} / {mean(found.ms(*p) for p in places):.2f}"
    return table(["cull test"] + [f"`{bounds}`" for bounds in BOUNDS],
                 [[f"`{test}`"] + [cell(test, bounds) for bounds in BOUNDS] for test in TESTS])


def tile_table(found):
    rows = []
    for frame in (f for f in found.frames if f in TILED):
        for tile in TILES:
            cells = [frame, str(tile), f"{found.ratio(frame, tile, 'exact', 'minmax', of='perfect'):.2f}"]
            for test, bounds in [("planes+aabb", "minmax"), ("exact", "halfz-modified")]:
                place = (frame, tile, test, bounds)
                cells.append(f"{found.ratio(*place):.2f} / {float(found.at[place]['tile_p99']):.0f} / {found.ms(*place):.2f}")
            rows.append(cells)
    return table(["frame", "tile", "perfect list", "`planes+aabb`, `minmax`", "`exact`, `halfz-modified`"], rows)


def choice_table(found):
    """Cost relative to the default: geometric mean over the frames."""
    settings = [(test, bounds, tile) for tile in (16, 8) for bounds in ("minmax", "halfz-modified")
                for test in ("planes+aabb", "exact")]
    rows = []
    for test, bounds, tile in settings:
        cells = [f"`{test}` `{bounds}` {tile}"]
        for ns in CHOICE_NS:
            ratios = [found.ms(frame, tile, test, bounds, shading_ns=ns) /
                      found.ms(frame, 16, "planes+aabb", "minmax", shading_ns=ns) for frame in found.frames]
            cells.append(f"{mean(ratios):.2f}")
        rows.append(cells)
    return table(["setting", *(f"{ns} ns per pair" for ns in CHOICE_NS)], rows)


def total_line(found):
    rows = found.at.values()
    first = next(iter(rows))
    commits = ", ".join(sorted({row["commit"] for row in rows}))
    return [f"Commit {commits}; {first['device']}, {first['threads']} thread(s). {len(found.at)} settings of "
            f"{len(found.frames)} frames; pairs lost: {sum(int(row['lost']) for row in rows)}."]


def fill(text, name, lines):
    pattern = re.compile(rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)", re.S)
    if not pattern.search(text):
        sys.exit(f"culling_accuracy: the page has no <!-- {name} --> ... <!-- /{name} -->")
    return pattern.sub(lambda m: m[1] + "\n".join(lines) + "\n" + m[2], text)


def main():
    args = arguments()
    if not args.from_csv:
        measure(args)
    found = Results(args.csv)
    with open(args.doc) as file:
        text = file.read()
    for name, make in [("total", total_line), 
                       ("choice", choice_table), ("tiles", tile_table), ("bounds", bounds_table)]:
        text = fill(text, name, make(found))
    with open(args.doc, "w") as file:
        file.write(text)


main()
