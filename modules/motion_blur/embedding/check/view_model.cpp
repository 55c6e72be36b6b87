// SPDX-License-Identifier: MIT
// Finds a weapon or cockpit that the host did not declare: depth that stays where it is in the
// picture while the cameras move all around it, in a range of values of its own.
#include "modules/motion_blur/embedding/check/last_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace shutter::motion_blur {

namespace {

constexpr double kMinMotionPx = 4.0; ///< that the cameras imply between the frames
constexpr size_t kMinStaying = 40;   ///< samples
constexpr double kMinShare = 0.9;    ///< of the nearest samples, that stay

struct NearSample {
    float metres;
    float stored;
    /// The last frame shows it where this one does, and not where the cameras imply.
    bool stays;
};

/// Samples of one frame that the last one shows, the nearest first.
std::vector<NearSample> sortSamples(const CheckedFrame& now, const CheckedFrame& last) {
    const FineDepth before(last, last.facts);
    const std::vector<bool> isMover = markMovers(now.facts);
    std::vector<NearSample> found;
    for (const CheckPoint& point : makePoints(now, now.facts)) {
        const bool moves = point.id < isMover.size() && isMover[point.id];
        if (point.isSky || moves || !(glm::length(point.camera) > kMinMotionPx))
            continue;
        const Match asWorld = before.compare(point.place - point.camera, point.metresBefore);
        const Match asItself = before.compare(point.place, point.metres);
        if (asWorld == Match::Same || asItself == Match::Same)
            found.push_back({point.metres, point.stored, asWorld != Match::Same});
    }
    std::sort(found.begin(), found.end(), [](const NearSample& a, const NearSample& b) {
        return a.metres < b.metres;
    });
    return found;
}

/// How many of the nearest samples nearly all stay.
size_t countStaying(const std::vector<NearSample>& samples) {
    size_t stays = 0;
    size_t counted = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
        stays += samples[i].stays;
        if (samples[i].stays && double(stays) >= kMinShare * double(i + 1))
            counted = i + 1;
    }
    return counted;
}

/// Values of hardware depth that lie behind the camera by its projection. What is infinitely far is
/// not among them: it is sky, whatever skyValue is.
std::vector<float> findImpossible(const CheckedFrame& now) {
    const HostConvention& convention = now.facts.convention;
    if (convention.depth.isLinear)
        return {};
    const glm::vec4 k = makePrepareTable(convention, now.facts.picture).depthFromValue;
    std::vector<float> found;
    for (const CheckPoint& point : makePoints(now, now.facts)) {
        const float metres = (k.x + k.y * point.stored) / (k.z + k.w * point.stored);
        if (point.stored != convention.depth.skyValue && std::isfinite(metres) && metres < 0.0f)
            found.push_back(point.stored);
    }
    return found;
}

bool reportImpossible(const CheckedFrame& now, std::vector<Finding>& findings) {
    std::vector<float> found = findImpossible(now);
    if (found.size() < kMinStaying)
        return false;
    const auto [least, most] = std::minmax_element(found.begin(), found.end());
    findings.push_back(
        {CheckKind::ViewModel,
         fmt::format(
             "depth from {:.4g} to {:.4g}, at {} samples, is of no surface before the camera by "
             "cameras.clipFromView, and counts as sky: a weapon or cockpit with a range of depth "
             "of "
             "its own is a viewModel",
             *least,
             *most,
             found.size()
         )}
    );
    return true;
}

} // namespace

void checkViewModel(
    const CheckedFrame& now, const CheckedFrame& last, std::vector<Finding>& findings
) {
    const CheckFacts& facts = now.facts;
    const VkExtent2D then = last.facts.picture;
    // Filters follow the vectors, which know a weapon's motion.
    if ((facts.hasVectors && !facts.readsMotion) || !facts.convention.cameras.areGiven ||
        !last.facts.convention.cameras.areGiven || facts.picture.width != then.width ||
        facts.picture.height != then.height)
        return;
    if (reportImpossible(now, findings))
        return;
    const std::vector<NearSample> samples = sortSamples(now, last);
    const size_t count = countStaying(samples);
    // Where all stays, it is the cameras that are wrong.
    if (count < kMinStaying || 2 * count > samples.size())
        return;
    const auto [least, most] = std::minmax_element(
        samples.begin(),
        samples.begin() + std::ptrdiff_t(count),
        [](const NearSample& a, const NearSample& b) { return a.stored < b.stored; }
    );
    findings.push_back(
        {CheckKind::ViewModel,
         fmt::format(
             "depth from {:.4g} to {:.4g} stays where it is in the picture, at {} samples, while "
             "the "
             "cameras move the rest: a weapon or cockpit is a viewModel or in viewModelRows, and "
             "what keeps pace with the camera a mover; else it is blurred as if it were the "
             "world's",
             least->stored,
             most->stored,
             count
         )}
    );
}

} // namespace shutter::motion_blur
