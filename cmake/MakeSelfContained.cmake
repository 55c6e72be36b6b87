# SPDX-License-Identifier: MIT
# cmake -D HEADER=<file> -P MakeSelfContained.cmake
# glslang's headers use uint32_t without its include.
file(READ ${HEADER} text)
file(WRITE ${HEADER} "#include <cstdint>\n\n${text}")
