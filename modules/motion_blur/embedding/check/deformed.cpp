// SPDX-License-Identifier: MIT
// Compares deformedMotion with motion vectors for pixels of deforming entities: from shutter open
// to close both must agree.
#include "modules/motion_blur/embedding/check/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace shutter::motion_blur {

namespace {

using math::dvec2;
using math::dvec4;

constexpr size_t kMinDeformed = 24; ///< minimum number of samples for a finding
constexpr double kMinMotionPx = 1.0;
constexpr double kDeformedTolerancePx = 0.5;
constexpr double kDeformedToleranceShare =
    0.25; ///< vectors of a frame are not quite the exposure's

struct DeformedSample {
    dvec2 vector{0.0}; ///< over the exposure
    dvec4 ends{0.0};   ///< to shutter open and close

    [[nodiscard]] dvec2 way() const { return dvec2(ends.z, ends.w) - dvec2(ends.x, ends.y); }
};

/// A hypothesis about the host's convention.
struct DeformedHypothesis {
    const char* sentence;
    dvec2 (*way)(const DeformedSample& sample, const CheckFacts& facts);
};

dvec2 pictureSize(const CheckFacts& facts) {
    return {facts.picture.width, facts.picture.height};
}

constexpr std::array kGuesses{
    DeformedHypothesis{
        "shutter open and close are exchanged, or displacements point the other way",
        [](const DeformedSample& sample, const CheckFacts&) { return -sample.way(); }},
    DeformedHypothesis{
        "y points up",
        [](const DeformedSample& sample, const CheckFacts&) {
            return dvec2(1.0, -1.0) * sample.way();
        }},
    DeformedHypothesis{
        "both are exchanged and y points up",
        [](const DeformedSample& sample, const CheckFacts&) {
            return dvec2(-1.0, 1.0) * sample.way();
        }},
    DeformedHypothesis{
        "displacements are shares of the picture, not pixels",
        [](const DeformedSample& sample, const CheckFacts& facts) {
            return pictureSize(facts) * sample.way();
        }},
    DeformedHypothesis{
        "displacements are in clip space, not pixels",
        [](const DeformedSample& sample, const CheckFacts& facts) {
            return 0.5 * pictureSize(facts) * sample.way();
        }},
    DeformedHypothesis{
        "they are over the time between the frames, not over the exposure",
        [](const DeformedSample& sample, const CheckFacts& facts) {
            const HostScales& scales = facts.convention.scales;
            return double(scales.exposureShare) / scales.displayedPerRendered * sample.way();
        }}};

std::vector<DeformedSample> listSamples(const CheckedFrame& frame) {
    const CheckFacts& facts = frame.facts;
    std::vector<bool> deforms(facts.rowCount, false);
    for (const CheckFacts::Mover& mover : facts.movers)
        if (mover.row < deforms.size())
            deforms[mover.row] = mover.firstMatrix == CheckFacts::kNone;
    const HostScales& scales = facts.convention.scales;
    const double share =
        facts.isNative ? 1.0 : double(scales.exposureShare) / scales.displayedPerRendered;
    const bool lackCamera = !facts.isNative && facts.convention.vectors.lackCamera;
    std::vector<DeformedSample> samples;
    for (const CheckPoint& point : makePoints(frame, facts)) {
        const dvec2 motion = lackCamera ? point.motion + point.camera : point.motion;
        DeformedSample sample{motion * share, dvec4(point.deformed)};
        const dvec2 way = sample.way();
        if (point.id < deforms.size() && deforms[point.id] && std::isfinite(way.x + way.y) &&
            glm::length(sample.vector) > kMinMotionPx)
            samples.push_back(sample);
    }
    return samples;
}

/// Share of the samples at which the way is the vector.
double measureAgreement(
    const std::vector<DeformedSample>& samples,
    const CheckFacts& facts,
    const DeformedHypothesis& candidate
) {
    const auto agreeing =
        std::count_if(samples.begin(), samples.end(), [&](const DeformedSample& sample) {
            return glm::distance(candidate.way(sample, facts), sample.vector) <=
                   kDeformedTolerancePx + kDeformedToleranceShare * glm::length(sample.vector);
        });
    return double(agreeing) / double(samples.size());
}

} // namespace

void checkDeformed(const CheckedFrame& now, std::vector<Finding>& findings) {
    constexpr DeformedHypothesis kDeclared{
        "", [](const DeformedSample& sample, const CheckFacts&) { return sample.way(); }};
    const CheckFacts& facts = now.facts;
    if (!facts.hasDeformed || !facts.hasVectors || !facts.hasIds ||
        hasFound(findings, {CheckKind::Vectors, CheckKind::IdChanges}))
        return;
    const std::vector<DeformedSample> samples = listSamples(now);
    if (samples.size() < kMinDeformed)
        return;
    const double agreeing = measureAgreement(samples, facts, kDeclared);
    if (agreeing >= 0.5)
        return;
    std::string sentence = fmt::format(
        "deformedMotion, from shutter open to close, is not what {} has at {} of what deforms",
        facts.isNative ? "motionDepth" : "vectors",
        describeShare(1.0 - agreeing)
    );
    for (const DeformedHypothesis& candidate : kGuesses)
        if (measureAgreement(samples, facts, candidate) >= 0.8) {
            sentence += fmt::format(": it would be if {}", candidate.sentence);
            break;
        }
    findings.push_back({CheckKind::Deformed, sentence});
}

} // namespace shutter::motion_blur
