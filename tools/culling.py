#!/usr/bin/env python3
"""The culling pipeline on captured frames, against a prototype, against itself and against an earlier build, in one go.

    tools/culling.py --frames DIR [--prototype DIR] [--against FILE] [--rounds N] [--runs N] [--threads 1,2]
                                [--only RE] [--of median|least] [--program FILE] [--csv FILE] [--table FILE]

DIR holds one folder a frame; where it is absent, the standard frames are written there first. The prototype's folder
holds `drv7` and `cull7.cl`; its program writes a `lights.bin` into each frame's folder. `--against` is the program of
an earlier build; the two then run with their defaults alone. PoCL only: the number of threads is PoCL's. In each round
each program runs once on each frame with each number of threads, in an order that turns around from round to round. The
table gives two figures each: of the least times of all rounds, and the median over the rounds, where a ratio is one of
two medians of that round. Nothing else should run on the machine; where something does, `--of least` takes a round's
least times for its medians.

The CSV has one line for each row of each round:
  commit,device,cores,round,frame,lights,threads,program,settings,row,runs,min_ms,median_ms,p90_ms
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
COLUMNS = ["commit", "device", "cores", "round", "frame", "lights", "threads", "program", "settings", "row", "runs",
           "min_ms", "median_ms", "p90_ms"]
# Comparisons within lightgrid, where the program has the setting; the first is the default.
COMPARISONS = [("cull-test", ["planes+aabb", "exact"]), ("portable", ["off", "on"])]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", required=True)
    parser.add_argument("--prototype")
    parser.add_argument("--against")
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "src", "lightgrid"))
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--runs", type=int, default=40)
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--only", default="")
    parser.add_argument("--of", choices=["median", "least"], default="median")
    parser.add_argument("--csv")
    parser.add_argument("--table")
    return parser.parse_args()


def frames_in(folder, only, program):
    """(name, lights) of each frame, fewest lights first."""
    if not os.path.isdir(folder):
        run([program, "bench", "--filter", "^(floor|spheres)-", "--write-frames", folder], 2)
    found = []
    for name in os.listdir(folder):
        path = os.path.join(folder, name, "lights.json")
        if os.path.isfile(path) and re.search(only, name):
            with open(path) as file:
                found.append((sum(line.count('"position"') for line in file), name))
    if not found:
        sys.exit(f"culling: no frame in {folder}" + (f" matches {only}" if only else ""))
    return [(name, lights) for lights, name in sorted(found)]


def environment(threads):
    return {**os.environ, "POCL_AFFINITY": "1", "POCL_MAX_PTHREAD_COUNT": str(threads)}


def run(command, threads, folder=None):
    done = subprocess.run(command, env=environment(threads), capture_output=True, text=True, cwd=folder)
    if done.returncode:
        sys.exit(f"culling: {' '.join(command)} ended with {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def known_values(program):
    """The values of each setting of this program."""
    text = run([program, "techniques"], 1)
    return lambda key, value: re.search(rf"\b{re.escape(key)}\b.*(?<![\w+-]){re.escape(value)}(?![\w+-])", text)


def runs_for(lights, runs):
    return max(5, runs // 4) if lights >= 500_000 else runs


def prototype_options(lights):
    """The prototype's own best choice for a number of lights, from its README."""
    return "-DTEST=1" + (" -DROW=1" if lights >= 4096 else "") + (" -DMID=2" if lights >= 65536 else "")


def run_prototype(args, frame, lights, threads):
    options = prototype_options(lights)
    runs = runs_for(lights, args.runs)
    folder = os.path.abspath(args.prototype)
    out = run([os.path.join(folder, "drv7"), os.path.abspath(os.path.join(args.frames, frame)), "cull7.cl", options,
               str(runs)], threads, folder)
    rows = []
    for name, low, mid in re.findall(r" (total|lights|depth|cull|compact) ([\d.]+)/([\d.]+)", out):
        rows.append({"program": "prototype", "settings": options, "row": "pipeline" if name == "total" else name,
                     "runs": runs, "min_ms": float(low), "median_ms": float(mid), "p90_ms": ""})
    return rows


def run_lightgrid(args, frame, lights, threads, comparison, earlier=False):
    """The rows of one process, whose settings run in turn; `comparison` may be None."""
    command = [args.against if earlier else args.program, "bench", "--replay", os.path.join(args.frames, frame),
               "--filter", f"^{re.escape(frame)}/", "--frames", str(runs_for(lights, args.runs)), "--json", "-"]
    if comparison:
        command += ["--compare", f"{comparison[0]}={','.join(comparison[1])}"]
    report = json.loads(run(command, threads))
    program = "earlier" if earlier else "lightgrid"
    machines[program] = report["machine"]
    return [{"program": program, "settings": row["params"].get("compared", ""), "row": row["name"],
             "runs": row["runs"], "min_ms": row["min_ms"], "median_ms": row["median_ms"], "p90_ms": row["p90_ms"]}
            for row in report["rows"]]


machines = {}  # each program's machine, as its bench reports it


def jobs(args, comparisons):
    """One round for one frame and one number of threads."""
    todo = [lambda *at, c=c: run_lightgrid(args, *at, c) for c in comparisons or [None]]
    if args.against:
        todo.append(lambda *at: run_lightgrid(args, *at, None, earlier=True))
    if args.prototype:
        todo.insert(0, lambda *at: run_prototype(args, *at))
    return todo


def measure(args, frames, comparisons):
    rows = []
    threads = [int(t) for t in args.threads.split(",")]
    for number in range(args.rounds):
        order = 1 if number % 2 == 0 else -1
        for frame, lights in frames:
            if lights >= 500_000 and number >= max(1, args.rounds // 2):
                continue  # such a frame takes as long as all others
            for count in threads[::order]:
                for job in jobs(args, comparisons)[::order]:
                    for row in job(frame, lights, count):
                        rows.append({"round": number, "frame": frame, "lights": lights, "threads": count, **row})
        print(f"culling: round {number + 1} of {args.rounds}", file=sys.stderr)
    return rows


def default_settings(comparisons):
    return [f"{key}={values[0]}" for key, values in comparisons] or [""]


class Found:
    """The rows grouped by frame, threads and setting."""

    def __init__(self, rows, of):
        self.rows = rows
        self.typical = {"median": "median_ms", "least": "min_ms"}[of]

    def per_round(self, frame, threads, program, settings, row, key):
        """{round: milliseconds}; several of one round are averaged (the default stands in each comparison)."""
        found = {}
        for r in self.rows:
            if (r["frame"], r["threads"], r["program"], r["row"]) == (frame, threads, program, row) and r["settings"] in settings:
                found.setdefault(r["round"], []).append(r[key])
        return {number: statistics.mean(values) for number, values in found.items()}

    def ratio(self, above, below):
        """The ratio of the least times of two such places; and the median of the rounds' ratios."""
        low = [self.per_round(*place, "min_ms") for place in (above, below)]
        mid = [self.per_round(*place, self.typical) for place in (above, below)]
        both = sorted(set(mid[0]) & set(mid[1]))
        if not both:
            return None
        least = min(low[0].values()) / min(low[1].values())
        return least, statistics.median(mid[0][r] / mid[1][r] for r in both)

    def time(self, place):
        low, mid = self.per_round(*place, "min_ms"), self.per_round(*place, self.typical)
        return (min(low.values()), statistics.median(mid.values())) if low else None


def cell(pair, digits=2):
    return "" if pair is None else f"{pair[0]:.{digits}f} / {pair[1]:.{digits}f}"


def frame_table(found, frames, threads, comparisons):
    default = default_settings(comparisons)
    settings_of = {key: f"{key}={values[1]}" for key, values in comparisons}
    head = ["frame", "threads", "prototype ms", "lightgrid ms", "ours / prototype", "exact / default", "portable / tuned",
            "depth bounds / plain read", "2 threads / 1"]
    raced = any(row["program"] == "earlier" for row in found.rows)
    head += ["earlier ms", "ours / earlier"] if raced else []
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    for frame, _ in frames:
        for count in threads:
            ours = (frame, count, "lightgrid", default, "pipeline")
            theirs = (frame, count, "prototype", {prototype_options(_)}, "pipeline")
            earlier = (frame, count, "earlier", [""], "pipeline")
            of = lambda key: found.ratio((frame, count, "lightgrid", [settings_of[key]], "pipeline"),
                                         (frame, count, "lightgrid", [f"{key}={dict(comparisons)[key][0]}"], "pipeline")) \
                if key in settings_of else None
            at = lambda row: (frame, count, "lightgrid", default, row)
            one = (frame, 1, "lightgrid", default, "pipeline")
            lines.append("| " + " | ".join([
                frame, str(count), cell(found.time(theirs), 3), cell(found.time(ours), 3), cell(found.ratio(ours, theirs)),
                cell(of("cull-test")), cell(of("portable")), cell(found.ratio(at("depth_bounds"), at("plain_read"))),
                cell(found.ratio(ours, one)) if count != 1 else "",
                *([cell(found.time(earlier), 3), cell(found.ratio(ours, earlier))] if raced else [])]) + " |")
    return lines


def scaling_lines(found, frames, threads, comparisons):
    default = default_settings(comparisons)
    by_lights = {lights: frame for frame, lights in frames if not frame.startswith("spheres")}
    lines = []
    for count in threads:
        place = lambda lights: (by_lights.get(lights, ""), count, "lightgrid", default, "pipeline")
        ratio = found.ratio(place(65536), place(4096))
        if ratio:
            lines.append(f"65,536 / 4096 lights, {count} thread(s): {cell(ratio)}")
        million = found.time(place(1_000_000))
        if million:
            lines.append(f"1,000,000 lights, {count} thread(s): {cell(million, 1)} ms")
    return lines


def write_csv(path, rows):
    machine = machines["lightgrid"]
    about = {"device": f"{machine.get('device', '')} ({machine.get('driver', '')})", "cores": os.cpu_count()}
    with open(path, "w", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        out.writeheader()
        for row in rows:
            commit = machines.get(row["program"], machine).get("commit", "")
            out.writerow({"commit": commit, **about, **row})


def main():
    args = arguments()
    if not os.access(args.program, os.X_OK):
        sys.exit(f"culling: {args.program} is no program; build first, or give --program")
    has = known_values(args.program)
    comparisons = [] if args.against else [c for c in COMPARISONS if all(has(c[0], value) for value in c[1])]
    for key, values in COMPARISONS:
        if not args.against and (key, values) not in comparisons:
            print(f"culling: this program has no {key}={values[1]}; left out", file=sys.stderr)
    frames = frames_in(args.frames, args.only, args.program)
    threads = [int(t) for t in args.threads.split(",")]
    rows = measure(args, frames, comparisons)
    if args.csv:
        write_csv(args.csv, rows)
    found = Found(rows, args.of)
    machine, earlier = machines["lightgrid"], machines.get("earlier")
    against = f" against {earlier.get('commit', '')}" if earlier else ""
    text = "\n".join([
        f"Commit {machine.get('commit', '')}{against}; {machine.get('device', '')} ({machine.get('driver', '')}). "
        f"{args.rounds} rounds of {args.runs} runs. "
        f"Each cell: of the least times / the median over the rounds (of their {args.of} times).", "",
        *frame_table(found, frames, threads, comparisons), "", *scaling_lines(found, frames, threads, comparisons)])
    if args.table:
        with open(args.table, "w") as file:
            file.write(text + "\n")
    print(text)


main()
