"""The findings of a run, by place: problems, warnings, repairs, nodes off their faces, lower layers. Independent
of the window."""

import dataclasses
import re

PROBLEM, WARNING, REPAIR, OFF_FACE, LAYERS, WORST = "problem", "warning", "repair", "off_face", "layers", "worst"

_NUMBER = r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?"
_POINT = re.compile(rf"\(({_NUMBER}), ({_NUMBER}), ({_NUMBER})\)")
_SUBSHAPE = re.compile(r"\b(?:Solid|Face|Edge|Vertex)[1-9]\d*\b")
COVERED = 0.999  # share of a face's area from which on it counts as covered by layers
_SHAPE_BY_DIMENSION = ("Vertex", "Edge", "Face")


@dataclasses.dataclass
class Place:
    """A finding and its place: at points (mm), on sub-shapes like Face7, or in a tetrahedron."""

    kind: str
    text: str
    points: tuple = ()
    subshapes: tuple = ()
    tetrahedra: object = None  # an array of corners, shape (n, 4, 3)


def told(kind, text, points=()):
    """Returns a Place with a message, and with the points and sub-shapes that it mentions. If it mentions no points,
    `points` are used."""
    found = tuple(tuple(map(float, numbers)) for numbers in _POINT.findall(text))
    return Place(kind, text, found or tuple(map(tuple, points)), tuple(dict.fromkeys(_SUBSHAPE.findall(text))))


def in_error(message):
    """Returns a Place for each line of the message of a run without a mesh."""
    return [told(PROBLEM, line) for line in message.splitlines() if line.strip()]


def in_report(report, warnings=()):
    """Returns the Places of a run with a mesh, each message once. `warnings` are further ones, which the report
    lacks."""
    places = [told(PROBLEM, each["message"], [each["where"]]) for each in report["check"]["findings"]]
    if report["message"] and not report["guarantees_hold"]:
        places.insert(0, told(PROBLEM, report["message"]))
    places += [told(WARNING, text.removeprefix("warning: ")) for text in warnings]
    places += [told(WARNING, each["message"], [each["where"]]) for each in report["complex"]["warnings"]]
    places += [told(WARNING, text) for text in (*report["warnings"], *report["notes"])]
    places += _repairs(report["repair"])
    places += _nodes_off_their_faces(report)
    places += _lower_layers(report.get("layers"))
    return list({(place.kind, place.text): place for place in places}.values())


def _repairs(repair):
    if not repair["repaired"]:
        return []
    return [told(REPAIR, message) for message in repair["messages"]]


def _nodes_off_their_faces(report):
    off = []
    for each in (report["projection"] or {}).get("exceptions", ()):
        name = each.get("name") or (f"Face{each['face']}" if "face" in each else f"Edge{each['edge']}")
        off.append((name, each["where"], each["distance"]))
    for each in (report["second_order"] or {}).get("straightened", ()):
        name = each.get("name") or f"{_SHAPE_BY_DIMENSION[each['dimension']]}{each['tag']}"
        off.append((name, each["where"], each["distance"]))
    return [told(OFF_FACE, f"{name}: {distance:.3g} mm" if distance is not None else name, [where])
            for name, where, distance in off]


def _lower_layers(layers):
    """Returns a Place for each reason why boundary layers are lower than asked for, where they are lowest, and
    one for each face that they do not cover."""
    if not layers:
        return []
    places = [told(LAYERS, f"{each['why']}: {each['nodes']} nodes, down to {100 * each['smallest_share']:.0f}%",
                   [each["where"]])
              for each in layers["reductions"]]
    for each in layers["patches"]:
        if each["covered"] < COVERED * each["area"]:
            covered = 100 * each["covered"] / each["area"]
            places.append(told(LAYERS, f"{each.get('name')}: layers cover {covered:.1f}%"))
    return places
