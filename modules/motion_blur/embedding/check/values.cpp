// SPDX-License-Identifier: MIT
// Checks the values of a host's images on their own.
#include "modules/motion_blur/embedding/check/checked_frame.h"
#include "shaders/motion_blur/prepare.glsl"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace shutter::motion_blur {

namespace {

/// Minimum number of pixels for a finding; closing windows may have fewer.
constexpr uint64_t kMinPixels = 64;

uint32_t countOf(const CheckedFrame& frame, uint32_t index) {
    return frame.totals.counts[index];
}

double shareOf(const CheckedFrame& frame, uint32_t index) {
    const VkExtent2D size = frame.facts.picture;
    return double(countOf(frame, index)) / (double(size.width) * size.height);
}

std::string_view vectorsName(const CheckFacts& facts) {
    return facts.isNative ? "motionDepth" : "vectors";
}

std::string_view depthName(const CheckFacts& facts) {
    return facts.isNative ? "motionDepth" : "depth";
}

void checkColorAndMotion(const CheckedFrame& now, std::vector<Finding>& findings) {
    struct Row {
        uint32_t index;
        CheckKind kind;
        std::string_view image;
        const char* what;
    };

    const std::string_view vectors = vectorsName(now.facts);
    for (const Row& row : std::initializer_list<Row>{
             {shader::kCheckColorNan, CheckKind::ColorNan, "color", "NaN"},
             {shader::kCheckColorInfinite, CheckKind::ColorInfinite, "color", "infinity"},
             {shader::kCheckMotionNan, CheckKind::MotionNan, vectors, "NaN"},
             {shader::kCheckMotionInfinite, CheckKind::MotionInfinite, vectors, "infinity"}})
        if (countOf(now, row.index) > 0)
            findings.push_back(
                {row.kind,
                 fmt::format(
                     "{} holds {} at {}, which spreads as far as the blur is long",
                     row.image,
                     row.what,
                     describeCount(now, row.index)
                 )}
            );
    // A rounding of filters goes a little below 0 here and there.
    if (shareOf(now, shader::kCheckColorNegative) > 0.001)
        findings.push_back(
            {CheckKind::ColorNegative,
             fmt::format(
                 "color is negative at {}; it must be linear light",
                 describeCount(now, shader::kCheckColorNegative)
             )}
        );
    if (shareOf(now, shader::kCheckMotionBeyond) > 0.01)
        findings.push_back(
            {CheckKind::MotionBeyond,
             fmt::format(
                 "{} is longer than the picture's diagonal at {}; check {}",
                 vectors,
                 describeCount(now, shader::kCheckMotionBeyond),
                 now.facts.isNative ? "that it is in pixels" : "pixelsPerUnit"
             )}
        );
}

void checkBlended(const CheckedFrame& now, std::vector<Finding>& findings) {
    struct Row {
        uint32_t index;
        CheckKind kind;
        const char* what;
        const char* rest;
    };

    for (const Row& row : std::initializer_list<Row>{
             {shader::kCheckBlendedNan,
              CheckKind::BlendedNan,
              "blended holds NaN or infinity",
              ", where nothing or white is drawn"},
             {shader::kCheckBlendedNegative,
              CheckKind::BlendedNegative,
              "blended is negative",
              "; it must be linear light, premultiplied"},
             {shader::kCheckBlendedOpacity,
              CheckKind::BlendedOpacity,
              "the alpha of blended is outside [0, 1]",
              "; it must be the opacity, in the mean over the exposure"}})
        if (countOf(now, row.index) > 0)
            findings.push_back(
                {row.kind,
                 fmt::format("{} at {}{}", row.what, describeCount(now, row.index), row.rest)}
            );
}

void checkDepthValues(const CheckedFrame& now, std::vector<Finding>& findings) {
    const CheckFacts& facts = now.facts;
    const HostDepth& depth = facts.convention.depth;
    const std::string_view name = depthName(facts);
    const auto add = [&](CheckKind kind, std::string sentence) {
        findings.push_back({kind, std::move(sentence)});
    };
    if (countOf(now, shader::kCheckDepthNan) > 0)
        add(CheckKind::DepthNan,
            fmt::format("{} holds NaN at {}", name, describeCount(now, shader::kCheckDepthNan)));
    // Infinity is a sky of linear depth.
    if (countOf(now, shader::kCheckDepthInfinite) > 0 && !depth.isLinear)
        add(CheckKind::DepthInfinite,
            fmt::format(
                "{} holds infinity at {}; raw depth is 0 to 1",
                name,
                describeCount(now, shader::kCheckDepthInfinite)
            ));
    if (countOf(now, shader::kCheckDepthNegative) > 0)
        add(CheckKind::DepthNegative,
            fmt::format(
                "{} is negative at {}; depth counts ahead of the camera: if view space faces "
                "-Z, store -z",
                name,
                describeCount(now, shader::kCheckDepthNegative)
            ));
    if (depth.isLinear && shareOf(now, shader::kCheckDepthZero) > 0.0 && depth.skyValue != 0.0f)
        add(CheckKind::DepthZero,
            fmt::format(
                "{} is 0 at {}, which is no distance; if nothing is drawn there, set "
                "skyValue or store {}",
                name,
                describeCount(now, shader::kCheckDepthZero),
                facts.isNative ? 1.0e9f : depth.skyValue
            ));
    if (!depth.isLinear && shareOf(now, shader::kCheckDepthAboveOne) > 0.01)
        add(CheckKind::DepthAboveOne,
            fmt::format(
                "depthIsLinear is false, but {} is above 1 at {}: for linear depth set "
                "depthIsLinear = true",
                name,
                describeCount(now, shader::kCheckDepthAboveOne)
            ));
    if (!depth.isLinear && depth.image.format == VK_FORMAT_R16_SFLOAT)
        add(CheckKind::DepthPrecision,
            "depth is R16_SFLOAT with raw depth, which resolves 2048 distances "
            "at the far end; use the depth buffer itself, or linear depth");
}

void checkSky(const CheckedFrame& now, std::vector<Finding>& findings) {
    const CheckFacts& facts = now.facts;
    const HostDepth& depth = facts.convention.depth;
    if (depth.isLinear || std::isnan(depth.skyValue))
        return;
    const bool isZero = depth.skyValue == 0.0f;
    if (!isZero && depth.skyValue != 1.0f)
        return;
    // The other end of the range in bulk, and this one nowhere.
    const uint32_t other = isZero ? shader::kCheckDepthOne : shader::kCheckDepthZero;
    if (countOf(now, shader::kCheckDepthSky) > 0 || shareOf(now, other) < 0.01)
        return;
    findings.push_back(
        {CheckKind::DepthSky,
         fmt::format(
             "raw depth is {} at {} and {} nowhere, where skyValue is {}: set "
             "skyValue = {}{}",
             isZero ? 1 : 0,
             describeCount(now, other),
             depth.skyValue,
             depth.skyValue,
             isZero ? 1 : 0,
             ", and see that cameras.clipFromView has the direction of depth that was drawn with"
         )}
    );
}

/// The sky where the camera has its near plane.
void checkSkyEnd(const CheckFacts& facts, bool isReversed, std::vector<Finding>& findings) {
    const float skyValue = facts.convention.depth.skyValue;
    const bool isReported =
        std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
            return finding.kind == CheckKind::DepthSky;
        });
    if (skyValue != (isReversed ? 1.0f : 0.0f) || isReported)
        return;
    findings.push_back(
        {CheckKind::DepthSky,
         fmt::format(
             "skyValue is {}, but by cameras.clipFromView that is the near "
             "plane: set skyValue = {}",
             skyValue,
             isReversed ? 0 : 1
         )}
    );
}

} // namespace

std::string describeShare(double share) {
    const double percent = 100.0 * share;
    return percent >= 9.95 ? fmt::format("{:.0f} %", percent) : fmt::format("{:.2g} %", percent);
}

std::string describeCount(const CheckedFrame& frame, uint32_t index) {
    return fmt::format(
        "{} pixel{} ({})",
        countOf(frame, index),
        countOf(frame, index) == 1 ? "" : "s",
        describeShare(shareOf(frame, index))
    );
}

void checkTotals(const CheckedFrame& now, std::vector<Finding>& findings) {
    if (!hasCameras(now.facts))
        findings.push_back(
            {CheckKind::LeftOut,
             "without cameras, vectors and depth are not compared with what the camera "
             "does; everything else is checked"}
        );
    checkColorAndMotion(now, findings);
    checkBlended(now, findings);
    checkDepthValues(now, findings);
    checkSky(now, findings);
    const shader::CheckTotals& totals = now.totals;
    const bool isSky = shareOf(now, shader::kCheckDepthSky) > 0.999;
    const VkExtent2D size = now.facts.picture;
    if (totals.depthLeast != totals.depthMost || uint64_t(size.width) * size.height < kMinPixels)
        return;
    // A picture of the sky alone is one depth by right.
    if (isSky && (!now.facts.hasIds || shareOf(now, shader::kCheckIdNone) > 0.99))
        return;
    findings.push_back(
        {CheckKind::DepthEqual,
         fmt::format(
             "{} is {} at every pixel{}: was it written before the motion blur, and is it the "
             "image that was drawn into?",
             depthName(now.facts),
             std::bit_cast<float>(totals.depthLeast),
             isSky ? ", as if nothing was drawn, although entityId has entities" : ""
         )}
    );
}

bool checkDepthDirection(const CheckedFrame& now, std::vector<Finding>& findings) {
    const CheckFacts& facts = now.facts;
    const HostDepth& depth = facts.convention.depth;
    if (depth.isLinear || !facts.convention.cameras.areGiven)
        return false;
    shader::PrepareTable plain = makePrepareTable(facts.convention, facts.picture);
    plain.skyValue = std::nanf("");
    // By the sign of the slope of (x + y value) / (z + w value).
    const glm::vec4& k = plain.depthFromValue;
    const bool isReversed = k.y * k.z - k.x * k.w < 0.0f;
    checkSkyEnd(facts, isReversed, findings);
    if ((plain.flags & shader::kPreparePerspective) == 0)
        return false; // its depth is linear: not much lies next to either end
    const float near = shader::metresOfDepth(plain, isReversed ? 1.0f : 0.0f);
    uint32_t drawn = 0;
    uint32_t atNear = 0;
    uint32_t flippedAtNear = 0;
    for (const shader::CheckSample& sample : now.totals.samples) {
        if (!(sample.depth > 0.0f && sample.depth < 1.0f))
            continue;
        ++drawn;
        atNear += shader::metresOfDepth(plain, sample.depth) < 2.0f * near;
        flippedAtNear += shader::metresOfDepth(plain, 1.0f - sample.depth) < 2.0f * near;
    }
    if (drawn < 64 || atNear < drawn * 9 / 10 || flippedAtNear > drawn / 2)
        return false;
    findings.push_back(
        {CheckKind::DepthDirection,
         fmt::format(
             "by cameras.clipFromView, {} of {} samples lie within {:.3g} m, next to the near "
             "plane, "
             "and the other way round {}: depth is {}, so give the {} "
             "projection as cameras.clipFromView and clipFromViewBefore, and skyValue = {}",
             atNear,
             drawn,
             2.0f * near,
             flippedAtNear,
             isReversed ? "forward depth (far is 1)" : "reversed depth (far is 0)",
             isReversed ? "forward" : "reversed",
             isReversed ? 1 : 0
         )}
    );
    return true;
}

} // namespace shutter::motion_blur
