"""Runs test cases inside FreeCAD and ends it with their result."""

import os
import sys
import traceback
import unittest


def run(*cases):
    """Runs the tests and never returns: FreeCAD imports a script, runs it again after an exception, and exits
    with 0 in any case. The environment variable COLLARMESH_TEST_ONLY may name the only test method to run."""
    try:
        loader = unittest.defaultTestLoader
        loader.testMethodPrefix = os.environ.get("COLLARMESH_TEST_ONLY", "test")
        suite = unittest.TestSuite(loader.loadTestsFromTestCase(case) for case in cases)
        passed = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(suite).wasSuccessful()
    except Exception:
        traceback.print_exc()
        passed = False
    sys.stdout.flush()
    os._exit(0 if passed else 1)
