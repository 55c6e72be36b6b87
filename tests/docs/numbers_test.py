# SPDX-License-Identifier: MIT
"""Numbers in the Markdown files: those that link to where they come from are there, and every page
that quotes measurements is in the list of docs/measuring.md, which has the commands. The pages of
docs are few and short."""

import pathlib
import re
import unittest

import links_test

ROOT = pathlib.Path(__file__).resolve().parents[2]
MAX_PAGES = 10
# Two screens.
MAX_LINES = 120
# Written by scripts/figures.py: tables, as many as there are suites.
GENERATED = "docs/figures.md"
LIST = "docs/measuring.md"
LIST_HEADING = "numbers"

NUMBER = re.compile(r"(?<![\w.,-])[+-]?\d[\d,]*(?:\.\d+)?(?![\w]|[.,]\d)")
CODE = re.compile(r"`([^`]+)`")
LINK = re.compile(r"\[([^\]]*)\]\(([^)\s]+)\)")
# A paragraph that begins so names the sections that the table below it repeats numbers of.
FROM = re.compile(r"^From (?=\[)")
# What only a measurement yields. Times in whole milliseconds are mostly settings.
MEASURED = re.compile(r"\d dB\b|\d\.\d+ ms\b|times as long|\bPSNR[^|`]*\d\d\.\d|\| *PSNR, dB *\|")


def list_numbers(text):
    """Numbers as they are written, without signs of thousands."""
    return [number.replace(",", "") for number in NUMBER.findall(text)]


def unfence(file):
    """A page whose fenced code blocks are empty lines."""
    text = file.read_text(encoding="utf-8")
    lines = [""] * len(text.splitlines())
    for number, line in links_test.split_fences(text):
        lines[number - 1] = line
    return "\n".join(lines)


def split_cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def is_rule(cells):
    return all(re.fullmatch(r":?-+:?", cell) for cell in cells)


class Table:
    """Cells with the words in code of row, column and corner, and the paragraph above."""

    def __init__(self, number, head, paragraph):
        self.number = number
        self.head = head
        self.paragraph = paragraph
        self.cells = []  # line number, names, text

    def add(self, number, cells):
        # Leading cells without a number outside of code or words name the row.
        labels = [cell for i, cell in enumerate(cells) if i == 0 or not list_numbers(CODE.sub("", cell))]
        row = set(CODE.findall(" ".join([self.head[0], *labels])))
        for heading, cell in zip(self.head[1:], cells[1:]):
            if list_numbers(cell):
                self.cells.append((number, row | set(CODE.findall(heading)), cell))


def list_tables(file):
    """The tables of a page: pairs of the anchor of the heading above, and a table."""
    tables, anchors = [], []
    paragraph, table, head = "", None, None
    for number, line in links_test.split_fences(file.read_text(encoding="utf-8")):
        if heading := links_test.HEADING.match(line):
            level = len(line) - len(line.lstrip("#"))
            anchors = anchors[:level - 1]
            anchors += [None] * (level - 1 - len(anchors)) + [links_test.anchor_of(heading.group(1))]
            paragraph, table, head = "", None, None
        elif line.startswith("|"):
            cells = split_cells(line)
            if table is not None:
                table.add(number, cells)
            elif head is not None and is_rule(cells):
                table = Table(number, head, paragraph)
                tables.append((set(anchors), table))
            else:
                head = cells
        elif line.strip():
            paragraph = line if table or head or paragraph.endswith("\n") else f"{paragraph} {line}".strip()
            table, head = None, None
        else:
            if paragraph:
                paragraph = paragraph.rstrip("\n") + "\n"
            if table:
                paragraph, table, head = "", None, None
    return tables


def agrees(quoted, exact):
    """Whether a number is another one, rounded to as many places as it has."""
    places = len(quoted.partition(".")[2])
    return abs(float(quoted) - float(exact)) <= 0.5 * 10 ** -places * (1 + 1e-9)


class Source:
    """The numbers of all tables of a page."""

    def __init__(self, file):
        self.tables = list_tables(file)

    def has(self, anchor, names, number):
        return any(names <= cell_names and any(agrees(number, other) for other in list_numbers(text))
                   for anchors, table in self.tables if not anchor or anchor in anchors
                   for _, cell_names, text in table.cells)


class Checker:
    def __init__(self, root):
        self.root = root
        self.sources = {}

    def source(self, path):
        if path not in self.sources:
            self.sources[path] = Source(path)
        return self.sources[path]

    def resolve(self, file, target):
        """Page and anchor of a link to Markdown that exists, or None: links_test reports others."""
        path, _, anchor = target.partition("#")
        linked = (file.parent / path).resolve() if path else file
        return (linked, anchor) if linked.suffix == ".md" and linked.exists() else None

    def find_fault(self, place, targets, names, text):
        for number in list_numbers(CODE.sub("", text)):
            if not any(self.source(page).has(anchor, names, number) for page, anchor in targets):
                of = f" of {', '.join(sorted(names))}" if names else ""
                pages = ", ".join(page.name + (f"#{anchor}" if anchor else "") for page, anchor in targets)
                yield f"{place}: no table of {pages} has {number}{of}"

    def list_faults(self, file):
        name = file.relative_to(self.root)
        prose = unfence(file)
        for link in LINK.finditer(prose):
            number, text = 1 + prose.count("\n", 0, link.start()), link.group(1)
            if (to := self.resolve(file, link.group(2))) and to[0] != file:
                yield from self.find_fault(f"{name}:{number}", [to], set(CODE.findall(text)), text)
        for _, table in list_tables(file):
            if not FROM.match(table.paragraph):
                continue
            targets = [to for _, target in LINK.findall(table.paragraph) if (to := self.resolve(file, target))]
            for number, names, text in table.cells:
                yield from self.find_fault(f"{name}:{number}", targets, names, text)


def list_false_claims(root):
    """A sentence for each number that is not where it links to."""
    checker = Checker(root)
    return [fault for file in links_test.list_markdown(root) for fault in checker.list_faults(file)]


def list_section(file, anchor):
    """Lines below a heading, up to the next of its level."""
    level = None
    for _, line in links_test.split_fences(file.read_text(encoding="utf-8")):
        if heading := links_test.HEADING.match(line):
            depth = len(line) - len(line.lstrip("#"))
            if level is None:
                level = depth if links_test.anchor_of(heading.group(1)) == anchor else None
                continue
            if depth <= level:
                return
        if level is not None:
            yield line


def is_measured(file):
    return any(MEASURED.search(line)
               for _, line in links_test.split_fences(file.read_text(encoding="utf-8")))


def list_unlisted(root):
    """A sentence for each page that quotes measurements and is not in the list, and for each in the
    list that quotes none."""
    listed = set()
    page = root / LIST
    for line in list_section(page, LIST_HEADING):
        for _, target in LINK.findall(line):
            path = target.partition("#")[0]
            listed.add((page.parent / path).resolve() if path else page)
    faults = []
    for file in links_test.list_markdown(root):
        if file == page:
            continue
        if is_measured(file) != (file in listed):
            state = "has no link in" if file not in listed else "quotes nothing that was measured, but is in"
            faults.append(f"{file.relative_to(root)} {state} {LIST}#{LIST_HEADING}")
    return faults


def list_long_pages(root):
    """A sentence for each way in which docs is larger than it may be."""
    pages = sorted((root / "docs").rglob("*.md"))
    faults = []
    if len(pages) > MAX_PAGES:
        faults.append(f"docs has {len(pages)} pages, more than {MAX_PAGES}")
    for page in pages:
        path = str(page.relative_to(root))
        lines = len(page.read_text(encoding="utf-8").splitlines())
        if lines > MAX_LINES and path != GENERATED:
            faults.append(f"{path} has {lines} lines, more than {MAX_LINES}")
    return faults


class TheTree(unittest.TestCase):
    def test_every_number_that_links_to_its_table_is_in_it(self):
        self.assertEqual([], list_false_claims(ROOT))

    def test_every_page_that_quotes_measurements_is_in_the_list(self):
        self.assertEqual([], list_unlisted(ROOT))

    def test_docs_has_few_short_pages(self):
        self.assertEqual([], list_long_pages(ROOT))


FIGURES = """# Figures

## Suite `edges`

PSNR, dB:

| method | `--aa` | `vase` | `courtyard` |
|---|---|---|---|
| `sharp` | `none` | 24.31 | 26.18 |
| `resolved` | `taa` | 43.86 | 1,285.5 |

## Suite `paper`

| method on `vase` | PSNR, dB |
|---|---|
| `sharp` | 25.94 |
"""


class Claims(links_test.SmallTree):
    def setUp(self):
        super().setUp()
        self.write("docs/figures.md", FIGURES)

    def test_each_number_that_is_not_where_it_links_to_is_a_fault(self):
        table = ("From [figures](docs/figures.md#suite-edges),\nin dB:\n\n"
                 "| shot | `sharp` | `resolved` |\n|---|---|---|\n")
        for text, *faults in (
            ("It has [43.86 dB](docs/figures.md#suite-edges).\n",),
            ("It has [43.85 dB](docs/figures.md#suite-edges).\n",
             "1: no table of figures.md#suite-edges has 43.85"),
            ("[43.86](docs/figures.md#suite-paper)\n", "1: no table of figures.md#suite-paper has 43.86"),
            # Over two lines, and below a block of code.
            ("```\n```\nIt has [43.85\ndB](docs/figures.md).\n", "3: no table of figures.md has 43.85"),
            # Rounded, and with a sign of thousands.
            ("[43.9](docs/figures.md) [44](docs/figures.md) [1,285](docs/figures.md) [1286](docs/figures.md)",),
            ("[43.8](docs/figures.md)", "1: no table of figures.md has 43.8"),
            # Words in code name row and column.
            ("[`vase`, `taa`: 43.9 dB](docs/figures.md) [`vase`, `sharp`: 25.9 dB](docs/figures.md)\n",),
            ("[`courtyard`, `taa`: 43.9 dB](docs/figures.md)\n",
             "1: no table of figures.md has 43.9 of courtyard, taa"),
            # Tables that say where their numbers are from, and others.
            (table + "| `vase`, 5 % moves | 24.3 | **43.9** |\n",),
            (table + "| `courtyard` | 24.3 | |\n",
             "6: no table of figures.md#suite-edges has 24.3 of courtyard, sharp"),
            (table + "| `vase` | 24.3 (24.4) | 43.9 |\n",
             "6: no table of figures.md#suite-edges has 24.4 of sharp, vase"),
            ("[12 pages](https://example.org) and [`A7`](docs/figures.md)\n\nOwn:\n\n"
             "| shot | `sharp` |\n|---|---|\n| `vase` | 1.0 |\n",),
        ):
            with self.subTest(text=text):
                self.write("README.md", text)
                self.assertEqual([f"README.md:{fault}" for fault in faults], list_false_claims(self.root))

    def test_pages_that_quote_measurements_and_no_others_are_in_the_list(self):
        both = "| `shutter bench` | [figures](figures.md), [README](../README.md) |"
        unlisted = ["README.md has no link in docs/measuring.md#numbers"]
        needless = ["README.md quotes nothing that was measured, but is in docs/measuring.md#numbers"]
        for text, is_measured_text in (
            ("It gains 3 dB.\n", True),
            ("It takes 0.31 ms.\n", True),
            ("It takes 1.3 times as long.\n", True),
            ("| a | PSNR, dB |\n|---|---|\n| b | 1 |\n", True),
            ("`--budget 2`: ms of a frame\n", False),
        ):
            self.write("README.md", text)
            for listed, faults in ((both, [] if is_measured_text else needless),
                                   ("[figures](figures.md)", unlisted if is_measured_text else [])):
                with self.subTest(text=text, listed=listed):
                    self.write("docs/measuring.md",
                               f"# Measuring\n\n## Numbers\n\n{listed}\n\n## Other\n\n[a](../README.md)\n")
                    self.assertEqual(faults, list_unlisted(self.root))

    def test_a_long_page_that_is_not_generated_and_an_eleventh_page_are_faults(self):
        self.write("docs/figures.md", "\n" * 500)
        for i in range(9):
            self.write(f"docs/page{i}.md", "\n" * 120)
        self.assertEqual([], list_long_pages(self.root))
        self.write("docs/folder/page.md", "\n" * 121)
        self.assertEqual(["docs has 11 pages, more than 10",
                          "docs/folder/page.md has 121 lines, more than 120"], list_long_pages(self.root))


if __name__ == "__main__":
    unittest.main()
