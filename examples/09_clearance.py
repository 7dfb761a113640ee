"""A part flies past another one: how near does it come, and when? Bounds for every time, not at samples.

    09_clearance.py A B [PICTURE]
"""

import sys

import numpy as np

import snug

a, b = map(snug.read, sys.argv[1:3])
size = max(a.size, b.size)
start = np.eye(4)
start[:3, 3] = -2 * size, 1.35 * size, 0
path = snug.Trajectory.steady(start, velocity=[4 * size, 0.1 * size, 0], axis=[0, 0, 1], radians=6)
room = snug.clearance(a, None, b, path, absolute="1%")
print(f"never closer than {room.lower:.4g}; at time {room.time:.3f} at most {room.upper:.4g} apart, after {room.steps} looks")
first = snug.time_of_contact(a, None, b, path, margin=room.upper * 1.5)
print(f"not within {room.upper * 1.5:.3g} before time {first.lower:.4f}")
if len(sys.argv) > 3:
    from matplotlib import pyplot

    times = np.linspace(0, 1, 200)
    pyplot.figure(figsize=(6, 3))
    pyplot.stairs(room.spans.lower, [*room.spans.time[:, 0], 1], baseline=None, label="proved")
    pyplot.plot(times, snug.distance(a, b, pose_b=[path.at(time) for time in times]).upper, label="at samples")
    pyplot.xlabel("time")
    pyplot.ylabel("distance")
    pyplot.legend()
    pyplot.savefig(sys.argv[3], bbox_inches="tight")
