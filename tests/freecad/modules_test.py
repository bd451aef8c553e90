"""The add-on's modules: no circle of imports, and none that is hidden in a function.

    modules_test.py
"""

import ast
import pathlib
import unittest

SOURCES = pathlib.Path(__file__).resolve().parents[2] / "freecad_workbench" / "freecad" / "collarmesh_workbench"


def imports(tree):
    """Returns the add-on's modules that a part of a source imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            yield from [node.module] if node.module else [each.name for each in node.names]


class Modules(unittest.TestCase):
    def setUp(self):
        sources = {path.stem: ast.parse(path.read_text(encoding="utf-8")) for path in SOURCES.glob("*.py")}
        self.package = sources.pop("__init__")  # FreeCAD loads it before anything can be imported
        self.sources = sources
        self.imported = {name: set(imports(tree)) for name, tree in sources.items()}

    def test_no_circle(self):
        """If modules that import no remaining module are removed again and again, none is left."""
        left = dict(self.imported)
        while free := [name for name in left if not left[name] & left.keys()]:
            for name in free:
                del left[name]
        self.assertEqual({name: names & left.keys() for name, names in left.items()}, {})

    def test_no_import_in_a_function(self):
        functions = [(name, node) for name, tree in self.sources.items() for node in ast.walk(tree)
                     if isinstance(node, (ast.FunctionDef, ast.Lambda))]
        self.assertGreater(len(functions), 200)
        self.assertEqual([(name, list(imports(node))) for name, node in functions if list(imports(node))], [])

    def test_only_modules_that_freecad_loads_observe(self):
        """Importing a module only defines names."""
        for name, tree in self.sources.items():
            calls = [ast.unparse(node) for node in tree.body if isinstance(
                node, ast.Expr) and isinstance(node.value, ast.Call)]
            self.assertTrue(name in ("init", "init_gui") or not calls, f"{name}: {calls}")


if __name__ == "__main__":
    unittest.main()
