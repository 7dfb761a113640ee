"""Pictures of surfaces by the command `snug render`, and plots in the colours of the documentation."""

import os
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

SEA, CLAY, SIGNAL, INK = "#2f6f9f", "#e08c66", "#c22f3d", "#27303c"


def render(*parts, size="640x420", options=()):
    """A picture of surfaces, each alone or with its pose, (4, 4); without the command, where that comes from."""
    from IPython.display import Image

    command = os.environ.get("SNUG_COMMAND") or shutil.which("snug")
    if not command:
        return "no picture: the command snug is not installed (make build, or the Debian package snug)"
    with tempfile.TemporaryDirectory() as folder:
        call = [command, "render", "--size", size, "--quiet", "-o", f"{folder}/picture.png", *options]
        for i, part in enumerate(parts):
            surface, pose = part if isinstance(part, tuple) else (part, np.eye(4))
            file = f"{folder}/{i}.obj"
            surface.write(file)
            call += [file, "--place", " ".join(repr(float(x)) for x in np.asarray(pose)[:3].ravel())]
        done = subprocess.run(call, capture_output=True, text=True, check=False)
        if done.returncode:
            return done.stderr
        return Image(pathlib.Path(folder, "picture.png").read_bytes())


def plots():
    """matplotlib's pyplot, with these colours."""
    import matplotlib.pyplot as plt

    plt.rcParams.update({"axes.prop_cycle": plt.cycler(color=[SEA, CLAY, SIGNAL, INK]), "axes.grid": True, "grid.color": "#dddddd", "axes.axisbelow": True,
                         "axes.edgecolor": INK, "legend.frameon": False})
    return plt
