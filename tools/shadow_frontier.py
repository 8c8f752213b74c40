#!/usr/bin/env python3
"""Costs and errors of settings of `visibility`, from a sweep with shadows.

    lightgrid frontier SCENE… --shadows all -o FOLDER
    tools/shadow_frontier.py FOLDER/frontier.json > docs/results/shadows_NAME.csv
    tools/shadow_frontier.py docs/results/shadows_NAME.csv [--page PAGE --mark NAME]

Prints the figures of each scene and setting as CSV; given that file, a table of time and FLIP. With --page it replaces
the text there between <!-- NAME --> and <!-- /NAME -->.
"""
import csv
import io
import json

from shadow_lights import report, table

COLUMNS = ["scene", "size", "views", "setting", "relative_time", "ms", "rmse_rel", "flip_mean", "temporal_rmse_rel", "leaked_percent",
           "acned_percent", "commit", "device"]


def number(value, form):
    return "" if value is None else form.format(value) if value else "0"


def rows_of(answer, scene):
    of_scene = [p for p in answer["points"] if p["scene"] == scene]
    points = [p for p in of_scene if p["technique"] == "visibility" and p["relative_time"]["estimate"]]
    exact = next((p for p in points if p["label"] == "visibility"), None)
    for p in sorted(points, key=lambda p: p["relative_time"]["estimate"]):
        total = p["error"]["total"]
        settings = p["label"].partition(":")[2].split(",")  # the source is left out: all have it
        name = ",".join(s for s in settings if not s.startswith("shadow-source")) or "exact"
        yield [scene, "x".join(map(str, p["size"])), max(p["views"] for p in of_scene), name,
               f"{p['relative_time']['estimate'] / exact['relative_time']['estimate']:.3g}" if exact else "",
               f"{p['frame_ms']['median']:.3g}", number(total["rmse_rel"], "{:.1e}"), number(total["flip_mean"], "{:.3f}"),
               number(p["error"]["temporal_rmse_rel"], "{:.1e}"), number(p.get("leaked_percent"), "{:.2f}"),
               number(p.get("acned_percent"), "{:.2f}"), answer["commit"], answer["machine"]["cl_device"]]


def figures(path):
    with open(path) as file:
        answer = json.load(file)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for scene in answer["scenes"]:
        writer.writerows(rows_of(answer, scene))
    return out.getvalue().rstrip("\n")


def tables(path):
    if path.endswith(".json"):
        return figures(path)
    with open(path) as file:
        rows = list(csv.DictReader(file))
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    of = {(r["setting"], r["scene"]): f"{r['relative_time']} / {r['flip_mean']}" for r in rows}
    settings = dict.fromkeys(r["setting"] for r in rows)
    return f"Commit {rows[0]['commit']}; {rows[0]['device']}.\n\n" + table(
        ["setting", *(f"`{s}`" for s in scenes)], [[f"`{name}`", *(of.get((name, s), "–") for s in scenes)] for name in settings])


if __name__ == "__main__":
    report(__doc__, tables)
