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


class Pipelines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = pipelines.make_folder()
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.machine = open_machine(folder)
        cls.runs = cls.machine.render_all()
        cls.programs = cls.machine.read_statistics()
        pipelines.write_table(cls.programs, TABLE)
        print(f"the table of all programs is {TABLE}")

    def test_every_method_and_effect_runs_without_a_message(self):
        self.assertGreater(len(self.runs), len(pipelines.VARIANTS))
        for run in self.runs:
            with self.subTest(run=" ".join(run.arguments)):
                self.assertEqual((run.status, run.messages), (0, ""))

    def test_validation_stands_above_the_layer_that_drops_submissions(self):
        loaded = self.machine.render("vase", "--method", "sharp", VK_LOADER_DEBUG="layer").messages
        chain = loaded[loaded.index("vkCreateDevice layer callstack"):]
        self.assertLess(chain.index("VK_LAYER_KHRONOS_validation"),
                        chain.index("VK_LAYER_SHUTTER_statistics"))

    def test_every_hot_shader_is_made(self):
        made = {program.pipeline for program in self.programs}
        self.assertEqual([name for name in pipelines.HOT if name not in made], [])

    def test_no_shader_spills_vector_registers_or_has_scratch_memory(self):
        self.assertEqual(list(pipelines.find_faults(self.programs)), [])

    def test_no_hot_shader_is_worse_than_its_pin(self):
        pinned = pipelines.read_pins(self.machine.mesa).get(FAMILY)
        if pinned is None:
            print(f"no pins for {FAMILY} with Mesa {self.machine.mesa}: the rest was checked")
            return
        self.assertEqual(list(pipelines.compare(pipelines.list_pins(self.programs), pinned)), [],
                         REPIN)


def open_machine(folder):
    return pipelines.Machine(os.environ["SHUTTER_EXECUTABLE"], os.environ["SHUTTER_ASSETS"],
                             os.environ["SHUTTER_STATISTICS_LAYER"], FAMILY, folder)


if __name__ == "__main__":
    probe = pipelines.make_folder()
    try:
        open_machine(probe)
    except pipelines.Missing as missing:
        print(f"skipped: {missing}")
        sys.exit(77)
    finally:
        shutil.rmtree(probe)
    unittest.main()
