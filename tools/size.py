#!/usr/bin/env python3
"""size.py [COMMIT]: lines per house and folder, words of the documentation, as a table in Markdown; and how many
headers of the engine the laboratory includes.

Counts files that git tracks, those of COMMIT where one is given. Lines are all lines of C++, kernels, shaders,
scripts and build files; words are those of Markdown pages, separated by white space.
"""
import collections
import re
import subprocess
import sys

CODE = (".h", ".cpp", ".cl", ".glsl", ".vert", ".frag", ".comp", ".py", ".js", ".css", ".html", ".sh", ".cmake")
# House: folders of the tree, and how many parts of a path name a row.
HOUSES = {
    "engine": (("src/engine/",), 3),
    "laboratory": (("src/laboratory/",), 3),
    "apps": (("src/apps/",), 3),
    "kernels": (("kernels/",), 2),
    "shaders": (("shaders/",), 1),
    "tests": (("tests/",), 3),
    "tools": (("tools/",), 1),
    "docs": (("docs/", "README.md"), 2),
}


def git(*words):
    return subprocess.run(("git", *words), capture_output=True, check=True).stdout


def names_of(commit):
    names = git("ls-tree", "-r", "--name-only", commit) if commit else git("ls-files")
    return names.decode().splitlines()


def text_of(commit, path):
    if commit:
        return git("show", f"{commit}:{path}")
    with open(path, "rb") as file:
        return file.read()


def headers_read(commit):
    """The headers of the engine that files of the laboratory include."""
    names = names_of(commit)
    included = set()
    for path in names:
        if path.startswith("src/laboratory/") and path.endswith((".h", ".cpp")):
            included.update(re.findall(r'^#include "(.+?)"', text_of(commit, path).decode(), re.M))
    return included & {name.removeprefix("src/engine/") for name in names}


def counts(commit):
    """{(house, folder): lines, or words of docs}"""
    found = collections.Counter()
    for path in names_of(commit):
        for house, (folders, parts) in HOUSES.items():
            if not path.startswith(folders) or not path.endswith(".md" if house == "docs" else CODE):
                continue
            text = text_of(commit, path)
            folder = "/".join(path.split("/")[:-1][:parts]) or path
            found[house, folder] += len(text.split()) if house == "docs" else text.count(b"\n")
    return found


def main():
    commit = sys.argv[1] if len(sys.argv) > 1 else ""
    found = counts(commit)
    print("| house | folder | lines |\n| --- | --- | ---: |")
    for house in HOUSES:
        folders = {folder: n for (of, folder), n in found.items() if of == house}
        unit = " words" if house == "docs" else ""
        print(f"| **{house}** | | **{sum(folders.values()):,}{unit}** |")
        if len(folders) > 1:
            for folder, n in sorted(folders.items()):
                print(f"| | `{folder}` | {n:,}{unit} |")
    print(f"\nThe laboratory includes {len(headers_read(commit))} headers of the engine.")


main()
