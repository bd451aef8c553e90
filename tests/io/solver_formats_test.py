#!/usr/bin/python3
"""Formats of solvers that we only write, read by others: Nastran and SU2 by meshio, OpenFOAM by checkMesh, Exodus and
CGNS by VTK, CGNS also by its library's cgnscheck where it is installed, Ansys and MFEM by readers of their own, which
follow the formats' descriptions.

    solver_formats_test.py PROGRAM MODELS (nastran|su2|ansys|mfem|exodus|cgns|openfoam)

Exit code 77: the judge is not installed.
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

PROGRAM, MODELS, KIND = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))  # edges of the mid-edge nodes of a tetrahedron in .vtk
NAMES = {"patches": {"Wall left": {"at": [0, 0.5, 0.5]}, "outlet": {"at": [3, 0.5, 0.5]}},
         "regions": {"steel": 1, "air": 2}}
# A rib on a plate. The plate's top, with the tag 6, touches the rib only in its middle; the regions have no
# tags.
RIB = """16 3 0 0
1 0 0 0\n2 3 0 0\n3 3 1 0\n4 0 1 0
5 0 0 1\n6 1 0 1\n7 2 0 1\n8 3 0 1\n9 3 1 1\n10 2 1 1\n11 1 1 1\n12 0 1 1
13 1 0 2\n14 2 0 2\n15 2 1 2\n16 1 1 2
13 1
1 0 1\n4 1 2 3 4
1 0 2\n6 1 2 8 7 6 5
1 0 3\n4 2 3 9 8
1 0 4\n6 3 4 12 11 10 9
1 0 5\n4 4 1 5 12
1 0 6\n4 5 6 11 12
1 0 6\n4 6 7 10 11
1 0 6\n4 7 8 9 10
1 0 7\n4 6 7 14 13
1 0 8\n4 7 10 15 14
1 0 9\n4 10 11 16 15
1 0 10\n4 11 6 13 16
1 0 11\n4 13 14 15 16
0
2
1 0.5 0.5 0.5 {}
2 1.5 0.5 1.5 {}
"""


def run(folder, *command, code=0, env=None):
    result = subprocess.run([str(part) for part in command], cwd=folder, capture_output=True, text=True, env=env)
    if result.returncode != code:
        raise SystemExit(f"{command}: {result.returncode}\n{result.stdout[-3000:]}\n{result.stderr[-2000:]}")
    return result.stdout + result.stderr


def expect(condition, what):
    if not condition:
        raise SystemExit(f"FAILED: {what}")


def volumes(points, tets):
    a, b, c, d = (points[tets[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


class Sample:
    """Two boxes, or a rib on a plate with names, or a sphere, with the expected contents of their mesh."""

    def __init__(self, folder, model, order, size):
        import meshio

        self.folder, self.order = folder, order
        named = [] if model == "sphere.off" else ["--names", json.dumps(NAMES)]
        run(folder, PROGRAM, MODELS / model, "-o", "a.vtk", "--size", size, "--order", order, *named)
        mesh = meshio.read(folder / "a.vtk")
        pick = dict(zip(("tets", "faces", "edges"), (("tetra", "triangle", "line"),
                    ("tetra10", "triangle6", "line3"))[order - 1]))
        self.points = mesh.points
        for name, kind in pick.items():
            blocks = [i for i, block in enumerate(mesh.cells) if block.type == kind]
            setattr(self, name, np.concatenate([mesh.cells[i].data for i in blocks])
                    if blocks else np.zeros((0, 2), int))
            setattr(self, name[:-1] + "_tag",
                    np.concatenate([mesh.cell_data["tag"][i] for i in blocks]) if blocks else np.zeros(0, int))
        of_faces = [i for i, block in enumerate(mesh.cells) if block.type == pick["faces"]]
        self.face_inside = np.concatenate([
            (mesh.cell_data["region_back"][i] != 0) & (mesh.cell_data["region_front"][i] != 0) for i in of_faces])
        self.region = np.concatenate([mesh.cell_data["region"][i]
                                     for i, b in enumerate(mesh.cells) if b.type == pick["tets"]])

    def convert(self, name, *options):
        return run(self.folder, PROGRAM, "convert", "a.vtk", "-o", name, *options)

    def name_of_patch(self, tag):
        x = self.points[self.faces[self.face_tag == tag]][:, :3, 0]
        named = len(np.unique(self.region)) == 2
        return "Wall left" if named and (x == 0).all() else "outlet" if named and (x == 3).all() else f"patch_{tag}"

    def nodes_of_patch(self, x):
        """Returns the nodes of the faces in the plane at this x."""
        flat = np.abs(self.points[self.faces][:, :3, 0] - x).max(axis=1) < 1e-12
        return set(np.unique(self.faces[flat]))


def samples(folder):
    for order in (1, 2):
        yield Sample(folder, "two_boxes.poly", order, 0.4)
        yield Sample(folder, "sphere.off", order, 0.5)
        (folder / "rib.poly").write_text(RIB.format(1, 2))
        yield Sample(folder, folder / "rib.poly", order, 0.4)


def nastran(folder):
    import meshio

    for sample in samples(folder):
        told = sample.convert("a.bdf")
        expect("edges on curves" in told or len(sample.edges) == 0, told)
        mesh = meshio.read(folder / "a.bdf")
        cells = {block.type: block.data for block in mesh.cells}
        kinds = ("tetra", "triangle") if sample.order == 1 else ("tetra10", "triangle6")
        expect(np.allclose(mesh.points, sample.points, rtol=1e-9, atol=1e-12), "points")
        expect(np.array_equal(cells[kinds[0]], sample.tets), "tetrahedra and their mid nodes")
        expect(np.array_equal(cells[kinds[1]], sample.faces), "faces and their mid nodes")
        property_of = {block.type: refs for block, refs in zip(mesh.cells, mesh.cell_data["nastran:ref"])}
        expect(np.array_equal(property_of[kinds[0]], sample.region), "properties are regions")
        names = dict(re.findall(r'^\$HMNAME PROP +(\d+)"(.*)"$', (folder / "a.bdf").read_text(), re.M))
        for tag in np.unique(sample.face_tag):
            found = set(property_of[kinds[1]][sample.face_tag == tag])
            expect(len(found) == 1 and str(*found) in names, f"property {found} of the tag {tag}")
        if len(np.unique(sample.region)) == 2:
            expect({"steel", "air", "Wall left", "outlet"} <= set(names.values()), f"names {names}")
    # Tests numbers with few digits, without a decimal point in their shortest form, and with exponents: each
    # must fit its field.
    run(folder, PROGRAM, MODELS / "box.off", "-o", "b.bdf", "--scale", "1.2345678901234e-87")
    expect(max(len(line) for line in (folder / "b.bdf").read_text().splitlines()) <= 80, "lines of 80 characters")
    expect(abs(meshio.read(folder / "b.bdf").points.max() / 3.7037036703702e-87 - 1) < 1e-8, "very small numbers")


def su2(folder):
    import meshio

    for sample in samples(folder):
        if sample.order == 2:
            told = run(folder, PROGRAM, "convert", "a.vtk", "-o", "b.su2", code=8)
            expect("no elements of second order" in told and not (folder / "b.su2").exists(), told)
            run(folder, PROGRAM, MODELS / "box.off", "-o", "b.su2", "--order", "2", code=2)
            continue
        told = sample.convert("a.su2")
        mesh = meshio.read(folder / "a.su2")
        expect(np.array_equal(mesh.points, sample.points), "points")
        cells = {block.type: block.data for block in mesh.cells}
        expect(np.array_equal(cells["tetra"], sample.tets), "tetrahedra")
        text = (folder / "a.su2").read_text()
        names = re.findall(r"MARKER_TAG= (\S+)", text)
        # In a closed surface each edge occurs twice.
        sides = np.sort(np.concatenate([cells["triangle"][:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
        expect((np.unique(sides, axis=0, return_counts=True)[1] % 2 == 0).all(), "the boundary is closed")
        if len(np.unique(sample.region)) == 2:
            expect({"Wall_left", "outlet"} <= set(names), f"markers {names}")
            expect("2 regions" in told and "triangles inside" in told and "2 names of groups" in told, told)
            expect(len(cells["triangle"]) < len(sample.faces), "the interface is left out")
        else:
            expect(len(cells["triangle"]) == len(sample.faces), "all faces")


def read_ansys(path):
    """Reads NBLOCK, EBLOCK and CMBLOCK in the columns that their format lines describe."""
    lines = path.read_text().splitlines()
    nodes, elements, components, kind = {}, {}, {}, None
    i = 0
    while i < len(lines):
        line = lines[i]
        i += 1
        if line.startswith("ET,1,"):
            kind = int(line.split(",")[2])
        elif line.startswith("NBLOCK"):
            expect(lines[i] == "(3i9,6e21.13e3)", "format of nodes")
            i += 1
            while not lines[i].startswith("N,"):
                row = lines[i]
                nodes[int(row[:9])] = [float(row[27 + 21 * k:48 + 21 * k]) for k in range(3)]
                i += 1
        elif line.startswith("EBLOCK"):
            expect(lines[i] == "(19i9)", "format of elements")
            i += 1
            while int(lines[i][:9]) != -1:
                row = [int(lines[i][9 * k:9 * k + 9]) for k in range(len(lines[i]) // 9)]
                i += 1
                count = row[8]
                if count > 8:
                    row += [int(lines[i][9 * k:9 * k + 9]) for k in range(count - 8)]
                    i += 1
                expect(len(row) == 11 + count, f"element {row}")
                elements[row[10]] = (row[0], row[11:])
            i += 1
        elif line.startswith("CMBLOCK"):
            _, name, what, count = line.split(",")
            members = []
            i += 1
            while len(members) < int(count):
                members += [int(lines[i][10 * k:10 * k + 10]) for k in range(len(lines[i]) // 10)]
                i += 1
            expect(name not in components and re.fullmatch(r"[A-Z][A-Z0-9_]{0,31}", name), f"component {name}")
            components[name] = (what, members)
    return kind, nodes, elements, components


def ansys(folder):
    for sample in samples(folder):
        sample.convert("a.cdb")
        kind, nodes, elements, components = read_ansys(folder / "a.cdb")
        expect(kind == (285, 187)[sample.order - 1], f"type {kind}")
        points = np.array([nodes[n] for n in range(1, len(nodes) + 1)])
        expect(np.allclose(points, sample.points, rtol=1e-12, atol=1e-13), "nodes")
        tets = np.array([elements[n][1] for n in range(1, len(elements) + 1)]) - 1
        expect(np.array_equal(tets, sample.tets), "elements and their mid nodes")
        expect([elements[n][0] for n in sorted(elements)] == list(sample.region), "materials are regions")
        if len(np.unique(sample.region)) == 2:
            for name, region in (("STEEL", 1), ("AIR", 2)):
                what, members = components[name]
                expect(what == "ELEM" and np.array_equal(np.array(members) -
                       1, np.flatnonzero(sample.region == region)), name)
            for name, x in (("WALL_LEFT", 0), ("OUTLET", 3)):
                what, members = components[name]
                expect(what == "NODE" and {n - 1 for n in members} == sample.nodes_of_patch(x), name)
            expect(any(name.startswith("CURVE_") for name in components), "curves")


def read_mfem(path):
    text = path.read_text()
    expect(text.startswith("MFEM mesh v1.0\n"), "first line")
    names = dict(re.findall(r"^# (?:boundary )?attribute (\d+): (.*)$", text, re.M))
    words = re.sub(r"#.*", "", text).split("\n", 1)[1].split()
    at = 0

    def take(count):
        nonlocal at
        at += count
        return words[at - count:at]

    expect(take(2) == ["dimension", "3"], "dimension")
    cells = {}
    for section, corners, kind in (("elements", 4, 4), ("boundary", 3, 2)):
        expect(take(1) == [section], section)
        rows = np.array(take((corners + 2) * int(*take(1))), dtype=int).reshape(-1, corners + 2)
        expect((rows[:, 1] == kind).all() and (rows[:, 0] > 0).all(), f"kinds and attributes of {section}")
        cells[section] = rows
    expect(take(1) == ["vertices"], "vertices")
    count = int(*take(1))
    if words[at] == "3":
        take(1)
        return cells, count, np.array(take(3 * count), dtype=float).reshape(-1, 3), names
    expect(take(7) == ["nodes", "FiniteElementSpace", "FiniteElementCollection:",
           "H1_3D_P2", "VDim:", "3", "Ordering:"], "nodes")
    expect(take(1) == ["1"], "ordering")
    return cells, count, np.array(words[at:], dtype=float).reshape(-1, 3), names


def mfem(folder):
    for sample in samples(folder):
        sample.convert("a.mfem")
        cells, vertices, nodes, names = read_mfem(folder / "a.mfem")
        tets = cells["elements"][:, 2:]
        expect((cells["elements"][:, 0] == sample.region).all(), "attributes are regions")
        expect(np.array_equal(nodes[tets], sample.points[sample.tets[:, :4]]), "corners of tetrahedra")
        expect(np.array_equal(nodes[cells["boundary"][:, 2:]], sample.points[sample.faces[:, :3]]), "corners of faces")
        # MFEM numbers edges in the order in which elements use them.
        edge_of = {}
        for tet in tets:
            for i, j in ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)):
                edge_of.setdefault(frozenset((tet[i], tet[j])), len(edge_of))
        expect(len(nodes) == vertices + (len(edge_of) if sample.order == 2 else 0), f"{len(nodes)} nodes")
        if sample.order == 2:
            for k, (i, j) in enumerate(EDGES):
                at = [vertices + edge_of[frozenset((tet[i], tet[j]))] for tet in tets]
                expect(np.array_equal(nodes[at], sample.points[sample.tets[:, 4 + k]]), f"mid nodes {k}")
        attributes = dict(zip(sample.face_tag, cells["boundary"][:, 0]))
        expect(all(attributes[tag] == a for tag, a in zip(
            sample.face_tag, cells["boundary"][:, 0])), "attributes of faces")
        if len(np.unique(sample.region)) == 2:
            of_attributes = re.findall(r"^# attribute \d+: (.*)$", (folder / "a.mfem").read_text(), re.M)
            expect({"steel", "air"} <= set(of_attributes), names)
            expect({"Wall left", "outlet"} <= set(names.values()), names)


def foam_numbers(path):
    body = path.read_text().split("}", 1)[1]
    return [int(word) for word in re.search(r"\n\d+\n\(\n(.*)\n\)", body, re.S)[1].split()]


def check_polymesh(folder, sample):
    """Checks the order of faces, that cells are closed, and their volume, from the files alone."""
    text = (folder / "points").read_text().split("}", 1)[1]
    points = np.array([row.split() for row in re.findall(r"^\((.*)\)$", text, re.M)], dtype=float)
    faces = np.array([row.split() for row in re.findall(
        r"^3\((.*)\)$", (folder / "faces").read_text(), re.M)], dtype=int)
    owner, neighbour = np.array(foam_numbers(folder / "owner")), np.array(foam_numbers(folder / "neighbour"))
    inside = len(neighbour)
    expect(np.array_equal(points, sample.points), "points")
    expect((owner[:inside] < neighbour).all(), "owners come before neighbours")
    expect((np.diff(owner[:inside] * len(sample.tets) + neighbour) > 0).all(), "upper triangular order")
    a, b, c = (points[faces[:, k]] for k in range(3))
    area = np.cross(b - a, c - a) / 2
    closed, volume = np.zeros((len(sample.tets), 3)), np.zeros(len(sample.tets))
    flux = np.einsum("ij,ij->i", area, a) / 3
    np.add.at(closed, owner, area)
    np.add.at(closed, neighbour, -area[:inside])
    np.add.at(volume, owner, flux)
    np.add.at(volume, neighbour, -flux[:inside])
    expect(np.abs(closed).max() < 1e-12, "cells are closed")
    expect(np.allclose(volume, volumes(sample.points, sample.tets)), "volumes of cells")


def openfoam(folder):
    sample = Sample(folder, "two_boxes.poly", 1, 0.4)
    (folder / "constant/polyMesh").mkdir(parents=True)
    told = sample.convert("constant/polyMesh/boundary", "--format", "polymesh")
    expect("edges on curves" in told, told)
    check_polymesh(folder / "constant/polyMesh", sample)
    boundary = (folder / "constant/polyMesh/boundary").read_text()
    types = dict(re.findall(r"^    (\w+)\n    \{\n        type +(\w+);", boundary, re.M))
    expect(types.get("Wall_left") == "wall" and types.get("outlet") == "patch", f"types of patches {types}")
    expect(re.findall(r"^(\w+)\n\{\n +type +cellZone", (folder / "constant/polyMesh/cellZones").read_text(), re.M)
           == ["steel", "air"], "zones of cells")
    run(folder, PROGRAM, "convert", "a.vtk", "-o", "constant/polyMesh/other", "--format", "polymesh", code=8)
    if not shutil.which("checkMesh"):
        print("openfoam is not installed")
        sys.exit(77)
    (folder / "system").mkdir()
    for name, text in (("controlDict", "deltaT 1; endTime 1; writeInterval 1;"), ("fvSolution", ""),
                       ("fvSchemes", "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} "
                                     "interpolationSchemes {} snGradSchemes {}")):
        (folder / "system" / name).write_text(
            f"FoamFile {{ version 2.0; format ascii; class dictionary; object {name}; }}\n{text}\n")
    environment = {**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam", "FOAM_ETC": "/usr/share/openfoam/etc"}
    said = run(folder, "checkMesh", env=environment)
    expect("Mesh OK" in said, said[-3000:])
    expect(re.search(r"cell zones: +2\b", said) and re.search(r"face zones: +1\b", said), said[-3000:])


def leaves(data):
    """Returns the names and grids of VTK's blocks."""
    if not data.IsA("vtkMultiBlockDataSet"):
        return []
    found = []
    for i in range(data.GetNumberOfBlocks()):
        block = data.GetBlock(i)
        info = data.GetMetaData(i) if data.HasMetaData(i) else None
        name = info.Get(data.NAME()) if info is not None and info.Has(data.NAME()) else ""
        if block is not None:
            found += leaves(block) if block.IsA("vtkMultiBlockDataSet") else [(name, block)]
    return found


def cells_of(grid):
    """Returns points, and rows of nodes by VTK's cell type."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    kinds, cells = vtk_to_numpy(grid.GetCellTypesArray()), vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    starts = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    points = vtk_to_numpy(grid.GetPoints().GetData())
    return points, {int(kind): np.array([cells[starts[i]:starts[i + 1]] for i in np.flatnonzero(kinds == kind)])
                    for kind in np.unique(kinds)}


def expect_regions(grids, sample):
    """Checks that there is a grid of tetrahedra for each region, with its name."""
    named = {1: "steel", 2: "air"} if len(np.unique(sample.region)) == 2 else {1: "region_1"}
    expect(set(grids) == set(named.values()), f"blocks {set(grids)}")
    for region, name in named.items():
        points, cells = cells_of(grids[name])
        expect(set(cells) == {(10, 24)[sample.order - 1]}, f"kinds of cells {set(cells)}")
        theirs, ours = points[next(iter(cells.values()))], sample.points[sample.tets[sample.region == region]]
        expect(np.allclose(theirs, ours, rtol=0, atol=1e-6), f"nodes of the tetrahedra of {name}")  # VTK stores 32 bits


def exodus(folder):
    from vtkmodules.vtkIOExodus import vtkExodusIIReader

    for sample in samples(folder):
        told = sample.convert("a.exo")
        expect("edges on curves (node sets are kept)" in told or len(sample.edges) == 0, told)
        reader = vtkExodusIIReader()
        reader.SetFileName(str(folder / "a.exo"))
        reader.UpdateInformation()
        for kind in (reader.SIDE_SET, reader.NODE_SET):
            for i in range(reader.GetNumberOfObjects(kind)):
                reader.SetObjectStatus(kind, i, 1)
        reader.Update()
        grids = dict(leaves(reader.GetOutput()))
        sides = {reader.GetObjectName(reader.SIDE_SET, i) for i in range(reader.GetNumberOfObjects(reader.SIDE_SET))}
        nodes = {reader.GetObjectName(reader.NODE_SET, i) for i in range(reader.GetNumberOfObjects(reader.NODE_SET))}
        expect_regions({name: grid for name, grid in grids.items() if name not in sides | nodes}, sample)
        expect(len(nodes) == len(np.unique(sample.edge_tag)) and all(
            name.startswith("curve_") for name in nodes), nodes)
        for tag in np.unique(sample.face_tag):
            faces = sample.faces[sample.face_tag == tag]
            at = sample.points[faces]
            name = sample.name_of_patch(tag)
            points, cells = cells_of(grids[name])
            expect(set(cells) == {(5, 22)[sample.order - 1]}, f"kinds of sides {set(cells)}")
            theirs = points[next(iter(cells.values()))].mean(axis=1)
            expect(np.allclose(theirs, at.mean(axis=1), rtol=0, atol=1e-6), f"sides of {name}")
        expect_coordinates(folder / "a.exo", sample)
        expect(b"eb_prop2" in (folder / "a.exo").read_bytes(), "tags")
    run(folder, PROGRAM, "info", "a.exo", code=3)
    (folder / "long.poly").write_text(RIB.format(1, 2**32 + 2))
    run(folder, PROGRAM, "long.poly", "-o", "long.exo", "--size", "0.5")
    written = (folder / "long.exo").read_bytes()
    expect(b"region_4294967298" in written and b"eb_prop2" not in written, "no tags that are cut off")


def expect_coordinates(path, sample):
    """Checks all digits with a reader of NetCDF."""
    try:
        from scipy.io import netcdf_file
    except ImportError:
        return
    with netcdf_file(path, "r", mmap=False) as file:
        for axis, name in enumerate(("coordx", "coordy", "coordz")):
            expect(np.array_equal(file.variables[name][:], sample.points[:, axis]), name)
        expect(file.variables["eb_prop2"].name == b"TAG" and len(file.variables["time_whole"][:]) == 0, "properties")


def cgns(folder):
    if not any((PROGRAM.parents[1] / "lib/collarmesh").glob("collarmesh_hdf5*")):
        print("this program was built without HDF5")
        sys.exit(77)
    from vtkmodules.vtkIOCGNSReader import vtkCGNSReader

    for sample in samples(folder):
        sample.convert("a.cgns")
        reader = vtkCGNSReader()
        reader.SetFileName(str(folder / "a.cgns"))
        reader.LoadBndPatchOn()
        reader.LoadMeshOn()
        reader.UpdateInformation()
        reader.EnableAllBases()
        reader.EnableAllFamilies()
        reader.Update()
        grids = dict(leaves(reader.GetOutput()))
        points, cells = cells_of(grids.pop("Internal"))
        expect(np.array_equal(points, sample.points), "points")
        order = np.argsort(sample.region, kind="stable")
        expect(np.array_equal(*cells.values(), sample.tets[order]), "tetrahedra, region by region")
        outside = {sample.name_of_patch(tag): sample.faces[(sample.face_tag == tag) & ~sample.face_inside]
                   for tag in np.unique(sample.face_tag[~sample.face_inside])}
        expect(set(grids) == set(outside), f"boundary conditions {set(grids)}")
        for name, faces in outside.items():
            expect(np.array_equal(*cells_of(grids[name])[1].values(), faces), f"faces of {name}")
        expect_sections(folder / "a.cgns", sample)
        if shutil.which("cgnscheck"):
            said = run(folder, "cgnscheck", "-v", "a.cgns")
            expect("checking complete" in said and "warning" not in said.lower() and "error" not in said.lower(), said)


def expect_sections(path, sample):
    """Checks the elements of each region, face and curve, by name."""
    import h5py

    with h5py.File(path) as file:
        zone = file["Base/Zone"]
        sections = {name: np.array(node["ElementConnectivity/ data"]) for name, node in zone.items()
                    if node.attrs.get("label", b"").startswith(b"Elements_t")}
    named = {1: "steel", 2: "air"} if len(np.unique(sample.region)) == 2 else {1: "region_1"}
    expected = {name: sample.tets[sample.region == region] for region, name in named.items()}
    outside_first = np.argsort(sample.face_inside, kind="stable")
    faces, face_tag = sample.faces[outside_first], sample.face_tag[outside_first]
    expected |= {sample.name_of_patch(tag): faces[face_tag == tag] for tag in np.unique(face_tag)}
    expected |= {f"curve_{tag}": sample.edges[sample.edge_tag == tag] for tag in np.unique(sample.edge_tag)}
    expect(set(sections) == set(expected), f"sections {set(sections)}")
    for name, cells in expected.items():
        expect(np.array_equal(sections[name], cells.ravel() + 1), f"nodes of {name}")


if __name__ == "__main__":
    if KIND in ("nastran", "su2", "ansys", "mfem", "exodus", "cgns", "openfoam"):
        try:
            import meshio  # noqa: F401
        except ImportError:
            print("python3-meshio is not installed")
            sys.exit(77)
    if KIND in ("exodus", "cgns"):
        try:
            import vtkmodules.vtkIOExodus  # noqa: F401
        except ImportError:
            print("python3-vtk9 is not installed")
            sys.exit(77)
    with tempfile.TemporaryDirectory() as work:
        globals()[KIND](pathlib.Path(work))
    print("all agree")
