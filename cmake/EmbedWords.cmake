# SPDX-License-Identifier: MIT
# cmake -DSOURCE=file -DOUTPUT=header -DSYMBOL=name -P EmbedWords.cmake
# Writes the 32-bit words of SOURCE, little-endian as SPIR-V tools write them, as
# `const uint32_t SYMBOL[]` for C and C++.
file(READ ${SOURCE} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
# Lines of eight words, eleven characters each.
string(REGEX REPLACE "(...........)(...........)(...........)(...........)(...........)(...........)(...........)(...........)"
                     "\\1\\2\\3\\4\\5\\6\\7\\8\n" words "${words}")
file(WRITE ${OUTPUT} "#pragma once\n\n#include <stdint.h>\n\nstatic const uint32_t ${SYMBOL}[] = {\n${words}};\n")
