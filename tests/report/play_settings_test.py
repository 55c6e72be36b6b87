# SPDX-License-Identifier: MIT
"""Settings of the player against the schema that `shutter info --schema` prints: what the program
writes is valid, and what the schema refuses the program refuses too, with line and field."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import jsonschema
except ImportError:
    print("skipped: the package python3-jsonschema is missing")
    sys.exit(77)

SHUTTER = os.environ["SHUTTER_EXECUTABLE"]
PROGRAM = os.environ["SHUTTER_PLAY_SETTINGS"]
FILES = 20


def run(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def place(path, value):
    """Settings with this one field."""
    for name in reversed(path):
        value = {name: value}
    return {"version": 1, **value}


class PlaySettings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = json.loads(subprocess.check_output([SHUTTER, "info", "--schema"], text=True))
        jsonschema.Draft202012Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft202012Validator(cls.schema)
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)
        run("write", cls.path, FILES)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def fields(self, schema=None, path=()):
        """Every field with its part of the schema."""
        for name, field in (schema or self.schema)["properties"].items():
            if "$ref" in field:
                field = self.schema["$defs"][field["$ref"].split("/")[-1]]
            if "properties" in field:
                yield from self.fields(field, (*path, name))
            else:
                yield (*path, name), field

    def check(self, contents):
        """What the program prints of each."""
        files = []
        for i, content in enumerate(contents):
            files.append(self.path / f"check{i}.json")
            files[-1].write_text(json.dumps(content, indent=1), encoding="utf-8")
        return list(zip(files, run("check", *files)))

    def test_files_of_the_program_are_valid(self):
        for i in range(FILES):
            self.validator.validate(json.loads((self.path / f"{i}.json").read_text("utf-8")))

    def test_files_of_the_program_tell_every_field(self):
        written = json.loads((self.path / "0.json").read_text("utf-8"))
        for path, _ in self.fields():
            value = written
            for name in path:
                value = value[name]

    def test_what_the_schema_refuses_the_program_refuses_with_line_and_field(self):
        cases = []
        for path, field in self.fields():
            number = next((f for f in (field, *field.get("anyOf", [])) if "maximum" in f), None)
            wrong = [None, [{}], "nosuch" * 20]
            if number:
                lowest = number.get("minimum", number.get("exclusiveMinimum"))
                wrong += [lowest - 1, number["maximum"] + 1, 1e300]
                if "exclusiveMinimum" in number:
                    wrong.append(lowest)
                if number["type"] == "integer":
                    wrong.append(lowest + 0.5)
            elif "enum" in field:
                wrong += [0, "nosuch"]
            cases += [(path, place(path, value)) for value in wrong]
        self.assertGreater(len(cases), 200)
        for (path, content), (file, printed) in zip(cases, self.check([c for _, c in cases])):
            self.assertFalse(self.validator.is_valid(content), content)
            self.assertRegex(printed, rf"^{file}:[0-9]+: {'[.]'.join(path)}\b", content)

    def test_ends_of_ranges_are_taken_by_both(self):
        cases = []
        for path, field in self.fields():
            for f in (field, *field.get("anyOf", [])):
                cases += [place(path, f[end]) for end in ("minimum", "maximum") if end in f]
                cases += [place(path, f["const"])] if "const" in f else []
                cases += [place(path, word) for word in f.get("enum", []) if word != "samples"]
        for content, (_, printed) in zip(cases, self.check(cases)):
            self.validator.validate(content)
            self.assertEqual(printed, "ok", content)

    def test_unknown_fields_are_refused_by_both(self):
        cases = [place((*path[:-1], "nosuch"), 1) for path, _ in self.fields()]
        for content, (_, printed) in zip(cases, self.check(cases)):
            self.assertFalse(self.validator.is_valid(content))
            self.assertIn("nosuch: is not a field here", printed)


if __name__ == "__main__":
    unittest.main()
