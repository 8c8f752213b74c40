#!/usr/bin/env python3
"""build.py FOLDER PROGRAM LIBRARY HEADER...: the documentation site in FOLDER/html, of the book, the notebooks as they run
here, the interfaces and the program's own help. Exit 1 for any warning of doxygen or Sphinx and any dead link within."""
import base64
import html
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

here = pathlib.Path(__file__).resolve().parent
checkout = here.parents[1]


def run(command, **further):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, text=True, **further)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}")
    return done.stdout


def linked_pages(contents, title, named=False):
    """The pages that a section of the contents page links, in its order; named: with the link's words as their titles."""
    section = re.search(rf"^## {title}$(.*?)(?=^## |\Z)", contents, re.M | re.S)[1]
    links = re.findall(r"\[([^]]+)\]\(([\w./-]+)\.md\)", section)
    pages = [(words, os.path.normpath(f"docs/{page}")) for words, page in links]
    return [f"{words} <{page}>" if named else page for words, page in pages]


def toctree(title, pages):
    return f"```{{toctree}}\n:caption: {title}\n:maxdepth: 1\n:hidden:\n\n" + "\n".join(pages) + "\n```\n\n"


def lay_out_book(source):
    left_out = shutil.ignore_patterns("site", "*.xz", "*.ipynb")
    shutil.copytree(checkout / "docs", source / "docs", ignore=left_out)
    for file in (checkout / "README.md", checkout / "LICENSE", here / "conf.py"):
        shutil.copy(file, source)


def output_of_cell(output, stem, source):
    """An output as Markdown. A page goes to a file of its own, in a frame, and stays alive."""
    data = output.get("data", {})
    if "text/html" in data:
        frame = re.search(r'<iframe srcdoc="([^"]*)"', data["text/html"])
        if not frame:
            return f"<div>{data['text/html']}</div>"
        (source / f"live/{stem}.html").write_text(html.unescape(frame[1]), encoding="utf-8")
        return framed(f"../../_static/{stem}.html")
    if "image/png" in data:
        (source / f"docs/notebooks/{stem}.png").write_bytes(base64.b64decode(data["image/png"]))
        return f"![picture]({stem}.png)"
    text = data.get("text/plain", output.get("text", ""))
    return f"```text\n{text.rstrip()}\n```" if text.strip() else ""


def framed(page):
    return (f'<iframe src="{page}" style="width:100%;height:80vh;border:1px solid #8888"></iframe>\n'
            f'<p><a href="{page}">This page alone</a></p>')


def lay_out_notebooks(source):
    import nbclient
    import nbformat
    pages = []
    order = re.findall(r"notebooks/(\w+\.ipynb)", (checkout / "docs/python.md").read_text(encoding="utf-8"))
    for path in sorted((checkout / "docs/notebooks").glob("*.ipynb"), key=lambda path: order.index(path.name)):
        notebook = nbformat.read(path, as_version=4)
        nbclient.NotebookClient(notebook, timeout=300).execute()
        parts = []
        for number, cell in enumerate(notebook.cells):
            if cell.cell_type == "markdown":
                parts.append(cell.source)
                continue
            code = f"```python\n{cell.source}\n```"
            if "solution" in cell.metadata.get("tags", []):
                code = f"<details><summary>Solution</summary>\n\n{code}\n\n</details>"
            printed = "".join(o.text for o in cell.outputs if o.get("name") == "stdout")
            outputs = [{"text": printed}] + [o for o in cell.outputs if "name" not in o]
            shown = [output_of_cell(o, f"{path.stem}-{number}-{i}", source) for i, o in enumerate(outputs)]
            parts += [code] + [s for s in shown if s]
        shutil.copy(path, source / "docs/notebooks")
        parts.append(f"{{download}}`This notebook as a file <{path.name}>`")
        (source / f"docs/notebooks/{path.stem}.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")
        pages.append(f"docs/notebooks/{path.stem}")
    return pages


def lay_out_commands(source, program):
    overview = run([program, "--help"])
    commands = re.findall(r"^  (\w+) {2,}", overview.split("Subcommands:")[1], re.M)
    text = "# Every command's options\n\nWhat the program says itself; [the book's page](docs/command_line.md) explains.\n\n"
    text += f"```text\n{overview}```\n"
    for command in commands:
        text += f"\n## {command}\n\n```text\n{run([program, command, '--help'])}```\n"
    text += f"\n## Techniques and settings\n\n```text\n{run([program, 'techniques'])}```\n"
    (source / "commands.md").write_text(text, encoding="utf-8")


def lay_out_interfaces(source, headers):
    (source / "api").mkdir()
    shown = ("briefdescription detaileddescription innerclass define enum func typedef var public-attrib public-func "
             "public-static-func public-type")
    names = [str(h.relative_to(checkout / "src")) for h in headers if h.name != "lightgrid.h"]
    for name, title, files in (("c", "C: lightgrid.h", ["lightgrid.h"]), ("cpp", "C++: the libraries", names)):
        text = f"# {title}\n" + ("\nAll is in the namespace `lightgrid`.\n" if name == "cpp" else "")
        for file in files:
            text += f"\n## {file}\n" if len(files) > 1 else ""
            text += f"\n```{{eval-rst}}\n.. doxygenfile:: {file}\n   :sections: {shown}\n```\n"
        (source / f"api/{name}.md").write_text(text, encoding="utf-8")
    shutil.copy(here / "python_api.txt", source / "api/python.md")
    return ["api/c", "api/cpp", "api/python"]


def lay_out_live_pages(source, folder, program):
    """A report and a frontier, small, as the program writes them here."""
    run([program, "--quiet", "compare", "hall", "--size", "320x180", "-o", folder / "report"])
    run([program, "--quiet", "frontier", "hall", "--size", "160x90", "--views", "2", "--rounds", "8", "--no-growth",
         "--budget", "1", "--page-mb", "1", "-t", "forward_plus,visibility", "-t", "visibility:range=cutoff",
         "-o", folder / "frontier"])
    text = "# A report and a frontier\n\nAs the program wrote them on the machine that built this site.\n"
    for name, command in (("report", "lightgrid compare hall"), ("frontier", "lightgrid frontier hall")):
        shutil.copy(folder / name / "index.html", source / f"live/{name}.html")
        text += f"\n## {command}\n\n{framed(f'_static/{name}.html')}\n"
    (source / "live_pages.md").write_text(text, encoding="utf-8")


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.targets, self.names = [], set()

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key in ("id", "name"):
                self.names.add(value)
            if key in ("href", "src") and value:
                self.targets.append(value)


def dead_links(site):
    pages = {}
    for path in site.rglob("*.html"):
        if "_static" not in path.parts:  # a page of the program's own: one file, without links
            pages[path] = Links()
            pages[path].feed(path.read_text(encoding="utf-8"))
    for path, links in pages.items():
        for target in links.targets:
            parts = urllib.parse.urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            to = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not to.is_file() or (parts.fragment and to in pages
                                    and urllib.parse.unquote(parts.fragment) not in pages[to].names):
                yield f"{path.relative_to(site)}: {target} leads nowhere"


def main(folder, program, library, *headers):
    folder, headers = pathlib.Path(folder).resolve(), [pathlib.Path(h).resolve() for h in headers]
    os.environ.update(LIGHTGRID_PROGRAM=program, LIGHTGRID_LIBRARY=library, PYTHONPATH=str(checkout / "python"),
                      PYTHONDONTWRITEBYTECODE="1", PYDEVD_DISABLE_FILE_VALIDATION="1", LIGHTGRID_API_XML=str(folder / "api/xml"))
    source, site = folder / "source", folder / "html"
    for old in (source, site, folder / "doctrees"):
        shutil.rmtree(old, ignore_errors=True)
    (source / "live").mkdir(parents=True)
    shutil.copy(here / "site.css", source / "live")
    run([here / "api_xml", folder / "api", *headers])
    lay_out_book(source)
    notebooks = lay_out_notebooks(source)
    lay_out_commands(source, program)
    lay_out_live_pages(source, folder, program)
    interfaces = lay_out_interfaces(source, headers)
    contents = (checkout / "docs/README.md").read_text(encoding="utf-8")
    book = linked_pages(contents, "The book")
    text = "# lightgrid\n\n" + (here / "front.txt").read_text(encoding="utf-8") + "\n"
    text += toctree("The book", book) + toctree("Notebooks", notebooks)
    examples = sorted(str(p.relative_to(checkout).with_suffix("")) for p in (checkout / "docs/examples").rglob("*.md"))
    text += toctree("Reference", ["docs/README", "commands", *interfaces, *linked_pages(contents, "Reference"), *examples])
    text += toctree("Results", ["live_pages"] + linked_pages(contents, "Results"))
    text += toctree("Lab notes", linked_pages(contents, "Lab notes", named=True))
    (source / "index.md").write_text(text, encoding="utf-8")
    print(run([sys.executable, "-m", "sphinx", "-n", "-W", "--keep-going", "-q", "-b", "html",
               "-d", folder / "doctrees", source, site]), end="")
    dead = sorted(dead_links(site))
    if dead:
        sys.exit("\n".join(dead))
    print(site / "index.html")


if __name__ == "__main__":
    main(*sys.argv[1:])
