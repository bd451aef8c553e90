"""The Python module: arrays in and out, guarantees, errors. Run by CTest with the module on PYTHONPATH."""

import copy
import gc
import inspect
import json
import os
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import collarmesh
import numpy

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from step_file import StepFile  # noqa: E402

# With sanitizers each step takes some 30 times as long; what makes many elements makes fewer there.
SANITIZED = "COLLARMESH_SANITIZED" in os.environ
LONG_RUN = 0.07 if SANITIZED else 0.015


def box(low, high):
    """Points and outward triangles, two for each face, tagged 1 to 6 as -x +x -y +y -z +z."""
    corners = numpy.array([[(low, high)[(i >> axis) & 1][axis] for axis in range(3)] for i in range(8)], dtype=float)
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    triangles = [corner for a, b, c, d in quads for corner in ((a, b, c), (a, c, d))]
    return corners, numpy.array(triangles), numpy.repeat(numpy.arange(1, 7), 2)


def volumes(mesh):
    a, b, c, d = (mesh.points[mesh.tets[:, i]] for i in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6


class Module(unittest.TestCase):
    def test_a_box_is_filled(self):
        mesh = collarmesh.mesh(box((0, 0, 0), (1, 2, 3)), size=0.3)
        self.assertTrue(mesh.passed, mesh.findings)
        self.assertEqual(mesh.tets.shape, (len(mesh.tet_region), 4))
        self.assertTrue((volumes(mesh) > 0).all())
        self.assertAlmostEqual(volumes(mesh).sum(), 6, places=12)
        self.assertEqual(mesh.points.dtype, numpy.float64)
        a, b, c = (mesh.points[mesh.faces[:, i]] for i in range(3))
        areas = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) / 2
        for tag, area in zip(range(1, 7), (6, 6, 3, 3, 2, 2)):
            self.assertAlmostEqual(areas[mesh.face_tag == tag].sum(), area, places=12)

    def test_two_surfaces_share_their_interface(self):
        mesh = collarmesh.mesh(box((0, 0, 0), (1, 1, 1))[:2], box((1, 0, 0), (2, 1, 1))[:2], size=0.4)
        self.assertTrue(mesh.passed, mesh.findings)
        for region in (1, 2):
            self.assertAlmostEqual(volumes(mesh)[mesh.tet_region == region].sum(), 1, places=12)
        self.assertGreater((mesh.face_regions.min(axis=1) > 0).sum(), 0)

    def test_sizes_by_tag_refine(self):
        surface = box((0, 0, 0), (1, 1, 1))
        coarse, fine = (collarmesh.mesh(surface, size=0.5, patch_size=sizes) for sizes in ({}, {3: 0.1}))
        self.assertGreater((fine.face_tag == 3).sum(), 4 * (coarse.face_tag == 3).sum())

    def test_second_order(self):
        mesh = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.5, order=2)
        self.assertEqual(mesh.order, 2)
        a, b = (mesh.points[mesh.tets[:, i]] for i in (0, 1))
        numpy.testing.assert_allclose(mesh.points[mesh.tet_mid_nodes[:, 0]], (a + b) / 2, atol=1e-12)
        self.assertEqual(collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.5).tet_mid_nodes.shape, (0, 6))

    def test_triangles_alone(self):
        mesh = collarmesh.mesh((numpy.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float),
                                numpy.array([(0, 1, 2), (0, 2, 3)])), size=0.2, dimension=2)
        self.assertEqual(len(mesh.tets), 0)
        a, b, c = (mesh.points[mesh.faces[:, i]] for i in range(3))
        self.assertAlmostEqual(numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2, 1, 9)
        self.assertGreater(len(mesh.faces), 40)

    def test_some_faces_and_lines(self):
        surface = box((0, 0, 0), (1, 1, 1))
        mesh = collarmesh.mesh(surface, size=0.25, dimension=2, faces=["2", "patch_3"])
        self.assertEqual(set(mesh.face_tag), {2, 3})
        with self.assertRaisesRegex(collarmesh.Error, "no patch is called 'lid'"):
            collarmesh.mesh(surface, size=0.25, dimension=2, faces=["lid"])
        lines = collarmesh.mesh(surface, size=0.25, dimension=1)
        self.assertEqual((len(lines.tets), len(lines.faces), len(lines.edges)), (0, 0, 48))
        ends = lines.points[lines.edges]
        self.assertAlmostEqual(numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum(), 12, 9)
        self.assertEqual([collarmesh.mesh(surface, size=0.5, dimension=d, order=2).order for d in (1, 2)], [2, 2])

    def test_same_input_same_mesh(self):
        first, second = (collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.2) for _ in range(2))
        numpy.testing.assert_array_equal(first.tets, second.tets)
        numpy.testing.assert_array_equal(first.points, second.points)

    def test_arrays_outlive_the_mesh_and_are_read_only(self):
        points = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.3).points
        gc.collect()
        self.assertEqual(points.max(), 1)
        with self.assertRaises(ValueError):
            points[0] = 0

    def test_progress_and_cancelling(self):
        seen = []
        collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.08, progress=lambda phase, part: seen.append(part) or True)
        self.assertEqual(seen, sorted(seen))
        self.assertGreater(len(seen), 1)
        with self.assertRaisesRegex(collarmesh.Error, "stopped at"):
            collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.08, progress=lambda phase, part: False)

    def test_mistakes_are_told(self):
        points, triangles, tags = box((0, 0, 0), (1, 1, 1))
        for surface, words in (
            ((points, triangles[:2]), r"open|border"),
            ((points, triangles + 1), "corner 8"),
            ((points[:, :2], triangles), r"\(n, 3\)"),
            ((points, triangles, tags[1:]), "tags"),
            ((points * numpy.nan, triangles), "finite"),
        ):
            with self.assertRaisesRegex(collarmesh.Error, words):
                collarmesh.mesh(surface)
        with self.assertRaises(collarmesh.Error):
            collarmesh.mesh()
        with self.assertRaises(collarmesh.Error):
            collarmesh.mesh((points, triangles), order=3)

    def test_invalid_surfaces_are_repaired_and_told(self):
        points, triangles, tags = box((0, 0, 0), (1, 1, 1))
        self.assertEqual(collarmesh.mesh((points, triangles), size=0.5).repairs, [])
        mesh = collarmesh.mesh((points, triangles[:-1], tags[:-1]), size=0.5)
        self.assertTrue(mesh.passed, mesh.findings)
        self.assertAlmostEqual(volumes(mesh).sum(), 1, places=12)
        self.assertEqual(len(mesh.repairs), 2)
        self.assertRegex(mesh.repairs[0], "hole of 3 edges")
        self.assertEqual(mesh.repairs[1], "repair moved nothing")
        with self.assertRaisesRegex(collarmesh.Error, "open"):
            collarmesh.mesh((points, triangles[:-1]), repair="none")
        with self.assertRaisesRegex(collarmesh.Error, "repair must be"):
            collarmesh.mesh((points, triangles), repair="maybe")
        wrapped = collarmesh.mesh((points, triangles[:2]), size=0.5, repair="wrap", wrap_offset=0.05)
        self.assertGreater(volumes(wrapped).sum(), 0)
        self.assertRegex(wrapped.repairs[-1], "wrapped around everything")

    def test_files(self):
        mesh = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.5)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "box.vtu")
            mesh.write(path)
            import meshio

            self.assertEqual(len(meshio.read(path).points), len(mesh.points))
        with self.assertRaises(collarmesh.Error):
            mesh.write("/no/such/folder/box.vtu")


MODELS = pathlib.Path(os.environ["COLLARMESH_MODELS"])


class Inputs(unittest.TestCase):
    def test_files_by_path(self):
        for path in (MODELS / "box.off", str(MODELS / "box.off")):
            mesh = collarmesh.mesh(path, size=0.5)
            self.assertTrue(mesh.passed, mesh.findings)
        self.assertEqual(set(mesh.face_tag), set(range(1, 7)))  # numbers, if the file has no tags

    def test_a_cad_shape(self):
        real = os.environ.get("COLLARMESH_REAL")
        if not real:
            self.skipTest("no CAD files beside the sources")
        path = min(pathlib.Path(real).rglob("*.st*p"), key=lambda p: p.stat().st_size)
        try:
            mesh = collarmesh.mesh(path)
        except collarmesh.ReadError as error:
            self.skipTest(str(error))
        self.assertTrue(mesh.passed, mesh.findings)
        self.assertEqual(mesh.name(2, 1), "Face1")

    def test_names_and_colours_of_step(self):
        file = StepFile()
        file.product("Base", file.box((0, 0, 0), (2, 2, 1), colour=(1, 0, 0), face_colours={0: (0, 0, 1)}))
        with tempfile.TemporaryDirectory() as folder:
            try:
                mesh = collarmesh.mesh(file.write(pathlib.Path(folder) / "a.step"), size=1)
            except collarmesh.ReadError as error:
                self.skipTest(str(error))
        self.assertEqual(mesh.name(3, 1), "Base")
        self.assertEqual(mesh.colours, {2: {1: "#0000ff", **{n: "#ff0000" for n in range(2, 7)}}, 3: {1: "#ff0000"}})
        self.assertEqual(pickle.loads(pickle.dumps(mesh)).colours, mesh.colours)
        self.assertEqual(mesh.info()["mesh"]["region_names"], {"1": "Base"})
        self.assertIn("Base</th>", mesh._repr_html_())
        try:
            import matplotlib
        except ImportError:
            self.skipTest("matplotlib is not installed")
        matplotlib.use("agg")
        drawn = numpy.array(mesh.plot().collections[0].get_facecolor())
        for colour, tags in (((0, 0, 1, 1), [1]), ((1, 0, 0, 1), [2, 3, 4, 5, 6])):
            self.assertEqual((drawn == numpy.array(colour)).all(axis=1).sum(), numpy.isin(mesh.face_tag, tags).sum())

    def test_a_complex_with_a_hole_a_region_and_an_open_facet(self):
        outer, _, _ = box((0, 0, 0), (3, 3, 3))
        inner, _, _ = box((1, 1, 1), (2, 2, 2))
        quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
        facets = [*quads, *[[i + 8 for i in quad] for quad in quads]]
        tags = [*range(1, 7), *[7] * 6]
        complex_ = collarmesh.Complex(numpy.vstack([outer, inner]), facets, facet_tags=tags, holes=[(1.5, 1.5, 1.5)],
                                      regions=[((0.5, 0.5, 0.5), 42, 0.8)], names={7: "cavity"})
        mesh = collarmesh.mesh(complex_)
        self.assertTrue(mesh.passed, mesh.findings)
        self.assertAlmostEqual(volumes(mesh).sum(), 26, places=10)
        self.assertEqual(set(mesh.tet_tag), {42})
        self.assertEqual(mesh.names, {2: {7: "cavity"}})
        a, b, c = (mesh.points[mesh.faces[mesh.face_tag == 7, i]] for i in range(3))
        self.assertAlmostEqual(numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2, 6, places=10)

    def test_a_facet_with_a_hole(self):
        points = [(x, y, z) for z in (0, 1)
                  for x, y in ((0, 0), (3, 0), (3, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2))]
        ring = lambda first: [[first + i for i in range(4)], [first + 4 + i for i in range(4)]]
        facets = [ring(0), ring(8)]
        facets += [[i, (i + 1) % 4, 8 + (i + 1) % 4, 8 + i] for i in range(4)]
        facets += [[4 + i, 4 + (i + 1) % 4, 12 + (i + 1) % 4, 12 + i] for i in range(4)]
        mesh = collarmesh.mesh(collarmesh.Complex(points, facets, facet_holes={0: [(1.5, 1.5, 0)], 1: [(1.5, 1.5, 1)]},
                                                  holes=[(1.5, 1.5, 0.5)]), size=0.5)
        self.assertTrue(mesh.passed, mesh.findings)
        self.assertAlmostEqual(volumes(mesh).sum(), 8, places=10)

    def test_kinds_and_shapes_of_arrays(self):
        points, triangles, tags = box((0, 0, 0), (1, 1, 1))
        for surface, words in (
            ((points, triangles + 0.5), "integers"),
            ((points, triangles.astype(float)), "integers"),
            ((points, triangles, tags.astype(float)), "integers"),
            ((points, triangles.ravel()), r"\(n, 3\)"),
            ((points.astype(str), triangles), "numbers"),
            ((points,), "tuple"),
            (7, "path"),
        ):
            with self.assertRaisesRegex(collarmesh.OptionError, words):
                collarmesh.mesh(surface)
        mesh = collarmesh.mesh((points.tolist(), triangles.astype(numpy.uint32)), size=0.5)
        self.assertTrue(mesh.passed)


class Signatures(unittest.TestCase):
    def test_docstrings_tell_every_parameter(self):
        """Every parameter is described in its own function, or in `mesh` if the description refers to it."""
        for function in (collarmesh.mesh, collarmesh.check, collarmesh.info, collarmesh.convert, collarmesh.repair,
                         collarmesh.read, collarmesh.Complex, collarmesh.Mesh.write, collarmesh.Mesh.partitioned,
                         collarmesh.Mesh.interpolate, collarmesh.Mesh.to_dolfinx, collarmesh.predict,
                         collarmesh.sampled_sizes):
            text = inspect.getdoc(function)
            if "collarmesh.mesh" in text:
                text += inspect.getdoc(collarmesh.mesh)
            for name in inspect.signature(function).parameters:
                if name not in ("self", "options"):
                    self.assertRegex(text, rf"\b{name}\b", function.__name__)

    def test_options_are_those_of_the_command_line(self):
        """The options are the command line's, except those about output and messages."""
        program = pathlib.Path(collarmesh.__file__).parents[2] / "bin/collarmesh"
        if not program.exists():
            self.skipTest("the program was not built")
        said = subprocess.run([program, "--help"], check=True, capture_output=True, text=True).stdout
        others = {"help", "version", "against", "output", "format", "scale", "report", "verbose", "quiet",
                  "ghost_cells", "cell_decomposition", "help_all", "name", "batch", "interaction", "cohesive", "trace",
                  "triangle_elements", "keep_invalid"}
        options = {name.replace("-", "_") for name in re.findall(r"--([a-z][a-z-]+)", said)} - others
        self.assertGreater(len(options), 30)
        self.assertLessEqual(options - set(inspect.signature(collarmesh.mesh).parameters), set())


class Options(unittest.TestCase):
    def setUp(self):
        self.box = box((0, 0, 0), (1, 1, 1))

    def count(self, **options):
        mesh = collarmesh.mesh(self.box, **options)
        self.assertTrue(mesh.passed, mesh.findings)
        return len(mesh.tets)

    def test_size_fields(self):
        coarse = self.count(size=0.5)
        fine_below = lambda x, y, z: 0.1 if z < 0.2 else 0.5
        points = numpy.array([(-1, -1, -1), (5, -1, -1), (-1, 5, -1), (-1, -1, 5)], dtype=float)
        for field in (fine_below, (points, [(0, 1, 2, 3)], numpy.full(4, 0.15)),
                      {"sources": [{"ball": {"centre": [0, 0, 0], "radius": 0.2}, "size": 0.1}]}):
            self.assertGreater(self.count(size=0.5, size_field=field), 2 * coarse)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "field.json"
            path.write_text(json.dumps({"sources": [{"patches": [5], "size": 0.1}]}))
            self.assertGreater(self.count(size=0.5, size_field=path), 2 * coarse)

    def test_what_a_size_field_raises_comes_out(self):
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            collarmesh.mesh(self.box, size_field=lambda x, y, z: 1 / 0)

    def test_curve_sizes_and_unknown_tags(self):
        tags = [patch["tag"] for patch in collarmesh.info(self.box)["complex"]["patch_list"]]
        self.assertEqual(tags, [1, 2, 3, 4, 5, 6])
        self.assertGreater(self.count(size=0.5, curve_size={1: 0.05}), 2 * self.count(size=0.5))
        for option in ("region_size", "patch_size", "curve_size"):
            with self.assertRaisesRegex(collarmesh.OptionError, "99"):
                collarmesh.mesh(self.box, **{option: {99: 0.1}})
            with self.assertRaisesRegex(collarmesh.OptionError, "integers"):
                collarmesh.mesh(self.box, **{option: {1.5: 0.1}})

    def test_out_of_range(self):
        for option in ({"weld": 0.5}, {"feature_angle": 190}, {"crease_angle": 91}, {"collar_angle": 90},
                       {"improve": 4}, {"thin_angle": 40}, {"theta": 0.5}, {"radius_edge": 0.5}, {"vertex_ratio": 2},
                       {"order": 3}, {"overlap": "both"}, {"collar_creation": "later"}, {"seed": -1}, {"size": "small"},
                       {"max_memory": "much"}, {"planar_tolerance": 0.1}, {"size": -1}):
            with self.assertRaises(collarmesh.OptionError, msg=option):
                collarmesh.mesh(self.box, **option)

    def test_names(self):
        points, triangles, _ = self.box
        names = {"patches": {"inlet": {"at": [0, 0.5, 0.5]}, "lid": 6}, "regions": {"air": 1}}
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "names.json"
            path.write_text(json.dumps(names))
            for given in (names, path):
                mesh = collarmesh.mesh((points, triangles), size=0.5, names=given)
                self.assertEqual(set(mesh.names[2].values()), {"inlet", "lid"})
                self.assertEqual(mesh.name(3, 1), "air")
                (inlet,) = [tag for tag, name in mesh.names[2].items() if name == "inlet"]
                self.assertEqual(mesh.points[mesh.faces[mesh.face_tag == inlet]][:, :, 0].max(), 0)
                self.assertIn("inlet", mesh.to_meshio().cell_sets)
            mesh.write(pathlib.Path(folder) / "box.inp")
            self.assertIn("NAME=INLET,", (pathlib.Path(folder) / "box.inp").read_text())
        with self.assertRaisesRegex(collarmesh.OptionError, "no patch has the number 99"):
            collarmesh.mesh((points, triangles), names={"patches": {"a": 99}})

    def test_threads_change_nothing(self):
        one, two = (collarmesh.mesh(self.box, size=0.2, threads=n) for n in (1, 2))
        numpy.testing.assert_array_equal(one.tets, two.tets)

    def test_budgets(self):
        with self.assertRaisesRegex(collarmesh.BudgetError, "200 vertices"):
            collarmesh.mesh(self.box, size=0.05, max_vertices=200)
        with self.assertRaisesRegex(collarmesh.BudgetError, "memory"):
            collarmesh.mesh(self.box, size=0.02, max_memory="1M")

    def test_weld_and_coarsen(self):
        points, triangles, tags = self.box
        torn = points[triangles].reshape(-1, 3) + numpy.repeat([[0, 0, 0], [1e-7, 0, 0]], 18, axis=0)
        loose = numpy.arange(36).reshape(-1, 3)
        mesh = collarmesh.mesh((torn, loose, tags), size=0.5, weld=1e-5, repair="none")
        self.assertAlmostEqual(volumes(mesh).sum(), 1, places=5)
        plate = box((0, 0, 0), (4, 4, 0.1))
        self.assertLess(3 * len(collarmesh.mesh(plate, size=1).tets),
                        len(collarmesh.mesh(plate, size=1, coarsen=False).tets))


class Meshes(unittest.TestCase):
    def setUp(self):
        self.mesh = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.4)

    def test_indices_are_signed(self):
        for name in ("tets", "faces", "edges", "face_regions", "tet_region", "tet_mid_nodes"):
            self.assertEqual(getattr(self.mesh, name).dtype, numpy.int64, name)

    def test_pickles_of_versions_without_partitions(self):
        state = self.mesh.__getstate__()
        del state["tet_partition"]
        old = collarmesh.Mesh.__new__(collarmesh.Mesh)
        old.__setstate__(state)
        self.assertEqual(len(old.tet_partition), 0)
        self.assertEqual(old.info(), self.mesh.info())

    def test_pickle_and_copy(self):
        for other in (pickle.loads(pickle.dumps(self.mesh)), copy.deepcopy(self.mesh)):
            numpy.testing.assert_array_equal(other.tets, self.mesh.tets)
            self.assertEqual(other.report, self.mesh.report)
            self.assertTrue(other.passed)
            with self.assertRaises(ValueError):
                other.points[0] = 0

    def test_write_read_check(self):
        points, triangles, tags = box((0, 0, 0), (1, 1, 1))
        with tempfile.TemporaryDirectory() as folder:
            for extension in (".vtu", ".msh", ".mesh", ".inp", ".unv", ".vtk"):
                path = pathlib.Path(folder) / f"box{extension}"
                self.mesh.write(path)
                other = collarmesh.read(path)
                self.assertEqual(len(other.tets), len(self.mesh.tets))
                for subject in (other, path):
                    report = collarmesh.check(subject, (points, triangles, tags))
                    self.assertTrue(report["passed"], (extension, report["findings"]))
                self.assertEqual(collarmesh.info(path)["mesh"]["tets"], len(self.mesh.tets))
            self.mesh.write(pathlib.Path(folder) / "small.msh", scale=0.001)
            numpy.testing.assert_array_equal(
                sorted(map(tuple, collarmesh.read(pathlib.Path(folder) / "small.msh").points)),
                sorted(map(tuple, 0.001 * self.mesh.points)))
        report = collarmesh.check(self.mesh, box((0, 0, 0), (1, 1, 1.1)))
        self.assertFalse(report["passed"])
        self.assertTrue(report["findings"])

    def test_partitions(self):
        if not list(pathlib.Path(collarmesh.__file__).parents[2].glob("lib*/collarmesh/collarmesh_scotch.so")):
            with self.assertRaisesRegex(collarmesh.OptionError, "libscotch-dev"):
                self.mesh.partitioned(2)
            self.skipTest("built without Scotch")
        self.assertEqual(len(self.mesh.tet_partition), 0)
        self.assertIsNone(self.mesh.info()["mesh"]["partitions"])
        divided = self.mesh.partitioned(4)
        sizes = numpy.bincount(divided.tet_partition)
        self.assertEqual(len(sizes), 4)
        self.assertLessEqual(sizes.max(), max(1.03 * sizes.mean(), numpy.ceil(sizes.mean())))
        found = divided.info()["mesh"]["partitions"]
        self.assertEqual((found["count"], found["smallest"], found["largest"]), (4, sizes.min(), sizes.max()))
        numpy.testing.assert_array_equal(divided.tets, self.mesh.tets)
        self.assertEqual(divided.report, self.mesh.report)
        made = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.4, partitions=4)
        numpy.testing.assert_array_equal(made.tet_partition, divided.tet_partition)
        self.assertEqual(pickle.loads(pickle.dumps(divided)).info(), divided.info())
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for extension in (".vtu", ".msh", ".pvtu"):
                for ghosts in (False,) if extension == ".vtu" else (False, True):
                    divided.write(folder / f"box{extension}", ghost_cells=ghosts)
                    other = collarmesh.read(folder / f"box{extension}")
                    self.assertEqual(other.info()["mesh"]["partitions"], found)
            collarmesh.convert(folder / "box.vtu", folder / "three.msh", partitions=3, ghost_cells=True)
            self.assertEqual(collarmesh.info(folder / "three.msh")["mesh"]["partitions"]["count"], 3)
            with self.assertRaisesRegex(collarmesh.WriteError, "no place for ghost cells"):
                divided.write(folder / "ghosts.vtu", ghost_cells=True)
            with self.assertRaisesRegex(collarmesh.OptionError, "not partitioned"):
                self.mesh.write(folder / "ghosts.msh", ghost_cells=True)
            self.check_mistakes_of_converting(folder)
        for partitions in (0, -1, 1.5, True, "4", len(self.mesh.tets) + 1, 2**40):
            with self.assertRaises(collarmesh.OptionError, msg=partitions):
                self.mesh.partitioned(partitions)
        for partitions in (0, -1, 1.5, "4", 10**6):
            with self.assertRaises(collarmesh.OptionError, msg=partitions):
                collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.6, partitions=partitions)

    def check_mistakes_of_converting(self, folder):
        """Mistakes are reported before anything is meshed or read."""
        surface = box((0, 0, 0), (1, 1, 1))
        for source in (surface, folder / "missing.vtu"):
            for output, options, message in (
                    ("a.off", {"partitions": 2}, r"partitions: \.off has no place for partitions; use \.vtu"),
                    ("a.inp", {"partitions": 2}, r"partitions: \.inp has no place for partitions; use \.vtu"),
                    ("a.off", {"ghost_cells": True}, r"\.off has no place for ghost cells; use \.pvtu \.msh"),
                    ("a.VTU", {"partitions": 2, "ghost_cells": True}, r"\.vtu has no place for ghost cells"),
                    ("a.msh", {"partitions": 2, "format": ".inp"}, r"\.inp has no place for partitions")):
                with self.assertRaisesRegex(collarmesh.OptionError, message):
                    collarmesh.convert(source, folder / output, **options)
                self.assertFalse((folder / output).exists())
        stages = []
        with self.assertRaisesRegex(collarmesh.OptionError, "ghost_cells: .*say how many"):
            collarmesh.convert(surface, folder / "a.msh", ghost_cells=True, progress=lambda *at: stages.append(at))
        self.assertEqual(stages, [])

    def test_convert_and_repair(self):
        points, triangles, tags = box((0, 0, 0), (1, 1, 1))
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            collarmesh.convert((points, triangles, tags), folder / "box.stl")
            collarmesh.convert(folder / "box.stl", folder / "box.obj")
            collarmesh.convert(folder / "box.obj", folder / "box.vtu", size=0.5)
            collarmesh.convert(folder / "box.vtu", folder / "skin.off")
            self.assertTrue(collarmesh.check(folder / "box.vtu", folder / "skin.off")["passed"])
            surfaces, messages = collarmesh.repair((points, triangles[:-1], tags[:-1]), output=folder / "whole.off")
            self.assertRegex(messages[0], "hole of 3 edges")
            self.assertEqual(len(surfaces[0][1]), 12)
            self.assertEqual(collarmesh.info(folder / "whole.off")["repair"]["repaired"], False)
        whole, nothing = collarmesh.repair((points, triangles, tags))
        self.assertEqual(nothing, [])
        numpy.testing.assert_array_equal(whole[0][2], tags)

    def test_to_meshio(self):
        try:
            import meshio
        except ImportError:
            self.skipTest("meshio is not installed")
        for order in (1, 2):
            mesh = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.5, order=order)
            other = mesh.to_meshio()
            with tempfile.TemporaryDirectory() as folder:
                # meshio cannot store mixed cells of second order in .xdmf.
                for name in ("box.vtu", "box.xdmf")[: 3 - order]:
                    path = os.path.join(folder, name)
                    meshio.Mesh(other.points, other.cells, cell_data=other.cell_data).write(path)
                    back = meshio.read(path)
                    self.assertEqual(sum(len(block.data) for block in back.cells),
                                     len(mesh.tets) + len(mesh.faces) + len(mesh.edges))
            self.assertEqual(len(other.cell_sets["patch_3"][1]), (mesh.face_tag == 3).sum())

    def test_plot(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("matplotlib is not installed")
        matplotlib.use("agg")
        axes = self.mesh.plot()
        self.assertEqual(len(axes.collections), 1)
        numbers = {str(tag) for tag in self.mesh.face_tag}
        self.assertEqual({text.get_text() for text in axes.texts}, numbers)
        named = collarmesh.mesh(MODELS / "box.off", size=0.5, names={"patches": {"loaded": 2}}).plot(curves=True)
        self.assertEqual(sorted(text.get_text() for text in named.texts if text.get_color() == "k"),
                         ["1", "3", "4", "5", "6", "loaded"])
        self.assertEqual(len([text for text in named.texts if text.get_color() == "b"]), 12)
        self.assertEqual(list(self.mesh.plot(labels=False).texts), [])
        with tempfile.TemporaryDirectory() as folder:
            axes.figure.savefig(os.path.join(folder, "box.png"))

    def test_to_pyvista(self):
        try:
            import pyvista
        except ImportError:
            with self.assertRaises(ImportError):
                self.mesh.to_pyvista()
            return
        self.assertEqual(self.mesh.to_pyvista().n_cells, len(self.mesh.tets))


class Stopping(unittest.TestCase):
    def test_a_callback_that_returns_nothing_goes_on_and_hears_of_all_stages(self):
        seen = []
        mesh = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.1 if SANITIZED else 0.04, coarsen=True,
                               progress=lambda phase, part: seen.append((phase, part)))
        self.assertTrue(mesh.passed)
        parts = [part for _, part in seen]
        self.assertEqual(parts, sorted(parts))
        self.assertLessEqual({"refine", "coarsen", "improve", "check"}, {phase for phase, _ in seen})

    def test_what_a_callback_raises_comes_out(self):
        def fail(phase, part):
            raise KeyError(phase)

        with self.assertRaises(KeyError):
            collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.02, progress=fail)

    def run_script(self, script, wait=lambda: None):
        """Sends Ctrl-C when the script has begun and `wait` returned; it must print that it was stopped."""
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        self.assertEqual(process.stdout.readline().strip(), "begin")
        wait()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertIn("stopped", out, err)

    def test_interrupt_in_every_stage(self):
        for stage in ("refine", "coarsen", "improve", "check"):
            with self.subTest(stage=stage):
                self.run_script(f"""
import os, signal, sys
sys.path[:0] = {sys.path!r}
import collarmesh
sys.path.insert(0, {os.path.dirname(__file__)!r})
from module_test import box
def told(phase, part):
    if phase == {stage!r} and not heard:
        heard.append(part)
        print("begin", flush=True)
heard = []
try:
    collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size={LONG_RUN}, coarsen={stage == 'coarsen'}, progress=told)
    print("ended", flush=True)
except KeyboardInterrupt:
    print("stopped", flush=True)
""")

    def wait_for_reader(self, pipe):
        """Waits until a process reads from a pipe. Returns the pipe, open for writing, so that it waits for data."""
        end = time.monotonic() + 60
        while True:
            try:
                return os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
            except OSError:  # nobody has opened it
                self.assertLess(time.monotonic(), end)
                time.sleep(0.002)

    def test_interrupt_while_reading(self):
        with tempfile.TemporaryDirectory() as folder:
            endless = os.path.join(folder, "endless.off")
            os.mkfifo(endless)
            pipes = []
            self.run_script(f"""
import sys
sys.path[:0] = {sys.path!r}
import collarmesh
print("begin", flush=True)
try:
    collarmesh.mesh({endless!r})
except KeyboardInterrupt:
    print("stopped", flush=True)
import os
os._exit(0)
""", lambda: pipes.append(self.wait_for_reader(endless)))
            os.close(pipes.pop())
            with self.assertRaisesRegex(collarmesh.BudgetError, "0.2 s .*read"):
                collarmesh.mesh(endless, time_limit=0.2)
            with open(endless, "w"):
                pass  # so that the abandoned reader ends

    def test_time_limit(self):
        with self.assertRaisesRegex(collarmesh.BudgetError, "time limit of 0.5 s"):
            collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.005, time_limit=0.5)

    def test_other_threads_go_on(self):
        counted = []
        done = threading.Event()

        def count():
            while not done.is_set():
                counted.append(1)
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.05)
        done.set()
        thread.join()
        self.assertGreater(len(counted), 10)


if __name__ == "__main__":
    unittest.main()
