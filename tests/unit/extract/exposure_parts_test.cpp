// SPDX-License-Identifier: MIT
// How an exposure is cut where something jumps, and how many parts motion within it takes.
#include "engine/extract/exposure_parts.h"
#include "engine/extract/frame_view.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace shutter::extract {
namespace {

using scene::Interpolation;

/// The exposure runs from 1 s to 2 s, and the raster instant is its end.
class ExposureParts : public Extraction {
  protected:
    ExposureParts() {
        mShutter.exposureSeconds = 1.0;
        mShutter.cuts.enabled = false;
        mBox = addBox({0.0, 0.0, -10.0});
    }

    /// Scales by 0 and 1 in turns.
    void blink(ecs::Entity entity, std::vector<float> times) {
        std::vector<float> factors;
        for (size_t i = 0; i < times.size(); ++i)
            factors.push_back(float(i % 2));
        animateScale(entity, std::move(times), factors, Interpolation::Step);
    }

    std::vector<ExposurePart> plan() {
        request.exposure = scene::computeExposure(mShutter, mRaster, 1.0 / 24.0);
        return planExposureParts(world, layout, request);
    }

    scene::ExposureMotion motionIn(const ExposurePart& part) const {
        return {world, camera, part.exposure};
    }

    /// The parts in their order, and which of them is the last one.
    static void expectParts(
        const std::vector<ExposurePart>& parts,
        const std::vector<std::pair<double, double>>& times,
        const std::vector<double>& shares
    ) {
        ASSERT_EQ(parts.size(), times.size());
        for (size_t i = 0; i < parts.size(); ++i) {
            EXPECT_NEAR(parts[i].exposure.open, times[i].first, 1e-9) << i;
            EXPECT_NEAR(parts[i].exposure.close, times[i].second, 1e-9) << i;
            EXPECT_NEAR(parts[i].share, shares[i], 1e-6) << i;
        }
    }

    scene::CameraShutter mShutter;
    double mRaster = 2.0;
    ecs::Entity mBox;
};

TEST_F(ExposureParts, AnExposureWithoutJumpsIsNotSplit) {
    EXPECT_TRUE(plan().empty());
    world.registry.add(mBox, scene::LinearVelocity{{100.0, 0.0, 0.0}});
    EXPECT_TRUE(plan().empty()) << "however fast it goes";
    world.playback.loop = true;
    animateX(addBox({0.0, 0.0, -10.0}), {0.0f, 0.35f, 0.7f}, {0.0f, 2.0f, 0.0f});
    EXPECT_TRUE(plan().empty()) << "a closed loop";
    world.playback.loop = false;
    animateScale(addBox({0, 0, -9}), {1.0f, 1.5f}, {0.0f, 1.0f});
    EXPECT_TRUE(plan().empty()) << "what grows goes a way";
    std::vector<float> times;
    std::vector<float> metres;
    for (int i = 0; i <= 40; ++i) {
        times.push_back(1.0f + float(i) / 40.0f);
        metres.push_back(3.0f * std::sin(0.2f * float(i)));
    }
    animateX(addBox({0.0, 0.0, -10.0}), times, metres);
    EXPECT_TRUE(plan().empty()) << "dense keys of a smooth motion";
}

TEST_F(ExposureParts, AnAppearanceSplitsByItsShareOfTheLight) {
    blink(mBox, {0.0f, 1.25f});
    expectParts(plan(), {{1.0, 1.25}, {1.25, 2.0}}, {0.25, 0.75});
    // A triangle takes 2 (1/4)^2 of its light in its first quarter.
    mShutter.response.shape = scene::ResponseShape::Triangle;
    expectParts(plan(), {{1.0, 1.25}, {1.25, 2.0}}, {0.125, 0.875});
    request.instant = 0.5;
    EXPECT_TRUE(plan().empty()) << "an instant has no parts";
}

TEST_F(ExposureParts, TheLastPartHoldsTheRasterInstantOrIsTheNearest) {
    blink(mBox, {0.0f, 1.25f, 1.75f});
    auto parts = plan();
    expectParts(parts, {{1.0, 1.25}, {1.25, 1.75}, {1.75, 2.0}}, {0.25, 0.5, 0.25});
    EXPECT_EQ(parts[2].exposure.rasterTime, 1.0);
    EXPECT_EQ(parts[2].exposure.raster, 2.0);
    EXPECT_EQ(parts[0].exposure.rasterTime, 1.0) << "as near to the frame's instant as it is";
    mShutter.phase = scene::ShutterPhase::Start;
    mRaster = 1.0;
    parts = plan();
    expectParts(parts, {{1.25, 1.75}, {1.75, 2.0}, {1.0, 1.25}}, {0.5, 0.25, 0.25});
    EXPECT_EQ(parts[2].exposure.rasterTime, 0.0);
    mShutter.phase = scene::ShutterPhase::Centre;
    mRaster = 1.5;
    parts = plan();
    expectParts(parts, {{1.0, 1.25}, {1.75, 2.0}, {1.25, 1.75}}, {0.25, 0.25, 0.5});
    EXPECT_NEAR(parts[2].exposure.rasterTime, 0.5, 1e-9);
}

TEST_F(ExposureParts, AStepAtAnEndOfTheExposureLeavesOnePartThatDoesNotReachIt) {
    blink(mBox, {0.0f, 2.0f});
    auto parts = plan();
    expectParts(parts, {{1.0, 2.0}}, {1.0});
    for (const double s : {0.0, 0.5, 1.0})
        EXPECT_EQ(motionIn(parts[0]).worldFromObject(mBox, s)[0].x, 0.0) << "it has not come yet";
    mRaster = 3.0;
    EXPECT_LE(plan().size(), 1u) << "it was there all the time";
    for (const ExposurePart& part : plan())
        EXPECT_EQ(motionIn(part).worldFromObject(mBox, 0.0)[0].x, 1.0);
}

TEST_F(ExposureParts, NoPartHasAnEntityBetweenItsPlaces) {
    // Children of an entity that steps, a loop that restarts, keys at nearly the same time.
    const ecs::Entity parent = world.registry.create();
    world.registry.add(parent, scene::LocalTransform{});
    world.registry.add(mBox, scene::Parent{parent});
    world.playback.loop = true;
    animateX(parent, {0.0f, 0.3f, 0.6f}, {-2.0f, 2.0f, -2.0f}, Interpolation::Step);
    const auto parts = plan();
    ASSERT_GE(parts.size(), 3u);
    double light = 0.0;
    for (const ExposurePart& part : parts) {
        light += part.share;
        const scene::ExposureMotion motion = motionIn(part);
        const double x = motion.worldFromObject(mBox, 0.5)[3].x;
        EXPECT_EQ(std::abs(x), 2.0);
        EXPECT_EQ(motion.worldFromObject(mBox, 0.0)[3].x, x);
        EXPECT_EQ(motion.worldFromObject(mBox, 1.0)[3].x, x);
    }
    EXPECT_NEAR(light, 1.0, 1e-12);
}

TEST_F(ExposureParts, KeysAtNearlyTheSameTimeAreAPartOfTheirOwn) {
    animateX(mBox, {1.0f, 1.5f, 1.5625f, 2.0f}, {0.0f, 0.0f, 3.0f, 3.0f});
    expectParts(plan(), {{1.0, 1.5}, {1.5, 1.5625}, {1.5625, 2.0}}, {0.5, 0.0625, 0.4375});
}

TEST_F(ExposureParts, InvisibleJumpsAndThoseOfEntitiesWithoutAPastAreIgnored) {
    const ecs::Entity outside = addBox({0.0, 0.0, 10.0});
    blink(outside, {0.0f, 1.25f});
    EXPECT_TRUE(plan().empty()) << "behind the camera";
    request.unseenMatters = true;
    EXPECT_EQ(plan().size(), 2u) << "it may cast a shadow into the picture";
    request.unseenMatters = false;
    const ecs::Entity hidden = addBox({0.0, 0.0, -8.0});
    blink(hidden, {0.0f, 1.25f});
    scene::hide(world, hidden);
    EXPECT_TRUE(plan().empty());
    animateX(mBox, {0.0f, 1.5f}, {0.0f, 0.01f}, Interpolation::Step, 10.0f);
    EXPECT_TRUE(plan().empty()) << "an eighth of a pixel";
    blink(mBox, {0.0f, 1.25f});
    EXPECT_EQ(plan().size(), 2u);
    scene::teleport(world, mBox, {.translation = {0, 0, -10}}, 1.5);
    EXPECT_TRUE(plan().empty()) << "entities without a past do not move";
}

TEST_F(ExposureParts, EntitiesShownOrHiddenByAGameAreInTheRightParts) {
    const auto isThereIn = [&](const ExposurePart& part) {
        const scene::ExposureMotion motion = motionIn(part);
        const bool atOpen = isDrawable(motion.worldFromObject(mBox, 0.0));
        EXPECT_EQ(isDrawable(motion.worldFromObject(mBox, 1.0)), atOpen);
        EXPECT_FALSE(motion.mayObjectMove(mBox)) << "nothing comes within a part";
        return atOpen && !motion.isHidden(mBox);
    };
    scene::appear(world, mBox, 1.25);
    auto parts = plan();
    expectParts(parts, {{1.0, 1.25}, {1.25, 2.0}}, {0.25, 0.75});
    EXPECT_FALSE(isThereIn(parts[0]));
    EXPECT_TRUE(isThereIn(parts[1]));
    scene::hide(world, mBox, 1.5);
    parts = plan();
    expectParts(parts, {{1.0, 1.25}, {1.25, 1.5}, {1.5, 2.0}}, {0.25, 0.25, 0.5});
    EXPECT_FALSE(isThereIn(parts[0]));
    EXPECT_TRUE(isThereIn(parts[1]));
    EXPECT_FALSE(isThereIn(parts[2]));
    scene::hide(world, mBox);
    EXPECT_TRUE(plan().empty()) << "hidden at all times";
}

TEST_F(ExposureParts, EntitiesAppearingAtTheFrameTimeAreVisibleForTheWholeExposure) {
    scene::appear(world, mBox, 2.0);
    EXPECT_TRUE(plan().empty());
    blink(addBox({1.0, 0.0, -9.0}), {0.0f, 1.5f});
    const auto parts = plan();
    ASSERT_EQ(parts.size(), 2u);
    for (const ExposurePart& part : parts)
        EXPECT_TRUE(isDrawable(motionIn(part).worldFromObject(mBox, 0.0)));
}

TEST_F(ExposureParts, EntitiesHiddenAtTheFrameTimeAreVisibleUntilThen) {
    scene::hide(world, mBox, 2.0);
    const auto parts = plan();
    expectParts(parts, {{1.0, 2.0}}, {1.0});
    EXPECT_TRUE(isDrawable(motionIn(parts.at(0)).worldFromObject(mBox, 1.0)));
    mRaster = 3.0;
    EXPECT_TRUE(plan().empty()) << "hidden all the time";
}

TEST_F(ExposureParts, ACameraThatStepsIsCutIntoPartsUnlessItIsACut) {
    animateX(camera, {0.0f, 1.5f}, {0.0f, 0.1f}, Interpolation::Step);
    expectParts(plan(), {{1.0, 1.5}, {1.5, 2.0}}, {0.5, 0.5});
    mShutter.cuts = {.enabled = true, .degrees = 10.0, .metres = 0.05};
    EXPECT_TRUE(plan().empty()) << "nothing moves in the frame of a cut";
}

TEST_F(ExposureParts, ScalesOfTheBlurPlaceJumpsWhereTheyAreSeen) {
    // At half its speed, what steps a quarter of the exposure before the raster instant is seen to
    // do so half of it before.
    mShutter.objectScale = 0.5;
    blink(mBox, {0.0f, 1.75f});
    const auto parts = plan();
    expectParts(parts, {{1.0, 1.5}, {1.5, 2.0}}, {0.5, 0.5});
    for (const ExposurePart& part : parts) {
        const scene::ExposureMotion motion = motionIn(part);
        EXPECT_EQ(motion.worldFromObject(mBox, 0.0)[0].x, motion.worldFromObject(mBox, 1.0)[0].x);
    }
    mShutter.objectScale = 0.0;
    EXPECT_TRUE(plan().empty());
}

TEST_F(ExposureParts, TheShortestPartsOfManyJumpsAreJoined) {
    std::vector<float> times{0.0f};
    for (int i = 1; i < 40; ++i)
        times.push_back(1.0f + float(i) / 40.0f);
    blink(mBox, std::move(times));
    const auto parts = plan();
    ASSERT_EQ(parts.size(), kMaxExposureParts);
    double light = 0.0;
    for (const ExposurePart& part : parts) {
        EXPECT_LT(part.share, 0.35);
        light += part.share;
    }
    EXPECT_NEAR(light, 1.0, 1e-12);
}

constexpr double kTurn = 2.0 * std::numbers::pi;

class MotionPartsTest : public Extraction {
  protected:
    MotionParts plan() { return planMotionParts(world, layout, extract(), request); }
};

TEST_F(MotionPartsTest, PartsFollowHowFarAMotionIsFromStraight) {
    const ecs::Entity box = addBox({0.0, 0.0, -5.0});
    EXPECT_EQ(plan().count, 0u) << "nothing moves";
    world.registry.add(box, scene::LinearVelocity{{1.0, 0.5, 0.0}});
    EXPECT_EQ(plan().count, 1u) << "a straight way";
    request.exposure = {1.0, 1.0, 1.0, 1.0};
    EXPECT_EQ(plan().count, 0u) << "no exposure";
    // At open, raster and close the box is where it was.
    request.exposure = {0.0, 1.0, 1.0, 1.0};
    world.registry.remove<scene::LinearVelocity>(box);
    world.registry.add(box, scene::AngularVelocity{{0.0, kTurn, 0.0}});
    const uint32_t parts = plan().count;
    EXPECT_GE(parts, 4u); // a quarter's chord is 0.9003 of its arc
    EXPECT_LE(parts, 8u);
    world.registry.add(box, scene::AngularVelocity{{0.0, 4 * kTurn, 0.0}});
    EXPECT_GE(plan().count, 16u);
    EXPECT_LE(plan().count, kMaxMotionParts);
    world.registry.remove<scene::AngularVelocity>(box);
    world.registry.add(camera, scene::AngularVelocity{{0.0, kTurn, 0.0}});
    EXPECT_GE(plan().count, 4u) << "a camera that turns once is not at rest either";
}

TEST_F(MotionPartsTest, AMoverBesideThePictureCountsWhereTheUnseenMatters) {
    // Behind the camera, by 5 m; at the raster instant it has moved by 1 m.
    addMover({0.0, 0.0, 5.0}, {1.0, 0.0, 0.0});
    EXPECT_EQ(plan().unseenPx, 0.0);
    request.unseenMatters = true;
    const double pixel = double{extract().constants.pixelFootprint.x} * std::hypot(5.0, 1.0);
    EXPECT_NEAR(plan().unseenPx, 1.0 / pixel, 1.0e-6 / pixel);
    request.unlit = true;
    EXPECT_EQ(plan().unseenPx, 0.0);
}

TEST_F(MotionPartsTest, AMovingLightIsReportedUnlessThePictureIsUnlit) {
    const ecs::Entity light = world.registry.create();
    world.registry.add(light, scene::LocalTransform{});
    world.registry.add(light, scene::Light{});
    EXPECT_FALSE(plan().movesLight);
    world.registry.add(light, scene::LinearVelocity{{1.0, 0.0, 0.0}});
    EXPECT_TRUE(plan().movesLight);
    request.unlit = true;
    EXPECT_FALSE(plan().movesLight);
}

} // namespace
} // namespace shutter::extract
