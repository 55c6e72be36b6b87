# SPDX-License-Identifier: MIT
"""What the gate refuses, on statistics that are made up."""

import unittest

import pipelines

PINNED = {"resolve 1 compute": {"scalarSpills": 4, "waves": 12, "instructions": 1000}}
FILE = """constants\t1
program\tcompute\t64
statistic\tVGPRs\t80
statistic\tSpilled SGPRs\t4
statistic\tSpilled VGPRs\t0
statistic\tScratch size\t0
statistic\tSubgroups per SIMD\t12
statistic\tInstructions\t1000
statistic\tCode size\t5000
statistic\tLDS size\t0
name\tresolve
"""


def change(**more):
    return {"resolve 1 compute": {**PINNED["resolve 1 compute"], **more}}


class Pins(unittest.TestCase):
    def expect(self, found, *sentences):
        self.assertEqual(list(pipelines.compare(found, PINNED)), list(sentences))

    def test_what_is_as_pinned_or_better_passes(self):
        self.expect(PINNED)
        self.expect(change(scalarSpills=0, waves=16, instructions=900))
        self.expect(change(instructions=1100))

    def test_what_is_worse_is_named(self):
        self.expect(change(scalarSpills=5),
                    "resolve 1 compute spills 5 scalar registers, more than 4")
        self.expect(change(waves=10), "resolve 1 compute leaves room for 10 waves, fewer than 12")

    def test_instructions_far_from_the_pin_are_named_either_way(self):
        for count in (899, 1101):
            self.expect(change(instructions=count),
                        f"resolve 1 compute has {count} instructions, over 10 % off 1000")

    def test_a_variant_that_comes_or_goes_is_named(self):
        self.expect({}, "resolve 1 compute is pinned and was not made")
        self.expect({**PINNED, "resolve 2 compute": {}}, "resolve 2 compute is not pinned")

    def test_the_file_of_a_pipeline_is_read(self):
        (program, found), = pipelines.read_pipeline(FILE)
        self.assertEqual(pipelines.list_pins({program: found}), PINNED)
        self.assertEqual(found["lanes"], 64)
        self.assertEqual(list(pipelines.find_faults({program: found})), [])

    def test_spilled_vector_registers_and_scratch_memory_are_faults_but_for_a_stack(self):
        for stage, count in (("compute", 2), ("raygen", 0)):
            program = pipelines.Program("resolve", "1", stage)
            faults = list(pipelines.find_faults({program: {"scratch": 16, "vectorSpills": 1}}))
            self.assertEqual(len(faults), count, faults)


if __name__ == "__main__":
    unittest.main()
