#!/usr/bin/python3
"""OpenFOAM: what went through gmshToFoam keeps the names of patches, and checkMesh finds the mesh good.

    openfoam_test.py PROGRAM MODELS   (Debian's openfoam)
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HEADER = "FoamFile {{ version 2.0; format ascii; class dictionary; object {}; }}\n"
FILES = {
    "controlDict": "application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; "
    "writeControl timeStep; writeInterval 1; ",
    "fvSchemes": "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} interpolationSchemes {} "
    "snGradSchemes {} ",
    "fvSolution": "",
}


def run(folder, *command):
    environment = {**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam", "FOAM_ETC": "/usr/share/openfoam/etc"}
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment)
    if result.returncode != 0:
        raise SystemExit(f"{command}: {result.returncode}\n{result.stdout[-3000:]}\n{result.stderr[-2000:]}")
    return result.stdout


def main():
    program, models = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if not shutil.which("gmshToFoam") or not shutil.which("checkMesh"):
        print("openfoam is not installed")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "system").mkdir()
        for name, text in FILES.items():
            (folder / "system" / name).write_text(HEADER.format(name) + text)
        # A box of 3 x 2 x 1: the ends in x are named by points on them, the other sides by their numbers.
        info = json.loads(run(folder, program, "info", "--json", models / "box.off"))
        rest = [p["tag"] for p in info["complex"]["patch_list"] if 0 < p["where"][0] < 3]
        names = {"patches": {"inlet": {"at": [0, 1, 0.5]}, "outlet": {"at": [3, 1, 0.5]}, "walls": rest},
                 "regions": {"air": 1}}
        (folder / "names.json").write_text(json.dumps(names))
        run(folder, program, models / "box.off", "-o", "box.msh2",
            "--size", "0.2", "--names", "names.json", "--scale", "0.001")
        shutil.copy(folder / "box.msh2", folder / "box.msh")
        run(folder, "gmshToFoam", "box.msh")
        boundary = (folder / "constant/polyMesh/boundary").read_text()
        found = set(re.findall(r"^\s+(\w+)\s*\n\s+\{", boundary, re.M))
        if found != {"inlet", "outlet", "walls"}:
            raise SystemExit(f"the patches are {found}:\n{boundary}")
        said = run(folder, "checkMesh")
        if "Mesh OK" not in said:
            raise SystemExit(said[-3000:])
        if "(0.003 0.002 0.001)" not in said:
            raise SystemExit(f"--scale is not in the bounding box:\n{said[-3000:]}")
        print("Mesh OK with", *sorted(found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
