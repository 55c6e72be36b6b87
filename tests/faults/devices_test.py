# SPDX-License-Identifier: MIT
"""Devices that can do less, none at all, and no Vulkan."""

import glob
import json
import os
import pathlib
import re
import unittest

from fault_case import ASSETS, DEVICE, FaultCase, sample

QUERY = "VK_KHR_ray_query"
PIPELINE = "VK_KHR_ray_tracing_pipeline"


class Devices(FaultCase):
    def expect_refusal(self, arguments, faults, *mentions):
        self.expect_sentence(self.run_faulty(arguments, faults), *mentions)
        self.assertEqual(self.list_files(), set())

    def test_a_validated_device_and_no_other_checks_bounds(self):
        for more, checked in ((["--validate"], True), ([], False)):
            counted = self.count_calls(self.render("--out", "a.png", *more, method="gather"))
            self.assertEqual((counted["checksBuffers"], counted["checksBounds"]),
                             (checked, checked))

    def test_without_rays_the_methods_that_need_none_draw_the_same(self):
        for method in ("resolved", "gather"):
            pictures = []
            for faults in ({}, {"hide": f"{QUERY},{PIPELINE}"}):
                self.expect_done(self.run_faulty(
                    self.render("--out", "a.png", "--validate", method=method), faults))
                pictures.append((self.folder / "a.png").read_bytes())
            self.assertEqual(*pictures)

    def test_passes_for_graphics_cards_draw_what_those_for_software_draw(self):
        # Constants that are known to a compiler, such as numbers of taps, make it round otherwise.
        # Rays and taps here, searches and deforming surfaces there.
        for scene, method, *more in sample((("courtyard", "hybrid"),
                                            ("gallery", "resolved"),
                                            ("courtyard", "gather"),
                                            ("courtyard", "resolved", "--camera", "pan"),
                                            ("gallery", "adaptive"))):
            with self.subTest(scene=scene, method=method):
                for faults in ({}, {"kind": "discrete"}):
                    self.expect_done(self.run_faulty(
                        ["render", f"{ASSETS}/{scene}.glb", "--device", DEVICE, "--time", "0.5",
                         "--size", "160x90", "--validate", "--method", method, *more,
                         "--out", f"{len(faults)}.exr"], faults))
                compared = self.run_shutter(["compare", "0.exr", "1.exr", "--linear"])
                decibels = re.search(r"PSNR (\S+)", compared.stdout)[1]
                self.assertGreater(float(decibels), 100.0, compared.stdout)

    def test_without_standard_sample_places_a_moving_camera_has_one_sample_per_pixel(self):
        for limits, has_split in (("", True), ("standardSampleLocations=0", False)):
            with self.subTest(limits=limits):
                self.expect_done(self.run_faulty(
                    ["render", f"{ASSETS}/courtyard.glb", "--device", DEVICE, "--camera", "pan",
                     "--time", "0.5", "--size", "160x90", "--validate", "--method", "resolved",
                     "--aa", "taa", "--stats", "stats.json", "--out", "a.png"],
                    {"limits": limits} if limits else {}))
                stats = json.loads((self.folder / "stats.json").read_text(encoding="utf-8"))
                passes = [one["name"] for one in stats["pictures"][0]["passes"]]
                self.assertEqual("split samples" in passes, has_split)

    def test_without_rays_the_methods_that_need_them_say_so(self):
        for hidden, method in ((f"{QUERY},{PIPELINE}", "hybrid"), ("accelerationStructure", "adaptive"),
                               ("rayQuery,rayTracingPipeline", "adaptive"),
                               ("VK_KHR_acceleration_structure", "hybrid"),
                               ("VK_KHR_deferred_host_operations", "hybrid")):
            with self.subTest(hidden=hidden, method=method):
                self.expect_refusal(
                    self.render("--out", "a.png", method=method), {"hide": hidden},
                    f"--method {method} needs", "resolved and gather do without")

    def test_hybrid_traces_with_pipelines_where_there_are_no_queries(self):
        for hidden in ("rayQuery", f"{QUERY},rayTracingPipelineTraceRaysIndirect"):
            with self.subTest(hidden=hidden):
                self.expect_done(self.run_faulty(
                    self.render("--out", "a.png", "--validate", method="hybrid"),
                    {"hide": hidden}))

    def test_play_takes_another_method_where_its_own_needs_rays(self):
        result = self.run_faulty(
            ["play", "rally", "--assets", ASSETS, "--no-window", "--frames", "2", "--size", "32x18",
             "--method", "hybrid"], {"hide": f"{QUERY},{PIPELINE}"})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("hybrid", result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)

    def test_a_feature_that_everything_needs_is_named(self):
        for feature, words in sample((("shaderStorageImageExtendedFormats", "extended storage formats"),
                                      ("dynamicRendering", "dynamic rendering"),
                                      ("timelineSemaphore", "timeline semaphores"),
                                      ("bufferDeviceAddress", "buffer device addresses"),
                                      ("scalarBlockLayout", "scalar block layout"),
                                      ("hostQueryReset", "host query reset"),
                                      ("synchronization2", "synchronization2"),
                                      ("maintenance4", "maintenance4"),
                                      ("independentBlend", "independent blending"))):
            with self.subTest(feature=feature):
                self.expect_refusal(
                    self.render("--out", "a.png"), {"hide": feature}, f"lacks {words}")

    def test_a_limit_that_does_not_suffice_is_named_before_anything_is_drawn(self):
        # The least values that Vulkan allows.
        for limit, size, mentions in (
            ("maxImageDimension2D=4096", "5000x16", ("--size 5000x16", "4096 pixels")),
            ("maxStorageBufferRange=134217728", "7680x4320", ("--size 7680x4320", "buffer")),
            ("maxPerStageDescriptorSamplers=16", "16x9", ("maxPerStageDescriptorSamplers",)),
            ("maxPerStageDescriptorSampledImages=16", "16x9",
             ("maxPerStageDescriptorSampledImages",)),
        ):
            with self.subTest(limit=limit):
                self.expect_refusal(
                    self.render("--out", "a.png", size=size, method="adaptive"),
                    {"limits": limit}, *mentions)

    def test_a_driver_that_brings_vulkan_to_another_interface_is_used(self):
        # What MoltenVK's manifest declares, declared of the software device: loaders hide it from
        # programs that do not request such drivers.
        manifests = [pathlib.Path(file) for file in self.find_manifests()]
        if not manifests:
            self.skipTest("no manifest of lavapipe was found")
        manifest = json.loads(manifests[0].read_text(encoding="utf-8"))
        manifest["ICD"]["is_portability_driver"] = True
        portable = self.folder / "portable.json"
        portable.write_text(json.dumps(manifest), encoding="utf-8")
        drivers = {"VK_DRIVER_FILES": str(portable), "VK_ICD_FILENAMES": str(portable)}
        listed = self.run_shutter(["info", "--devices"], drivers)
        self.assertIn(DEVICE, listed.stdout, listed.stderr)
        self.expect_done(self.run_shutter(
            self.render("--out", "a.png", "--validate", method="gather"), drivers))

    @staticmethod
    def find_manifests():
        named = os.environ.get("VK_DRIVER_FILES") or os.environ.get("VK_ICD_FILENAMES")
        if named:
            return [file for file in named.split(":") if "lvp" in file]
        return sorted(glob.glob("/usr/share/vulkan/icd.d/lvp_icd*.json"))

    def test_without_a_driver_or_a_loader_each_command_names_the_package(self):
        nowhere = {"VK_DRIVER_FILES": str(self.folder / "none.json"), "VK_ICD_FILENAMES": ""}
        # An invalid library simulates a missing one, which needs no change of the system.
        libraries = self.folder / "libraries"
        libraries.mkdir()
        (libraries / "libvulkan.so.1").write_text("none\n", encoding="utf-8")
        without = {"LD_LIBRARY_PATH": str(libraries)}
        for command in (self.render("--out", "a.png"), ["info", "--devices"],
                        ["play", "rally", "--assets", ASSETS, "--no-window", "--frames", "1"],
                        ["bench", "--suite", "paper", "--out", "report"]):
            with self.subTest(command=command[0]):
                self.expect_sentence(self.run_shutter(command, nowhere), "mesa-vulkan-drivers")
                self.expect_sentence(self.run_shutter(command, without), "libvulkan.so.1",
                                     "package libvulkan1")
        self.assertEqual(self.list_files(), {"libraries", "libraries/libvulkan.so.1"})
        # What needs no Vulkan goes on.
        self.expect_done(self.run_shutter(["info", "--methods"], without))

    def test_the_layer_refuses_what_it_does_not_know(self):
        result = self.run_faulty(self.render("--out", "a.png"), {"limits": "maxWidth=3"})
        self.assertEqual(result.returncode, 99)


if __name__ == "__main__":
    unittest.main()
