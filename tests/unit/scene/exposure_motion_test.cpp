// SPDX-License-Identifier: MIT
// The artist's scales: time that runs slower or faster away from the raster instant.
#include "engine/scene/exposure_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace shutter::scene {
namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;

void expectNearMatrix(const dmat4& actual, const dmat4& expected) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            EXPECT_NEAR(actual[column][row], expected[column][row], 1e-9) << column << row;
}

class Artist : public testing::Test {
  protected:
    Artist() : mCamera(addMover({0.5, 0.1, -0.3}, {0.2, 0.9, 0.1})) {
        mWorld.registry.add(mCamera, Camera{});
        // A camera's scale has no meaning and must not leak into what rides with it.
        mWorld.registry.get<LocalTransform>(mCamera).transform.scale = {2, 3, 0.5};
        mShutter.exposureSeconds = 0.5;
        mShutter.phase = ShutterPhase::Centre;
        mShutter.cuts.enabled = false;
    }

    ecs::Entity addMover(const dvec3& velocity, const dvec3& angular) {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, LocalTransform{{{1, 2, -5}, {1, 0, 0, 0}, dvec3(1.0)}});
        mWorld.registry.add(entity, LinearVelocity{velocity});
        mWorld.registry.add(entity, AngularVelocity{angular});
        return entity;
    }

    ecs::Entity addStill() {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, LocalTransform{{{0, 1, -4}, {1, 0, 0, 0}, dvec3(1.0)}});
        return entity;
    }

    [[nodiscard]] ExposureMotion motion() const {
        return {mWorld, mCamera, computeExposure(mShutter, kRaster, 1.0 / 24.0)};
    }

    [[nodiscard]] dmat4 world(ecs::Entity entity, double seconds) const {
        return scene::worldFromEntity(mWorld, entity, seconds);
    }

    [[nodiscard]] dmat4 view(double seconds) const {
        return scene::worldFromRigid(mWorld, mCamera, seconds);
    }

    static constexpr double kRaster = 3.0;
    World mWorld;
    CameraShutter mShutter;
    ecs::Entity mCamera;
};

TEST_F(Artist, ScalesOfOneChangeNoBit) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    mWorld.registry.add(mover, MotionBlur{});
    const ExposureMotion now = motion();
    for (const double s : {0.0, 0.123, 0.5, 0.77, 1.0}) {
        const double seconds = s == 0.5 ? kRaster : now.exposure().at(s);
        EXPECT_EQ(now.worldFromEntity(mover, s), world(mover, seconds));
        EXPECT_EQ(now.worldFromObject(mover, s), world(mover, seconds));
        EXPECT_EQ(now.worldFromCamera(s), view(seconds));
    }
}

TEST_F(Artist, TheCamerasTurningAndDisplacementScaleApart) {
    for (const auto& [turning, displacement] :
         {std::pair{0.0, 1.0}, {1.0, 0.0}, {0.5, 2.0}, {0.0, 0.0}}) {
        mShutter.cameraRotationScale = turning;
        mShutter.cameraTranslationScale = displacement;
        const ExposureMotion now = motion();
        for (const double s : {0.0, 0.3, 1.0}) {
            const double away = now.exposure().at(s) - kRaster;
            dmat4 expected = view(kRaster + turning * away);
            expected[3] = world(mCamera, kRaster + displacement * away)[3];
            expectNearMatrix(now.worldFromCamera(s), expected);
        }
        EXPECT_EQ(now.worldFromCamera(0.5), view(kRaster));
    }
}

TEST_F(Artist, ObjectsScaleWithoutTheCamera) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    for (const double scale : {0.0, 0.5, 2.0}) {
        mShutter.objectScale = scale;
        const ExposureMotion now = motion();
        for (const double s : {0.0, 0.3, 1.0}) {
            const double away = now.exposure().at(s) - kRaster;
            expectNearMatrix(now.worldFromEntity(mover, s), world(mover, kRaster + scale * away));
            expectNearMatrix(now.worldFromObject(mover, s), world(mover, kRaster + scale * away));
            expectNearMatrix(now.worldFromCamera(s), view(now.exposure().at(s)));
        }
        EXPECT_EQ(now.mayMove(mover), scale != 0.0);
        EXPECT_EQ(now.mayObjectMove(mover), scale != 0.0);
    }
}

TEST_F(Artist, AnEntitysScaleIsOfItsWayAcrossTheView) {
    for (const ecs::Entity entity : {addMover({1, 0, 0}, {0, 3, 0}), addStill()})
        for (const double scale : {0.0, 0.25, 1.5, 2.0}) {
            mWorld.registry.add(entity, MotionBlur{.scale = scale});
            const ExposureMotion now = motion();
            EXPECT_TRUE(now.mayObjectMove(entity)) << "under a moving camera";
            for (const double s : {0.0, 0.3, 0.5, 1.0}) {
                const double away = now.exposure().at(s) - kRaster;
                const double seen = kRaster + scale * away;
                // The same in the view as it would be at the other time.
                expectNearMatrix(
                    glm::inverse(now.worldFromCamera(s)) * now.worldFromObject(entity, s),
                    glm::inverse(view(seen)) * world(entity, seen)
                );
            }
            EXPECT_EQ(now.worldFromObject(entity, 0.5), world(entity, kRaster));
        }
}

TEST_F(Artist, ScalesMultiply) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    mWorld.registry.add(mover, MotionBlur{.scale = 0.5});
    mShutter.cameraRotationScale = 0.5;
    mShutter.cameraTranslationScale = 1.5;
    mShutter.objectScale = 0.8;
    const ExposureMotion now = motion();
    const auto camera = [&](double away) {
        dmat4 pose = view(kRaster + 0.5 * away);
        pose[3] = view(kRaster + 1.5 * away)[3];
        return pose;
    };
    for (const double s : {0.0, 0.4, 1.0}) {
        const double away = now.exposure().at(s) - kRaster;
        expectNearMatrix(
            glm::inverse(camera(away)) * now.worldFromObject(mover, s),
            glm::inverse(camera(0.5 * away)) * world(mover, kRaster + 0.8 * 0.5 * away)
        );
    }
}

TEST_F(Artist, AnExcludedEntityRidesWithTheCamera) {
    for (const ecs::Entity entity : {addMover({1, 0, 0}, {0, 3, 0}), addStill()}) {
        mWorld.registry.add(entity, MotionBlur{.scale = 2.0, .exclude = true});
        const ExposureMotion now = motion();
        EXPECT_TRUE(now.mayObjectMove(entity));
        EXPECT_FALSE(now.mayDeform(entity));
        for (const double s : {0.0, 0.3, 1.0})
            expectNearMatrix(
                glm::inverse(now.worldFromCamera(s)) * now.worldFromObject(entity, s),
                glm::inverse(view(kRaster)) * world(entity, kRaster)
            );
    }
}

TEST_F(Artist, UnderAStillCameraExcludedIsStill) {
    mWorld.registry.remove<LinearVelocity>(mCamera);
    mWorld.registry.remove<AngularVelocity>(mCamera);
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    mWorld.registry.add(mover, MotionBlur{.exclude = true});
    const ExposureMotion now = motion();
    EXPECT_FALSE(now.mayObjectMove(mover));
    EXPECT_EQ(now.worldFromObject(mover, 0.0), world(mover, kRaster));
}

TEST_F(Artist, TheNearestUpwardsCounts) {
    const ecs::Entity parent = addMover({1, 0, 0}, {0, 0, 0});
    const ecs::Entity child = addStill();
    mWorld.registry.add(child, Parent{parent});
    mWorld.registry.add(parent, MotionBlur{.exclude = true});
    const auto ridesWithTheCamera = [&] {
        const ExposureMotion now = motion();
        const dmat4 open = glm::inverse(now.worldFromCamera(0.0)) * now.worldFromObject(child, 0.0);
        const dmat4 raster = glm::inverse(view(kRaster)) * world(child, kRaster);
        return glm::length(dvec3(open[3]) - dvec3(raster[3])) < 1e-9;
    };
    EXPECT_TRUE(ridesWithTheCamera());
    mWorld.registry.add(child, MotionBlur{});
    EXPECT_FALSE(ridesWithTheCamera()) << "its own says: as ever";
}

TEST_F(Artist, LightsFollowTheObjectScaleAlone) {
    const ecs::Entity lamp = addMover({1, 0, 0}, {0, 0, 0});
    mWorld.registry.add(lamp, MotionBlur{.exclude = true});
    mShutter.objectScale = 0.5;
    const ExposureMotion now = motion();
    const double away = now.exposure().at(0.0) - kRaster;
    expectNearMatrix(now.worldFromEntity(lamp, 0.0), world(lamp, kRaster + 0.5 * away));
}

TEST_F(Artist, DeformationIsTakenAtTheScaledTime) {
    const ecs::Entity entity = addStill();
    WeightChannel channel;
    channel.targetCount = 1;
    channel.times = {0.0f, 10.0f};
    channel.values = {0.0f, 1.0f};
    AnimationClip clip;
    clip.weightChannels = {channel};
    mWorld.assets.clips.push_back(clip);
    mWorld.playback.activeClips = {true};
    mWorld.registry.add(entity, MorphWeights{{0.0f}, {{0, 0}}});
    mWorld.registry.add(entity, MotionBlur{.scale = 0.5});
    mShutter.objectScale = 0.8;
    const ExposureMotion now = motion();
    EXPECT_TRUE(now.mayDeform(entity));
    const double away = now.exposure().at(0.0) - kRaster;
    EXPECT_NEAR(
        now.deformationAt(entity, 0.0).morphWeights.at(0), (kRaster + 0.4 * away) / 10.0, 1e-7
    );
    EXPECT_NEAR(now.deformationAt(entity, 0.5).morphWeights.at(0), kRaster / 10.0, 1e-7);
    mShutter.objectScale = 0.0;
    EXPECT_FALSE(motion().mayDeform(entity));
}

TEST_F(Artist, APartOfTheExposureShowsWhatTheWholeShowsThen) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    const ecs::Entity held = addMover({2, 0, 0}, {0, 0, 0});
    teleport(mWorld, held, {}, kRaster - 0.01);
    mWorld.registry.add(mover, MotionBlur{.scale = 0.5});
    mShutter.objectScale = 0.8;
    mShutter.cameraRotationScale = 2.0;
    const ExposureMotion whole = motion();
    const ExposureInterval& exposure = whole.exposure();
    for (const auto& [from, to] : {std::pair{0.0, 0.25}, {0.25, 0.75}, {0.75, 1.0}}) {
        const ExposureMotion part(
            mWorld, mCamera, takePart(exposure, exposure.at(from), exposure.at(to))
        );
        for (const double s : {0.0, 0.3, 1.0}) {
            const double at = std::lerp(from, to, s);
            for (const ecs::Entity entity : {mover, held}) {
                expectNearMatrix(
                    part.worldFromEntity(entity, s), whole.worldFromEntity(entity, at)
                );
                expectNearMatrix(
                    part.worldFromObject(entity, s), whole.worldFromObject(entity, at)
                );
            }
            expectNearMatrix(part.worldFromCamera(s), whole.worldFromCamera(at));
        }
        EXPECT_FALSE(part.mayMove(held)) << "a frame's events are those of all its parts";
    }
}

TEST_F(Artist, AnEventThatAScaleReachesCounts) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 0, 0});
    appear(mWorld, mover, kRaster - 0.4); // open is 0.25 before the raster instant
    EXPECT_TRUE(motion().mayMove(mover));
    mShutter.objectScale = 2.0;
    EXPECT_FALSE(motion().mayMove(mover));
    mShutter.objectScale = 1.0;
    mWorld.registry.add(mover, MotionBlur{.scale = 2.0});
    EXPECT_FALSE(motion().mayMove(mover));
}

} // namespace
} // namespace shutter::scene
