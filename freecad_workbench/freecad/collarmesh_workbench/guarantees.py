"""The guarantees of a mesh, as text, from the report of a run."""

from .translations import translate


def guarantees(report):
    """Returns [(text, messages of violations)]; no messages if the guarantee holds."""
    groups = {1: _groups_of_lines, 2: _groups_of_triangles, 3: _groups}[report["options"]["dimension"]]()
    if report["options"]["order"] != 2:
        groups = groups[:-1]
    if report["split"]:
        groups.append((translate("collarmesh", "Solids that are kept apart share no node, and their faces fit"),
                       ("split_nodes", "split_pairs", "split_sectors", "split_measures")))
    if report.get("periodic"):
        groups.append((translate("collarmesh", "Periodic faces have the same nodes, edges and triangles"),
                       ("periodic_motion", "periodic_nodes", "periodic_places", "periodic_faces", "periodic_edges",
                        "periodic_corners")))
    if report.get("layers"):
        groups += _groups_of_layers()
    if report.get("interior_nodes"):
        groups.append((translate("collarmesh", "Each element has a node inside of its solid"), ("interior_node",)))
    findings = report["check"]["findings"]
    known = {name for _, names in groups for name in names}
    lines = [(text, [f["message"] for f in findings if f["guarantee"] in names]) for text, names in groups]
    others = [f["message"] for f in findings if f["guarantee"] not in known]
    if others:
        lines.append((translate("collarmesh", "The mesh is sound"), others))
    return lines


def _curved():
    return (translate("collarmesh", "Curved elements are not inverted"),
            ("mid_nodes", "mid_node_distance", "positive_jacobian"))


def _groups_of_layers():
    return [
        (translate("collarmesh", "Elements of layers are not inverted and meet in whole sides"),
         ("layer_arrays", "layer_jacobian", "layer_conforming", "layer_sides", "layer_mid_nodes")),
        (translate("collarmesh", "Layers keep the faces and the volumes of solids"), ("layer_volume", "layer_walls")),
        (translate("collarmesh", "Tetrahedra beside layers have no small or large angle"), ("core_angles",)),
    ]


def _groups_of_triangles():
    return [
        (translate("collarmesh", "The mesh covers the surface: every face, edge and corner is kept"),
         ("conforming", "curve_cover", "curve_distance", "curve_present", "patch_area", "patch_border",
          "patch_distance", "patch_manifold", "patch_plane", "patch_present", "vertex_feature", "vertex_present",
          "listed_edges")),
        (translate("collarmesh", "Triangles of a solid look outwards, those of a surface are turned alike"),
         ("patch_orientation", "shell_orientation")),
        (translate("collarmesh", "Elements name the shape's faces and edges that they lie on"),
         ("curve_tag", "patch_tag")),
        (translate("collarmesh", "Triangles have no small or large angle"), ("triangle_angles",)),
        _curved(),
    ]


def _groups_of_lines():
    return [
        (translate("collarmesh", "The mesh follows every edge from end to end"),
         ("curve_cover", "curve_distance", "curve_present", "vertex_feature", "vertex_present", "listed_edges")),
        (translate("collarmesh", "Elements name the shape's edges that they lie on"), ("curve_tag",)),
        _curved(),
    ]


def _groups():
    """Returns [(text, the certificate's names of the guarantees)] for a mesh of tetrahedra."""
    return [
        (translate("collarmesh", "The mesh fills the shape: every face, edge and corner is kept"),
         ("conforming", "watertight", "curve_cover", "curve_distance", "patch_area", "patch_border", "patch_distance",
          "patch_manifold", "patch_orientation", "patch_plane", "vertex_feature", "vertex_present", "listed_edges",
          "listed_faces")),
        (translate("collarmesh", "Each solid has its volume, no element is inverted"),
         ("region_volume", "volume_kept", "thickness_kept", "region_tag", "positive_volume", "distinct_tets")),
        (translate("collarmesh", "Elements name the shape's faces and edges that they lie on"),
         ("curve_tag", "patch_tag", "patch_regions", "face_regions")),
        (translate("collarmesh", "Circumradius / shortest edge is bounded"), ("radius_edge",)),
        (translate("collarmesh", "Thin elements have no small or large angle"), ("thin_angles",)),
        (translate("collarmesh", "Collars have no large angle"),
         ("collar_cells", "collar_centre", "collar_dihedral", "collar_disjoint", "collar_gap")),
        _curved(),
    ]
