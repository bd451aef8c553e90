"""Every text of the add-on has a German translation, and the compiled files agree with their sources. Run by
run.py."""

import pathlib
import string
import sys
import unittest

from PySide import QtCore

HERE = pathlib.Path(__file__).resolve().parent
TRANSLATIONS = HERE.parents[1] / "freecad_workbench" / "translations"
sys.path[:0] = [str(HERE), str(TRANSLATIONS)]
import run_in_freecad  # noqa: E402
import update  # noqa: E402

FILES = sorted(TRANSLATIONS.glob("collarmesh_*.ts"))


def fields(text):
    """Returns the names in braces."""
    return sorted(name for _, name, _, _ in string.Formatter().parse(text) if name is not None)


class Translations(unittest.TestCase):
    def test_german_is_there(self):
        self.assertIn("collarmesh_de.ts", [path.name for path in FILES])
        self.assertGreater(len(update.texts()), 150)

    def test_every_text_has_a_translation(self):
        for path in FILES:
            untranslated, without_text = update.missing(path)
            self.assertEqual(untranslated, [], f"{path.name}: translate these (translations/update.py)")
            self.assertEqual(
                without_text, [], f"{path.name}: no source has these any more (translations/update.py)"
            )

    def test_fields_are_kept(self):
        for path in FILES:
            for (_, text), translation in update.read(path).items():
                if "{" in text or "{" in (translation or ""):
                    self.assertEqual(fields(translation), fields(text), text)

    def test_compiled_files_are_up_to_date(self):
        for path in FILES:
            translator = QtCore.QTranslator()
            self.assertTrue(translator.load(str(path.with_suffix(".qm"))), path)
            for (context, text), translation in update.read(path).items():
                self.assertEqual(
                    translator.translate(context, text), translation, "run translations/update.py"
                )

    def test_texts_that_are_no_constants_are_refused(self):
        with self.assertRaises(ValueError):
            update.texts_in('translate("collarmesh", f"{x} mm")')
        self.assertEqual(update.texts_in('translate("collarmesh", each.title)'), set())
        self.assertEqual(
            update.texts_in('doc("A" "B"); mark("c", "d")'), {("App::Property", "AB"), ("c", "d")}
        )


run_in_freecad.run(Translations)
