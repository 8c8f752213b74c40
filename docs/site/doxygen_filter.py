#!/usr/bin/env python3
"""doxygen_filter.py HEADER: the header as doxygen reads it, on stdout; each line stays in its place.

Comments need no marks. One before a declaration is about it, and about those that follow it without a blank line or
another comment between. One before a blank line is about nothing. One behind the declarations of a line, or in further
lines below that, is about them alone. The first of a file is about the file, and about its first type where that has
none. Destructors, moves and what is deleted or defaulted need no words and are left out, as is the namespace lightgrid: all
is in it.
"""
import re
import sys

CODE = re.compile(r"(?P<code>(?:[^/\"]|/(?!/)|\"(?:[^\"\\]|\\.)*\")*)(?P<mark>// ?)?(?P<words>.*)")
SCOPE = re.compile(r"(inline |typedef )?(struct|class|enum|union|namespace)\b|extern \"C\"|layout\(")
NEEDS_NONE = re.compile(r"(virtual )?~\w+\(.*|.*= (delete|default);|(\w+)\(\3&&\).*|static_assert.*|friend .*")
ONE = r"\w+(?:\[\d+\])?(?: = [^,;(]+)?"
DECLARATORS = re.compile(rf"((?:const )?[\w:]+(?:<[\w:]+>)?[*&]?) ({ONE}(?:, {ONE})+);")
NO_DECLARATION = re.compile(r"[{}]|(private|public|protected):|using \w+<|#(?!define)")


def plain(words):
    """Words that doxygen would take for commands or links; two more spaces before code."""
    return "  " + words if words.startswith("  ") else re.sub(r"([\\@#<>&$])", r"\\\1", words)


def line_comments(text):
    """C comments as // comments."""
    inside = False
    for line in text.split("\n"):
        opens = not inside and re.search(r"(^|\s)/\*", line)
        if inside and line.strip() == "*/":
            line = "// */"
        elif inside:
            line = re.sub(r"^(\s*) \* ?", r"\1// ", line)
        elif opens:
            line = line.replace("/*", "//", 1)
        if inside or opens:
            inside = "*/" not in line
            line = line.replace("*/", "").rstrip()
        # typedef struct NAME { … } NAME; as doxygen shows it best
        line = re.sub(r"^typedef (?=(struct|enum) \w+ \{)", "", line)
        yield re.sub(r"^\} \w+;", "};", line)


class Filter:
    def __init__(self):
        self.scopes = []         # "body" of a function, or another
        self.head = True         # in the file's first comment
        self.of_file = []        # the file's first comment, until its first type
        self.about = []          # the last comment's words, about declarations at its indent
        self.indent = 0
        self.fresh = False       # no declaration has followed that comment yet
        self.behind = None       # the column of a comment behind the last line's code
        self.unfinished = False  # the last line's code ends within a declaration

    def comment(self, indent, words, loose):
        if self.head:
            start, self.of_file = ("\\opens " if not self.of_file else ""), self.of_file + [words]
            return "/// " + start + plain(words)
        if self.behind == indent:
            return " " * indent + "///< " + plain(words)
        self.behind = None
        if loose:
            return ""
        self.about, self.indent, self.fresh = (self.about if self.fresh else []) + [words], indent, True
        return " " * indent + "/// " + plain(words)

    def declaration(self, indent, code, words):
        start = not self.unfinished
        if start and NEEDS_NONE.fullmatch(code):
            return ""
        line, behind = code, " ///< " + plain(words) if words is not None else ""
        if start and not NO_DECLARATION.match(code):
            if SCOPE.match(code) and "{" in code and not code.startswith("namespace"):
                about = [] if self.about else self.of_file
                line = ("/** " + plain(" ".join(about)) + " */ " if about else "") + code
                self.of_file = []
            spread = "/** " + plain(" ".join(self.about)) + " */ " if self.about and indent == self.indent else ""
            if words is not None:  # the end of what that comment is about
                spread, self.about = "", []
            elif not self.fresh and spread:
                line = spread + code
            self.fresh = False
            several = DECLARATORS.fullmatch(code)
            if several:  # doxygen gives a comment to one of them alone
                about = "/**< " + plain(words) + " */" if words is not None else ""
                parts = [f"{several[1]} {one};{about}" for one in several[2].split(", ")]
                line, behind = line[: len(line) - len(code)] + (" " + spread).join(parts), ""
        return " " * indent + line + behind

    def line(self, text, loose):
        found = CODE.fullmatch(text)
        code, words = found["code"], found["words"] if found["mark"] else None
        indent, stripped = len(code) - len(code.lstrip()), code.strip()
        if not stripped and words is not None:
            return text if "body" in self.scopes else self.comment(indent, words, loose)
        if self.head and stripped:
            self.head = False
        self.behind = len(code) if stripped and words is not None else None
        if not stripped:
            self.about, self.fresh = [], False
            return text
        if stripped.startswith("}") and self.scopes:
            if self.scopes.pop() != "body" and not stripped.startswith("} else"):
                self.about, self.fresh = [], False
        was_body = "body" in self.scopes
        out = text if was_body else self.declaration(indent, stripped, words)
        if stripped.endswith("{"):
            self.scopes.append("other" if SCOPE.match(stripped) and not was_body else "body")
            if self.scopes[-1] == "other":
                self.about = []
        if re.fullmatch(r"(inline )?namespace lightgrid \{|\} *// namespace lightgrid", text):
            out = ""
        self.unfinished = not re.search(r"[;{}:]$", stripped) and not stripped.startswith("#")
        if self.scopes and self.scopes[-1] == "other" and stripped.endswith(",") and not was_body and "(" not in stripped:
            self.unfinished = False  # a value of an enumeration
        return out


def main(path):
    with open(path, encoding="utf-8") as header:
        lines = list(line_comments(header.read()))
    loose = [False] * len(lines)  # a comment's line, before a blank one
    for i in reversed(range(len(lines) - 1)):
        loose[i] = lines[i].lstrip().startswith("//") and (loose[i + 1] or not lines[i + 1].strip())
    read = Filter()
    for line, is_loose in zip(lines, loose):
        print(read.line(line, is_loose))


if __name__ == "__main__":
    main(sys.argv[1])
