// SPDX-License-Identifier: MIT
#include "game/options/option_rows.h"

#include "shaders/common/numeric.glsl"

#include <regex>

namespace shutter::game {

namespace {

using core::makeError;

constexpr uint32_t kMaxSize = 16384;

} // namespace

std::vector<std::string> splitAt(const std::string& text, char separator) {
    std::vector<std::string> parts;
    size_t start = 0;
    for (size_t at; (at = text.find(separator, start)) != std::string::npos; start = at + 1)
        parts.push_back(text.substr(start, at - start));
    parts.push_back(text.substr(start));
    return parts;
}

core::Status parseOption(const std::string& text, PictureSize& parsed) {
    static const std::regex kPattern("([0-9]{1,6})x([0-9]{1,6})");
    std::smatch match;
    if (!std::regex_match(text, match, kPattern))
        return makeError("'{}' is not WxH, e.g. 1280x720", text);
    const PictureSize size{
        static_cast<uint32_t>(std::stoul(match[1])), static_cast<uint32_t>(std::stoul(match[2]))};
    if (size.width < 1 || size.height < 1 || size.width > kMaxSize || size.height > kMaxSize)
        return makeError("{} must lie between 1x1 and {}x{}", text, kMaxSize, kMaxSize);
    parsed = size;
    return {};
}

core::Status parseOption(const std::string& text, math::vec3& parsed) {
    const auto parts = splitAt(text, ',');
    if (parts.size() != 3)
        return makeError("'{}' is not R,G,B", text);
    math::vec3 color(0.0f);
    for (int i = 0; i < 3; ++i) {
        const auto value = core::parseNumber(parts[static_cast<size_t>(i)]);
        if (!value || *value < 0.0 || *value > double(shader::kMaxColor))
            return makeError("'{}' is not R,G,B of numbers in [0, {}]", text, shader::kMaxColor);
        color[i] = static_cast<float>(*value);
    }
    parsed = color;
    return {};
}

core::Status parseOption(const std::string& text, core::FrameRate& parsed) {
    const auto rate = core::parseFrameRate(text);
    if (!rate)
        return rate.error();
    parsed = rate.value();
    return {};
}

core::Status parseOption(const std::string& text, bool& isOn) {
    if (text != "on" && text != "off")
        return makeError("'{}' is not on or off", text);
    isOn = text == "on";
    return {};
}

std::string describeOption(const PictureSize& size) {
    return fmt::format("{}x{}", size.width, size.height);
}

std::string describeOption(const math::vec3& color) {
    return fmt::format("{},{},{}", color.x, color.y, color.z);
}

std::string describeOption(const core::FrameRate& rate) {
    return core::describe(rate);
}

std::string describeOption(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, ","));
}

} // namespace shutter::game
