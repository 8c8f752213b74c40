#!/usr/bin/env python3
"""frontier_table.py frontier.json: its points as CSV, one row a point, by scene and time: what docs/results keeps of a run."""
import csv
import json
import sys


def cell(value):
    return "" if value is None else f"{value:.4g}" if isinstance(value, float) else value


def main():
    answer = json.load(open(sys.argv[1]))
    out = csv.writer(sys.stdout, lineterminator="\n")
    # Of a sweep with shadows alone.
    shadows = ["leaked_percent", "acned_percent"] if any("leaked_percent" in p for p in answer["points"]) else []
    out.writerow(
        "scene label views runs ms ratio ratio_low ratio_high total_rmse_rel model_rmse_rel technique_rmse_rel precision_rmse_rel "
        "total_max_rel flip_mean temporal_rmse_rel deviation_rmse_rel bias_rmse_rel listed_per_lit lost memory_bytes front".split() + shadows
    )
    points = [p for scene in answer["scenes"] for p in answer["points"] if p["scene"] == scene]
    order = {scene: i for i, scene in enumerate(answer["scenes"])}
    for p in sorted(points, key=lambda p: (order[p["scene"]], p["ratio"]["median"] or 1e9)):
        e = p["error"]
        row = [p["scene"], p["label"], p["views"], p["ratio"]["runs"], p["frame_ms"]["median"], p["ratio"]["median"], *p["ratio"]["ci95"]]
        row += [e[kind]["rmse_rel"] for kind in ("total", "model", "technique", "precision")]
        row += [e["total"]["max_rel"], e["total"]["flip_mean"], e["temporal_rmse_rel"], e["deviation_rmse_rel"], e["bias_rmse_rel"]]
        row += [p["listed_per_lit"], p["pairs"]["lost"], p["memory_bytes"], int(p["front"])]
        out.writerow([cell(value) for value in row + [p.get(key) for key in shadows]])


main()
