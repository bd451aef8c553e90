"""Any number of threads makes the same bytes, even more threads than cores.
Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import os
import unittest
from unittest import mock

from program import MODELS, ProgramTest, box_points, off_text, wedge_text

COUNTS = (1, 2, 3, 8, 16)


class AnyNumberOfThreads(ProgramTest):
    def setUp(self):
        super().setUp()
        cores = mock.patch.dict(os.environ, {"COLLARMESH_CORES": str(max(COUNTS))})
        cores.start()
        self.addCleanup(cores.stop)

    def expect_the_same(self, *arguments, formats=("vtu", "msh")):
        for suffix in formats:
            written = []
            # Further formats store the same mesh, so fewer counts suffice.
            counts = COUNTS if suffix == formats[0] else (1, 3, max(COUNTS))
            for threads in counts:
                self.expect(0, *arguments, "-o", f"mesh.{suffix}", "--threads", threads)
                written.append((self.folder / f"mesh.{suffix}").read_bytes())
            for threads, bytes_of in zip(counts, written):
                self.assertEqual(bytes_of, written[0], f"{threads} threads, .{suffix}")

    def test_a_box(self):
        self.expect_the_same(self.box, "--size", "0.04", formats=("vtu", "msh", "mesh", "inp"))

    def test_a_wedge(self):
        self.expect_the_same(self.write("wedge.off", wedge_text(20)), "--size", "0.03")

    def test_a_plate_that_is_coarsened(self):
        plate = off_text(box_points((0, 0, 0), (10, 10, 0.1)), [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5),
                                                                (2, 3, 7, 6), (3, 0, 4, 7)])
        self.expect_the_same(self.write("plate.off", plate), "--size", "1")

    def test_regions(self):
        self.expect_the_same(MODELS / "two_boxes.poly", "--size", "0.06")


class RecordedCosts(ProgramTest):
    def test_a_table(self):
        with mock.patch.dict(os.environ, {"COLLARMESH_CORES": "8", "COLLARMESH_RECORD_COSTS": "costs.tsv"}):
            self.expect(0, self.box, "-o", "recorded.vtu", "--size", "0.05", "--threads", "8")
        self.expect(0, self.box, "-o", "mesh.vtu", "--size", "0.05", "--threads", "1")
        self.assertEqual((self.folder / "recorded.vtu").read_bytes(), (self.folder / "mesh.vtu").read_bytes())
        header, *rows = [line.split("\t") for line in (self.folder / "costs.tsv").read_text().splitlines()]
        found = [dict(zip(header, row)) for row in rows]
        for stage in ("read", "complex", "refine", "coarsen", "improve", "check", "write"):
            self.assertIn(stage, {row["stage"] for row in found})
        for row in found:
            work, spans = float(row["work"]), [float(row[f"span_{n}"]) for n in (2, 4, 8, 16, 32, 64)]
            self.assertEqual(spans, sorted(spans, reverse=True), row)
            self.assertGreaterEqual(spans[0] + 1e-5, work / 2, row)
            self.assertLessEqual(spans[0], work + 1e-5, row)


if __name__ == "__main__":
    unittest.main()
