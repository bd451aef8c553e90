"""Output in notebooks and terminals: progress, predictions, tables, types."""

import contextlib
import io
import re
import typing
import unittest

import collarmesh
import collarmesh._types as types
import numpy

from module_test import MODELS, box

CUBE = box((0, 0, 0), (1, 1, 1))


class Progress(unittest.TestCase):
    def test_the_end_is_one(self):
        for size in (0.5, 0.05):
            seen = []
            collarmesh.mesh(CUBE, size=size, progress=lambda stage, part: seen.append(part))
            self.assertEqual(seen[-1], 1)
            self.assertEqual(seen, sorted(seen))
            self.assertEqual(seen.count(1), 1)

    def test_a_bar(self):
        for show, text in ((True, r"\r#{10,} 100 % \w+ *\n$"), (False, "^$"), (None, "^$")):
            said = io.StringIO()
            with contextlib.redirect_stderr(said):
                collarmesh.mesh(CUBE, size=0.3, progress=show)
            self.assertRegex(said.getvalue(), text)
        said = io.StringIO()
        with contextlib.redirect_stderr(said), self.assertRaises(collarmesh.Error):
            collarmesh.mesh(MODELS / "missing.off", progress=True)
        self.assertEqual(said.getvalue()[-1], "\n")


class Predictions(unittest.TestCase):
    def test_tets_are_predicted_and_not_made(self):
        coarse, fine = collarmesh.predict(CUBE, sizes=[0.3, 0.1])
        self.assertEqual((coarse["size"], fine["size"]), (0.3, 0.1))
        made = len(collarmesh.mesh(CUBE, size=0.1).tets)
        self.assertTrue(0.5 < fine["tets"] / made < 2, (fine, made))
        self.assertGreater(fine["tets"], 8 * coarse["tets"])
        self.assertGreater(fine["seconds"], 0)

    def test_options_count_and_mistakes_are_told(self):
        (plain,), (refined,), (by_place,) = (
            collarmesh.predict(MODELS / "box.off", sizes=[0.5], **more)
            for more in ({}, {"patch_size": {1: 0.05}}, {"size_field": lambda x, y, z: 0.1}))
        self.assertGreater(refined["tets"], 2 * plain["tets"])
        self.assertGreater(by_place["tets"], 20 * plain["tets"])
        with self.assertRaises(collarmesh.OptionError):
            collarmesh.predict(CUBE, sizes=[-1])


class Tables(unittest.TestCase):
    def test_a_mesh_shows_its_certificate(self):
        mesh = collarmesh.mesh(CUBE, size=0.4)
        page = mesh._repr_html_()
        self.assertIn("every guarantee holds", page)
        self.assertIn(f"{len(mesh.tets)} tetrahedra", page)
        self.assertRegex(page, r"region_1</th><td[^>]*>volume 1, \+0\.00 % of the input&#x27;s 1<")
        foreign = collarmesh.Mesh(mesh.points, mesh.tets, names={3: {1: "<steel>"}})._repr_html_()
        self.assertIn("not certified", foreign)
        self.assertIn("&lt;steel&gt;", foreign)
        points, triangles, tags = CUBE
        repaired = collarmesh.mesh((points, triangles[:-1], tags[:-1]), size=0.5)._repr_html_()
        self.assertIn("hole of 3 edges", repaired)


class Types(unittest.TestCase):
    def require_type(self, value, kind, where):
        origin = typing.get_origin(kind)
        if typing.is_typeddict(kind):
            for key, inner in typing.get_type_hints(kind).items():
                if key in kind.__required_keys__ or key in value:
                    self.assertIn(key, value, where)
                    self.require_type(value[key], inner, f"{where}.{key}")
        elif origin is list:
            for each in value:
                self.require_type(each, typing.get_args(kind)[0], where)
        elif origin is dict:
            for each in value.values():
                self.require_type(each, typing.get_args(kind)[1], where)
        elif origin is typing.Union:
            if value is not None:
                self.require_type(value, typing.get_args(kind)[0], where)
        else:
            self.assertIsInstance(value, (int, float) if kind is float else kind, where)

    def test_dicts_are_as_their_types_say(self):
        mesh = collarmesh.mesh(CUBE, size=0.5)
        self.require_type(mesh.info(), types.MeshInfo, "mesh")
        self.require_type(collarmesh.info(mesh), types.Info, "info")
        found = collarmesh.info(MODELS / "bracket.off")
        self.assertEqual(set(found), {"complex", "repair"})
        self.require_type(found, types.Info, "info")
        self.assertTrue(found["complex"]["patch_list"])
        self.require_type(collarmesh.predict(CUBE, sizes=[0.5])[0], types.Prediction, "prediction")
        hints = typing.get_type_hints(collarmesh.info)
        self.assertIs(hints["return"], types.Info)


if __name__ == "__main__":
    unittest.main()
