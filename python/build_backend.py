"""Builds snug for pip, by CMake and zipfile: a backend of PEP 517 and PEP 660 that needs no other package.

Metadata stand here and in pyproject.toml; the version is that of CMakeLists.txt.
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

from self_contained import self_contained

NAME = "snug-surfaces"  # PyPI has another package named snug
FILE_NAME = "snug_surfaces"
ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python/snug"
PAGE = ROOT / "build/web/snug.html"  # which make page builds
TAG = f"cp{sys.version_info[0]}{sys.version_info[1]}"
PLATFORM = re.sub(r"[-.]", "_", sysconfig.get_platform())
BUILD = ROOT / f"build/wheel-{TAG}-{PLATFORM}"


def version():
    return re.search(r"project\(snug VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """On Linux, where patchelf is, one that needs no library which a system may lack; else one for systems like this."""
    extension = _built()
    with tempfile.TemporaryDirectory() as folder:
        binaries, tag = self_contained(extension, folder) if sys.platform == "linux" else ([extension], None)
        binaries = {f"snug/{file.name}": file.read_bytes() for file in binaries}
    files = {f"snug/{file.name}": file.read_bytes() for file in sorted(PACKAGE.iterdir()) if file.suffix in (".py", ".pyi", ".typed")}
    files["snug/py.typed"] = b""
    files.update(binaries)
    files["snug/still.html"] = (ROOT / "web/page/still.html").read_bytes()
    if PAGE.exists():
        files["snug/view.html"] = PAGE.read_bytes()
    platform = PLATFORM.replace("linux", tag) if tag else PLATFORM
    return _zipped(wheel_directory, files, platform)


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Without it pip would build once more, to read them from a wheel."""
    folder = pathlib.Path(metadata_directory) / f"{FILE_NAME}-{version()}.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text(_metadata(), encoding="utf-8")
    return folder.name


prepare_metadata_for_build_editable = prepare_metadata_for_build_wheel


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """The files in Python are links to those in the tree; C++ is built again by pip install -e."""
    staged = _built().parent.parent
    return _zipped(wheel_directory, {"snug.pth": f"{staged}\n".encode()})


def build_sdist(sdist_directory, config_settings=None):
    base = f"{FILE_NAME}-{version()}"
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    with tarfile.open(pathlib.Path(sdist_directory) / f"{base}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for name in filter(None, listed.split("\0")):
            archive.add(ROOT / name, f"{base}/{name}", recursive=False)
        facts = pathlib.Path(sdist_directory) / "PKG-INFO"
        facts.write_text(_metadata(), encoding="utf-8")
        archive.add(facts, f"{base}/PKG-INFO")
        facts.unlink()
    return f"{base}.tar.gz"


def _built():
    """The extension module for the Python that runs this."""
    configure = ["cmake", "--preset", "python", "-B", str(BUILD), f"-DPython_EXECUTABLE={sys.executable}"]
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 2))
    for command in (configure, ["cmake", "--build", str(BUILD), "--target", "snug_python", "--parallel", jobs]):
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit(f"{done.stdout}\nsnug: building failed; scripts/install_packages build python installs what it needs")
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    return BUILD / f"python/snug/_snug{suffix}"


def _metadata():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    return (
        f"Metadata-Version: 2.1\nName: {NAME}\nVersion: {version()}\n"
        "Summary: Proved answers about the limit surfaces of subdivision meshes\nLicense: Apache-2.0\n"
        f"Requires-Python: >=3.9\nRequires-Dist: numpy\nDescription-Content-Type: text/markdown\n\n{readme}"
    )


def _zipped(directory, files, platform=PLATFORM):
    facts = f"{FILE_NAME}-{version()}.dist-info"
    files = {
        **files,
        f"{facts}/METADATA": _metadata().encode(),
        f"{facts}/WHEEL": f"Wheel-Version: 1.0\nGenerator: snug\nRoot-Is-Purelib: false\nTag: {TAG}-{TAG}-{platform}\n".encode(),
        **{f"{facts}/licenses/{path.name}": path.read_bytes() for path in (ROOT / "LICENSE", ROOT / "python/NOTICES")},
    }
    record = "".join(f"{name},sha256={_hash(content)},{len(content)}\n" for name, content in files.items())
    files[f"{facts}/RECORD"] = f"{record}{facts}/RECORD,,\n".encode()
    wheel = f"{FILE_NAME}-{version()}-{TAG}-{TAG}-{platform}.whl"
    with zipfile.ZipFile(pathlib.Path(directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            # A date of its own: the same files make the same wheel.
            info = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = 0o100644 << 16
            archive.writestr(info, content)
    return wheel


def _hash(content):
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
