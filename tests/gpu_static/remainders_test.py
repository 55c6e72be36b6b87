# SPDX-License-Identifier: MIT
"""The remainder of a negative integer is undefined in Vulkan (before VK_KHR_maintenance8): an index from
it may be any number. Shaders take remainders of unsigned integers alone."""

import array
import os
import pathlib
import unittest

SHADERS = pathlib.Path(os.environ["SHUTTER_SPIRV"])
SIGNED_REMAINDERS = (138, 139)  # OpSRem, OpSMod


def list_opcodes(path):
    words = array.array("I", path.read_bytes())
    at = 5
    while at < len(words):
        yield words[at] & 0xFFFF
        at += words[at] >> 16


class Remainders(unittest.TestCase):
    def test_no_shader_takes_the_remainder_of_a_signed_integer(self):
        shaders = sorted(SHADERS.rglob("*.spv"))
        self.assertGreater(len(shaders), 50)
        self.assertEqual([str(shader.relative_to(SHADERS)) for shader in shaders
                          if any(code in SIGNED_REMAINDERS for code in list_opcodes(shader))], [])


if __name__ == "__main__":
    unittest.main()
