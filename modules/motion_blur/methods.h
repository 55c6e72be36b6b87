// SPDX-License-Identifier: MIT
// The methods there are.
#pragma once

#include "modules/motion_blur/method.h"

#include <span>
#include <string_view>

namespace shutter::motion_blur {

/// In the order in which quality rises.
[[nodiscard]] std::span<const Method* const> listMethods();

/// Null: there is none of that name.
[[nodiscard]] const Method* findMethod(std::string_view name);

/// The method of that name, which must exist (CHECKed).
[[nodiscard]] const Method& getMethod(std::string_view name);

} // namespace shutter::motion_blur
