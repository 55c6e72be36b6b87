# SPDX-License-Identifier: MIT
"""scripts/check_tidy.sh names files with faults, and judges in one version only."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]
NOT_CHECKED = 77
FAULTY = """#include <memory>
#include <utility>
int read(std::unique_ptr<int> one) {
    const std::unique_ptr<int> other = std::move(one);
    return *one + *other;
}
"""
SOUND = FAULTY.replace("*one + *other", "*other")


class CheckTidy(unittest.TestCase):
    """A repository of two sources and a header that one of them includes, with the script in it."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.root = self.folder / "tree"
        (self.root / "scripts/lib").mkdir(parents=True)
        for name in ("check_tidy.sh", "lib/messages.sh", "lib/llvm_tools.sh"):
            shutil.copy(ROOT / "scripts" / name, self.root / "scripts" / name)
        shutil.copy(ROOT / ".clang-tidy", self.root)
        self.write("engine/a.cpp", f'#include "engine/a.h"\n{SOUND}')
        self.write("engine/a.h", "#pragma once\n")
        self.write("engine/b.cpp", SOUND)
        self.write("build/release/compile_commands.json", json.dumps([
            {"directory": str(self.root), "file": f"engine/{name}.cpp",
             "command": f"c++ -std=c++20 -I. -c engine/{name}.cpp"} for name in "ab"]))
        self.git("init", "--quiet")
        self.git("add", "engine")
        self.git("-c", "user.name=A", "-c", "user.email=a@example.org",
                 "commit", "--quiet", "--message", "engine: add it")

    def git(self, *arguments):
        subprocess.run(["git", *arguments], cwd=self.root, check=True)

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def check(self, *arguments, path=None):
        environment = {**os.environ, "PATH": path or os.environ["PATH"]}
        return subprocess.run(["bash", self.root / "scripts/check_tidy.sh", *arguments],
                              env=environment, capture_output=True, text=True, check=False)

    def make_path(self, version=None):
        """A PATH before which only a clang-tidy of this version stands, if any. It finds fault with
        the files whose names begin with b."""
        programs = self.folder / "bin"
        programs.mkdir()
        for name in ("bash", "cat", "comm", "cp", "dirname", "git", "grep", "mktemp", "nproc", "rm", "sed",
                     "sort", "wc", "xargs"):
            (programs / name).symlink_to(shutil.which(name))
        if version:
            fake = programs / "clang-tidy"
            fake.write_text(f"#!{shutil.which('bash')}\n"
                            f"[[ $1 != --version ]] || {{ echo 'LLVM version {version}.0.6'; exit; }}\n"
                            "[[ ${!#} != */b.cpp ]] || { echo 'a fault of b'; exit 1; }\n")
            fake.chmod(0o755)
        return str(programs)

    def test_a_fault_is_named_with_its_file(self):
        self.write("engine/b.cpp", FAULTY)
        done = self.check()
        if done.returncode == NOT_CHECKED:
            self.skipTest(done.stderr)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("bugprone-use-after-move", done.stderr)
        self.assertIn("1 of 2 files have faults: engine/b.cpp\n", done.stderr)
        self.write("engine/b.cpp", SOUND)
        done = self.check()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("2 files", done.stdout)

    def test_a_file_that_does_not_compile_is_a_fault(self):
        self.write("engine/b.cpp", "int read(\n")
        done = self.check("engine/b.cpp")
        if done.returncode == NOT_CHECKED:
            self.skipTest(done.stderr)
        self.assertEqual(done.returncode, 1)

    def test_a_header_that_gcc_precompiled_is_not_read(self):
        header = self.root / "build/release/CMakeFiles/a.dir/cmake_pch.hxx"
        self.write(header, "#include <memory>\n#include <utility>\n")
        self.write(f"{header}.gch", "gpch")
        self.write("build/release/compile_commands.json", json.dumps([
            {"directory": str(self.root), "file": "engine/a.cpp", "command":
             f"c++ -std=c++20 -I. -fpch-preprocess -Winvalid-pch -include {header} -c engine/a.cpp"}]))
        done = self.check("engine/a.cpp")
        if done.returncode == NOT_CHECKED:
            self.skipTest(done.stderr)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.write("engine/a.cpp", SOUND.replace("#include <memory>", ""))
        self.assertEqual(self.check("engine/a.cpp").returncode, 1, "its own includes must do")

    def test_every_file_is_checked_and_each_faulty_one_named(self):
        done = self.check(path=self.make_path(version=14))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("a fault of b", done.stderr)
        self.assertIn("1 of 2 files", done.stderr)

    def test_files_that_were_named_are_checked_and_no_others(self):
        path = self.make_path(version=14)
        self.assertEqual(self.check("engine/a.cpp", path=path).returncode, 0)
        self.assertEqual(self.check("engine/b.cpp", path=path).returncode, 1)

    def test_a_folder_stands_for_its_files(self):
        path = self.make_path(version=14)
        self.write("game/c.cpp", SOUND)
        self.assertIn("1 of 2 files", self.check("engine", path=path).stderr)
        self.assertIn("1 files", self.check("game/", path=path).stdout)
        done = self.check("game", "none", path=path)
        self.assertEqual(done.returncode, 1)
        self.assertIn("no .cpp file in none", done.stderr)

    def test_since_a_revision_only_what_changed_is_checked(self):
        path = self.make_path(version=14)
        done = self.check("--since", "HEAD", path=path)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("no file", done.stdout)
        self.write("engine/a.h", "#pragma once\n\nint a();\n")
        done = self.check("--since", "HEAD", path=path)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("1 files", done.stdout)
        self.write("engine/b.cpp", FAULTY)
        done = self.check("--since", "HEAD", path=path)
        self.assertIn("1 of 2 files", done.stderr)

    def test_a_new_file_counts_as_changed(self):
        path = self.make_path(version=14)
        self.write("engine/new.cpp", "int a();\n")
        self.assertIn("1 files", self.check("--since", "HEAD", path=path).stdout)

    def test_a_revision_that_does_not_exist_is_an_error(self):
        done = self.check("--since", "none", path=self.make_path(version=14))
        self.assertEqual(done.returncode, 1)
        self.assertIn("none is no revision", done.stderr)

    def test_a_folder_that_is_not_configured_is_an_error(self):
        done = self.check("--build", "build/none", path=self.make_path(version=14))
        self.assertEqual(done.returncode, 1)
        self.assertIn("build/none is not configured", done.stderr)

    def test_another_version_is_told_and_judges_nothing(self):
        done = self.check(path=self.make_path(version=99))
        self.assertEqual((done.returncode, done.stdout), (NOT_CHECKED, ""))
        self.assertIn("version 99", done.stderr)

    def test_no_version_at_all_is_told(self):
        done = self.check(path=self.make_path())
        self.assertEqual((done.returncode, done.stdout), (NOT_CHECKED, ""))
        self.assertIn("is not installed", done.stderr)

    def test_wrong_usage_is_refused(self):
        for arguments in (["--sins", "HEAD"], ["--since"], ["--build"],
                          ["--since", "HEAD", "engine"]):
            self.assertEqual(self.check(*arguments).returncode, 2)


if __name__ == "__main__":
    unittest.main()
