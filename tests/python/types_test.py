"""mypy on the package, and its stub against the compiled module.

    types_test.py SOURCES   (the module on PYTHONPATH)
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import collarmesh._core as core

USE = """
import pathlib
from typing import List
import collarmesh
import numpy

m: collarmesh.Mesh = collarmesh.mesh(pathlib.Path("box.off"), size=0.5, patch_size={3: 0.1}, \
size_field=lambda x, y, z: 1.0)
told: List[str] = m.findings
m.write(pathlib.Path("box.vtu"))
tag: int = collarmesh.info("box.off")["complex"]["patch_list"][0]["tag"]
volume: float = m.info()["mesh"]["region_volumes"]["1"]
other = collarmesh.mesh("box.off", progress=True, size_field=(m, numpy.ones(len(m.tets))))
seconds: float = collarmesh.predict("box.off", sizes=[0.5])[0]["seconds"]
"""


def main():
    sources = pathlib.Path(sys.argv[1])
    mypy = shutil.which("mypy")
    if mypy is None:
        print("mypy is not installed")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        use = pathlib.Path(folder) / "use.py"
        wrong = pathlib.Path(folder) / "wrong.py"
        use.write_text(USE)
        wrong.write_text('import collarmesh\ncollarmesh.mesh("box.off", size="small")\n')
        common = [mypy, "--strict", "--config-file", sources / "pyproject.toml", "--cache-dir", f"{folder}/cache"]
        package = pathlib.Path(core.__file__).parent
        environment = {**os.environ, "MYPYPATH": str(package.parent)}
        subprocess.run([*common, package, use], check=True, cwd=folder, env=environment)
        refused = subprocess.run([*common, wrong], cwd=folder, env=environment, capture_output=True, text=True)
        wrong.write_text('import collarmesh\nn: str = collarmesh.info("box.off")["complex"]["points"]\n')
        key = subprocess.run([*common, wrong], cwd=folder, env=environment, capture_output=True, text=True)
        if 'incompatible type "str"' not in refused.stdout or "Incompatible types in assignment" not in key.stdout:
            raise SystemExit(f"mypy does not see a wrong type:\n{refused.stdout}{refused.stderr}")
    stub = (sources / "mesher/python/collarmesh/_core.pyi").read_text()
    functions = {name for name in vars(core) if not name.startswith("_")}
    told = {line.split("(")[0].split()[1].rstrip(":")
            for line in stub.splitlines() if line.startswith(("def ", "class "))}
    if functions != told:
        raise SystemExit(f"the stub differs from the module: {functions ^ told}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
