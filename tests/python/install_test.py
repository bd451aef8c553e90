"""`cmake --install` into a prefix, and `pip install .` from a copy of the sources into a fresh environment, without
network, and what it gives.

    install_test.py SOURCES BUILD
"""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

USE = """
import importlib.metadata, importlib.resources, os, pathlib, subprocess, sys
import collarmesh, numpy
assert sys.prefix in collarmesh.__file__, collarmesh.__file__
assert collarmesh.__version__ == importlib.metadata.version("collarmesh")
files = {str(f) for f in importlib.metadata.files("collarmesh")}
for wanted in ("collarmesh/py.typed", "collarmesh/_core.pyi"):
    assert wanted in files, (wanted, files)
assert any("LICENSE" in f for f in files), files
mesh = collarmesh.mesh(sys.argv[1], size=0.5)
assert mesh.passed and len(mesh.tets) > 10
mesh.write("box.vtu")
assert len(collarmesh.read("box.vtu").tets) == len(mesh.tets)
for command in ([os.path.join(sys.prefix, "bin", "collarmesh")], [sys.executable, "-m", "collarmesh"]):
    told = subprocess.run([*command, "--version"], capture_output=True, text=True).stdout
    assert told.split() == ["collarmesh", collarmesh.__version__], (command, told)
"""
LACKING = """
import os, sys
sys.path.insert(0, os.path.join(sys.argv[1], "packaging"))
os.environ["PATH"] = "/nowhere"
import pip_build
pip_build.compile_package("/nowhere")
"""
MODULES = """
import collarmesh, sys
collarmesh.mesh(sys.argv[1], size=0.5).write("box.xdmf")   # loads the module with HDF5
try:
    collarmesh.mesh("no.step")
except collarmesh.ReadError as error:
    assert "no such file" in str(error), error
"""


def import_from_prefix(build, prefix):
    """Files that `cmake --install` puts below a prefix are found where Debian's Python looks below
    /usr/local."""
    for component in ("python", "modules"):
        subprocess.run(["cmake", "--install", build, "--prefix", prefix, "--component", component], check=True,
                       stdout=subprocess.DEVNULL)
    where = prefix / f"lib/python{sys.version_info[0]}.{sys.version_info[1]}/dist-packages"
    use = f"import site; site.addsitedir('{where}'); import collarmesh; print(collarmesh.__file__)"
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    found = subprocess.run([sys.executable, "-c", use], check=True,
                           capture_output=True, text=True, env=environment).stdout
    if not found.startswith(str(prefix)):
        raise SystemExit(f"the package was imported from {found}")


def main():
    sources, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    for needed in ("venv", "pip"):
        if importlib.util.find_spec(needed) is None:
            print(f"{needed} is not installed")
            return 77
    with tempfile.TemporaryDirectory(prefix="collarmesh-prefix-") as folder:
        import_from_prefix(build, pathlib.Path(folder))
    with tempfile.TemporaryDirectory(prefix="collarmesh-pip-") as folder:
        folder = pathlib.Path(folder)
        copy = folder / "sources"
        shutil.copytree(sources, copy, ignore=shutil.ignore_patterns("build", ".git", "*.egg-info"))
        # Uses the system's numpy and pip, so that nothing is downloaded.
        subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", folder / "venv"], check=True)
        python = folder / "venv" / "bin" / "python"
        environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        environment["COLLARMESH_BUILD_DIR"] = str(build)
        subprocess.run([python, "-m", "pip", "install", "--no-index", copy],
                       check=True, env=environment)
        box = sources / "resources/models/box.off"
        subprocess.run([python, "-c", USE, box], check=True, cwd=folder, env=environment)
        told = subprocess.run([python, "-c", LACKING, copy], env={**environment, "COLLARMESH_BUILD_DIR": ""},
                              capture_output=True, text=True).stderr
        if "apt-get install g++ cmake" not in told or "pybind11-dev" not in told:
            raise SystemExit(f"it is not said which packages are missing: {told}")
        if list(build.glob("lib/collarmesh/collarmesh_hdf5.so")):
            subprocess.run([python, "-c", MODULES, box], check=True, cwd=folder, env=environment)
    return 0


if __name__ == "__main__":
    sys.exit(main())
