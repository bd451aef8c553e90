"""Write functions.py with the options of the command line in it.

    write_functions.py functions.py OPTIONS.json OUTPUT   (OPTIONS.json: collarmesh --generate options)
"""

import json
import re
import sys
import textwrap

WIDTH = 118
PLACE = re.compile(r"^( +)# options of (\w+)\n", re.M)
TYPES = {"flag": "bool", "count": "int", "number": "float", "text": "str", "sizes": "Mapping[int, float]",
         "texts": "Sequence[str]"}
# Options whose types in Python differ from those on the command line.
OTHER_TYPES = {"size_field": "SizeField", "names": "Union[Path, Mapping[str, Any]]", "max_memory": "Union[int, str]"}
MORE = {
    "size_field": "the path of such a file; a dict with the content of such a .json file; a tuple (mesh, values) or "
                  "(points, tets, values), a mesh with a length for each point or each tet; a callable that takes an "
                  "array of places of shape (n, 3) and returns lengths of shape (n,); or a callable of x, y, z that "
                  "returns a length, which takes longer",
    "names": 'the path of a JSON file, or its content, {"patches": {"inlet": 3, "walls": [1, {"at": [0, 0, 1]}]}}',
    "partitions": "`Mesh.tet_partition` lists them",
}


def type_of(option):
    if option["kind"] == "choice":
        return "bool" if isinstance(option["default"], bool) else "str"
    return OTHER_TYPES.get(option["key"]) or TYPES[option["kind"]]


def in_python(text):
    """Returns a text in which options are named as in Python: `max_memory` for `--max-memory`."""
    return re.sub(r"--([a-z-]+)", lambda match: match[1].replace("-", "_"), text)


def description(option):
    """Returns one paragraph: the option's purpose, its allowed values, its default."""
    text = option["help"][0].lower() + option["help"][1:]
    default = option["default_text"]
    if type_of(option) == "bool":
        for word, value in zip(option["words"], ("True", "False")):
            text = text.replace(f"{word}:", f"{value}:")
        default = str(option["default"])
    elif option["words"]:
        default = f'"{default}", one of ' + ", ".join(f'"{word}"' for word in option["words"])
    elif option["kind"] == "sizes":
        default = "none; a dict of tags and lengths, {3: 0.1}"
    clauses = [text, MORE.get(option["key"]), default and f"default {default}"]
    return in_python(f"{option['key']}: {'; '.join(filter(None, clauses))}.")


def main():
    template, options, output = sys.argv[1:]
    with open(options, encoding="utf-8") as file:
        table = [option for option in json.load(file) if "programs" in option["takers"]]

    def written(match):
        indent, command = match.groups()
        taken = [option for option in table if command in option["takers"]]
        if in_signature(match):
            return "".join(f"{indent}{option['key']}: Optional[{type_of(option)}] = None,\n" for option in taken)
        return "".join(textwrap.fill(description(option), WIDTH, initial_indent=indent,
                                     subsequent_indent=indent + "    ", break_on_hyphens=False) + "\n"
                       for option in taken)

    with open(template, encoding="utf-8") as file:
        text = file.read()

    def in_signature(match):
        return text.count('"""', 0, match.start()) % 2 == 0

    with open(output, "w", encoding="utf-8") as file:
        file.write(PLACE.sub(written, text))


if __name__ == "__main__":
    main()
