# SPDX-License-Identifier: MIT
# cmake -DSOURCE=file.glsl -DOUTPUT=file.glsl -P ErringShader.cmake
# The same functions with quotients that err, for tests/erring: "a / b" becomes "a / kErring / b", and
# the shim brings the arithmetic. What two literals divide into stays exact: compilers fold it.
file(READ ${SOURCE} text)
string(REGEX REPLACE "([0-9]\\.[0-9]*(e[-+]?[0-9]+)?f) / ([0-9])" "\\1/\\3" text "${text}")
string(REPLACE " / " " / kErring / " text "${text}")
string(REPLACE "#include <glm/glm.hpp>" "#include \"tests/erring/erring_arithmetic.h\"" text "${text}")
file(WRITE ${OUTPUT} "${text}")
