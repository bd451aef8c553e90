"""Gives the program hostile input and faults of the system: one test for each that once did harm.

Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import contextlib
import fcntl
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from program import (BOX_FACES, MODELS, PROGRAM, ProgramTest, box_points, children_of, has_signal, off_text,
                     wait_for)

BRACKET = MODELS / "bracket.off"


def limited(kind, value):
    return lambda: resource.setrlimit(kind, (value, value))


class HostileTest(ProgramTest):
    def run_bytes(self, *arguments, **options):
        """Runs the program with bytes in and out, because names need not be UTF-8."""
        return subprocess.run([os.fsencode(PROGRAM), *map(os.fsencode, arguments)], cwd=self.folder, timeout=120,
                              **{"capture_output": True, **options})


class InputsAreKept(HostileTest):
    """No output may replace an input."""

    def poly(self):
        self.expect_surface("part.poly", self.box)
        text = (self.folder / "part.poly").read_text()
        self.assertNotIn("node", text)
        return self.folder / "part.poly"

    def expect_surface(self, name, source):
        run = self.run_program("convert", source, "-o", self.folder / name)
        self.assertEqual(run.returncode, 0, run.stderr)

    def refuses(self, *arguments):
        before = {p.name: p.read_bytes() for p in self.folder.iterdir()}
        run = self.run_program(*arguments)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("would overwrite", run.stderr)
        self.assertEqual(before, {p.name: p.read_bytes() for p in self.folder.iterdir()})

    def test_points_of_a_complex_in_a_file_of_their_own(self):
        poly = self.poly()
        lines = poly.read_text().splitlines()
        count = int(next(line for line in lines if not line.startswith("#")).split()[0])
        first = next(i for i, line in enumerate(lines) if not line.startswith("#"))
        (self.folder / "part.node").write_text("\n".join(lines[first:first + count + 1]) + "\n")
        poly.write_text("\n".join(["0 3 0 0", *lines[first + count + 1:]]) + "\n")
        self.refuses(poly, "-o", self.folder / "part.ele")

    def test_files_of_a_mesh(self):
        self.expect_mesh("part.ele")
        self.refuses("convert", self.folder / "part.ele", "-o", self.folder / "part.ele")
        self.expect_mesh("other.vtu")
        os.symlink("other.vtu", self.folder / "link.vtu")
        self.refuses("convert", self.folder / "other.vtu", "-o", self.folder / "link.vtu")

    def expect_mesh(self, name):
        run = self.run_program(self.box, "-o", self.folder / name)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_surface(self):
        self.refuses("convert", self.box, "-o", self.box)
        self.refuses("repair", self.box, "-o", self.box)

    def test_size_field(self):
        self.expect_mesh("sizes.vtu")
        self.refuses(self.box, "-o", self.folder / "sizes.vtu", "--size-field", self.folder / "sizes.vtu")

    def test_names(self):
        names = self.folder / "names.vtu"
        names.write_text("{}")
        self.refuses(self.box, "-o", names, "--names", names)
        self.refuses("repair", self.box, "-o", self.folder / "names.vtu", "--format", "off", "--names", names)

    def test_parts_of_a_mesh_in_several_files(self):
        self.expect_mesh("part.xdmf")
        self.assertTrue((self.folder / "part_faces.h5").exists())
        self.refuses("convert", self.folder / "part.xdmf", "-o", self.folder / "part_faces.xdmf")

    def test_standard_input(self):
        with open(self.box) as box:
            run = subprocess.run([PROGRAM, "convert", "-", "--input-format", ".off", "-o", self.box], stdin=box,
                                 capture_output=True, text=True)
        self.assertEqual(run.returncode, 2, run.stderr)

    def test_report_beside_the_files_of_the_mesh(self):
        run = self.run_program(self.box, "-o", self.folder / "x.ele", "--report", self.folder / "x.face")
        self.assertEqual(run.returncode, 2, run.stderr)


class OutputFiles(HostileTest):
    def test_all_files_of_a_mesh_or_none(self):
        (self.folder / "x.node").mkdir()
        run = self.run_program(self.box, "-o", self.folder / "x.ele")
        self.assertEqual(run.returncode, 8, run.stderr)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["box.off", "x.node"])

    def test_mode_is_kept(self):
        for name in ("a.vtu", "b.ele", "b.node"):
            (self.folder / name).touch()
            (self.folder / name).chmod(0o600)
        for name in ("a.vtu", "b.ele"):
            self.assertEqual(self.run_program(self.box, "-o", self.folder / name).returncode, 0)
        for name in ("a.vtu", "b.ele", "b.node"):
            self.assertEqual((self.folder / name).stat().st_mode & 0o777, 0o600, name)

    @unittest.skipUnless(os.geteuid() == 0, "only root gives files away")
    def test_owner_is_kept(self):
        self.out.touch()
        os.chown(self.out, 12345, 23456)
        self.expect(0, self.box, "-o", self.out, writes=True)
        self.assertEqual((self.out.stat().st_uid, self.out.stat().st_gid), (12345, 23456))

    def test_folders_of_killed_runs_are_removed(self):
        dead, used, fresh = (self.folder / f".collarmesh-{name}" for name in ("dead00", "used00", "fresh0"))
        for folder in (dead, used, fresh):
            folder.mkdir(mode=0o700)
            (folder / "out.vtu").write_text("half")
        for folder in (dead, used):
            os.utime(folder, (time.time() - 3600,) * 2)
        lock = os.open(used, os.O_RDONLY)
        self.addCleanup(os.close, lock)
        fcntl.flock(lock, fcntl.LOCK_EX)
        run = self.run_program(self.box, "-o", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual([folder.exists() for folder in (dead, used, fresh)], [False, True, True])

    def test_no_space(self):
        """Includes formats that libraries write."""
        for name in ("a.vtu", "a.med", "a.xdmf", "a.ele", "a.msh"):
            for size in (100, 4096, 30000):
                with self.subTest(name=name, size=size):
                    run = subprocess.run([PROGRAM, BRACKET, "-o", self.folder / name, "-q"], capture_output=True,
                                         text=True, preexec_fn=limited(resource.RLIMIT_FSIZE, size))
                    if "cannot be loaded" in run.stderr or "use .vtu" in run.stderr:
                        continue  # the program was built without it
                    self.assertEqual(run.returncode, 8, run.stderr)
                    self.assertEqual([p.name for p in self.folder.iterdir()], ["box.off"])

    def test_temporary_folder_is_missing(self):
        environment = dict(os.environ, TMPDIR=str(self.folder / "missing"))
        run = subprocess.run([PROGRAM, "convert", self.box, "-o", "-", "--format", ".vtu"], env=environment,
                             capture_output=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn(b"</VTKFile>", run.stdout)

    def test_name_that_is_no_utf8(self):
        for name in (b"\xff.off", b"\xc3\x28 \xe2\x82.off"):
            path = os.path.join(os.fsencode(self.folder), name)
            shutil.copy(self.box, path)
            run = self.run_bytes(path, "-o", self.out, "--report", "report.json", "--progress", "json")
            self.assertEqual(run.returncode, 0, run.stderr)
            json.loads((self.folder / "report.json").read_bytes())
            self.assertTrue(self.out.exists())
            for arguments in (("info", "--json", path), ("check", "--json", self.out, "--against", path),
                              ("repair", path, "-o", "r.off", "--json")):
                run = self.run_bytes(*arguments)
                self.assertEqual(run.returncode, 0, run.stderr)
                json.loads(run.stdout)


class Streams(HostileTest):
    """Standard output and error that are full, closed, or pipes that nobody reads."""

    def redirected(self, arguments, redirection):
        return subprocess.run(["bash", "-c", f'"$0" "$@" {redirection}', PROGRAM, *map(str, arguments)],
                              cwd=self.folder, capture_output=True, text=True, timeout=120)

    def test_messages_that_cannot_be_written(self):
        for redirection in ("2>&-", "2>/dev/full", ">&- 2>&-", "<&- >&- 2>&-"):
            for options in ((), ("--progress", "json"), ("-v",)):
                with self.subTest(redirection=redirection, options=options):
                    run = self.redirected((self.box, "-o", self.out, *options), redirection)
                    self.assertEqual(run.returncode, 0)
                    self.assertIn("</VTKFile>", self.out.read_text()[-20:])
                    self.assertNotIn("guarantee", self.out.read_text())
                    self.out.unlink()
            self.assertEqual(self.redirected(("missing.off", "-o", self.out), redirection).returncode, 3)
            self.assertEqual(self.redirected((self.box,), redirection).returncode, 2)

    def test_results_that_cannot_be_written(self):
        self.expect(0, self.box, "-o", self.out, writes=True)
        for redirection in (">/dev/full", ">&-"):
            for arguments in (("info", self.box), ("info", self.box, "--json"), ("info", self.out),
                              ("check", self.out, "--against", self.box), ("--help",), ("info", "--help"),
                              ("--version",), ("check", self.out, "--against", self.box, "--json"),
                              ("repair", self.box, "-o", "r.off", "--json"),
                              ("convert", self.box, "-o", "-", "--format", ".stl")):
                with self.subTest(redirection=redirection, arguments=arguments):
                    run = self.redirected(arguments, redirection)
                    self.assertEqual(run.returncode, 8, run.stderr)
                    self.assertIn("standard output", run.stderr)

    def test_a_pipe_that_nobody_reads(self):
        read, write = os.pipe()
        os.close(read)
        for arguments in (("info", self.box), ("convert", self.box, "-o", "-", "--format", ".vtu")):
            run = subprocess.run([PROGRAM, *map(str, arguments)], stdout=write, stderr=subprocess.PIPE,
                                 env=dict(os.environ, TMPDIR=str(self.folder)))
            self.assertEqual(run.returncode, 8, run.stderr)
        os.close(write)
        self.assert_nothing_left()


class Signals(HostileTest):
    def test_each_leaves_nothing(self):
        for number in (signal.SIGHUP, signal.SIGQUIT, signal.SIGINT, signal.SIGTERM):
            for times in (1, 2):
                with self.subTest(signal=number, times=times):
                    run = subprocess.Popen([PROGRAM, self.box, "-o", self.out, "--size", "0.002", "--progress", "json"],
                                           stderr=subprocess.PIPE, text=True)
                    self.addCleanup(run.kill)
                    for line in run.stderr:
                        if json.loads(line)["phase"] == "refine":
                            break
                    for _ in range(times):
                        run.send_signal(number)
                        wait_for(lambda: run.poll() is not None or not has_signal(
                            run.pid, "ShdPnd", number), "delivery")
                    run.communicate(timeout=60)
                    self.assertEqual(run.returncode, 6)
                    self.assertFalse(self.out.exists())
                    self.assert_nothing_left()

    def test_limit_of_cpu_time(self):
        for soft, hard in ((2, 60), (4, 4)):
            with self.subTest(soft=soft, hard=hard):
                run = subprocess.run([PROGRAM, self.box, "-o", self.out, "--size", "0.002"], capture_output=True,
                                     text=True, timeout=120,
                                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (soft, hard)))
                self.assertEqual(run.returncode, 5, run.stderr)
                self.assertIn("limit of CPU time is reached (stage: refine", run.stderr)
                self.assertFalse(self.out.exists())
                self.assert_nothing_left()

    def bytes_being_written(self):
        """Returns the size of the largest temporary file, -1 if there is none."""
        size = -1
        for folder, _, files in os.walk(self.folder):  # leaves out folders that go away meanwhile
            for file in files if ".collarmesh-" in folder else []:
                with contextlib.suppress(FileNotFoundError):
                    size = max(size, os.path.getsize(os.path.join(folder, file)))
        return size

    def test_while_writing(self):
        """Afterwards there is either the complete old file or the complete new one."""
        self.expect(0, self.box, "-o", self.out, "--size", "0.05", writes=True)
        before = self.out.read_bytes()
        self.expect(0, self.box, "-o", self.out, "--size", "0.04", writes=True)
        after = self.out.read_bytes()
        codes = []
        for share in (0, 0.2, 0.4, 0.6, 0.8, 1):
            self.out.write_bytes(before)
            run = subprocess.Popen([PROGRAM, self.box, "-o", self.out, "--size", "0.04", "-q"],
                                   stderr=subprocess.DEVNULL)
            self.addCleanup(run.kill)
            wait_for(lambda: run.poll() is not None or self.bytes_being_written() >= share * len(after), "it writes",
                     seconds=300)
            run.send_signal(signal.SIGHUP)
            code = run.wait(timeout=60)
            codes.append(code)
            self.assertIn(code, (0, 6, -signal.SIGHUP))
            self.assertEqual(self.out.read_bytes(), after if code == 0 else before)
            self.assert_nothing_left()
        self.assertTrue(any(codes), "no signal came before the new file was in place")


class Libraries(HostileTest):
    """No library may be loaded from the current folder."""

    def targets(self):
        root = pathlib.Path(PROGRAM).parents[1]
        found = [pathlib.Path(PROGRAM), *root.glob("lib/**/collarmesh/*.so"), *root.glob("python/collarmesh/*.so"),
                 *root.glob("lib/python3/dist-packages/collarmesh/*.so")]
        self.assertGreater(len(found), 0)
        return found

    def test_run_paths_are_absolute(self):
        for target in self.targets():
            text = subprocess.run(["readelf", "-d", target], capture_output=True, text=True).stdout
            for path in re.findall(r"R(?:UN)?PATH.*\[(.*)\]", text):
                for entry in path.split(":"):
                    self.assertRegex(entry, r"^(/|\$ORIGIN)", f"{target}: {path}")

    def plant(self, name):
        """Makes a library that reports when it is loaded."""
        code = ('#include <unistd.h>\n__attribute__((constructor)) static void here(void) '
                '{ write(2, "PLANTED\\n", 8); }\n')
        source = self.write("planted.c", code)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", self.folder / name, source], check=True)

    @unittest.skipIf(shutil.which("cc") is None, "no compiler")
    def test_planted_libraries_are_not_loaded(self):
        needed = subprocess.run(["ldd", PROGRAM], capture_output=True, text=True).stdout
        for name in re.findall(r"^\s*(lib(?:gmp|mpfr|z|tbb|fmt|pugixml)\S*) =>", needed, re.MULTILINE):
            self.plant(name)
        self.plant("collarmesh_cad.so")
        self.plant("collarmesh_hdf5.so")
        self.plant("collarmesh_scotch.so")
        for arguments in ((self.box, "-o", self.out), (self.box, "-o", "a.med"),
                          (self.box, "-o", "a.vtu", "--partitions", "2"), ("info", "missing.step")):
            run = self.run_program(*arguments)
            self.assertNotIn("PLANTED", run.stderr)
        step = self.write("part.step", "ISO-10303-21;\nEND-ISO-10303-21;\n")
        self.assertNotIn("PLANTED", self.run_program("info", step).stderr)
        module = next(iter(pathlib.Path(PROGRAM).parents[1].glob("python/collarmesh*.so")), None)
        if module is not None:
            run = subprocess.run(["/usr/bin/python3", "-c", "import sys; sys.path[:] = [p for p in sys.path if p]; "
                                  f"sys.path.insert(0, {str(module.parent)!r}); import collarmesh"],
                                 cwd=self.folder, capture_output=True, text=True)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertNotIn("PLANTED", run.stderr)


class Memory(HostileTest):
    def test_json_that_is_nested_deeply(self):
        for text in ("[" * 80000 + "]" * 80000,
                     '{"sources": [{"size": 1, "curves": [' + "[" * 80000 + "]" * 80000 + "]}]}",
                     '{"sources": ' + '{"a":' * 80000 + "1" + "}" * 80000 + "}"):
            deep = self.write("deep.json", text)
            self.expect(3, self.box, "-o", self.out, "--size-field", deep, says=["nested"])

    def test_the_budget_covers_reading(self):
        """A file of a megabyte that grows to gigabytes when it is unpacked."""
        import base64
        import struct
        import zlib
        block = 1 << 15
        blocks = 20000
        packed = zlib.compress(bytes(block))
        header = struct.pack(f"<{3 + blocks}Q", blocks, block, 0, *[len(packed)] * blocks)
        data = base64.b64encode(header) + base64.b64encode(packed * blocks)
        count = blocks * block // 24
        (self.folder / "bomb.vtu").write_bytes(
            b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
            b'header_type="UInt64" compressor="vtkZLibDataCompressor"><UnstructuredGrid>'
            + f'<Piece NumberOfPoints="{count}" NumberOfCells="0"><Points>'.encode()
            + b'<DataArray type="Float64" NumberOfComponents="3" format="binary">' + data
            + b'</DataArray></Points></Piece></UnstructuredGrid></VTKFile>\n')
        run = subprocess.Popen([PROGRAM, "convert", self.folder / "bomb.vtu", "-o", self.folder / "o.msh",
                                "--max-memory", "200M"], stderr=subprocess.PIPE, text=True)
        messages = run.stderr.read()
        _, status, usage = os.wait4(run.pid, 0)
        self.assertEqual(os.waitstatus_to_exitcode(status), 5, messages)
        self.assertLess(usage.ru_maxrss * 1024, 1.1 * 200 * 2**20 + 60 * 2**20)

    def test_little_memory(self):
        """With any amount of memory, the run succeeds or ends with exit code 5 (127: the program could not
        even be loaded)."""
        for megabytes in (60, 80, 90, 100, 110, 120, 140, 180, 250, 400):
            with self.subTest(megabytes=megabytes):
                run = subprocess.run([PROGRAM, BRACKET, "-o", self.out, "-q"], capture_output=True, text=True,
                                     preexec_fn=limited(resource.RLIMIT_AS, megabytes << 20))
                if "error while loading shared libraries" in run.stderr:
                    continue
                self.assertIn(run.returncode, (0, 5), run.stderr)
                self.assertEqual(self.out.exists(), run.returncode == 0)
                self.out.unlink(missing_ok=True)
                self.assert_nothing_left()


HOSTILE = pathlib.Path(__file__).resolve().parent / "hostile"


def reads_cad():
    """Returns whether the module for CAD files is there."""
    with tempfile.NamedTemporaryFile(suffix=".step") as empty:
        said = subprocess.run([PROGRAM, "info", empty.name], capture_output=True, text=True).stderr
    return "STEP" in said


def has_open(pid, path):
    """Returns whether a process has this file open."""
    with contextlib.suppress(OSError):
        return str(path.resolve()) in [os.readlink(file) for file in pathlib.Path(f"/proc/{pid}/fd").iterdir()]
    return False


def words_of(pid):
    """Returns the words of a process's status from its state on; nothing if there is no such process."""
    with contextlib.suppress(OSError):
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return []


def state_of(pid):
    """Returns a letter: T means stopped, Z ended, X that there is no such process."""
    return (words_of(pid) or "X")[0]


def has_ended(pid):
    """Returns whether a process has ended, even if nobody has asked for its exit code yet."""
    return state_of(pid) in "ZX"


def cpu_seconds(pid):
    """Returns the CPU time that a process has used so far."""
    words = words_of(pid)
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK") if words else 0


@unittest.skipUnless(reads_cad(), "built without OpenCASCADE")
class CadFilesThatCrash(HostileTest):
    def test_say_file_and_stage(self):
        for path in sorted((HOSTILE / "cad_crash").iterdir()):
            for arguments in (("-o", self.out), None):
                with self.subTest(path=path.name, arguments=arguments):
                    run = self.run_program(path, *arguments) if arguments else self.run_program("info", path)
                    self.assertEqual(run.returncode, 3, run.stderr)
                    self.assertIn(path.name, run.stderr)
                    self.assertRegex(run.stderr, "OpenCASCADE")
                    self.assertEqual([p.name for p in self.folder.iterdir()], ["box.off"])

    def test_that_end_early(self):
        whole = (HOSTILE / "brep_truncated_hang" / "half.brep").read_bytes()
        for length in range(10, len(whole) + 1, 97):
            (self.folder / "part.brep").write_bytes(whole[:length])
            run = self.run_program("info", self.folder / "part.brep", timeout=30)
            self.assertEqual(run.returncode, 3, run.stderr)

    def test_the_child_dies_with_the_program_and_is_told_to_stop(self):
        """OpenCASCADE waits for a pipe without an end in place of a file."""
        endless = self.folder / "endless.brep"
        os.mkfifo(endless)
        keep_open = os.open(endless, os.O_RDWR)
        self.addCleanup(os.close, keep_open)
        for number, code in ((signal.SIGTERM, 6), (signal.SIGINT, 6), (signal.SIGHUP, 6), (signal.SIGKILL, -9)):
            with self.subTest(signal=number):
                run = subprocess.Popen([PROGRAM, endless, "-o", self.out], stderr=subprocess.PIPE, text=True)
                self.addCleanup(run.kill)
                (child,) = wait_for(lambda: children_of(run.pid), "a child")
                wait_for(lambda: has_open(child, endless), "the child reads")
                wait_for(lambda: code < 0 or has_signal(run.pid, "SigCgt", number), "a handler")
                run.send_signal(number)
                messages = run.communicate(timeout=60)[1]
                self.assertEqual(run.returncode, code, messages)
                wait_for(lambda: has_ended(child), "the end of the child")
        self.expect(5, endless, "-o", self.out, "--time-limit", "0.3", says=["time limit"])
        self.expect(5, "info", endless, "--time-limit", "0.3", says=["time limit"])

    def test_a_crash_of_the_child_in_each_stage(self):
        """Whatever kills the child, the program reports it and leaves no files."""
        for number, codes in ((signal.SIGSEGV, (1, 3)), (signal.SIGKILL, (5,))):
            with self.subTest(signal=number):
                killed = [self.crash_of_the_child(number, codes, seconds) for seconds in (0, 0.05, 0.2, 0.4, 0.8)]
                self.assertTrue(killed[0])

    def crash_of_the_child(self, number, codes, seconds):
        """Sends the signal to the child after this much CPU time. Returns whether it was in time."""
        part = HOSTILE / "iges_closed_face" / "sphere.igs"
        run = subprocess.Popen([PROGRAM, part, "-o", self.out, "--size", "0.3"], stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.kill)
        (child,) = wait_for(lambda: children_of(run.pid), "a child")
        wait_for(lambda: has_ended(child) or cpu_seconds(child) >= seconds, "the child works")
        with contextlib.suppress(ProcessLookupError):
            os.kill(child, signal.SIGSTOP)  # so that it does not end before the signal
        wait_for(lambda: state_of(child) in "TZX", "the child stops")
        in_time = state_of(child) == "T"
        if in_time:
            os.kill(child, number)
            os.kill(child, signal.SIGCONT)
        messages = run.communicate(timeout=100)[1]
        self.assertIn(run.returncode, codes if in_time else (0,), messages)
        self.assertEqual(self.out.exists(), not in_time)
        self.out.unlink(missing_ok=True)
        self.assert_nothing_left()
        return in_time

    def test_closed_faces(self):
        for path in sorted((HOSTILE / "iges_closed_face").iterdir()):
            with self.subTest(path=path.name):
                self.expect(0, path, "-o", self.out, writes=True)
                self.out.unlink()


class Regions(HostileTest):
    """No body may be lost without a message."""

    def volumes(self, path, *options):
        report = self.folder / "report.json"
        run = self.run_program(path, "-o", self.out, "--report", report, *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stderr, json.loads(report.read_text())["check"]["region_volumes"]

    def test_a_body_inside_out_beside_another_one(self):
        _, volumes = self.volumes(HOSTILE / "lost_region" / "two_cubes.off")
        self.assertEqual(len(volumes), 2)
        for volume in volumes.values():
            self.assertAlmostEqual(volume, 1, places=9)

    def test_any_facets_turned(self):
        """Two stacked cubes: whichever facets are reversed, there are two bodies."""
        lines = (HOSTILE / "lost_region" / "two_cubes.off").read_text().splitlines()
        for turned in list(range(0, 2048, 37)) + [2047]:
            facets = [line.split() for line in lines[14:25]]
            facets = [[f[0], *reversed(f[1:])] if turned >> i & 1 else f for i, f in enumerate(facets)]
            path = self.write("turned.off", "\n".join(lines[:14] + [" ".join(f) for f in facets]) + "\n")
            run = self.run_program("info", path, "--json")
            regions = json.loads(run.stdout)["complex"]["regions"]
            volumes = [region["volume"] for region in regions]
            self.assertEqual(len(volumes), 2, f"{turned}: {run.stdout}")
            for volume in volumes:
                self.assertAlmostEqual(volume, 1, places=9)

    def test_small_bodies_are_kept_or_told(self):
        for folder in ("small_body", "welded_away"):
            for path in sorted((HOSTILE / folder).iterdir()):
                with self.subTest(path=path.name):
                    messages, volumes = self.volumes(path, "-q", "--time-limit", "60")
                    if len(volumes) < 2:
                        self.assertRegex(messages, r"warning: The body of 6 facets at \(.*is lost")
        _, volumes = self.volumes(HOSTILE / "small_body" / "sm_1e-06_0.off", "-q", "--repair", "none")
        self.assertAlmostEqual(volumes["2"] * 1e18, 1, places=6)


class Judgement(HostileTest):
    def test_an_inverted_tet_is_a_finding(self):
        mesh = self.folder / "box.mesh"
        self.assertEqual(self.run_program(self.box, "-o", mesh, "--size", "0.4").returncode, 0)
        lines = mesh.read_text().splitlines()
        at = lines.index("Tetrahedra") + 2

        def swapped(line):
            a, b, *rest = line.split()
            return " ".join([b, a, *rest])

        self.expect(0, "check", mesh, "--against", self.box)
        for count in (1, 3):
            changed = lines[:at] + [swapped(line) for line in lines[at:at + count]] + lines[at + count:]
            mesh.write_text("\n".join(changed) + "\n")
            self.expect(7, "check", mesh, "--against", self.box)
        tets = int(lines[at - 1])
        mesh.write_text("\n".join(lines[:at] + [swapped(line)
                        for line in lines[at:at + tets]] + lines[at + tets:]) + "\n")
        self.expect(0, "check", mesh, "--against", self.box)  # with another convention


class Repairs(HostileTest):
    def test_t_junctions_filled_by_flat_triangles(self):
        for path in sorted((HOSTILE / "cap_stl").iterdir()):
            with self.subTest(path=path.name):
                self.expect(0, path, "-o", self.out, writes=True)
                self.out.unlink()


class Ends(HostileTest):
    def test_slivers_between_bodies(self):
        """Such bodies are meshed, refused, or end at a budget, which is kept."""
        for path in sorted((HOSTILE / "hang").iterdir()):
            for budget in (("--max-vertices", "20000"), ("--max-memory", "40M")):
                with self.subTest(path=path.name, budget=budget):
                    run = self.run_program(path, "-o", self.out, *budget, timeout=100)
                    self.assertIn(run.returncode, (0, 4, 5), run.stderr)
                    self.assertNotIn("time limit", run.stderr)
                    self.out.unlink(missing_ok=True)

    def test_bodies_far_from_the_origin(self):
        for path in sorted((HOSTILE / "segv_far_from_origin").iterdir()):
            with self.subTest(path=path.name):
                self.expect(4, path, "-o", self.out, "--time-limit", "60", says=["from the origin"])


if __name__ == "__main__":
    unittest.main()
