# SPDX-License-Identifier: MIT
"""The Markdown files of the tree: relative links lead to files and headings that exist, and so do
the paths that inline code names."""

import os
import pathlib
import re
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Hidden folders and build trees hold files of others.
SKIPPED_FOLDERS = {"build"}
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
INLINE_CODE = re.compile(r"`([^`\n]+)`")
HEADING = re.compile(r"^#{1,6} +(.+?) *#*$")
FENCE = re.compile(r"^(```|~~~)")
# `game/play` or `tests/image/paper_test.cpp`, but no option, glob or generated file.
TREE_PATH = re.compile(r"^(engine|modules|game|shaders|assets|tests|docs|scripts|cmake)/[\w./-]+$")

# What a reader fills in: `modules/NAME`.
PLACEHOLDER = re.compile(r"\b(NAME|FOLDER)\b")


def list_markdown(root):
    """All Markdown files below root, except in hidden folders and build trees. Those are not even
    entered: other tests create and remove folders in a build tree meanwhile."""
    files = []
    for folder, subfolders, names in os.walk(root):
        subfolders[:] = [f for f in subfolders
                         if not f.startswith(".") and f not in SKIPPED_FOLDERS]
        files += [pathlib.Path(folder, name) for name in names if name.endswith(".md")]
    return sorted(files)


def split_fences(text):
    """Pairs of line number and line outside of fenced code blocks."""
    in_fence = False
    for number, line in enumerate(text.splitlines(), 1):
        if FENCE.match(line.lstrip()):
            in_fence = not in_fence
        elif not in_fence:
            yield number, line


def anchor_of(heading):
    """What GitHub makes of a heading: lower case, without punctuation, spaces as hyphens."""
    text = LINK.sub(lambda m: m.group(0).split("]")[0].lstrip("!["), heading)
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")


def list_anchors(file):
    anchors = set()
    for _, line in split_fences(file.read_text(encoding="utf-8")):
        if match := HEADING.match(line):
            base = anchor = anchor_of(match.group(1))
            count = 0
            while anchor in anchors:  # GitHub numbers headings of the same text
                count += 1
                anchor = f"{base}-{count}"
            anchors.add(anchor)
    return anchors


def check_link(root, file, target):
    """The fault of a link, or None."""
    if re.match(r"[a-z][a-z0-9+.-]*:", target):
        return None
    path, _, anchor = target.partition("#")
    linked = (file.parent / path).resolve() if path else file
    if not linked.is_relative_to(root):
        return f"link {target} leads out of the tree"
    if not linked.exists():
        return f"link {target} leads to no file"
    if anchor and linked.suffix == ".md" and anchor not in list_anchors(linked):
        return f"link {target} names no heading of {linked.name}"
    return None


def list_faults(root):
    """One sentence for each broken link and each path that does not exist."""
    faults = []
    for file in list_markdown(root):
        for number, line in split_fences(file.read_text(encoding="utf-8")):
            place = f"{file.relative_to(root)}:{number}"
            prose = INLINE_CODE.sub("", line)
            for match in LINK.finditer(prose):
                if fault := check_link(root, file, match.group(1)):
                    faults.append(f"{place}: {fault}")
            for match in INLINE_CODE.finditer(line):
                path = match.group(1)
                if not TREE_PATH.match(path) or PLACEHOLDER.search(path):
                    continue
                if not (root / path).exists():
                    faults.append(f"{place}: there is no {path}")
    return faults


class TheTree(unittest.TestCase):
    def test_every_link_and_path_of_every_markdown_file_exists(self):
        files = list_markdown(ROOT)
        self.assertGreater(len(files), 10, "hardly any Markdown was found; was the test moved?")
        self.assertEqual([], list_faults(ROOT))

    def test_a_reader_of_the_readme_finds_every_page_of_docs(self):
        readme = (ROOT / "README.md").read_text(encoding="utf-8")
        linked = {match.group(1).partition("#")[0] for match in LINK.finditer(readme)}
        pages = {f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md")}
        self.assertEqual(set(), pages - linked)


class SmallTree(unittest.TestCase):
    """A tree of some pages in a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")


class BrokenLinks(SmallTree):
    def test_each_broken_link_and_path_is_a_fault_and_nothing_else_is(self):
        self.write("docs/page.md", "# A page (of `two`), and more\n\n## Same\n\n## Same\n")
        for folder in (".git", "build/release"):
            self.write(f"{folder}/page.md", "[a](none.md)\n")
        for text, *faults in (
            ("# Top\n[a](docs/page.md) [b](docs) [c](#top) [d](docs/page.md#same-1)\n"
             "[e](docs/page.md#a-page-of-two-and-more) [f](https://example.org/none.md)\n",),
            ("```\n[a](none.md)\n```\n`[a](none.md)`\n",),
            ("\n[a](docs/none.md)\n", "2: link docs/none.md leads to no file"),
            ("![a](docs/none.png)\n", "1: link docs/none.png leads to no file"),
            ("[a](docs/page.md#same-2)\n", "1: link docs/page.md#same-2 names no heading of page.md"),
            ("[a](../none.md)\n", "1: link ../none.md leads out of the tree"),
            ("`docs/page.md`, `docs/none.md`, `docs/*.md`, `none/a`, `docs/NAME.md`\n",
             "1: there is no docs/none.md"),
        ):
            with self.subTest(text=text):
                self.write("README.md", text)
                self.assertEqual([f"README.md:{fault}" for fault in faults], list_faults(self.root))


if __name__ == "__main__":
    unittest.main()
