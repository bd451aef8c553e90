"""Adds the pages of the public headers to the site, as api/. A hook of mkdocs; needs doxygen."""

import logging
import pathlib
import shutil
import subprocess
import tempfile

from mkdocs.structure.files import File

SOURCES = pathlib.Path(__file__).resolve().parents[1]
FOLDER = "api"
log = logging.getLogger("mkdocs.plugins.header_pages")  # with --strict, its warnings are errors
made = tempfile.TemporaryDirectory(prefix="collarmesh-headers-")  # mkdocs copies the files when it writes the site


def on_files(files, config):
    if shutil.which("doxygen") is None:
        log.warning("doxygen is not installed: the site has no pages of the public headers")
        return files
    into = pathlib.Path(made.name) / FOLDER
    shutil.rmtree(into, ignore_errors=True)
    into.mkdir()
    run = subprocess.run(["doxygen", "-"], input=f"@INCLUDE = resources/Doxyfile\nOUTPUT_DIRECTORY = {into}\n",
                         cwd=SOURCES, stderr=subprocess.PIPE, text=True, check=True)
    for line in run.stderr.splitlines():
        log.warning("doxygen: %s", line)
    for path in into.rglob("*"):
        if path.is_file():
            files.append(File(str(path.relative_to(made.name)), made.name,
                         config["site_dir"], use_directory_urls=False))
    return files
