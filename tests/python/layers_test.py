"""Prisms, pyramids and quadrangles of meshes: arrays, files, conversions."""

import os
import pathlib
import pickle
import tempfile
import unittest

import collarmesh
import numpy

# A prism, a pyramid on one of its quadrangles, and a tet on a side of the pyramid.
POINTS = [(0, 0, 0), (1, 0, 0), (0.5, 1, 0), (0, 0, 1), (1, 0, 1), (0.5, 1, 1), (0.5, -0.8, 0.5), (0.5, -0.8, 1.5)]
PRISM, PYRAMID, TET = (0, 1, 2, 3, 4, 5), (0, 1, 4, 3, 6), (3, 6, 4, 7)
SIDES = {"prism": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
         "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
         "tet": ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))}
EDGES = {"prism": ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
         "pyramid": ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)),
         "tet": ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
         3: ((0, 1), (1, 2), (2, 0)), 4: ((0, 1), (1, 2), (2, 3), (3, 0))}


def boundary():
    sides = {}
    for kind, cell in (("prism", PRISM), ("pyramid", PYRAMID), ("tet", TET)):
        for side in SIDES[kind]:
            corners = tuple(cell[k] for k in side)
            sides.setdefault(tuple(sorted(corners)), []).append(corners)
    single = [found[0] for found in sides.values() if len(found) == 1]
    return [side for side in single if len(side) == 3], [side for side in single if len(side) == 4]


def layers(order=1, **more):
    """The mesh, with nodes amid its edges in second order."""
    faces, quads = boundary()
    points, middle = [numpy.array(p, dtype=float) for p in POINTS], {}

    def with_nodes(cell, edges):
        if order == 1:
            return cell
        amid = []
        for i, j in edges:
            key = tuple(sorted((cell[i], cell[j])))
            if key not in middle:
                middle[key] = len(points)
                points.append((points[cell[i]] + points[cell[j]]) / 2)
            amid.append(middle[key])
        return (*cell, *amid)

    cells = {f"{kind}s": [with_nodes(cell, EDGES[kind])]
             for kind, cell in (("prism", PRISM), ("pyramid", PYRAMID), ("tet", TET))}
    cells["faces"] = [with_nodes(face, EDGES[3]) for face in faces]
    cells["quads"] = [with_nodes(quad, EDGES[4]) for quad in quads]
    tets = cells.pop("tets")
    return collarmesh.Mesh(points, tets, face_tags=[7] * len(faces), quad_tags=[8] * len(quads), **cells, **more)


class Layers(unittest.TestCase):
    def test_arrays(self):
        for order in (1, 2):
            mesh = layers(order, prism_tags=[3], pyramid_tags=[3], tags=[3])
            self.assertEqual(mesh.order, order)
            self.assertEqual(mesh.prisms.shape, (1, 6))
            self.assertEqual(mesh.prism_mid_nodes.shape, (order - 1, 9))
            self.assertEqual(mesh.pyramids.tolist(), [list(PYRAMID)])
            self.assertEqual(mesh.pyramid_mid_nodes.shape, (order - 1, 8))
            self.assertEqual(mesh.quads.shape, (2, 4))
            self.assertEqual(mesh.quad_tag.tolist(), [8, 8])
            self.assertEqual(mesh.quad_regions.tolist(), [[1, 0]] * 2)
            self.assertTrue((mesh.face_regions == [1, 0]).all())
            self.assertEqual(mesh.prism_region.tolist(), [1])
            self.assertEqual(mesh.prism_layer.tolist(), [0])
            self.assertIn("1 prisms, 1 pyramids", repr(mesh))
            figures = mesh.info()["mesh"]
            self.assertEqual((figures["prisms"], figures["pyramids"], figures["quads"]), (1, 1, 2))
            self.assertAlmostEqual(figures["region_volumes"]["1"], 0.5 + 0.8 / 3 + 0.8 / 6)
            self.assertIn("1 prisms", mesh._repr_html_())

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            for order in (1, 2):
                mesh = layers(order)
                for extension in (".vtu", ".msh", ".unv"):
                    path = os.path.join(folder, f"a{order}{extension}")
                    mesh.write(path)
                    read = collarmesh.read(path)
                    for name in ("points", "tets", "prisms", "pyramids", "quads", "prism_mid_nodes",
                                 "pyramid_mid_nodes", "quad_mid_nodes", "quad_tag", "prism_tag"):
                        self.assertEqual(getattr(read, name).tolist(), getattr(mesh, name).tolist(), (extension, name))
            with self.assertRaisesRegex(collarmesh.WriteError, "prisms and pyramids"):
                layers().write(os.path.join(folder, "a.pvtu"))
            skin = os.path.join(folder, "skin.off")
            collarmesh.convert(layers(), skin)
            facets = len(boundary()[0]) + len(boundary()[1])
            self.assertEqual(pathlib.Path(skin).read_text().split()[2], str(facets))
            self.assertTrue(collarmesh.check(layers(), skin, radius_edge=100)["passed"])

    def test_pickled(self):
        mesh = pickle.loads(pickle.dumps(layers(2)))
        self.assertEqual(mesh.prisms.tolist(), [list(PRISM)])
        state = {name: value for name, value in layers().__getstate__().items()
                 if not name.startswith(("prism", "pyramid"))}
        earlier = collarmesh.Mesh.__new__(collarmesh.Mesh)
        earlier.__setstate__(state)
        self.assertEqual(earlier.prisms.shape, (0, 6))

    def test_prisms_that_turn_the_other_way_are_turned(self):
        turned = [PRISM[k] for k in (0, 2, 1, 3, 5, 4)]
        faces, quads = boundary()
        mesh = collarmesh.Mesh(POINTS, [TET], faces=faces, quads=quads, prisms=[turned], pyramids=[PYRAMID])
        self.assertEqual(mesh.prisms.tolist(), [list(PRISM)])

    def test_meshio(self):
        try:
            import meshio  # noqa: F401
        except ImportError:
            self.skipTest("meshio is not installed")
        mesh = layers().to_meshio()
        self.assertEqual([(block.type, len(block.data)) for block in mesh.cells],
                         [("tetra", 1), ("triangle", 8), ("line", 0), ("wedge", 1), ("pyramid", 1), ("quad", 2)])
        self.assertEqual([len(part) for part in mesh.cell_sets["patch_8"]], [0, 0, 0, 0, 0, 2])
        self.assertEqual([len(part) for part in mesh.cell_sets["region_1"]], [1, 0, 0, 1, 1, 0])

    def test_faults(self):
        for wrong, said in (({"prisms": [(0, 1, 2, 3, 4)]}, "prisms"), ({"prisms": [(0, 1, 2, 3, 4, 99)]}, "prisms"),
                            ({"prisms": [PRISM], "prism_tags": [1, 2]}, "prism_tags"),
                            ({"prisms": [(*PRISM, *PRISM[:3], *PRISM)]}, "order 1")):
            with self.assertRaisesRegex(collarmesh.OptionError, said):
                collarmesh.Mesh(POINTS, [TET], faces=boundary()[0], **wrong)
        with self.assertRaisesRegex(collarmesh.OptionError, "faces"):
            collarmesh.Mesh(POINTS, [TET], prisms=[PRISM])
        for what in (lambda mesh: mesh.interpolate(numpy.zeros(8), [(0.5, 0.2, 0.2)]),
                     lambda mesh: mesh.partitioned(1)):
            with self.assertRaisesRegex(collarmesh.OptionError, "prisms"):
                what(layers())


if __name__ == "__main__":
    unittest.main()
