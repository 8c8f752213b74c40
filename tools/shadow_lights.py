#!/usr/bin/env python3
"""The tables of docs/results/shadows.md from the measurements of tools/shadow_lights.cpp.

    tools/shadow_lights.py CSV... [--page PAGE --mark NAME]

Prints the tables of one machine. Given several files, whose names end with a number of cores, it prints one
table of exact shadows. With --page they replace the text there between <!-- NAME --> and <!-- /NAME -->.
"""
import argparse
import csv
import math
import re
import sys

BUDGETS = (16, 33, 100)
TABLED = "1280x720"  # the size in the tables of one machine; the CSV has the others
NONE, EXACT = "shadows=none", "shadows=exact"
MAPS = {64: "shadows=map shadow-size=64", 256: "shadows=map shadow-size=256"}
NAMES = {NONE: "none", EXACT: "exact", MAPS[64]: "maps of 64", MAPS[256]: "maps of 256"}


class Series:
    """The rows of one scene and size, by setting, then by number of lights."""

    def __init__(self):
        self.rows = {}

    def add(self, row):
        self.rows.setdefault(row["shadows"], {})[int(row["lights"])] = row

    def of(self, setting):
        return sorted(self.rows.get(setting, {}).items())

    def both(self, a, b):
        return sorted(set(self.rows.get(a, {})) & set(self.rows.get(b, {})))


def read(path):
    groups, machine = {}, ""
    with open(path) as file:
        for row in csv.DictReader(file):
            machine = f"Commit {row['commit']}; {row['device']}."
            groups.setdefault((row["scene"], row["size"]), Series()).add(row)
    if not groups:
        sys.exit(f"{path}: holds no measurement")
    return groups, machine


def figure(value):
    if value >= 100 or value == 0:
        return f"{value:,.0f}"
    return f"{value:.3g}" if value >= 1 else f"{value:.2g}"


def fitting(points, budget):
    """The number of lights whose frame takes `budget` ms: between measured ones, times are powers of it."""
    points = [(n, max(ms, 1e-6)) for n, ms in points]
    if not points:
        return "–"
    if points[0][1] > budget:
        return f"< {points[0][0]}"
    for (n0, t0), (n1, t1) in zip(points, points[1:]):
        if t1 > budget:
            share = math.log(budget / t0) / math.log(t1 / t0)
            count = n0 * (n1 / n0) ** share
            return f"{float(f'{count:.2g}'):,.0f}"
    return f"> {points[-1][0]:,}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| --- | " + " | ".join("---:" for _ in head[1:]) + " |"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def lights_that_fit(groups, column):
    settings = [s for s in NAMES if s != NONE]
    head = ["scene"] + [f"{b} ms: {' / '.join(NAMES[s] for s in settings)}" for b in BUDGETS]
    rows = []
    for (scene, size), series in groups.items():
        if size != TABLED or len(series.of(EXACT)) < 2:
            continue
        timed = {s: [(n, float(r[column])) for n, r in series.of(s)] for s in NAMES}
        least = timed[NONE][0][1]  # with the fewest lights, without shadows
        cells = [" / ".join(fitting(timed[s], b) for s in settings) if least <= b else "0" for b in BUDGETS]
        rows.append([f"`{scene}`"] + cells)
    return table(head, rows)


def exact_by_cores(paths):
    cores = [int(re.search(r"(\d+)\.csv$", path)[1]) for path in paths]
    machines = [read(path) for path in paths]
    head = ["scene"] + [f"{b} ms: {' / '.join(map(str, cores))} cores" for b in BUDGETS]
    rows = []
    for scene, size in machines[-1][0]:
        if size != TABLED:
            continue
        points = []
        for groups, _ in machines:
            series = groups.get((scene, size), Series())
            points.append([(n, float(r["frame_ms"])) for n, r in series.of(EXACT)])
        if all(len(p) < 2 for p in points):
            continue
        cells = [" / ".join(fitting(p, b) for p in points) for b in BUDGETS]
        rows.append([f"`{scene}`"] + cells)
    return machines[-1][1] + "\n\n" + table(head, rows)


def break_even(groups):
    """Times of a ray, a look-up and a light's maps, by kernels, at the most lights that all of these have."""
    head = ["scene", "ray, ns", "pairs per light"]
    head += ["maps of 64: µs per light", "look-up, ns", "pay from pairs per light"]
    rows = []
    for (scene, size), series in groups.items():
        lights = [n for n in series.both(EXACT, MAPS[256]) if n in series.rows.get(MAPS[64], {})
                  and int(series.rows[EXACT][n]["pairs"]) > 0]
        if size != TABLED or not lights:
            continue
        n = lights[-1]
        exact = series.rows[EXACT][n]
        pairs, found = int(exact["pairs"]), int(exact["lights_found"])
        ray = float(exact["find_shadows_ms"]) * 1e6 / pairs
        cells = [f"`{scene}`, {n:,} lights", figure(ray), figure(pairs / found)]
        row = series.rows[MAPS[64]][n]
        drawn = int(row["maps_drawn"])
        a_light = float(row["draw_maps_ms"]) * 1e6 / drawn if drawn else 0
        look_up = float(row["find_shadows_ms"]) * 1e6 / pairs
        cells += [figure(a_light / 1e3), figure(look_up), figure(a_light / (ray - look_up)) if ray > look_up else "never"]
        rows.append(cells)
    return table(head, rows)


def replace(page, mark, text):
    """Puts the text between the page's marks."""
    with open(page) as file:
        whole = file.read()
    begin, end = f"<!-- {mark} -->\n", f"<!-- /{mark} -->"
    if whole.count(begin) != 1 or whole.count(end) != 1:
        sys.exit(f"{page}: has no place {begin.strip()} … {end}")
    with open(page, "w") as file:
        file.write(whole.split(begin)[0] + begin + "\n" + text + "\n\n" + end + whole.split(end)[1])


def report(description, text_of):
    """Prints what `text_of` makes of the named file, or writes it into --page at --mark."""
    parser = argparse.ArgumentParser(description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="CSV")
    parser.add_argument("--page")
    parser.add_argument("--mark")
    o = parser.parse_args()
    if bool(o.page) != bool(o.mark):
        parser.error("--page and --mark go together")
    text = text_of(*o.files)
    if o.page:
        replace(o.page, o.mark, text)
    else:
        print(text)


def tables(path, *others):
    if others:
        return exact_by_cores([path, *others])
    groups, machine = read(path)
    size = TABLED.replace("x", " × ")
    return "\n\n".join([
        machine,
        f"Lights that fit at {size}, by frame time:", lights_that_fit(groups, "frame_ms"),
        f"Where maps begin to pay at {size}, by kernel times:", break_even(groups)])


if __name__ == "__main__":
    report(__doc__, tables)
