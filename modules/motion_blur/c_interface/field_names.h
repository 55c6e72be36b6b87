// SPDX-License-Identifier: MIT
// Sentences about the C++ interface's fields as a host in C has these.
#pragma once

#include <string>
#include <string_view>

namespace shutter::motion_blur {

/// The sentence with each field, function and setting of a field (`vectors.lackCamera = true`)
/// under its name in shutter_motion_blur.h, where some mean the opposite. What is 'quoted', such as
/// a file, stays as it is.
[[nodiscard]] std::string nameForC(std::string_view sentence);

} // namespace shutter::motion_blur
