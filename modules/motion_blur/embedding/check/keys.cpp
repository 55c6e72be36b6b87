// SPDX-License-Identifier: MIT
// Camera keys against the cameras of this frame and of the one before. The key at the raster
// instant is this frame's camera, and in the exposure the keys go that share of the way between the
// frames.
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/check/checked_frame.h"
#include "modules/motion_blur/embedding/host_ways.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace shutter::motion_blur {

namespace {

constexpr double kSamePx = 1.0; ///< keys may hold jitter, which cameras do not

class Keys {
  public:
    Keys(const CheckFacts& facts, double metres)
        : mFacts(facts), mMetres(metres), mNow(*findCamera(facts, false)),
          mBefore(*findCamera(facts, true)), mWay(facts.keys, false) {
        const HostScales& scales = facts.convention.scales;
        mShare = double(scales.exposureShare) / scales.displayedPerRendered;
        mFramePx = apart(mNow, mBefore);
    }

    /// Describes the fault of the key at the raster instant; empty: none.
    [[nodiscard]] std::string describeRaster() const {
        const HostCamera& raster = mWay.atKey(mFacts.rasterKey);
        const double off = apart(mNow, raster);
        if (off <= kSamePx)
            return {};
        if (const auto other = findNow())
            return describeOther(*other);
        if (apart(mBefore, raster) <= kSamePx)
            return "keys are those of the frame before: the one at rasterTime is "
                   "cameras.viewFromWorldBefore; give this frame's";
        HostCamera inverse = raster;
        inverse.viewFromWorld = glm::inverse(raster.viewFromWorld);
        if (apart(mNow, inverse) <= kSamePx)
            return "keys hold the camera's own place (world from view): the inverse of the "
                   "one at rasterTime is cameras.viewFromWorld; give the inverse of each";
        return fmt::format(
            "the key at rasterTime is {:.3g} px away from cameras.viewFromWorld and "
            "clipFromView, which are of the same instant",
            off
        );
    }

    /// How far the keys go from the raster instant to the far end of the exposure, and how far they
    /// should, pixels.
    struct Exposure {
        double px = 0.0;
        double wantedPx = 0.0;
        double time = 0.0; ///< of that end
    };

    [[nodiscard]] Exposure measure() const {
        const double time = mFacts.rasterTime >= 0.5 ? 0.0 : 1.0;
        const double part = std::abs(mFacts.rasterTime - time);
        return {apart(mNow, at(time)), part * mShare * mFramePx, time};
    }

    /// Whether the keys are reversed in time. With the raster instant in the middle, its key does
    /// not reveal that.
    [[nodiscard]] bool areReversed(const Exposure& exposure) const {
        // One end of a longer exposure may lie beyond the previous frame.
        if (exposure.wantedPx < 2.0 * kSamePx || exposure.wantedPx > mFramePx)
            return false;
        const HostCamera end = at(exposure.time);
        const bool isPast = exposure.time < mFacts.rasterTime;
        const double frame = apart(mBefore, mNow);
        return (apart(mBefore, end) > frame + 0.25 * exposure.wantedPx) == isPast;
    }

    [[nodiscard]] double framePx() const { return mFramePx; }

    [[nodiscard]] double share() const { return mShare; }

  private:
    [[nodiscard]] double apart(const HostCamera& from, const HostCamera& to) const {
        if (from.isPerspective != to.isPerspective)
            return HUGE_VAL;
        return measureApart(from, to, mFacts.picture, mMetres);
    }

    [[nodiscard]] HostCamera at(double time) const { return mWay.at(locate(mFacts.keys, time)); }

    /// Another key that is this frame's camera.
    [[nodiscard]] std::optional<size_t> findNow() const {
        for (size_t i = 0; i < mFacts.keys.size(); ++i)
            if (i != mFacts.rasterKey && apart(mNow, mWay.atKey(i)) <= kSamePx)
                return i;
        return std::nullopt;
    }

    [[nodiscard]] std::string describeOther(size_t other) const {
        const double time = mFacts.keys[other].time;
        const bool isEarlier = apart(mBefore, mWay.atKey(mFacts.rasterKey)) < apart(mBefore, mNow);
        if (isEarlier == (mFacts.rasterTime < time))
            return fmt::format(
                "the key at {:.3g} is cameras.viewFromWorld, and the one at "
                "rasterTime "
                "is not: the raster was drawn then, so set rasterTime = {:.3g}",
                time,
                time
            );
        return fmt::format(
            "keys run backwards: the key at {:.3g} is cameras.viewFromWorld, and the one at "
            "rasterTime lies before it; times rise from shutter open to close",
            time
        );
    }

    const CheckFacts& mFacts;
    double mMetres;
    HostCamera mNow;
    HostCamera mBefore;
    CameraWay mWay;
    double mShare = 0.0;
    double mFramePx = 0.0;
};

std::string describeShareOff(double keyShare, double share) {
    if (std::abs(keyShare - 1.0) < 0.1)
        return fmt::format(
            "keys go over the whole time between the frames in the exposure, of which it is "
            "{:.3g} by exposureShare: give the camera at shutter open, or the frame before at the "
            "time that shutterBlurGetTimeBefore() returns",
            share
        );
    return fmt::format(
        "keys go {:.3g} of the way between cameras.viewFromWorldBefore and viewFromWorld in "
        "the exposure, which is {:.3g} of the time between the frames by exposureShare: one of the "
        "two is wrong",
        keyShare,
        share
    );
}

} // namespace

void checkKeys(CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings) {
    const CheckFacts& facts = now.facts;
    const auto camera = findCamera(facts, false);
    if (facts.keys.empty() || !camera)
        return;
    const auto report = [&](std::string sentence) {
        findings.push_back({CheckKind::Keys, std::move(sentence)});
    };
    const Keys keys(facts, findTypicalMetres(makePoints(now, facts)));
    if (std::string sentence = keys.describeRaster(); !sentence.empty())
        return report(std::move(sentence));
    // With motionDepth the exposure's share is unknown.
    if (facts.isNative || !(keys.share() > 0.0))
        return;
    const Keys::Exposure exposure = keys.measure();
    if (exposure.wantedPx < kSamePx)
        return;
    now.keyShare = exposure.px * keys.share() / exposure.wantedPx;
    now.areKeysReversed = keys.areReversed(exposure);
    // A camera that starts, stops or turns back does in one frame what keys do that are wrong.
    if (!last || last->keyShare < 0.0)
        return;
    if (std::max(now.keyShare, last->keyShare) < 0.1 * keys.share())
        return report(fmt::format(
            "keys do not move in the exposure, although the camera moves {:.3g} px between "
            "the frames: give it at shutter open, too, or the frame before at the time that "
            "shutterBlurGetTimeBefore() returns",
            keys.framePx()
        ));
    if (now.areKeysReversed && last->areKeysReversed)
        return report("keys run backwards: they go on from cameras.viewFromWorld the way that "
                      "the camera came; times rise from shutter open to close");
    const bool isOff = std::abs(exposure.px - exposure.wantedPx) >
                       std::max(1.5 * kSamePx, 0.25 * exposure.wantedPx);
    // One that speeds up or slows down goes another share in each frame.
    if (isOff && std::abs(now.keyShare - last->keyShare) < 0.1 * now.keyShare)
        report(describeShareOff(now.keyShare, keys.share()));
}

} // namespace shutter::motion_blur
