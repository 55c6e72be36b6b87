// SPDX-License-Identifier: MIT
// The effect's settings as rows (engine/core/setting_row.h).
#pragma once

#include "engine/core/setting_row.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/settings.h"

namespace shutter::motion_blur {

/// One row per field of MotionBlurSettings, except for `method`.
[[nodiscard]] core::SettingRows<MotionBlurSettings> listSettingRows();
/// One row per field of BlurBudget.
[[nodiscard]] core::SettingRows<BlurBudget> listBudgetRows();

} // namespace shutter::motion_blur
