// SPDX-License-Identifier: MIT
// Checks movers' matrices against their pixels: the motion vectors there or, without any, the last
// frame's ids and depth. Possible mistakes are tried for all movers at once.
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/check/last_frame.h"
#include "modules/motion_blur/embedding/host_ways.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

namespace shutter::motion_blur {

namespace {

using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;

constexpr size_t kMinSamples = 8;
/// From which a disagreement without a cause is reported: a vertex-animated model may be all that
/// is seen.
constexpr size_t kMinForVerdict = 24;
constexpr double kMoverTolerancePx = 0.5;
constexpr double kMoverToleranceShare =
    0.25; ///< of the expected motion: paths are not straight, nor even

/// Two times between which motion is given, with their cameras.
struct Span {
    double from = 0.0;
    double to = 1.0;
    HostCamera fromCamera;
    HostCamera toCamera;
};

/// Over the frame; with motionDepth over the exposure.
std::optional<Span> findSpan(const CheckFacts& facts) {
    const CameraWay way(facts.keys, false);
    if (facts.isNative && facts.hasExposureCameras)
        return Span{0.0, 1.0, way.at(locate(facts.keys, 0.0)), way.at(locate(facts.keys, 1.0))};
    const auto now = findCamera(facts, false);
    const auto before = findCamera(facts, true);
    const HostScales& scales = facts.convention.scales;
    if (facts.isNative || !now || !(scales.exposureShare > 0.0f))
        return std::nullopt;
    const double share = double(scales.exposureShare) / scales.displayedPerRendered;
    return Span{facts.rasterTime - 1.0 / share, facts.rasterTime, *before, *now};
}

/// A sample of a mover that has matrices.
struct MoverSample {
    dvec2 place{0.0};
    dvec3 world{0.0}; ///< at the raster instant
    dvec2 motion{0.0};
    dvec2 camera{0.0};
    size_t mover = 0;
    uint32_t row = 0;
};

/// The movers of a frame and their visible samples.
class MoverFrame {
  public:
    MoverFrame(const CheckedFrame& frame, const Span& span) : mFacts(frame.facts), mSpan(span) {
        const bool vectorsHaveCamera = mFacts.isNative || !mFacts.convention.vectors.lackCamera;
        std::unordered_map<uint32_t, size_t> movers;
        for (size_t i = 0; i < mFacts.movers.size(); ++i)
            if (mFacts.movers[i].firstMatrix != CheckFacts::kNone)
                movers[mFacts.movers[i].row] = i;
        const HostCamera raster = CameraWay(mFacts.keys, false).atKey(mFacts.rasterKey);
        const dmat4 worldFromPicture = glm::inverse(raster.pictureFromWorld(sizePx()));
        for (const CheckPoint& point : makePoints(frame, mFacts)) {
            const auto found = movers.find(point.id);
            if (point.isSky || found == movers.end())
                continue;
            const double depth = point.metres;
            const dvec4 picture(
                raster.isPerspective ? point.place * depth : point.place, depth, 1.0
            );
            samples.push_back(
                {point.place,
                 dvec3(worldFromPicture * picture),
                 vectorsHaveCamera ? point.motion : point.motion + point.camera,
                 point.camera,
                 found->second,
                 point.id}
            );
        }
    }

    [[nodiscard]] math::uvec2 sizePx() const {
        return {mFacts.picture.width, mFacts.picture.height};
    }

    /// World then from world at the raster instant, at the span's ends, by a mover's matrices.
    struct Move {
        dmat4 from{1.0};
        dmat4 to{1.0};
        double fromReach = 1.0; ///< beyond the first key, motion goes on as it is up to the next
    };

    using Change = std::function<dmat4(const dmat4&, size_t key)>;

    /// \param change of the matrices as the host gave them; empty: none
    [[nodiscard]] Move findMove(const CheckFacts::Mover& mover, const Change& change = {}) const {
        std::vector<dmat4> matrices;
        for (size_t key = 0; key < mFacts.keys.size(); ++key) {
            const dmat4& given = mFacts.matrices[mover.firstMatrix + key];
            matrices.push_back(change ? change(given, key) : given);
        }
        const MoverWay way(matrices);
        const dmat4 objectFromWorld = glm::inverse(matrices[mFacts.rasterKey]);
        Move move;
        move.from = way.at(locate(mFacts.keys, mSpan.from)) * objectFromWorld;
        move.to = way.at(locate(mFacts.keys, mSpan.to)) * objectFromWorld;
        const double first = mFacts.keys.front().time;
        if (mSpan.from < first && first < mFacts.rasterTime)
            move.fromReach = (mFacts.rasterTime - mSpan.from) / (mFacts.rasterTime - first);
        return move;
    }

    /// Where a sample's surface was at the span's beginning, and how far away; nothing: behind the
    /// camera.
    struct Place {
        dvec2 place{0.0};
        double metres = 0.0;
    };

    [[nodiscard]] std::optional<Place> see(const HostCamera& camera, const dvec3& world) const {
        const dvec4 seen = camera.pictureFromWorld(sizePx()) * dvec4(world, 1.0);
        if (!camera.isPerspective)
            return Place{dvec2(seen), seen.z};
        if (!(seen.z > 0.0))
            return std::nullopt;
        return Place{dvec2(seen) / seen.z, seen.z};
    }

    [[nodiscard]] std::optional<Place>
    findBefore(const MoverSample& sample, const Move& move) const {
        const dvec3 then(move.from * dvec4(sample.world, 1.0));
        return see(mSpan.fromCamera, sample.world + (then - sample.world) * move.fromReach);
    }

    /// Whether the sample's vector agrees with the motion.
    [[nodiscard]] Match compareVector(const MoverSample& sample, const Move& move) const {
        const auto from = findBefore(sample, move);
        const auto to = see(mSpan.toCamera, dvec3(move.to * dvec4(sample.world, 1.0)));
        if (!from || !to || !std::isfinite(from->place.x + to->place.x))
            return Match::Other;
        const double expected = glm::length(sample.motion - sample.camera);
        const double off = glm::length(to->place - from->place - sample.motion);
        return off <= kMoverTolerancePx + kMoverToleranceShare * expected ? Match::Same
                                                                          : Match::Other;
    }

    /// Compares the samples' vectors with the matrices.
    [[nodiscard]] std::vector<Match> compareVectors(const Change& change = {}) const {
        return compareEach(change, [this](const MoverSample& sample, const Move& move) {
            return compareVector(sample, move);
        });
    }

    template <class Compare>
    [[nodiscard]] std::vector<Match>
    compareEach(const Change& change, const Compare& compare) const {
        std::unordered_map<size_t, Move> moves;
        std::vector<Match> matches;
        for (const MoverSample& sample : samples) {
            const auto [move, isNew] = moves.try_emplace(sample.mover);
            if (isNew)
                move->second = findMove(mFacts.movers[sample.mover], change);
            matches.push_back(compare(sample, move->second));
        }
        return matches;
    }

    /// Whether no mover that is seen moves by its matrices.
    [[nodiscard]] bool areTheSame() const {
        return std::all_of(samples.begin(), samples.end(), [&](const MoverSample& sample) {
            const size_t first = mFacts.movers[sample.mover].firstMatrix;
            for (size_t key = 1; key < mFacts.keys.size(); ++key)
                if (mFacts.matrices[first + key] != mFacts.matrices[first])
                    return false;
            return true;
        });
    }

    [[nodiscard]] const CheckFacts& facts() const { return mFacts; }

    [[nodiscard]] const Span& span() const { return mSpan; }

    std::vector<MoverSample> samples;

  private:
    const CheckFacts& mFacts;
    Span mSpan;
};

using Matches = std::vector<Match>;

size_t count(const Matches& matches, Match one) {
    return size_t(std::count(matches.begin(), matches.end(), one));
}

/// Whether a candidate explains samples that the host's expected words do not.
bool isBetter(const Matches& declared, const Matches& candidate) {
    size_t won = 0;
    size_t lost = 0;
    for (size_t i = 0; i < declared.size(); ++i) {
        won += candidate[i] == Match::Same && declared[i] == Match::Other;
        lost += candidate[i] == Match::Other && declared[i] == Match::Same;
    }
    const size_t same = count(candidate, Match::Same);
    return won >= std::max(kMinSamples, declared.size() / 5) && won >= 4 * lost &&
           10 * same >= 6 * (same + count(candidate, Match::Other));
}

class MoverCheck {
  public:
    MoverCheck(const CheckedFrame& now, const CheckedFrame* last, const Span& span)
        : mFrame(now, span) {
        if (last && last->facts.keys.size() > 0)
            if (const auto lastSpan = findSpan(last->facts))
                mLast.emplace(*last, *lastSpan);
        if (last && !now.facts.hasVectors)
            mLastDepth.emplace(*last, last->facts);
    }

    [[nodiscard]] std::optional<std::string> findMistake() {
        if (mFrame.samples.size() < kMinSamples || (!hasVectors() && !mLastDepth))
            return std::nullopt;
        const Matches declared = judge({});
        // What stops between the frames may be static in all of the exposure, once.
        const bool areTheSame = mFrame.areTheSame() && mLast && mLast->areTheSame();
        if (areTheSame && (count(declared, Match::Other) >= share(4) || movesSinceLast()))
            return describe("the same at all keys, although the row moves in the picture: "
                            "give it at each key's time");
        if (count(declared, Match::Other) < share(4))
            return std::nullopt;
        const auto& keys = mFrame.facts().keys;
        const auto invert = [](const dmat4& given, size_t) { return glm::inverse(given); };
        const auto leaveView = [&](const dmat4& given, size_t key) {
            return glm::inverse(keys[key].viewFromWorld) * given;
        };
        const Matches inverted = judge(invert);
        const Matches inWorld = judge(leaveView);
        const bool isInView = isBetter(declared, inWorld) &&
                              count(inWorld, Match::Same) >= count(inverted, Match::Same);
        if (isInView)
            return describe("in view space, as the row's pixels show: leave viewFromWorld out of it"
            );
        if (isBetter(declared, inverted))
            return describe(
                "inverted (object from world), as the row's pixels show: give its inverse"
            );
        if (areLate())
            return describe("that of the frame before, whose vectors it explains: give this frame's"
            );
        return describeRest(declared);
    }

  private:
    [[nodiscard]] bool hasVectors() const { return mFrame.facts().hasVectors; }

    /// A part of the samples, and enough of them.
    [[nodiscard]] size_t share(size_t parts) const {
        return std::max(kMinSamples, mFrame.samples.size() / parts);
    }

    [[nodiscard]] Matches judge(const MoverFrame::Change& change) const {
        if (hasVectors())
            return mFrame.compareVectors(change);
        return mFrame.compareEach(
            change,
            [this](const MoverSample& sample, const MoverFrame::Move& move) {
                return compareLast(sample, move);
            }
        );
    }

    /// Whether the last frame shows the mover at the place implied by its motion.
    [[nodiscard]] Match compareLast(const MoverSample& sample, const MoverFrame::Move& move) const {
        const auto before = mFrame.findBefore(sample, move);
        if (!before || !std::isfinite(before->place.x + before->place.y))
            return Match::Other;
        const auto id = mLastDepth->grid().findId(before->place);
        if (!id)
            return Match::Unknown;
        return *id == sample.row ? mLastDepth->compare(before->place, before->metres)
                                 : Match::Other;
    }

    /// Whether the last frame's matrices have them elsewhere than this one's.
    [[nodiscard]] bool movesSinceLast() const {
        if (!mLast || !mFrame.facts().rowIds.empty())
            return false;
        size_t moved = 0;
        for (const MoverSample& sample : mFrame.samples) {
            const auto then = findLastMatrix(sample.row);
            if (!then)
                continue;
            const CheckFacts& facts = mFrame.facts();
            const size_t first = facts.movers[sample.mover].firstMatrix;
            const dmat4 move = *then * glm::inverse(facts.matrices[first + facts.rasterKey]);
            const HostCamera& camera = mFrame.span().toCamera;
            const auto at = mFrame.see(camera, sample.world);
            const auto was = mFrame.see(camera, dvec3(move * dvec4(sample.world, 1.0)));
            moved += at && was && glm::length(at->place - was->place) > 2.0;
        }
        return moved >= share(4);
    }

    /// Finds the matrix at the last frame's raster instant.
    [[nodiscard]] std::optional<dmat4> findLastMatrix(uint32_t row) const {
        const CheckFacts& facts = mLast->facts();
        for (const CheckFacts::Mover& mover : facts.movers)
            if (mover.row == row && mover.firstMatrix != CheckFacts::kNone)
                return facts.matrices[mover.firstMatrix + facts.rasterKey];
        return std::nullopt;
    }

    /// Whether this frame's matrices explain the last frame's vectors.
    [[nodiscard]] bool areLate() const {
        if (!mLast || !hasVectors() || !mLast->facts().hasVectors || !mFrame.facts().rowIds.empty())
            return false;
        Matches matches;
        for (const MoverSample& sample : mLast->samples) {
            const auto& movers = mFrame.facts().movers;
            const auto mover =
                std::find_if(movers.begin(), movers.end(), [&](const CheckFacts::Mover& one) {
                    return one.row == sample.row && one.firstMatrix != CheckFacts::kNone;
                });
            if (mover != movers.end())
                matches.push_back(mLast->compareVector(sample, mFrame.findMove(*mover)));
        }
        return matches.size() >= kMinSamples &&
               10 * count(matches, Match::Same) >= 8 * matches.size();
    }

    [[nodiscard]] std::string describe(const char* what) const {
        const MoverSample& sample = mFrame.samples[mFrame.samples.size() / 2];
        return fmt::format(
            "movers[{}].worldFromObject, of row {}, is {}", sample.mover, sample.row, what
        );
    }

    [[nodiscard]] std::optional<std::string> describeRest(const Matches& declared) const {
        if (declared.size() < kMinForVerdict)
            return std::nullopt;
        const auto areOff = [](const Matches& matches, size_t tenths) {
            return 10 * count(matches, Match::Other) >= tenths * matches.size();
        };
        // Acceleration causes mismatches in single frames, and fast rotation at the rim.
        const bool lasts = hasVectors() && mLast && mLast->facts().hasVectors &&
                           mLast->samples.size() >= kMinSamples &&
                           areOff(mLast->compareVectors(), 7);
        if (hasVectors() ? !lasts || !areOff(declared, 7) : !areOff(declared, 8))
            return std::nullopt;
        return fmt::format(
            "movers' worldFromObject do not agree with {} at {} of the {} samples that show "
            "them, as at row {}: see that they are world from object at each key's time, of this "
            "frame, and that ShutterBlurMover::row is the value in entityId",
            hasVectors() ? "the vectors" : "where the last frame shows them",
            describeShare(double(count(declared, Match::Other)) / double(declared.size())),
            declared.size(),
            mFrame.samples.front().row
        );
    }

    MoverFrame mFrame;
    std::optional<MoverFrame> mLast;
    std::optional<FineDepth> mLastDepth;
};

} // namespace

void checkMovers(
    const CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings
) {
    const CheckFacts& facts = now.facts;
    const bool isSameSize = last && last->facts.picture.width == facts.picture.width &&
                            last->facts.picture.height == facts.picture.height;
    if (!facts.readsMotion || !facts.hasIds || facts.matrices.empty() || facts.keys.empty())
        return;
    const auto span = findSpan(facts);
    if (!span)
        return;
    if (auto mistake = MoverCheck(now, isSameSize ? last : nullptr, *span).findMistake())
        findings.push_back({CheckKind::Movers, std::move(*mistake)});
}

} // namespace shutter::motion_blur
