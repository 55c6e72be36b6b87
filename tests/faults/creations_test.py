# SPDX-License-Identifier: MIT
"""Objects that cannot be made: images, pipelines, pools, layouts, views and what else a frame needs.

With SHUTTER_FAULT_ALL set, each single creation fails in turn, which takes some minutes; else the
first, the last and some in between of each kind."""

import os
import unittest

from fault_case import ASSETS, FaultCase

# The first ones of each kind that a frame makes more of.
MOST_OF_A_KIND = 3
# A frame of any method needs these; rays and raster have pipelines and structures of their own.
KINDS_OF_A_FRAME = {
    "AllocateCommandBuffers", "AllocateDescriptorSets", "BindBufferMemory", "BindImageMemory",
    "CreateAccelerationStructureKHR", "CreateBuffer", "CreateCommandPool", "CreateComputePipelines",
    "CreateDescriptorPool", "CreateDescriptorSetLayout", "CreateDevice", "CreateGraphicsPipelines",
    "CreateImage", "CreateImageView", "CreateInstance", "CreatePipelineCache", "CreatePipelineLayout", "CreateQueryPool",
    "CreateSampler", "CreateSemaphore", "CreateShaderModule"}


def choose(count):
    """Numbers of calls, the first and the last among them."""
    if os.environ.get("SHUTTER_FAULT_ALL") or count <= MOST_OF_A_KIND:
        return range(1, count + 1)
    step = (count - 1) / (MOST_OF_A_KIND - 1)
    return sorted({1 + round(i * step) for i in range(MOST_OF_A_KIND)})


class Creations(FaultCase):
    def fail_each(self, arguments, kinds):
        counts = self.count_calls(arguments)["creations"]
        made = {name: count for name, count in counts.items() if count > 0 and name in kinds}
        for path in self.folder.iterdir():
            path.unlink()
        for name, count in made.items():
            for number in choose(count):
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
        kinds = {"CreateRayTracingPipelinesKHR", "CreateShaderModule"}
        frame = self.render("--out", "a.png", "--validate", "--rays", "pipeline", method="hybrid")
        self.assertEqual(self.fail_each(frame, kinds), kinds)

    def test_objects_of_a_session(self):
        session = ["play", "rally", "--assets", ASSETS, "--no-window", "--frames", "3",
                   "--size", "32x18", "--validate"]
        self.fail_each(session, {"CreateImage", "CreateComputePipelines", "AllocateDescriptorSets"})


if __name__ == "__main__":
    unittest.main()
