// SPDX-License-Identifier: MIT
#include "game/options/setting_options.h"

#include "engine/core/setting_row.h"
#include "modules/motion_blur/setting_rows.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <string_view>

namespace shutter::game {

using core::makeError;
using core::Status;

std::vector<std::string> splitAt(const std::string& text, char separator) {
    std::vector<std::string> parts;
    size_t start = 0;
    for (size_t at; (at = text.find(separator, start)) != std::string::npos; start = at + 1)
        parts.push_back(text.substr(start, at - start));
    parts.push_back(text.substr(start));
    return parts;
}

Status applySetting(
    const std::string& text, const MethodInfo& method, motion_blur::MotionBlurSettings& settings
) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos)
        return makeError("--set '{}' is not NAME=VALUE", text);
    const std::string name = text.substr(0, equals);
    const std::string value = text.substr(equals + 1);
    if (!method.blur)
        return makeError("--set '{}': method {} has no settings", name, method.name);
    const std::vector<std::string_view>& known = method.blur->settings;
    if (std::find(known.begin(), known.end(), name) == known.end())
        return makeError(
            "--set '{}': method {} has no such setting, it has {}",
            name,
            method.name,
            fmt::join(known, ", ")
        );
    const auto& row = core::getRow(motion_blur::listSettingRows(), name);
    if (Status parsed = core::parseValue(row, value, settings); !parsed)
        return makeError("--set {}: {}", name, parsed.error().message);
    return {};
}

} // namespace shutter::game
