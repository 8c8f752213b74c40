#!/usr/bin/env python3
"""Makes the figures of docs/results/frontier.md and docs/results/families.md and their pictures from the samples in docs/results/frontier.

    tools/frontier_pages.py [--check] [--program FILE]

Samples are the parts of sweeps as `lightgrid frontier` wrote them (docs/frontier_json.md#parts), compressed: RUN.jsonl.xz, or
RUN-1.jsonl.xz, RUN-2.jsonl.xz, … of the scenes of one machine. `lightgrid frontier merge` computes the answer from them. In
the page, what stands between <!-- made: WHAT --> and <!-- end --> is made anew, and each <!--= RUN SCENE LABEL FIGURE -->text<!---->
too; what is outside is written by hand and holds no figure. --check writes nothing, and ends with status 1 where a file is not as
it would be made.
"""
import argparse
import csv
import html
import io
import json
import lzma
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import family_pages
import frontier_table

ROOT = pathlib.Path(__file__).resolve().parent.parent
SAMPLES = ROOT / "docs/results/frontier"
PAGE = ROOT / "docs/results/frontier.md"
PICTURE = ROOT / "docs/images/frontier_planes.svg"
FAMILIES_PAGE = ROOT / "docs/results/families.md"  # page of FAMILIES.jsonl.xz
FAMILIES = "families"
FAMILIES_ON_GPU = "h100_families"
FAMILIES_PICTURES = {ROOT / "docs/images/families.svg": "picture", ROOT / "docs/images/families_passes.svg": "passes_picture"}
# The time of a run that its tables and picture show, and its name there.
CLOCKS = {"cpu": ("relative_time", "frame_ms", "fronts", "flip_front_bands", "controls", "cheapest_within_flip", "wall time"),
          "h100": ("relative_device_time", "device_ms", "device_fronts", "device_flip_front_bands", "device_controls",
                   "device_cheapest_within_flip", "device time")}
NAMES = {"cpu": "two CPU cores", "h100": "H100"}


def merged(program, file, name):
    """The text of a file of the answer that a part's samples make."""
    with tempfile.TemporaryDirectory() as folder:
        part = pathlib.Path(folder) / "part"
        part.mkdir()
        (part / "records-0-of-1.jsonl").write_bytes(lzma.decompress(file.read_bytes()))
        command = [program, "frontier", "merge", str(part), "-o", folder + "/answer", "--page-mb", "1", "--quiet"]
        status = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if status.returncode not in (0, 1):  # 1: lights lost by design
            sys.exit(f"{file.name}: {status.stderr}")
        return (pathlib.Path(folder) / "answer" / name).read_text()


def answer_of(program, run):
    """The joined answers of a run's parts."""
    joined = None
    for file in sorted([*SAMPLES.glob(f"{run}.jsonl.xz"), *SAMPLES.glob(f"{run}-*.jsonl.xz")]):
        answer = json.loads(merged(program, file, "frontier.json"))
        if joined is None:
            joined = answer | {"commits": [answer["commit"]]}
            continue
        joined["commits"] = list(dict.fromkeys([*joined["commits"], answer["commit"]]))
        for name in ("cheapest_within_flip", "device_cheapest_within_flip"):  # name points by their index
            for entry in answer[name]:
                entry["point"] += len(joined["points"])
        for name, value in answer.items():
            if isinstance(value, list):
                joined[name] += value
    return joined


def three(value):
    """Three significant digits."""
    if value is None:
        return "-"
    if value == 0:
        return "0"
    digits = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:,.{digits}f}" if digits < 6 else f"{value:.1e}"


def flip_of(point, of="total"):
    error = point["error"]["total"] if of == "total" else point["error"].get("authored", {}).get("total", {})
    shown = error.get("displayed_flip")
    return shown["mean"] if shown else None


def interval(time):
    return f"{three(time['estimate'])} ({three(time['ci95'][0])} to {three(time['ci95'][1])})"


def share(probability):
    """A probability is null where a scene's control failed."""
    return "not measured" if probability is None else f"{100 * probability:.0f} %"


def percent(share):
    return "-" if share is None else f"{100 * share:+.1f} %".replace("+0.0 %", "0.0 %").replace("-0.0 %", "0.0 %")


def table(head, rows):
    align = ["---"] + ["---:"] * (len(head) - 1)
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, align, *rows]) + "\n"


class Run:
    def __init__(self, name, answer):
        self.name, self.answer = name, answer
        self.time, self.ms, self.fronts, self.bands, self.controls, self.within, self.clock = CLOCKS[name]

    def points(self, scene):
        points = [p for p in self.answer["points"] if p["scene"] == scene and p[self.time]["estimate"] is not None]
        return sorted(points, key=lambda p: p[self.time]["estimate"])

    def point(self, scene, label):
        return next(p for p in self.points(scene) if p["label"] == label)

    def machine(self):
        m, a = self.answer["machine"], self.answer
        size = a["points"][0]["size"]
        scenes = []
        for scene in a["scenes"]:
            of = self.points(scene)
            flips = max(p["error"]["flip_views"] for p in of)
            timed = f"{of[0]['timed_views']} timed, " if of[0]["timed_views"] < of[0]["views"] else ""
            scenes.append(f"`{scene}` {of[0]['views']} views ({timed}{flips} with HDR-FLIP and flicker), {max(p[self.time]['runs'] for p in of)} rounds")
        shared = sum(p["shared_rounds"] for p in a["processes"])
        rounds = sum(p["rounds"] for p in a["processes"])
        return (f"{m['cl_device']}, {m['cl_driver']}; OpenGL: {m['gl_device']}, {m['gl_driver']}; {m['cpu']}; {size[0]} × {size[1]}; commit "
                f"{', '.join(a['commits'])}. {len(a['points'])} points: {'; '.join(scenes)}. Others used the processors in {shared} of {rounds} "
                f"rounds. Times: {self.clock}.\n")

    def made_controls(self):
        rows = []
        for wall, device in zip(self.answer["controls"], self.answer["device_controls"] or self.answer["controls"]):
            rows.append([f"`{wall['scene']}`", interval(device["relative_time"]), interval(wall["relative_time"]),
                         f"{max(0, (device if self.name == 'h100' else wall)['widened_by'] - 1) * 100:.1f} %"])
        return table(["scene", "device time", "wall-clock time", "intervals widened by"], rows)

    def made_front(self, *scenes):
        rows = []
        for scene in scenes or self.answer["scenes"]:
            for p in self.points(scene):
                front = p[self.fronts]["total"]
                if front["on"]:
                    rows.append([f"`{scene}`", f"`{p['label']}`", interval(p[self.time]), three(flip_of(p)),
                                 percent(p["error"]["total"]["energy_rel"]), share(front["probability"])])
        return table(["scene", "point", "time relative to `forward_plus`", "FLIP as displayed", "energy", "on the front with"], rows)

    def made_techniques(self):
        """Each technique as it is, its time in every scene, and how far it is from authored ranges."""
        scenes = self.answer["scenes"]
        labels = [p["label"] for p in self.answer["points"] if p["label"] in (p["technique"], p["technique"] + ":raster=opencl")]
        labels = list(dict.fromkeys(labels))
        times = {label: [next((p for p in self.points(s) if p["label"] == label), None) for s in scenes] for label in labels}
        order = sorted(labels, key=lambda label: sum(math.log(p[self.time]["estimate"]) for p in times[label] if p))
        rows = []
        for label in order:
            of = times[label]
            worst = max((flip_of(p, "authored") or 0 for p in of if p), default=0)
            lost = sum(p["pairs"]["lost"] for p in of if p)
            rows.append([f"`{label}`", *(three(p[self.time]["estimate"]) if p else "-" for p in of), three(worst), f"{lost:,}"])
        return table(["technique", *(f"`{s}`" for s in scenes), "largest FLIP from authored ranges", "lost pairs"], rows)

    def made_within(self):
        """The cheapest point within each FLIP, a column per scene."""
        cells = {}
        for c in self.answer[self.within]:
            if c["of"] == "total":
                label = self.answer["points"][c["point"]]["label"]
                cells.setdefault(c["flip"], {})[c["scene"]] = f"`{label}` {three(c['relative_time']['estimate'])}"
        scenes = self.answer["scenes"]
        return table(["FLIP up to", *(f"`{s}`" for s in scenes)],
                     [[f"{flip:g}", *(of.get(s, "-") for s in scenes)] for flip, of in sorted(cells.items())])

    def made_range(self):
        labels = ["visibility", "visibility:far-light=4096", "visibility:range=stochastic"]
        labels += [f"visibility:range=cutoff,cutoff={c}" for c in ("0.2", "0.05", "0.005", "0.001", "0.0001")] + ["visibility:range=infinite"]
        rows = []
        for label in labels:
            row = [f"`{label}`"]
            for scene in self.answer["scenes"]:
                p = next((p for p in self.points(scene) if p["label"] == label), None)
                row.append(f"{three(p[self.ms]['median'])} / {three(flip_of(p))} / {percent(p['error']['total']['energy_rel'])}" if p else "-")
            rows.append(row)
        return table(["point", *(f"`{s}`: ms / FLIP / energy" for s in self.answer["scenes"])], rows)

    def made_break_even(self):
        steps = [("forward_plus", "forward_plus:cull-test=sphere", "`sphere` to `planes+aabb`"),
                 ("forward_plus:cull-test=exact", "forward_plus", "`planes+aabb` to `exact`")]
        ends = lambda ci: f"{three(ci[0])} to {'never' if ci[1] is None else three(ci[1])}" if ci else "-"
        rows = []
        for tighter, looser, words in steps:
            of = {b["scene"]: b for b in self.answer["break_even"] if (b["tighter"], b["looser"]) == (tighter, looser)}
            rows.append([words, *(ends(of[s]["ci95"]) if s in of and of[s]["rounds"] else "-" for s in self.answer["scenes"])])
        costs = {c["scene"]: c for c in self.answer["shading_costs"] if (c["technique"], c["brdf"]) == ("forward_plus", "ggx")}
        rows.append(["a pixel and light of `forward_plus`", *(f"{three(costs[s]['ns_per_pixel_light'])} ({ends(costs[s]['ci95'])})" if s in costs else "-" for s in self.answer["scenes"])])
        return table(["", *(f"`{s}`" for s in self.answer["scenes"])], rows)

    def made(self, what):
        name, *arguments = what
        return {"machine": self.machine, "controls": self.made_controls, "front": self.made_front, "within": self.made_within,
                "techniques": self.made_techniques, "range": self.made_range, "break-even": self.made_break_even}[name](*arguments)

    def figure(self, scene, label, what):
        p = self.point(scene, label)
        return {"time": lambda: three(p[self.time]["estimate"]), "ms": lambda: three(p[self.ms]["median"]), "flip": lambda: three(flip_of(p)),
                "energy": lambda: percent(p["error"]["total"]["energy_rel"]), "wall-ms": lambda: three(p["frame_ms"]["median"]),
                "flicker": lambda: three(p["error"]["temporal_rmse_rel"]), "authored": lambda: three(flip_of(p, "authored"))}[what]()


# --- The picture

COLORS = [("", "far-light", "#d1495b", "with far light"), ("visibility", "", "#1b6ca8", "visibility"),
          ("world_grid", "", "#2a9d5c", "world_grid"), ("voxel_lights", "", "#8e6bbf", "voxel_lights"), ("lidr", "", "#b8860b", "lidr"),
          ("", "", "#8a8f98", "other techniques, drawn with OpenGL")]


def color_of(point):
    return next(c for t, part, c, _ in COLORS if point["technique"].startswith(t) and part in point["label"])


class Plane:
    """A scene's points in the plane of error and time; both logarithmic, with a line of its own for 0."""
    width, height, left, top = 260, 260, 46, 24
    least_flip = 1e-3

    def __init__(self, run, scene, x, y, ends):
        self.run, self.scene, self.x, self.y, self.ends = run, scene, x, y, ends

    def across(self, time):
        low, high = self.ends
        share = (math.log(time) - math.log(low)) / (math.log(high) - math.log(low))
        return self.x + self.left + min(max(share, 0), 1) * (self.width - self.left - 8)

    def up(self, flip):
        inner = self.height - self.top - 40
        bottom = self.y + self.top + inner
        return bottom + 14 if flip < self.least_flip else bottom - inner * math.log(flip / self.least_flip) / math.log(1 / self.least_flip)

    def draw(self, out):
        run, points = self.run, self.run.points(self.scene)
        right, bottom = self.x + self.width - 8, self.up(0)
        text = lambda x, y, s, anchor="middle", more="": out.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {more}>{html.escape(s)}</text>')
        text((self.x + self.left + right) / 2, self.y + 14, f"{self.scene}, {NAMES[run.name]}", more='font-weight="bold"')
        for flip, label in [(1, "1"), (0.1, "0.1"), (0.01, "0.01"), (0.001, "0.001"), (0, "0")]:
            y = self.up(flip)
            out.append(f'<path d="M{self.x + self.left} {y:.1f}H{right}" stroke="#d9dce1"/>')
            text(self.x + self.left - 5, y + 3.5, label, "end")
        for time in (0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30):
            if self.ends[0] <= time <= self.ends[1]:
                text(self.across(time), bottom + 15, f"{time:g}")
                out.append(f'<path d="M{self.across(time):.1f} {self.up(1):.1f}V{bottom:.1f}" stroke="#eceef1"/>')
        band = next((b["steps"] for b in run.answer[run.bands] if b["scene"] == self.scene and b["of"] == "total"), [])
        for i, step in enumerate(band):
            above = band[i + 1]["flip"] if i + 1 < len(band) else 1
            if step["ci95"] and None not in step["ci95"]:
                a, b = map(self.across, step["ci95"])
                out.append(f'<rect x="{a:.1f}" y="{self.up(above):.1f}" width="{max(b - a, 0.8):.1f}" height="{self.up(step["flip"]) - self.up(above):.1f}" fill="#1b1f24" opacity="0.13"/>')
        path, last = "", None
        for p in [p for p in points if p[run.fronts]["total"]["on"]]:
            x, y = self.across(p[run.time]["estimate"]), self.up(flip_of(p))
            path += f"M{x:.1f} {y:.1f}" if last is None else f"H{x:.1f}V{y:.1f}"
            last = y
        out.append(f'<path d="{path}" fill="none" stroke="#1b1f24" stroke-width="1"/>')
        for p in sorted(points, key=lambda p: p[run.fronts]["total"]["on"]):
            if flip_of(p) is None:
                continue
            on = p[run.fronts]["total"]["on"]
            x, y = self.across(p[run.time]["estimate"]), self.up(flip_of(p))
            out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{3.4 if on else 2.2}" fill="{color_of(p)}" opacity="{1 if on else 0.55}">'
                       f"<title>{html.escape(p['label'])}</title></circle>")


def picture_of(runs):
    out, rows = [], list(runs.values())
    scenes = max((run.answer["scenes"] for run in rows), key=len)
    width, height = Plane.width * len(scenes), Plane.height * len(rows) + 52
    for r, run in enumerate(rows):
        times = [p[run.time]["estimate"] for s in run.answer["scenes"] for p in run.points(s)]
        ends = min(times) / 1.2, max(times) * 1.2
        for scene in run.answer["scenes"]:
            Plane(run, scene, Plane.width * scenes.index(scene), Plane.height * r, ends).draw(out)
    y = Plane.height * len(rows) + 14
    out.append(f'<text x="{width / 2}" y="{y}" text-anchor="middle">time over forward_plus ({html.escape("; ".join(f"{NAMES[n]}: {r.clock}" for n, r in runs.items()))}); '
               "upwards: FLIP of the whole picture as displayed, against every light without a range</text>")
    x = 20
    for _, _, color, name in COLORS:
        out.append(f'<circle cx="{x}" cy="{y + 20}" r="3.4" fill="{color}"/><text x="{x + 8}" y="{y + 24}">{name}</text>')
        x += 26 + 6.1 * len(name)
    out.append(f'<path d="M{x} {y + 20}h18" stroke="#1b1f24"/><text x="{x + 24}" y="{y + 24}">the front, and where it lies with 95 %</text>')
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" font-family="sans-serif" '
            f'font-size="11" fill="#1b1f24"><rect width="{width}" height="{height}" fill="#ffffff"/>\n' + "\n".join(out) + "\n</svg>\n")


# --- Files

def made_page(text, runs):
    def block(match):
        run, *what = match[1].split()
        return f"<!-- made: {match[1]} -->\n\n{runs[run].made(what)}\n<!-- end -->"

    def figure(match):
        run, scene, label, what = match[1].split()
        return f"<!--= {match[1]} -->{runs[run].figure(scene, label, what)}<!---->"

    text = re.sub(r"<!-- made: ([^>]*?) -->.*?<!-- end -->", block, text, flags=re.S)
    return re.sub(r"<!--= ([^>]*?) -->.*?<!---->", figure, text, flags=re.S)


def files_of(program):
    runs = {name: Run(name, answer) for name in CLOCKS if (answer := answer_of(program, name))}
    files = {PAGE: made_page(PAGE.read_text(), runs), PICTURE: picture_of(runs)}
    for name, run in runs.items():
        out = io.StringIO()
        frontier_table.write(run.answer, out)
        files[SAMPLES / f"{name}.csv"] = out.getvalue()
    text = lzma.decompress((SAMPLES / f"{FAMILIES}.jsonl.xz").read_bytes()).decode()
    on_gpu = list(csv.DictReader(io.StringIO(merged(program, SAMPLES / f"{FAMILIES_ON_GPU}.jsonl.xz", "frontier.csv"))))
    families = family_pages.Families(answer_of(program, FAMILIES), text, on_gpu, answer_of(program, FAMILIES_ON_GPU), three, table)
    files[FAMILIES_PAGE] = made_page(FAMILIES_PAGE.read_text(), {FAMILIES: families})
    files |= {path: getattr(families, name)() for path, name in FAMILIES_PICTURES.items()}
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--program", default=str(ROOT / "build/src/lightgrid"))
    o = parser.parse_args()
    stale = {path: text for path, text in files_of(o.program).items() if not path.exists() or path.read_text() != text}
    if o.check and stale:
        sys.exit("\n".join(f"{path.relative_to(ROOT)}: is not what its samples make" for path in stale))
    for path, text in stale.items():
        path.write_text(text)


if __name__ == "__main__":
    main()
