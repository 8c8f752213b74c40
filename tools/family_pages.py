"""Writes docs/results/families.md about two families of lights from the part that `lightgrid frontier --families` wrote: for
frontier_pages.py."""
import html
import json
import math

SERIES = {"equal overlap": "lights, ten of them at a pixel in the mean", "overlap": "lights that reach a pixel, of 10,000"}
COLORS = {"forward_plus": "#8a8f98", "clustered": "#b8860b", "deferred_tiled": "#d1495b", "world_grid": "#2a9d5c", "visibility": "#1b6ca8"}
COPIES, LISTS, LIGHT, SURFACES = range(4)
STAGES = [("copies between APIs", "#8c6a4f"), ("lists of lights", "#3f9b58"), ("light and materials", "#d9822b"), ("surfaces and depth bounds", "#3b6fb6")]


def stage_of(name):
    if name.endswith(("_to_cl", "_to_gl")):
        return COPIES
    if name.startswith(("shade", "resolve")):
        return LIGHT
    return LISTS if any(part in name for part in ("cull", "light", "grid", "lists")) else SURFACES


def short(decade):
    return f"{10**decade:,}" if decade < 5 else f"{10**(decade - 3)}k" if decade < 6 else f"{10**(decade - 6)}M"


def plain(label):
    return label.split(":")[0] if label.split(":")[1:] in ([], ["raster=opencl"]) else None


class Families:
    """answer, text: of a part, as JSON and its lines; on_gpu: the rows of another one's frontier.csv; gpu_answer: and its JSON."""

    def __init__(self, answer, text, on_gpu, gpu_answer, three, table):
        self.answer, self.on_gpu, self.gpu_answer, self.three, self.table = answer, on_gpu, gpu_answer, three, table
        self.records = [json.loads(line)["open"] for line in text.splitlines() if line.startswith('{"open"')]
        self.techniques = list(dict.fromkeys(r["technique"] for r in self.records))

    def growth(self, technique, series):
        return next((g for g in self.answer["growth"] if g["of"] == series and plain(g["technique"]) == technique), None)

    def curves(self, series, of, flip, on_gpu=False):
        all_curves = self.gpu_answer["device_equal_flip"] if on_gpu else self.answer["equal_flip"]
        return {e["technique"]: e for e in all_curves if (e["series"], e["of"], e["flip"]) == (series, of, flip)}

    def steps(self, series):
        return sorted({(r["lights"], r["overlap"]) for r in self.records if r["series"] == series})

    def step_name(self, series, step):
        return f"{step[0]:,}" if series == "equal overlap" else self.three(step[1])

    def made_machine(self):
        m, a = self.answer["machine"], self.answer
        r = self.records[0]
        rounds, shared = (sum(p[key] for p in a["processes"]) for key in ("rounds", "shared_rounds"))
        others = max((p["others_percent"] or 0 for p in a["processes"]), default=0)
        return (f"{m['cl_device']}, {m['cl_driver']}; OpenGL: {m['gl_device']}, {m['gl_driver']}; {m['cpu']}, {m['threads']} threads; load "
                f"{m['load_at_start']:.1f} at the start, {m['load_at_end']:.1f} at the end; {r['width']} × {r['height']}; commit {a['commit']}; baseline "
                f"`{a['baseline']}`. Others used the processors in {shared} of {rounds} rounds, up to {others:.0f} % of them.\n")

    def made_steps(self):
        rows = []
        for series, words in (("equal overlap", "number"), ("overlap", "overlap")):
            for step in self.steps(series):
                of = [r for r in self.records if (r["series"], r["lights"], r["overlap"]) == (series, *step)]
                exact = [r for r in of if not r["refused"] and r["settings"].get("list_cap", "off") == "off"]
                rows.append([words, f"{step[0]:,}", f"{step[1]:.3f}", f"{of[0]['radius_scale']:.3f}", f"{sum(bool(r['refused']) for r in of)} of {len(of)}",
                             f"{sum(r['pairs']['lost'] for r in exact):,} of {sum(r['pairs']['lit'] for r in exact):,}"])
        return self.table(["family", "lights", "per pixel", "scale of ranges", "refused points", "pairs lost by exact lists"], rows)

    def made_growth(self):
        rows = []
        for technique in self.techniques:
            row = [f"`{technique}`"]
            for series in SERIES:
                g = self.growth(technique, series)
                if not g:
                    row += ["-", "-"]
                    continue
                (x0, t0), (x1, t1) = g["samples"][0], g["samples"][-1]
                low, high = g["ci95"]
                span = f" ({low:.2f} to {high:.2f})" if low is not None else ""
                name = (lambda x: f"{x:,.0f}") if series == "equal overlap" else self.three
                row += [f"{g['exponent']:.2f}{span}", f"{self.three(t0)} ({name(x0)}) to {self.three(t1)} ({name(x1)})"]
            rows.append(row)
        return self.table(["technique", "exponent over lights", "ms", "exponent over the overlap", "ms"], rows)

    def made_equal(self, series, of, flip, on_gpu=False):
        series = series.replace("-", " ")
        curves = self.curves(series, of, float(flip), on_gpu)
        steps = self.steps(series)
        if on_gpu:
            steps = sorted({(int(r["lights"]), float(r["overlap"])) for r in self.on_gpu if r["series"] == series})
        x_of = (lambda s: s[0]) if series == "equal overlap" else (lambda s: s[1])
        rows = []
        for technique in self.techniques:
            curve = curves.get(technique)
            row = [f"`{technique}`"]
            for step in steps:
                sample = next((s for s in curve["samples"] if math.isclose(s["x"], x_of(step), rel_tol=1e-6)), None) if curve else None
                settings = sample["label"].partition(":")[2].replace("raster=opencl", "").strip(",") if sample else ""
                row.append(f"{self.three(sample['ms'])}{f' `{settings}`' if settings else ''}" if sample else "-")
            rows.append(row + [f"{curve['exponent']:.2f}" if curve and len(curve["samples"]) > 1 else "-"])
        return self.table(["technique", *(self.step_name(series, s) for s in steps), "exponent"], rows)

    def made_device_equal(self, *what):
        return self.made_equal(*what, on_gpu=True)

    def made_device(self, series):
        """Milliseconds on the devices of each technique as it is, and of the light tree."""
        series = series.replace("-", " ")
        rows = [r for r in self.on_gpu if r["series"] == series]
        steps = sorted({(int(r["lights"]), float(r["overlap"])) for r in rows})
        out = []
        for label in dict.fromkeys(r["label"] for r in rows):
            if not plain(label) and "tree" not in label:
                continue
            times = {(int(r["lights"]), float(r["overlap"])): r["device_ms"] for r in rows if r["label"] == label}
            name = plain(label) or label
            out.append([f"`{name}`", *(self.three(float(times[s])) if times.get(s) else "-" for s in steps)])
        return self.table(["technique", *(self.step_name(series, s) for s in steps)], out)

    def made(self, what):
        return {"machine": self.made_machine, "steps": self.made_steps, "growth": self.made_growth, "equal": self.made_equal,
                "device": self.made_device, "device-equal": self.made_device_equal}[what[0]](*what[1:])

    # --- Pictures

    def picture(self):
        """Time at equal FLIP: a row a family, a column an error."""
        columns = [("total", 0.001), ("total", 0.06), ("authored", 0.001)]
        width, height, left = 300, 250, 60
        out = []
        times = [s["ms"] for e in self.answer["equal_flip"] for s in e["samples"]]
        low, high = min(times) / 1.3, max(times) * 1.3
        for row, series in enumerate(SERIES):
            xs = [s["x"] for e in self.answer["equal_flip"] if e["series"] == series for s in e["samples"]]
            for column, (of, flip) in enumerate(columns):
                x0, y0, x1, y1 = width * column + left, height * row + 34, width * (column + 1) - 10, height * (row + 1) - 46
                along = lambda v: x0 + 8 + (x1 - x0 - 16) * math.log(v / min(xs)) / math.log(max(xs) / min(xs))
                up = lambda v: y1 - (y1 - y0) * math.log(v / low) / math.log(high / low)
                words = "every light without a range" if of == "total" else "authored ranges"
                out.append(f'<text x="{(x0 + x1) / 2:.0f}" y="{y0 - 12}" text-anchor="middle" font-weight="bold">FLIP within {flip:g} of {words}</text>')
                for decade in range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1):
                    out.append(f'<path d="M{x0} {up(10**decade):.1f}H{x1}" stroke="#d9dce1"/><text x="{x0 - 5}" y="{up(10**decade) + 4:.1f}" text-anchor="end">{10**decade:g} ms</text>')
                for decade in range(math.ceil(math.log10(min(xs)) - 0.01), math.floor(math.log10(max(xs)) + 0.01) + 1):
                    out.append(f'<text x="{along(10**decade):.1f}" y="{y1 + 16}" text-anchor="middle">{short(decade)}</text>')
                out.append(f'<text x="{(x0 + x1) / 2:.0f}" y="{y1 + 33}" text-anchor="middle">{SERIES[series]}</text>')
                for technique, e in self.curves(series, of, flip).items():
                    places = [(along(s["x"]), up(s["ms"]), s) for s in e["samples"]]
                    path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y, _ in places)
                    out.append(f'<path d="{path}" fill="none" stroke="{COLORS[technique]}" stroke-width="1.6"/>')
                    for x, y, s in places:
                        title = html.escape(f"{s['label']}: {self.three(s['ms'])} ms")
                        out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{COLORS[technique]}"><title>{title}</title></circle>')
        return svg(width * 3, height * 2 + 30, out, [(name, COLORS[name]) for name in self.techniques], height * 2 + 14)

    def passes_picture(self):
        """Passes of each technique as it is, at three numbers of lights: times to the left, bytes to the right."""
        out, y, numbers = [], 20, [n for n, _ in self.steps("equal overlap")]
        shown = [n for n in (100, 10000, 100000) if n in numbers]
        rows = [(n, r) for n in shown for r in self.records if r["series"] == "equal overlap" and r["lights"] == n and plain(r["label"]) and not r["refused"]]
        halves = [("pass_ms", 170, 310, "ms"), ("pass_bytes", 560, 270, "MB")]
        for key, x, _, unit in halves:
            out.append(f'<text x="{x}" y="14" font-weight="bold">{"times of passes" if unit == "ms" else "bytes that they read and write"}</text>')
        for n in shown:
            out.append(f'<text x="8" y="{y + 14}" font-weight="bold">{n:,} lights</text>')
            y += 22
            of = [r for m, r in rows if m == n]
            for r in of:
                out.append(f'<text x="160" y="{y + 12}" text-anchor="end">{plain(r["label"])}</text>')
                for key, x, width, unit in halves:
                    scale = max(sum(o[key].values()) for o in of)
                    parts = sorted(((stage_of(name), name, value) for name, value in r[key].items() if value > 0), key=lambda part: (-part[0], part[1]))
                    at = x
                    for stage, name, value in parts:
                        w = width * value / scale
                        text = f"{self.three(value)} ms" if unit == "ms" else f"{self.three(value / 1e6)} MB"
                        out.append(f'<rect x="{at:.1f}" y="{y}" width="{max(w, 0.3):.1f}" height="15" fill="{STAGES[stage][1]}"><title>{name}: {text}</title></rect>')
                        at += w
                    total = sum(r[key].values())
                    text = f"{self.three(total)} ms" if unit == "ms" else f"{self.three(total / 1e6)} MB"
                    out.append(f'<text x="{at + 5:.1f}" y="{y + 12}">{text}</text>')
                y += 18
            y += 8
        return svg(900, y + 26, out, STAGES, y + 12)


def svg(width, height, parts, names, y):
    x = 20
    for name, color in names:
        parts.append(f'<rect x="{x}" y="{y - 8}" width="10" height="10" fill="{color}"/><text x="{x + 15}" y="{y + 1}">{name}</text>')
        x += 34 + 6.2 * len(name)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" font-family="sans-serif" '
            f'font-size="11" fill="#1b1f24"><rect width="{width}" height="{height}" fill="#ffffff"/>\n' + "\n".join(parts) + "\n</svg>\n")
