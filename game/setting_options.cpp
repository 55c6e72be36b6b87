// SPDX-License-Identifier: MIT
#include "game/setting_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;

/// A setting whose values are words.
template <class T>
Status applyWord(
    const std::string& name,
    const std::string& value,
    const std::array<std::pair<const char*, T>, 2>& words,
    T& target
) {
    for (const auto& [word, meaning] : words)
        if (value == word) {
            target = meaning;
            return {};
        }
    return makeError("--set {}: '{}' is not {} or {}", name, value, words[0].first, words[1].first);
}

/// A setting whose values are numbers; its range is checked with all others.
Status applyNumber(
    const std::string& name, const std::string& value, motion_blur::MotionBlurSettings& settings
) {
    const std::vector<std::pair<const char*, uint32_t*>> counts = {
        {"tileSizePx", &settings.tileSizePx},
        {"neighbourhoodTiles", &settings.neighbourhoodTiles},
        {"recursionLimit", &settings.recursionLimit},
        {"filterLevels", &settings.filterLevels},
    };
    const std::vector<std::pair<const char*, float*>> numbers = {
        {"softDepthExtent", &settings.softDepthExtent},
        {"edgeThreshold", &settings.edgeThreshold},
        {"luminanceThreshold", &settings.luminanceThreshold},
        {"foregroundMagnification", &settings.foregroundMagnification},
        {"backgroundMagnification", &settings.backgroundMagnification},
        {"jitter", &settings.jitter},
        {"centreBias", &settings.centreBias},
        {"speedThresholdPx", &settings.speedThresholdPx},
        {"luminanceSigma", &settings.luminanceSigma},
        {"uniformMotionPx", &settings.uniformMotionPx},
        {"maxMotionDepth", &settings.maxMotionDepth},
        {"rayShare", &settings.rayShare},
        {"halfResolutionPx", &settings.halfResolutionPx},
    };
    const auto number = parseNumber(value);
    if (!number)
        return makeError("--set {}: '{}' is not a number", name, value);
    for (const auto& [field, target] : counts)
        if (name == field) {
            if (*number < 0.0 || *number > 1e6 || *number != std::floor(*number))
                return makeError("--set {}: {} is not a whole number", name, value);
            *target = static_cast<uint32_t>(*number);
            return {};
        }
    for (const auto& [field, target] : numbers)
        if (name == field) {
            *target = static_cast<float>(*number);
            return {};
        }
    return makeError("--set: there is no setting '{}'", name);
}

} // namespace

std::vector<std::string> splitAt(const std::string& text, char separator) {
    std::vector<std::string> parts;
    size_t start = 0;
    for (size_t at; (at = text.find(separator, start)) != std::string::npos; start = at + 1)
        parts.push_back(text.substr(start, at - start));
    parts.push_back(text.substr(start));
    return parts;
}

std::optional<double> parseNumber(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value))
        return std::nullopt;
    return value;
}

Status applySetting(
    const std::string& text, const MethodInfo& method, motion_blur::MotionBlurSettings& settings
) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos)
        return makeError("--set '{}' is not NAME=VALUE", text);
    const std::string name = text.substr(0, equals);
    const std::string value = text.substr(equals + 1);
    std::span<const std::string_view> known;
    if (method.family == MethodFamily::MotionBlur)
        known = motion_blur::listSettings(method.blur);
    if (known.empty())
        return makeError("--set '{}': method {} has no settings", name, method.name);
    if (std::find(known.begin(), known.end(), name) == known.end())
        return makeError(
            "--set '{}': method {} has no such setting, it has {}",
            name,
            method.name,
            fmt::join(known, ", ")
        );
    using motion_blur::ObjectTest;
    using motion_blur::OccluderTest;
    using motion_blur::RevealTraversal;
    if (name == "objectTest")
        return applyWord<ObjectTest>(
            name,
            value,
            {{{"mesh_id", ObjectTest::MeshId}, {"luminance", ObjectTest::Luminance}}},
            settings.objectTest
        );
    if (name == "revealTraversal")
        return applyWord<RevealTraversal>(
            name,
            value,
            {{{"single", RevealTraversal::Single}, {"stepping", RevealTraversal::Stepping}}},
            settings.revealTraversal
        );
    if (name == "occluderTest")
        return applyWord<OccluderTest>(
            name,
            value,
            {{{"none", OccluderTest::None}, {"velocity", OccluderTest::Velocity}}},
            settings.occluderTest
        );
    return applyNumber(name, value, settings);
}

} // namespace shutter::game
