// SPDX-License-Identifier: MIT
// EXT_lights_image_based.
#include "engine/environment/irradiance.h"
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shutter::gltf {

namespace {

// A 1x1 RGBA PNG of (200, 100, 50, 128).
constexpr const char* kPicture = R"({"uri":"data:image/png;base64,)"
                                 "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAA"
                                 R"(DUlEQVR4nGM4kWLUAAAFNQHfc2Lj2wAAAABJRU5ErkJggg=="})";

std::string sceneWith(const std::string& light) {
    return R"("images":[)" + std::string(kPicture) +
           R"(],"extensionsUsed":["EXT_lights_image_based"],)"
           R"("extensions":{"EXT_lights_image_based":{"lights":[)" +
           light + R"(]}},"scenes":[{"extensions":{"EXT_lights_image_based":{"light":0}}}])";
}

constexpr const char* kSides = R"("specularImages":[[0,0,0,0,0,0]])";

double linear(double encoded) {
    return std::pow((encoded / 255.0 + 0.055) / 1.055, 2.4);
}

TEST(GltfEnvironment, IsReadWithItsRotationAndIntensity) {
    const LoadedScene scene = expectLoads(loadMembers(sceneWith(
        "{" + std::string(kSides) + R"(,"intensity":2,"rotation":[0,0.70710678,0,0.70710678]})"
    )));
    ASSERT_TRUE(scene.world.assets.environment.has_value());
    const scene::Environment& environment = *scene.world.assets.environment;
    const math::vec3 seen = environment::evaluateIrradiance(environment.irradiance, {0, 1, 0});
    // RGBD: twice as bright as its colours, and twice that by the intensity.
    EXPECT_NEAR(seen.x, linear(200) * 255.0 / 128.0 * 2.0, 1e-2);
    EXPECT_NEAR(seen.y, linear(100) * 255.0 / 128.0 * 2.0, 1e-2);
    // Turned by 90 degrees about +Y: what the map has ahead is seen on the left.
    const math::vec3 looked = environment.mapFromWorld * math::vec3(-1, 0, 0);
    EXPECT_LT(glm::distance(looked, math::vec3(0, 0, -1)), 1e-5f);
}

TEST(GltfEnvironment, ASceneThatNamesNoneHasNone) {
    const LoadedScene scene = expectLoads(loadMembers(R"("scenes":[{}])"));
    EXPECT_FALSE(scene.world.assets.environment.has_value());
}

TEST(GltfEnvironment, IsRefusedWithTheField) {
    const auto expectField = [](const std::string& light, const std::string& field) {
        const auto loaded = loadMembers(sceneWith(light));
        ASSERT_FALSE(loaded) << light;
        EXPECT_NE(loaded.error().message.find(field), std::string::npos) << loaded.error().message;
    };
    expectField(R"({"name":"none"})", "EXT_lights_image_based.lights[0].specularImages is missing");
    expectField("7", "EXT_lights_image_based.lights");
    expectField(R"({"specularImages":7})", "specularImages");
    expectField(R"({"specularImages":[]})", "EXT_lights_image_based.lights");
    expectField(
        R"({"specularImages":[[0,0,0]]})",
        "specularImages[0] is not an array of at least 6 elements"
    );
    expectField(R"({"specularImages":[[0,0,0,0,0,9]]})", "specularImages[0][5]");
    expectField(R"({"specularImages":[[0,0,0,0,0,0.5]]})", "specularImages[0][5]");
    expectField(R"({"specularImages":[[0,0,0,0,0,-1]]})", "specularImages[0][5]");
    const std::string sides = "{" + std::string(kSides);
    expectField(sides + R"(,"rotation":[0,0,0,0]})", "rotation is no rotation");
    expectField(sides + R"(,"rotation":[0,0]})", "rotation is not an array");
    expectField(sides + R"(,"rotation":[0,"a",0,1]})", "rotation is no rotation");
    expectField(sides + R"(,"intensity":-1})", "intensity of -1");
    expectField(sides + R"(,"intensity":"a"})", "intensity");
    const auto outside =
        loadMembers(R"("extensions":{"EXT_lights_image_based":{"lights":[]}},)"
                    R"("scenes":[{"extensions":{"EXT_lights_image_based":{"light":0}}}])");
    EXPECT_FALSE(outside);
    const auto none = loadMembers(R"("scenes":[{"extensions":{"EXT_lights_image_based":{}}}])");
    EXPECT_FALSE(none);
}

} // namespace
} // namespace shutter::gltf
