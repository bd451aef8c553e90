"""The pages: every block of commands and code runs, in the order of its page, in a folder with the models; the site
builds without a warning, so that no link leads nowhere; every option is on its page.

    pages_test.py blocks PAGE SOURCES BUILD
    pages_test.py recipe NAME SOURCES BUILD
    pages_test.py cpp SOURCES BUILD
    pages_test.py site SOURCES
    pages_test.py options SOURCES BUILD
    pages_test.py gallery SOURCES BUILD
    pages_test.py readme SOURCES BUILD

A comment before a block tells what it needs and where it runs: <!-- needs dolfinx ccx --> are modules of Python and
programs without which it is left out, <!-- in the sources --> runs it in a copy of them, in a fresh environment of
Python, which later blocks have, too, <!-- in FreeCAD --> in FreeCAD with the add-on. <!-- recipe: NAME; needs ... -->
is a part of a recipe, which is a test of its own.
"""

import dataclasses
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^(?:<!-- ([^\n]*) -->\n)?```([^\n]*)\n(.*?)^```", re.M | re.S)
RUN = {"bash", "python"}
KNOWN = RUN | {"cpp", "cmake", "text"}
MOST_LINES = 10
PARTS = {"OpenCASCADE": "lib/collarmesh/collarmesh_cad.so", "HDF5": "lib/collarmesh/collarmesh_hdf5.so",
         "Scotch": "lib/collarmesh/collarmesh_scotch.so", "MPI": "bin/collarmesh-mpi"}
UNPACKAGED = {"abaqus", "ElmerGrid", "ElmerSolver", "ex1", "SU2_CFD"}  # in no list of cmake/packages.txt
SMALLEST_PICTURE = 10_000  # bytes; an empty picture is smaller
# The expected last output of each recipe.
RECIPES = {
    "pip": ["Successfully installed collarmesh", r"largest temperature 0\.(49|50)"],
    "calculix": [r"displacements \(vx,vy,vz\) for set LOADED_NODES", r"\n +\d+ +-?\d\.\d+E-0\d "],
    "openfoam": ["Mesh OK", r"\binlet\b", r"\boutlet\b", r"\bwalls\b", "cellZone air"],
}


def installed(name, build):
    """Returns whether a program or Python module is installed, or the program was built with something."""
    if name in PARTS:
        return (build / PARTS[name]).exists()
    return shutil.which(name) is not None or importlib.util.find_spec(name) is not None


@dataclasses.dataclass
class Block:
    language: str
    code: str
    recipe: str = ""
    needs: list = dataclasses.field(default_factory=list)
    in_sources: bool = False
    in_freecad: bool = False

    def lines(self):
        return [line for line in self.code.splitlines() if line.strip()]

    def missing(self, build):
        return [name for name in self.needs if not installed(name, build)]


def leave_out(page, missing):
    """Tells that a block is left out. Where everything is installed that can be, as in continuous integration, that is
    a failure."""
    if os.environ.get("CI") and not UNPACKAGED & set(missing):
        raise SystemExit(f"{page}: {missing} not installed, see cmake/packages.txt: a block would be left out")
    print(f"{missing} not installed: a block is left out")


def blocks(page):
    found = []
    for notes, language, code in BLOCK.findall(page.read_text()):
        block = Block(language, code)
        for note in filter(None, notes.split("; ")):
            if note.startswith("recipe: "):
                block.recipe = note.removeprefix("recipe: ")
            elif note.startswith("needs "):
                block.needs = note.split()[1:]
            elif note == "in the sources":
                block.in_sources = True
            elif note == "in FreeCAD":
                block.in_freecad = True
            else:
                raise SystemExit(f"{page.name}: what is '{note}'?")
        found.append(block)
    unknown = [block.language for block in found if block.language not in KNOWN]
    if unknown:
        raise SystemExit(f"{page.name}: blocks of {unknown}, which nothing runs")
    return found


class Reader:
    """A reader who types the commands of a page, in a folder with the models."""

    def __init__(self, folder, sources, build):
        self.folder = pathlib.Path(folder)
        self.sources, self.build = sources, build
        for model in (sources / "resources/models").iterdir():
            shutil.copy(model, folder)
        self.python = sys.executable
        self.environment = {**os.environ, "PATH": f"{build}/bin:{os.environ['PATH']}", "PYTHONPATH": f"{build}/python",
                            # needed in containers
                            "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                            "OMPI_MCA_rmaps_base_oversubscribe": "1"}

    def make_clone(self):
        """Makes a copy of the sources. Uses the system's numpy and pip, so that nothing is downloaded."""
        clone, venv = self.folder / "clone", self.folder / "venv"
        shutil.copytree(self.sources, clone, ignore=shutil.ignore_patterns("build", ".git", "*.egg-info"))
        subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", venv], check=True)
        self.python = str(venv / "bin/python")
        self.environment["PATH"] = f"{venv}/bin:{self.environment['PATH']}"
        self.environment.pop("PYTHONPATH")
        self.environment.update(PIP_NO_INDEX="1", COLLARMESH_BUILD_DIR=str(self.build))
        return clone

    def run(self, page, block):
        if block.in_freecad:
            return self.run_in_freecad(page, block)
        where = self.make_clone() if block.in_sources else self.folder
        command = ["bash", "-euo", "pipefail", "-c"] if block.language == "bash" else [self.python, "-c"]
        run = subprocess.run([*command, block.code], cwd=where, env=self.environment, capture_output=True, text=True)
        if run.returncode != 0:
            raise SystemExit(f"{page}: {run.returncode}\n{block.code}\n{run.stdout[-5000:]}\n{run.stderr[-5000:]}")
        print(block.code, run.stdout, sep="\n")
        return run.stdout

    def run_in_freecad(self, page, block):
        script = self.folder / "macro.py"
        script.write_text(block.code + "print('the macro has ended', flush=True)\n")
        run = subprocess.run([sys.executable, self.sources / "tests/freecad/run.py", self.build / "bin/collarmesh",
                              script],
                             cwd=self.folder, capture_output=True, text=True)
        if run.returncode == 77:
            leave_out(page, ["FreeCAD"])
        elif "the macro has ended" not in run.stdout:
            raise SystemExit(f"{page}:\n{block.code}\n{run.stdout}\n{run.stderr}")
        print(block.code, run.stdout, sep="\n")
        return run.stdout


def run_blocks(page, sources, build):
    with tempfile.TemporaryDirectory(prefix="collarmesh-page-") as folder:
        reader = Reader(folder, sources, build)
        for block in blocks(sources / "mesher/doc" / page):
            if block.language not in RUN or block.recipe:
                continue
            if missing := block.missing(build):
                leave_out(page, missing)
                continue
            reader.run(page, block)


def run_recipe(name, sources, build):
    """Runs a recipe of the page of solvers: at most ten lines, from the program or the package to a solution."""
    page = sources / "mesher/doc/solvers.md"
    recipe = [block for block in blocks(page) if block.recipe == name]
    if {block.recipe for block in blocks(page)} - {""} != set(RECIPES):
        raise SystemExit("a recipe of the page has no test, or a test no recipe")
    lines = sum(len(block.lines()) for block in recipe)
    if lines > MOST_LINES:
        raise SystemExit(f"{name} has {lines} lines")
    if missing := [need for block in recipe for need in block.missing(build)]:
        print(f"{missing} not installed")
        return 77
    with tempfile.TemporaryDirectory(prefix="collarmesh-recipe-") as folder:
        reader = Reader(folder, sources, build)
        if name == "calculix":  # the page says that it comes from a model
            reader.run(page.name, Block("bash", "collarmesh convert bracket.off -o bracket.stl && rm bracket.off"))
        said = "".join(reader.run(page.name, block) for block in recipe)
    for expected in RECIPES[name]:
        if not re.search(expected, said):
            raise SystemExit(f"{name} does not say {expected}")
    return 0


CMAKE = """cmake_minimum_required(VERSION 3.22)
project(pages LANGUAGES CXX)
find_package(OpenMesh CONFIG)
"""


def run_cpp(sources, build):
    """Builds the programs of the pages against what `cmake --install` installs."""
    with tempfile.TemporaryDirectory(prefix="collarmesh-page-") as folder:
        folder = pathlib.Path(folder)
        subprocess.run(["cmake", "--install", build, "--prefix", folder / "prefix"],
                       check=True, stdout=subprocess.DEVNULL)
        codes = {page: [block.code for block in blocks(sources / f"mesher/doc/{page}.md") if block.language == "cpp"]
                 for page in ("cpp", "openmesh")}
        programs = dict(zip(("mesher", "files", "openmesh_io"), codes["cpp"] + codes["openmesh"], strict=True))
        find, link = [block.code for block in blocks(
            sources / "mesher/doc/cpp.md") if block.language == "cmake"][0].splitlines()
        text = CMAKE + find + "\n"
        for target, code in programs.items():
            (folder / f"{target}.cpp").write_text(code)
            linked = link.replace("program", f"on_page_{target}").replace("::mesher", f"::{target}")
            text += (f"if(TARGET collarmesh::{target})\nadd_executable(on_page_{target} {target}.cpp)\n"
                     f"{linked}\nendif()\n")
        (folder / "CMakeLists.txt").write_text(text)
        subprocess.run(["cmake", "-S", folder, "-B", folder / "build",
                       f"-DCMAKE_PREFIX_PATH={folder}/prefix"], check=True)
        subprocess.run(["cmake", "--build", folder / "build"], check=True)
        unread = subprocess.run([folder / "build/on_page_mesher"], cwd=folder, capture_output=True, text=True)
        if unread.returncode != 2 or "bracket.off" not in unread.stderr:
            raise SystemExit(f"the program does not say which file is missing: {unread}")
        for model in ("bracket.off", "flange.step"):
            shutil.copy(sources / "resources/models" / model, folder)
        wanted = {"mesher": "bracket.vtu"}
        if installed("OpenCASCADE", build):
            wanted["files"] = "flange.msh"
        for target, mesh in wanted.items():
            subprocess.run([folder / f"build/on_page_{target}"], check=True, cwd=folder)
            if not (folder / mesh).exists():
                raise SystemExit(f"the program for {target} wrote no mesh")


def missing_files(sources):
    """Returns files of the sources that pages name but that do not exist."""
    there = set()
    for folder in ("cmake", "freecad_workbench", "mesher", "openmesh_io", "resources", "tests"):
        there.update(str(path.relative_to(sources)) for path in (sources / folder).rglob("*") if path.is_file())
    missing = []
    for page in (sources / "mesher/doc").rglob("*.md"):
        for name in re.findall(r"`((?:[\w.-]+/)*[\w-]+\.(?:cpp|h|py|sh|cmake))`", page.read_text()):
            if not any(f"/{path}".endswith(f"/{name}") for path in there):
                missing.append(f"{page.name}: {name}")
    return missing


def build_site(sources):
    if missing := missing_files(sources):
        raise SystemExit(f"pages name files that are not there: {missing}")
    if missing := [program for program in ("mkdocs", "doxygen") if shutil.which(program) is None]:
        print(f"{missing} not installed")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(["mkdocs", "build", "--strict", "-f", sources / "mkdocs.yml", "-d", folder],
                             capture_output=True, text=True)
        print(run.stdout, run.stderr)
        if run.returncode != 0:
            raise SystemExit("the site does not build")
        doc, site = sources / "mesher/doc", pathlib.Path(folder)
        pages = {page.relative_to(site) for page in site.rglob("*.html")}
        told = {page.relative_to(doc).with_suffix(".html") for page in doc.rglob("*.md")}
        if not told <= pages:
            raise SystemExit(f"pages are missing: {told - pages}")
        for name, member in (("structcollarmesh_1_1MeshOptions", "size_field"), ("namespacecollarmesh", "run_pipeline"),
                             ("namespacecollarmesh_1_1io", "read_soup"),
                             ("classcollarmesh_1_1brep_1_1CadModel", "CadModel"),
                             ("classcollarmesh_1_1openmesh__io_1_1Surfaces", "Surfaces")):
            page = site / f"api/{name}.html"  # doxygen's warnings are mkdocs' warnings, which --strict refuses
            if not page.exists() or member not in page.read_text():
                raise SystemExit(f"the public headers have no page {name} with {member}")
        unread = {str(page.relative_to(site)) for page in site.rglob("*.html") if re.search("<p>```", page.read_text())}
        if unread:
            raise SystemExit(f"blocks of code that the site does not show as such: {unread}")
    for page in (sources / "README.md", sources / "CONTRIBUTING.md", sources / "mesher/bench/README.md"):
        for link in re.findall(r"\]\(([^)#]+)\)", page.read_text()):
            if "://" not in link and not (page.parent / link).exists():
                raise SystemExit(f"{page.name}: {link} leads nowhere")
    return 0


def options_told(sources, build):
    """Checks that each option is on the page, and that the table is the program's."""
    sys.path.insert(0, str(sources / "resources"))
    import options_page

    page = (sources / "mesher/doc/options.md").read_text(encoding="utf-8")
    program = f"{build}/bin/collarmesh"
    said = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    words = page.replace("`", " ").split()
    missing = {option for option in re.findall(r"--[a-z][a-z-]+", said) if option not in words}
    if missing:
        raise SystemExit(f"options.md does not tell of {missing}")
    if options_page.page(page, program) != page:
        raise SystemExit(f"the table of options.md is out of date; write it: resources/options_page.py {program}")


def run_readme(sources, build):
    """Runs the commands of the README; `./collarmesh` stands for the program that was built."""
    (block,) = blocks(sources / "README.md")
    with tempfile.TemporaryDirectory(prefix="collarmesh-page-") as folder:
        reader = Reader(folder, sources, build)
        (reader.folder / "resources").symlink_to(sources / "resources")
        (reader.folder / "collarmesh").symlink_to(build / "bin/collarmesh")
        reader.run("README.md", block)
        if not (reader.folder / "bracket.vtu").exists():
            raise SystemExit("the README's commands make no mesh")


def draw_gallery(sources, build):
    """Checks that one script draws all pictures of the gallery and of reports, and no others."""
    if missing := Block("", "", needs=["vtk", "PIL", "xvfb-run", "ccx", "chromium", "OpenCASCADE"]).missing(build):
        print(f"not installed: {missing}")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "PATH": f"{build}/bin:{os.environ['PATH']}"}
        subprocess.run(["xvfb-run", "-a", sys.executable, sources / "resources/gallery.py", "--draft", "--into",
                        folder], check=True,
                       env=environment)
        made = {path.name for path in pathlib.Path(folder).glob("*.png") if path.stat().st_size > SMALLEST_PICTURE}
    shown = re.findall(r"!\[[^\]]+\]\(images/(\w+\.png)\)", (sources / "mesher/doc/gallery.md").read_text())
    if len(shown) != 15 or {*shown, "report.png"} != made:
        raise SystemExit(f"the page shows {sorted(shown)}, the script makes {sorted(made)}")
    return 0


def main():
    what, *rest = sys.argv[1:]
    if what in ("blocks", "recipe"):
        run = {"blocks": run_blocks, "recipe": run_recipe}[what]
        return run(rest[0], *(pathlib.Path(p).resolve() for p in rest[1:]))
    tests = {"cpp": run_cpp, "site": build_site, "options": options_told, "gallery": draw_gallery,
             "readme": run_readme}
    return tests[what](*(pathlib.Path(p).resolve() for p in rest))


if __name__ == "__main__":
    sys.exit(main())
