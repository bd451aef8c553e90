#!/usr/bin/env python3
"""Archives of the program that run without installing anything: unpack, and run bin/collarmesh.

    make_archive.py BUILD OUTPUT    BUILD: a folder in which collarmesh_product was built; OUTPUT: a folder

Two are written: collarmesh-...tar.gz, and collarmesh-freecad-...tar.gz, which is unpacked into FreeCAD's folder Mod.
Needs patchelf, and ldd and objdump of the system that built the program.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import self_contained

README = """collarmesh {version}, with its libraries, for Linux on x86-64 with the GNU C library {glibc} or newer.

Run bin/collarmesh; bin/collarmesh --help tells more. The folder may be moved; bin/collarmesh must stay where it is in it.
The licence is in LICENSE; those of the libraries are in share/doc/collarmesh/libraries.
"""


def installed(build, prefix):
    """`cmake --install`, without what programs of C++ and Python need."""
    subprocess.run(["cmake", "--install", build, "--prefix", prefix, "--strip"], check=True, stdout=subprocess.DEVNULL)
    return prefix / "share/freecad/Mod/collarmesh"


def copy_program(prefix, root):
    """The program, the modules that it loads, its manual page and completions."""
    (root / "bin").mkdir(parents=True)
    shutil.copy2(prefix / "bin/collarmesh", root / "bin")
    modules = root / "lib/collarmesh"
    modules.mkdir(parents=True)
    for module in prefix.glob("lib/**/collarmesh/collarmesh_*.so"):
        shutil.copy2(module, modules)
    for folder in ("man", "bash-completion", "zsh", "fish"):
        shutil.copytree(prefix / "share" / folder, root / "share" / folder)
    shutil.copy2(next(prefix.glob("share/doc/**/LICENSE")), root)


def add_addon(addon, root):
    """FreeCAD's add-on at the base, as the Add-on Manager has it."""
    shutil.copytree(addon, root, dirs_exist_ok=True)
    described = root / "package.xml"
    text = described.read_text(encoding="utf-8")
    described.write_text(re.sub(r'file="[^"]*LICENSE"', 'file="LICENSE"', text), encoding="utf-8")


def packed(root, output):
    """The same files give the same archive."""
    subprocess.run(["tar", "--sort=name", "--mtime=@0", "--owner=0", "--group=0", "--numeric-owner", "-C", root.parent,
                    "-czf", output, root.name], check=True)
    print(output)


def main():
    build, output = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="collarmesh-archive-") as folder:
        folder = pathlib.Path(folder)
        addon = installed(build, folder / "prefix")
        root = folder / "collarmesh"
        copy_program(folder / "prefix", root)
        libraries = self_contained.carry_libraries(root, root / "lib")
        self_contained.add_licences(libraries, root / "share/doc/collarmesh/libraries")
        glibc = ".".join(map(str, self_contained.glibc_needed(root)))
        version = subprocess.run([root / "bin/collarmesh", "--version"], check=True, capture_output=True,
                                 text=True).stdout.split()[-1]
        (root / "README").write_text(README.format(version=version, glibc=glibc), encoding="utf-8")
        name = f"{version}-linux-x86_64-glibc{glibc}.tar.gz"
        packed(root, output / f"collarmesh-{name}")
        add_addon(addon, root)
        packed(root, output / f"collarmesh-freecad-{name}")


if __name__ == "__main__":
    main()
