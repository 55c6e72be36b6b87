# SPDX-License-Identifier: MIT
"""The tree as it is, against the table of dependence and two rules of its text."""

import functools
import pathlib
import re
import unittest

import layer_table
import sources

ROOT = pathlib.Path(__file__).resolve().parents[2]
NO_SOURCES = (".md", ".txt", ".json", ".cmake")
# A compiler may assume in Vulkan that no float is NaN or infinite, so that it may drop these: only a test
# of the bits (shaders/common/numeric.glsl) holds. An operand is a name, members and indices; what all but
# infinity are below begins at 3.4e38.
NAN_TEST = re.compile(r"(?:^|[^\w.\]])([A-Za-z_]\w*(?:\.\w+|\[\w+\])*)\s*[!=]=\s*\1(?![\w.\[(])"
                      r"|(?:^|[^\w])is(?:nan|inf)\s*\("
                      r"|(?:[<>]|[<>=!]=)\s*-?3\.4\d*[eE]\+?38")


@functools.cache
def is_file(path):
    return (ROOT / path).is_file()


def list_folders(folder):
    return {path.name for path in (ROOT / folder).iterdir() if path.is_dir()}


class Layering(unittest.TestCase):
    def test_every_part_keeps_the_order_of_dependence(self):
        for folder in ("engine", "modules", "game", "assets/generator", "shaders"):
            includes = [include for file in sources.list_files(ROOT, folder)
                        if not file.endswith(NO_SOURCES)
                        for include in sources.read_includes(
                            file, sources.blank_comments(sources.read(ROOT / file)))]
            self.assertTrue(includes, f"{folder} holds no include; was it moved?")
            faults = [layer_table.find_violation(include, is_file) for include in includes]
            self.assertEqual([fault for fault in faults if fault], [])

    def test_every_row_has_a_folder_and_every_shader_folder_an_owner(self):
        self.assertEqual(list_folders("engine"), set(layer_table.ENGINE))
        owners = list_folders("engine") | list_folders("modules") | {"common"}
        self.assertEqual(list_folders("shaders") - owners, set())

    def test_the_tree_includes_the_standard_headers_that_it_uses(self):
        tree = sources.Sources(ROOT, "engine", "modules", "game", "assets", "shaders", "tests")
        self.assertGreater(len(tree.files), 500, "were the sources moved?")
        self.assertEqual(list(tree.find_missing_headers()), [])

    def test_no_shader_tests_for_nan_by_a_comparison(self):
        for line in ("if (!(v.x == v.x))", "return isnan(x);", "abs(x) <= 3.402823e38f"):
            self.assertTrue(NAN_TEST.search(line), line)
        files = sources.list_files(ROOT, "shaders")
        self.assertGreater(len(files), 50, "were the shaders moved?")
        for file in files:
            for line in sources.blank_comments(sources.read(ROOT / file)).splitlines():
                self.assertIsNone(NAN_TEST.search(line), f"{file}: {line}")


if __name__ == "__main__":
    unittest.main()
