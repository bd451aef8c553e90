"""Names and layers on a fin that is far thinner than the feature size, which repair may lay over itself."""

import json
import unittest

from program import ProgramTest, off_text

WIDE, DEEP, BLOCK, TOP, THICKNESS = 10, 4, 3, 9, 0.004


def fin_text():
    """Returns a block with a fin across its whole top."""
    left, right = 5, 5 + THICKNESS
    outline = [(0, 0), (WIDE, 0), (WIDE, BLOCK), (right, BLOCK), (right, TOP), (left, TOP), (left, BLOCK), (0, BLOCK)]
    n = len(outline)
    points = [(x, y, z) for y in (0, DEEP) for x, z in outline]
    sides = [(k, n + k, n + (k + 1) % n, (k + 1) % n) for k in range(n)]
    return off_text(points, [*sides, range(n), range(2 * n - 1, n - 1, -1)])


class ThinFin(ProgramTest):
    def setUp(self):
        super().setUp()
        self.fin = self.write("fin.off", fin_text())
        self.out = self.folder / "fin.vtk"

    def mesh(self, *options):
        return self.run_program(self.fin, "-o", self.out, "--size", "1", *options, timeout=600)

    def info(self, path, part):
        return json.loads(self.run_program("info", "--json", path).stdout)[part]

    def heights_of(self, name):
        """Returns the heights of the corners of all faces with this name in the mesh."""
        import meshio

        tags = [patch["tag"] for patch in self.info(self.out, "mesh")["patch_list"] if patch["name"] == name]
        mesh = meshio.read(self.out)
        return {float(mesh.points[corner][2]) for block, tag_of in zip(mesh.cells, mesh.cell_data["tag"])
                if block.type == "triangle" for corners, tag in zip(block.data, tag_of) if tag in tags
                for corner in corners}

    def test_a_name_stays_on_the_face_it_was_given_to(self):
        top, = (patch for patch in self.info(self.fin, "complex")["patch_list"] if patch["where"][2] == TOP)
        self.assertAlmostEqual(top["area"], DEEP * THICKNESS)
        run = self.mesh("--name", f"fintop={top['tag']}")
        self.assertIn(run.returncode, (0, 7), run.stderr)
        self.assertEqual(self.heights_of("fintop"), {TOP}, run.stderr)

    def test_layers_on_all_faces(self):
        run = self.mesh("--layers", "all")
        self.assertNotIn("on no face", run.stderr)
        if run.returncode in (0, 7):
            self.assertGreater(self.info(self.out, "mesh")["prisms"], 0, run.stderr)
        else:  # walls that leave no room for layers may be refused
            self.assertRegex(run.stderr, r"collarmesh: .*(layers|wall|thin)")
            self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()
