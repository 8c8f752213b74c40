#!/usr/bin/env python3
"""frontier_table.py frontier.json: its points as CSV, one row a point, by scene and time: as docs/results keeps them."""
import csv
import json
import sys


def cell(value):
    return "" if value is None else f"{value:.4g}" if isinstance(value, float) else value


def write(answer, file):
    out = csv.writer(file, lineterminator="\n")
    # Only in a sweep with shadows.
    shadows = ["leaked_percent", "acned_percent"] if any("leaked_percent" in p for p in answer["points"]) else []
    out.writerow(
        "scene label views runs processes ms p95_ms p99_ms relative_time relative_time_low relative_time_high modes total_rmse_rel model_rmse_rel technique_rmse_rel precision_rmse_rel "
        "total_max_rel flip_mean displayed_flip temporal_rmse_rel deviation_rmse_rel bias_rmse_rel listed_per_lit lost memory_bytes front front_probability device_ms relative_device_time relative_device_time_low relative_device_time_high device_front energy_rel authored_displayed_flip".split() + shadows
    )
    points = [p for scene in answer["scenes"] for p in answer["points"] if p["scene"] == scene]
    order = {scene: i for i, scene in enumerate(answer["scenes"])}
    for p in sorted(points, key=lambda p: (order[p["scene"]], p["relative_time"]["estimate"] or 1e9)):
        e = p["error"]
        time = p["relative_time"]
        row = [p["scene"], p["label"], p["views"], time["runs"], time["processes"], p["frame_ms"]["median"]]
        row += [*(p["frame_ms_within"][share] for share in ("p95", "p99")), time["estimate"], *time["ci95"]]
        row += [" ".join(cell(mode) for mode in time["modes"])]
        row += [e[kind]["rmse_rel"] for kind in ("total", "model", "technique", "precision")]
        row += [e["total"]["max_rel"], e["total"]["flip_mean"], e["total"]["displayed_flip"]["mean"], e["temporal_rmse_rel"], e["deviation_rmse_rel"], e["bias_rmse_rel"]]
        row += [p["listed_per_lit"], p["pairs"]["lost"], p["memory_bytes"], int(p["fronts"]["total"]["on"]), p["fronts"]["total"]["probability"]]
        device, authored = p["relative_device_time"], (e.get("authored") or {}).get("total", {}).get("displayed_flip") or {}
        row += [p["device_ms"]["median"], device["estimate"], *device["ci95"], int(p["device_fronts"]["total"]["on"])]
        row += [e["total"]["energy_rel"], authored.get("mean")]
        out.writerow([cell(value) for value in row + [p.get(key) for key in shadows]])


if __name__ == "__main__":
    write(json.load(open(sys.argv[1])), sys.stdout)
