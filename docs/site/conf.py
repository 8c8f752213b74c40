# The site's settings for Sphinx; build.py lays out the sources that they are for.
import os
import re

project, author, html_title = "lightgrid", "the authors of lightgrid", "lightgrid"
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc"]
source_suffix = {".md": "markdown"}
root_doc = "index"
highlight_language = "none"
nitpicky = True

myst_heading_anchors = 6
suppress_warnings = ["myst.header"]  # a first heading of another level: pages of tables

breathe_projects = {"lightgrid": os.environ["LIGHTGRID_API_XML"]}
breathe_default_project = "lightgrid"
breathe_domain_by_extension = {"h": "cpp"}
breathe_domain_by_file_pattern = {"*/lightgrid.h": "c"}
breathe_show_include = False

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
# Names of other projects, whose pages the site does not link.
nitpick_ignore_regex = [("c:identifier", r"u?int\d+_t|size_t|ptrdiff_t"),
                        ("cpp:identifier", r"(std|cl|glm|fmt)(::.*)?|u?int\d+_t|size_t|cl_\w+|uint|MOST_\w+"),
                        ("py:.*", r"(np|numpy|os|typing|collections)\..*|optional|[A-Z]\w*Error")]

html_theme = "furo"
html_show_sphinx = html_show_copyright = html_copy_source = False
html_static_path = ["live"]
html_css_files = ["site.css"]
smartquotes = False  # --set


def links_to_notebooks(app, name, source):
    """The book names notebooks as files; here they are pages."""
    source[0] = re.sub(r"(\]\([\w./]*)\.ipynb\)", r"\1.md)", source[0])


def code_in_words(app, what, name, value, options, lines):
    """A module's example is code, as in Markdown."""
    first = next((i for i, line in enumerate(lines) if line.startswith("    ")), None)
    if what == "module" and first:
        lines[first:first] = ["::", ""]


def setup(app):
    app.connect("source-read", links_to_notebooks)
    app.connect("autodoc-process-docstring", code_in_words)
