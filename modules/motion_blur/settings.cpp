// SPDX-License-Identifier: MIT
#include "modules/motion_blur/settings.h"

#include "modules/motion_blur/setting_rows.h"

namespace shutter::motion_blur {

core::Status validate(const MotionBlurSettings& settings) {
    if (!settings.method)
        return core::makeError("motion blur: method is null");
    return core::validateRows(listSettingRows(), settings, "motion blur: ");
}

} // namespace shutter::motion_blur
