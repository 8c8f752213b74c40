"""Runs lightgrid for docs/results/comparison.md; see comparison.sh."""
import csv
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

BUILD, MORE = sys.argv[1], sys.argv[2:]
PROGRAM = os.path.join(BUILD, "src", "lightgrid")
FRAMES = os.environ.get("LIGHTGRID_FRAMES", "3")
SCENES = ["hall", "spheres", "terrain", "street", "gallery"]
SIZE = os.environ.get("LIGHTGRID_SIZE", "1280x720")
RESULTS = "docs/results/comparison"
EXACT = 1e-5  # relative to the brightest channel: src/laboratory/report/report.h
# Techniques that are shown with more than their defaults.
VARIANTS = {
    "deferred": ["deferred", "deferred:buffer-bits=8"],
    "deferred_tiled": ["deferred_tiled", "deferred_tiled:buffer-bits=8"],
    "lidr": [*(f"lidr:lidr-overlap={n}" for n in (1, 2, 4, 8, 16)),
             *(f"lidr:lidr-overlap=4,lidr-packing={p}" for p in ("maxblend", "sort"))],
}


def all_techniques():
    listed = subprocess.run([PROGRAM, "techniques", "--json", "-"], check=True, capture_output=True, text=True).stdout
    names = [t["name"] for t in json.loads(listed)["techniques"]]
    return [row for name in names for row in VARIANTS.get(name, [name])]


def compare(folder):
    """Seconds taken, and the command as a reader types it."""
    arguments = ["compare", *SCENES, "--size", SIZE, "-t", ",".join(all_techniques()), "--frames", FRAMES, "--page-mb", "6", *MORE]
    start = time.monotonic()
    status = subprocess.run([PROGRAM, *arguments, "-o", folder], stdout=subprocess.DEVNULL).returncode
    if status not in (0, 1):  # 1: a gate failed, which the table says
        sys.exit(f"comparison: lightgrid ended with status {status}")
    return time.monotonic() - start, shlex.join(["lightgrid", *arguments])


def cell(row, best):
    if row["refused"]:
        return "refused"
    text = f"{float(row['median_ms']):,.0f}"
    faults = [f"{int(row[key]):,} {key}" for key in ("lost", "wrong") if int(row[key])]
    if int(row["nan_pixels"]):
        faults.append(f"{row['nan_pixels']} NaN")
    if faults:
        return f"{text} ({', '.join(faults)})"
    if not (light_error(row) <= EXACT):
        return f"{text} (off by {light_error(row):.1e})"
    return f"**{text}**" if row is best else text


def light_error(row):
    """Against every light on the same surfaces; in older tables, on OpenGL's."""
    return float(row.get("same_surfaces_max_rel") or row["max_rel"] or "nan")


def is_exact(row):
    counts = [row["lost"], row["wrong"], row["nan_pixels"]]
    return not row["refused"] and all(int(n) == 0 for n in counts) and light_error(row) <= EXACT


def table_of(rows):
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    at = {(r["row"], r["scene"]): r for r in rows}
    best = {s: min((r for r in rows if r["scene"] == s and is_exact(r)), key=lambda r: float(r["median_ms"])) for s in scenes}
    heads = [f"`{s}`, {at[rows[0]['row'], s]['lights']} lights" for s in scenes]
    lines = ["| technique | " + " | ".join(heads) + " |", "| --- |" + " ---: |" * len(scenes)]
    for name in dict.fromkeys(r["row"] for r in rows):
        lines.append(f"| `{name}` | " + " | ".join(cell(at[name, s], best[s]) for s in scenes) + " |")
    return "\n".join(lines)


def put_table(text):
    path = RESULTS + ".md"
    page = open(path).read()
    page = re.sub(r"<!-- table -->.*<!-- /table -->", lambda _: f"<!-- table -->\n{text}\n<!-- /table -->", page, flags=re.S)
    open(path, "w").write(page)


def main():
    with tempfile.TemporaryDirectory() as folder:
        seconds, command = compare(folder)
        os.makedirs("out", exist_ok=True)
        shutil.copy(os.path.join(folder, "index.html"), "out/comparison.html")
        shutil.copy(os.path.join(folder, "results.csv"), RESULTS + ".csv")
    rows = list(csv.DictReader(open(RESULTS + ".csv", newline="")))
    first = rows[0]
    head = f"Commit {first['commit']}; {first['cl']}; {first['gl']}; {os.cpu_count()} cores. {seconds / 60:.1f} minutes.\n\n    {command}\n\n"
    text = head + table_of(rows)
    put_table(text)
    print(text)


main()
