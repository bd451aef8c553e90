"""The part of the panel that shows which guarantees a mesh keeps."""

from PySide import QtGui

from . import colours, widgets
from .fold import Fold
from .guarantees import guarantees
from .translations import translate


class GuaranteesView(QtGui.QWidget):
    """A line that unfolds to the list of guarantees. It is unfolded at first if one is missed."""

    def __init__(self):
        super().__init__()
        self._report, self._out_of_date = None, False
        self.lines = widgets.label("collarmesh_guarantees", selectable=True)
        self.fold = Fold(self.lines)
        self.fold.setObjectName("collarmesh_guarantees_fold")
        widgets.stack(self, self.fold, self.lines).setSpacing(2)

    def show_report(self, report):
        self._report, self._out_of_date = report, False
        self.fold.setChecked(not report["guarantees_hold"])
        self._write()
        self.show()

    def show_out_of_date(self, out_of_date):
        """Shows the guarantees in grey if the mesh is out of date."""
        if self._report is not None and out_of_date != self._out_of_date:
            self._out_of_date = out_of_date
            self._write()

    def _write(self):
        holds = self._report["guarantees_hold"]
        self.fold.setText(self._heading(holds))
        self.fold.setStyleSheet(f"{self._css(holds)}; font-weight: bold")
        self.lines.setText("<br>".join(self._line(*each) for each in guarantees(self._report)))

    def _heading(self, holds):
        if self._out_of_date:
            return (translate("collarmesh", "Every guarantee held when the mesh was made") if holds else
                    translate("collarmesh", "A guarantee was missed when the mesh was made"))
        return (translate("collarmesh", "Every guarantee holds") if holds else
                translate("collarmesh", "A guarantee is missed"))

    def _css(self, holds):
        return colours.css(colours.FAINT if self._out_of_date else colours.GOOD if holds else colours.BAD)

    def _line(self, text, broken):
        count = f" ({len(broken)})" if broken else ""
        mark = "✗" if broken else "✓"
        return f'<span style="{self._css(not broken)}">{mark} {escaped(text)}{count}</span>'


def escaped(text):
    """Escapes text for labels."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace("\n", "<br>")
