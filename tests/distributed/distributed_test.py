"""collarmesh-mpi: the same mesh on any number of ranks, its certificate, its files, its failures, and solutions on it.

Run by ctest with COLLARMESH_MPI (the program), COLLARMESH_POISSON (the example in C++) and, where there is OpenCASCADE,
COLLARMESH_TWO_SOLIDS (a program that writes a CAD part).
"""

import hashlib
import importlib.util
import itertools
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

import numpy

PROGRAM, POISSON = os.environ["COLLARMESH_MPI"], os.environ["COLLARMESH_POISSON"]
TWO_SOLIDS = os.environ.get("COLLARMESH_TWO_SOLIDS")
SOURCES = pathlib.Path(__file__).resolve().parents[2]
MODELS = SOURCES / "resources" / "models"
DISTRIBUTED = SOURCES / "mesher" / "distributed"
PYTHON = "/usr/bin/python3"
MPIRUN = ["mpirun", "--oversubscribe", "--allow-run-as-root"]
RANKS = (1, 2, 4)


def has(module):
    return importlib.util.find_spec(module) is not None


def wedge(path, angle=20):
    """Writes a prism over a triangle with this angle (degrees) between two sides of length 1."""
    a = math.radians(angle)
    below = [(0, 0, 0), (1, 0, 0), (math.cos(a), math.sin(a), 0)]
    points = below + [(x, y, 1) for x, y, _ in below]
    facets = [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]
    path.write_text(f"OFF\n{len(points)} {len(facets)} 0\n" + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points)
                    + "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in facets))


class Mesh:
    """The arrays of NAME.xdmf and of its faces and edges."""

    def __init__(self, path):
        import h5py
        path = pathlib.Path(path)
        with h5py.File(path) as file:
            self.points = file["xdmf/points"][()]
            self.tets, self.tags, self.collar = self.cells(file, "mesh", "collar")
        with h5py.File(path.with_name(f"{path.stem}_faces.h5")) as file:
            self.faces, self.face_tags = self.cells(file, "faces")
        with h5py.File(path.with_name(f"{path.stem}_edges.h5")) as file:
            self.edges, self.edge_tags = self.cells(file, "edges")

    @staticmethod
    def cells(file, name, *more):
        group = file[f"xdmf/{name}"]
        return [group["topology"][()]] + [group[array][()].ravel() for array in ("tag", *more)]

    def corners(self, cells, count):
        return self.points[cells[:, :count]]

    def volumes(self):
        a, b, c, d = numpy.moveaxis(self.corners(self.tets, 4), 1, 0)
        return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6

    def dihedrals(self):
        """Returns the six dihedral angles of each tet, degrees."""
        p = self.corners(self.tets, 4)
        found = []
        for i, j in itertools.combinations(range(4), 2):
            k, m = (x for x in range(4) if x not in (i, j))
            edge = p[:, j] - p[:, i]
            u = numpy.cross(edge, p[:, k] - p[:, i])
            v = numpy.cross(edge, p[:, m] - p[:, i])
            found.append(numpy.arctan2(numpy.linalg.norm(numpy.cross(u, v), axis=1), numpy.einsum("ij,ij->i", u, v)))
        return numpy.degrees(numpy.array(found))

    def boundary(self):
        """Returns the triangles that only one tet has, by sorted corners."""
        triangles = numpy.concatenate([self.tets[:, list(c)] for c in itertools.combinations(range(4), 3)])
        found, counts = numpy.unique(numpy.sort(triangles, axis=1), axis=0, return_counts=True)
        assert counts.max() <= 2
        return found[counts == 1]

    def hash(self):
        """Returns a hash of all cells with their labels and the exact places of their nodes, independent of
        numbers."""
        digest = hashlib.sha256()
        for cells, labels in ((self.tets, [self.tags, self.collar]), (self.faces, [self.face_tags]),
                              (self.edges, [self.edge_tags])):
            places = (self.points[cells] + 0.0).view(numpy.int64).reshape(len(cells), cells.shape[1], 3)
            order = numpy.lexsort(numpy.moveaxis(places, 2, 0)[::-1],
                                  axis=1) if len(cells) else numpy.zeros((0, 1), int)
            places = numpy.take_along_axis(places, order[:, :, None], axis=1).reshape(len(cells), -1)
            rows = numpy.column_stack([places, *labels])
            digest.update(rows[numpy.lexsort(rows.T[::-1])].tobytes())
        return digest.hexdigest()


class DistributedTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="collarmesh-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def mpirun(self, ranks, *command, **options):
        return subprocess.run([*MPIRUN, "-q", "-n", str(ranks), *map(str, command)], capture_output=True, text=True,
                              cwd=self.folder, timeout=900, **options)

    def mesh(self, ranks, part, *options, output="out.h5", expected=0):
        run = self.mpirun(ranks, PROGRAM, part, "-o", output, "--report", "report.json", *options)
        self.assertEqual(run.returncode, expected, run.stderr)
        return json.loads((self.folder / "report.json").read_text())

    def assert_same_on_all_ranks(self, part, *options, levels=2):
        """Returns the mesh and its report."""
        hashes, fingerprints = set(), set()
        for ranks in RANKS:
            report = self.mesh(ranks, part, "--levels", levels, *options)
            self.assertTrue(report["guarantees_hold"])
            self.assertEqual(len(report["tets_of_ranks"]), ranks)
            self.assertEqual(sum(report["tets_of_ranks"]), report["tets"])
            self.assertGreater(min(report["tets_of_ranks"]), 0.8 * report["tets"] / ranks)
            mesh = Mesh(self.folder / "out.h5")
            self.assertEqual(len(mesh.tets), report["tets"])
            hashes.add(mesh.hash())
            fingerprints.add(report["fingerprint"])
        self.assertEqual(len(hashes), 1)
        self.assertEqual(len(fingerprints), 1)
        return mesh, report

    def assert_sound(self, mesh, report):
        """Checks that the files have what the certificate says. `coarse_angles` has the mesher's bound on the
        largest angle in collars."""
        volumes = mesh.volumes()
        self.assertGreater(volumes.min(), 0)
        for tag, volume in report["region_volumes"].items():
            self.assertAlmostEqual(volumes[mesh.tags == int(tag)].sum() / volume, 1, delta=1e-9)
        angles = mesh.dihedrals()
        for inside, least, most in ((False, "min_dihedral", "max_dihedral"),
                                    (True, "min_collar_dihedral", "max_collar_dihedral")):
            of_kind = angles[:, (mesh.collar > 0) == inside]
            if of_kind.size == 0:
                continue
            self.assertAlmostEqual(of_kind.min(), report["angles"][least], delta=1e-6)
            self.assertAlmostEqual(of_kind.max(), report["angles"][most], delta=1e-6)
            self.assertGreaterEqual(of_kind.min(), report["coarse_angles"][least] - 10)
            self.assertLessEqual(of_kind.max(), report["coarse_angles"][most] + 10)
        tagged = {tuple(face) for face in numpy.sort(mesh.faces[:, :3], axis=1)}
        self.assertTrue(tagged.issuperset(map(tuple, mesh.boundary())))


class Bracket(DistributedTest):
    def test_same_mesh(self):
        mesh, report = self.assert_same_on_all_ranks(MODELS / "bracket.off", "--size", "10")
        self.assert_sound(mesh, report)
        coarse = self.mesh(1, MODELS / "bracket.off", "--size", "10", "--levels", "0")
        self.assertEqual(report["tets"], 64 * coarse["tets"])
        self.assertEqual(set(report["patch_areas"]), set(coarse["patch_areas"]))
        # A level cuts every face into four and every edge into two.
        before = Mesh(self.folder / "out.h5")
        for fine, rough, factor in ((mesh.face_tags, before.face_tags, 16), (mesh.edge_tags, before.edge_tags, 4)):
            tags, counts = numpy.unique(rough, return_counts=True)
            found, fine_counts = numpy.unique(fine, return_counts=True)
            self.assertEqual(list(tags), list(found))
            self.assertEqual(list(factor * counts), list(fine_counts))


class Acute(DistributedTest):
    def test_collars(self):
        wedge(self.folder / "wedge.off")
        mesh, report = self.assert_same_on_all_ranks("wedge.off", "--size", "0.28", "--coarsen", "off")
        self.assert_sound(mesh, report)
        self.assertGreater(int((mesh.collar > 0).sum()), 0)
        self.assertAlmostEqual(mesh.volumes().sum(), 0.5 * math.sin(math.radians(20)), delta=1e-12)


@unittest.skipUnless(TWO_SOLIDS, "built without OpenCASCADE")
class Cad(DistributedTest):
    def setUp(self):
        super().setUp()
        subprocess.run([TWO_SOLIDS, self.folder / "two.brep"], check=True)

    def test_two_solids(self):
        mesh, report = self.assert_same_on_all_ranks("two.brep", "--size", "4")
        self.assert_sound(mesh, report)
        plate, pin = 40 * 30 * 8, math.pi * 49 * 12
        self.assertAlmostEqual(report["region_volumes"]["1"], plate, delta=1e-6 * plate)
        self.assertAlmostEqual(report["region_volumes"]["2"], pin, delta=1e-2 * pin)
        # The area is that of the exact cylinder, not of the complex's triangles.
        side = [tag for tag, area in report["patch_areas"].items() if abs(area - 2 * math.pi * 7 * 12) < 5]
        self.assertEqual(len(side), 1)
        points = mesh.points[numpy.unique(mesh.faces[mesh.face_tags == int(side[0])])]
        self.assertLess(numpy.abs(numpy.hypot(points[:, 0] - 20, points[:, 1] - 15) - 7).max(), 1e-9)

    def test_second_order(self):
        mesh, report = self.assert_same_on_all_ranks("two.brep", "--size", "5", "--order", "2", levels=1)
        self.assertEqual(mesh.tets.shape[1], 10)
        self.assertGreater(report["second_order"]["curved"], 0)
        pin = math.pi * 49 * 12
        self.assertAlmostEqual(report["region_volumes"]["2"], pin, delta=1e-4 * pin)  # a hundred times more exact


class Files(DistributedTest):
    def test_petsc_loads(self):
        if not has("petsc4py"):
            self.skipTest("petsc4py is not there")
        for order in "1", "2":
            report = self.mesh(2, MODELS / "sphere.off", "--size", "0.4", "--order", order)
            for ranks in 1, 3:
                run = self.mpirun(ranks, PYTHON, DISTRIBUTED / "bench" / "load.py", "out.h5")
                self.assertEqual(run.returncode, 0, run.stderr)
                tets = re.findall(r"rank \d: (\d+) tets, \{'region': 1, 'patch': 1,", run.stdout)
                self.assertEqual(len(tets), ranks, run.stdout)
                self.assertEqual(sum(map(int, tets)), report["tets"])

    def test_meshio_reads(self):
        if not has("meshio"):
            self.skipTest("meshio is not there")
        import meshio
        report = self.mesh(2, MODELS / "two_boxes.poly", "--levels", "1")
        mesh = meshio.read(self.folder / "out.xdmf")
        self.assertEqual(len(mesh.cells_dict["tetra"]), report["tets"])
        self.assertEqual({str(tag) for tag in numpy.unique(mesh.cell_data["tag"][0])}, set(report["region_volumes"]))
        faces = meshio.read(self.folder / "out_faces.xdmf")
        self.assertEqual({str(tag) for tag in numpy.unique(faces.cell_data["tag"][0])}, set(report["patch_areas"]))

    def test_vtk_reads_pieces(self):
        if not has("vtk"):
            self.skipTest("vtk is not there")
        import vtk
        report = self.mesh(3, MODELS / "two_boxes.poly", "--levels", "1", output="out.pvtu")
        reader = vtk.vtkXMLPUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "out.pvtu"))
        reader.Update()
        grid = reader.GetOutput()
        self.assertEqual(reader.GetNumberOfPieces(), 3)
        self.assertEqual(grid.GetNumberOfCells(), report["tets"])
        tags = grid.GetCellData().GetArray("tag")
        found = {str(int(tags.GetValue(i))) for i in range(tags.GetNumberOfTuples())}
        self.assertEqual(found, set(report["region_volumes"]))


class Failures(DistributedTest):
    def assert_fails(self, run, code, *words, by_each_rank=False):
        """Checks that a run fails with one message, which ranks that fail at once may repeat, and leaves no
        new files."""
        self.assertEqual(run.returncode, code, run.stderr)
        said = [line for line in run.stderr.splitlines() if line.startswith("collarmesh")]
        if by_each_rank:
            said = list(set(said))
        self.assertEqual(len(said), 1, run.stderr)
        for word in words:
            self.assertIn(word, said[0])
        self.assertEqual([p.name for p in self.folder.iterdir()
                         if "out" in p.name or p.name.startswith(".collarmesh")], [])

    def test_memory(self):
        self.assert_fails(self.mpirun(2, PROGRAM, MODELS / "bracket.off", "-o", "out.h5", "--size", "4", "--levels",
                                      "2", "--max-memory", "80M"), 5, "memory", by_each_rank=True)

    def test_options(self):
        self.assert_fails(self.mpirun(3, PROGRAM, MODELS / "box.off", "-o",
                          "out.h5", "--levels", "many"), 2, "--levels")
        self.assert_fails(self.mpirun(3, PROGRAM, MODELS / "box.off", "-o", "out.off"), 2, "use .h5 or .pvtu")
        self.assert_fails(self.mpirun(3, PROGRAM, "-o", "out.h5"), 2, "INPUT")
        self.assert_fails(self.mpirun(3, PROGRAM, "missing.off", "-o", "out.h5"), 3, "missing.off")
        self.assert_fails(self.mpirun(2, PROGRAM, MODELS / "box.off", "-o", "nowhere/out.h5"), 8, "nowhere")

    def test_time_limit(self):
        self.assert_fails(self.mpirun(2, PROGRAM, MODELS / "bracket.off", "-o",
                          "out.h5", "--size", "1", "--time-limit", "1"), 5, "time limit")

    def test_flat_tets(self):
        """Levels cut a box that is as thick as two steps of its coordinates until they cannot tell nodes apart."""
        far, step = 2.0**30, 2.0**-22
        corners = [[far + step * size * (i >> axis & 1) for axis, size in enumerate((8192, 8192, 2))] for i in range(8)]
        facets = (0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)
        (self.folder / "thin.off").write_text("OFF\n8 6 0\n" + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in corners)
                                              + "".join(f"4 {a} {b} {c} {d}\n" for a, b, c, d in facets))
        command = [PROGRAM, "thin.off", "-o", "out.h5", "--size", "1", "--levels", "2", "-q"]
        self.assert_fails(self.mpirun(2, *command), 7, "is flat", "Nothing was written")
        self.assertEqual(self.mpirun(2, *command, "--keep-invalid").returncode, 7)
        self.assertLessEqual(Mesh(self.folder / "out.h5").volumes().min(), 0)

    def test_other_options_on_a_rank(self):
        run = self.mpirun(1, PROGRAM, MODELS / "box.off", "-o", "out.h5", ":", "-n", "1", PROGRAM, MODELS / "box.off",
                          "-o", "out.h5", "--levels", "2")
        self.assert_fails(run, 2, "rank 1", "other options")

    def test_other_input_on_a_rank(self):
        for name in "one", "other":
            (self.folder / name).mkdir()
            shutil.copy(MODELS / ("box.off" if name == "one" else "sphere.off"), self.folder / name / "part.off")
        run = self.mpirun(1, "-wdir", self.folder / "one", PROGRAM, "part.off", "-o", self.folder / "out.h5", ":", "-n",
                          "1", "-wdir", self.folder / "other", PROGRAM, "part.off", "-o", self.folder / "out.h5")
        self.assert_fails(run, 3, "part.off", "rank 1")

    def test_full_disk(self):
        """Files may have 1 MB, but the mesh takes more."""
        for output in "out.h5", "out.pvtu":
            run = self.mpirun(
                2, "bash", "-c",
                f"ulimit -f 1000; exec {PROGRAM} {MODELS / 'bracket.off'} -o {output} --size 6 --levels 2 -q")
            self.assert_fails(run, 8, "out")

    def run_until_meshed(self, *options):
        process = subprocess.Popen([*MPIRUN, "-n", "2", PROGRAM, MODELS / "bracket.off", "-o", "out.h5", "--size", "6",
                                    "--levels", "4", *options], cwd=self.folder, stderr=subprocess.PIPE, text=True,
                                   start_new_session=True)
        self.addCleanup(process.stderr.close)
        for line in process.stderr:
            if line.startswith("level 1"):
                return process
        self.fail("it ended early")

    def test_a_rank_dies(self):
        process = self.run_until_meshed()
        children = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True).stdout.split()
        self.assertEqual(len(children), 2)
        os.kill(int(children[1]), signal.SIGKILL)
        self.assertNotEqual(process.wait(timeout=120), 0)
        self.assertFalse((self.folder / "out.h5").exists())
        self.assertEqual(list(self.folder.glob("*.xdmf")), [])

    def test_interrupt(self):
        process = self.run_until_meshed()
        process.send_signal(signal.SIGINT)
        self.assertNotEqual(process.wait(timeout=120), 0)
        self.assertEqual([p.name for p in self.folder.iterdir()], [])


class Solutions(DistributedTest):
    def errors(self, run, pattern):
        self.assertEqual(run.returncode, 0, run.stderr)
        return [tuple(map(float, found)) for found in re.findall(pattern, run.stdout)]

    def test_in_memory(self):
        results = []
        for ranks in RANKS:
            run = self.mpirun(ranks, POISSON, MODELS / "box.off", "1", "3")
            self.assertNotIn("NOT certified", run.stdout)
            results.append(self.errors(run, r"error (\S+), norm (\S+)"))
        errors = [error for error, _ in results[0]]
        self.assertEqual(len(errors), 4)
        self.assertAlmostEqual(math.log2(errors[-2] / errors[-1]), 2, delta=0.1)
        for other in results[1:]:
            numpy.testing.assert_allclose(other, results[0], rtol=1e-6)

    def test_dolfinx(self):
        if not has("dolfinx"):
            self.skipTest("dolfinx is not there")
        for order, expected in ("1", 2), ("2", 3):
            for level in range(3):
                self.mesh(2, MODELS / "box.off", "--size", "1", "--levels",
                          level, "--order", order, output=f"part_{level}.h5")
            results = []
            for ranks in RANKS:
                run = self.mpirun(ranks, PYTHON, DISTRIBUTED / "examples" / "poisson.py", "part_0", "part_1", "part_2")
                results.append(self.errors(run, r"error (\S+), norm (\S+)"))
            errors = [error for error, _ in results[0]]
            self.assertAlmostEqual(math.log2(errors[1] / errors[2]), expected, delta=0.15)
            for other in results[1:]:
                numpy.testing.assert_allclose(other, results[0], rtol=1e-6)


if __name__ == "__main__":
    unittest.main()
