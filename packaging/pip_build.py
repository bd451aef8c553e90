"""Does the work of `pip install .` and `pip wheel .`: builds the mesher with CMake and makes a wheel of the package
`collarmesh`, of the program and of the modules that they load. Needs no Python package.

COLLARMESH_BUILD_DIR names a CMake build that is there already; then nothing is compiled. CMAKE_BUILD_PARALLEL_LEVEL
says how many compilers run at a time.
"""

import base64
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

import project

SOURCES = project.SOURCES
MEMORY_OF_A_COMPILER = 1 << 31  # bytes
PLATFORM = f"linux_{os.uname().machine}"
METADATA = """Metadata-Version: 2.1
Name: collarmesh
Version: {version}
Summary: Tetrahedral meshes of surfaces, complexes and CAD shapes, certified
License: GPL-3.0-or-later
License-File: LICENSE
Requires-Python: >=3.9
Requires-Dist: numpy
"""


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Makes the wheel for pip. Returns its name."""
    with tempfile.TemporaryDirectory(prefix="collarmesh-wheel-") as folder:
        root = pathlib.Path(folder) / "root"
        name = lay_out(root, pathlib.Path(folder) / "build")
        pack(root, pathlib.Path(wheel_directory) / name)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """Makes an archive of the sources for pip. Returns its name."""
    name = f"collarmesh-{project.version()}"
    subprocess.run(["git", "-C", SOURCES, "archive", f"--prefix={name}/", "-o",
                    pathlib.Path(sdist_directory).resolve() / f"{name}.tar.gz", "HEAD"], check=True)
    return f"{name}.tar.gz"


def lay_out(root, folder):
    """Puts the files of the wheel below `root`, from COLLARMESH_BUILD_DIR if that is set, else from a new build in
    `folder`. Returns the wheel's name."""
    made = os.environ.get("COLLARMESH_BUILD_DIR")
    if made is None:
        compile_package(folder)
    else:
        folder = pathlib.Path(made)
    package = root / "collarmesh"
    shutil.copytree(SOURCES / "mesher/python/collarmesh", package, ignore=shutil.ignore_patterns("__pycache__"))
    with tempfile.TemporaryDirectory() as prefix:
        for component in ("python", "modules", "program"):
            subprocess.run(["cmake", "--install", folder, "--prefix", prefix,
                           "--component", component, "--strip"], check=True)
        # The program finds its modules as below any prefix: bin and lib lie beside each other.
        for pattern, place in (("_core*.so", "."), ("_functions.py", "."), ("collarmesh_*.so", "lib/collarmesh"),
                               ("bin/collarmesh", "bin")):
            for path in pathlib.Path(prefix).rglob(pattern):
                (package / place).mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, package / place)
    return describe(root)


def compile_package(folder):
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DCOLLARMESH_TESTS=OFF", "-DCOLLARMESH_DISTRIBUTED=OFF",
               "-DCOLLARMESH_IN_GROUPS=ON", "-DCMAKE_REQUIRE_FIND_PACKAGE_pybind11=ON",
               f"-DPYTHON_EXECUTABLE={sys.executable}", f"-DPython_EXECUTABLE={sys.executable}"]
    if shutil.which("ninja"):
        options += ["-G", "Ninja"]
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    jobs = max(1, min(len(os.sched_getaffinity(0)), memory // MEMORY_OF_A_COMPILER))
    environment = {"CMAKE_BUILD_PARALLEL_LEVEL": str(jobs), **os.environ}
    try:
        subprocess.run(["cmake", "-S", SOURCES, "-B", folder, *options], check=True, env=environment)
    except (OSError, subprocess.CalledProcessError) as error:
        raise SystemExit(f"The build cannot be prepared: {error}. It needs packages that Debian and Ubuntu call so; as "
                         f"root, run:\n  apt-get install {packages_needed()}")
    subprocess.run(["cmake", "--build", folder, "--target", "collarmesh_python_package"], check=True, env=environment)


def packages_needed():
    """Returns the Debian packages that the program and the Python module are built with."""
    table = [line.split() for line in (SOURCES / "cmake/packages.txt").read_text().splitlines()]
    return " ".join(name for group, name in (row for row in table if len(row) == 2)
                    if group == "build" or name in ("python3-dev", "pybind11-dev"))


def describe(root):
    """Writes the metadata that pip reads from the wheel. Returns the wheel's name."""
    information = root / f"collarmesh-{project.version()}.dist-info"
    information.mkdir()
    python = "cp" + sysconfig.get_config_var("py_version_nodot")
    tag = f"{python}-{python}-{PLATFORM}"
    readme = (SOURCES / "README.md").read_text(encoding="utf-8")
    for name, text in {
            "METADATA": f"{METADATA.format(version=project.version())}Description-Content-Type: text/markdown\n\n"
                        f"{readme}",
            "WHEEL": f"Wheel-Version: 1.0\nGenerator: collarmesh\nRoot-Is-Purelib: false\nTag: {tag}\n",
            "entry_points.txt": "[console_scripts]\ncollarmesh = collarmesh.__main__:main\n"}.items():
        (information / name).write_text(text, encoding="utf-8")
    shutil.copyfile(SOURCES / "LICENSE", information / "LICENSE")
    return f"collarmesh-{project.version()}-{tag}.whl"


def pack(root, wheel):
    """Packs the wheel. The same files always give the same wheel."""
    (information,) = root.glob("*.dist-info")
    lines = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        def add(path, content, mode):
            member = zipfile.ZipInfo(path)
            member.external_attr = (0o100000 | mode) << 16
            member.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(member, content)

        for file in sorted(file for file in root.rglob("*") if file.is_file()):
            path, content = str(file.relative_to(root)), file.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            lines.append(f"{path},sha256={digest},{len(content)}\n")
            add(path, content, 0o755 if file.stat().st_mode & 0o100 else 0o644)
        record = f"{information.name}/RECORD"
        add(record, "".join([*lines, f"{record},,\n"]), 0o644)
