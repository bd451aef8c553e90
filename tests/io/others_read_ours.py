#!/usr/bin/python3
"""Do the programs of others find in our files what we wrote?

    others_read_ours.py WRITE_SAMPLE_MESH

Writes the sample mesh as .vtu, .msh and .mesh and reads it with meshio, VTK and Gmsh. A library
that is not installed is skipped and named. Exit code 0: all agree; 1: not; 77: nothing could be tested.
"""
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np

try:
    import meshio
except ImportError:
    meshio = None
try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    vtk = None

N = 3
DIMENSIONS = {"tetra": 3, "triangle": 2, "line": 1}
failures = []


def expect(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def by_type(mesh, name=None):
    """Returns the cells, or values of a cell array, in all blocks of a type."""
    result = {}
    for i, block in enumerate(mesh.cells):
        result.setdefault(block.type, []).append(block.data if name is None else mesh.cell_data[name][i])
    return {kind: np.concatenate(parts) for kind, parts in result.items()}


def volumes(points, tets):
    a, b, c, d = (points[tets[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def check_counts(label, mesh, counts):
    cells = by_type(mesh)
    points, tets, faces, edges = counts
    expect(len(mesh.points) == points, f"{label}: {len(mesh.points)} points, expected {points}")
    for kind, count in (("tetra", tets), ("triangle", faces), ("line", edges)):
        expect(len(cells[kind]) == count, f"{label}: {len(cells[kind])} cells {kind}, expected {count}")
    expect((volumes(mesh.points, cells["tetra"]) > 0).all(), f"{label}: all tets positive")


def canonical(points, cells, values):
    """Returns cells by coordinates with their values, independent of the order of nodes and cells. (Gmsh
    writes 16 digits.)"""
    rounded = np.round(points, 12)
    return sorted((tuple(sorted(map(tuple, rounded[cell]))), int(value)) for cell, value in zip(cells, values))


def check_vtk_with_meshio(path, counts):
    """Checks cells of all kinds."""
    mesh = meshio.read(path)
    check_counts("vtk by meshio", mesh, counts)
    names = {"region", "region_back", "region_front", "tag", "feature", "collar",
             "radius_edge", "min_dihedral", "max_dihedral"}
    check_arrays("vtk by meshio", mesh, names)
    return mesh


def check_arrays(label, mesh, names):
    expect(names <= set(mesh.cell_data), f"{label}: cell arrays {sorted(mesh.cell_data)}")
    for name in names & set(mesh.cell_data):
        for block, values in zip(mesh.cells, mesh.cell_data[name]):
            expect(np.shape(np.squeeze(values)) == (len(block.data),), f"{label}: shape of {name} for {block.type}")
            expect(np.isfinite(values).all(), f"{label}: {name} finite")
    expect(set(np.squeeze(by_type(mesh, "collar")["tetra"])) == {0, 1, 2}, f"{label}: collar")
    expect(set(np.squeeze(by_type(mesh, "region")["tetra"])) == {1, 2}, f"{label}: region")
    expect(set(np.squeeze(mesh.point_data["feature_dimension"])) == {0, 1, 2, 3}, f"{label}: feature_dimension")


def check_vtu_with_meshio(path, counts):
    """Checks tetrahedra only."""
    mesh = meshio.read(path)
    expect([(block.type, len(block.data)) for block in mesh.cells] == [("tetra", counts[1])], "vtu by meshio: cells")
    check_arrays("vtu by meshio", mesh, {"region", "tag", "collar", "radius_edge", "min_dihedral", "max_dihedral"})
    return mesh


def check_vtu_with_vtk(path, ours):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    expect(np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), ours.points), "vtu by VTK: points")
    corners = np.concatenate([block.data.ravel() for block in ours.cells])
    expect(np.array_equal(vtk_to_numpy(grid.GetCells().GetConnectivityArray()), corners), "vtu by VTK: corners")
    for name, parts in ours.cell_data.items():
        array = vtk_to_numpy(grid.GetCellData().GetArray(name))
        expect(np.array_equal(array, np.concatenate(parts)), f"vtu by VTK: {name}")
    for name, values in ours.point_data.items():
        expect(np.array_equal(vtk_to_numpy(grid.GetPointData().GetArray(name)), values), f"vtu by VTK: {name}")


def tags_of_msh(mesh):
    """Returns tags from the names of physical groups, which are exact."""
    names = {}
    for name, (number, dimension) in mesh.field_data.items():
        names[int(dimension), int(number)] = int(name.rsplit("_", 1)[1])
    return {kind: np.array([names[DIMENSIONS[kind], int(v)] for v in values])
            for kind, values in by_type(mesh, "gmsh:physical").items()}


def check_msh_with_meshio(label, path, counts, ours):
    mesh = meshio.read(path)
    check_counts(label, mesh, counts)
    tags, cells, our_tags, our_cells = tags_of_msh(mesh), by_type(mesh), by_type(ours, "tag"), by_type(ours)
    for kind in DIMENSIONS:
        read, written = (mesh.points, cells[kind], tags[kind]), (ours.points, our_cells[kind], our_tags[kind])
        expect(canonical(*read) == canonical(*written), f"{label}: tags of {kind}")
    if "collar" in mesh.cell_data:
        expect(canonical(mesh.points, cells["tetra"], by_type(mesh, "collar")["tetra"])
               == canonical(ours.points, our_cells["tetra"], by_type(ours, "collar")["tetra"]), f"{label}: collar")
    return mesh


def check_medit_with_meshio(path, counts, ours):
    mesh = meshio.read(path)
    check_counts("mesh by meshio", mesh, counts)
    expect(np.array_equal(mesh.points, ours.points), "mesh by meshio: points")
    references = by_type(mesh, "medit:ref")
    expect(np.array_equal(references["tetra"], by_type(ours, "region")["tetra"]), "mesh by meshio: regions")
    for kind in ("triangle", "line"):
        expect(np.array_equal(references[kind], by_type(ours, "tag")[kind]), f"mesh by meshio: tags of {kind}")


def convert_with_gmsh(gmsh, path, out):
    run = subprocess.run([gmsh, path, "-0", "-o", out], capture_output=True, text=True)
    complaints = [line for line in (run.stdout + run.stderr).splitlines() if "Error" in line or "Warning" in line]
    expect(run.returncode == 0 and not complaints, f"{path} by Gmsh: {run.returncode} {complaints}")


def main():
    if meshio is None:
        print("python3-meshio is not installed: nothing tested")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        vtu, vtk_file, msh, mesh = (os.path.join(folder, "sample" + ext) for ext in (".vtu", ".vtk", ".msh", ".mesh"))
        run = subprocess.run([sys.argv[1], str(N), "1", vtu, vtk_file, msh, mesh],
                             capture_output=True, text=True, check=True)
        counts = tuple(map(int, run.stdout.split()))
        ours = check_vtk_with_meshio(vtk_file, counts)
        volume = check_vtu_with_meshio(vtu, counts)
        if vtk is None:
            print("reading by VTK ... skipped 'python3-vtk9 is not installed'")
        else:
            check_vtu_with_vtk(vtu, volume)
        read = check_msh_with_meshio("msh by meshio", msh, counts, ours)
        expect("collar" in read.cell_data, "msh by meshio: collar is there")
        check_medit_with_meshio(mesh, counts, ours)
        gmsh = shutil.which("gmsh")
        if gmsh is None:
            print("reading by Gmsh ... skipped 'gmsh is not installed'")
        else:
            for path in (msh, mesh):
                out = os.path.join(folder, "by_gmsh.msh")
                convert_with_gmsh(gmsh, path, out)
                if path == msh:
                    check_msh_with_meshio("msh by Gmsh by meshio", out, counts, ours)
    print("failed" if failures else "all agree")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
