"""A row of parts: which of them touch, if neighbours may?

    08_scene.py MESH
"""

import sys

import numpy as np

import snug

part = snug.read(sys.argv[1])  # one surface, in many places
manager = snug.CollisionManager()
for i in range(12):
    angle = np.radians(30 * i)
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    pose[0, 3] = 0.6 * part.size * i
    manager.add_object(str(i), part, pose, group="even" if i % 2 == 0 else "odd")
touch, names = manager.in_collision_internal(return_names=True)
print(touch, sorted(names, key=lambda pair: tuple(map(int, pair))))
manager.allow("even", "odd")
print("without neighbours:", manager.in_collision_internal(return_names=True))
print("the others are at least", manager.min_distance_internal(), "apart")
