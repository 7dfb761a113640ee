"""A signed distance field on a grid, negative inside: each number lies in a proved interval.

    11_signed_distance.py MESH [PICTURE]
"""

import sys

import numpy as np

import snug

surface = snug.read(sys.argv[1])
lower, upper = np.min(surface.vertices, axis=0), np.max(surface.vertices, axis=0)
steps = 60
x, z = np.meshgrid(np.linspace(lower[0], upper[0], steps), np.linspace(lower[2], upper[2], steps))
points = np.stack([x, np.full_like(x, (lower[1] + upper[1]) / 2), z], axis=-1).reshape(-1, 3)
field = surface.signed_distance(points, absolute="0.1%")
inside = field.upper < 0
print(f"{inside.sum()} of {len(points)} points are inside, {((field.lower <= 0) & (field.upper >= 0)).sum()} undecided")
print(f"the deepest one is {-field.lower.min():.4g} to {-field.upper.min():.4g} inside; widest interval {(field.upper - field.lower).max():.2g}")
if len(sys.argv) > 2:
    from matplotlib import pyplot

    pyplot.figure(figsize=(4, 4))
    pyplot.contourf(x, z, field.upper.reshape(x.shape), 21, cmap="RdBu", vmin=-abs(field.lower).max(), vmax=abs(field.lower).max())
    pyplot.contour(x, z, field.upper.reshape(x.shape), [0], colors="black")
    pyplot.axis("equal")
    pyplot.savefig(sys.argv[2], bbox_inches="tight")
