"""An installed add-on meshes with the program installed with it. Run by package_test.py."""

import os
import sys
import unittest

import Part
from freecad import collarmesh_workbench

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402


class Installed(unittest.TestCase):
    def test_program_is_found_and_meshes(self):
        prefix = os.environ["COLLARMESH_TEST_ARGUMENT"]
        self.assertTrue(collarmesh_workbench.__file__.startswith(os.environ["FREECAD_USER_HOME"]))
        self.assertEqual(collarmesh_workbench.find_program(), os.path.join(prefix, "bin", "collarmesh"))
        self.assertGreater(collarmesh_workbench.mesh(Part.makeSphere(5), size=1).FemMesh.VolumeCount, 1000)


run_in_freecad.run(Installed)
