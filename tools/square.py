#!/usr/bin/env python3
"""Makes the tables of docs/results/square.md and square.csv beside it: all techniques on the scene `square`.

    tools/square.py            ratios of times, memory and bytes
    tools/square.py --times    milliseconds too: nothing else should run on the machine
    tools/square.py --times --device NVIDIA --gl egl
                                          with more arguments of compare: prints the tables and writes nothing

Needs a built tree (build/, or LIGHTGRID_BUILD). LIGHTGRID_FRAMES: frames a measurement (default 3);
LIGHTGRID_SIZE: of the images (default 1280x720).
"""
import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = pathlib.Path(os.environ.get("LIGHTGRID_BUILD", ROOT / "build")) / "src" / "lightgrid"
FRAMES = os.environ.get("LIGHTGRID_FRAMES", "3")
SIZE = os.environ.get("LIGHTGRID_SIZE", "1280x720")
PIXELS = int(SIZE.split("x")[0]) * int(SIZE.split("x")[1])
RESULTS = ROOT / "docs" / "results" / "square"
BASE = "forward_plus"  # ratios are to it
COUNTS = [1, 4, 16, 64, 300]
SCATTERED = ["--lights", 3000, "--light-radius", "3,8"]
MORE = []  # arguments of compare, from the command line
OF_THE_ARTICLE = ["forward", "forward_zprepass", "deferred", "forward_plus"]
EXACT = 1e-5  # relative to the brightest channel: src/laboratory/report/report.h


def program(*arguments):
    """Its standard output; a failed gate (status 1) is what the tables show."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"square: lightgrid {' '.join(map(str, arguments))} ended with status {done.returncode}")
    return done.stdout


def compare(folder, techniques, *more):
    program("compare", "square", "--size", SIZE, "-t", ",".join(techniques), "--frames", FRAMES, "--reference", "full",
            "-o", folder, *more, *MORE)
    return json.load(open(f"{folder}/results.json"))


def milliseconds(row):
    return row["frame_ms"]["median"]


def moved(row):
    return sum(p["bytes_read"] + p["bytes_written"] for p in row["passes"])


def light_error(row):
    """Against every light on the same surfaces."""
    return (row["same_surfaces"] or row["error"])["max_rel"]


def all_techniques():
    return [t["name"] for t in json.loads(program("techniques", "--json", "-"))["techniques"]]


def technique_table(results, times):
    rows = results["rows"]
    base = next(milliseconds(r) for r in rows if r["technique"] == BASE)
    heads = [f"relative time", *(["ms"] if times else []), "buffers, B per pixel", "geometry buffer",
             "moved, B per pixel", "listed per pixel", "lost", "image"]
    lines = ["| technique | " + " | ".join(heads) + " |", "| --- |" + " ---: |" * len(heads)]
    for r in rows:
        memory, pairs = r["memory_bytes"], r["pairs"]
        listed = f"{pairs['listed'] / PIXELS:.1f}" if pairs else "-"
        lost = f"{pairs['lost']:,}" if pairs else "-"
        error = light_error(r)
        image = "bit-identical" if r["same_surfaces"] and r["same_surfaces"]["bit_identical"] else \
                f"exact ({error:.0e})" if error <= EXACT else f"off by {error:.0e}"
        cells = [f"{milliseconds(r) / base:.2f}", *([f"{milliseconds(r):.0f}"] if times else []),
                 f"{memory['total'] / PIXELS:.0f}", f"{memory['gbuffer'] / PIXELS:.0f}", f"{moved(r) / PIXELS:.0f}", listed,
                 lost, image]
        lines.append(f"| `{r['technique']}` | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def count_table(results, times):
    """How the article's techniques grow with the number of lights: ratios to forward_plus of the same run."""
    lines = ["| lights | " + " | ".join(f"`{t}`" for t in OF_THE_ARTICLE) + " |", "| ---: |" + " ---: |" * len(OF_THE_ARTICLE)]
    for count, one in results.items():
        at = {r["technique"]: milliseconds(r) for r in one["rows"]}
        cells = [f"{at[t] / at[BASE]:.2f}" + (f" ({at[t]:.0f} ms)" if times else "") for t in OF_THE_ARTICLE]
        lines.append(f"| {count} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def processor_time(scene, frames, folder):
    """Processor time in seconds and peak resident bytes of `render`."""
    command = [PROGRAM, "render", scene, "-t", "visibility", "--size", SIZE, "--frames", frames, "-o", f"{folder}/a.png"]
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        sys.exit(f"square: render {scene} ended with status {os.waitstatus_to_exitcode(status)}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def visibility_table(folder, times):
    lines = ["| scene | frame, processor time relative to `street` | " + ("ms per frame | " if times else "") + "start, processor time | peak memory |",
             "| --- | ---: |" + (" ---: |" if times else "") + " ---: | ---: |"]
    frame, cells = {}, {}
    for scene in ["street", "square"]:
        processor_time(scene, 1, folder)  # compiles what is not in a cache yet
        start, peak = processor_time(scene, 1, folder)
        frame[scene] = (processor_time(scene, 31, folder)[0] - start) / 30
        wall = ""
        if times:
            program("render", scene, "-t", "visibility", "--size", SIZE, "--frames", 30, "--warmup", 3, "-o", f"{folder}/a.png",
                    "--json", f"{folder}/a.json")
            wall = f" {milliseconds(json.load(open(f'{folder}/a.json'))):.1f} |"
        cells[scene] = f"{wall} {start:.2f} s | {peak / 1e6:.0f} MB |"
    for scene in frame:
        lines.append(f"| `{scene}` | {frame[scene] / frame['street']:.1f} |" + cells[scene])
    return "\n".join(lines)


def write_csv(whole, counts, times):
    with open(f"{RESULTS}.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["commit", "lights", "technique", "time_ratio", "median_ms", "memory", "gbuffer", "light_grid", "moved_bytes",
                      "listed", "lit", "lost", "wrong", "max_rel"])
        for count, results in [("300", whole), *((str(n), r) for n, r in counts.items())]:
            base = next(milliseconds(r) for r in results["rows"] if r["technique"] == BASE)
            for r in results["rows"]:
                memory, pairs = r["memory_bytes"], r["pairs"] or {}
                out.writerow([results["commit"], count, r["technique"], f"{milliseconds(r) / base:.4f}",
                              f"{milliseconds(r):.3f}" if times else "", memory["total"], memory["gbuffer"], memory["light_grid"],
                              moved(r), *(pairs.get(k, "") for k in ("listed", "lit", "lost", "wrong")), light_error(r)])


def put(page, name, text):
    found = re.search(rf"<!-- {name} -->.*<!-- /{name} -->", page, re.S)
    if not found:
        sys.exit(f"square: {RESULTS}.md has no mark {name}")
    return page[:found.start()] + f"<!-- {name} -->\n{text}\n<!-- /{name} -->" + page[found.end():]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", action="store_true", help="milliseconds too")
    choice, more = parser.parse_known_args()
    MORE.extend(more)
    times = choice.times
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        whole = compare(f"{folder}/all", all_techniques())
        program("capture", "square", "--size", "160x90", "-o", f"{folder}/capture")
        lights = json.load(open(f"{folder}/capture/lights.json"))["lights"]
        counts = {}
        for n in COUNTS:
            # Every so many-th light: the scene lists them kind by kind.
            some = {"lights": [lights[i * len(lights) // n] for i in range(n)]}
            json.dump(some, open(f"{folder}/some.json", "w"))
            counts[n] = compare(f"{folder}/{n}", OF_THE_ARTICLE, "--lights-file", f"{folder}/some.json")
        counts["3000 scattered"] = compare(f"{folder}/scattered", OF_THE_ARTICLE, *SCATTERED)
        devices = f"{whole['devices']['cl']}; {whole['devices']['gl']}"
        tables = {"techniques": f"Commit {whole['commit']}; {devices}; {SIZE}.\n\n" + technique_table(whole, times),
                  "counts": count_table(counts, times)}
        if not MORE:
            tables["visibility"] = visibility_table(folder, times)
    print("\n\n".join(tables.values()) + f"\n\n{(time.monotonic() - started) / 60:.1f} minutes")
    if MORE:
        return
    page = open(f"{RESULTS}.md").read()
    for name, text in tables.items():
        page = put(page, name, text)
    open(f"{RESULTS}.md", "w").write(page)
    write_csv(whole, counts, times)


main()
