#!/usr/bin/env python3
"""recompute.py FOLDER: relative times, fronts, their probabilities and break-evens again, from frontier.csv, samples.csv
and culling.csv alone.

Compares them with frontier.json of the same folder, prints what differs, and ends with status 1 if anything does.
Written without the program's code: medians by statistics, the front by its definition, Student's t by integration,
probabilities by draws of its own, and the ranks of intervals in whole numbers. Two levels vary: rounds within a view, and
views.
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
          ("relative_cpu_time", None, ("cpu_ms", "baseline_cpu_ms"), " in processor time"),
          ("relative_device_time", "device_fronts", ("device_ms", "baseline_device_ms"), " by the devices' clocks")]


def read_samples(folder, columns):
    """By row: {(process, round of it): (ms, baseline's ms)}, sums over the round's frames, of rows that have such times of
    all their runs."""
    sizes = {row["row"]: int(row["frames_per_round"]) for row in csv.DictReader(open(folder / "frontier.csv", newline=""))}
    frames = {}
    for row in csv.DictReader(open(folder / "samples.csv", newline="")):
        values = tuple(float(row[name]) if row[name] else None for name in columns)
        frames.setdefault(row["row"], {}).setdefault(int(row["process"]), []).append(values)
    samples = {}
    for row, processes in frames.items():
        if any(None in values for of_process in processes.values() for values in of_process):
            continue
        size = sizes[row]
        samples[row] = {(process, i): tuple(map(sum, zip(*of_process[i * size:(i + 1) * size])))
                        for process, of_process in processes.items() for i in range(len(of_process) // size)}
    return samples


def baselines(folder, samples):
    """{(scene, view, shard, process, round): the baseline's times}, next to points of the front and controls. A point's are
    those from a place on that moves by three a round."""
    runs = {}
    for row in csv.DictReader(open(folder / "frontier.csv", newline="")):
        if not row["series"] or row["series"].startswith("control"):
            for block, (_, baseline) in samples.get(row["row"], {}).items():
                runs.setdefault((row["scene"], row["view"], row["shard"], *block), []).append(baseline)
    return {place: lambda k, place=place, times=times: times[(3 * (place[3] + place[4]) + k) % len(times)]
            for place, times in runs.items()}


def times_of(rows, samples, base, number=0):
    """{(shard, process, round): log of the sum of times over views over that of the baseline's}, and by view the same of it
    with the baseline's median."""
    rows = [row for row in rows if int(row["runs"])]  # others have errors alone
    rounds, views, shard = {}, {}, rows[0]["shard"] if rows else ""
    of_rows = [{block: (ms, base[row["scene"], row["view"], row["shard"], *block](number))
                for block, (ms, _) in samples.get(row["row"], {}).items()} for row in rows]
    for row, times in zip(rows, of_rows):
        if times:
            logs = {(shard, *block): math.log(ms / baseline) for block, (ms, baseline) in sorted(times.items())}
            views[row["view"]] = logs, statistics.median(baseline for _, baseline in times.values())
    for block in sorted(set(of_rows[0]).intersection(*of_rows)) if rows else ():
        rounds[shard, *block] = math.log(sum(t[block][0] for t in of_rows) / sum(t[block][1] for t in of_rows))
    return rounds, views


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


def lower_rank(n):
    """The largest rank that the signed-rank statistic stays below with at most 2.5 %; above 20 values by the normal
    distribution."""
    if n > 20:
        return int(n * (n + 1) / 4 - 1.959964 * math.sqrt(n * (n + 1) * (2 * n + 1) / 24) + 0.5)
    ways = [1]
    for value in range(1, n + 1):
        ways = [(ways[i] if i < len(ways) else 0) + (ways[i - value] if i >= value else 0) for i in range(len(ways) + value)]
    rank = 0
    while 40 * sum(ways[:rank + 1]) <= 2**n:
        rank += 1
    return rank


def spread(deviations):
    """Standard error of a mean of which the values' influences are these, which add up to 0."""
    n = len(deviations)
    return math.sqrt(sum(d * d for d in deviations) / (n * (n - 1))) if n > 1 else 0


def plain_mean(values):
    mean = statistics.fmean(values)
    return mean, [v - mean for v in values], len(values) - 1


def middle(values):
    """Hodges and Lehmann's estimate, the values' influences on it (times their number), degrees of freedom, and the
    interval of the signed-rank test; below six values Student's t."""
    n = len(values)
    means = sorted((values[i] + values[j]) / 2 for i in range(n) for j in range(i, n))
    estimate = statistics.median(means)
    if n < 6:
        _, deviations, dof = plain_mean(values)
        half = t_quantile(dof) * spread(deviations) if dof > 0 else 0
        return estimate, deviations, dof, estimate - half, estimate + half
    rank = lower_rank(n)
    low, high = means[rank - 1], means[-rank]
    signs = [sum(((a + b) / 2 > estimate) - ((a + b) / 2 < estimate) for b in values) for a in values]
    centre = statistics.fmean(signs)
    signs = [sign - centre for sign in signs]
    scale = (high - low) / 2 / t_quantile(n - 1) / spread(signs) if spread(signs) > 0 else 0
    return estimate, [sign * scale for sign in signs], n - 1, low, high


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


def by_process(rounds):
    processes = {}
    for (shard, process, _), value in rounds.items():
        processes.setdefault((shard, process), []).append(value)
    return processes


def level_of_rounds(rounds):
    """Estimate, {block: influence} and degrees of freedom; blocks are rounds or, with several processes, these."""
    processes = by_process(rounds)
    if len(processes) < 2:
        estimate, deviations, dof, _, _ = middle(list(rounds.values()))
        return estimate, dict(zip(rounds, deviations)), dof
    estimate, deviations, dof = plain_mean([middle(values)[0] for values in processes.values()])
    return estimate, dict(zip(processes, deviations)), dof


def levels_of_views(rounds, views):
    """The levels of which times vary: views, and processes if there are several; with a single view its rounds."""
    estimate, influences, dof = level_of_rounds(rounds)
    if len(views) < 2:
        return estimate, [(influences, dof)]
    ratios = {view: math.exp(middle(list(logs.values()))[0]) for view, (logs, _) in views.items()}
    weights = {view: baseline for view, (_, baseline) in views.items()}
    total, n = sum(weights.values()), len(views)
    ratio = sum(weights[v] * ratios[v] for v in views) / total
    of_views = {("view", v): (n - 1) * weights[v] / (total - weights[v]) * (ratios[v] / ratio - 1) for v in views}
    levels = [(of_views, n - 1)]
    if len(by_process(rounds)) > 1:
        noise = 0
        for view, (logs, _) in views.items():
            processes = by_process(logs)
            noise += (weights[view] / total) ** 2 * sum(spread(middle(v)[1]) ** 2 for v in processes.values()) / len(processes) ** 2
        own, all_of_it = spread(list(influences.values())) ** 2 - noise, spread(list(influences.values())) ** 2
        if own > 0:
            levels.append(({block: i * math.sqrt(own / all_of_it) for block, i in influences.items()}, dof))
    return estimate, levels


def relative_time(times, widen=0.0):
    """Estimate, low, high, and low and high over views or None."""
    rounds, views = times
    values = list(rounds.values())
    if len(by_process(rounds)) > 1:
        mean, influences, dof = level_of_rounds(rounds)
        below = above = t_quantile(dof) * spread(list(influences.values()))
    else:
        mean, _, _, low, high = middle(values)
        below, above = mean - low, high - mean
    if modes := two_modes(values):
        mean = statistics.fmean(modes[len(modes[1]) > len(modes[0])])
        below, above = mean - min(values), max(values) - mean
    result = [math.exp(mean), math.exp(mean - below - widen), math.exp(mean + above + widen)]
    if len(views) < 2:
        return *result, None, None
    _, levels = levels_of_views(rounds, views)
    half = t_quantile(min(dof for _, dof in levels)) * math.sqrt(sum(spread(list(i.values())) ** 2 for i, _ in levels)) + widen
    return *result, math.exp(mean - half), math.exp(mean + half)


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
    rounds, numbers = {}, {}
    for (scene, _, _), rows in sorted(places.items(), key=lambda place: (int(place[0][1]), place[0][2])):
        number = numbers.setdefault(scene, 0)
        of_place, _ = times_of(rows, samples, base, number)
        numbers[scene] += bool(of_place)
        for block, value in of_place.items():
            rounds.setdefault(scene, {}).setdefault(block, []).append(value)
    answer = {}
    for scene, of_scene in rounds.items():
        count = collections.Counter(shard for name, shard, _ in places if name == scene)
        means = {block: statistics.fmean(of_places) for block, of_places in of_scene.items() if len(of_places) == count[block[0]]}
        estimate, low, high, _, _ = relative_time((means, {}))
        passed = low <= 1 <= high and abs(estimate - 1) <= 0.01
        answer[scene] = 0 if passed else abs(math.log(estimate))
    return answer


def recompute(folder, of, columns):
    """{(scene, label, frames): (front, (estimate, low, high, low and high over views) or None)}"""
    samples = read_samples(folder, columns)
    base = baselines(folder, samples)
    widen = widenings(folder, samples, base)
    times, places = {}, {}
    for key, rows in read_points(folder).items():
        log_times = times_of(rows, samples, base)
        times[key] = relative_time(log_times, widen.get(key[0], 0)) if log_times[0] else None
        if log_times[0] and len(log_times[0]) < MIN_ROUNDS:
            times[key] = times[key][0], None, None, None, None
        error = error_of(rows, of)
        if times[key] and error is not None and not any(int(row["nan_pixels"]) for row in rows):
            places[key] = (times[key][0], error)
    answer = {}
    for key in times:
        of_scene = [place for other, place in places.items() if other[0] == key[0]]
        answer[key] = (key in places and not is_beaten(places[key], of_scene), times[key])
    return answer


def level_of_errors(rows, of):
    """The logarithm of the mean error over views, and the views' influences."""
    errors = {("view", row["view"]): float(row[COLUMNS[of]]) for row in rows}
    mean = statistics.fmean(errors.values())
    if mean == 0:
        return -math.inf, []
    return math.log(mean), [({view: error / mean - 1 for view, error in errors.items()}, len(errors) - 1)] if len(errors) > 1 else []


def draw_of(centre, levels, normal, squares):
    for influences, dof in levels:
        n = len(influences)
        if dof > 0:
            kind = "view" if next(iter(influences))[0] == "view" else len(next(iter(influences)))
            scale = math.sqrt(dof / sum(squares[kind][:dof]) / (n * (n - 1)))
            centre += scale * sum(influence * normal[block] for block, influence in influences.items())
    return centre


def drawn_fronts(folder, of_error, columns, count=2000):
    """{key: (share of draws of rounds, share of draws of views) in which the point is on the front}, of scenes without two
    modes and with one process; the second is None where a point has fewer than two timed views."""
    samples = read_samples(folder, columns)
    base, numbers = baselines(folder, samples), random.Random(1)
    widen = widenings(folder, samples, base)
    scenes = {}
    for key, rows in read_points(folder).items():
        times = times_of(rows, samples, base)
        if error_of(rows, of_error) is not None and times[0] and not any(int(row["nan_pixels"]) for row in rows):
            scenes.setdefault(key[0], {})[key] = times, rows
    shares, rounds = {}, {}
    for scene, points in scenes.items():
        if widen.get(scene) or any(two_modes(list(t[0].values())) or len({b[:2] for b in t[0]}) > 1 for t, _ in points.values()):
            continue
        known, over_views = {}, all(len(times[1]) > 1 for times, _ in points.values())
        for key, (times, rows) in points.items():
            estimate, influences, dof = level_of_rounds(times[0])
            known[key] = (estimate, [(influences, dof)], levels_of_views(*times)[1], *level_of_errors(rows, of_error))
            shares[key], rounds[key] = [0, 0], len(times[0])
        every = [level for _, a, b, _, c in known.values() for level in (*a, *b, *c)]
        blocks = {block for influences, _ in every for block in influences}
        for _ in range(count):
            normal = {block: numbers.gauss(0, 1) for block in blocks}
            squares = {kind: [numbers.gauss(0, 1) ** 2 for _ in range(64)] for kind in ("view", 2, 3)}
            of_rounds = {key: (draw_of(k[0], k[1], normal, squares), k[3]) for key, k in known.items()}
            of_views = {key: (draw_of(k[0], k[2], normal, squares), draw_of(k[3], k[4], normal, squares)) for key, k in known.items()}
            for which, places in enumerate((of_rounds, of_views)):
                values = list(places.values())
                for key, place in places.items():
                    shares[key][which] += not is_beaten(place, values)
    return {key: (a / count, b / count if over_views else None) for key, (a, b) in shares.items() if rounds[key] >= MIN_ROUNDS}


def differs(share, stated):
    """Shares of 2,000 draws, both: four deviations of their difference are 0.064."""
    return (share is None) != (stated is None) or share is not None and abs(share - stated) > 0.064


def different_probabilities(folder, of, stated, columns):
    drawn = drawn_fronts(folder, of, columns)
    different = [key for key, shares in drawn.items()
                 if any(s is not None and differs(a, s) for a, s in zip(shares, stated[key])) or stated[key][0] is None]
    for key in different:
        print(f"{key}: on the front with {stated[key]}, drawn {drawn[key]}")
    print(f"{len(drawn)} probabilities of the front: {len(different)} differ")
    return len(different)


def agrees(stated, computed):
    (front, times), (other_front, others) = stated, computed
    return (front is None or front == other_front) and (times is None) == (others is None) and (
        times is None or all((a is None) == (b is None) and (a is None or abs(a - b) <= 1e-6 * abs(b)) for a, b in zip(times, others)))


def different_fronts(folder, of, clock, keys, points):
    """How many points' times, fronts and probabilities differ from those stated by a clock of CLOCKS."""
    time_key, fronts_key, columns, words = clock
    stated, probabilities = {}, {}
    for key, p in zip(keys, points):
        time, front = p[time_key], p.get(fronts_key, {}).get(of, {"on": False, "probability": 0}) if fronts_key else None
        stated[key] = front["on"] if front else None, (time["estimate"], *time["ci95"], *time["views_ci95"]) if time["runs"] else None
        decides = p["clock"] == {"relative_time": "wall", "relative_cpu_time": "cpu", "relative_device_time": "device"}[time_key]
        probabilities[key] = front["probability"] if front else None, p.get("p_front_views", {}).get(of) if decides else None
    computed, differ = recompute(folder, of, columns), 0
    for key in sorted(set(stated) | set(computed)):
        if key not in stated or key not in computed or not agrees(stated[key], computed[key]):
            differ += 1
            print(f"{', '.join(map(str, key))}: stated {stated.get(key)}, computed {computed.get(key)}")
    on_front = sum(front for front, _ in computed.values())
    print(f"{of}: {len(computed)} points, {on_front} on a front{words}: {differ} points differ")
    differences = differ or not computed
    if set(stated) == set(computed) and fronts_key:
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
