"""Beside the answers: threads, Ctrl-C, progress, forks, time of import."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
import types

import numpy as np
import pytest

import snug
from conftest import CUBE, CUBE_FACES, MODELS, moved, turned


def test_one_surface_and_many_threads(bracket, pin):
    poses = np.array([turned(3 * i, 0.05 * i - 1) for i in range(40)])
    expected = snug.collide(bracket, pin, pose_b=poses).lower
    found = [None] * 4

    def ask(i):
        found[i] = np.array([snug.collide(bracket, pin, pose_b=pose).lower for pose in poses])

    workers = [threading.Thread(target=ask, args=(i,)) for i in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    for each in found:
        np.testing.assert_array_equal(each, expected)


def test_updates_while_others_ask(cube):
    faults = []
    done = threading.Event()

    def ask():
        try:
            while not done.is_set():
                hits = cube.ray([[0, 0, 9]] * 5, [0, 0, -1], certified=False).t
                near = cube.closest_point(np.zeros((50, 3))).lower
                if len(set(hits)) != 1 or len(set(near)) != 1:
                    faults.append((hits, near))
        except Exception as error:
            faults.append(error)

    workers = [threading.Thread(target=ask) for _ in range(3)]
    for worker in workers:
        worker.start()
    for i in range(60):
        cube.update(CUBE * (1 + i % 3))
    done.set()
    for worker in workers:
        worker.join()
    assert not faults


def test_a_bar(cube, monkeypatch):
    bars = []

    class Bar:
        def __init__(self, total, **_):
            self.n, self.total = 0, total
            bars.append(self)

        def update(self, by):
            self.n += by

    package = types.ModuleType("tqdm")
    package.auto = types.ModuleType("tqdm.auto")
    package.auto.tqdm = Bar
    monkeypatch.setitem(sys.modules, "tqdm", package)
    monkeypatch.setitem(sys.modules, "tqdm.auto", package.auto)
    cube.tessellate("0.5%", progress=True)
    cube.tessellate("0.5%", progress=False)
    assert len(bars) == 1 and 0 < bars[0].n <= bars[0].total
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ValueError, match="tqdm"):
        cube.tessellate("0.5%", progress=True)


def test_progress(cube):
    seen = []
    cube.tessellate("0.5%", progress=seen.append)
    assert seen and all(0 <= done <= 1 for done in seen)

    def fail(done):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        cube.tessellate("0.01%", progress=fail)
    with pytest.raises(LookupError):
        snug.collide(cube, cube, pose_b=[moved(3)] * 5000, progress=fail)
    many = np.zeros(300_000)
    for work in (
        lambda progress: cube.evaluate(np.zeros(len(many), int), many, many, progress=progress),
        lambda progress: cube.ray(np.full((len(many), 3), 9.0), [0, 0, -1], certified=False, progress=progress),
        lambda progress: cube.contains(np.full((len(many), 3), [0.3, 0.2, 0.1]), progress=progress),
    ):
        seen.clear()
        work(seen.append)
        assert seen and all(0 <= done <= 1 for done in seen)
        with pytest.raises(LookupError, match="enough"):
            work(fail)
    # A query within the callback.
    cube.tessellate("0.5%", progress=lambda done: cube.contains([0, 0, 0]))


LONG = """
    import signal, sys, threading, time
    import snug
    surface = snug.read({model!r})
    print("ready", flush=True)
    {handler}
    begin = time.monotonic()
    try:
        surface.tessellate("0.00001%", max_splits=10**9)
    except KeyboardInterrupt:
        print("interrupted", flush=True)
    except {error} as error:
        print("raised", flush=True)
"""


def interrupted(handler="", error="MemoryError"):
    program = textwrap.dedent(LONG).format(model=str(MODELS / "bust.obj"), handler=handler, error=error)
    # As from a terminal: what a shell puts into the background ignores SIGINT.
    heard = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)  # noqa: E731
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, preexec_fn=heard)
    watch = threading.Timer(30, process.kill)
    watch.start()
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    begin = time.monotonic()
    said = process.stdout.readline()
    watch.cancel()
    return said, time.monotonic() - begin, process


def test_ctrl_c_ends_a_long_query():
    said, seconds, process = interrupted()
    assert said == "interrupted\n" and seconds < 1
    assert process.wait(5) == 0


def test_ctrl_c_calls_the_handler_in_place():
    handler = "signal.signal(signal.SIGINT, lambda *_: (_ for _ in ()).throw(LookupError()))"
    said, seconds, process = interrupted(handler, "LookupError")
    assert said == "raised\n" and seconds < 1
    process.wait(5)


def test_the_handler_is_put_back():
    program = """
        import os, signal
        import snug
        cube = snug.Surface({vertices}, {faces})
        snug.collide(cube, cube)
        try:
            os.kill(os.getpid(), signal.SIGINT)
            for _ in range(10**6): pass
        except KeyboardInterrupt:
            pass
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        snug.collide(cube, cube)
        os.kill(os.getpid(), signal.SIGINT)
        print("ignored")
    """
    program = textwrap.dedent(program).format(vertices=CUBE.tolist(), faces=CUBE_FACES.tolist())
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout == "ignored\n"


def test_after_a_fork(cube):
    expected = cube.closest_point([3, 2, 1]).lower
    child = os.fork()
    if child == 0:
        same = cube.closest_point(np.full((4, 3), [3, 2, 1])).lower[0] == expected
        os._exit(0 if same else 1)
    assert os.waitpid(child, 0)[1] == 0


def test_import_brings_no_more_than_it_needs():
    """What takes its time is imported on first use; how long the import takes: bench/python/run."""
    late = "import sys, snug; print([name for name in sys.modules if name.startswith('snug.')])"
    loaded = subprocess.run([sys.executable, "-c", late], capture_output=True, text=True, check=True).stdout
    assert not any(name in loaded for name in ("_view", "collision", "proximity"))
