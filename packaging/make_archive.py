#!/usr/bin/env python3
"""Makes archives of the program that run without installing anything: unpack, and run bin/collarmesh.

    make_archive.py BUILD OUTPUT [options]    BUILD: a folder in which collarmesh_product was built; OUTPUT: a folder

Two are written: collarmesh-...tar.gz, and collarmesh-freecad-...tar.gz, which is unpacked into FreeCAD's folder Mod.
The options are those of freecad_workbench/make_package.py. Needs patchelf, and ldd and objdump of the system that built
the program.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

import project
import self_contained

sys.path.append(str(project.SOURCES / "freecad_workbench"))
import make_package  # noqa: E402

README = """collarmesh {version}, with its libraries, for Linux on x86-64 with the GNU C library {glibc} or newer.

Run bin/collarmesh; bin/collarmesh --help tells more. The folder may be moved; bin/collarmesh must stay where \
it is in it.
The licence is in LICENSE; those of the libraries are in share/doc/collarmesh/libraries.
"""


def install(build, prefix):
    """Runs `cmake --install`."""
    subprocess.run(["cmake", "--install", build, "--prefix", prefix, "--strip"], check=True, stdout=subprocess.DEVNULL)


def copy_program(prefix, root):
    """Copies the program, the modules that it loads, its manual page, completions and licence."""
    (root / "bin").mkdir(parents=True)
    shutil.copy2(prefix / "bin/collarmesh", root / "bin")
    modules = root / "lib/collarmesh"
    modules.mkdir(parents=True)
    for module in prefix.glob("lib/**/collarmesh/collarmesh_*.so"):
        shutil.copy2(module, modules)
    for folder in ("man", "bash-completion", "zsh", "fish"):
        shutil.copytree(prefix / "share" / folder, root / "share" / folder)
    shutil.copy2(next(prefix.glob("share/doc/**/LICENSE")), root)


def packed(root, output):
    """Packs a folder. The same files always give the same archive."""
    subprocess.run(["tar", "--sort=name", "--mtime=@0", "--owner=0", "--group=0", "--numeric-owner", "-C", root.parent,
                    "-czf", output, root.name], check=True)
    print(output)


def main():
    parser = argparse.ArgumentParser(description="Archives of the program that run without installing anything.")
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    make_package.add_details(parser)
    details = vars(parser.parse_args())
    build, output = details.pop("build").resolve(), details.pop("output").resolve()
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="collarmesh-archive-") as folder:
        folder = pathlib.Path(folder)
        install(build, folder / "prefix")
        root = folder / "collarmesh"
        copy_program(folder / "prefix", root)
        libraries = self_contained.carry_libraries(root, root / "lib")
        self_contained.add_licences(libraries, root / "share/doc/collarmesh/libraries")
        glibc = ".".join(map(str, self_contained.glibc_needed(root)))
        (root / "README").write_text(README.format(version=project.version(), glibc=glibc), encoding="utf-8")
        name = f"{project.version()}-linux-x86_64-glibc{glibc}.tar.gz"
        packed(root, output / f"collarmesh-{name}")
        make_package.lay_out(root, **details)
        packed(root, output / f"collarmesh-freecad-{name}")


if __name__ == "__main__":
    main()
