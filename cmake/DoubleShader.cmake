# SPDX-License-Identifier: MIT
# cmake -DSOURCE=file.glsl -DOUTPUT=header -P DoubleShader.cmake
# The same functions in double precision, as C++ (namespace shutter::shader64): float becomes double,
# vec3 dvec3, 0.1f 0.1. For pure .glsl files, which have no bindings; structs of shared headers stay
# what they are.
file(READ ${SOURCE} text)
string(REGEX REPLACE "([0-9]+\\.[0-9]*(e[-+]?[0-9]+)?)f" "\\1" text "${text}")
string(REGEX REPLACE "(^|[^A-Za-z0-9_])float([^A-Za-z0-9_])" "\\1double\\2" text "${text}")
# Bits are those of the value in single precision: NaN and infinity stay what they are.
string(REGEX REPLACE "floatBitsToUint\\(([a-z.]+)\\)" "floatBitsToUint(static_cast<float>(\\1))" text "${text}")
string(REGEX REPLACE "(^|[^A-Za-z0-9_])(vec[234]|mat[234])([^A-Za-z0-9_])" "\\1d\\2\\3" text "${text}")
string(REGEX REPLACE "#include \"([a-z_/0-9]+\\.glsl)\"" "#include \"double/\\1.h\"" text "${text}")
string(REGEX REPLACE "SHUTTER_([A-Z0-9_]+_GLSL)" "SHUTTER_DOUBLE_\\1" text "${text}")
string(REPLACE "SHUTTER_SHADER_BEGIN"
               "namespace shutter::shader {}\nnamespace shutter::shader64 {\nusing namespace glm;\nusing glm::uint;\nusing namespace shutter::shader;" text "${text}")
string(REPLACE "SHUTTER_SHADER_END" "}" text "${text}")
file(WRITE ${OUTPUT} "${text}")
