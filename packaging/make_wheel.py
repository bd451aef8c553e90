#!/usr/bin/env python3
"""Makes a wheel that contains its libraries: `pip install` of it needs no compiler and no package of the system.

    make_wheel.py OUTPUT    for the Python that runs it; OUTPUT: a folder

Builds as `pip install .` does (pip_build.py). Needs patchelf, and ldd and objdump of the system that built the module.
"""

import pathlib
import sys
import tempfile

import pip_build
import self_contained


def main():
    output = pathlib.Path(sys.argv[1]).resolve()
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="collarmesh-wheel-") as folder:
        root = pathlib.Path(folder) / "root"
        name = pip_build.lay_out(root, pathlib.Path(folder) / "build")
        libraries = self_contained.carry_libraries(root, root / "collarmesh.libs", into_processes_of_others=True)
        (information,) = root.glob("*.dist-info")
        self_contained.add_licences(libraries, information / "licences_of_libraries")
        platform = "manylinux_{}_{}_x86_64".format(*self_contained.glibc_needed(root))
        description = information / "WHEEL"
        text = description.read_text(encoding="utf-8")
        description.write_text(text.replace(pip_build.PLATFORM, platform), encoding="utf-8")
        wheel = output / name.replace(pip_build.PLATFORM, platform)
        pip_build.pack(root, wheel)
    print(wheel)


if __name__ == "__main__":
    main()
