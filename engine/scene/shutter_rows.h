// SPDX-License-Identifier: MIT
// The shutter's fields as rows (engine/core/setting_row.h): the command line, settings files,
// panels and flythroughs read their names, ranges and meanings here.
#pragma once

#include "engine/core/setting_row.h"
#include "engine/scene/components.h"

#include <string>

namespace shutter::scene {

/// One row per field of CameraShutter, except for `response` and `cuts`, which have their own.
[[nodiscard]] core::SettingRows<CameraShutter> listShutterRows();
/// One row per field of ShutterResponse, except for `samples`, which is a list.
[[nodiscard]] core::SettingRows<ShutterResponse> listResponseRows();
[[nodiscard]] core::SettingRows<CutDetection> listCutRows();

/// One sentence that names the field which is out of its range.
/// \param prefix before the field's name, e.g. "shutter."
[[nodiscard]] core::Status validate(const CameraShutter& shutter, std::string_view prefix = "");

/// All fields and their values in one line, which differs wherever a value does.
[[nodiscard]] std::string describe(const CameraShutter& shutter);

} // namespace shutter::scene
