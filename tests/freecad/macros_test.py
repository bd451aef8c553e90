"""The example macros work as they say. Run by run.py."""

import os
import pathlib
import runpy
import sys
import unittest

import FreeCAD

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402

MACROS = pathlib.Path(__file__).resolve().parents[2] / "freecad_workbench" / "macros"


class Macros(unittest.TestCase):
    def run_macro(self, name):
        found = runpy.run_path(str(MACROS / name))
        self.addCleanup(FreeCAD.closeDocument, found["document"].Name)
        return found

    def test_plate_with_hole(self):
        # Stress concentration of a finite plate, width 40, hole 8, on the net section (Heywood): 2 + 0.8^3 = 2.51
        self.assertAlmostEqual(self.run_macro("plate_with_hole.py")["concentration"], 2.51, delta=0.15)

    def test_two_materials(self):
        found = self.run_macro("two_materials.py")
        groups = found["elements"]
        self.assertEqual(groups["Aluminium_Volumes"] + groups["Steel_Volumes"], found["fem_mesh"].VolumeCount)
        self.assertEqual(groups["Steel_Volumes"], groups["Solid2"])

    def test_parametric_study(self):
        table = self.run_macro("parametric_study.py")["table"]
        self.assertEqual([row[0] for row in table], [2, 4, 6, 8])
        for radius, elements, volume, angle in table:
            self.assertAlmostEqual(volume, 6000 - 3.14159265 * radius**2 * 10, delta=0.1)
            self.assertGreater(elements, 1000)
            self.assertGreater(angle, 5)


run_in_freecad.run(Macros)
