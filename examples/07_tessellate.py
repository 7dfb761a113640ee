"""Triangles within a proved distance of the limit surface, written as a file.

    07_tessellate.py MESH OUT
"""

import sys

import snug

mesh, out = sys.argv[1:]
surface = snug.read(mesh)
for error in ("2%", "0.5%", "0.1%"):
    triangles = surface.tessellate(error)
    print(f"{error:>5}: {len(triangles.triangles)} triangles, nowhere farther than {triangles.error_bound:.3g}")
snug.Surface(triangles).write(out)
apart = snug.deviation(surface, triangles)
print(f"compared with the surface: {apart.from_surface.upper:.3g} and {apart.from_candidate.upper:.3g} at most")
