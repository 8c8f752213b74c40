#!/usr/bin/env python3
"""recompute.py FOLDER: relative times, fronts, their probabilities and break-evens again, from frontier.csv, samples.csv
and culling.csv alone.

Compares them with frontier.json of the same folder, prints what differs, and ends with status 1 if anything does.
Written without the program's code: medians by statistics, the front by its definition, Student's t by integration,
probabilities by draws of its own, and the ranks of intervals in whole numbers.
"""
import collections
import csv
import functools
import itertools
import json
import math
import pathlib
import random
import statistics
import sys


def read_points(folder):
    """Points that ran on all their views, by (scene, label, frames): lists of rows, one a view."""
    points = {}
    for row in csv.DictReader(open(folder / "frontier.csv", newline="")):
        if not row["series"]:
            points.setdefault((row["scene"], row["label"], int(row["frames"])), []).append(row)
    return {key: rows for key, rows in points.items() if not any(row["refused"] for row in rows)}


# The keys of times and fronts in frontier.json; the columns of samples.csv; words.
CLOCKS = [("relative_time", "fronts", ("frame_ms", "baseline_ms"), ""),
          ("relative_device_time", "device_fronts", ("device_ms", "baseline_device_ms"), " by the devices' clocks")]


def read_samples(folder, columns):
    """By row: {(process, round of it): (ms, baseline's ms)}, of rows that have such times of all their runs."""
    samples = {}
    for row in csv.DictReader(open(folder / "samples.csv", newline="")):
        of_row, process = samples.setdefault(row["row"], {}), int(row["process"])
        number = sum(p == process for p, _ in of_row)
        of_row[process, number] = tuple(float(row[name]) if row[name] else None for name in columns)
    return {row: times for row, times in samples.items() if not any(None in pair for pair in times.values())}


def baselines(folder, samples):
    """{(scene, view, shard, process, round): three of the baseline's runs}, of points of the front and of controls.

    Those beside three successive rows, from a place on that moves by three a round."""
    runs = {}
    for row in csv.DictReader(open(folder / "frontier.csv", newline="")):
        if not row["series"] or row["series"].startswith("control"):
            for block, (_, baseline) in samples.get(row["row"], {}).items():
                runs.setdefault((row["scene"], row["view"], row["shard"], *block), []).append(baseline)
    return {place: [times[(3 * (place[3] + place[4]) + k) % len(times)] for k in range(3)] for place, times in runs.items()}


def log_times_of(rows, samples, base):
    """{(shard, process, round): logs of the sum of times over views over sums of the baseline's, one a series}."""
    rows = [row for row in rows if int(row["runs"])]  # others have errors alone
    views = [samples.get(row["row"], {}) for row in rows]
    times = {}
    if not rows:
        return times
    for block in sorted(set(views[0]).intersection(*views)):
        place = [base[row["scene"], row["view"], row["shard"], *block] for row in rows]
        total = sum(v[block][0] for v in views)
        times[rows[0]["shard"], *block] = [math.log(total / sum(of_series)) for of_series in zip(*place)]
    return times


@functools.lru_cache(None)
def t_quantile(dof):
    """97.5 % of Student's t, by Simpson's rule on the density and bisection."""
    scale = math.gamma((dof + 1) / 2) / math.gamma(dof / 2) / math.sqrt(dof * math.pi)

    def half(x, n=20000):
        f = [(1 + (x * i / n) ** 2 / dof) ** (-(dof + 1) / 2) for i in range(n + 1)]
        return scale * x / n / 3 * (f[0] + f[-1] + 4 * sum(f[1:-1:2]) + 2 * sum(f[2:-1:2]))

    low, high = 0.0, 200.0
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if half(middle) < 0.475 else (low, middle)
    return low


def trimmed(values, share=10):
    """Mean without a tenth at either end, how far each winsorized value moves it (times their number), degrees of freedom."""
    n, cut, ordered = len(values), len(values) // share if share else 0, sorted(values)
    kept = ordered[cut:n - cut]
    winsorized = [min(max(v, kept[0]), kept[-1]) for v in values]
    centre = statistics.fmean(winsorized)
    return statistics.fmean(kept), [(w - centre) * n / len(kept) for w in winsorized], len(kept) - 1


def middles(times):
    """Each round over the middle one of the baseline's runs."""
    return [statistics.median(value) for value in times.values()]


def two_modes(values):
    """None, or the two groups of values that a gap of 1.25 or more parts."""
    ordered, n = sorted(values), len(values)
    least = max(2, math.ceil(n / 10))
    for i in range(least, n - least + 1):
        below, above = ordered[:i], ordered[i:]
        gap = above[0] - below[-1]
        if gap >= math.log(1.25) and gap > below[-1] - below[0] and gap > above[-1] - above[0]:
            return below, above
    return None


def level_of(times):
    """Mean over the series, deviations of the units from it, degrees of freedom; units are rounds or, with several
    processes, these."""
    of_process = {}
    for (shard, process, _), value in times.items():
        of_process.setdefault((shard, process), []).append(value)
    if len(of_process) < 2:
        units, share = list(times.values()), 10
    else:
        units = [[trimmed(series)[0] for series in zip(*values)] for values in of_process.values()]
        share = 10 if len(units) == len(times) else None
    parts = [trimmed(series, share) for series in zip(*units)]
    return statistics.fmean(p[0] for p in parts), [statistics.fmean(d) for d in zip(*(p[1] for p in parts))], parts[0][2]


def relative_time(times, widen=0.0):
    """Estimate, low, high."""
    values = middles(times)
    mean, deviations, dof = level_of(times)
    below = above = t_quantile(dof) * statistics.stdev(deviations) / math.sqrt(len(deviations)) if dof > 0 else 0
    if modes := two_modes(values):
        mean = statistics.fmean(modes[len(modes[1]) > len(modes[0])])
        below, above = mean - min(values), max(values) - mean
    return math.exp(mean), math.exp(mean - below - widen), math.exp(mean + above + widen)


COLUMNS = {"total": "total_displayed_flip_mean", "authored": "authored_total_displayed_flip_mean"}


def error_of(rows, of):
    """FLIP as displayed against a reference; None if a view has none."""
    errors = [row.get(COLUMNS[of], "") for row in rows]
    return None if "" in errors else statistics.fmean(map(float, errors))


def median_interval(values):
    """Median, low, high: the ranks that at most 2.5 % of all outcomes leave on either side, by the binomial distribution."""
    values, n = sorted(values), len(values)
    rank = 0
    while rank + 1 <= (n - 1) // 2 and 40 * sum(math.comb(n, k) for k in range(rank + 2)) <= 2**n:
        rank += 1
    return statistics.median(values), values[rank], values[n - 1 - rank]


def read_culling(folder):
    rounds = {}
    for row in csv.DictReader(open(folder / "culling.csv", newline="")):
        rounds.setdefault(row["row"], []).append(float(row["cull_ms"]))
    return rounds


def break_evens(folder):
    """{(scene, tighter, looser): (rounds, ns, low, high)} of the points that differ in the cull test alone."""
    rounds, groups = read_culling(folder), {}
    for row in csv.DictReader(open(folder / "frontier.csv", newline="")):
        settings = dict(item.split("=", 1) for item in row["settings"].split())
        if row["row"] in rounds and not row["series"] and not row["refused"] and settings.pop("cull_test", None):
            shared = ("scene", "technique", "frames", "view", "shard")
            key = (*(row[name] for name in shared), tuple(sorted(settings.items())))
            groups.setdefault(key, []).append(row)
    answer = {}
    for a, b in itertools.chain(*(itertools.combinations(group, 2) for group in groups.values())):
        extra = [x - y for x, y in zip(rounds[a["row"]], rounds[b["row"]])]
        saved = int(b["listed"]) - int(a["listed"])
        if saved < 0:
            a, b, saved, extra = b, a, -saved, [-x for x in extra]
        if saved > 0:
            figures = [max(x, 0) * 1e6 / saved for x in median_interval(extra)]
            answer[a["scene"], a["label"], b["label"]] = (len(extra), *figures)
    return answer


def different_break_evens(folder, stated):
    computed = break_evens(folder)
    stated = {(b["scene"], b["tighter"], b["looser"]): (b["rounds"], b["ns_per_pixel_light"], *b["ci95"])
              for b in stated if b["rounds"] > 0}
    different = [key for key in set(stated) | set(computed) if key not in stated or key not in computed
                 or any(abs(x - y) > 1e-9 * max(abs(y), 1e-9) for x, y in zip(stated[key], computed[key]))]
    for key in different:
        print(f"break-even of {', '.join(key)}: stated {stated.get(key)}, computed {computed.get(key)}")
    print(f"{len(computed)} break-evens with intervals: {len(different)} differ")
    return len(different)


def is_beaten(place, places):
    return any(q != place and q[0] <= place[0] and q[1] <= place[1] for q in places)


MIN_ROUNDS = 3  # with fewer, no interval and no probability is stated


def widenings(folder, samples, base):
    """By scene, the logarithm by which a control that did not pass widens intervals."""
    places = {}  # each shard has its own
    for row in csv.DictReader(open(folder / "frontier.csv", newline="")):
        if row["series"].startswith("control"):
            places.setdefault((row["scene"], row["shard"], row["series"]), []).append(row)
    rounds = {}
    for (scene, _, _), rows in places.items():
        for block, value in log_times_of(rows, samples, base).items():
            rounds.setdefault(scene, {}).setdefault(block, []).append(value)
    answer = {}
    for scene, of_scene in rounds.items():
        count = collections.Counter(shard for name, shard, _ in places if name == scene)
        series = {block: sum(of_places, []) for block, of_places in of_scene.items() if len(of_places) == count[block[0]]}
        estimate, low, high = relative_time(series)
        passed = low <= 1 <= high and abs(estimate - 1) <= 0.01
        answer[scene] = 0 if passed else abs(math.log(estimate))
    return answer


def recompute(folder, of, columns):
    """{(scene, label, frames): (front, (estimate, low, high) or None)}"""
    samples = read_samples(folder, columns)
    base = baselines(folder, samples)
    widen = widenings(folder, samples, base)
    times, places = {}, {}
    for key, rows in read_points(folder).items():
        log_times = log_times_of(rows, samples, base)
        times[key] = relative_time(log_times, widen.get(key[0], 0)) if log_times else None
        if log_times and len(log_times) < MIN_ROUNDS:
            times[key] = times[key][0], None, None
        error = error_of(rows, of)
        if times[key] and error is not None and not any(int(row["nan_pixels"]) for row in rows):
            places[key] = (times[key][0], error)
    answer = {}
    for key in times:
        of_scene = [place for other, place in places.items() if other[0] == key[0]]
        answer[key] = (key in places and not is_beaten(places[key], of_scene), times[key])
    return answer


def drawn_fronts(folder, of_error, columns, count=2000):
    """{key: share of draws in which the point is on the front}, of scenes without two modes and with one process."""
    samples = read_samples(folder, columns)
    base, numbers = baselines(folder, samples), random.Random(1)
    widen = widenings(folder, samples, base)
    scenes = {}
    for key, rows in read_points(folder).items():
        log_times = log_times_of(rows, samples, base)
        if error_of(rows, of_error) is not None and log_times and not any(int(row["nan_pixels"]) for row in rows):
            scenes.setdefault(key[0], {})[key] = (log_times, error_of(rows, of_error))
    shares = {}
    for scene, points in scenes.items():
        if widen.get(scene) or any(two_modes(middles(t)) or len({b[:2] for b in t}) > 1 for t, _ in points.values()):
            continue
        known = {}
        for key, (log_times, error) in points.items():
            mean, deviations, dof = level_of(log_times)
            n = len(deviations)
            weights = [d / math.sqrt(n * (n - 1)) if n > 1 else 0 for d in deviations]
            known[key] = (mean, dof, list(log_times), weights, error)
            shares[key] = 0
        blocks = {block for _, _, of, _, _ in known.values() for block in of}
        for _ in range(count):
            normal = {block: numbers.gauss(0, 1) for block in blocks}
            squares = [numbers.gauss(0, 1) ** 2 for _ in range(100)]
            places = {}
            for key, (mean, dof, of, weights, error) in known.items():
                scale = math.sqrt(dof / sum(squares[:dof])) if dof > 0 else 0
                places[key] = (mean + scale * sum(w * normal[b] for w, b in zip(weights, of)), error)
            for key, place in places.items():
                shares[key] += not is_beaten(place, places.values())
    rounds = {key: len(log_times) for of_scene in scenes.values() for key, (log_times, _) in of_scene.items()}
    return {key: hits / count for key, hits in shares.items() if rounds[key] >= MIN_ROUNDS}


def different_probabilities(folder, of, stated, columns):
    """Shares of 2,000 draws, both: four deviations of their difference are 0.064."""
    drawn = drawn_fronts(folder, of, columns)
    different = [key for key, share in drawn.items() if stated[key] is None or abs(share - stated[key]) > 0.064]
    for key in different:
        print(f"{key}: on the front with {stated[key]}, drawn {drawn[key]}")
    print(f"{len(drawn)} probabilities of the front: {len(different)} differ")
    return len(different)


def agrees(stated, computed):
    (front, times), (other_front, others) = stated, computed
    return front == other_front and (times is None) == (others is None) and (
        times is None or all((a is None) == (b is None) and (a is None or abs(a - b) <= 1e-6 * abs(b)) for a, b in zip(times, others)))


def different_fronts(folder, of, clock, keys, points):
    """How many points' times, fronts and probabilities differ from those stated by a clock of CLOCKS."""
    time_key, fronts_key, columns, words = clock
    stated, probabilities = {}, {}
    for key, p in zip(keys, points):
        time, front = p[time_key], p.get(fronts_key, {}).get(of, {"on": False, "probability": 0})
        stated[key] = front["on"], (time["estimate"], *time["ci95"]) if time["runs"] else None
        probabilities[key] = front["probability"]
    computed, differ = recompute(folder, of, columns), 0
    for key in sorted(set(stated) | set(computed)):
        if key not in stated or key not in computed or not agrees(stated[key], computed[key]):
            differ += 1
            print(f"{', '.join(map(str, key))}: stated {stated.get(key)}, computed {computed.get(key)}")
    on_front = sum(front for front, _ in computed.values())
    print(f"{of}: {len(computed)} points, {on_front} on a front{words}: {differ} points differ")
    differences = differ or not computed
    if set(stated) == set(computed):
        differences += different_probabilities(folder, of, probabilities, columns)
    return differences


def main():
    folder = pathlib.Path(sys.argv[1])
    answer = json.load(open(folder / "frontier.json"))
    points = answer["points"]
    keys = [(p["scene"], p["label"], p["frames"]) for p in points]
    differences = 0
    for of in sorted({of for p in points for of in p["fronts"]}):
        for clock in CLOCKS:
            if clock is CLOCKS[0] or any(p[clock[0]]["runs"] for p in points):
                differences += different_fronts(folder, of, clock, keys, points)
    if len(answer.get("machines", [])) < 2:  # times of other machines are scaled
        differences += different_break_evens(folder, answer["break_even"])
    return 1 if differences or not points else 0


if __name__ == "__main__":
    sys.exit(main())
