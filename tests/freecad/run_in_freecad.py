"""Run test cases inside FreeCAD and end it with their verdict."""

import os
import sys
import traceback
import unittest


def run(*cases):
    """FreeCAD imports a script, runs it again after an exception, and ends with 0 whatever happens: so this never
    returns. The environment variable COLLARMESH_TEST_ONLY may name the only test method to run."""
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
