"""Where do two surfaces cross? Curves, as polylines with boxes that contain them.

    10_contacts.py A B [OUT]
"""

import sys

import numpy as np

import snug

a, b = map(snug.read, sys.argv[1:3])
pose = np.eye(4)
pose[:3, 3] = 0.13 * a.size, 0.07 * a.size, 0.3 * a.size
found = snug.contacts(a, b, pose_b=pose, error="0.1%")
print(found, "- all of them" if found.exhaustive else "- there may be more")
for curve in found.curves:
    length = np.linalg.norm(np.diff(curve.points, axis=0), axis=1).sum()
    print(f"{'closed' if curve.closed else 'open'} curve of length {length:.4g}, {'proved' if curve.proved else 'not proved'}, within {curve.error:.2g}")
if len(sys.argv) > 3:  # polylines as OBJ
    with open(sys.argv[3], "w", encoding="ascii") as file:
        for curve in found.curves:
            file.writelines(f"v {x} {y} {z}\n" for x, y, z in curve.points)
            count = len(curve.points)
            file.write("l " + " ".join(str(i - count) for i in range(count)) + (f" -{count}\n" if curve.closed else "\n"))
