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


def test_says_what_is_not_proved(bracket, pin, tmp_path):
    path = tmp_path / "proof.txt"
    with pytest.warns(UserWarning, match="does not prove that neither solid lies inside the other"):
        snug.collide(bracket, pin, solid=True, certificate=path)
    assert len(verified(path)) == 1
    with pytest.raises(OSError):
        snug.collide(bracket, pin, certificate=tmp_path / "none" / "proof.txt")
