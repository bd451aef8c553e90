#!/usr/bin/python3
"""Periodic faces in files, as other programs read them: the faces of a cube of tetrahedra that this script
makes.

    periodic_test.py PROGRAM   (the module collarmesh on PYTHONPATH)

PROGRAM is one of gmsh, calculix. Exit code 0: it finds what we wrote; 1: it does not; 77: it is not installed.
"""
import itertools
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import collarmesh

failures = []


def expect(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def cube(n, order):
    """Makes n^3 cubes of six tetrahedra each; sides 1 to 6 (x, y, z, low and high), two materials in layers
    along z."""
    grid = np.array(list(itertools.product(range(n + 1), repeat=3)))
    number = {tuple(g): i for i, g in enumerate(grid)}
    tets, tags = [], []
    for low in itertools.product(range(n), repeat=3):
        for axes in itertools.permutations(range(3)):
            at, corners = list(low), [number[low]]
            for axis in axes:
                at[axis] += 1
                corners.append(number[tuple(at)])
            tets.append(corners)
            tags.append(1 if 2 * low[2] < n else 2)
    points, tets = grid / n, np.array(tets)
    a, b, c, d = (points[tets[:, k]] for k in range(4))
    wrong = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets[wrong] = tets[wrong][:, [0, 1, 3, 2]]
    sides = np.vstack([tets[:, s] for s in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    faces, face_tags = [], []
    for axis, end in itertools.product(range(3), (0, 1)):
        on = sides[(points[sides][:, :, axis] == end).all(axis=1)]
        faces += on.tolist()
        face_tags += [2 * axis + end + 1] * len(on)
    if order == 2:
        points, tets, faces = with_mid_nodes(points, tets, faces)
    mesh = collarmesh.Mesh(points, tets, tags, faces=faces, face_tags=face_tags)
    mesh.periodic = [pair(mesh, axis) for axis in range(3)]
    return mesh


def with_mid_nodes(points, tets, faces):
    middle, more = {}, list(points)

    def amid(a, b):
        key = min(a, b), max(a, b)
        if key not in middle:
            middle[key] = len(more)
            more.append((points[a] + points[b]) / 2)
        return middle[key]
    ends = (0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)
    tets = [[*t, *(amid(t[i], t[j]) for i, j in ends)] for t in tets]
    faces = [[*f, *(amid(f[i], f[j]) for i, j in ends[:3])] for f in faces]
    return np.array(more), tets, faces


def pair(mesh, axis):
    shift = np.eye(3)[axis]
    nodes = [np.unique(mesh._cells("faces")[mesh.face_tag == 2 * axis + 1 + end]) for end in (0, 1)]
    at = {tuple(mesh.points[node]): node for node in nodes[1]}
    images = [at[tuple(mesh.points[node] + shift)] for node in nodes[0]]
    return {"first": np.array([2 * axis + 1]), "second": np.array([2 * axis + 2]), "rotation": np.eye(3),
            "shift": shift, "nodes": np.column_stack([nodes[0], images])}


def gmsh(folder):
    try:
        import gmsh
    except ImportError:
        return 77
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    # Gmsh 4.8 does not write this section in .msh2, even in its own files.
    for order, parts in itertools.product((1, 2), (0, 3)):
        case = f"order {order}, {parts} partitions"
        mesh = cube(3, order)
        mesh = mesh.partitioned(parts) if parts else mesh
        path = folder / "cell.msh"
        mesh.write(path)
        gmsh.open(str(path))
        found = {}
        for dimension, entity in gmsh.model.getEntities(2):
            master, nodes, masters, affine = gmsh.model.mesh.getPeriodicNodes(dimension, entity)
            if master != entity:
                found[tuple(np.array(affine).reshape(4, 4)[:3, 3])] = sorted(zip(masters, nodes))
        for faces in mesh.periodic:
            wanted = sorted((a + 1, b + 1) for a, b in faces["nodes"])
            expect(found.get(tuple(faces["shift"])) == wanted, f"{case}: Gmsh has other pairs along {faces['shift']}")
        expect(len(found) == len(mesh.periodic), f"{case}: Gmsh has {len(found)} periodic surfaces")
        gmsh.clear()
    gmsh.finalize()
    return 0


def calculix(folder):
    """Stretches a cell of two materials in layers, free to contract. Along the layers stiffnesses are
    averaged, across them compliances; this is exact because neither material contracts laterally."""
    if shutil.which("ccx") is None:
        return 77
    stiff, soft = 1000.0, 100.0
    for order, axis in itertools.product((1, 2), (0, 2)):
        name = f"cell{order}{axis}"
        cube(4, order).write(folder / f"{name}.inp")
        expect((folder / f"{name}_periodic.inp").exists(), f"{name}: no conditions")
        held = "".join(f"PERIODIC_{k + 1}_REFERENCE, {k + 1 if k == axis else 1}, {3 if k != axis else k + 1}, "
                       f"{0.01 if k == axis else 0}\n" for k in range(3))
        across = "".join(f"PERIODIC_{axis + 1}_REFERENCE, {i}, {i}, 0\n" for i in (1, 2, 3) if i != axis + 1)
        (folder / f"{name}_job.inp").write_text(
            f"*INCLUDE, INPUT={name}.inp\n*INCLUDE, INPUT={name}_periodic.inp\n"
            f"*MATERIAL, NAME=STIFF\n*ELASTIC\n{stiff}, 0\n*MATERIAL, NAME=SOFT\n*ELASTIC\n{soft}, 0\n"
            "*SOLID SECTION, ELSET=REGION_1, MATERIAL=STIFF\n*SOLID SECTION, ELSET=REGION_2, MATERIAL=SOFT\n"
            f"*STEP\n*STATIC\n*BOUNDARY\nPERIODIC_HELD, 1, 3\n{held}{across}"
            f"*NODE PRINT, NSET=PATCH_{2 * axis + 2}_NODES, TOTALS=ONLY\nRF\n*END STEP\n")
        run = subprocess.run(["ccx", "-i", f"{name}_job"], cwd=folder, capture_output=True, text=True)
        expect("Job finished" in run.stdout and "*ERROR" not in run.stdout,
               f"{name}: CalculiX says {run.stdout[-2000:]}")
        rows = re.findall(r"^ +(-?\d\S+) +(\S+) +(\S+)\n", (folder / f"{name}_job.dat").read_text(), re.M)
        stress = abs(float(rows[-1][axis])) / 0.01 if rows else float("nan")
        known = (stiff + soft) / 2 if axis == 0 else 2 / (1 / stiff + 1 / soft)
        print(f"{name}: stiffness {stress:.6g}, known {known:.6g}")
        expect(abs(stress / known - 1) < 1e-4, f"{name}: stiffness {stress}, not {known}")
    return 0


def main():
    with tempfile.TemporaryDirectory() as folder:
        code = {"gmsh": gmsh, "calculix": calculix}[sys.argv[1]](Path(folder))
    return 1 if failures else code


if __name__ == "__main__":
    sys.exit(main())
