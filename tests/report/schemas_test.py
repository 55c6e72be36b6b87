# SPDX-License-Identifier: MIT
"""Files against their schemas, and against the code that reads and writes them: results of `bench`
(game/bench/results.schema.json), flythroughs (engine/flythrough/flythrough.schema.json) and settings
of the player (`shutter info --schema`)."""

import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import example_results

try:
    import jsonschema
except ImportError:
    print("skipped: the package python3-jsonschema is missing")
    sys.exit(77)

ROOT = pathlib.Path(__file__).parents[2]
SHIPPED = sorted((ROOT / "assets/flythroughs").glob("*.json"))
RANDOM_FILES = 20


def make_validator(text):
    schema = json.loads(text)
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def run(*arguments):
    """Lines that the program files.cpp prints."""
    return subprocess.run([os.environ["SHUTTER_TEST_FILES"], *map(str, arguments)], check=True,
                          stdout=subprocess.PIPE, text=True).stdout.split("\n")[:-1]


class SchemaCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)

    def read(self, kind, contents):
        """Pairs of the file of each content and what the reader prints of it: nothing, or the error."""
        files = []
        for i, content in enumerate(contents):
            files.append(self.folder / f"changed_{i}.json")
            files[-1].write_text(json.dumps(content, indent=1), encoding="utf-8")
        printed = run(kind, *files)
        self.assertEqual(len(printed), len(files))
        return list(zip(files, printed))


def first(results):
    return results["cases"][0]["measurements"][0]


WRONG_RESULTS = {
    "another version": lambda r: r.update(version=1),
    "no device": lambda r: r.pop("device"),
    "no truth": lambda r: r["cases"][0].pop("truth"),
    "no time of the effect": lambda r: first(r)["milliseconds"].pop("effect"),
    "a misspelt field": lambda r: first(r).update(errormap="a.png"),
    "a misspelt field of a table": lambda r: r["paper"]["table2"]["rows"][0].update(our=["edge"]),
    "an unknown anti-aliasing": lambda r: r["cases"][0].update(antiAliasing="msaa"),
    "a negative time": lambda r: first(r)["milliseconds"]["frame"].update(median=-1),
    "a picture outside of the folder": lambda r: r["cases"][0]["truth"].update(image="/etc/picture.png"),
}


class Results(unittest.TestCase):
    def setUp(self):
        self.validator = make_validator(
            (ROOT / "game/bench/results.schema.json").read_text(encoding="utf-8"))

    def test_an_example_of_every_suite_is_valid(self):
        for suite in example_results.SUITES:
            with self.subTest(suite=suite):
                self.validator.validate(example_results.make(suite))
        equal = example_results.make("paper")
        first(equal)["metrics"]["psnr"] = None  # a picture that equals the truth
        self.validator.validate(equal)

    def test_what_is_wrong_is_refused(self):
        for fault, change in WRONG_RESULTS.items():
            with self.subTest(fault=fault):
                results = copy.deepcopy(example_results.make("paper"))
                change(results)
                self.assertFalse(self.validator.is_valid(results))


EXAMPLE = {
    "version": 1,
    "name": "example",
    "fps": 30,
    "interpolation": "linear",
    "ease": "inOut",
    "up": [0, 1, 0],
    "keys": [
        {"time": 0, "position": [0, 1, 2], "lookAt": [0, 0, 0], "fieldOfView": 40,
         "shutter": {"exposure": 0.01, "phase": "centre"}},
        {"time": 1.5, "position": [0, 1, 3], "lookAt": [0, 0, 0], "fieldOfView": 30, "cut": True,
         "timeScale": 0.25,
         "shutter": {"shutterAngle": 180}},
    ],
}


def key(changes, index=0):
    return lambda f: f["keys"][index].update(changes)


# The fault, and the field that the reader names. Both refuse these.
WRONG = [
    (lambda f: f.pop("version"), "version"),
    (lambda f: f.update(version=2), "version"),
    (lambda f: f.update(version="1"), "version"),
    (lambda f: f.pop("keys"), "keys"),
    (lambda f: f.update(keys=[]), "keys"),
    (lambda f: f.update(keys={}), "keys"),
    (lambda f: f.update(fps=0), "fps"),
    (lambda f: f.update(fps=1001), "fps"),
    (lambda f: f.update(fps="24"), "fps"),
    (lambda f: f.update(fps="24/1.001"), "fps"),
    (lambda f: f.update(name=3), "name"),
    (lambda f: f.update(name="x" * 257), "name"),
    (lambda f: f.update(interpolation="cubic"), "interpolation"),
    (lambda f: f.update(ease=None), "ease"),
    (lambda f: f.update(up=[0, 1]), "up"),
    (lambda f: f.update(speed=1), "speed"),
    (lambda f: f["keys"][0].pop("time"), "time"),
    (lambda f: f["keys"][0].pop("position"), "position"),
    (lambda f: f["keys"][0].pop("lookAt"), "lookAt"),
    (key({"time": 1e7}), "keys[0].time"),
    (key({"time": "0"}), "keys[0].time"),
    (key({"position": [0, 1, 2, 3]}), "keys[0].position"),
    (key({"position": [0, 1, 1e10]}), "keys[0].position[2]"),
    (key({"rotation": [0, 0, 0, 1]}), "keys[0]"),
    (key({"lookAt": [0, None, 0]}), "keys[0].lookAt[1]"),
    (key({"fieldOfView": 180}), "keys[0].fieldOfView"),
    (key({"fieldOfView": 0}), "keys[0].fieldOfView"),
    (key({"cut": 1}), "keys[0].cut"),
    (key({"timeScale": 0}), "keys[0].timeScale"),
    (key({"timeScale": 1001}), "keys[0].timeScale"),
    (key({"colour": "red"}), "keys[0].colour"),
    (key({"shutter": {}}), "keys[0].shutter"),
    (key({"shutter": {"exposure": 1, "shutterAngle": 1}}), "keys[0].shutter"),
    (key({"shutter": {"exposure": -1}}), "keys[0].shutter.exposure"),
    (key({"shutter": {"shutterAngle": 36001}}), "keys[0].shutter.shutterAngle"),
    (key({"shutter": {"exposure": 1, "phase": "middle"}}), "keys[0].shutter.phase"),
    (key({"shutter": 180}), "keys[0].shutter"),
]

# What no schema has.
BEYOND = [
    (key({"time": 1.5}), "keys[1].time"),
    (lambda f: f.update(up=[0, 0, 0]), "up"),
    (lambda f: f["keys"][1].pop("fieldOfView"), "keys[1]"),
    (lambda f: f["keys"][0].pop("fieldOfView"), "keys[1]"),
    (lambda f: [f["keys"][1].pop("lookAt"), key({"rotation": [0, 0, 0, 1]}, 1)(f)], "keys[1]"),
    (lambda f: [k.pop("lookAt") and k.update(rotation=[0, 0, 0, 0.9]) for k in f["keys"]],
     "keys[0].rotation"),
]


class Flythrough(SchemaCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.validator = make_validator(
            (ROOT / "engine/flythrough/flythrough.schema.json").read_text(encoding="utf-8"))

    def expect_refusals(self, cases, is_valid):
        changed = [copy.deepcopy(EXAMPLE) for _ in cases]
        for flythrough, (change, _) in zip(changed, cases):
            change(flythrough)
        for flythrough, (_, error), (_, field) in zip(changed, self.read("flythroughs", changed), cases):
            with self.subTest(field=field, flythrough=flythrough):
                self.assertEqual(self.validator.is_valid(flythrough), is_valid)
                self.assertRegex(error, r"/changed_[0-9]+\.json:[0-9]+: ")
                self.assertIn(field, error)

    def test_both_take_the_example_and_what_is_shipped(self):
        self.assertGreaterEqual(len(SHIPPED), 2)
        for path in SHIPPED:
            with self.subTest(path=path.name):
                self.validator.validate(json.loads(path.read_text(encoding="utf-8")))
        self.assertEqual(run("flythroughs", *SHIPPED), [""] * len(SHIPPED))
        self.validator.validate(EXAMPLE)
        self.assertEqual([error for _, error in self.read("flythroughs", [EXAMPLE])], [""])

    def test_both_refuse_what_is_wrong(self):
        self.expect_refusals(WRONG, is_valid=False)

    def test_the_reader_refuses_what_no_schema_says(self):
        self.expect_refusals(BEYOND, is_valid=True)


def place(path, value):
    """Settings with this one field."""
    for name in reversed(path):
        value = {name: value}
    return {"version": 1, **value}


class PlaySettings(SchemaCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.validator = make_validator(subprocess.check_output(
            [os.environ["SHUTTER_EXECUTABLE"], "info", "--schema"], text=True))
        cls.schema = cls.validator.schema

    def fields(self, schema=None, path=()):
        """Every field with its part of the schema."""
        for name, field in (schema or self.schema)["properties"].items():
            if "$ref" in field:
                field = self.schema["$defs"][field["$ref"].split("/")[-1]]
            if "properties" in field:
                yield from self.fields(field, (*path, name))
            else:
                yield (*path, name), field

    def test_files_of_the_program_are_valid_and_have_every_field(self):
        run("write", self.folder, RANDOM_FILES)
        written = [json.loads((self.folder / f"{i}.json").read_text("utf-8"))
                   for i in range(RANDOM_FILES)]
        for content in written:
            self.validator.validate(content)
        for path, _ in self.fields():
            value = written[0]
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
        for (path, content), (file, printed) in zip(cases, self.read("settings", [c for _, c in cases])):
            self.assertFalse(self.validator.is_valid(content), content)
            self.assertRegex(printed, rf"^{file}:[0-9]+: {'[.]'.join(path)}\b", content)

    def test_ends_of_ranges_are_taken_by_both(self):
        cases = []
        for path, field in self.fields():
            for f in (field, *field.get("anyOf", [])):
                cases += [place(path, f[end]) for end in ("minimum", "maximum") if end in f]
                cases += [place(path, f["const"])] if "const" in f else []
                cases += [place(path, word) for word in f.get("enum", []) if word != "samples"]
        for content, (_, printed) in zip(cases, self.read("settings", cases)):
            self.validator.validate(content)
            self.assertEqual(printed, "", content)

    def test_unknown_fields_are_refused_by_both(self):
        cases = [place((*path[:-1], "nosuch"), 1) for path, _ in self.fields()]
        for content, (_, printed) in zip(cases, self.read("settings", cases)):
            self.assertFalse(self.validator.is_valid(content))
            self.assertIn("nosuch: is not a field here", printed)


if __name__ == "__main__":
    unittest.main()
