// SPDX-License-Identifier: MIT
#include "engine/scene/camera_cut.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace shutter::scene {

namespace {

using math::dmat3;
using math::dmat4;
using math::dvec3;

constexpr int kIntervals = 16;
constexpr int kHalvings = 30;
/// A camera that races changes enough in many intervals at once; the largest changes are followed.
constexpr size_t kMostFollowed = 64;

struct Interval {
    double from = 0.0;
    double to = 0.0;
    dmat4 first{1.0};
    dmat4 last{1.0};
    double change = 0.0; ///< 1: the smallest that is a cut
};

/// Turn or displacement over its threshold, whichever is larger; 0 where one is nowhere.
double measureChange(const dmat4& a, const dmat4& b, const CutDetection& detection) {
    const dmat3 turn = glm::transpose(dmat3(a)) * dmat3(b);
    const double cosine = std::clamp((turn[0][0] + turn[1][1] + turn[2][2] - 1.0) / 2.0, -1.0, 1.0);
    const double degrees = std::acos(cosine) * 180.0 / std::numbers::pi;
    const double metres = glm::length(dvec3(b[3]) - dvec3(a[3]));
    if (!std::isfinite(metres))
        return 0.0;
    return std::max(degrees / detection.degrees, metres / detection.metres);
}

class Search {
  public:
    Search(const PoseAt& poseAt, const CutDetection& detection)
        : mPoseAt(poseAt), mDetection(detection) {}

    bool run(double from, double to) {
        std::vector<Interval> open;
        double at = from;
        dmat4 pose = mPoseAt(from);
        for (int i = 1; i <= kIntervals; ++i) {
            const double next = std::lerp(from, to, double(i) / kIntervals);
            const dmat4 nextPose = mPoseAt(next);
            follow(open, at, next, pose, nextPose);
            at = next;
            pose = nextPose;
        }
        for (int i = 0; i < kHalvings && !open.empty(); ++i)
            open = halve(open);
        return !open.empty();
    }

  private:
    /// Keeps the interval if a cut may lie in it.
    void follow(
        std::vector<Interval>& open, double from, double to, const dmat4& first, const dmat4& last
    ) const {
        const double change = measureChange(first, last, mDetection);
        if (change >= 1.0)
            open.push_back({from, to, first, last, change});
    }

    [[nodiscard]] std::vector<Interval> halve(const std::vector<Interval>& intervals) const {
        std::vector<Interval> halves;
        for (const Interval& interval : intervals) {
            const double middle = std::midpoint(interval.from, interval.to);
            const dmat4 pose = mPoseAt(middle);
            follow(halves, interval.from, middle, interval.first, pose);
            follow(halves, middle, interval.to, pose, interval.last);
        }
        if (halves.size() > kMostFollowed) {
            std::partial_sort(
                halves.begin(),
                halves.begin() + kMostFollowed,
                halves.end(),
                [](const Interval& a, const Interval& b) { return a.change > b.change; }
            );
            halves.resize(kMostFollowed);
        }
        return halves;
    }

    const PoseAt& mPoseAt;
    const CutDetection& mDetection;
};

} // namespace

bool findsCameraCut(const PoseAt& poseAt, double from, double to, const CutDetection& detection) {
    return detection.enabled && from < to && Search(poseAt, detection).run(from, to);
}

} // namespace shutter::scene
