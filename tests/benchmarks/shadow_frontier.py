#!/usr/bin/env python3
"""What settings of `visibility` cost and get wrong, from a sweep with shadows.

    lightgrid frontier SCENE… --shadows all -o FOLDER
    tests/benchmarks/shadow_frontier.py FOLDER/frontier.json [--page PAGE --mark NAME]

Prints a table a scene, by time; with --page they replace the text there between <!-- NAME --> and
<!-- /NAME -->.
"""
import json

from shadow_lights import report, table


def number(value, form):
    return "–" if value is None else form.format(value) if value else "0"


def rows_of(answer, scene):
    points = [p for p in answer["points"]
              if p["scene"] == scene and p["technique"] == "visibility" and p["relative_time"]["estimate"]]
    exact = next((p for p in points if p["label"] == "visibility"), None)
    for p in sorted(points, key=lambda p: p["relative_time"]["estimate"]):
        total = p["error"]["total"]
        settings = p["label"].partition(":")[2].split(",")  # the source is left out: all have it
        name = ", ".join(s for s in settings if not s.startswith("shadow-source")) or "exact"
        yield [f"`{name}`" if name != "exact" else name,
               f"{p['relative_time']['estimate'] / exact['relative_time']['estimate']:.3g}" if exact else "–",
               f"{p['frame_ms']['median']:.3g}", number(total["rmse_rel"], "{:.1e}"),
               number(total["flip_mean"], "{:.3f}"),
               number(p["error"]["temporal_rmse_rel"], "{:.1e}"), number(p.get("leaked_percent"), "{:.2f}"),
               number(p.get("acned_percent"), "{:.2f}")]


def tables(path):
    with open(path) as file:
        answer = json.load(file)
    parts = [f"Commit {answer['commit']}; {answer['machine']['cl_device']}."]
    head = ["setting", "times exact", "ms", "RMSE", "FLIP", "flicker", "leaked, %", "acned, %"]
    for scene in answer["scenes"]:
        of_scene = [p for p in answer["points"] if p["scene"] == scene]
        views, size = max(p["views"] for p in of_scene), of_scene[0]["size"]
        parts += [f"`{scene}`, {size[0]} × {size[1]}, {views} view{'s' if views > 1 else ''}:",
                  table(head, list(rows_of(answer, scene)))]
    return "\n\n".join(parts)


if __name__ == "__main__":
    report(__doc__, tables)
