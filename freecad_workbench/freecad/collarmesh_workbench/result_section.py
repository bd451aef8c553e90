"""The part of the panel that shows the result: counts, guarantees and a chart of the angles."""

from PySide import QtGui

from . import colours, widgets
from .angle_chart import AngleChart
from .guarantees_view import GuaranteesView, escaped
from .numbers_typed import grouped, shown
from .regions_table import RegionsTable
from .size_presets import duration_text
from .translations import translate


class ResultSection(QtGui.QWidget):
    def __init__(self):
        super().__init__()
        self.out_of_date = widgets.label("collarmesh_out_of_date", selectable=True)
        self.message = widgets.label("collarmesh_message", selectable=True)
        self.counts = widgets.label("collarmesh_counts", selectable=True)
        self.regions = RegionsTable()
        self.guarantees = GuaranteesView()
        self.chart = AngleChart()
        self.out_of_date.hide()
        self.out_of_date.setText(_coloured(colours.CARE, translate(
            "collarmesh", "This mesh is out of date: the shape, a size or a setting has changed since it was made. "
            "Mesh it again.")))
        widgets.stack(self, self.out_of_date, self.message, self.counts, self.regions, self.guarantees, self.chart)
        self.clear()

    def clear(self):
        for widget in (self.message, self.counts, self.regions, self.guarantees, self.chart):
            widget.hide()

    def say(self, text, kind):
        """Shows a message above everything else; `kind` is one of colours."""
        self.message.setText(_coloured(kind, text))
        self.message.show()

    def show_out_of_date(self, out_of_date):
        """Shows whether the mesh is out of date."""
        self.out_of_date.setVisible(out_of_date)
        self.guarantees.show_out_of_date(out_of_date)

    def show_outcome(self, outcome):
        self.clear()
        if outcome.cancelled:
            self.say(translate("collarmesh", "Cancelled; the previous mesh is kept."), colours.CARE)
        elif outcome.report is None:
            self.say(translate("collarmesh", "No mesh is made; the list says why."), colours.BAD)
        else:
            self._show_report(outcome.report)
            if outcome.part_changed:
                text = translate("collarmesh",
                                 "The part was changed while it was meshed: this is the mesh of the part as "
                                 "it was before. Mesh it again.")
                self.say(text, colours.CARE)

    def _show_report(self, report):
        self.counts.setText(counts_text(report))
        self.regions.show_report(report)
        if report["repair"]["filled"]:
            self.say(filled_text([each["area"] for each in report["repair"]["filled"]]), colours.CARE)
        self.guarantees.show_report(report)
        self.chart.show_report(report)
        self.counts.show()
        self.chart.setVisible(bool(self.chart.series))


def counts_text(report):
    """Returns the counts of the mesh, as text."""
    mesh = report["mesh"]
    dimension, time = report["options"]["dimension"], _time(report["seconds"]["total"])
    if dimension == 1:
        counts = translate("collarmesh", "<b>{lines}</b> lines, <b>{nodes}</b> nodes, in {time}")
        return counts.format(lines=grouped(mesh["edges"]), nodes=grouped(mesh["points"]), time=time)
    if dimension == 2:
        triangles = report["check"]["triangles"]
        counts = translate("collarmesh", "<b>{triangles}</b> triangles, <b>{nodes}</b> nodes")
        angles = translate("collarmesh", "angles from {smallest}° to {largest}°, in {time}")
        return (counts.format(triangles=grouped(mesh["faces"]), nodes=grouped(mesh["points"])) + "<br>"
                + angles.format(smallest=shown(f"{triangles['min_angle']:.1f}"),
                                largest=shown(f"{triangles['max_angle']:.1f}"), time=time))
    counts = translate("collarmesh", "<b>{tets}</b> tetrahedra, <b>{nodes}</b> nodes, <b>{faces}</b> faces")
    layers = "<br>" + layers_text(report["layers"]) if report.get("layers") else ""
    angles = translate("collarmesh", "dihedral angles from {smallest}° to {largest}°, in {time}")
    return (counts.format(tets=grouped(mesh["tets"]), nodes=grouped(mesh["points"]), faces=grouped(mesh["faces"]))
            + "<br>" + angles.format(smallest=shown(f"{mesh['min_dihedral']:.1f}"),
                                     largest=shown(f"{mesh['max_dihedral']:.1f}"), time=time) + layers)


def layers_text(layers):
    """Returns text on the numbers of elements in boundary layers, and on the share of the faces that the layers
    cover."""
    text = translate("collarmesh", "Layers: <b>{prisms}</b> prisms, {pyramids} pyramids and {tets} tetrahedra cover "
                                   "{percent}% of the faces")
    return text.format(prisms=grouped(layers["prisms"]), pyramids=grouped(layers["pyramids"]),
                       tets=grouped(layers["tets"]), percent=shown(f"{100 * layers['coverage']:.1f}"))


def filled_text(areas):
    """Returns text on the holes of the shape that repair has filled; areas in mm²."""
    if len(areas) == 1:
        text = translate("collarmesh", "A hole of the shape is filled, with {area} mm²; the list has its place.")
    else:
        text = translate("collarmesh",
                         "{count} holes of the shape are filled, the largest with {area} mm²; the list has "
                         "their places.")
    return text.format(count=len(areas), area=shown(f"{max(areas):.4g}"))


def _time(seconds):
    if seconds >= 10:
        return duration_text(seconds)
    return translate("collarmesh", "{n} s").format(n=shown(f"{seconds:.1f}"))


def _coloured(kind, text):
    return f'<span style="{colours.css(kind)}">{escaped(text)}</span>'
