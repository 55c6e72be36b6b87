# SPDX-License-Identifier: MIT
"""Out of device memory at every allocation of a frame in turn."""

import unittest

from fault_case import METHOD, FaultCase


class Memory(FaultCase):
    def test_each_allocation_that_fails_is_told_in_one_sentence_and_leaves_nothing(self):
        for method, step in ((METHOD, 1), ("resolved", 3)):
            # Validation reports objects that were not destroyed before their device.
            frame = self.render("--out", "a.png", "--validate", method=method)
            count = self.count_calls(frame)["allocations"]
            self.assertGreater(count, 25)
            (self.folder / "a.png").unlink()
            for number in range(1, count + 1, step):
                with self.subTest(method=method, allocation=number):
                    result = self.run_faulty(frame, {"allocation": number})
                    self.expect_sentence(result, "allocating", "out of device memory")
                    self.assertEqual(self.list_files(), set())

    def test_memory_of_another_type_is_taken_where_one_is_full(self):
        frame = self.render("--out", "a.png")
        self.expect_done(self.run_shutter(frame))
        picture = (self.folder / "a.png").read_bytes()
        # There are two of each requested kind.
        types = ("local,visible+coherent,visible+coherent+cached,visible+cached,"
                 "local+visible+coherent,local")
        count = self.count_calls(frame)["allocations"]
        for number in range(1, count + 1, 5):
            with self.subTest(allocation=number):
                (self.folder / "a.png").unlink()
                faults = {"memory": types, "allocation": number}
                self.expect_done(self.run_faulty(frame, faults))
                self.assertEqual((self.folder / "a.png").read_bytes(), picture)

    def test_memory_that_stays_full_is_told(self):
        types = "local,visible+coherent,visible+coherent+cached,local+visible+coherent"
        result = self.run_faulty(
            self.render("--out", "a.png"), {"memory": types, "allocation": "20+"})
        self.expect_sentence(result, "out of device memory")
        self.assertEqual(self.list_files(), set())

    def test_memory_that_is_not_coherent_holds_the_same_picture(self):
        frame = self.render("--out", "a.png")
        self.expect_done(self.run_shutter(frame))
        picture = (self.folder / "a.png").read_bytes()
        self.expect_done(self.run_faulty(
            [*frame, "--validate"], {"memory": "local,visible+coherent,visible+cached"}))
        self.assertEqual((self.folder / "a.png").read_bytes(), picture)

    def test_a_device_that_allows_few_allocations_is_told_of(self):
        result = self.run_faulty(
            self.render("--out", "a.png"), {"limits": "maxMemoryAllocationCount=10"})
        self.expect_sentence(result, "allocating", "too many objects")


if __name__ == "__main__":
    unittest.main()
