"""Each call of the system that a run makes fails in turn; after that: the right exit code, whole files or none, and
what was there before as it was.

Run by ctest with COLLARMESH_PROGRAM and COLLARMESH_FAULTS, the library to preload (faults.cpp). Allocations are many:
COLLARMESH_ALL_FAULTS=1 has every one fail (an hour), else samples of them do.
"""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM, FAULTS = os.environ["COLLARMESH_PROGRAM"], os.environ["COLLARMESH_FAULTS"]
ALL = os.environ.get("COLLARMESH_ALL_FAULTS") == "1"
SOURCES = pathlib.Path(__file__).resolve().parents[2]
BRACKET = SOURCES / "resources" / "models" / "bracket.off"
CAD = SOURCES / "resources" / "models" / "flange.step"
BEFORE = "what was there before"


class FaultsTest(unittest.TestCase):
    """The runs by name, and the files that each writes."""
    runs = {"vtu": (BRACKET, ["out.vtu"]), "med": (BRACKET, ["out.med"]),
            "ele": (BRACKET, ["out.ele", "out.node", "out.face", "out.edge"]), "unv": (CAD, ["out.unv"])}

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="collarmesh-test-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.count = self.folder / "count"

    def run_with(self, name, **faults):
        part, files = self.runs[name]
        environment = dict(os.environ, LD_PRELOAD=FAULTS, FAULT_COUNT=str(self.count),
                           **{f"FAULT_{key.upper()}": str(value) for key, value in faults.items()})
        for left in self.folder.iterdir():
            shutil.rmtree(left) if left.is_dir() else left.unlink()
        for file in files:
            (self.folder / file).write_text(BEFORE)
        patient = ["--time-limit", "100000"] if "forks" in faults else []  # reading CAD files has its own limit
        run = subprocess.run([PROGRAM, part, "-o", files[0], "-q", "--threads", "1", *patient], cwd=self.folder,
                             env=environment, capture_output=True, text=True, timeout=7200 if ALL else 600)
        return run.returncode, run.stderr

    def counts(self, name, kind):
        """Returns the numbers of calls of the process that writes, by the names in faults.cpp."""
        code, messages = self.run_with(name, kind=kind, at=0)
        if "cannot be loaded" in messages or code == 2:
            self.skipTest("built without this format")
        self.assertEqual(code, 0, messages)
        most = {}
        for word, number in map(str.split, self.count.read_text().splitlines()):
            most[word] = max(int(number), most.get(word, 0))
        return most

    def calls(self, name, kind):
        return self.counts(name, kind)["calls"]

    def assert_whole(self, name, code, context):
        """After success all files are new, otherwise all are old; nothing else is left."""
        files = self.runs[name][1]
        old = [(self.folder / file).exists() and (self.folder / file).read_bytes() == BEFORE.encode() for file in files]
        self.assertEqual(old, [code != 0] * len(files), context)
        self.assertTrue(all((self.folder / file).stat().st_size > 0 for file in files), context)
        left = {p.name for p in self.folder.iterdir()} - set(files) - {"count"}
        self.assertEqual(left, set(), context)

    def assert_kept(self, name, messages):
        """If files could not be put back either, each is in its place or in the folder that the message
        names."""
        folder = self.folder / messages.strip().rsplit(" ", 1)[-1]
        for file in self.runs[name][1]:
            places = [self.folder / file, folder / f"kept-{file}"]
            self.assertTrue(any(p.exists() and p.read_bytes() == BEFORE.encode() for p in places), messages)


class Threads(FaultsTest):
    def test_each_thread(self):
        for name in self.runs:
            for at in range(1, self.calls(name, "thread") + 3):
                for lasts in ({}, {"lasts": 1}):
                    with self.subTest(name=name, at=at, lasts=bool(lasts)):
                        code, messages = self.run_with(name, kind="thread", at=at, **lasts)
                        self.assertIn(code, (0, 5), messages)
                        self.assert_whole(name, code, messages)


class Files(FaultsTest):
    def test_each_call(self):
        for name in self.runs:
            for at in range(1, self.calls(name, "file") + 1):
                for lasts in ({}, {"lasts": 1}) if ALL or name == "ele" else ({},):
                    with self.subTest(name=name, at=at, lasts=bool(lasts)):
                        code, messages = self.run_with(name, kind="file", at=at, **lasts)
                        self.assertIn(code, (0, 8), messages)
                        if lasts and "the previous files could not be restored" in messages:
                            self.assert_kept(name, messages)
                        else:
                            self.assert_whole(name, code, messages)


class Memory(FaultsTest):
    def test_each_allocation_before_writing(self):
        """In children that are forked at each allocation (faults.cpp), which takes a millisecond for each."""
        for name in ("vtu", "unv") if not ALL else self.runs:
            total = self.calls(name, "new")
            with self.subTest(name=name):
                first = 1 if ALL else max(1, total - 5000)
                code, messages = self.run_with(name, kind="new", at=first, forks=1)
                self.assertEqual(code, 0, messages[-2000:])
                wrong = [line for line in self.count.read_text().splitlines()
                         if not line.startswith(("calls", "before"))]
                self.assertEqual(wrong, [])
                self.assert_whole(name, 0, messages[-2000:])

    def test_allocations(self):
        """In separate runs, mostly for the allocations of writing."""
        for name in self.runs:
            counts = self.counts(name, "new")
            total, before = counts["calls"], counts["before_writing"]
            self.assertTrue(0 < before < total, counts)
            writing = range(before, total + 1, 1 if ALL else max(1, (total - before) // 12))
            sample = sorted({*range(1, total, max(1, total // (200 if ALL else 6))), *writing})
            for at in sample:
                with self.subTest(name=name, at=at):
                    code, messages = self.run_with(name, kind="new", at=at)
                    self.assertIn(code, (0, 5), messages)
                    self.assert_whole(name, code, messages)


if __name__ == "__main__":
    unittest.main()
