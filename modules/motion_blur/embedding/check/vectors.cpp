// SPDX-License-Identifier: MIT
// Checks motion vectors against the motion that the cameras imply for static surfaces. Possible
// mistakes are tried one at a time, and reported if the vectors agree with the cameras under that
// hypothesis and not without it. Movers agree with neither and so do not count.
#include "modules/motion_blur/embedding/check/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>

namespace shutter::motion_blur {

namespace {

using math::dvec2;

/// Factor from the motion along an axis to the camera's.
std::optional<double> fitScale(const std::vector<CheckPoint>& points, int axis) {
    std::vector<double> ratios;
    for (const CheckPoint& point : points)
        if (!point.isSky && std::abs(point.camera[axis]) > 1.0 &&
            std::abs(point.motion[axis]) > 1.0e-9)
            ratios.push_back(point.camera[axis] / point.motion[axis]);
    return takeMedian(ratios, kMinInformative);
}

bool isNear(double value, double wanted) {
    return std::abs(value - wanted) <= 0.05 * std::abs(wanted);
}

/// A unit of motion vectors that hosts have.
struct Unit {
    const char* name;
    dvec2 pixels; ///< per unit
};

std::string describeFactors(const dvec2& factors) {
    const auto describe = [](const char* axis, double factor) {
        return isNear(factor, -1.0) ? fmt::format("{} is negated", axis)
                                    : fmt::format("{} is multiplied by {:.4g}", axis, factor);
    };
    const bool hasX = !isNear(factors.x, 1.0);
    const bool hasY = !isNear(factors.y, 1.0);
    if (hasX && hasY)
        return describe("x", factors.x) + " and " + describe("y", factors.y);
    return hasX ? describe("x", factors.x) : describe("y", factors.y);
}

/// Collects hypotheses.
class Guesses {
  public:
    Guesses(const CheckedFrame& now, const CheckedFrame* last, Hypothesis declared)
        : mNow(now), mLast(last), mFacts(now.facts), mDeclared(std::move(declared)) {}

    [[nodiscard]] std::optional<std::string> findMistake() {
        tryUnits();
        tryExposure();
        tryCamera();
        trySwap();
        tryFrames();
        tryCameras();
        tryDepth();
        tryFactors();
        if (!mBest)
            tryLens();
        return mBest ? std::optional(mSentence) : std::nullopt;
    }

  private:
    void consider(const Hypothesis& declared, const Hypothesis& candidate) {
        const auto explained = judge(declared, candidate);
        if (!explained)
            return;
        // The first of what explains as much: they come in the order of how often hosts do so.
        const size_t apart = candidate.points.size() / 33;
        if (mBest && *explained <= *mBest + apart) {
            if (candidate.isAlternative && *explained + apart >= *mBest)
                mSentence += "; or " + candidate.sentence;
            return;
        }
        mBest = explained;
        mSentence = candidate.sentence;
    }

    void consider(const Hypothesis& candidate) { consider(mDeclared, candidate); }

    void tryCamera() {
        if (mFacts.isNative || (mDeclared.haveCamera && !areZero()))
            return;
        Hypothesis candidate = mDeclared;
        candidate.haveCamera = !mDeclared.haveCamera;
        candidate.sentence =
            mDeclared.haveCamera
                ? "vectors are 0 where things are static although the camera moves: the camera's "
                  "part is not in them, set vectorsLackCamera = true"
                : "vectors hold the camera's part already: set vectorsLackCamera = false";
        consider(candidate);
    }

    /// Whether most vectors are none at all, and not short ones, where the camera's are long.
    [[nodiscard]] bool areZero() const {
        size_t count = 0;
        size_t zero = 0;
        for (const CheckPoint& point : mDeclared.points) {
            const double camera = glm::length(point.camera);
            if (point.isSky || camera < 1.0)
                continue;
            ++count;
            zero += glm::length(point.motion) <= 1.5e-4 * camera; // texture coordinates: 1 / width
        }
        return 10 * zero >= 6 * count;
    }

    /// Units that hosts have, either way in time, y down or up.
    void tryUnits() {
        if (!mDeclared.haveCamera)
            return;
        forEachUnit([&](const Unit& unit, const dvec2& sign) {
            considerScale(
                sign * unit.pixels / dvec2(mFacts.convention.vectors.pixelsPerUnit),
                fmt::format(
                    ", as for {} that lead to {} with y {}",
                    unit.name,
                    sign.x < 0.0 ? "the frame before" : "this frame",
                    sign.x == sign.y ? "down" : "up"
                )
            );
        });
    }

    void forEachUnit(const std::function<void(const Unit&, const dvec2& sign)>& visit) const {
        const dvec2 size(mFacts.picture.width, mFacts.picture.height);
        for (const Unit& unit : std::initializer_list<Unit>{
                 {"pixels", dvec2(1.0)},
                 {"texture coordinates", size},
                 {"normalised device coordinates", 0.5 * size}})
            for (const dvec2& sign :
                 {dvec2(1.0, 1.0), dvec2(-1.0, -1.0), dvec2(1.0, -1.0), dvec2(-1.0, 1.0)})
                visit(unit, sign);
    }

    void considerScale(const dvec2& factors, const std::string& unit) {
        Hypothesis candidate = mDeclared;
        candidate.scale = factors;
        const dvec2 pixels = factors * dvec2(mFacts.convention.vectors.pixelsPerUnit);
        candidate.sentence =
            mFacts.isNative
                ? fmt::format(
                      "motionDepth agrees with the cameras after {}{}: it must hold pixels, right "
                      "and down, from shutter open to close; or give vectors with "
                      "pixelsPerUnit = ({:.6g}, {:.6g})",
                      describeFactors(factors),
                      unit,
                      pixels.x,
                      pixels.y
                  )
                : fmt::format(
                      "vectors agree with the cameras after {}{}: set pixelsPerUnit = "
                      "({:.6g}, {:.6g})",
                      describeFactors(factors),
                      unit,
                      pixels.x,
                      pixels.y
                  );
        consider(candidate);
    }

    void tryExposure() {
        const double share = mFacts.convention.scales.exposureShare;
        if (mFacts.isNative || !mDeclared.haveCamera || !(share > 0.0))
            return;
        Hypothesis candidate = mDeclared;
        candidate.scale = dvec2(1.0 / share);
        candidate.sentence = fmt::format(
            "vectors agree with the cameras after multiplication by {:.4g}, 1 / exposureShare: "
            "they are over the exposure already, set exposureShare = 1, and give the camera "
            "at shutter open as the one before",
            1.0 / share
        );
        consider(candidate);
    }

    /// Any factors. Much may pass for them, such as another frame's motion, so they come last. What
    /// fits one frame by chance, as the vectors of a shape that grows do, does not fit the one
    /// before by the same factors.
    void tryFactors() {
        const auto x = fitScale(mDeclared.points, 0);
        const auto y = fitScale(mDeclared.points, 1);
        if (!mLast || !mDeclared.haveCamera || !(x || y))
            return;
        const dvec2 factors(x ? *x : *y, y ? *y : *x);
        const Hypothesis before = readDeclared(*mLast);
        Hypothesis candidate = before;
        candidate.scale = factors;
        if (judge(before, candidate))
            considerScale(
                factors,
                ", as they do where cameras.clipFromView has another field of view or aspect ratio "
                "than the picture was drawn with, or the vectors another unit"
            );
    }

    void trySwap() {
        if (!mDeclared.haveCamera)
            return;
        // Only units that hosts have are tried: two free factors would fit an orthographic camera's
        // motion, which is nearly the same everywhere, whatever is wrong.
        const dvec2 unit(mFacts.convention.vectors.pixelsPerUnit);
        forEachUnit([&](const Unit& meant, const dvec2& sign) {
            Hypothesis candidate = mDeclared;
            candidate.isSwapped = true;
            const dvec2 pixels = sign * meant.pixels;
            candidate.scale = pixels / dvec2(unit.y, unit.x);
            candidate.sentence = fmt::format(
                "vectors agree with the cameras after x and y are exchanged: write x to the first "
                "channel and y to the second, with pixelsPerUnit = ({:.6g}, {:.6g})",
                pixels.x,
                pixels.y
            );
            consider(candidate);
        });
    }

    /// Vectors, or cameras, of another frame.
    void tryFrames() {
        const HostCameras& cameras = mFacts.convention.cameras;
        if (!mLast || !cameras.areGiven || mFacts.hasExposureCameras ||
            !mLast->facts.convention.cameras.areGiven)
            return;
        const HostCameras& then = mLast->facts.convention.cameras;
        CheckFacts facts = mFacts;
        facts.convention.cameras.viewFromWorldBefore = then.viewFromWorld;
        facts.convention.cameras.clipFromViewBefore = then.clipFromView;
        considerFacts(
            facts,
            "vectors agree with the viewFromWorld of the frame before, which "
            "cameras.viewFromWorldBefore is not: set it, and clipFromViewBefore, to last frame's"
        );
        // The last frame's vectors lead to this frame.
        Hypothesis declared = read(*mLast, mLast->facts);
        considerLastVectors(declared);
        facts = mLast->facts;
        facts.convention.cameras.viewFromWorldBefore = cameras.viewFromWorld;
        facts.convention.cameras.clipFromViewBefore = cameras.clipFromView;
        Hypothesis candidate = read(*mLast, facts);
        for (CheckPoint& point : candidate.points)
            point.camera = -point.camera;
        candidate.sentence =
            "vectors lead from this frame to the next one: make them from the frame "
            "before, or delay the cameras by a frame";
        consider(declared, candidate);
    }

    /// This frame's vectors by the last one's cameras and depth.
    void considerLastVectors(const Hypothesis& then) {
        if (then.points.size() != mDeclared.points.size())
            return;
        Hypothesis candidate = mDeclared;
        for (size_t i = 0; i < candidate.points.size(); ++i) {
            candidate.points[i].camera = then.points[i].camera;
            candidate.points[i].isSky = then.points[i].isSky;
        }
        candidate.sentence =
            "vectors are those of the frame before: they agree with last frame's cameras, so read "
            "the image after this frame has written it";
        consider(candidate);
    }

    void tryCameras() {
        const HostCameras& cameras = mFacts.convention.cameras;
        if (!cameras.areGiven || mFacts.hasExposureCameras)
            return;
        CheckFacts facts = mFacts;
        for (math::dmat4* view :
             {&facts.convention.cameras.viewFromWorld,
              &facts.convention.cameras.viewFromWorldBefore})
            *view = glm::inverse(*view);
        considerFacts(
            facts,
            "vectors agree with the inverse of cameras.viewFromWorld: it holds the camera's own "
            "place (world from view); give its inverse, and that of viewFromWorldBefore"
        );
        facts = mFacts;
        for (math::dmat4* clip :
             {&facts.convention.cameras.clipFromView, &facts.convention.cameras.clipFromViewBefore})
            for (int column = 0; column < 4; ++column)
                (*clip)[column].y = -(*clip)[column].y;
        // Under an orthographic camera all points move alike, so this is indistinguishable from
        // vectors with y up.
        Hypothesis candidate = read(mNow, facts);
        candidate.isAlternative = true;
        candidate.sentence =
            "vectors agree with the cameras after the second row of cameras.clipFromView is "
            "negated: y = -1 must be the top of the picture; negate the row of clipFromViewBefore, "
            "too";
        consider(candidate);
    }

    void tryDepth() {
        const HostDepth& depth = mFacts.convention.depth;
        if (mFacts.isNative || !mFacts.convention.cameras.areGiven)
            return;
        CheckFacts facts = mFacts;
        if (!depth.isLinear) {
            facts.convention.depth.skyValue = 1.0f - depth.skyValue;
            facts.flipsDepth = true;
            considerFacts(
                facts,
                "vectors agree with the cameras after depth is reversed: cameras.clipFromView has "
                "near and far the other way round than depth"
            );
        }
        facts = mFacts;
        facts.convention.depth.isLinear = !depth.isLinear;
        facts.convention.depth.skyValue = std::numeric_limits<float>::quiet_NaN();
        considerFacts(
            facts,
            !depth.isLinear
                ? "vectors agree with the cameras if depth is linear: set depthIsLinear = true"
                : "vectors agree with the cameras if depth is as the hardware stores it: set "
                  "depthIsLinear = false"
        );
        if (!depth.isLinear)
            return;
        for (const float factor : kUnitFactors) {
            facts = mFacts;
            facts.convention.depth.metresPerUnit *= factor;
            considerFacts(
                facts,
                fmt::format(
                    "vectors agree with the cameras after depth is multiplied by {:g}: depth and "
                    "viewFromWorld are in different units, set metresPerUnit = {:g}",
                    factor,
                    facts.convention.depth.metresPerUnit
                )
            );
        }
    }

    /// Another field of view makes everything that the camera moves longer or shorter.
    void tryLens() {
        if (!mLast || !mFacts.convention.cameras.areGiven || mFacts.isNative ||
            !mDeclared.haveCamera || countAgreeing(mDeclared) * 2 >= mDeclared.points.size())
            return;
        const math::dvec2 scale = fitLens([&](const dvec2& tried) {
            const Hypothesis candidate = read(mNow, scaleLens(mFacts, tried));
            std::vector<double> off;
            for (const CheckPoint& point : candidate.points)
                if (!point.isSky)
                    off.push_back(glm::length(candidate.differenceOf(point)));
            return takeMedian(off, kMinPoints).value_or(0.0);
        });
        considerFacts(
            scaleLens(mFacts, scale),
            "vectors agree with the cameras if " + describeLens(mFacts, scale) +
                ": set it, and clipFromViewBefore's, to what the picture was drawn with"
        );
    }

    void considerFacts(const CheckFacts& facts, std::string sentence) {
        Hypothesis candidate = read(mNow, facts);
        candidate.sentence = std::move(sentence);
        consider(candidate);
    }

    const CheckedFrame& mNow;
    const CheckedFrame* mLast;
    const CheckFacts& mFacts;
    Hypothesis mDeclared;
    std::optional<size_t> mBest;
    std::string mSentence;
};

} // namespace

void checkVectors(CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings) {
    const Hypothesis declared = readDeclared(now);
    if (const auto mistake = Guesses(now, last, declared).findMistake())
        findings.push_back({CheckKind::Vectors, *mistake});
    else
        checkOffset(now, last, declared, findings);
}

} // namespace shutter::motion_blur
