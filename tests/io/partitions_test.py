#!/usr/bin/python3
"""Reads partitioned meshes with other programs: with ghost cells and without, order 1 and 2.

    partitions_test.py PROGRAM MODELS OTHER

OTHER is one of gmsh, vtk, meshio, openfoam. Exit code 0: it finds the partitions that we wrote; 1: it does
not; 77: it is not installed, or the program was built without Scotch.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

PARTITIONS = 5


def skip(what):
    print(f"{what} is not installed: nothing tested")
    sys.exit(77)


def run(folder, *command, **more):
    words = [str(word) for word in command]
    found = subprocess.run(words, cwd=folder, capture_output=True, text=True, **more)
    if found.returncode != 0:
        raise SystemExit(f"{command}: {found.returncode}\n{found.stdout[-3000:]}\n{found.stderr[-3000:]}")
    return found.stdout + found.stderr


class Divided:
    """Two boxes in partitions. The contents of the .vtu file, read by VTK, are the reference."""

    def __init__(self, folder, program, models, order=1):
        self.folder, self.program = folder, program
        self.name = folder / f"divided{order}.vtu"
        run(folder, program, models / "two_boxes.poly", "-o", self.name, "--size", "0.4", "--order", order,
            "--partitions", PARTITIONS)
        self.info = json.loads(run(folder, program, "info", self.name, "--json"))["mesh"]
        assert self.info["partitions"]["count"] == PARTITIONS

    def convert(self, name, *options):
        run(self.folder, self.program, "convert", self.name, "-o", self.folder / name, *options)
        return self.folder / name

    def grid(self):
        import vtk

        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.name))
        reader.Update()
        return reader.GetOutput()

    def tets(self):
        """Returns corners (m, 4) and partitions (m,)."""
        from vtk.util.numpy_support import vtk_to_numpy

        grid = self.grid()
        nodes = 4 if grid.GetCellType(0) == 10 else 10
        corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, nodes)[:, :4]
        return corners, vtk_to_numpy(grid.GetCellData().GetArray("partition"))

    def ghosts(self):
        """Returns for each partition the tets of other partitions with a corner in it, as sets."""
        corners, partition = self.tets()
        around = [set() for _ in range(corners.max() + 1)]
        for tet, p in zip(corners.tolist(), partition.tolist()):
            for v in tet:
                around[v].add(p)
        found = [set() for _ in range(PARTITIONS)]
        for t, tet in enumerate(corners.tolist()):
            for p in set().union(*(around[v] for v in tet)) - {partition[t]}:
                found[p].add(t)
        return found


def section(text, name):
    return text.split(f"${name}\n", 1)[1].split(f"$End{name}", 1)[0].split("\n")


def with_gmsh(folder, program, models):
    """Gmsh opens the file, and the file that it saves has the same partitions and ghosts."""
    if shutil.which("gmsh") is None:
        skip("gmsh")
    for order in (1, 2):
        mesh = Divided(folder, program, models, order)
        _, partition = mesh.tets()
        kind = "4" if order == 1 else "11"
        for name, options in (("plain.msh", ()), ("plain.msh2", ()), ("ghosts.msh", ("--ghost-cells",))):
            path = mesh.convert(name, *options)
            said = run(folder, "gmsh", path, "-0", "-save_all", "-format", "msh22", "-o", "old.msh")
            complaints = [line for line in said.splitlines() if "Error" in line or "Warning" in line
                          and "older than 4.0 may cause information loss" not in line]
            assert not complaints, complaints
            assert f"{PARTITIONS} partitions" in said or name != "plain.msh", said
            found, ghosts, numbers = {}, [set() for _ in range(PARTITIONS)], []
            for line in section((folder / "old.msh").read_text(), "Elements")[1:-1]:
                words = line.split()
                if words[1] != kind:
                    continue
                partitions = [int(word) for word in words[6:6 + int(words[5])]]
                t = len(numbers)
                numbers.append(int(words[0]))
                found[t] = partitions[0] - 1
                for ghost in partitions[1:]:
                    assert ghost < 0, line
                    ghosts[-ghost - 1].add(t)
            sizes = np.bincount(list(found.values()), minlength=PARTITIONS)
            assert (sizes == np.bincount(partition, minlength=PARTITIONS)).all(), (name, sizes)
            if options:
                expected = [len(each) for each in mesh.ghosts()]
                counted = [len(each) for each in ghosts]
                assert counted == expected, (name, counted, expected)
            # Gmsh saves it as 4.1, and we read it: the same tets in the same partitions.
            run(folder, "gmsh", path, "-0", "-save_all", "-format", "msh41", "-o", "new.msh")
            info = json.loads(run(folder, program, "info", "new.msh", "--json"))["mesh"]
            for key in ("points", "tets", "faces", "partitions"):
                assert info[key] == mesh.info[key], (name, key, info[key], mesh.info[key])
            print(f"{name} of order {order}: partitions of {sizes} tets")
    # Also read a mesh that Gmsh has divided itself, with its own boundaries between partitions.
    whole = folder / "whole.msh"
    run(folder, program, models / "two_boxes.poly", "-o", whole, "--size", "0.4")
    before = json.loads(run(folder, program, "info", whole, "--json"))["mesh"]
    for form in ("msh41", "msh40", "msh22"):
        for binary in ((), ("-bin",)) if form != "msh40" else ((),):
            run(folder, "gmsh", whole, "-0", "-part", "3", "-part_ghosts", "-save_all", *binary,
                "-format", form, "-o", "gmsh.msh")
            info = json.loads(run(folder, program, "info", "gmsh.msh", "--json"))["mesh"]
            assert info["partitions"]["count"] == 3, (form, binary, info["partitions"])
            assert (info["tets"], info["faces"]) == (before["tets"], before["faces"]), (form, binary)
            found, expected = info["region_volumes"], before["region_volumes"]
            assert found.keys() == expected.keys(), (form, binary, found)
            assert np.allclose(list(found.values()), list(expected.values())), (form, binary)
            print(f"Gmsh's own {form} {binary}: {info['partitions']}")


def with_vtk(folder, program, models):
    """vtkXMLPUnstructuredGridReader finds all cells once, their numbers, and marked ghosts."""
    try:
        import vtk
    except ImportError:
        skip("python3-vtk9")
    from vtk.util.numpy_support import vtk_to_numpy

    for order in (1, 2):
        mesh = Divided(folder, program, models, order)
        whole = mesh.grid()
        points = vtk_to_numpy(whole.GetPoints().GetData())
        corners, partition = mesh.tets()
        ghosts = mesh.ghosts()
        for name, options in (("plain.pvtu", ()), ("ghosts.pvtu", ("--ghost-cells",))):
            path = mesh.convert(name, *options)
            reader = vtk.vtkXMLPUnstructuredGridReader()
            reader.SetFileName(str(path))
            reader.Update()
            assert reader.GetNumberOfPieces() == PARTITIONS
            grid = reader.GetOutput()
            assert grid.GetNumberOfCells() == len(corners) + (sum(map(len, ghosts)) if options else 0)
            arrays, found = (
                {data.GetArrayName(k) for k in range(data.GetNumberOfArrays())}
                for data in (whole.GetCellData(), grid.GetCellData()))
            assert arrays <= found, arrays - found
            seen, owned = np.zeros(len(corners), int), np.zeros(len(points), int)
            for k in range(PARTITIONS):
                piece = vtk.vtkXMLUnstructuredGridReader()
                piece.SetFileName(str(folder / f"{path.stem}_{k}.vtu"))
                piece.Update()
                part = piece.GetOutput()
                cell_ids = vtk_to_numpy(part.GetCellData().GetGlobalIds())
                point_ids = vtk_to_numpy(part.GetPointData().GetGlobalIds())
                assert (vtk_to_numpy(part.GetPoints().GetData()) == points[point_ids]).all()
                nodes = vtk_to_numpy(part.GetCells().GetConnectivityArray()).reshape(len(cell_ids), -1)[:, :4]
                assert (point_ids[nodes] == corners[cell_ids]).all()
                assert (vtk_to_numpy(part.GetCellData().GetArray("partition")) == partition[cell_ids]).all()
                own = partition[cell_ids] == k
                marks = part.GetCellGhostArray()
                assert (marks is None) == (not options)
                if options:
                    duplicate = vtk.vtkDataSetAttributes.DUPLICATECELL
                    assert (vtk_to_numpy(marks) == np.where(own, 0, duplicate)).all()
                    assert set(cell_ids[~own].tolist()) == ghosts[k]
                    duplicate = vtk.vtkDataSetAttributes.DUPLICATEPOINT
                    owned[point_ids] += vtk_to_numpy(part.GetPointGhostArray()) != duplicate
                else:
                    assert own.all()
                seen[cell_ids[own]] += 1
            assert (seen == 1).all()
            assert not options or (owned == 1).all()
            if options:  # where a partition meets another one, its surface is that of the ghosts
                surface = vtk.vtkDataSetSurfaceFilter()
                surface.SetInputData(grid)
                surface.SetNonlinearSubdivisionLevel(0)
                surface.Update()
                marks = vtk_to_numpy(surface.GetOutput().GetCellData().GetArray("vtkGhostType"))
                sides = np.sort(np.concatenate([np.delete(corners, k, axis=1) for k in range(4)]), axis=1)
                outer = (np.unique(sides, axis=0, return_counts=True)[1] == 1).sum()
                assert (marks == 0).sum() == outer, ((marks == 0).sum(), outer)
            print(f"{name} of order {order}: {grid.GetNumberOfCells()} cells")


def with_meshio(folder, program, models):
    try:
        import meshio
    except ImportError:
        skip("python3-meshio")
    for order in (1, 2):
        mesh = Divided(folder, program, models, order)
        _, partition = mesh.tets()
        kind = "tetra" if order == 1 else "tetra10"
        optional = []
        try:
            import h5py  # noqa: F401

            optional = [e for e in ("xdmf", "med") if not subprocess.run(
                [program, "convert", mesh.name, "-o", folder / f"try.{e}"], capture_output=True).returncode]
        except ImportError:
            print("python3-h5py is not installed: .med and .xdmf are not tested")
        for extension in ("vtu", "vtk", *optional):
            found = meshio.read(mesh.convert(f"by_meshio.{extension}")).cell_data_dict["partition"][kind]
            assert np.array_equal(np.ravel(found).astype(int), partition), (extension, order)
            print(f".{extension} of order {order}: {np.bincount(partition)}")
        # meshio 5 cannot read partitioned files in format 4.1, neither ours nor Gmsh's.
        path = mesh.convert("by_meshio.msh", "--format", "msh2")
        assert len(meshio.read(path).cells_dict[kind]) == len(partition), order
        print(f".msh2 of order {order}: read")


FOAM = "FoamFile {{ version 2.0; format ascii; class dictionary; object {}; }}\n"
FOAM_FILES = {
    "controlDict": "application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; "
    "deltaT 1; writeControl timeStep; writeInterval 1; ",
    "fvSchemes": "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} interpolationSchemes {} "
    "snGradSchemes {} ",
    "fvSolution": "",
    "decomposeParDict": f"numberOfSubdomains {PARTITIONS}; method manual; "
    'coeffs { dataFile "cellDecomposition"; } ',
}


def with_openfoam(folder, program, models):
    """decomposePar assigns the cells to processors as our file says."""
    if shutil.which("gmshToFoam") is None or shutil.which("decomposePar") is None:
        skip("openfoam")
    (folder / "system").mkdir()
    (folder / "constant").mkdir()
    for name, text in FOAM_FILES.items():
        (folder / "system" / name).write_text(FOAM.format(name) + text)
    run(folder, program, models / "box.off", "-o", "box.vtu", "--size", "0.3", "--partitions", PARTITIONS)
    run(folder, program, "convert", "box.vtu", "-o", "duct.msh", "--format", "msh2", "--cell-decomposition",
        "constant/cellDecomposition")
    info = json.loads(run(folder, program, "info", "box.vtu", "--json"))["mesh"]
    environment = {
        **os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam", "FOAM_ETC": "/usr/share/openfoam/etc"}
    run(folder, "gmshToFoam", "duct.msh", env=environment)
    run(folder, "decomposePar", env=environment)
    cells, shared = [], 0
    for k in range(PARTITIONS):
        mesh = folder / f"processor{k}/constant/polyMesh"
        cells.append(int(re.search(r"nCells:\s*(\d+)", (mesh / "owner").read_text())[1]))
        boundary = (mesh / "boundary").read_text()
        for name, count in re.findall(r"(procBoundary\w+)\s*\{.*?nFaces\s+(\d+);", boundary, re.S):
            shared += int(count)
    partitions = info["partitions"]
    assert sum(cells) == info["tets"], cells
    assert (min(cells), max(cells)) == (partitions["smallest"], partitions["largest"]), (cells, partitions)
    assert shared == 2 * partitions["cut_faces"], (shared, partitions)  # a cut face belongs to two processors
    print("processors with", cells, "cells,", shared // 2, "faces between them")


OTHERS = {"gmsh": with_gmsh, "vtk": with_vtk, "meshio": with_meshio, "openfoam": with_openfoam}

if __name__ == "__main__":
    collarmesh, resources = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    if not (collarmesh.parents[1] / "lib/collarmesh/collarmesh_scotch.so").exists():
        skip("Scotch")
    with tempfile.TemporaryDirectory() as work:
        OTHERS[sys.argv[3]](pathlib.Path(work), collarmesh, resources)
