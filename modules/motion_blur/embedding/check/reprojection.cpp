// SPDX-License-Identifier: MIT
// Checks cameras against the last frame's depth, for a host without motion vectors: at the
// reprojected places of this frame's surfaces, that frame must show surfaces at their depth. As
// with vectors (vectors.cpp), possible mistakes are tried one at a time.
#include "modules/motion_blur/embedding/check/hypothesis.h"
#include "modules/motion_blur/embedding/check/last_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace shutter::motion_blur {

namespace {

using math::dmat4;
using math::dvec2;

constexpr size_t kMinKnown = 200;      ///< minimum number of samples for a finding
constexpr size_t kMinInformative = 48; ///< samples that a mistake explains
constexpr size_t kLensStride = 3;      ///< of the samples that a lens is fitted to

/// What of a frame's samples is found in the last one.
struct Found {
    std::vector<Match> matches;
    size_t same = 0;
    size_t other = 0;
    size_t outside = 0; ///< of the last picture, by the cameras

    [[nodiscard]] size_t known() const { return same + other; }
};

/// The frames as the host declared them, or a hypothesis.
struct Declared {
    CheckFacts now;
    CheckFacts last;
};

class Reprojection {
  public:
    Reprojection(const CheckedFrame& now, const CheckedFrame& last)
        : mNow(now), mLast(last), mIsMover(markMovers(now.facts)), mDeclared{now.facts, last.facts},
          mFound(reproject(mDeclared)) {}

    [[nodiscard]] std::optional<Finding> findMistake() {
        // Usually, less leaves the view in a frame than stays in it.
        if (mFound.outside > mFound.known())
            std::replace(
                mFound.matches.begin(), mFound.matches.end(), Match::Unknown, Match::Other
            );
        else if (mFound.known() < kMinKnown || 20 * mFound.other <= mFound.known())
            return std::nullopt;
        tryCameras();
        tryDepth();
        if (!mBest)
            tryLens();
        if (mBest)
            return Finding{CheckKind::Vectors, "the last frame's depth agrees with " + mSentence};
        return describeRest();
    }

  private:
    [[nodiscard]] Found reproject(const Declared& declared, size_t stride = 1) const {
        const FineDepth depth(mLast, declared.last);
        const std::vector<CheckPoint> points = makePoints(mNow, declared.now);
        const VkExtent2D size = declared.now.picture;
        Found found;
        for (size_t i = 0; i < points.size(); i += stride) {
            const CheckPoint& point = points[i];
            const bool moves = point.id < mIsMover.size() && mIsMover[point.id];
            Match match = Match::Unknown;
            if (!point.isSky && !moves) {
                const dvec2 place = point.place - point.camera;
                match = depth.compare(place, point.metresBefore);
                found.outside +=
                    !(place.x >= 0.0 && place.y >= 0.0 && place.x <= size.width &&
                      place.y <= size.height);
            }
            found.matches.push_back(match);
            found.same += match == Match::Same;
            found.other += match == Match::Other;
        }
        return found;
    }

    /// Accepts a hypothesis that explains samples which the declaration does not, and loses hardly
    /// any.
    void consider(const Declared& candidate, const std::string& sentence) {
        const Found found = reproject(candidate);
        size_t won = 0;
        size_t lost = 0;
        for (size_t i = 0; i < found.matches.size(); ++i) {
            won += found.matches[i] == Match::Same && mFound.matches[i] == Match::Other;
            lost += found.matches[i] == Match::Other && mFound.matches[i] == Match::Same;
        }
        const bool isBetter = won >= std::max(kMinInformative, mFound.known() / 20) &&
                              won >= 6 * lost && 10 * found.same >= 7 * found.known() &&
                              2 * found.known() >= mFound.known();
        if (!isBetter || (mBest && *mBest >= found.same))
            return;
        mBest = found.same;
        mSentence = sentence;
    }

    void tryCameras() {
        Declared candidate = mDeclared;
        HostCameras& cameras = candidate.now.convention.cameras;
        for (dmat4* view : {&cameras.viewFromWorld, &cameras.viewFromWorldBefore})
            *view = glm::inverse(*view);
        consider(
            candidate,
            "the inverse of cameras.viewFromWorld: it holds the camera's own place (world from "
            "view); give its inverse, and that of viewFromWorldBefore"
        );
        consider(
            {scaleLens(mDeclared.now, {1.0, -1.0}), mDeclared.last},
            "the cameras after the second row of cameras.clipFromView is negated: y = -1 must be "
            "the top of the picture; negate the row of clipFromViewBefore, too"
        );
    }

    void tryDepth() {
        const HostDepth& depth = mDeclared.now.convention.depth;
        const auto change = [&](const auto& apply) {
            Declared candidate = mDeclared;
            apply(candidate.now);
            apply(candidate.last);
            return candidate;
        };
        const auto interpret = [&](bool isLinear) {
            return change([&](CheckFacts& facts) {
                facts.convention.depth.isLinear = isLinear;
                facts.convention.depth.skyValue = std::numeric_limits<float>::quiet_NaN();
            });
        };
        if (!depth.isLinear) {
            consider(
                change([](CheckFacts& facts) {
                    facts.flipsDepth = true;
                    facts.convention.depth.skyValue = 1.0f - facts.convention.depth.skyValue;
                }),
                "the cameras after depth is reversed: cameras.clipFromView has near and far the "
                "other way round than depth"
            );
            const Declared linear = interpret(true);
            if (!isFlat(linear.now))
                consider(linear, "the cameras if depth is linear: set depthIsLinear = true");
            return;
        }
        consider(
            interpret(false),
            "the cameras if depth is as the hardware stores it: set depthIsLinear = false"
        );
        for (const float factor : kUnitFactors)
            consider(
                change([&](CheckFacts& facts) { facts.convention.depth.metresPerUnit *= factor; }),
                fmt::format(
                    "the cameras after depth is multiplied by {:g}: depth and viewFromWorld are in "
                    "different units, set metresPerUnit = {:g}",
                    factor,
                    factor * depth.metresPerUnit
                )
            );
    }

    /// Depths are so alike that they agree with any camera, as hardware depth of far surfaces does
    /// where it is taken for linear.
    [[nodiscard]] bool isFlat(const CheckFacts& declared) const {
        std::vector<float> metres;
        for (const CheckPoint& point : makePoints(mNow, declared))
            if (!point.isSky)
                metres.push_back(point.metres);
        if (metres.empty())
            return true;
        std::sort(metres.begin(), metres.end());
        return metres[metres.size() * 9 / 10] < 1.1f * metres[metres.size() / 10];
    }

    void tryLens() {
        const dvec2 scale = fitLens([&](const dvec2& tried) {
            const Found found =
                reproject({scaleLens(mDeclared.now, tried), mDeclared.last}, kLensStride);
            return -double(found.same);
        });
        consider(
            {scaleLens(mDeclared.now, scale), mDeclared.last},
            "the cameras if " + describeLens(mDeclared.now, scale) +
                ": set it, and clipFromViewBefore's, to what the picture was drawn with"
        );
    }

    /// Where movers are listed, all else is static by the host's own word.
    [[nodiscard]] std::optional<Finding> describeRest() const {
        const bool hasMotionInputs = mNow.facts.readsMotion && mNow.facts.hasIds;
        const size_t least = hasMotionInputs ? 4 : 7; // tenths
        if (mFound.known() < kMinKnown || 10 * mFound.other < least * mFound.known())
            return std::nullopt;
        return Finding{
            CheckKind::Unexplained,
            fmt::format(
                "by the last frame's depth, {} of the static pixels are not where the cameras "
                "place them, and no single mistake explains it: hold viewFromWorld, "
                "viewFromWorldBefore, clipFromView and depth against what the picture was drawn "
                "with",
                describeShare(double(mFound.other) / double(mFound.known()))
            )};
    }

    const CheckedFrame& mNow;
    const CheckedFrame& mLast;
    std::vector<bool> mIsMover;
    Declared mDeclared;
    Found mFound;
    std::optional<size_t> mBest;
    std::string mSentence;
};

} // namespace

void checkReprojection(
    const CheckedFrame& now, const CheckedFrame& last, std::vector<Finding>& findings
) {
    const VkExtent2D size = now.facts.picture;
    if (size.width != last.facts.picture.width || size.height != last.facts.picture.height ||
        !now.facts.convention.cameras.areGiven || !last.facts.convention.cameras.areGiven)
        return;
    if (auto finding = Reprojection(now, last).findMistake())
        findings.push_back(std::move(*finding));
}

} // namespace shutter::motion_blur
