# SPDX-License-Identifier: MIT
"""What a GPU of one family would run: API use that validation accepts, and code that is no worse than
its pins (README.md)."""

import os
import pathlib
import shutil
import sys
import unittest

import pipelines

FAMILY = os.environ["SHUTTER_FAMILY"]
TABLE = pathlib.Path(os.environ["SHUTTER_TABLE"])
REPIN = "tests/gpu_static/pin.py build/release pins intended changes"
# Both families take the same path through the program, with the same calls: one of them is validated.
VALIDATES = FAMILY == "rdna2" or "SHUTTER_ALL" in os.environ


class Pipelines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.runs = MACHINE.render_all()
        cls.programs = MACHINE.read_statistics()
        pipelines.write_table(cls.programs, TABLE)
        print(f"the table of all programs is {TABLE}")

    def test_every_method_and_effect_runs_without_a_message(self):
        self.assertGreater(len(self.runs), len(pipelines.VARIANTS))
        for run in self.runs:
            with self.subTest(run=" ".join(run.arguments)):
                self.assertEqual((run.status, run.messages), (0, ""))

    @unittest.skipUnless(VALIDATES, "the other family is validated")
    def test_validation_stands_above_the_layer_that_drops_submissions(self):
        loaded = MACHINE.render("vase", "--method", "sharp", VK_LOADER_DEBUG="layer").messages
        chain = loaded[loaded.index("vkCreateDevice layer callstack"):]
        self.assertLess(chain.index("VK_LAYER_KHRONOS_validation"),
                        chain.index("VK_LAYER_SHUTTER_faults"))

    def test_every_hot_shader_is_made(self):
        made = {program.pipeline for program in self.programs}
        self.assertEqual([name for name in pipelines.HOT if name not in made], [])

    def test_no_shader_spills_vector_registers_or_has_scratch_memory(self):
        self.assertEqual(list(pipelines.find_faults(self.programs)), [])

    def test_no_hot_shader_is_worse_than_its_pin(self):
        pinned = pipelines.read_pins(MACHINE.mesa).get(FAMILY)
        if pinned is None:
            print(f"no pins for {FAMILY} with Mesa {MACHINE.mesa}: the rest was checked")
            return
        self.assertEqual(list(pipelines.compare(pipelines.list_pins(self.programs), pinned)), [],
                         REPIN)

    def test_the_gate_names_what_is_worse_than_a_pin_or_has_none(self):
        pin = {"scalarSpills": 4, "waves": 12, "instructions": 1000}
        for found, *sentences in (
            ({"a": {"scalarSpills": 0, "waves": 16, "instructions": 1100}},),
            ({"a": {**pin, "scalarSpills": 5}}, "a spills 5 scalar registers, more than 4"),
            ({"a": {**pin, "waves": 10}}, "a leaves room for 10 waves, fewer than 12"),
            ({"a": {**pin, "instructions": 899}}, "a has 899 instructions, over 10 % off 1000"),
            ({"a": {**pin, "instructions": 1101}}, "a has 1101 instructions, over 10 % off 1000"),
            ({"b": pin}, "a is pinned and was not made", "b is not pinned"),
        ):
            self.assertEqual(list(pipelines.compare(found, {"a": pin})), sentences)


if __name__ == "__main__":
    folder = pipelines.make_folder()
    try:
        MACHINE = pipelines.Machine(os.environ["SHUTTER_EXECUTABLE"], os.environ["SHUTTER_ASSETS"],
                                    os.environ["SHUTTER_FAULT_LAYER"], FAMILY, folder, VALIDATES)
        unittest.main()
    except pipelines.Missing as missing:
        print(f"skipped: {missing}")
        sys.exit(77)
    finally:
        shutil.rmtree(folder)
