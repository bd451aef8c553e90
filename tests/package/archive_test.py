"""The archives that carry their libraries, where nothing is installed, and in FreeCAD.

    archive_test.py SOURCES BUILD
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import bare_root


def require_success(process, what):
    if process.returncode != 0:
        raise SystemExit(f"{what}: {process.stdout}{process.stderr}")


def check_program(root, models, modules):
    """Runs the program in a root where the program as it was built would find no library."""
    for model in ("box.off", "flange.step"):
        shutil.copy(models / model, root)
    program = "/collarmesh/bin/collarmesh"
    require_success(bare_root.run(root, program, "/box.off", "--size", "0.5", "-o", "/box.vtu"), "box.off")
    if "collarmesh_cad.so" in modules:
        require_success(bare_root.run(root, program, "/flange.step", "-o", "/flange.vtu"), "flange.step")
        require_success(bare_root.run(root, program, "check", "/flange.vtu", "--against", "/flange.step"), "check")
    if "collarmesh_hdf5.so" in modules:
        require_success(bare_root.run(root, program, "convert", "/box.vtu", "-o", "/box.xdmf"), "box.xdmf")
    if "collarmesh_scotch.so" in modules:
        require_success(bare_root.run(root, program, "/box.off", "--partitions", "2", "-o", "/parts.vtu"), "partitions")
    if "collarmesh_openmesh.so" in modules:
        told = bare_root.run(root, program, "info", "/box.vtu.om").stderr
        if "cannot be loaded" in told:
            raise SystemExit(told)


def check_addon(base):
    """Checks the files that the Add-on Manager reads."""
    described = xml.etree.ElementTree.parse(base / "package.xml").getroot()
    files = [element.get("file") for element in described.iter() if element.get("file")]
    files += [element.text for element in described.iter() if element.tag.endswith("}icon")]
    for file in [*files, "README", "freecad/collarmesh_workbench/init_gui.py"]:
        if not (base / file).is_file() or ".." in file:
            raise SystemExit(f"package.xml names {file}, which the archive does not have")


def main():
    sources, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    missing = [program for program in ("patchelf", "objdump", "unshare") if shutil.which(program) is None]
    if missing or bare_root.enter() is None:
        print(f"not installed: {missing}, or no root of one's own is allowed")
        return 77
    with tempfile.TemporaryDirectory(prefix="collarmesh-archive-test-") as folder:
        folder = pathlib.Path(folder)
        subprocess.run([sys.executable, sources / "packaging/make_archive.py", build, folder / "out"], check=True)
        plain, freecad = sorted((folder / "out").iterdir())
        for archive in (plain, freecad):
            if not re.fullmatch(r"collarmesh-(freecad-)?[\d.]+-linux-x86_64-glibc2\.\d+\.tar\.gz", archive.name):
                raise SystemExit(f"an archive is called {archive.name}")
        root = folder / "root"
        bare_root.make(root)
        shutil.copy(build / "bin/collarmesh", root / "bare")
        if "cannot open shared object file" not in bare_root.run(root, "/bare", "--version").stderr:
            raise SystemExit("the root has libraries of the system; nothing can be seen in it")
        shutil.unpack_archive(plain, root)
        check_program(root, sources / "resources/models", [path.name for path in build.glob("lib/collarmesh/*.so")])
        shutil.unpack_archive(freecad, folder / "Mod")
        addon = folder / "Mod/collarmesh"
        check_addon(addon)
        in_freecad = [sys.executable, sources / "tests/freecad/run.py", "", sources / "tests/freecad/installed_test.py"]
        code = subprocess.run([*in_freecad, "--addon", addon, "--", addon]).returncode
        return 0 if code == 77 else code


if __name__ == "__main__":
    sys.exit(main())
