"""Reports as HTML: what they hold, and what a browser makes of them.

Run by ctest with COLLARMESH_PROGRAM set. The browser is chromium, without a window; its tests are skipped where there
is none.
"""

import base64
import html.parser
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

SOURCES = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(SOURCES / "tests/support"))
from step_file import StepFile  # noqa: E402

PROGRAM = os.environ["COLLARMESH_PROGRAM"]
MODELS = SOURCES / "resources" / "models"
HAS_CAD = any((pathlib.Path(PROGRAM).parents[1] / "lib/collarmesh").glob("collarmesh_cad*"))
CHROMIUM = shutil.which("chromium")


class Page(html.parser.HTMLParser):
    """Finds the scripts with an id, and everything that the page would load."""

    def __init__(self, text):
        super().__init__()
        self.scripts, self.loads, self.open = {}, [], None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.loads += [attributes[name] for name in ("src", "href") if name in attributes]
        if tag == "script":
            self.open = attributes.get("id")

    def handle_endtag(self, tag):
        if tag == "script":
            self.open = None

    def handle_data(self, data):
        if self.open:
            self.scripts[self.open] = self.scripts.get(self.open, "") + data


class ReportTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def report(self, part, *options, name="report.html"):
        path = self.folder / name
        run = subprocess.run([PROGRAM, part, "-o", self.folder / "mesh.vtu", "--report", path, "-q", *options],
                             capture_output=True, text=True, timeout=300)
        self.assertEqual(run.returncode, 0, run.stderr)
        return path


class Contents(ReportTest):
    def test_the_tets_are_those_of_the_mesh(self):
        page = Page(self.report(MODELS / "two_boxes.poly", "--order", "2").read_text())
        self.assertEqual(page.loads, [])
        report, shown = (json.loads(page.scripts[name]) for name in ("report", "shown"))
        data = zlib.decompress(base64.b64decode(page.scripts["data"]))
        points, tets, faces = shown["points"], shown["tets"], shown["faces"]
        self.assertTrue(shown["complete"])
        self.assertEqual(tets, report["mesh"]["tets"])
        self.assertEqual(len(data), 12 * points + 19 * tets + 16 * faces)
        place = [struct.unpack_from("<3f", data, 12 * p) for p in range(points)]
        corners = [struct.unpack_from("<4I", data, 12 * points + 16 * t) for t in range(tets)]
        region = struct.unpack_from(f"<{tets}H", data, 12 * points + 16 * tets + 16 * faces)

        def six_volume(tet):
            a, b, c, d = (place[p] for p in tet)
            u, v, w = ([x - y for x, y in zip(q, a)] for q in (b, c, d))
            return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2])
                    + u[2] * (v[0] * w[1] - v[1] * w[0]))

        for number, volume in report["check"]["region_volumes"].items():
            made = sum(six_volume(t) for t, r in zip(corners, region) if r == int(number)) / 6
            self.assertAlmostEqual(made, volume, delta=1e-4 * volume)
        angles = [w["smallest"] for w in shown["worst"]]
        self.assertAlmostEqual(min(angles), report["mesh"]["min_dihedral"], places=9)

    def test_the_faces_are_those_of_the_patches(self):
        page = Page(self.report(MODELS / "two_boxes.poly").read_text())
        report, shown = (json.loads(page.scripts[name]) for name in ("report", "shown"))
        data = zlib.decompress(base64.b64decode(page.scripts["data"]))
        begin = 12 * shown["points"] + 16 * shown["tets"]
        areas = dict.fromkeys(shown["face_tags"], 0.0)
        for f in range(shown["faces"]):
            *corners, number = struct.unpack_from("<4I", data, begin + 16 * f)
            a, b, c = (struct.unpack_from("<3f", data, 12 * p) for p in corners)
            u, v = ([x - y for x, y in zip(q, a)] for q in (b, c))
            areas[shown["face_tags"][number]] += math.hypot(
                u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
        expected = {patch["tag"]: patch["area"] for patch in report["complex"]["patch_list"]}
        self.assertEqual(areas.keys(), expected.keys())
        for tag, area in expected.items():
            self.assertAlmostEqual(areas[tag], area, places=4)

    def test_json_stays_json(self):
        json.loads(self.report(MODELS / "bracket.off", name="report.json").read_text())

    def test_both_at_once(self):
        path = self.report(MODELS / "bracket.off", "--report", self.folder / "both.json", name="both.html")
        report = json.loads((self.folder / "both.json").read_text())
        self.assertEqual(json.loads(Page(path.read_text()).scripts["report"]), report)

    def test_repair_has_no_pages(self):
        run = subprocess.run([PROGRAM, "repair", MODELS / "box.off", "-o", self.folder / "box.off", "--report",
                              self.folder / "box.html"], capture_output=True, text=True, timeout=60)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("is JSON here", run.stderr)

    def test_names_do_not_end_scripts(self):
        part = self.folder / "a</script><b>.off"
        part.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(MODELS / "box.off", part)
        page = Page(self.report(part, "--size", "1").read_text())
        self.assertEqual(json.loads(page.scripts["report"])["inputs"], [str(part)])

    def test_large_meshes_are_shown_by_their_surface_and_cuts(self):
        path = self.report(MODELS / "box.off", "--size", "0.06")
        page = Page(path.read_text())
        report, shown = (json.loads(page.scripts[name]) for name in ("report", "shown"))
        self.assertFalse(shown["complete"])
        self.assertGreater(report["mesh"]["tets"], 100000)
        self.assertLess(shown["tets"], report["mesh"]["tets"])
        self.assertLess(path.stat().st_size, 3e6 + 20 * 4 * shown["tets"])


@unittest.skipUnless(CHROMIUM, "chromium is not installed")
class InABrowser(ReportTest):
    def look(self, path, link="", size="1000,800"):
        """Opens the page in a browser. Returns the attributes of its body, and the picture's bytes."""
        picture = self.folder / "picture.png"
        dom = subprocess.run(
            [CHROMIUM, "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", f"--window-size={size}", "--virtual-time-budget=20000",
             f"--user-data-dir={self.folder / 'profile'}", "--dump-dom", f"--screenshot={picture}",
             f"{path.as_uri()}{link}"], capture_output=True, text=True, timeout=120).stdout
        attributes = dict(re.findall(r'data-(\w+)="([^"]*)"', re.search(r"<body[^>]*>", dom).group()))
        self.assertNotIn("error", attributes, dom[-2000:])
        self.assertEqual(attributes.get("ready"), "yes")
        return attributes, dom, picture.read_bytes()

    def test_it_opens_turns_cuts_and_marks(self):
        path = self.report(MODELS / "bracket.off")
        report = json.loads(Page(path.read_text()).scripts["report"])
        whole, dom, picture = self.look(path)
        self.assertEqual(int(whole["triangles"]), report["mesh"]["faces"])
        self.assertIn("Every guarantee holds", dom)
        self.assertRegex(dom, r"56,\d{3}\.\d+ \([+-]0\.\d\d % of the input's 56,390\.56\)")
        cut, _, picture_of_cut = self.look(path, "#cut=x,0.5&colour=region")
        self.assertNotEqual(cut["triangles"], whole["triangles"])
        self.assertNotEqual(picture, picture_of_cut)
        _, _, turned = self.look(path, "#turn=60")
        self.assertNotEqual(picture, turned)
        marked, dom, _ = self.look(path, "#worst=0")
        self.assertEqual(marked["marked"], "6")  # the edges of a tet
        self.assertIn("dihedral angles", dom)

    def test_triangles_alone(self):
        path = self.report(MODELS / "bracket.off", "--dimension", "2", "--size", "4")
        report = json.loads(Page(path.read_text()).scripts["report"])
        whole, dom, picture = self.look(path)
        self.assertEqual(int(whole["triangles"]), report["mesh"]["faces"])
        for text in ("Triangles have no small or large angle", "Smallest angle of each triangle"):
            self.assertIn(text, dom)
        for text in ("Tetrahedra", "Collars", "Volume of", "Worst elements"):
            self.assertNotIn(f">{text}", dom)
        cut, _, picture_of_cut = self.look(path, "#cut=x,0.5&colour=angle")
        self.assertLess(int(cut["triangles"]), int(whole["triangles"]))
        self.assertNotEqual(picture, picture_of_cut)

    def test_every_part_fits_into_the_view(self):
        for lengths in ((1, 1, 40), (40, 1, 1), (1, 40, 1), (30, 30, 1)):
            path = self.report(self.box(*lengths), "--size", "4", "--distance", "1")
            for size in ("1000,800", "600,1100"):
                with self.subTest(lengths=lengths, size=size):
                    self.assertEqual(self.look(path, size=size)[0]["whole"], "yes")

    def box(self, *lengths):
        path = self.folder / "box.off"
        points = [tuple(low * (k >> axis & 1) for axis, low in enumerate(lengths)) for k in range(8)]
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        path.write_text("\n".join(["OFF", "8 6 0", *(" ".join(map(str, row)) for row in points),
                                   *(" ".join(map(str, (4, *face))) for face in faces), ""]))
        return path

    def test_faces_and_regions_have_their_names(self):
        names = self.folder / "names.json"
        names.write_text('{"patches": {"loaded": 3}}')
        _, dom, _ = self.look(self.report(MODELS / "two_boxes.poly", "--names", names), "#colour=face")
        spans = re.search(r'<div id="labels">.*?</div>', dom, re.S).group()
        labels = {text for look, text in re.findall(r"<span([^>]*)>([^<]*)</span>", spans) if "hidden" not in look}
        self.assertIn("loaded", labels)  # at the visible end
        self.assertNotIn("patch 1", labels)  # at the other end
        legend = re.search(r'<p id="legend">.*?</p>', dom, re.S).group()
        for name in ("loaded", "patch 1", "patch 2"):
            self.assertIn(name, legend)
        _, dom, _ = self.look(self.folder / "report.html", "#colour=region")
        legend = re.search(r'<p id="legend">.*?</p>', dom, re.S).group()
        for name in ("two_boxes.poly 1", "two_boxes.poly 2"):
            self.assertIn(f"Volume of {name}", dom)
            self.assertIn(name, legend)

    @unittest.skipUnless(HAS_CAD, "no OpenCASCADE")
    def test_names_and_colours_of_step(self):
        file = StepFile()
        file.product("Lid </script>", file.box((0, 0, 0), (1, 1, 1), colour=(1, 0, 0), face_colours={5: (0, 0, 1)}))
        path = self.report(file.write(self.folder / "a.step"), "--size", "0.5")
        _, dom, picture = self.look(path, "#colour=file")
        legend = re.search(r'<p id="legend">.*?</p>', dom, re.S).group()
        colours = re.findall(r"background: (#\w+)[^>]*></i>([^<]*)<", legend)
        self.assertEqual(colours, [("#ff0000", "Face1, Face2, Face3 and 2 more"), ("#0000ff", "Face6")])
        self.assertNotRegex(dom, r'<option value="file" hidden')
        self.assertIn("Volume of Lid &lt;/script&gt;", dom)
        self.assertNotEqual(picture, self.look(path, "#colour=face")[2])
        _, dom, _ = self.look(self.report(MODELS / "box.off", "--size", "1"), "#colour=face")
        self.assertRegex(dom, r'<option value="file" hidden')

    def test_a_slider_goes_through_the_steps_of_the_run(self):
        plain = self.report(MODELS / "box.off", "--size", "1")
        self.assertNotIn("steps", self.look(plain)[0])
        size = plain.stat().st_size
        path = self.report(self.wedge(), "--size", "0.3", "--trace", self.folder / "steps")
        steps = json.loads(Page(path.read_text()).scripts["steps"])
        self.assertEqual((steps[0]["stage"], steps[-1]["stage"]), ("box", "improve"))
        self.assertLess(path.stat().st_size, size + 3e6)
        seen, dom, last = self.look(path)
        self.assertEqual(int(seen["steps"]), len(steps) + 1)
        self.assertNotRegex(dom, '<form id="trace" hidden')
        stages = [step["stage"] for step in steps]
        pictures = {last}
        for number in (0, stages.index("rip"), stages.index("stitch")):
            seen, dom, picture = self.look(path, f"#step={number}&colour=collar")
            self.assertIn(f"{number + 1} of {len(steps) + 1}, {stages[number]}", dom)
            self.assertNotIn(picture, pictures)
            pictures.add(picture)
        self.assertGreater(int(seen["balls"]), 2)

    def wedge(self):
        path = self.folder / "wedge.off"
        corners = [(0, 0), (1, 0), (0.9, 0.42)]
        points = [(x, y, z) for z in (0, 1) for x, y in corners]
        faces = [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]
        path.write_text("\n".join(["OFF", "6 5 0", *(" ".join(map(str, row)) for row in points),
                                   *(" ".join(map(str, (len(face), *face))) for face in faces), ""]))
        return path

    def test_layers_are_told_and_shown(self):
        path = self.report(MODELS / "box.off", "--layers", "1,2:first=0.02,count=4", "--size", "0.3")
        report = json.loads(Page(path.read_text()).scripts["report"])
        data = zlib.decompress(base64.b64decode(Page(path.read_text()).scripts["data"]))
        marks = data[-json.loads(Page(path.read_text()).scripts["shown"])["tets"]:]
        self.assertEqual(sum(1 for mark in marks if mark & 24), 3 * report["layers"]["prisms"])
        _, dom, whole = self.look(path)
        for text in ("Boundary layers", "by the share of the thickness reached", "100 % covered",
                     "90–100%: 100 % of the area"):
            self.assertIn(text, dom)
        _, dom, layers = self.look(path, "#cut=x,0.5&colour=layers")
        self.assertIn("odd layers", re.search(r'<p id="legend">.*?</p>', dom, re.S).group())
        self.assertNotEqual(whole, layers)

    def test_straightened_nodes_are_marked(self):
        path = self.report(MODELS / "bracket.off", "--size", "8", "--order", "2")
        self.assertEqual(self.look(path)[0]["straightened"], "0")
        node = {"point": 1, "edge": [0, 1], "dimension": 2, "tag": 1, "where": [0, 0, 0], "distance": 0.5}
        text, count = re.subn(r'"straightened":\s*\[\]', f'"straightened":[{json.dumps(node)}]', path.read_text())
        self.assertEqual(count, 1)
        path.write_text(text)
        attributes, dom, _ = self.look(path)
        self.assertEqual(attributes["straightened"], "1")
        self.assertIn("patch 1: 0.5 away", dom)

    def test_ratios_reach_as_far_as_their_histogram(self):
        path = self.report(MODELS / "bracket.off", "--size", "8")
        mesh = json.loads(Page(path.read_text()).scripts["report"])["mesh"]
        self.assertGreater(mesh["max_thin_radius_edge"], mesh["max_radius_edge"])
        _, dom, _ = self.look(path)
        self.assertIn(f"{mesh['max_thin_radius_edge']:.4g} (thin tetrahedra)", dom)

    def test_on_a_phone_the_view_comes_first_and_nothing_is_too_wide(self):
        path = self.report(MODELS / "bracket.off", "--size", "10")
        measure = """<script>setTimeout(() => {
          const top = id => document.getElementById(id).getBoundingClientRect().top;
          document.body.dataset.first = top('view') < top('facts') ? 'view' : 'facts';
          document.body.dataset.wider = document.documentElement.scrollWidth - window.innerWidth;
        }, 3000)</script></body>"""
        path.write_text(path.read_text().replace("</body>", measure))
        attributes, _, _ = self.look(path, size="420,800")
        self.assertEqual(attributes["first"], "view")
        self.assertLessEqual(int(attributes["wider"]), 0)

    def test_findings_and_repairs_are_listed(self):
        part = self.folder / "two.off"
        points = [(x + s, y, z) for s in (0, 0.5) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        box = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        facets = [[v + 8 * k for v in f] for k in (0, 1) for f in box]
        part.write_text("\n".join(["OFF", f"{len(points)} {len(facets)} 0", *(" ".join(map(str, p)) for p in points),
                                   *(" ".join(map(str, [4, *f])) for f in facets), ""]))
        _, dom, _ = self.look(self.report(part))
        self.assertIn("Repaired", dom)


if __name__ == "__main__":
    unittest.main()
