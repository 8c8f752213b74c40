#!/usr/bin/env python3
"""size.py [COMMIT]: lines per house and folder, words of the documentation, as a table in Markdown.

Counts files that git tracks, those of COMMIT where one is given. Lines are all lines of C++, kernels, shaders,
scripts and build files; words are those of Markdown pages, separated by white space.
"""
import collections
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


def counts(commit):
    """{(house, folder): lines, or words of docs}"""
    found = collections.Counter()
    names = git("ls-tree", "-r", "--name-only", commit) if commit else git("ls-files")
    for path in names.decode().splitlines():
        for house, (folders, parts) in HOUSES.items():
            if not path.startswith(folders) or not path.endswith(".md" if house == "docs" else CODE):
                continue
            if commit:
                text = git("show", f"{commit}:{path}")
            else:
                with open(path, "rb") as file:
                    text = file.read()
            folder = "/".join(path.split("/")[:-1][:parts]) or path
            found[house, folder] += len(text.split()) if house == "docs" else text.count(b"\n")
    return found


def main():
    found = counts(sys.argv[1] if len(sys.argv) > 1 else "")
    print("| house | folder | lines |\n| --- | --- | ---: |")
    for house in HOUSES:
        folders = {folder: n for (of, folder), n in found.items() if of == house}
        unit = " words" if house == "docs" else ""
        print(f"| **{house}** | | **{sum(folders.values()):,}{unit}** |")
        if len(folders) > 1:
            for folder, n in sorted(folders.items()):
                print(f"| | `{folder}` | {n:,}{unit} |")


main()
