# SPDX-License-Identifier: MIT
"""Code in the Markdown files that a build compiles: a block whose first line is a comment with a path
holds lines of that file, in one piece."""

import textwrap
import unittest

import links_test

ROOT = links_test.ROOT
COMMENT = "// "
# Pages that show how to add something.
TUTORIALS = ("game/demos/README.md", "game/examples/README.md", "modules/motion_blur/README.md")


def list_quotes(text):
    """For each quote the number of its first line, the path, and the lines below that."""
    block = None
    for number, line in enumerate(text.splitlines(), 1):
        if links_test.FENCE.match(line):
            if block and block[1] and is_path(block[1][0]):
                yield block[0] + 1, block[1][0].removeprefix(COMMENT), block[1][1:]
            block = None if block else (number, [])
        elif block:
            block[1].append(line)


def is_path(line):
    return line.startswith(COMMENT) and bool(links_test.TREE_PATH.match(line.removeprefix(COMMENT)))


def normalise(lines):
    """Without what all lines are indented by, and without empty ones, which pages leave out."""
    return [line.rstrip() for line in textwrap.dedent("\n".join(lines)).splitlines() if line.strip()]


def find_start(lines, quote):
    """Where in the lines the quote begins, or None."""
    for start in range(len(lines) - len(quote) + 1):
        if normalise(lines[start:start + len(quote)]) == quote:
            return start
    return None


def find_fault(root, path, lines):
    """The fault of a quote, or None."""
    if not (root / path).is_file():
        return f"there is no {path}"
    source = [line for line in (root / path).read_text(encoding="utf-8").splitlines() if line.strip()]
    quote = normalise(lines)
    if not quote:
        return f"quotes nothing of {path}"
    if find_start(source, quote) is not None:
        return None
    known = {line.strip() for line in source}
    strange = next((line.strip() for line in quote if line.strip() not in known), None)
    return f"{path} has no line {strange!r}" if strange else f"{path} has not these lines in one piece"


def list_faults(root):
    return [f"{page.relative_to(root)}:{number}: {fault}" for page in links_test.list_markdown(root)
            for number, path, lines in list_quotes(page.read_text(encoding="utf-8"))
            if (fault := find_fault(root, path, lines))]


class TheTree(unittest.TestCase):
    def test_what_pages_quote_is_in_the_sources(self):
        self.assertEqual([], list_faults(ROOT))

    def test_each_tutorial_quotes_a_source(self):
        for page in TUTORIALS:
            with self.subTest(page):
                self.assertTrue(list(list_quotes((ROOT / page).read_text(encoding="utf-8"))))


class Quotes(links_test.SmallTree):
    def test_each_quote_that_is_not_in_its_source_is_a_fault(self):
        self.write("game/a.h", "namespace a {\n    int one();\n\n    int two();\n} // namespace a\n")
        for block, *faults in (
            ("// game/a.h\nint one();\nint two();",),
            ("// game/a.h\n    int two();\n} // namespace a",),
            ("int three();",),
            ("// a comment\nint three();",),
            ("// game/a.h\nint one();\nint three();", "2: game/a.h has no line 'int three();'"),
            ("// game/a.h\nint two();\nint one();", "2: game/a.h has not these lines in one piece"),
            ("// game/a.h", "2: quotes nothing of game/a.h"),
            ("// game/b.h\nint one();", "2: there is no game/b.h"),
        ):
            with self.subTest(block):
                self.write("page.md", f"```cpp\n{block}\n```\n")
                self.assertEqual([f"page.md:{fault}" for fault in faults], list_faults(self.root))


if __name__ == "__main__":
    unittest.main()
