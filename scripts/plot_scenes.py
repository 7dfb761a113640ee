#!/usr/bin/env python3
"""Plots the cost of scenes against their parts from the results of bench_scenes.

usage: plot_scenes.py [RESULTS [PICTURE.svg]]; default: bench/results/scenes.txt and docs/pictures/scenes.svg.
"""

import math
import pathlib
import re
import sys

from plot_experiments import Axes, legend, plain_entry, power
from svg_picture import Picture

ROOT = pathlib.Path(__file__).resolve().parent.parent
CURVES = {"broad phase": ("#0072b2", None), "verdicts": ("#d55e00", "7 4")}


def read(path):
    """Microseconds a part and bytes a part, by name and number of parts."""
    costs, memory, parts = {name: {} for name in CURVES}, {}, None
    for line in path.read_text(encoding="utf-8").splitlines():
        if title := re.match(r"packed loosely, (\d+) parts", line):
            parts = int(title[1])
        elif found := re.match(r"  broad phase, (\d+) parts .* ([\d.]+) bytes/part", line):
            memory[int(found[1])] = float(found[2])
        elif parts and (found := re.match(r"  (broad phase|verdicts) +([\d.]+) us/part", line)):
            costs[found[1]][parts] = float(found[2])
    if not memory or any(set(curve) != set(memory) for curve in costs.values()):
        sys.exit(f"{path}: no figures a part; run bench/run --save scenes")
    return costs, memory


def main(results, path):
    costs, memory = read(results)
    counts = sorted(memory)
    picture = Picture(640, 360, "Cost of a scene against its parts")
    axes = Axes(picture, (75, 60, 520, 230), (math.log10(counts[0]) - 0.2, math.log10(counts[-1]) + 0.2), (0.5, 100), True)
    axes.ticks_y([(y, f"{y:g}") for y in (1, 10, 100)])
    axes.ticks_x([(math.log10(n), power(round(math.log10(n)))) for n in counts])
    for name, (colour, dash) in CURVES.items():
        points = [axes.at(math.log10(n), costs[name][n]) for n in counts]
        picture.path(points, colour, dash=dash)
        for n, (x, y) in zip(counts, points):
            picture.mark("circle", x, y, colour)
            picture.text(x, y - 9, f"{costs[name][n]:.1f}", "middle")
    for n in counts:
        x, y = axes.at(math.log10(n), 0.62)
        picture.text(x, y, f"{memory[n]:.0f} bytes", "middle")
    axes.label_x("parts; below the curves, memory of the broad phase a part at its peak")
    axes.label_y("microseconds a part")
    legend(picture, 75, 30, [(plain_entry(picture, dash, colour), words) for (colour, dash), words in
                             zip(CURVES.values(), ("broad phase", "broad phase and verdicts"))], 200)
    picture.save(path)


if __name__ == "__main__":
    given = [pathlib.Path(word) for word in sys.argv[1:]]
    main(*(given + [ROOT / "bench/results/scenes.txt", ROOT / "docs/pictures/scenes.svg"][len(given):]))
