// SPDX-License-Identifier: MIT
// Everything that can move a surface, on real models: motion vectors against positions rasterised
// twice, and blur against brute force as near as on a rigid mover of the same speed.
#include "engine/gltf/gltf_loader.h"
#include "engine/scene/animation.h"
#include "engine/scene/camera.h"
#include "engine/scene/deformation.h"
#include "tests/support/expected_motion.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec2;
using math::dvec3;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

struct Model {
    const char* name;
    const char* file; ///< below scenes/gltf-samples
    double seconds;   ///< of the raster instant, inside of the clip
    double exposureSeconds;
    double yaw = 0.0;      ///< of the camera round the model, radians; 0: from +Z
    dvec3 velocity{0.0};   ///< of the whole model besides its clips, m/s
    double mostLost = 1.0; ///< dB below the rigid mover
};

void PrintTo(const Model& model, std::ostream* out) {
    *out << model.name;
}

const Model kModels[] = {
    {"Skin", "CesiumMan/CesiumMan.glb", 0.6, 0.08},
    {"FastSkin", "Fox/Fox.gltf", 0.35, 0.06},
    // Legs that cross in opposite directions inside of one tile, which knows one dominant motion:
    // 3.2 and 3.6 dB below the rigid mover come from the method, more than the 1 dB allowed to
    // others.
    {"FastSkinFromItsSide", "Fox/Fox.gltf", 0.35, 0.06, 1.3, dvec3(0.0), 4.0},
    {"Morph", "MorphStressTest/MorphStressTest.glb", 0.7, 0.1},
    {"Interpolation", "InterpolationTest/InterpolationTest.glb", 1.3, 0.08},
    {"SpinningWheels", "CesiumMilkTruck/CesiumMilkTruck.glb", 0.5, 0.08, 1.3},
    // Rolls without slipping. Wheels and body move differently inside of one tile, which knows one
    // dominant motion: the error of the paper's gather there is 1.3 to 1.4 dB.
    {"RollingTruck", "CesiumMilkTruck/CesiumMilkTruck.glb", 0.5, 0.08, 1.3, {0, 0, 2.15}, 1.5},
};

constexpr uint32_t kSourceWidth = 320;
constexpr uint32_t kSourceHeight = 180;

/// Stops every clip in its pose at `seconds`.
void freeze(scene::World& world, double seconds) {
    std::vector<ecs::Entity> entities;
    for (const ecs::Entity entity : world.registry.entities())
        entities.push_back(entity);
    for (const ecs::Entity entity : entities) {
        if (auto* morph = world.registry.find<scene::MorphWeights>(entity)) {
            const auto weights = scene::deformationAt(world, entity, seconds).morphWeights;
            morph->weights.assign(weights.begin(), weights.end());
            morph->channels.clear();
        }
        if (const auto* animated = world.registry.find<scene::Animated>(entity)) {
            auto& local = world.registry.get<scene::LocalTransform>(entity);
            local.transform = scene::sampleAnimated(
                world.assets, world.playback, *animated, local.transform, seconds
            );
            world.registry.remove<scene::Animated>(entity);
        }
    }
}

/// All that is drawn slides, each entity through its own place at `seconds`.
void slide(scene::World& world, double seconds, const dvec3& metresPerSecond) {
    std::vector<ecs::Entity> roots;
    for (const ecs::Entity entity : world.registry.entities())
        if (!world.registry.has<scene::Parent>(entity) &&
            !world.registry.has<scene::Camera>(entity) && !world.registry.has<scene::Light>(entity))
            roots.push_back(entity);
    for (const ecs::Entity root : roots) {
        const auto* before = world.registry.find<scene::LinearVelocity>(root);
        const dvec3 faster = metresPerSecond - (before ? before->metresPerSecond : dvec3(0.0));
        world.registry.add(root, scene::LinearVelocity{metresPerSecond});
        if (auto* matrix = world.registry.find<scene::LocalMatrix>(root)) {
            matrix->matrix[3] -= math::dvec4(faster * seconds, 0.0);
            continue;
        }
        auto* local = world.registry.find<scene::LocalTransform>(root);
        if (!local)
            local = &world.registry.add<scene::LocalTransform>(root);
        local->transform.translation -= faster * seconds;
    }
}

class MotionSources : public test::GpuTest, public ::testing::WithParamInterface<Model> {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped())
            return;
        const auto path =
            std::filesystem::path(SHUTTER_SHARED_DIR) / "scenes/gltf-samples" / GetParam().file;
        if (!std::filesystem::exists(path))
            GTEST_SKIP() << "the scenes are not available (" << path.filename() << ")";
        auto loaded = gltf::loadGltf(path);
        ASSERT_TRUE(loaded) << loaded.error().message;
        mScene.world = std::move(loaded.value().world);
        mScene.camera = scene::addFramingCamera(
            mScene.world, double(kSourceWidth) / kSourceHeight, GetParam().seconds
        );
        walkRound(GetParam().yaw);
        slide(mScene.world, GetParam().seconds, GetParam().velocity);
        mScene.addSun({-0.3, -1.0, -0.5}, 2.0f);
    }

    void walkRound(double yaw) {
        const dvec3 centre = scene::computeWorldBounds(mScene.world, GetParam().seconds).centre();
        const math::dquat turn = glm::angleAxis(yaw, dvec3(0, 1, 0));
        math::Transform& camera =
            mScene.world.registry.get<scene::LocalTransform>(mScene.camera).transform;
        camera.translation = centre + turn * (camera.translation - centre);
        camera.rotation = turn * camera.rotation;
    }

    [[nodiscard]] static Shot makeShot(std::string_view method) {
        Shot shot;
        shot.method = method;
        shot.width = kSourceWidth;
        shot.height = kSourceHeight;
        shot.seconds = GetParam().seconds;
        shot.exposureSeconds = GetParam().exposureSeconds;
        shot.background = math::vec3(0.18f);
        shot.ambient = math::vec3(0.25f);
        shot.instants = 96;
        return shot;
    }

    [[nodiscard]] static Shot makePaperShot(std::string_view method) {
        Shot shot = makeShot(method);
        shot.settings = motion_blur::paperSettings();
        return shot;
    }

    SceneBuilder mScene;
};

/// Covered and far enough from any silhouette for the two rasterisers to mean the same surface.
bool isInside(const image::Image& motion, const test::ExpectedMotion& expected, int x, int y) {
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const auto nx = uint32_t(x + dx);
            const auto ny = uint32_t(y + dy);
            const auto& pixel = expected.at(nx, ny);
            if (!pixel || std::abs(pixel->depth / double(motion.at(nx, ny, 2)) - 1.0) > 1e-3)
                return false;
        }
    return true;
}

TEST_P(MotionSources, MotionVectorsAreDifferencesOfRasterisedPositions) {
    Shot shot = makeShot("sharp");
    shot.aovs = {"motion"};
    const auto result = test::renderOnce(device(), mScene, shot);
    const image::Image& motion = result.intermediates.at("motion");
    const auto exposure = scene::computeExposure({shot.exposureSeconds, shot.phase}, shot.seconds);
    const test::ExpectedMotion expected(
        mScene.world, mScene.camera, exposure, kSourceWidth, kSourceHeight
    );
    size_t inside = 0;
    double longest = 0.0;
    double worst = 0.0;
    for (int y = 1; y + 1 < int(kSourceHeight); ++y)
        for (int x = 1; x + 1 < int(kSourceWidth); ++x) {
            if (!isInside(motion, expected, x, y))
                continue;
            const dvec2 actual(
                motion.at(uint32_t(x), uint32_t(y), 0), motion.at(uint32_t(x), uint32_t(y), 1)
            );
            const dvec2 truth = expected.at(uint32_t(x), uint32_t(y))->motion;
            worst = std::max(worst, glm::length(actual - truth));
            longest = std::max(longest, glm::length(truth));
            ++inside;
        }
    EXPECT_GT(inside, 1200u);
    EXPECT_GT(longest, 4.0);
    EXPECT_LE(worst, 0.05);
}

/// Where a motion reaches: tiles whose neighbourhood moves.
bool isReached(const image::Image& tiles, uint32_t x, uint32_t y) {
    constexpr uint32_t kTile = 40;
    return std::hypot(tiles.at(x / kTile, y / kTile, 0), tiles.at(x / kTile, y / kTile, 1)) > 0.5;
}

/// dB over the pixels that a motion reaches.
double computeReachedPsnr(
    const image::Image& picture, const image::Image& truth, const image::Image& tiles
) {
    double sum = 0.0;
    double count = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            if (!isReached(tiles, x, y))
                continue;
            for (uint32_t c = 0; c < 3; ++c)
                sum += std::pow(double(picture.at(x, y, c)) - double(truth.at(x, y, c)), 2.0);
            count += 3.0;
        }
    return 10.0 * std::log10(count / sum);
}

/// Root mean square of the motion of covered pixels that move, px.
double measureSpeed(const image::Image& motion) {
    double sum = 0.0;
    double count = 0.0;
    for (uint32_t y = 0; y < motion.height; ++y)
        for (uint32_t x = 0; x < motion.width; ++x) {
            const double speed = std::hypot(motion.at(x, y, 0), motion.at(x, y, 1));
            if (speed < 0.5)
                continue;
            sum += speed * speed;
            count += 1.0;
        }
    return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

TEST_P(MotionSources, BlurIsAsNearToTruthAsOnARigidMoverOfTheSameSpeed) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << device().info().name << " has no ray queries";

    struct Scores {
        double speed = 0.0;
        double gather = 0.0;
        double hybrid = 0.0;
    };

    const auto measure = [&] {
        Stage stage(device(), mScene);
        Scores scores;
        const auto truth = stage.render(makeShot("accumulate"));
        Shot shot = makePaperShot("gather");
        shot.aovs = {"motion", "tiles"};
        const auto gather = stage.render(shot);
        const auto hybrid = stage.render(makePaperShot("hybrid"));
        const image::Image& tiles = gather.intermediates.at("tiles");
        scores.speed = measureSpeed(gather.intermediates.at("motion"));
        scores.gather = computeReachedPsnr(gather.color, truth.color, tiles);
        scores.hybrid = computeReachedPsnr(hybrid.color, truth.color, tiles);
        return scores;
    };
    const Scores moving = measure();
    const dvec3 right(scene::worldFromEntity(mScene.world, mScene.camera, GetParam().seconds)[0]);
    // One metre a second first: motion is proportional to it.
    freeze(mScene.world, GetParam().seconds);
    slide(mScene.world, GetParam().seconds, right);
    Shot probe = makeShot("sharp");
    probe.aovs = {"motion"};
    probe.exposureSeconds = 10.0;
    const double perMetre =
        measureSpeed(test::renderOnce(device(), mScene, probe).intermediates.at("motion")) / 10.0;
    ASSERT_GT(perMetre, 0.0);
    const double metresPerSecond = moving.speed / (perMetre * GetParam().exposureSeconds);
    slide(mScene.world, GetParam().seconds, right * metresPerSecond);
    const Scores rigid = measure();
    EXPECT_NEAR(rigid.speed, moving.speed, 0.1 * moving.speed);
    EXPECT_GE(moving.gather, rigid.gather - GetParam().mostLost);
    EXPECT_GE(moving.hybrid, rigid.hybrid - GetParam().mostLost);
}

INSTANTIATE_TEST_SUITE_P(
    OnRealModels,
    MotionSources,
    ::testing::ValuesIn(kModels),
    [](const auto& param) { return std::string(param.param.name); }
);

} // namespace
} // namespace shutter
