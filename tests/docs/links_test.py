# SPDX-License-Identifier: MIT
"""The Markdown files of the tree: relative links lead to files and headings that exist, and so do
the paths that inline code names."""

import os
import pathlib
import re
import tempfile
import unittest
import unittest.mock

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


class ASmallTree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        self.write("docs/page.md", "# A page (of `two`), and more\n\n## Same\n\n## Same\n")

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")

    def faults_of(self, text):
        self.write("README.md", text)
        return list_faults(self.root)

    def test_links_to_files_folders_headings_and_other_sites_are_right(self):
        self.assertEqual([], self.faults_of(
            "# Top\n[a](docs/page.md) [b](docs) [c](#top) [d](docs/page.md#same-1)\n"
            "[e](docs/page.md#a-page-of-two-and-more) [f](https://example.org/none.md)\n"))

    def test_a_link_to_no_file_is_a_fault_with_its_place(self):
        self.assertEqual(["README.md:2: link docs/none.md leads to no file"],
                         self.faults_of("\n[a](docs/none.md)\n"))

    def test_a_picture_that_is_missing_is_a_fault(self):
        self.assertEqual(1, len(self.faults_of("![a](docs/none.png)\n")))

    def test_a_link_to_no_heading_is_a_fault(self):
        self.assertEqual(2, len(self.faults_of("[a](docs/page.md#same-2) [b](#none)\n")))

    def test_a_link_out_of_the_tree_is_a_fault(self):
        self.assertEqual(1, len(self.faults_of("[a](../none.md)\n")))

    def test_a_path_in_code_that_does_not_exist_is_a_fault(self):
        self.assertEqual(["README.md:1: there is no docs/none.md"],
                         self.faults_of("`docs/page.md`, `docs/none.md`, `docs/*.md`, `none/a`, "
                                        "`docs/NAME.md`\n"))

    def test_code_blocks_and_links_in_code_are_passed_over(self):
        self.assertEqual([], self.faults_of("```\n[a](none.md)\n```\n`[a](none.md)`\n"))

    def test_hidden_folders_and_build_trees_are_passed_over(self):
        for folder in (".git", "build/release"):
            self.write(f"{folder}/page.md", "[a](none.md)\n")
        list_folder = os.scandir

        def list_folder_of_tree(path):
            self.assertNotIn("build", pathlib.Path(path).parts)
            return list_folder(path)

        with unittest.mock.patch("os.scandir", list_folder_of_tree):
            self.assertEqual([], self.faults_of(""))


if __name__ == "__main__":
    unittest.main()
