#!/usr/bin/python3
"""The pages: every block of commands and code runs, in the order of its page, in a folder with the models; the site
builds without a warning, so that no link leads nowhere; every option is on its page.

    pages_test.py blocks PAGE SOURCES BUILD
    pages_test.py cpp SOURCES BUILD
    pages_test.py site SOURCES
    pages_test.py options SOURCES BUILD
"""

import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```(\w*)([^\n]*)\n(.*?)^```", re.M | re.S)
RUN = {"bash", "python"}
KNOWN = RUN | {"cpp", "cmake", "text"}


def blocks(page):
    return [(language, words.split(), code) for language, words, code in BLOCK.findall(page.read_text())]


def run_blocks(page, sources, build):
    found = blocks(sources / "mesher/doc" / page)
    unknown = [language for language, _, _ in found if language not in KNOWN]
    if unknown:
        raise SystemExit(f"{page}: blocks of {unknown}, which nothing runs")
    with tempfile.TemporaryDirectory(prefix="collarmesh-page-") as folder:
        for model in (sources / "resources/models").iterdir():
            shutil.copy(model, folder)
        environment = {**os.environ, "PATH": f"{build}/bin:{os.environ['PATH']}", "PYTHONPATH": f"{build}/python"}
        for language, words, code in found:
            if language not in RUN:
                continue
            missing = [module for module in words if importlib.util.find_spec(module) is None]
            if missing:
                print(f"{missing} not installed: a block is left out")
                continue
            command = ["bash", "-euo", "pipefail", "-c", code] if language == "bash" else [sys.executable, "-c", code]
            run = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
            if run.returncode != 0:
                raise SystemExit(f"{page}: {run.returncode}\n{code}\n{run.stdout}\n{run.stderr}")
            print(code, run.stdout, sep="\n")


CMAKE = """cmake_minimum_required(VERSION 3.22)
project(pages LANGUAGES CXX)
find_package(OpenMesh CONFIG)
"""


def run_cpp(sources, build):
    """The programs of the pages, built against what `cmake --install` installs."""
    with tempfile.TemporaryDirectory(prefix="collarmesh-page-") as folder:
        folder = pathlib.Path(folder)
        subprocess.run(["cmake", "--install", build, "--prefix", folder / "prefix"], check=True, stdout=subprocess.DEVNULL)
        (link,) = [code for language, _, code in blocks(sources / "mesher/doc/cpp.md") if language == "cmake"]
        text = CMAKE
        for page, target in (("cpp", "mesher"), ("openmesh", "openmesh_io")):
            (code,) = [code for language, _, code in blocks(sources / f"mesher/doc/{page}.md") if language == "cpp"]
            (folder / f"{page}.cpp").write_text(code)
            text += f"add_executable({page} {page}.cpp)\n"
            text += link.replace("program", page).replace("::mesher", f"::{target}")
        text = text.replace("add_executable(openmesh", "if(NOT TARGET collarmesh::openmesh_io)\n  return()\nendif()\nadd_executable(openmesh")
        (folder / "CMakeLists.txt").write_text(text)
        subprocess.run(["cmake", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={folder}/prefix"], check=True)
        subprocess.run(["cmake", "--build", folder / "build"], check=True)
        shutil.copy(sources / "resources/models/bracket.off", folder)
        subprocess.run([folder / "build/cpp"], check=True, cwd=folder)
        if not (folder / "bracket.vtu").exists():
            raise SystemExit("the program wrote no mesh")


def build_site(sources):
    if shutil.which("mkdocs") is None:
        print("mkdocs-material is not installed")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(["mkdocs", "build", "--strict", "-f", sources / "mkdocs.yml", "-d", folder],
                             capture_output=True, text=True)
        print(run.stdout, run.stderr)
        if run.returncode != 0:
            raise SystemExit("the site does not build")
        pages = {page.name for page in pathlib.Path(folder).glob("*.html")}
        told = {page.with_suffix(".html").name for page in (sources / "mesher/doc").glob("*.md")}
        if not told <= pages:
            raise SystemExit(f"pages are missing: {told - pages}")
    for page in (sources / "README.md", sources / "CONTRIBUTING.md"):
        for link in re.findall(r"\]\(([^)#]+)\)", page.read_text()):
            if "://" not in link and not (sources / link).exists():
                raise SystemExit(f"{page.name}: {link} leads nowhere")
    return 0


def options_told(sources, build):
    page = (sources / "mesher/doc/options.md").read_text().replace("`", " ").split()
    said = subprocess.run([f"{build}/bin/collarmesh", "--help"], capture_output=True, text=True, check=True).stdout
    missing = {option for option in re.findall(r"--[a-z][a-z-]+", said) if option not in page}
    if missing:
        raise SystemExit(f"options.md does not tell of {missing}")


def main():
    what, *rest = sys.argv[1:]
    if what == "blocks":
        return run_blocks(rest[0], *(pathlib.Path(p).resolve() for p in rest[1:]))
    return {"cpp": run_cpp, "site": build_site, "options": options_told}[what](*(pathlib.Path(p).resolve() for p in rest))


if __name__ == "__main__":
    sys.exit(main())
