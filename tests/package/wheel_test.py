"""The wheel that carries its libraries: installed without network, its libraries found where the system has none of
them.

    wheel_test.py SOURCES BUILD
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

USE = """
import collarmesh, os, pathlib, subprocess, sys
models = pathlib.Path(sys.argv[1])
collarmesh.mesh(models / "box.off", size=0.5, partitions={partitions}).write("box{hdf5}")
{cad}collarmesh.mesh(models / "flange.step", size=4).write("flange.vtu")
here = os.path.dirname(os.path.dirname(collarmesh.__file__))
loaded = {{line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}}
of_ours = {{path for path in loaded if any(name in path \
for name in ("libTK", "libtbb-", "libtbb.", "libfmt", "libmpfr", "hdf5", "scotch"))}}
assert of_ours and all(path.startswith(here) for path in of_ours), of_ours
for command in (["collarmesh"], [sys.executable, "-m", "collarmesh"]):
    command[0] = os.path.join(os.path.dirname(sys.executable), command[0])
    told = subprocess.run([*command, "--version"], capture_output=True, text=True)
    assert told.stdout.split() == ["collarmesh", collarmesh.__version__], told
    assert subprocess.run([*command, models / "box.off", "-q", "--size", "0.5", "-o", "own.vtu"]).returncode == 0
"""


def main():
    sources, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    missing = [program for program in ("patchelf", "objdump") if shutil.which(program) is None]
    if missing or not list(build.glob("python/collarmesh/_core*.so")):
        print(f"not installed: {missing}, or the module is not built")
        return 77
    modules = [path.name for path in build.glob("lib/collarmesh/*.so")]
    use = USE.format(partitions=2 if "collarmesh_scotch.so" in modules else None,
                     hdf5=".xdmf" if "collarmesh_hdf5.so" in modules else ".vtu",
                     cad="" if "collarmesh_cad.so" in modules else "# ")
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    with tempfile.TemporaryDirectory(prefix="collarmesh-wheel-test-") as folder:
        folder = pathlib.Path(folder)
        subprocess.run([sys.executable, sources / "packaging/make_wheel.py", folder], check=True,
                       env={**environment, "COLLARMESH_BUILD_DIR": str(build)}, stdout=subprocess.DEVNULL)
        (wheel,) = folder.glob("*.whl")
        if not re.fullmatch(r"collarmesh-[\d.]+-cp\d+-cp\d+-manylinux_2_\d+_x86_64\.whl", wheel.name):
            raise SystemExit(f"the wheel is called {wheel.name}")
        # Uses the system's numpy, so that nothing is downloaded.
        subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", folder / "venv"], check=True)
        python = folder / "venv/bin/python"
        subprocess.run([python, "-m", "pip", "install", "-q", "--no-index", wheel], check=True, env=environment)
        subprocess.run([python, "-c", use, sources / "resources/models"], check=True, cwd=folder, env=environment)
    return 0


if __name__ == "__main__":
    sys.exit(main())
