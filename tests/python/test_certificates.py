"""Proofs of answers, which another program verifies."""

import os
import subprocess

import numpy as np
import pytest

from conftest import PROGRAMS, moved

import snug


def verified(path):
    """What snug-check says of a file, a line a question."""
    program = os.environ.get("SNUG_CHECK")
    if program is None:
        pytest.skip("snug-check was not built")
    done = subprocess.run([program, str(path)], capture_output=True, text=True, check=False, env=PROGRAMS)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_of_a_pair_and_of_poses(bracket, pin, tmp_path):
    path = tmp_path / "proof.txt"
    far = snug.distance(bracket, pin, certificate=path)
    assert far.lower > 0
    (line,) = verified(path)
    assert "are farther apart than 0.0" in line and "are at most 0.0" in line
    poses = np.array([moved(x) for x in (2.0, 3.0, 4.0)])
    assert snug.collide(bracket, pin, pose_b=poses, certificate=str(path)).separated.all()
    assert len(verified(path)) == 3


def test_of_points_and_rays(bracket, tmp_path):
    path = tmp_path / "proof.txt"
    bracket.closest_point([[3, 0, 0], [0, 4, 0]], certificate=path)
    assert len(verified(path)) == 2
    bracket.ray([9, 9, 9], [1, 0, 0], certificate=path)
    assert any("have no point in common" in line for line in verified(path))
    with pytest.raises(ValueError, match="certificate"):
        bracket.ray([9, 9, 9], [1, 0, 0], certified=False, certificate=path)


def test_of_signed_distances_and_containment(bracket, tmp_path):
    path = tmp_path / "proof.txt"
    points = np.array([[5.0, 0, 0], [0, 0, 0.5], [0.3, 0.2, 0.1]])
    far = bracket.signed_distance(points, certificate=path)
    inside = bracket.contains(points, certificate=tmp_path / "inside.txt")
    lines = verified(path)
    assert len(lines) == 3 and verified(tmp_path / "inside.txt")
    for i, line in enumerate(lines):
        winds = "winding number 0" not in line
        assert winds == bool(far.upper[i] < 0) == bool(inside.inside[i])


def test_says_what_is_not_proved(bracket, pin, tmp_path):
    path = tmp_path / "proof.txt"
    with pytest.warns(UserWarning, match="not written, there is no proof of the verdict, which is undecided"):
        snug.collide(pin, pin, tolerance=0, max_splits=1000, certificate=path)
    assert not path.exists()
    with pytest.raises(OSError):
        snug.collide(bracket, pin, certificate=tmp_path / "none" / "proof.txt")
