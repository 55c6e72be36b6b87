// SPDX-License-Identifier: MIT
// The scenes that the game makes for itself go through the loader as any other file does.
#include "assets/generator/hard_cases.h"
#include "assets/generator/scaling_scenes.h"
#include "engine/gltf/gltf_loader.h"
#include "engine/scene/deformation.h"
#include "engine/scene/motion.h"
#include "engine/scene/shutter.h"
#include "modules/particles/particle_emitter.h"
#include "modules/particles/particle_extras.h"
#include "modules/particles/particle_tables.h"
#include "tests/support/outcomes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <utility>

namespace shutter::generator {

/// Without it the test's name would hold the bytes of a pointer.
void PrintTo(const BenchCase& hardCase, std::ostream* stream) {
    *stream << hardCase.name;
}

namespace {

namespace fs = std::filesystem;

/// Fails where the scene cannot be written or does not load without a warning.
scene::World writeAndLoad(const std::string& name, const GltfWriter& writer) {
    const fs::path folder = fs::path(SHUTTER_BUILD_DIR) / "test_scenes";
    fs::create_directories(folder);
    const fs::path path = folder / (name + ".glb");
    const std::string problem = writer.write(path);
    EXPECT_EQ(problem, "");
    gltf::LoadedScene loaded =
        test::valueOf(gltf::loadGltf(path, {}, {&particles::kParticleExtras, 1}));
    fs::remove(path);
    for (const std::string& warning : loaded.warnings)
        ADD_FAILURE() << warning;
    return std::move(loaded.world);
}

size_t countTriangles(const scene::World& world) {
    size_t triangles = 0;
    for (const auto& [entity, instance] : world.registry.view<const scene::MeshInstance>())
        for (const scene::Primitive& primitive : world.assets.meshes[instance.mesh].primitives)
            triangles += primitive.indices.size() / 3;
    return triangles;
}

const ecs::Entity* findCamera(const scene::World& world, const std::string& name) {
    const auto found =
        std::find_if(world.cameras.begin(), world.cameras.end(), [&](ecs::Entity camera) {
            return world.registry.get<scene::Camera>(camera).name == name;
        });
    return found == world.cameras.end() ? nullptr : &*found;
}

/// Entities with a mesh whose place in the camera's eyes changes between two times, or whose shape
/// may.
size_t countMovers(const scene::World& world, ecs::Entity camera, double open, double close) {
    const auto viewFrom = [&](ecs::Entity entity, double seconds) {
        return glm::inverse(scene::worldFromEntity(world, camera, seconds)) *
               scene::worldFromEntity(world, entity, seconds);
    };
    size_t movers = 0;
    for (const auto& [entity, instance] : world.registry.view<const scene::MeshInstance>()) {
        const math::dmat4 difference = viewFrom(entity, close) - viewFrom(entity, open);
        double most = 0.0;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                most = std::max(most, std::abs(difference[column][row]));
        movers += most > 1e-3 || scene::mayDeform(world, entity);
    }
    return movers;
}

/// The longest way of a particle in the picture, pixels.
float measureParticles(const scene::World& world, ecs::Entity camera, const BenchCase& hardCase) {
    scene::CameraShutter shutter;
    shutter.exposureSeconds = hardCase.exposureSeconds;
    shutter.phase = scene::ShutterPhase::End;
    extract::ViewRequest view;
    view.camera = camera;
    view.exposure = scene::computeExposure(shutter, hardCase.timeSeconds, hardCase.exposureSeconds);
    view.width = static_cast<uint32_t>(kCaseSizePx.x);
    view.height = static_cast<uint32_t>(kCaseSizePx.y);
    const auto tables = particles::extractParticles(
        world, view, extract::FrameView(world, view), particles::ParticleTime::Exposure
    );
    EXPECT_TRUE(tables.ok());
    return tables ? tables.value().longestWayPx : 0.0f;
}

/// Particles that live during the exposure, at least and at most, where a case's name promises it.
const std::map<std::string, std::pair<size_t, size_t>> kLiving = {
    {"sparks", {70, 100}}, {"smoke", {35, 50}}, {"additive_sparks", {270, 330}}};

class HardCase : public testing::TestWithParam<BenchCase> {};

TEST_P(HardCase, EachCaseLoadsWithoutAWarningAndMovesDuringItsExposure) {
    const BenchCase& hardCase = GetParam();
    const scene::World world = writeAndLoad(hardCase.name, hardCase.build());
    const ecs::Entity* camera = findCamera(world, hardCase.camera);
    ASSERT_NE(camera, nullptr);
    const double close = hardCase.timeSeconds;
    const size_t movers = countMovers(world, *camera, close - hardCase.exposureSeconds, close);
    const float wayPx = measureParticles(world, *camera, hardCase);
    EXPECT_EQ(movers == 0, hardCase.movesParticles);
    EXPECT_EQ(wayPx > 0.0f, hardCase.movesParticles);
    EXPECT_EQ(kLiving.contains(hardCase.name), hardCase.movesParticles);
    if (hardCase.movesParticles) {
        EXPECT_GE(wayPx, hardCase.peakMotionPx.x);
        EXPECT_LE(wayPx, hardCase.peakMotionPx.y);
        size_t living = 0;
        for (const auto& [entity, emitter] :
             world.registry.view<const particles::ParticleEmitter>()) {
            const double open = kCaseSeconds - 2.0 * kCaseExposureSeconds;
            living += particles::listLiving(emitter, open, kCaseSeconds).value().size();
        }
        EXPECT_GE(living, kLiving.at(hardCase.name).first);
        EXPECT_LE(living, kLiving.at(hardCase.name).second);
    }
    // Enough for a scene, few enough for a software device.
    EXPECT_GE(countTriangles(world), 5'000u);
    EXPECT_LE(countTriangles(world), 25'000u);
    EXPECT_GE(world.assets.images.size(), 3u);
}

INSTANTIATE_TEST_SUITE_P(
    Generated,
    HardCase,
    testing::ValuesIn(listHardCases().begin(), listHardCases().end()),
    [](const auto& test) { return std::string(test.param.name); }
);

/// Of a scene of an axis, over its exposure.
size_t countScalingMovers(const scene::World& world) {
    const ecs::Entity* camera = findCamera(world, kScalingCamera);
    EXPECT_NE(camera, nullptr);
    const double open = kScalingSeconds - kScalingExposureSeconds;
    return camera ? countMovers(world, *camera, open, kScalingSeconds) : 0;
}

TEST(ScalingScenes, ScenesHaveTheRequestedNumberOfMovingEntitiesWithinTheRange) {
    using Row = std::pair<int, size_t>;
    for (const auto& [requested, count] :
         {Row{-7, 1}, {2, 2}, {101, 101}, {kMaxEntityCount + 1, kMaxEntityCount}}) {
        const scene::World world =
            writeAndLoad(fmt::format("entities_{}", requested), buildEntitiesScene(requested));
        EXPECT_EQ(countScalingMovers(world), count);
        EXPECT_EQ(world.assets.meshes.size(), 2u) << "they share one mesh; the wall has another";
        EXPECT_EQ(countTriangles(world), count * 12 + 2);
    }
}

TEST(ScalingScenes, FewMoverScenesHaveTheRequestedEntitiesOrOneStaticOne) {
    for (const auto& [count, movers] :
         {std::pair{1, 0}, {1, 1}, {100, 7}, {101, 101}, {10'000, 10}})
        for (const bool merged : {false, true}) {
            const scene::World world = writeAndLoad(
                fmt::format("few_movers_{}_{}_{}", count, movers, merged),
                buildFewMoversScene(count, movers, merged)
            );
            EXPECT_EQ(countScalingMovers(world), size_t(movers));
            size_t drawn = 0;
            for (auto [entity, instance] : world.registry.view<scene::MeshInstance>())
                drawn += instance.mesh != scene::kNone;
            EXPECT_EQ(drawn, merged ? size_t(movers) + (movers < count) : size_t(count));
            if (merged) {
                EXPECT_EQ(countTriangles(world), size_t(count) * 12);
            }
        }
}

TEST(ScalingScenes, ScenesHaveTheRequestedNumberOfTrianglesWithinTheRangeAnd2Percent) {
    using Row = std::pair<int, double>;
    for (const auto& [requested, count] :
         {Row{-1, kMinTriangleCount},
          {10'000, 10'000},
          {31'623, 31'623},
          {kMaxTriangleCount * 3 / 2, kMaxTriangleCount}}) {
        const scene::World world =
            writeAndLoad(fmt::format("triangles_{}", requested), buildTrianglesScene(requested));
        EXPECT_NEAR(double(countTriangles(world)), count, 0.02 * count);
        EXPECT_EQ(countScalingMovers(world), 1u);
    }
}

TEST(ScalingScenes, ARegionOfPanelsMovesAndTheOthersAreStatic) {
    struct Row {
        int columns;
        int rows;
        int moving;
    };

    for (const Row& row :
         {Row{5, -1, 0},
          Row{-1, 4, 0},
          Row{3, 2, 6},
          Row{kPanelColumns + 1, kPanelRows + 1, kPanelColumns * kPanelRows}}) {
        const scene::World world = writeAndLoad(
            fmt::format("region_{}_{}", row.columns, row.rows),
            buildMovingRegionScene(row.columns, row.rows)
        );
        EXPECT_EQ(countTriangles(world), 2u + 2u * kPanelColumns * kPanelRows);
        EXPECT_EQ(countScalingMovers(world), size_t(row.moving));
    }
}

TEST(ScalingScenes, AShareOfNothingOrNaNHasNoPanels) {
    for (const float share : {0.0f, -0.5f, std::numeric_limits<float>::quiet_NaN()}) {
        const scene::World world = writeAndLoad("share_none", buildMovingShareScene(share));
        EXPECT_EQ(countTriangles(world), 2u) << "the wall alone";
    }
}

} // namespace
} // namespace shutter::generator
