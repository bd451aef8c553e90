"""The panel's texts for reports, messages and progress, without the window. Run by run.py."""

import enum
import math
import os
import subprocess
import sys
import unittest

from freecad.collarmesh_workbench import compatibility, places, size_presets, time_left, work_folder

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402


class Words(unittest.TestCase):
    def test_places_in_messages(self):
        text = "4 edges border one face: Edge6 of Face2 at (10, -5.5, 1e-3), Edge6 of Face2 at (0, 5, 10); size 3"
        place = places.told(places.PROBLEM, text)
        self.assertEqual(place.points, ((10, -5.5, 0.001), (0, 5, 10)))
        self.assertEqual(place.subshapes, ("Edge6", "Face2"))
        self.assertEqual(places.told(places.PROBLEM, "nothing", [[1, 2, 3]]).points, ((1, 2, 3),))

    def test_each_message_is_told_once(self):
        report = {"check": {"findings": []}, "complex": {"warnings": [{"message": "a note", "where": [0, 0, 0]}]},
                  "warnings": ["a note"], "notes": ["a note", "another"], "message": "", "guarantees_hold": True,
                  "repair": {"repaired": False}, "projection": None, "second_order": None}
        self.assertEqual([each.text for each in places.in_report(report)], ["a note", "another"])

    def test_sizes_fit_the_shape(self):
        for diagonal in (1e-4, 0.3, 50, 7e5):
            sizes = [size for _, size in size_presets.presets(diagonal)]
            self.assertEqual(sizes, sorted(sizes, reverse=True))
            self.assertAlmostEqual(sizes[2] / diagonal, 1 / 20, delta=0.003)
        self.assertEqual(size_presets.rounded(0.02534), 0.025)
        self.assertEqual(size_presets.count_text(12345), "12\u202f000")

    def test_time_left_of_what_was_predicted(self):
        """Runs that are as fast as predicted, faster, slower, and much slower."""
        for pace in (1, 0.3, 1.3, 6):
            left = time_left.TimeLeft(predicted=20, afterwards=4)
            told = [left.seconds(20 * pace * time_left.share_of_time(i / 100), i / 100) for i in range(101)]
            self.assertEqual(told[0], 24)
            numbers = [each for each in told if each != math.inf]
            for i, number in enumerate(numbers):
                self.assertLessEqual(number, 1.5 * min(numbers[:i + 1]), f"{pace}: {told}")
            self.assertAlmostEqual(numbers[-1], 4)
            self.assertEqual(math.inf in told, pace > 1.5, f"{pace}: {told}")
            if 1 <= pace < 1.5:
                self.assertAlmostEqual(told[60], (1 - time_left.share_of_time(0.6)) * 20 * pace + 4)

    def test_time_left_of_a_run_that_stands_still(self):
        left = time_left.TimeLeft(predicted=10)
        told = [left.seconds(passed, 0.01) for passed in range(60)]
        self.assertEqual(told[-1], math.inf)
        self.assertLess(told[0], 11)

    def test_time_left_without_prediction(self):
        left = time_left.TimeLeft()
        self.assertIsNone(left.seconds(0.5, 0.9))
        self.assertIsNone(time_left.TimeLeft().seconds(60, 0.05))
        first = left.seconds(10, 0.59)
        self.assertAlmostEqual(first, 10 / 0.3 - 10)
        self.assertAlmostEqual(left.seconds(15, 0.59), first - 5)  # no news
        self.assertEqual(left.seconds(100, 0.59), math.inf)
        self.assertEqual(left.seconds(200, 0.6), math.inf)  # the shown time would grow
        self.assertLess(left.seconds(210, 0.97), 15)

    def test_shares_of_time(self):
        shares = [time_left.share_of_time(i / 100) for i in range(101)]
        self.assertEqual((shares, shares[0], shares[-1]), (sorted(shares), 0, 1))

    def test_folders_end_with_what_works_in_them(self):
        folder = work_folder.WorkFolder()
        with open(os.path.join(folder.name, "file"), "w", encoding="utf-8"):
            pass
        with subprocess.Popen(["sleep", "100"]) as program:
            folder.program_is(program.pid)
            folder.cleanup()
            self.assertEqual(program.wait(), -9)
        self.assertFalse(os.path.exists(folder.name))

    def test_buttons_of_all_versions(self):
        """FreeCAD 0.20 and 0.21 use numbers, 1.x uses enumerations."""

        class Button(enum.Flag):
            CLOSE = 0x00200000

        self.assertEqual(compatibility.as_number(Button.CLOSE), 0x00200000)
        self.assertEqual(compatibility.as_number(0x00200000), 0x00200000)


run_in_freecad.run(Words)
