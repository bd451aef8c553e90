"""The user's preferences: the program's path, its number of threads, and the defaults of new meshes."""

import FreeCAD

from .translations import translate


def _stored():
    return FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/collarmesh")


def program():
    """Returns the path of the program; empty: search for it."""
    return _stored().GetString("Program", "")


def threads():
    """Returns the maximum number of threads; 0: all cores."""
    return max(0, _stored().GetInt("Threads", 0))


def improve_level():
    return _stored().GetInt("ImproveLevel", 2)


def improve_levels():
    """Returns the texts for the levels of improvement."""
    return (translate("collarmesh", "none"), translate("collarmesh", "quick"), translate("collarmesh", "good"),
            translate("collarmesh", "best"))


def second_order():
    return _stored().GetBool("SecondOrder", True)


class Page:
    """The page in FreeCAD's preferences, group FEM."""

    def __init__(self, _parent=None):
        from PySide import QtGui

        self.form = QtGui.QWidget()
        self.form.setObjectName("collarmesh_preferences")
        self.form.setWindowTitle("collarmesh")
        self.program = QtGui.QLineEdit()
        self.program.setObjectName("collarmesh_preferences_program")
        self.program.setPlaceholderText(translate("collarmesh", "found by itself"))
        browse = QtGui.QPushButton("...")
        browse.clicked.connect(self._browse)
        path = QtGui.QHBoxLayout()
        path.addWidget(self.program)
        path.addWidget(browse)
        self.threads = QtGui.QSpinBox()
        self.threads.setObjectName("collarmesh_preferences_threads")
        self.threads.setRange(0, 1024)
        self.threads.setSpecialValueText(translate("collarmesh", "as many as cores"))
        self.threads.setToolTip(translate("collarmesh", "Largest number of threads; the result does not depend on it"))
        self.improve = QtGui.QComboBox()
        self.improve.setObjectName("collarmesh_preferences_improve")
        self.improve.addItems(improve_levels())
        self.second_order = QtGui.QCheckBox(translate("collarmesh", "second order"))
        self.second_order.setObjectName("collarmesh_preferences_second_order")
        rows = QtGui.QFormLayout(self.form)
        rows.addRow(translate("collarmesh", "Program collarmesh"), path)
        rows.addRow(translate("collarmesh", "Threads"), self.threads)
        rows.addRow(translate("collarmesh", "Improvement of new meshes"), self.improve)
        rows.addRow(translate("collarmesh", "Elements of new meshes"), self.second_order)

    def _browse(self):
        from PySide import QtGui

        title = translate("collarmesh", "The program collarmesh")
        chosen = QtGui.QFileDialog.getOpenFileName(self.form, title, self.program.text())[0]
        if chosen:
            self.program.setText(chosen)

    def loadSettings(self):
        self.program.setText(program())
        self.threads.setValue(threads())
        self.improve.setCurrentIndex(improve_level())
        self.second_order.setChecked(second_order())

    def saveSettings(self):
        _stored().SetString("Program", self.program.text().strip())
        _stored().SetInt("Threads", self.threads.value())
        _stored().SetInt("ImproveLevel", self.improve.currentIndex())
        _stored().SetBool("SecondOrder", self.second_order.isChecked())
