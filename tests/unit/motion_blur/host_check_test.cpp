// SPDX-License-Identifier: MIT
// What the checker says of frames that are made in main memory: where it must say nothing because
// what looks wrong may be right, and where it must not confuse two mistakes.
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/host_check.h"
#include "shaders/motion_blur/check_grid.glsl"
#include "shaders/render/scene_shared.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace shutter::motion_blur {
namespace {

using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;

constexpr VkExtent2D kPicture{320, 180};
constexpr double kShare = 0.4; ///< exposure over the time between the frames
constexpr double kNear = 0.1;
constexpr uint32_t kWallRow = 0;
constexpr uint32_t kMoverRow = 1;

/// A floor and a wall, before which a square moves, under a camera that moves; all by functions of
/// the time in frames.
class CheckedWorld {
  public:
    virtual ~CheckedWorld() = default;

    [[nodiscard]] virtual dvec3 cameraAt(double frames) const { return {0.25 * frames, 0.0, 0.0}; }

    [[nodiscard]] virtual dvec3 moverAt(double frames) const {
        return {0.5 * frames - 1.0, 0.0, -5.0};
    }

    [[nodiscard]] dmat4 viewAt(double frames) const {
        return glm::translate(dmat4(1.0), -cameraAt(frames));
    }

    [[nodiscard]] dmat4 placeAt(double frames) const {
        return glm::translate(dmat4(1.0), moverAt(frames));
    }

    [[nodiscard]] static dmat4 projection() {
        return math::clipFromViewPerspective(0.8, double(kPicture.width) / kPicture.height, kNear);
    }

    /// The recording of a frame: two keys in the exposure, a mover with matrices, vectors.
    [[nodiscard]] std::unique_ptr<CheckedFrame> draw(double frames) const {
        auto frame = std::make_unique<CheckedFrame>();
        CheckFacts& facts = frame->facts;
        facts.picture = kPicture;
        facts.convention.scales.exposureShare = float(kShare);
        facts.convention.cameras = {
            true, viewAt(frames), projection(), viewAt(frames - 1.0), projection()};
        facts.hasIds = facts.readsMotion = facts.wantsHistory = facts.followsLast = true;
        facts.rowCount = 2;
        for (const double time : {0.0, 1.0}) {
            const double at = frames - (1.0 - time) * kShare;
            facts.keys.push_back({time, viewAt(at), projection()});
            facts.matrices.push_back(placeAt(at));
        }
        facts.rasterKey = 1;
        CheckFacts::Mover mover;
        mover.row = kMoverRow;
        mover.firstMatrix = 0;
        facts.movers.push_back(mover);
        fill(*frame, frames);
        return frame;
    }

  private:
    struct Hit {
        uint32_t row = kWallRow;
        double metres = 0.0;
        dvec2 motion{0.0};
    };

    [[nodiscard]] static dvec2 see(const dmat4& view, const dvec3& world) {
        const dvec4 clip = projection() * view * dvec4(world, 1.0);
        return (dvec2(clip) / clip.w * 0.5 + 0.5) * dvec2(kPicture.width, kPicture.height);
    }

    [[nodiscard]] Hit trace(const dvec2& place, double frames) const {
        const dvec2 ndc = place / dvec2(kPicture.width, kPicture.height) * 2.0 - 1.0;
        const dmat4 clip = projection();
        const dvec3 ray(ndc.x / clip[0].x, ndc.y / clip[1].y, -1.0);
        const dvec3 eye = cameraAt(frames);
        Hit hit;
        hit.metres = 20.0 + eye.z; // the wall
        if (ray.y < 0.0)           // the floor
            hit.metres = std::min(hit.metres, (-2.0 - eye.y) / ray.y);
        const double toMover = eye.z - moverAt(frames).z;
        const dvec3 onMover = eye + ray * toMover - moverAt(frames);
        if (std::abs(onMover.x) < 0.8 && std::abs(onMover.y) < 0.8 && toMover < hit.metres) {
            hit.row = kMoverRow;
            hit.metres = toMover;
        }
        const dvec3 world = eye + ray * hit.metres;
        const dvec3 then =
            hit.row == kMoverRow ? world - moverAt(frames) + moverAt(frames - 1.0) : world;
        hit.motion = place - see(viewAt(frames - 1.0), then);
        return hit;
    }

    void fill(CheckedFrame& frame, double frames) const {
        const glm::uvec2 size(kPicture.width, kPicture.height);
        shader::CheckTotals& totals = frame.totals;
        totals.depthLeast = std::bit_cast<uint32_t>(1.0e-3f);
        totals.depthMost = std::bit_cast<uint32_t>(1.0f);
        for (uint32_t i = 0; i < shader::kCheckSamples; ++i) {
            const glm::uvec2 cell(i % shader::kCheckAcross, i / shader::kCheckAcross);
            const Hit hit = trace(dvec2(shader::checkedPixel(cell, size)) + 0.5, frames);
            totals.samples[i] = {glm::vec2(hit.motion), float(kNear / hit.metres), hit.row};
            totals.seenRows[0] |= 1u << hit.row;
        }
        const glm::uvec2 fine = shader::fineGrid(size);
        for (uint32_t i = 0; i < fine.x * fine.y; ++i) {
            const glm::uvec2 pixel = shader::finePixel({i % fine.x, i / fine.x}, size);
            const Hit hit = trace(dvec2(pixel) + 0.5, frames);
            totals.fineDepths[i] = float(kNear / hit.metres);
            totals.fineIds[i] = hit.row;
        }
    }
};

using Change = void (*)(CheckFacts&, const CheckedWorld&, double frames);

/// All that is said of three frames.
std::string check(const CheckedWorld& world, Change change = nullptr) {
    std::string all;
    std::unique_ptr<CheckedFrame> last;
    for (int frame = 0; frame < 3; ++frame) {
        auto now = world.draw(frame);
        if (change)
            change(now->facts, world, frame);
        for (const Finding& finding : checkFrame(*now, last.get()))
            all += finding.sentence + "\n";
        last = std::move(now);
    }
    return all;
}

void leaveVectorsOut(CheckFacts& facts, const CheckedWorld&, double) {
    facts.hasVectors = false;
}

TEST(HostCheck, SaysNothingOfAWorldThatMovesEvenly) {
    EXPECT_EQ(check(CheckedWorld()), "");
    EXPECT_EQ(check(CheckedWorld(), leaveVectorsOut), "");
}

/// All moves by the square of the time, from rest in the first frame.
struct Starting : CheckedWorld {
    static double squareOf(double frames) { return frames < 0.0 ? 0.0 : frames * frames; }

    [[nodiscard]] dvec3 cameraAt(double frames) const override {
        return {0.3 * squareOf(frames), 0.0, 0.0};
    }

    [[nodiscard]] dvec3 moverAt(double frames) const override {
        return {0.4 * squareOf(frames) - 1.0, 0.0, -5.0};
    }
};

TEST(HostCheck, SaysNothingOfWhatSpeedsUpFromRest) {
    EXPECT_EQ(check(Starting()), "");
    EXPECT_EQ(check(Starting(), leaveVectorsOut), "");
}

/// All stops in the last frame, just before its shutter opens.
struct Stopping : CheckedWorld {
    [[nodiscard]] dvec3 cameraAt(double frames) const override {
        return CheckedWorld::cameraAt(std::min(frames, 1.59));
    }

    [[nodiscard]] dvec3 moverAt(double frames) const override {
        return CheckedWorld::moverAt(std::min(frames, 1.59));
    }
};

TEST(HostCheck, SaysNothingOfWhatStopsBeforeTheShutterOpens) {
    EXPECT_EQ(check(Stopping()), "");
    EXPECT_EQ(check(Stopping(), leaveVectorsOut), "");
}

/// Turns back in each frame.
struct Shaking : CheckedWorld {
    [[nodiscard]] dvec3 cameraAt(double frames) const override {
        return {0.3 * std::sin(2.2 * frames), 0.0, 0.0};
    }
};

TEST(HostCheck, SaysNothingOfACameraThatShakes) {
    EXPECT_EQ(check(Shaking()), "");
}

TEST(HostCheck, MatricesThatAreTheSameAreNamedWhereTheMoverMoves) {
    const Change change = [](CheckFacts& facts, const CheckedWorld&, double) {
        facts.matrices[0] = facts.matrices[1];
    };
    EXPECT_NE(check(CheckedWorld(), change).find("the same at all motion.keys"), std::string::npos);
}

TEST(HostCheck, AMoverBehindAWallIsInNobodysView) {
    const Change behind = [](CheckFacts& facts, const CheckedWorld&, double) {
        facts.rowCount = 3; // the picture does not show the last of them
        facts.movers.front() = {2, true, {160.0, 40.0}, 40.0, CheckFacts::kNone};
    };
    EXPECT_EQ(check(CheckedWorld(), behind).find("shows none of"), std::string::npos);
    const Change before = [](CheckFacts& facts, const CheckedWorld&, double) {
        facts.rowCount = 3;
        facts.movers.front() = {2, true, {160.0, 40.0}, 20.5, CheckFacts::kNone};
    };
    EXPECT_NE(check(CheckedWorld(), before).find("shows none of"), std::string::npos);
}

TEST(HostCheck, OnePixelHasOneDepth) {
    CheckedFrame frame;
    frame.facts.picture = {1, 1};
    frame.totals.depthLeast = frame.totals.depthMost = std::bit_cast<uint32_t>(0.5f);
    std::vector<Finding> findings;
    checkTotals(frame, findings);
    EXPECT_FALSE(hasFound(findings, {CheckKind::DepthEqual}));
    frame.facts.picture = {64, 64};
    checkTotals(frame, findings);
    EXPECT_TRUE(hasFound(findings, {CheckKind::DepthEqual}));
}

TEST(HostCheck, SharesAreRoundedAsPeopleWriteThem) {
    EXPECT_EQ(describeShare(1.0), "100 %");
    EXPECT_EQ(describeShare(0.999), "100 %");
    EXPECT_EQ(describeShare(0.4512), "45 %");
    EXPECT_EQ(describeShare(0.0996), "10 %");
    EXPECT_EQ(describeShare(0.0321), "3.2 %");
    EXPECT_EQ(describeShare(0.00012), "0.012 %");
    EXPECT_EQ(describeShare(0.0), "0 %");
}

} // namespace
} // namespace shutter::motion_blur
