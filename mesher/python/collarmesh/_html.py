"""A mesh in a notebook: a table of the certificate and the figures."""

import html
from typing import Any, Dict, List, Mapping, Optional, Tuple

from ._types import MeshFigures

_SHOWN = 10  # maximum number of findings shown, and of repairs


def table_of(
    passed: Optional[bool],
    findings: List[str],
    repairs: List[str],
    figures: MeshFigures,
    check: Mapping[str, Any],
) -> str:
    """Returns the HTML. passed: None for a mesh that was not made here."""
    verdict = {True: "every guarantee holds", False: "a guarantee does not hold", None: "not certified"}[passed]
    rows: List[Tuple[str, str]] = [("Certificate", verdict)]
    rows += [("Finding", text) for text in _first(findings)] + [("Repair", text) for text in _first(repairs)]
    rows += [
        ("Cells", _counts(figures)),
        ("Dihedral angles", f"{figures['min_dihedral']:.2f} to {figures['max_dihedral']:.2f} degrees"),
        ("Median edge", f"{figures['median_edge']:.4g}"),
    ]
    kept: Dict[str, Any] = {str(row["number"]): row for row in check.get("kept", {}).get("region_volumes", [])}
    for number, volume in figures["region_volumes"].items():
        text = f"volume {volume:.6g}"
        if number in kept:
            text += f", {kept[number]['percent']:+.2f} % of the input's {kept[number]['input']:.6g}"
        rows.append((figures["region_names"].get(number, f"region_{number}"), text))
    lines = "".join(f"<tr><th style='text-align:left'>{html.escape(head)}</th>"
                    f"<td style='text-align:left'>{html.escape(text)}</td></tr>" for head, text in rows)
    return f"<table><caption>collarmesh.Mesh</caption>{lines}</table>"


def _counts(figures: MeshFigures) -> str:
    counts = [("tetrahedra", figures["tets"]), ("prisms", figures["prisms"]), ("pyramids", figures["pyramids"]),
              ("points", figures["points"]), ("boundary triangles", figures["faces"]),
              ("quadrangles", figures["quads"])]
    layers = ("prisms", "pyramids", "quadrangles")
    return ", ".join(f"{count} {what}" for what, count in counts if count > 0 or what not in layers)


def _first(texts: List[str]) -> List[str]:
    more = len(texts) - _SHOWN
    return texts[:_SHOWN] + ([f"and {more} more"] if more > 0 else [])
