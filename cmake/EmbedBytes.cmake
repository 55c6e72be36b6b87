# SPDX-License-Identifier: MIT
# cmake -DSOURCE=file -DOUTPUT=header -DSYMBOL=name -P EmbedBytes.cmake
# Writes the bytes of SOURCE as `inline constexpr char SYMBOL[]`, a zero after them.
file(READ ${SOURCE} bytes HEX)
string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
# Lines of eight bytes, seven characters each.
string(REGEX REPLACE "(.......)(.......)(.......)(.......)(.......)(.......)(.......)(.......)"
                     "\\1\\2\\3\\4\\5\\6\\7\\8\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "#pragma once\n\ninline constexpr char ${SYMBOL}[] = {\n${bytes}'\\0'};\n")
