# SPDX-License-Identifier: MIT
"""Flythroughs against engine/flythrough/flythrough.schema.json, and against the code that reads them."""

import copy
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

ROOT = pathlib.Path(__file__).parents[2]
SCHEMA = ROOT / "engine/flythrough/flythrough.schema.json"
SHIPPED = sorted((ROOT / "assets/flythroughs").glob("*.json"))

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


class Flythrough(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator.check_schema(schema)
        cls.validator = jsonschema.Draft202012Validator(schema)
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)

    def read(self, paths):
        """The reader's line for each file: empty, or the error."""
        run = subprocess.run(
            [os.environ["SHUTTER_CHECK_FLYTHROUGHS"], *paths],
            capture_output=True, text=True, check=True)
        printed = run.stdout.split("\n")[:-1]
        self.assertEqual(len(printed), len(paths))
        return printed

    def change(self, changes):
        """Pairs of the changed example and its file."""
        changed = []
        for i, change in enumerate(changes):
            flythrough = copy.deepcopy(EXAMPLE)
            change(flythrough)
            path = self.folder / f"changed_{i}.json"
            path.write_text(json.dumps(flythrough, indent=1), encoding="utf-8")
            changed.append((flythrough, path))
        return changed

    def expect_refusals(self, cases, is_valid):
        changed = self.change([change for change, _ in cases])
        printed = self.read([path for _, path in changed])
        for (flythrough, _), error, (_, field) in zip(changed, printed, cases):
            with self.subTest(field=field, flythrough=flythrough):
                self.assertEqual(self.validator.is_valid(flythrough), is_valid)
                self.assertRegex(error, r"/changed_[0-9]+\.json:[0-9]+: ")
                self.assertIn(field, error)

    def test_both_take_what_is_shipped(self):
        self.assertGreaterEqual(len(SHIPPED), 2)
        for path in SHIPPED:
            with self.subTest(path=path.name):
                self.validator.validate(json.loads(path.read_text(encoding="utf-8")))
        self.assertEqual(self.read(SHIPPED), [""] * len(SHIPPED))

    def test_both_take_the_example(self):
        [(flythrough, path)] = self.change([lambda f: None])
        self.validator.validate(flythrough)
        self.assertEqual(self.read([path]), [""])

    def test_both_refuse_what_is_wrong(self):
        self.expect_refusals(WRONG, is_valid=False)

    def test_the_reader_refuses_what_no_schema_says(self):
        self.expect_refusals(BEYOND, is_valid=True)


if __name__ == "__main__":
    unittest.main()
