"""`pip install .`: builds the mesher with CMake and puts its module into the package `collarmesh`.

COLLARMESH_BUILD_DIR names a CMake build that is there already; then nothing is compiled.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCES = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        made = os.environ.get("COLLARMESH_BUILD_DIR")
        folder = pathlib.Path(made or pathlib.Path(self.build_temp).resolve())
        if made is None:
            self.compile(folder)
        package = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve().parent
        package.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as prefix:
            for component in ("python", "modules"):
                subprocess.run(["cmake", "--install", folder, "--prefix", prefix, "--component", component,
                                "--strip"], check=True)
            for name in ("*.so", "_functions.py"):  # what the build has made
                for path in pathlib.Path(prefix).rglob(f"collarmesh/{name}"):
                    shutil.copy2(path, package)

    @staticmethod
    def compile(folder):
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DCOLLARMESH_TESTS=OFF", "-DCOLLARMESH_TOOLS=OFF",
                   f"-DPYTHON_EXECUTABLE={sys.executable}"]
        subprocess.run(["cmake", "-S", SOURCES, "-B", folder, *options], check=True)
        subprocess.run(["cmake", "--build", folder, "--target", "collarmesh_python_package",
                        "--parallel", str(os.cpu_count())], check=True)


version = re.search(r"project\(collarmesh VERSION ([\d.]+)", (SOURCES / "CMakeLists.txt").read_text())[1]
setup(
    name="collarmesh",
    version=version,
    description="Tetrahedral meshes of surfaces, complexes and CAD shapes, certified",
    license="GPL-3.0-or-later",
    license_files=["LICENSE"],
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["collarmesh"],
    package_dir={"collarmesh": "mesher/python/collarmesh"},
    package_data={"collarmesh": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("collarmesh._core", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    zip_safe=False,
)
