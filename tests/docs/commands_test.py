# SPDX-License-Identifier: MIT
"""The commands of the pages, for a reader whose tree was set up by scripts/demo.sh alone: pages name
first what commands need that it does not do."""

import os
import re
import subprocess
import unittest

import links_test

ROOT = links_test.ROOT
COMMAND = re.compile(r"(?:\w+=\S+ )*(?:shutter|cmake|scripts/\S+|build/\S+) ?")
# A command, and what scripts/demo.sh does not do and has to be above it, or on a page that this one links to.
NEEDS = (
    (re.compile(r"shutter bench (?!.*--report-only)"), "cmake --build --preset release --target shutter_bench"),
    (re.compile(r"cmake --install build/release "), "cmake --build --preset release"),
    (re.compile(r"cmake .*-DCMAKE_PREFIX_PATH=PREFIX"), "cmake --install build/release --prefix PREFIX"),
)


def list_commands(page):
    """Pairs of line number and command of the fenced blocks without a language. Comments are removed, lines
    that go on joined."""
    in_fence = is_plain = False
    begun = ""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if links_test.FENCE.match(line.lstrip()):
            in_fence = not in_fence
            is_plain = in_fence and line.strip("`~ ") == ""
            continue
        text = begun + re.sub(r"(^|\s+)# .*", "", line.strip())
        if not is_plain or not (begun or COMMAND.match(text)):
            continue
        if text.endswith("\\"):
            begun = text[:-1]
            continue
        begun = ""
        for command in text.split(" && "):
            yield number, command.strip()


def list_pages():
    """Those for users of a tree that scripts/demo.sh has set up; pages of the tests are for theirs."""
    return [page for page in links_test.list_markdown(ROOT) if (ROOT / "tests") not in page.parents]


def list_all():
    for page in list_pages():
        for number, command in list_commands(page):
            yield f"{page.relative_to(ROOT)}:{number}", command


def list_unmet():
    """A sentence for each command that needs what neither scripts/demo.sh nor the page's commands above it do."""
    pages = {page: [command for _, command in list_commands(page)] for page in list_pages()}
    for page, commands in pages.items():
        linked = {(page.parent / match.group(1).partition("#")[0]).resolve()
                  for match in links_test.LINK.finditer(page.read_text(encoding="utf-8"))}
        for i, command in enumerate(commands):
            for pattern, needed in NEEDS:
                if pattern.match(command) and needed not in commands[:i] and not any(
                        needed in pages.get(other, []) for other in linked):
                    yield f"{page.relative_to(ROOT)}: `{command}` comes without `{needed}`"


class Commands(unittest.TestCase):
    def test_what_a_command_needs_beyond_the_demo_script_comes_first(self):
        self.assertEqual([], list(list_unmet()))

    def test_scripts_exist(self):
        commands = list(list_all())
        self.assertGreater(len(commands), 40, "hardly any command was found")
        for place, command in commands:
            if command.startswith("scripts/"):
                self.assertTrue(os.access(ROOT / command.split()[0], os.X_OK), place)

    def test_the_demo_script_installs_what_films_are_encoded_by(self):
        packages = subprocess.run(
            ["bash", "-c", 'llvm_version=0; source "$0"; echo "${build_packages[@]}"',
             ROOT / "scripts/lib/packages.sh"], capture_output=True, text=True, check=True).stdout.split()
        self.assertIn("ffmpeg", packages)


if __name__ == "__main__":
    unittest.main()
