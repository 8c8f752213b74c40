#!/usr/bin/env python3
"""Prints how long frames with an effect take, relative to the same lights without it: the tables of docs/profiles.md,
docs/area_lights.md, docs/light_hulls.md and docs/environment.md.

    effect_times.py LIGHTGRID DEVICE [ROUNDS]

visibility, hall, 1280 x 720; medians of ratios of runs that alternate: processor time and the sum of kernels.
"""
import json
import pathlib
import statistics
import sys
import tempfile

from price_of_sameness import frame_ms

ASSETS = pathlib.Path(__file__).resolve().parent.parent / "assets" / "profiles"
HULL = "1 0 0 3, -1 0 0 3, 0 1 0 2, 0 -1 0 9, 0 0 1 3, 0 0 -1 3"
RECTANGLE = {"type": "rectangle", "area_width": 0.5, "area_height": 1.2, "up_axis": [0, 0, 1]}


def lights_file(folder, name, change):
    """The lights of hall.json without profiles, each changed."""
    file = json.loads((ASSETS / "hall.json").read_text())
    for light in file["lights"]:
        del light["profile"]
        light.pop("up_axis", None)
        change(light)
    path = folder / (name + ".json")
    path.write_text(json.dumps(file))
    return ["hall", "--lights-file", str(path)]


def half_space(light, values):
    light.pop("inner_cone", None)
    light.pop("outer_cone", None)
    light.setdefault("direction", [0, -1, 0])
    light.update(values)


def pairs(folder):
    """For each effect: its name, the words with it, the words without it."""
    of_asset = lambda name: ["hall", "--lights-file", str(ASSETS / name)]
    rectangles = lights_file(folder, "area", lambda light: half_space(light, RECTANGLE))
    spots = lights_file(folder, "spots", lambda light: half_space(
        light, {"type": "spot", "inner_cone": 1.5, "outer_cone": 1.57}))
    yield "profiles", of_asset("hall.json"), of_asset("hall.json") + ["--set", "light-profiles=off"]
    yield "cookies", of_asset("cookies.json"), of_asset("cookies.json") + ["--set", "light-cookies=off"]
    yield ("hulls", lights_file(folder, "hulls", lambda light: light.update(hull=HULL)),
           lights_file(folder, "plain", lambda light: None))
    yield "environment", ["hall", "--environment", "sky"], ["hall"]
    yield "rectangles, 4 points", rectangles + ["--set", "area-points=4"], spots
    yield "rectangles, 16 points", rectangles, spots


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    program, device = sys.argv[1:3]
    rounds = int(sys.argv[3]) if len(sys.argv) == 4 else 3
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for effect, on, off in pairs(folder):
            ratios = []
            for number in range(rounds + 1):  # the first compiles
                with_it, without = (frame_ms(program, device, words + ["-t", "visibility"], folder)
                                    for words in (on, off))
                if number > 0:
                    ratios.append([a / b for a, b in zip(with_it, without)])
            _, processor, kernels = (statistics.median(column) for column in zip(*ratios))
            print("{}: processor {:.2f}, kernels {:.2f}".format(effect, processor, kernels), flush=True)


if __name__ == "__main__":
    main()
