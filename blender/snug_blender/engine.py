# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module snug: installed by Blender 4.2 from the manifest's wheel, unpacked from that wheel by older ones."""

import importlib
import os
import sys
import zipfile
from pathlib import Path

import bpy


def find():
    """Imports snug. Raises ImportError if there is no wheel for this Python."""
    try:
        return importlib.import_module("snug")
    except ImportError:
        pass
    tag = f"-cp{sys.version_info[0]}{sys.version_info[1]}-"
    wheels = [wheel for wheel in (Path(__file__).parent / "wheels").glob("*.whl") if tag in wheel.name]
    if not wheels:
        raise ImportError(f"there is no wheel of snug for Python {sys.version.split()[0]} in this add-on")
    # A folder for each wheel: one in use is never written.
    folder = Path(bpy.utils.user_resource("SCRIPTS", path=os.path.join("snug", wheels[0].stem), create=True))
    if not (folder / "snug").exists():
        with zipfile.ZipFile(wheels[0]) as wheel:
            wheel.extractall(folder)
    sys.path.insert(0, str(folder))
    return importlib.import_module("snug")
