// SPDX-License-Identifier: MIT
// One source, two machines: files that begin and end with these macros compile as GLSL and, over
// GLM, as C++ (namespace shutter::shader), so that structs are written once and unit tests and CPU
// references call the shipped code.
#ifndef SHUTTER_SHIM_H
#define SHUTTER_SHIM_H

#ifdef __cplusplus

#ifndef GLM_FORCE_DEPTH_ZERO_TO_ONE
#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#endif
#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>

#define SHUTTER_SHADER_BEGIN                                                                       \
    namespace shutter::shader {                                                                    \
    using namespace glm;                                                                           \
    using glm::uint;
#define SHUTTER_SHADER_END }
#define SHUTTER_INLINE inline
#define SHUTTER_CONST inline constexpr

#else

#define SHUTTER_SHADER_BEGIN
#define SHUTTER_SHADER_END
#define SHUTTER_INLINE
#define SHUTTER_CONST const

#endif

#endif
