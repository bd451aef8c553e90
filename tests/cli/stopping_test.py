"""Runs that are stopped before they end: budgets and signals.
Run by ctest with COLLARMESH_PROGRAM set; each class is one ctest.
"""

import json
import os
import signal
import subprocess
import time
import unittest

from program import COORDINATES, MODELS, PROGRAM, ProgramTest


class Budgets(ProgramTest):
    def test_vertices(self):
        self.expect(5, self.box, "-o", self.out, "--size", "0.02", "--max-vertices", "200",
                    says=["the budget of 200 vertices is spent at \\d+ vertices", r"cells, .* MB, after", COORDINATES,
                          "raise max-vertices"])

    def test_memory(self):
        self.expect(5, self.box, "-o", self.out, "--size", "0.01", "--max-memory", "200K",
                    says=["the memory budget of 204800 bytes is spent", COORDINATES, "raise max-memory"])

    def test_memory_has_a_default(self):
        report = self.folder / "report.json"
        self.expect(0, self.box, "-o", self.out, "--report", report, writes=True)
        memory = json.loads(report.read_text())["options"]["max_memory"]
        machine = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        self.assertGreater(memory, 0)
        self.assertLessEqual(memory, machine // 2)
        self.expect(0, self.box, "-o", self.out, "--max-memory", "0", "--report", report, writes=True)
        self.assertIsNone(json.loads(report.read_text())["options"]["max_memory"])

    def test_options_without_an_end(self):
        """Runs that would not terminate with such options end at a budget, after a warning."""
        sphere, bracket = MODELS / "sphere.off", MODELS / "bracket.off"
        for option, value in (("--radius-edge", "1"), ("--distance", "1e-9")):
            with self.subTest(option=option):
                self.expect(5, sphere, "-o", self.out, option, value, "--max-memory", "20M",
                            says=[f"warning: {option} ", COORDINATES, "raise max-memory"])
        self.expect(0, bracket, "-o", self.out, "--planar-tolerance", "0.01", says=["warning: --planar-tolerance"],
                    writes=True)

    def test_time(self):
        self.expect(5, self.box, "-o", self.out, "--size", "0.002", "--time-limit", "3",
                    says=["time limit of 3 s .*stage: refine, .* vertices", COORDINATES, "raise --time-limit"])

    def test_time_limits_every_stage(self):
        endless = self.folder / "endless.off"
        os.mkfifo(endless)  # reading it never ends
        self.expect(5, endless, "-o", self.out, "--time-limit", "0.1", says=["time limit of 0.1 s .*stage: read"])
        self.expect(5, self.box, "-o", self.out, "--time-limit", "1e-6", says=["stage: start"])
        for stage in ("refine", "coarsen", "improve"):
            with self.subTest(stage=stage):
                self.stop_until_the_limit(stage)

    def stop_until_the_limit(self, stage):
        """Stops a run in this stage until its limit has passed: however fast it is, it has no time left then."""
        limit = 1
        process = subprocess.Popen([PROGRAM, self.box, "-o", self.out, "--size", "0.05", "--time-limit", str(limit),
                                    "--progress", "json"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        told, stopped = "", False
        for line in process.stderr:
            told += line
            if f'"{stage}"' in line:
                stopped = True
                process.send_signal(signal.SIGSTOP)
                time.sleep(1.1 * limit)
                process.send_signal(signal.SIGCONT)
                break
        told += process.communicate(timeout=60)[1]
        self.assertTrue(stopped, told)
        self.assertEqual(process.returncode, 5, told)
        self.assertRegex(told, "time limit of 1 s .*stage: ")
        self.assertFalse(self.out.exists())
        self.assert_nothing_left()


class Cancelling(ProgramTest):
    def start_long_run(self):
        process = subprocess.Popen([PROGRAM, self.box, "-o", self.out, "--size", "0.002", "--progress", "json"],
                                   cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        for line in process.stderr:
            progress = json.loads(line)
            if progress["phase"] == "refine" and progress["vertices"] > 100:
                break
        return process

    def test_interrupt_stops(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                process = self.start_long_run()
                process.send_signal(number)
                _, messages = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 6, messages)
                self.assertIn("cancelled", messages)
                self.assertFalse(self.out.exists())
                self.assert_nothing_left()

    def test_interrupt_ends_every_stage(self):
        """An interrupt sets the same flag as the time limit. After a stage that does not check it, the next
        stage would begin."""
        command = [PROGRAM, str(self.box), "-o", str(self.out), "--size", "0.03", "--order", "2", "--progress", "json"]

        def stages(stop_at=None):
            process = subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, text=True)
            self.addCleanup(process.kill)
            begun = []
            for line in process.stderr:
                phase = json.loads(line).get("phase") if line.startswith("{") else None
                if phase and phase not in begun:
                    begun.append(phase)
                    if phase == stop_at:
                        process.send_signal(signal.SIGTERM)
            code = process.wait(timeout=120)
            process.stderr.close()
            return code, begun

        code, every = stages()
        self.assertEqual(code, 0)
        self.out.unlink()
        for stage in ("refine", "coarsen", "improve", "check"):  # stages that take a while
            with self.subTest(stage=stage):
                code, begun = stages(stage)
                self.assertEqual((code, begun[-1]), (6, stage))
                self.assertFalse(self.out.exists())
                self.assert_nothing_left()
        for stage in set(every) - {"refine", "coarsen", "improve", "check"}:
            with self.subTest(stage=stage):
                code, _ = stages(stage)
                self.assertIn(code, (0, 6))  # 6, unless the signal comes too late
                self.assertEqual(self.out.exists(), code == 0)
                self.out.unlink(missing_ok=True)
                self.assert_nothing_left()

    def test_interrupt_at_any_time_leaves_no_half_file(self):
        """Each signal comes after another line of progress, the first one at once."""
        arguments = [PROGRAM, str(self.box), "-o", str(self.out), "--size", "0.05", "--progress", "json"]
        whole = subprocess.run(arguments, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(whole.returncode, 0)
        complete, codes = self.out.stat().st_size, []
        for lines in range(whole.stderr.count("\n") + 1):
            self.out.unlink(missing_ok=True)
            process = subprocess.Popen(arguments, cwd=self.folder, stderr=subprocess.PIPE, text=True)
            self.addCleanup(process.kill)
            for _ in range(lines):
                process.stderr.readline()
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            code = process.returncode
            codes.append(code)
            self.assertIn(code, (0, 6, -signal.SIGINT))
            self.assertEqual(self.out.exists(), code == 0)
            if code == 0:
                self.assertEqual(self.out.stat().st_size, complete)
            self.assert_nothing_left()
        self.assertIn(6, codes)


if __name__ == "__main__":
    unittest.main()
