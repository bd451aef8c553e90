"""The part of the panel that tells what came: counts, guarantees and a chart of the angles."""

from PySide import QtCore, QtGui

from .angle_chart import AngleChart
from .guarantees import guarantees
from .size_presets import duration_text
from .translations import translate

GOOD, BAD, CARE = "#2e8b57", "#c83c3c", "#b07010"


class ResultSection(QtGui.QWidget):
    def __init__(self):
        super().__init__()
        self.message = _label("collarmesh_message")
        self.counts = _label("collarmesh_counts")
        self.lines = _label("collarmesh_guarantees")
        self.chart = AngleChart()
        layout = QtGui.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for widget in (self.message, self.counts, self.lines, self.chart):
            layout.addWidget(widget)
        self.clear()

    def clear(self):
        for widget in (self.message, self.counts, self.lines, self.chart):
            widget.hide()

    def say(self, text, colour):
        """A message above everything else."""
        self.message.setText(f'<span style="color:{colour}">{_escaped(text)}</span>')
        self.message.show()

    def show_outcome(self, outcome):
        self.clear()
        if outcome.cancelled:
            self.say(translate("collarmesh", "Cancelled; the mesh is the one from before."), CARE)
        elif outcome.report is None:
            self.say(translate("collarmesh", "No mesh is made; the list says why."), BAD)
        else:
            self._show_report(outcome.report)
            if outcome.part_changed:
                text = translate("collarmesh", "The part was changed while it was meshed: this is the mesh of the part as "
                                               "it was before. Mesh it again.")
                self.say(text, CARE)

    def _show_report(self, report):
        mesh = report["mesh"]
        self.counts.setText(counts_text(report))
        self.lines.setText(guarantees_text(report))
        self.chart.show_report(mesh)
        for widget in (self.counts, self.lines, self.chart):
            widget.show()


def counts_text(report):
    """What was made, for people."""
    mesh = report["mesh"]
    counts = translate("collarmesh", "<b>{tets}</b> tetrahedra, <b>{nodes}</b> nodes, <b>{faces}</b> faces")
    angles = translate("collarmesh", "dihedral angles from {smallest}° to {largest}°, in {time}")
    return (counts.format(tets=_exact(mesh["tets"]), nodes=_exact(mesh["points"]), faces=_exact(mesh["faces"])) + "<br>"
            + angles.format(smallest=f"{mesh['min_dihedral']:.1f}", largest=f"{mesh['max_dihedral']:.1f}",
                            time=_time(report["seconds"]["total"])))


def _time(seconds):
    return translate("collarmesh", "{n} s").format(n=f"{seconds:.1f}") if seconds < 10 else duration_text(seconds)


def guarantees_text(report):
    lines = []
    if report["guarantees_hold"]:
        lines.append(_line(GOOD, translate("collarmesh", "<b>Every guarantee holds</b>")))
    else:
        lines.append(_line(BAD, translate("collarmesh", "<b>A guarantee is missed</b>")))
    for text, broken in guarantees(report):
        count = f" ({len(broken)})" if broken else ""
        lines.append(_line(BAD if broken else GOOD, ("✗ " if broken else "✓ ") + _escaped(text) + count))
    return "<br>".join(lines)


def _line(colour, text):
    return f'<span style="color:{colour}">{text}</span>'


def _exact(count):
    return f"{count:,}".replace(",", "\u202f")


def _escaped(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace("\n", "<br>")


def _label(name):
    label = QtGui.QLabel()
    label.setObjectName(name)
    label.setWordWrap(True)
    label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
    return label
