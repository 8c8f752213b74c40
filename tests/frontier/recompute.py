#!/usr/bin/env python3
"""recompute.py FOLDER: front, ties, ratios and break-evens again, from frontier.csv, samples.csv and culling.csv alone.

Compares them with frontier.json of the same folder, prints what differs, and ends with status 1 if anything does.
Written without the program's code: medians by statistics, the front by its definition, Mann-Whitney and the ranks of
intervals in whole numbers.
"""
import csv
import functools
import itertools
import json
import math
import pathlib
import statistics
import sys


def read_points(folder):
    """Points that ran on all their views, by (scene, label, frames): lists of rows, one a view."""
    points = {}
    for row in csv.DictReader(open(folder / "frontier.csv", newline="")):
        if not row["series"]:
            points.setdefault((row["scene"], row["label"], int(row["frames"])), []).append(row)
    return {key: rows for key, rows in points.items() if not any(row["refused"] for row in rows)}


def read_samples(folder):
    samples = {}
    for row in csv.DictReader(open(folder / "samples.csv", newline="")):
        samples.setdefault(row["row"], []).append((float(row["frame_ms"]), float(row["baseline_ms"])))
    return samples


def ratios_of(rows, samples):
    """For each run, the sum of times over views over the sum of the baseline's."""
    views = [samples.get(row["row"], []) for row in rows]
    return [sum(v[run][0] for v in views) / sum(v[run][1] for v in views) for run in range(min(map(len, views)))]


def error_of(rows):
    """None if a view's error is not finite."""
    errors = [row["total_rmse_rel"] for row in rows]
    if "" in errors:
        return None
    return math.sqrt(sum(float(e) ** 2 for e in errors) / len(errors))


@functools.lru_cache(None)
def orders(m, n, u):
    """Ways to interleave m and n values so that u pairs have the larger one among the m."""
    if u < 0 or m < 0 or n < 0:
        return 0
    if m == 0 or n == 0:
        return int(u == 0)
    return orders(m - 1, n, u - n) + orders(m, n - 1, u)


def mann_whitney(a, b):
    m, n = len(a), len(b)
    u = sum((x > y) + 0.5 * (x == y) for x in a for y in b)
    pooled = a + b
    ties = [pooled.count(value) for value in set(pooled)]
    if m + n <= 20 and max(ties) == 1:
        tail = sum(orders(m, n, k) for k in range(int(min(u, m * n - u)) + 1))
        return min(1.0, 2 * tail / math.comb(m + n, m))
    variance = m * n / 12 * (m + n + 1 - sum(t**3 - t for t in ties) / ((m + n) * (m + n - 1)))
    if variance <= 0:
        return 1.0
    z = max(0.0, abs(u - m * n / 2) - 0.5) / math.sqrt(variance)
    return math.erfc(z / math.sqrt(2))


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


def recompute(folder):
    """{(scene, label, frames): (front, set of tied keys)}"""
    samples = read_samples(folder)
    ratios, places = {}, {}
    for key, rows in read_points(folder).items():
        ratios[key] = ratios_of(rows, samples)
        error = error_of(rows)
        if ratios[key] and error is not None and not any(int(row["nan_pixels"]) for row in rows):
            places[key] = (statistics.median(ratios[key]), error)
    answer = {}
    for key in ratios:
        of_scene = [place for other, place in places.items() if other[0] == key[0]]
        front = key in places and not is_beaten(places[key], of_scene)
        tied = {
            other
            for other in ratios
            if other != key and other[0] == key[0] and ratios[key] and ratios[other]
            and mann_whitney(ratios[key], ratios[other]) >= 0.05
        }
        answer[key] = (front, tied)
    return answer


def main():
    folder = pathlib.Path(sys.argv[1])
    answer = json.load(open(folder / "frontier.json"))
    points = answer["points"]
    keys = [(p["scene"], p["label"], p["frames"]) for p in points]
    stated = {key: (p["front"], {keys[i] for i in p["tied_with"]}) for key, p in zip(keys, points)}
    computed = recompute(folder)
    differences = 0
    for key in sorted(set(stated) | set(computed)):
        if stated.get(key) != computed.get(key):
            differences += 1
            print(f"{', '.join(map(str, key))}: stated {stated.get(key)}, computed {computed.get(key)}")
    on_front = sum(front for front, _ in computed.values())
    ties = sum(len(tied) for _, tied in computed.values()) // 2
    print(f"{len(computed)} points, {on_front} on a front, {ties} ties: {differences} points differ")
    if len(answer.get("machines", [])) < 2:  # those of other machines are scaled
        differences += different_break_evens(folder, answer["break_even"])
    return 1 if differences or not computed else 0


if __name__ == "__main__":
    sys.exit(main())
