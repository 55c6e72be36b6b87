// SPDX-License-Identifier: MIT
// Hard cases of particles: sparks, smoke, light alone.
#include "assets/generator/axes.h"
#include "assets/generator/hard_stage.h"
#include "assets/generator/textures.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace shutter::generator {

namespace {

using nlohmann::json;

constexpr float kDepth = 3.0f; // metres before the camera

json toArray(const vec3& v) {
    return {v.x, v.y, v.z};
}

float metresFor(float pixels) {
    return kDepth * pixels / kYardCaseShot.focalLengthPx();
}

/// Speed, m/s, that crosses as many pixels in an exposure.
float speedFor(float pixels) {
    return glm::length(kYardCaseShot.velocityFor({pixels, 0.0f}, kDepth));
}

void addEmitter(GltfWriter& writer, const char* name, vec2 pixel, const json& particles) {
    writer.addNode(
        {.name = name, .translation = kYardCaseShot.pointAt(pixel, kDepth), .particles = particles}
    );
}

/// A puff: dense in the middle, ragged, gone before the border.
Picture puff() {
    Picture picture = paint(128, 128, [](vec2 uv) {
        return vec3(0.72f + 0.2f * fractalNoise(uv * 8.0f, {8, 8}, 41));
    });
    paintAlpha(picture, [](vec2 uv) {
        const float distance = glm::length(uv - 0.5f) * 2.0f;
        const float ragged = fractalNoise(uv * 4.0f, {4, 4}, 43) - 0.5f;
        const float rim = 1.0f - glm::smoothstep(0.6f, 1.0f, distance);
        return 0.6f * rim * (1.0f - glm::smoothstep(0.1f, 0.9f, distance + 0.4f * ragged));
    });
    return picture;
}

} // namespace

GltfWriter buildSparksCase() {
    GltfWriter writer("sparks");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    addEmitter(
        writer,
        "grinder",
        {320.0f, 230.0f},
        {{"spans", {{{"fromSeconds", -10.0f}, {"perSecond", 160.0f}}}},
         {"lifeSeconds", 0.5f},
         {"lifeSpread", 0.4f},
         {"velocity", toArray(kY * speedFor(10.0f))},
         {"coneDegrees", 70.0f},
         {"speedSpread", 0.4f},
         {"gravity", {0.0f, -9.81f, 0.0f}},
         {"sizeBirth", metresFor(7.0f)},
         {"sizeDeath", metresFor(4.0f)},
         {"colors",
          {{1.0f, 0.9f, 0.55f, 1.0f}, {1.0f, 0.55f, 0.15f, 1.0f}, {0.7f, 0.15f, 0.05f, 0.6f}}},
         {"seed", 3}}
    );
    return writer;
}

GltfWriter buildSmokeCase() {
    GltfWriter writer("smoke");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    const Index texture = writer.addTexture("puff", puff());
    addEmitter(
        writer,
        "chimney",
        {180.0f, 200.0f},
        {{"spans", {{{"fromSeconds", -10.0f}, {"perSecond", 80.0f}}}},
         {"lifeSeconds", 0.5f},
         {"lifeSpread", 0.2f},
         {"velocity", toArray(kX * speedFor(16.0f))},
         {"coneDegrees", 20.0f},
         {"speedSpread", 0.25f},
         {"radius", metresFor(50.0f)},
         {"drag", 1.0f},
         {"sizeBirth", metresFor(90.0f)},
         {"sizeDeath", metresFor(180.0f)},
         {"spin", 4.0f},
         {"colors",
          {{0.9f, 0.9f, 0.95f, 0.0f}, {0.8f, 0.8f, 0.85f, 0.7f}, {0.7f, 0.7f, 0.75f, 0.0f}}},
         {"texture", texture},
         {"softMetres", 0.3f},
         {"seed", 5}}
    );
    return writer;
}

GltfWriter buildAdditiveSparksCase() {
    GltfWriter writer("additive_sparks");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    addEmitter(
        writer,
        "welder",
        {320.0f, 190.0f},
        {{"spans", {{{"fromSeconds", -10.0f}, {"perSecond", 2770.0f}}}},
         {"lifeSeconds", 0.075f},
         {"lifeSpread", 0.6f},
         {"velocity", toArray(kY * speedFor(26.0f))},
         {"coneDegrees", 80.0f},
         {"speedSpread", 0.4f},
         {"radius", metresFor(8.0f)},
         {"gravity", {0.0f, -9.81f, 0.0f}},
         {"drag", 4.0f},
         {"sizeBirth", metresFor(5.0f)},
         {"sizeDeath", metresFor(3.0f)},
         {"colors",
          {{12.0f, 9.0f, 5.0f, 1.0f}, {8.0f, 3.0f, 0.8f, 1.0f}, {1.0f, 0.2f, 0.05f, 0.5f}}},
         {"blend", "add"},
         {"seed", 7}}
    );
    return writer;
}

} // namespace shutter::generator
