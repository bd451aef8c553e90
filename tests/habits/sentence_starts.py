#!/usr/bin/env python3
"""Looks for comments, and sentences in comments and on pages, that begin with "What", "Those" or "Of" in place of a
noun. Questions, headings, and the examples of bad sentences in contributing.md may begin so.

    sentence_starts.py ROOT
"""
import ast
import io
import pathlib
import re
import subprocess
import sys
import tokenize

SENTENCE = re.compile(r"(?:^|[.!?:;|)]\s+|[-*]\s+|\*\*|[(\"“])(What|Those|Of)\b(?!\s*[\"”]|:)")
COMMENT = re.compile(r"^(what|those|of)\b(?!\s*[\"”]|:)", re.I)
# Strings and characters first, so that slashes in them do not count.
C_TOKEN = re.compile(r'R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|`(?:\\.|[^`\\])*`|//[/!]?<?[^\n]*')
IN_PLACE_OF = "| in place of |"


def c_comments(text):
    """Yields the comments of C++ and JavaScript: a line number and a text. Comment lines that follow each other, and
    comment lines that continue a comment after code, are one comment."""
    open_line, open_text, column = 0, [], 0
    end = -1
    for found in C_TOKEN.finditer(text):
        if not found[0].startswith("//"):
            continue
        line = text.count("\n", 0, found.start()) + 1
        start = text.rfind("\n", 0, found.start()) + 1
        alone = not text[start:found.start()].strip()
        words = re.sub(r"^//[/!]?<?", "", found[0]).strip()
        if alone and line == end + 1 and found.start() - start == column and words:
            open_text.append(words)
        else:
            if open_text:
                yield open_line, " ".join(open_text)
            open_line, open_text, column = line, [words] if words else [], found.start() - start
        end = line
    if open_text:
        yield open_line, " ".join(open_text)


def python_comments(text):
    """Yields the comments and docstrings of Python: a line number and a text."""
    last, joined, first = -1, [], 0
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type != tokenize.COMMENT:
            continue
        if token.start[0] != last + 1:
            if joined:
                yield first, " ".join(joined)
            first, joined = token.start[0], []
        joined.append(token.string.lstrip("#! "))
        last = token.start[0]
    if joined:
        yield first, " ".join(joined)
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, kinds) and ast.get_docstring(node):
            line = node.body[0].lineno
            for paragraph in node.body[0].value.value.split("\n\n"):
                yield line, " ".join(paragraph.split())
                line += paragraph.count("\n") + 2


def shell_comments(text):
    """Yields the comment lines of shell scripts and CMake: a line number and a text."""
    first, joined = 0, []
    for number, line in enumerate(text.splitlines() + [""], 1):
        words = re.match(r"\s*#+!?\s*(.*)|.*\s#\s(.*)", line)
        if words and (words[1] or joined and words[1] is not None):
            first = first if joined else number
            joined.append(words[1])
            continue
        if joined:
            yield first, " ".join(joined)
        joined = []
        if words and words[2]:
            yield number, words[2]


def paragraphs(text):
    """Yields the paragraphs, list items and table rows of a page: a line number and a text."""
    first, joined, code, table = 0, [], False, ""
    for number, line in enumerate(text.splitlines() + [""], 1):
        fence = line.lstrip().startswith("```")
        row = line.startswith("|")
        table = (table or line) if row else ""
        begins = re.match(r"\s*([-*]|\d+\.)\s|\|", line)
        if fence or code or not line.strip() or line.startswith("#") or begins:
            if joined:
                yield first, " ".join(joined)
            joined = []
        code ^= fence
        if fence or code or line.startswith("#") or not line.strip():
            continue
        if row and table.startswith(IN_PLACE_OF):
            line = line[line.index("|", 1):]
        if not joined:
            first = number
        joined.append(re.sub(r"`[^`]*`", "`x`", line.strip()))


READERS = {".cpp": c_comments, ".h": c_comments, ".js": c_comments, ".py": python_comments, ".sh": shell_comments,
           ".cmake": shell_comments, ".md": paragraphs}


def reader_of(path, text):
    """Returns the function that finds comments in a file, or the sentences of a page; None for other files."""
    if path.suffix == ".md":
        return paragraphs if path.parts[:2] == ("mesher", "doc") or path.name == "README.md" else None
    if path.name == "CMakeLists.txt":
        return shell_comments
    if re.match(r"#!.*\bpython", text):
        return python_comments
    if re.match(r"#!.*\b(ba)?sh\b", text):
        return shell_comments
    return READERS.get(path.suffix)


def is_question(text, start):
    """Returns whether the sentence that begins there ends with a question mark."""
    end = re.compile(r"[.!?](?=[\s*|)\"”]|$)").search(text, start)
    return end is not None and end[0] == "?"


def faults(path, text):
    """Yields a message for each sentence of a file that begins with one of the words."""
    reader = reader_of(path, text)
    for line, words in reader(text) if reader else ():
        found = {match.start(1): match for match in SENTENCE.finditer(words)}
        if reader is not paragraphs and (match := COMMENT.search(words)):
            found[match.start(1)] = match
        for start in sorted(found):
            if not is_question(words, start):
                yield f"{path}:{line}: {words[start:start + 80]}"


def main():
    root = pathlib.Path(sys.argv[1])
    names = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=root, check=True,
                           capture_output=True, text=True).stdout.splitlines()
    found = []
    for name in names:
        path = pathlib.Path(name)
        if (root / path).is_file() and (path.suffix in READERS or path.suffix in ("", ".txt")):
            found += faults(path, (root / path).read_text(errors="replace"))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
