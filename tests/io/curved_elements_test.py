#!/usr/bin/python3
"""Meshes of second order with curved faces, as other programs find them.

    curved_elements_test.py COLLARMESH PROGRAM

PROGRAM is one of calculix, gmsh, meshio. Exit code 0: the elements are valid there; 1: they are not; 77: the
program is not installed.
"""
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

MODELS = Path(__file__).resolve().parents[2] / "resources" / "models"
failures = []


def expect(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def skip(what):
    print(f"{what} is not installed: nothing tested")
    sys.exit(77)


def mesh(model, path, *arguments):
    run = subprocess.run([sys.argv[1], MODELS / model, "-o", path, "--order", "2", *arguments], capture_output=True,
                         text=True)
    expect(run.returncode == 0, f"{model}: exit code {run.returncode} {run.stderr}")
    return path


def section(text, keyword):
    """Returns the data lines of an Abaqus keyword, as lists of numbers."""
    lines = text.split(f"\n*{keyword}", 1)[1].split("\n*", 1)[0].splitlines()[1:]
    return [[float(word) for word in line.split(",") if word.strip()] for line in lines if line.strip()]


def with_calculix(folder):
    """Warms a body evenly and holds it so that it may expand. The displacement is linear, which curved
    isoparametric elements represent exactly; CalculiX rejects elements whose Jacobian is not positive."""
    ccx = shutil.which("ccx")
    if ccx is None:
        skip("calculix-ccx")
    expansion, rise = 1e-5, 100.0
    for model, size in (("sphere.off", "0.5"), ("plate_with_hole.off", "6")):
        name = Path(model).stem
        text = mesh(model, folder / f"{name}.inp", "--size", size).read_text()
        nodes = {int(row[0]): np.array(row[1:]) for row in section(text, "NODE")}
        expect("C3D10" in text, f"{model}: no C3D10")
        numbers, places = np.array(list(nodes)), np.array(list(nodes.values()))
        origin = numbers[np.lexsort(places.T)[0]]
        away = places - nodes[origin]
        # Three nodes that span a plane hold the body, at the exact displacement.
        second = np.argmax(np.linalg.norm(away, axis=1))
        third = np.argmax(np.linalg.norm(np.cross(away, away[second]), axis=1))
        held = [origin, numbers[second], numbers[third]]
        boundary = "".join(f"{n}, {axis + 1}, {axis + 1}, {expansion * rise * (nodes[n] - nodes[origin])[axis]:.12e}\n"
                           for n in held for axis in range(3))
        job = folder / f"{name}_job"
        job.with_suffix(".inp").write_text(
            f"*INCLUDE, INPUT={name}.inp\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*EXPANSION, ZERO=0.\n"
            f"{expansion},\n*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\n"
            f"NALL, 0.\n*BOUNDARY\n{boundary}*STEP\n*STATIC\n*TEMPERATURE\nNALL, {rise}\n*NODE PRINT, NSET=NALL\nU\n"
            "*END STEP\n")
        run = subprocess.run([ccx, "-i", job.name], cwd=folder, capture_output=True, text=True)
        errors = re.findall(r"\*ERROR[^\n]*|[^\n]*nonpositive[^\n]*", run.stdout)
        expect(run.returncode == 0 and "Job finished" in run.stdout and not errors,
               f"{model}: {run.returncode} {errors}")
        if failures:
            continue
        rows = [line.split() for line in job.with_suffix(".dat").read_text().splitlines()]
        moved = {int(row[0]): np.array(row[1:], float) for row in rows if len(row) == 4 and row[0].isdigit()}
        expect(len(moved) == len(nodes), f"{model}: {len(moved)} displacements of {len(nodes)} nodes")
        off = max(np.abs(u - expansion * rise * (nodes[n] - nodes[origin])).max() for n, u in moved.items())
        expect(off < 1e-6 * expansion * rise * np.abs(away).max() + 1e-8, f"{model}: displacements are off by {off}")


def with_gmsh(folder):
    """Checks by Gmsh's own bounds of the Jacobian."""
    gmsh = shutil.which("gmsh")
    if gmsh is None:
        skip("gmsh")
    for model, size in (("sphere.off", "0.5"), ("plate_with_hole.off", "6")):
        path = mesh(model, folder / f"{model}.msh", "--size", size)
        script = folder / "analyse.geo"
        script.write_text(f'Merge "{path}";\nPlugin(AnalyseMeshQuality).JacobianDeterminant = 1;\n'
                          "Plugin(AnalyseMeshQuality).DimensionOfElements = 3;\nPlugin(AnalyseMeshQuality).Run;\n")
        run = subprocess.run([gmsh, "-", script], capture_output=True, text=True)
        found = re.search(r"minJ/maxJ\s*=\s*([-\d.e+]+)[,\s]+([-\d.e+]+)[,\s]+([-\d.e+]+)", run.stdout + run.stderr)
        expect(found is not None, f"{model}: {run.stdout[-800:]}")
        if found is not None:
            expect(float(found[1]) > 0, f"{model}: least ratio of Jacobians {found[0]}")


def volume_within(path):
    """Returns the volume of the closed surface in an .off file of triangles."""
    rows = [line.split() for line in path.read_text().splitlines()[1:] if line.strip() and not line.startswith("#")]
    points = np.array(rows[1:1 + int(rows[0][0])], float)
    triangles = np.array([row[1:4] for row in rows[1 + int(rows[0][0]):]], int)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6


def with_meshio(folder):
    """The volume of the curved tets that meshio reads is nearer to the input's than that of straight tets; if
    nodes were in another order, it would be far off."""
    try:
        import meshio
    except ImportError:
        skip("meshio")
    found = meshio.read(mesh("sphere.off", folder / "sphere.vtu", "--size", "0.4", "--coarsen", "off"))
    tets = found.points[found.cells_dict["tetra10"]]
    ends = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))   # nodes of VTK_QUADRATIC_TETRA
    volume = 0
    for weight, *place in ((-0.8, 0.25, 0.25, 0.25, 0.25),
                           *((0.45, *np.roll([0.5, 1 / 6, 1 / 6, 1 / 6], k)) for k in range(4))):
        slopes = np.zeros((10, 4))   # slopes of the shape functions, in barycentric coordinates
        for i in range(4):
            slopes[i, i] = 4 * place[i] - 1
        for e, (i, j) in enumerate(ends):
            slopes[4 + e, i], slopes[4 + e, j] = 4 * place[j], 4 * place[i]
        columns = np.einsum("tnx,nk->txk", tets, slopes[:, 1:] - slopes[:, :1])
        volume += weight * np.linalg.det(columns).sum() / 6
    corners = tets[:, :4]
    straight = np.linalg.det(corners[:, 1:] - corners[:, :1]).sum() / 6
    wanted = volume_within(MODELS / "sphere.off")
    expect(abs(volume - wanted) < 0.15 * abs(straight - wanted),
           f"volume {volume}, straight {straight}, wanted {wanted}")


PROGRAMS = {"calculix": with_calculix, "gmsh": with_gmsh, "meshio": with_meshio}

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        PROGRAMS[sys.argv[2]](Path(work))
    print("failed" if failures else "valid")
    sys.exit(1 if failures else 0)
