"""Runs lightgrid for docs/results/first_light.md; see first_light.sh."""
import csv
import glob
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time

BUILD = sys.argv[1]
PROGRAM = os.path.join(BUILD, "src", "lightgrid")
FRAMES = os.environ.get("LIGHTGRID_FRAMES", "5")
SPONZA = os.environ.get("LIGHTGRID_SPONZA") or next(iter(glob.glob("../shared/scenes/large/Sponza/**/*.gltf", recursive=True)), "")
SPONZA_LIGHTS = os.environ.get("LIGHTGRID_SPONZA_LIGHTS", "../shared/bench/sponza_lights.json")
RESULTS = "docs/results/first_light"
SIZE = "1280x720"
# The passes between the prepass and shading: the reduction and culling, then the hand-overs.
GRID_PASSES = ["depth_bounds", "cull_lights", "cull_lights_for_blended"]
HAND_OVERS = ["depth_to_cl", "tile_distances"]

rows, table = [], []


def record(what, scene, size, lights, technique, values, unit):
    rows.append([what, scene, size, lights, technique, len(values), min(values), statistics.median(values), max(values), unit])


def line(*cells):
    table.append("| " + " | ".join(str(c) for c in cells) + " |")


def run(arguments, env=None):
    """Wall time and processor time in seconds, and peak resident bytes."""
    start = time.monotonic()
    process = subprocess.Popen([PROGRAM, *arguments], env={**os.environ, **(env or {})}, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.monotonic() - start
    if status:
        sys.exit(f"first_light: lightgrid {' '.join(arguments)} ended with status {os.waitstatus_to_exitcode(status)}")
    return seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def measure_hall(folder):
    command = ["render", "hall", "--size", "640x360", "-o", f"{folder}/hall.png"]

    def caches(name):
        path = f"{folder}/{name}"
        return {"XDG_CACHE_HOME": path, "POCL_CACHE_DIR": f"{path}/pocl", "MESA_SHADER_CACHE_DIR": f"{path}/mesa"}

    for name in ["a", "b", "c"]:
        os.makedirs(f"{folder}/{name}/pocl")
    cold_runs = [run(command, caches(name)) for name in ["a", "b", "c"]]
    warm_runs = [run(command, caches("a")) for _ in range(5)]
    for name, runs in [("empty", cold_runs), ("warm", warm_runs)]:
        record(f"wall, caches {name}", "hall", "640x360", "", "forward_plus", [r[0] for r in runs], "s")
        record(f"processor time, caches {name}", "hall", "640x360", "", "forward_plus", [r[1] for r in runs], "s")
    cold, warm = [r[0] for r in cold_runs], [r[0] for r in warm_runs]
    line("`render hall --size 640x360`, caches empty: wall time", f"{min(cold):.2f} / {statistics.median(cold):.2f} s", "6 s")
    line("the same, caches warm", f"{min(warm):.2f} / {statistics.median(warm):.2f} s", "1.0 s")


def share(row, names):
    return sum(p["median_ms"] for p in row["passes"] if p["name"] in names) / row["frame_ms"]["median"]


def record_row(row, lights):
    frame = row["frame_ms"]
    rows.append(["frame", "Sponza", SIZE, lights, row["technique"], frame["runs"], frame["min"], frame["median"], frame["max"], "ms"])
    for p in row["passes"]:
        record("pass " + p["name"], "Sponza", SIZE, lights, row["technique"], [p["median_ms"]], "ms")
    cell = f"{frame['min']:.0f} / {frame['median']:.0f} ms"
    target = {64: "130 ms", 255: "150 ms", 1024: "240 ms"}.get(lights) if row["technique"] == "forward_plus" else ""
    line(f"Sponza {SIZE}, {lights} lights, `{row['technique']}`: frame", cell, target)


def measure_sponza(folder):
    scene = [SPONZA, "--size", SIZE, "--lights-file", SPONZA_LIGHTS]
    for lights in [64, 255]:
        out = f"{folder}/row.json"
        run(["render", *scene, "--lights", str(lights), "--warmup", "1", "--frames", FRAMES, "--json", out, "-o", f"{folder}/a.png"])
        record_row(json.load(open(out)), lights)
    run(["compare", *scene, "--lights", "1024", "--warmup", "1", "--frames", FRAMES, "-o", f"{folder}/compare"])
    both = {r["technique"]: r for r in json.load(open(f"{folder}/compare/results.json"))["rows"]}
    plus, forward = both["forward_plus"], both["forward"]
    record_row(plus, 1024)
    record_row(forward, 1024)
    ratio = forward["frame_ms"]["median"] / plus["frame_ms"]["median"]
    record("forward / forward_plus", "Sponza", SIZE, 1024, "", [ratio], "ratio")
    line("the same: `forward` / `forward_plus`, medians of one run", f"{ratio:.1f}", "at least 10")
    grid, all_told = share(plus, GRID_PASSES), share(plus, GRID_PASSES + HAND_OVERS)
    record("depth bounds, cull and grid / frame", "Sponza", SIZE, 1024, "forward_plus", [grid], "ratio")
    record("the same with hand-overs / frame", "Sponza", SIZE, 1024, "forward_plus", [all_told], "ratio")
    line("the same: depth bounds, cull and grid, of the frame", f"{100 * grid:.1f} % ({100 * all_told:.1f} % with the hand-overs)", "5 %")
    line("the same: pairs lost, wrong; NaN pixels; image against `forward`",
         f"{plus['pairs']['lost']}, {plus['pairs']['wrong']}; {plus['nan_pixels']}; "
         + ("bit-identical" if plus["error"]["bit_identical"] else "differs"), "0, 0; 0; bit-identical")
    _, _, peak = run(["render", *scene, "--lights", "1024", "-o", f"{folder}/a.png"])
    record("peak resident memory", "Sponza", SIZE, 1024, "forward_plus", [peak], "B")
    line(f"`render` of Sponza {SIZE} with 1024 lights: peak resident memory", f"{peak / 1e6:.0f} MB", "700 MB")


def measure_depth_read():
    for size in [SIZE, "3840x2160"]:
        out = subprocess.run([os.path.join(BUILD, "tools", "depth_read"), size, "100"], capture_output=True, text=True, check=True).stdout
        count, read_min, read_median, bounds_min, bounds_median = (float(x) for x in out.split())
        rows.append(["plain read on the device", "", size, "", "", 100, read_min, read_median, "", "ms"])
        rows.append(["depth bounds on the device", "", size, "", "", 100, bounds_min, bounds_median, "", "ms"])
        line(f"depth bounds {size}, {count / 1e6:.1f} MB, against a plain read: medians on the device",
             f"{bounds_median:.3f} / {read_median:.3f} ms = {bounds_median / read_median:.2f}", "2")


def machine():
    devices = json.loads(subprocess.run([PROGRAM, "devices", "--json", "-"], capture_output=True, text=True, check=True).stdout)
    cl = next(d for d in devices["cl"] if d["chosen"])
    gl = next(d for d in devices["gl"] if d["chosen"])
    commit = subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=10"], capture_output=True, text=True).stdout.strip()
    return [commit or "unknown", f"{cl['name']} ({cl['driver']})", f"{gl['renderer']} ({gl['version']})", os.cpu_count()]


def put_table(text):
    path = RESULTS + ".md"
    page = open(path).read()
    page = re.sub(r"<!-- table -->.*<!-- /table -->", lambda _: f"<!-- table -->\n{text}\n<!-- /table -->", page, flags=re.S)
    open(path, "w").write(page)


def main():
    commit, cl, gl, cores = machine()
    line("what", "least / median", "wanted")
    line("---", "---:", "---:")
    with tempfile.TemporaryDirectory() as folder:
        measure_hall(folder)
        if os.path.isfile(SPONZA) and os.path.isfile(SPONZA_LIGHTS):
            measure_sponza(folder)
        else:
            print("first_light: Sponza is left out: set LIGHTGRID_SPONZA and LIGHTGRID_SPONZA_LIGHTS", file=sys.stderr)
    measure_depth_read()
    with open(RESULTS + ".csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["commit", "cl", "gl", "cores", "what", "scene", "size", "lights", "technique", "runs", "min", "median", "max", "unit"])
        out.writerows([commit, cl, gl, cores, *row] for row in rows)
    text = f"Commit {commit}; {cl}; {gl}; {cores} cores.\n\n" + "\n".join(table)
    put_table(text)
    print(text)


main()
