"""Checks that FreeCAD reads the add-on's package.xml, and that the add-on meshes. Run by addon_test.py with
the path of that file."""

import os
import sys
import unittest

import FreeCAD
import Part
from freecad import collarmesh_workbench

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402


class Addon(unittest.TestCase):
    def test_metadata(self):
        metadata = FreeCAD.Metadata(os.environ["COLLARMESH_TEST_ARGUMENT"])
        self.assertEqual(metadata.Name, "collarmesh")
        self.assertEqual(metadata.Maintainer, [{"name": "A & B", "email": "a@b.example"}])
        self.assertEqual(metadata.License[0]["file"], "LICENSE")
        self.assertEqual(len(metadata.Urls), 4)
        (workbench,) = metadata.Content["workbench"]
        self.assertIn("FEM", workbench.Tag)

    def test_it_meshes(self):
        self.assertGreater(collarmesh_workbench.mesh(Part.makeBox(10, 10, 10), size=4).FemMesh.VolumeCount, 50)


run_in_freecad.run(Addon)
