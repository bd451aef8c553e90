"""The panel in which a mesh is made: sizes, progress, cancel, messages and a summary."""

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

from . import mesh_object, worst_elements
from .program import MesherError, as_warning

FIELDS = (
    ("CharacteristicLengthMax", "Size"),
    ("CharacteristicLengthMin", "Least size"),
    ("MeshSizeFromCurvature", "Per circle"),
    ("ElementsAcrossGap", "Across gaps"),
    ("SurfaceDistance", "Distance"),
    ("RadiusEdgeRatio", "Radius-edge"),
    ("CreaseAngle", "Crease angle"),
    ("CollarAngle", "Collar angle"),
    ("ImproveLevel", "Improvement"),
)


class MeshTaskPanel:
    """Runs the mesher as a process of its own, so that FreeCAD stays alive and a run can be cancelled. The
    object's mesh is replaced when a run has ended well, and only then."""

    def __init__(self, obj):
        self.object = obj
        self.job = None
        self.process = None
        self.highlight = None
        self.form = QtGui.QWidget()
        self.form.setObjectName("collarmesh_panel")
        self.form.setWindowTitle("Mesh by collarmesh")
        self.form.setWindowIcon(QtGui.QIcon(obj.ViewObject.Proxy.getIcon()))
        rows = QtGui.QFormLayout()
        self.fields = {name: self._field(rows, name, text) for name, text in FIELDS}
        self.order = QtGui.QComboBox()
        self.order.setObjectName("collarmesh_ElementOrder")
        self.order.addItems(mesh_object.ORDERS)
        self.order.setCurrentIndex(mesh_object.ORDERS.index(obj.ElementOrder))
        rows.addRow("Order", self.order)
        self.run_button = QtGui.QPushButton("Mesh")
        self.run_button.setObjectName("collarmesh_run")
        self.run_button.clicked.connect(self.start)
        self.cancel_button = QtGui.QPushButton("Cancel")
        self.cancel_button.setObjectName("collarmesh_cancel")
        self.cancel_button.setEnabled(False)
        self.cancel_button.clicked.connect(self.cancel)
        self.bar = QtGui.QProgressBar()
        self.bar.setObjectName("collarmesh_progress")
        self.bar.setRange(0, 1000)
        self.log = QtGui.QPlainTextEdit()
        self.log.setObjectName("collarmesh_log")
        self.log.setReadOnly(True)
        self.worst_box = QtGui.QCheckBox("Show the worst elements")
        self.worst_box.setObjectName("collarmesh_worst")
        self.worst_box.toggled.connect(self.show_worst)
        buttons = QtGui.QHBoxLayout()
        buttons.addWidget(self.run_button)
        buttons.addWidget(self.cancel_button)
        layout = QtGui.QVBoxLayout(self.form)
        layout.addLayout(rows)
        layout.addLayout(buttons)
        layout.addWidget(self.bar)
        layout.addWidget(self.log)
        layout.addWidget(self.worst_box)

    def _field(self, rows, name, text):
        value = getattr(self.object, name)
        field = QtGui.QLineEdit(getattr(value, "UserString", str(value)))
        field.setObjectName("collarmesh_" + name)
        field.setToolTip(self.object.getDocumentationOfProperty(name))
        field.setMinimumWidth(60)
        rows.addRow(text, field)
        return field

    def _store(self):
        """The fields into the properties. Raises MesherError."""
        self.object.ElementOrder = self.order.currentText()
        for name, field in self.fields.items():
            current = getattr(self.object, name)
            try:
                if hasattr(current, "Value"):
                    setattr(self.object, name, FreeCAD.Units.Quantity(field.text()))
                else:
                    setattr(self.object, name, type(current)(field.text()))
            except (ValueError, OSError, TypeError) as error:
                raise MesherError(f"{name}: '{field.text()}' is no value for it ({error}).") from error

    def start(self):
        if self.process is not None:
            return
        self.log.clear()
        self.worst_box.setChecked(False)
        self.bar.setValue(0)
        try:
            self._store()
            self.job = mesh_object.start(self.object)
        except MesherError as error:
            self.say(str(error))
            return
        for warning in self.job.messages:
            self.say(warning)
        self.process = QtCore.QProcess()
        self.process.setReadChannel(QtCore.QProcess.StandardError)
        self.process.readyReadStandardError.connect(self._read)
        self.process.finished.connect(self._finished)
        self.process.setStandardInputFile(QtCore.QProcess.nullDevice())
        self.run_button.setEnabled(False)
        self.cancel_button.setEnabled(True)
        self.cancelled = False
        self.process.start(self.job.command[0], self.job.command[1:])
        if not self.process.waitForStarted():
            self.say(f"{self.job.command[0]} cannot be started: {self.process.errorString()}")
            self._end()

    def cancel(self):
        if self.process is not None:
            self.cancelled = True
            self.process.kill()

    def _read(self):
        while self.process is not None and self.process.canReadLine():
            line = bytes(self.process.readLine()).decode(errors="replace")
            step = self.job.heard(line)
            if step:
                self.bar.setValue(int(1000 * step.fraction))
                self.bar.setFormat(f"{step.phase} %p%")
            elif line.strip():
                said = self.job.messages[-1]
                self.say(as_warning(said) or said)

    def _finished(self, exit_code, _status=None):
        self._read()
        try:
            if self.cancelled:
                self.say("Cancelled; the mesh is the one from before.")
            else:
                report = mesh_object.finish(self.object, self.job, exit_code)
                self.bar.setValue(1000)
                self.bar.setFormat("done")
                self.say(summary(report))
                self.object.Document.recompute()
        except MesherError as error:
            self.log.clear()
            self.say(str(error))
            self.bar.setFormat("failed")
        finally:
            self._end()

    def _end(self):
        self.job.__exit__()
        self.job = None
        process, self.process = self.process, None
        process.deleteLater()
        self.run_button.setEnabled(True)
        self.cancel_button.setEnabled(False)

    def show_worst(self, shown):
        """Mark the tetrahedra with the smallest dihedral angles in the view, and say where they are."""
        if self.highlight is not None:
            self.highlight.remove()
            self.highlight = None
        if not shown or self.object.FemMesh.VolumeCount == 0:
            return
        numbers, angles, corners = worst_elements.worst(self.object.FemMesh)
        self.highlight = worst_elements.Highlight(self.object.ViewObject, corners)
        x, y, z = corners[0].mean(axis=0)
        self.say(f"The {len(numbers)} worst elements are red: dihedral angles from {angles[0]:.1f} (element {numbers[0]} "
                 f"at ({x:.3g}, {y:.3g}, {z:.3g})) to {angles[-1]:.1f} degrees")  # fmt: skip

    def say(self, text):
        self.log.appendPlainText(text)

    def getStandardButtons(self):
        return int(QtGui.QDialogButtonBox.Close)

    def reject(self):
        self.cancel()
        self.worst_box.setChecked(False)
        FreeCADGui.ActiveDocument.resetEdit()
        return True


def summary(report):
    """A few lines on a mesh."""
    mesh = report["mesh"]
    lines = [
        f"{mesh['tets']} tetrahedra, {mesh['points']} nodes",
        f"dihedral angles {mesh['min_dihedral']:.1f} to {mesh['max_dihedral']:.1f} degrees",
        histogram(mesh["histograms"]["min_dihedral"]),
    ]
    off = report["projection"]["exceptions"]
    lines += [f"warning: {each['message']}" for each in report["complex"]["warnings"]]
    lines += [f"warning: {note}" for note in report["notes"]]
    if off:
        where = sorted({f"Face{e['face']}" if "face" in e else f"Edge{e['edge']}" for e in off})
        lines.append(f"{len(off)} boundary nodes stay off the exact shape, at {', '.join(where)}")
    straightened = (report["second_order"] or {}).get("straightened", ())
    if straightened:
        where = sorted({f"{('Edge', 'Face')[node['dimension'] - 1]}{node['tag']}" for node in straightened})
        lines.append(f"{len(straightened)} nodes amid edges stay off the exact shape, at {', '.join(where)}")
    lines.append("every guarantee holds" if report["guarantees_hold"] else "a guarantee is missed, see above")
    return "\n".join(lines)


def histogram(counts):
    """Smallest dihedral angles, a line of text for each bin that is not empty."""
    total = max(1, sum(counts["tets"]))
    width = counts["bin_width"]
    return "\n".join(
        f"  {i * width:3d} to {(i + 1) * width:3d}: {100 * n / total:5.1f}% " + "#" * round(20 * n / total)
        for i, n in enumerate(counts["tets"])
        if n
    )
