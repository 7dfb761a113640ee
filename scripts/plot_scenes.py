#!/usr/bin/python3
"""Plots the cost of scenes against their parts from the results of bench_scenes.

usage: plot_scenes.py [RESULTS [PICTURE.svg]]; default: bench/results/scenes.txt and docs/pictures/scenes.svg.
"""

import pathlib
import re
import sys

from plotting import panels, save

ROOT = pathlib.Path(__file__).resolve().parent.parent
CURVES = {"broad phase": ("#0072b2", "-"), "verdicts": ("#d55e00", "--")}


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
    figure, (axis,) = panels(1, 1, (6.7, 3.8))
    for (name, (colour, style)), words in zip(CURVES.items(), ("broad phase", "broad phase and verdicts")):
        axis.loglog(counts, [costs[name][n] for n in counts], "o", color=colour, ls=style, label=words)
        for n in counts:
            axis.annotate(f"{costs[name][n]:.1f}", (n, costs[name][n]), (0, 6), textcoords="offset points", ha="center")
    for n in counts:
        axis.text(n, 0.62, f"{memory[n]:.0f} bytes", ha="center")
    axis.set(xlim=(counts[0] / 1.6, counts[-1] * 1.6), ylim=(0.5, 100), ylabel="microseconds a part",
             xlabel="parts; below the curves, memory of the broad phase a part at its peak")
    axis.set_yticks((1, 10, 100), (1, 10, 100))
    axis.minorticks_off()
    save(figure, path, "Cost of a scene against its parts", 2)


if __name__ == "__main__":
    given = [pathlib.Path(word) for word in sys.argv[1:]]
    main(*(given + [ROOT / "bench/results/scenes.txt", ROOT / "docs/pictures/scenes.svg"][len(given):]))
