"""Models and poses that all tests use. The module under test is the one on PYTHONPATH."""

import os
import pathlib
import tempfile

import hypothesis
import hypothesis.configuration
import numpy as np
import pytest

import snug

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MODELS = ROOT / "examples/models"
# The environment of programs: without the sanitizer's runtime that Python needs before it, as they have their own.
PROGRAMS = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}

hypothesis.configuration.set_hypothesis_home_dir(tempfile.gettempdir())

# SNUG_FUZZ=N: N cases of each random test.
hypothesis.settings.register_profile(
    "snug",
    max_examples=int(os.environ.get("SNUG_FUZZ", "40")),
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=list(hypothesis.HealthCheck),
)
hypothesis.settings.load_profile("snug")

CUBE = np.array([[x, y, z] for x in (-1.0, 1) for y in (-1.0, 1) for z in (-1.0, 1)])
CUBE_FACES = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def moved(x=0.0, y=0.0, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def turned(degrees, x=0.0, y=0.0, z=0.0):
    pose = moved(x, y, z)
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    pose[:2, :2] = [[c, -s], [s, c]]
    return pose


@pytest.fixture(scope="session")
def bracket():
    return snug.read(MODELS / "bracket.obj")


@pytest.fixture(scope="session")
def pin():
    return snug.read(MODELS / "pin.obj")


@pytest.fixture
def cube():
    return snug.Surface(CUBE, CUBE_FACES)
