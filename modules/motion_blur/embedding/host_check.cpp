// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_check.h"

#include "engine/core/words.h"
#include "engine/math/layer_tables.h"
#include "modules/motion_blur/embedding/host_camera.h"
#include "shaders/motion_blur/check_grid.glsl"
#include "shaders/motion_blur/prepare.glsl"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <optional>

namespace shutter::motion_blur {

namespace {

using math::dmat4;
using math::dvec2;

uint32_t countOf(const CheckedFrame& frame, uint32_t index) {
    return frame.totals.counts[index];
}

double shareOf(const CheckedFrame& frame, uint32_t index) {
    const VkExtent2D size = frame.facts.picture;
    return double(countOf(frame, index)) / (double(size.width) * size.height);
}

std::string_view vectorsName(const CheckFacts& facts) {
    return facts.isNative ? "motionDepth" : "convention.vectors.image";
}

std::string_view depthName(const CheckFacts& facts) {
    return facts.isNative ? "motionDepth" : "convention.depth.image";
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
                 now.facts.isNative ? "that it is in pixels" : "vectors.pixelsPerUnit"
             )}
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
    if (countOf(now, shader::kCheckDepthInfinite) > 0 && depth.isRaw)
        add(CheckKind::DepthInfinite,
            fmt::format(
                "{} holds infinity at {}; raw depth is 0 to 1",
                name,
                describeCount(now, shader::kCheckDepthInfinite)
            ));
    if (countOf(now, shader::kCheckDepthNegative) > 0)
        add(CheckKind::DepthNegative,
            fmt::format(
                "{} is negative at {}; depth counts ahead of the camera: if view space looks along "
                "-Z, store -z",
                name,
                describeCount(now, shader::kCheckDepthNegative)
            ));
    if (!depth.isRaw && shareOf(now, shader::kCheckDepthZero) > 0.0 && depth.skyValue != 0.0f)
        add(CheckKind::DepthZero,
            fmt::format(
                "{} is 0 at {}, which is no distance; if nothing is drawn there, set "
                "convention.depth.skyValue or store {}",
                name,
                describeCount(now, shader::kCheckDepthZero),
                facts.isNative ? 1.0e9f : depth.skyValue
            ));
    if (depth.isRaw && shareOf(now, shader::kCheckDepthAboveOne) > 0.01)
        add(CheckKind::DepthAboveOne,
            fmt::format(
                "convention.depth.isRaw is true, but {} is above 1 at {}: for linear depth set "
                "depth.isRaw = false",
                name,
                describeCount(now, shader::kCheckDepthAboveOne)
            ));
    if (depth.isRaw && depth.image.format == VK_FORMAT_R16_SFLOAT)
        add(CheckKind::DepthPrecision,
            "convention.depth.image is R16_SFLOAT with raw depth, which tells 2048 distances apart "
            "at the far end; use the depth buffer itself, or linear depth");
}

void checkSky(const CheckedFrame& now, std::vector<Finding>& findings) {
    const CheckFacts& facts = now.facts;
    const HostDepth& depth = facts.convention.depth;
    if (!depth.isRaw || std::isnan(depth.skyValue))
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
             "raw depth is {} at {} and {} nowhere, where convention.depth.skyValue is {}: set "
             "depth.skyValue = {}{}",
             isZero ? 1 : 0,
             describeCount(now, other),
             depth.skyValue,
             depth.skyValue,
             isZero ? 1 : 0,
             ", and see that cameras.clipFromView has the direction of depth that was drawn with"
         )}
    );
}

/// Picture space of `to` from that of `from`, both without jitter.
std::optional<dmat4> mapBetween(
    const HostCameraKey& from, const HostCameraKey& to, bool aheadIsPlusZ, VkExtent2D picture
) {
    const auto a = normalize(from, aheadIsPlusZ);
    const auto b = normalize(to, aheadIsPlusZ);
    if (!a || !b)
        return std::nullopt;
    const math::uvec2 sizePx(picture.width, picture.height);
    return b->pictureFromWorld(sizePx) * glm::inverse(a->pictureFromWorld(sizePx));
}

/// By how many pixels what is seen in the middle of the picture, far away, is elsewhere by another
/// camera; infinity: behind it.
double measureTurn(const HostCameraKey& from, const HostCameraKey& to, const CheckFacts& facts) {
    const auto map = mapBetween(from, to, facts.convention.cameras.aheadIsPlusZ, facts.picture);
    if (!map)
        return 0.0;
    const dvec2 middle = 0.5 * dvec2(facts.picture.width, facts.picture.height);
    const auto camera = normalize(from, facts.convention.cameras.aheadIsPlusZ);
    const double metres = 1.0e4; // a translation of some metres turns nothing there
    const glm::dvec4 point = camera->isPerspective ? glm::dvec4(middle * metres, metres, 1.0)
                                                   : glm::dvec4(middle, 10.0, 1.0);
    const glm::dvec4 seen = *map * point;
    if (!camera->isPerspective)
        return glm::length(dvec2(seen) - middle);
    return seen.z > 0.0 ? glm::length(dvec2(seen) / seen.z - middle) : HUGE_VAL;
}

/// The sky where the camera has its near plane.
void checkSkyEnd(const CheckFacts& facts, bool isReversed, std::vector<Finding>& findings) {
    const float skyValue = facts.convention.depth.skyValue;
    const bool isTold = std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
        return finding.kind == CheckKind::DepthSky;
    });
    if (skyValue != (isReversed ? 1.0f : 0.0f) || isTold)
        return;
    findings.push_back(
        {CheckKind::DepthSky,
         fmt::format(
             "convention.depth.skyValue is {}, but by cameras.clipFromView that is the near "
             "plane: set depth.skyValue = {}",
             skyValue,
             isReversed ? 0 : 1
         )}
    );
}

} // namespace

std::string describeCount(const CheckedFrame& frame, uint32_t index) {
    return fmt::format(
        "{} ({:.2g} %)",
        core::countOf(countOf(frame, index), "pixel"),
        100.0 * shareOf(frame, index)
    );
}

bool hasCameras(const CheckFacts& facts) {
    return facts.hasExposureCameras || facts.convention.cameras.areGiven;
}

std::vector<CheckPoint> makePoints(const CheckedFrame& frame, const CheckFacts& said) {
    HostConvention convention = said.convention;
    if (said.hasExposureCameras)
        convention.cameras = said.open;
    const shader::PrepareTable table = makePrepareTable(convention, said.picture);
    std::optional<shader::PrepareTable> close;
    if (said.hasExposureCameras) {
        convention.cameras = said.close;
        close = makePrepareTable(convention, said.picture);
    }
    std::vector<CheckPoint> points;
    points.reserve(shader::kCheckSamples);
    for (uint32_t i = 0; i < shader::kCheckSamples; ++i) {
        const shader::CheckSample& sample = frame.totals.samples[i];
        const glm::uvec2 cell(i % shader::kCheckAcross, i / shader::kCheckAcross);
        const glm::uvec2 pixel =
            shader::checkedPixel(cell, {said.picture.width, said.picture.height});
        CheckPoint point;
        point.place = dvec2(pixel) + 0.5;
        point.motion = dvec2(sample.vector) * dvec2(table.pixelsPerUnit) - dvec2(table.jitterPx);
        if (!std::isfinite(point.motion.x) || !std::isfinite(point.motion.y))
            continue;
        point.depth = sample.depth;
        point.metres = shader::metresOfDepth(table, sample.depth);
        point.isSky = point.metres >= shader::kSkyDepth;
        point.id = sample.id;
        if (hasCameras(said)) {
            const glm::vec2 place(point.place);
            point.camera = shader::motionOfCamera(table, place, point.metres);
            if (close)
                point.camera -= dvec2(shader::motionOfCamera(*close, place, point.metres));
        }
        points.push_back(point);
    }
    return points;
}

void checkTotals(const CheckedFrame& now, std::vector<Finding>& findings) {
    checkColorAndMotion(now, findings);
    checkDepthValues(now, findings);
    checkSky(now, findings);
    const shader::CheckTotals& totals = now.totals;
    const bool isSky = shareOf(now, shader::kCheckDepthSky) > 0.999;
    if (totals.depthLeast != totals.depthMost)
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
    if (!depth.isRaw || !facts.convention.cameras.areGiven)
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
             "and the other way round {}: convention.depth.image is {}, so give the {} "
             "projection as cameras.clipFromView and clipFromViewBefore, and depth.skyValue = {}",
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

void checkCameras(
    const CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings
) {
    if (!last)
        return;
    const CheckFacts& facts = now.facts;
    const HostCameras& cameras = facts.convention.cameras;
    const bool follows = facts.followsLast || (facts.frameNumber != 0 &&
                                               facts.frameNumber == last->facts.frameNumber + 1);
    if (!follows || facts.convention.scales.isCut)
        return;
    if (cameras.areGiven && last->facts.convention.cameras.areGiven) {
        const HostCameras& then = last->facts.convention.cameras;
        const double off = measureTurn(
            {0.0, then.viewFromWorld, then.clipFromView},
            {0.0, cameras.viewFromWorldBefore, cameras.clipFromViewBefore},
            facts
        );
        if (off > 1.0)
            findings.push_back(
                {CheckKind::CameraJump,
                 fmt::format(
                     "convention.cameras.viewFromWorldBefore is not the viewFromWorld of the frame "
                     "before: the middle of the picture differs by {:.3g} px; after a cut set "
                     "scales.isCut, and motion.followsLast = false",
                     off
                 )}
            );
        return;
    }
    if (!facts.followsLast || !facts.hasExposureCameras || !last->facts.hasExposureCameras)
        return;
    const double jump = measureTurn(
        {0.0, last->facts.open.viewFromWorld, last->facts.open.clipFromView},
        {0.0, facts.open.viewFromWorld, facts.open.clipFromView},
        facts
    );
    const double during = measureTurn(
        {0.0, facts.open.viewFromWorldBefore, facts.open.clipFromViewBefore},
        {0.0, facts.close.viewFromWorldBefore, facts.close.clipFromViewBefore},
        facts
    );
    // Eight exposures a frame are a shutter of 45 degrees.
    if (jump > 0.75 * facts.picture.width && jump > 8.0 * during)
        findings.push_back(
            {CheckKind::CameraJump,
             fmt::format(
                 "motion.followsLast is true, but the camera keys are {:.3g} px away from those of "
                 "the frame before, and move {:.3g} px during the exposure: after a cut, set "
                 "followsLast = false",
                 jump,
                 during
             )}
        );
}

std::vector<Finding> checkFrame(CheckedFrame& now, const CheckedFrame* last) {
    std::vector<Finding> findings;
    checkTotals(now, findings);
    if (!hasCameras(now.facts))
        findings.push_back(
            {CheckKind::LeftOut,
             "without convention.cameras, vectors and depth are not compared with what the camera "
             "does; everything else is checked"}
        );
    // Samples that lie where the depth says they do not agree with no camera.
    const bool isDepthWrong = checkDepthDirection(now, findings);
    if (now.facts.hasVectors && hasCameras(now.facts) && !isDepthWrong &&
        !now.facts.convention.scales.isCut)
        checkVectors(now, last, findings);
    checkCameras(now, last, findings);
    checkIds(now, last, findings);
    return findings;
}

} // namespace shutter::motion_blur
