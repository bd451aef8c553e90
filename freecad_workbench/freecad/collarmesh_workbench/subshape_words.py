"""Replaces patches, curves and regions in the program's messages by FreeCAD's names of faces, edges and
solids."""

import re

KINDS = {"patch": "Face", "curve": "Edge", "region": "Solid"}
_TAGGED = re.compile(rf"\b({'|'.join(KINDS)}) \d+ \(tag (\d+)\)", re.IGNORECASE)


def in_names(text, names):
    """Rewrites a message. `names("Face", 7)` returns the name of the face with that number in the mesh."""
    return _TAGGED.sub(lambda match: names(KINDS[match[1].lower()], int(match[2])), text)


def report_in_names(report, names):
    """Rewrites all messages of a run's report. Adds the names of faces and edges to its lists of layers and of nodes
    off their faces."""
    for holder in (*report["check"]["findings"], *report["complex"]["warnings"], report):
        holder["message"] = in_names(holder["message"], names)
    for holder, key in ((report, "warnings"), (report, "notes"), (report["repair"], "messages")):
        holder[key] = [in_names(text, names) for text in holder[key]]
    for each in (report.get("layers") or {}).get("patches", ()):
        each["name"] = names("Face", each["tag"])
    for each in (report["projection"] or {}).get("exceptions", ()):
        each["name"] = names("Face", each["face"]) if "face" in each else names("Edge", each["edge"])
    for each in (report["second_order"] or {}).get("straightened", ()):
        if each["dimension"] > 0:
            each["name"] = names(("Edge", "Face")[each["dimension"] - 1], each["tag"])
