# SPDX-License-Identifier: MIT
"""Calls of a frame that fail: allocations of memory, creations of objects, and submissions, at which the
device is lost. With SHUTTER_ALL set, each call fails in turn, which takes many minutes; else a sample."""

import unittest

from fault_case import ASSETS, METHOD, FaultCase, choose

# A frame of any method needs these; rays and raster have pipelines and structures of their own.
KINDS_OF_A_FRAME = {
    "AllocateCommandBuffers", "AllocateDescriptorSets", "BindBufferMemory", "BindImageMemory",
    "CreateAccelerationStructureKHR", "CreateBuffer", "CreateCommandPool", "CreateComputePipelines",
    "CreateDescriptorPool", "CreateDescriptorSetLayout", "CreateDevice", "CreateGraphicsPipelines",
    "CreateImage", "CreateImageView", "CreateInstance", "CreatePipelineCache", "CreatePipelineLayout", "CreateQueryPool",
    "CreateSampler", "CreateSemaphore", "CreateShaderModule"}


class Memory(FaultCase):
    def test_each_allocation_that_fails_is_told_in_one_sentence_and_leaves_nothing(self):
        for method, most in ((METHOD, 6), ("resolved", 3)):
            # Validation reports objects that were not destroyed before their device.
            frame = self.render("--out", "a.png", "--validate", method=method)
            count = self.count_calls(frame)["allocations"]
            self.assertGreater(count, 25)
            (self.folder / "a.png").unlink()
            for number in choose(count, most):
                with self.subTest(method=method, allocation=number):
                    result = self.run_faulty(frame, {"allocation": number})
                    self.expect_sentence(result, "allocating", "out of device memory")
                    self.assertEqual(self.list_files(), set())

    def test_other_memory_holds_the_same_picture(self):
        frame = self.render("--out", "a.png", "--validate")
        count = self.count_calls(frame)["allocations"]
        picture = (self.folder / "a.png").read_bytes()
        # There are two of each requested kind, one of which is full.
        types = ("local,visible+coherent,visible+coherent+cached,visible+cached,"
                 "local+visible+coherent,local")
        incoherent = {"memory": "local,visible+coherent,visible+cached"}
        for faults in (*({"memory": types, "allocation": number} for number in choose(count, 3)),
                       incoherent):
            with self.subTest(faults=faults):
                (self.folder / "a.png").unlink()
                self.expect_done(self.run_faulty(frame, faults))
                self.assertEqual((self.folder / "a.png").read_bytes(), picture)

    def test_memory_that_stays_full_is_told(self):
        types = "local,visible+coherent,visible+coherent+cached,local+visible+coherent"
        result = self.run_faulty(
            self.render("--out", "a.png"), {"memory": types, "allocation": "20+"})
        self.expect_sentence(result, "out of device memory")
        self.assertEqual(self.list_files(), set())

    def test_a_device_that_allows_few_allocations_is_told_of(self):
        result = self.run_faulty(
            self.render("--out", "a.png"), {"limits": "maxMemoryAllocationCount=10"})
        self.expect_sentence(result, "allocating", "too many objects")


class Creations(FaultCase):
    def fail_each(self, arguments, kinds):
        counts = self.count_calls(arguments)["creations"]
        made = {name: count for name, count in counts.items() if count > 0 and name in kinds}
        for path in self.folder.iterdir():
            path.unlink()
        for name, count in made.items():
            for number in choose(count, 2):
                with self.subTest(creation=f"{name} {number} of {count}"):
                    result = self.run_faulty(arguments, {"creation": f"{name}={number}"})
                    if name == "CreatePipelineCache" and result.returncode == 0:
                        # Pipelines are made all the same, and not kept.
                        self.expect_done(result)
                        continue
                    self.expect_sentence(result, "out of main memory")
                    self.assertEqual(self.list_files(), set())
        return set(made)

    def test_each_kind_of_object_of_a_frame(self):
        # Validation reports objects that were not destroyed before their device.
        made = self.fail_each(self.render("--out", "a.png", "--validate"), KINDS_OF_A_FRAME)
        self.assertEqual(made, KINDS_OF_A_FRAME)

    def test_each_command_without_instance_or_device(self):
        for command in (["info", "--devices"],
                        ["play", "rally", "--assets", ASSETS, "--no-window", "--frames", "1"],
                        ["bench", "--suite", "paper", "--out", "report"]):
            for name, doing in (("CreateInstance", "creating the Vulkan instance"),
                                ("CreateDevice", "opening the device")):
                if command[0] == "info" and name == "CreateDevice":
                    continue  # it opens none
                with self.subTest(command=command[0], creation=name):
                    result = self.run_faulty(command, {"creation": f"{name}=1"})
                    self.expect_sentence(result, f"{doing}", "out of main memory")
                    self.assertEqual(self.list_files(), set())

    def test_pipelines_that_trace_rays(self):
        kinds = {"CreateRayTracingPipelinesKHR"}
        frame = self.render("--out", "a.png", "--validate", "--rays", "pipeline", method="hybrid")
        self.assertEqual(self.fail_each(frame, kinds), kinds)

    def test_objects_of_a_session(self):
        session = ["play", "rally", "--assets", ASSETS, "--no-window", "--frames", "3",
                   "--size", "32x18", "--method", "gather", "--validate"]
        self.fail_each(session, {"CreateImage", "CreateComputePipelines", "AllocateDescriptorSets"})


class LostDevice(FaultCase):
    """Where a command is submitted, or while it runs."""

    def lose(self, arguments, numbers, kinds=("submission", "execution")):
        for kind in kinds:
            for number in numbers:
                with self.subTest(lost_at=f"{kind} {number}"):
                    result = self.run_faulty(arguments, {kind: number})
                    self.expect_sentence(result, "the device was lost")

    def test_each_submission_of_a_picture(self):
        frame = self.render("--out", "a.png", "--validate")
        count = self.count_calls(frame)["submissions"]
        # What the scene is uploaded with, the frame before and the frame.
        self.assertGreater(count, 5)
        (self.folder / "a.png").unlink()
        self.lose(frame, choose(count, 4))
        self.assertEqual(self.list_files(), set())

    def test_a_sequence_keeps_the_frames_from_before_and_goes_on_from_them(self):
        sequence = self.render("--frames", "0:2", "--out", "f_%d.png", method="sharp")
        count = self.count_calls([*sequence, "--restart"])["submissions"]
        whole = [(self.folder / f"f_{i}.png").read_bytes() for i in range(3)]
        for path in self.folder.iterdir():
            path.unlink()
        # The last submission is the last frame's.
        self.lose(sequence, [count], kinds=["execution"])
        self.assertEqual(self.list_files(), {".f_%d.png.journal", "f_0.png", "f_1.png"})
        result = self.run_shutter(sequence)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 of 3 frames are complete", result.stdout)
        self.assertEqual([(self.folder / f"f_{i}.png").read_bytes() for i in range(3)], whole)

    def test_frames_on_their_way_in_play(self):
        session = ["play", "rally", "--assets", ASSETS, "--no-window", "--frames", "4",
                   "--size", "32x18", "--method", "gather"]
        count = self.count_calls(session)["submissions"]
        self.lose(session, range(count - 1, count + 1))


if __name__ == "__main__":
    unittest.main()
