# SPDX-License-Identifier: MIT
"""Results against game/bench/results.schema.json."""

import copy
import json
import pathlib
import sys
import unittest

import example_results

try:
    import jsonschema
except ImportError:
    print("skipped: the package python3-jsonschema is missing")
    sys.exit(77)

SCHEMA = pathlib.Path(__file__).parents[2] / "game/bench/results.schema.json"


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator.check_schema(schema)
        cls.validator = jsonschema.Draft202012Validator(schema)

    def refuses(self, change):
        results = copy.deepcopy(example_results.make("paper"))
        change(results)
        self.assertFalse(self.validator.is_valid(results))

    def test_takes_an_example_of_every_suite(self):
        for suite in example_results.SUITES:
            with self.subTest(suite=suite):
                self.validator.validate(example_results.make(suite))

    def test_takes_a_picture_equal_to_the_truth(self):
        results = example_results.make("paper")
        results["cases"][0]["measurements"][0]["metrics"]["psnr"] = None
        self.validator.validate(results)

    def test_refuses_another_version(self):
        self.refuses(lambda r: r.update(version=1))

    def test_refuses_a_missing_field(self):
        self.refuses(lambda r: r.pop("device"))
        self.refuses(lambda r: r["cases"][0].pop("truth"))
        self.refuses(lambda r: r["cases"][0]["measurements"][0]["milliseconds"].pop("effect"))

    def test_refuses_a_misspelt_field(self):
        self.refuses(lambda r: r["cases"][0]["measurements"][0].update(errormap="a.png"))
        self.refuses(lambda r: r["paper"]["table2"]["rows"][0].update(our=["edge"]))

    def test_refuses_an_unknown_anti_aliasing(self):
        self.refuses(lambda r: r["cases"][0].update(antiAliasing="msaa"))

    def test_refuses_a_negative_time(self):
        frame = lambda r: r["cases"][0]["measurements"][0]["milliseconds"]["frame"]
        self.refuses(lambda r: frame(r).update(median=-1))

    def test_refuses_a_picture_outside_the_folder(self):
        self.refuses(lambda r: r["cases"][0]["truth"].update(image="/etc/picture.png"))


if __name__ == "__main__":
    unittest.main()
