#!/usr/bin/env python3
"""flicker.py FILE: the flicker of a sequence, from its pictures, the truth's, and the pixels that each one is carried from.

Written from the papers on FLIP (Andersson et al. 2020) and docs/details/frontier.md, without the program's code: filters are
two-dimensional sums, colours by matrices of their own. Prints mean and largest flicker and the mean FLIP against the truth, of
the frames and of their exponential mean."""
import json
import math
import sys

PIXELS_PER_DEGREE = 67
XYZ = [[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
       [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
       [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]]
WHITE = [sum(row) for row in XYZ]


def inverse(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return [[(e * i - f * h) / det, (c * h - b * i) / det, (b * f - c * e) / det],
            [(f * g - d * i) / det, (a * i - c * g) / det, (c * d - a * f) / det],
            [(d * h - e * g) / det, (b * g - a * h) / det, (a * e - b * d) / det]]


RGB = inverse(XYZ)
times = lambda m, v: [sum(a * b for a, b in zip(row, v)) for row in m]


def opponent(rgb):
    x, y, z = (v / w for v, w in zip(times(XYZ, rgb), WHITE))
    return [116 * y - 16, 500 * (x - y), 200 * (y - z)]


def from_opponent(color):
    y = (color[0] + 16) / 116
    return times(RGB, [v * w for v, w in zip((y + color[1] / 500, y, y - color[2] / 200), WHITE)])


def hunt_lab(rgb):
    curve = lambda t: t ** (1 / 3) if t > (6 / 29) ** 3 else t / (3 * (6 / 29) ** 2) + 4 / 29
    x, y, z = (curve(v / w) for v, w in zip(times(XYZ, rgb), WHITE))
    lightness = 116 * y - 16
    return [lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)]


def hyab(a, b):
    return abs(a[0] - b[0]) + math.hypot(a[1] - b[1], a[2] - b[2])


class Grid:
    def __init__(self, width, height):
        self.width, self.height = width, height

    def filtered(self, values, kernel, radius):
        """kernel: {(dx, dy): weight}; the edge goes on."""
        w, h = self.width, self.height
        clamp = lambda v, top: min(max(v, 0), top - 1)
        columns = [[clamp(x + d, w) for d in range(-radius, radius + 1)] for x in range(w)]
        rows = [[clamp(y + d, h) for d in range(-radius, radius + 1)] for y in range(h)]
        return [sum(k * values[rows[y][dy + radius] * w + columns[x][dx + radius]] for (dx, dy), k in kernel.items())
                for y in range(h) for x in range(w)]


def kernel_of(radius, function):
    return {(x, y): function(x, y) for x in range(-radius, radius + 1) for y in range(-radius, radius + 1)}


def sensitivity(*terms):
    radius = math.ceil(3 * math.sqrt(0.04 / (2 * math.pi ** 2)) * PIXELS_PER_DEGREE)
    value = lambda x, y: sum(a * math.sqrt(math.pi / b) * math.exp(-math.pi ** 2 * (x * x + y * y) / PIXELS_PER_DEGREE ** 2 / b) for a, b in terms)
    kernel = kernel_of(radius, value)
    total = sum(kernel.values())
    return {at: k / total for at, k in kernel.items()}, radius


def feature(of):
    sigma = 0.5 * 0.082 * PIXELS_PER_DEGREE
    radius = math.ceil(3 * sigma)
    gaussian = lambda x, y: math.exp(-(x * x + y * y) / (2 * sigma ** 2))
    kernel = kernel_of(radius, lambda x, y: of(x, sigma) * gaussian(x, y))
    up, down = (abs(sum(k for k in kernel.values() if k * sign > 0)) for sign in (1, -1))
    return {at: k / (up if k > 0 else down) for at, k in kernel.items()}, radius


SENSITIVITIES = [sensitivity((1, 0.0047)), sensitivity((1, 0.0053)), sensitivity((34.1, 0.04), (13.5, 0.025))]
FEATURES = [feature(lambda x, s: -x), feature(lambda x, s: x * x / s ** 2 - 1)]


def seen(image, grid):
    colors = [opponent([min(max(c, 0), 1) for c in pixel]) for pixel in image]
    blurred = zip(*(grid.filtered([c[i] for c in colors], *SENSITIVITIES[i]) for i in range(3)))
    lab = [hunt_lab([min(max(c, 0), 1) for c in from_opponent(c)]) for c in blurred]
    lightness = [(c[0] + 16) / 116 for c in colors]
    magnitudes = []
    for kernel, radius in FEATURES:
        turned = {(y, x): k for (x, y), k in kernel.items()}
        magnitudes.append([math.hypot(a, b) for a, b in zip(grid.filtered(lightness, kernel, radius), grid.filtered(lightness, turned, radius))])
    return lab, *magnitudes


def flip(a, b, grid):
    largest = hyab(hunt_lab([0, 1, 0]), hunt_lab([0, 0, 1])) ** 0.7
    values = []
    for color, edge, point, color2, edge2, point2 in zip(*seen(a, grid), *seen(b, grid)):
        error, knee = hyab(color, color2) ** 0.7, 0.4 * largest
        error = error * 0.95 / knee if error < knee else 0.95 + (error - knee) / (largest - knee) * 0.05
        values.append(error ** (1 - math.sqrt(max(abs(edge - edge2), abs(point - point2)) / math.sqrt(2))))
    return values


mean = lambda values: sum(values) / len(values)


def carried(values, sequence, i):
    x, y, weights = sequence["carried"][i]
    if sum(weights) == 0:
        return None
    places = [(y + dy) * sequence["width"] + x + dx for dy in (0, 1) for dx in (0, 1)]
    return [sum(w * values[place][c] for w, place in zip(weights, places)) for c in range(3)]


def figures(sequence, newest):
    grid = Grid(sequence["width"], sequence["height"])
    steps, errors, last, truth_before = [], [], None, None
    moved = lambda image, now: [c if c is not None else p for c, p in zip((carried(image, sequence, i) for i in range(len(image))), now)]
    for number, (picture, truth) in enumerate(zip(sequence["pictures"], sequence["truths"])):
        if last:
            share = max(newest, 1 / (number + 1))
            picture = [[v + share * (c - v) for c, v in zip(p, b)] for p, b in zip(picture, moved(last, picture))]
            of_picture, of_truth = flip(picture, moved(last, picture), grid), flip(truth, moved(truth_before, truth), grid)
            steps.append(mean([max(p - t, 0) for p, t in zip(of_picture, of_truth)]))
        errors.append(mean(flip(picture, truth, grid)))
        last, truth_before = picture, truth
    return {"flicker": mean(steps), "largest_flicker": max(steps), "displayed_flip": mean(errors)}


sequence = json.load(open(sys.argv[1]))
print(json.dumps({"plain": figures(sequence, 1), "filtered": figures(sequence, sequence["newest"])}))
