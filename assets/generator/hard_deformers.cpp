// SPDX-License-Identifier: MIT
// Hard cases of what deforms: characters, cloth, a whip.
#include "assets/generator/axes.h"
#include "assets/generator/demo_scenes.h"
#include "assets/generator/figure.h"
#include "assets/generator/hard_stage.h"
#include "assets/generator/textures.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace shutter::generator {

namespace {

constexpr auto kSeconds = static_cast<float>(kCaseSeconds);

Index addCaseFigureMesh(GltfWriter& writer) {
    return addFigureMesh(writer, "person", {0.75f, 0.25f, 0.15f}, {0.25f, 0.32f, 0.55f});
}

/// A person that crosses the picture to the right with its feet on the ground.
Figure addCrossingFigure(
    GltfWriter& writer,
    const Shot& shot,
    float pixel,
    float depth,
    float metresPerSecond,
    const Gait& gait
) {
    vec3 place = shot.pointAt({pixel, kCaseSizePx.y / 2.0f}, depth);
    place.y = 0.0f;
    const Index walker = writer.addNode(
        {.name = "walker",
         .translation = startFor(place, kX * metresPerSecond),
         .linearVelocity = kX * metresPerSecond}
    );
    const Figure figure = addFigure(
        writer,
        addCaseFigureMesh(writer),
        {.name = "person", .parent = walker, .rotation = turned(glm::half_pi<float>(), kY)}
    );
    addGait(writer, writer.addClip("gait"), figure, gait, 0.0f, 2.0f * kSeconds);
    return figure;
}

} // namespace

GltfWriter buildWalkingFigureCase() {
    GltfWriter writer("walking_figure");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    (void)addCrossingFigure(
        writer, kYardCaseShot, 330.0f, 4.0f, 2.4f, {.strideSeconds = 0.9f, .phase = 0.9f}
    );
    return writer;
}

GltfWriter buildRunningFigureCase() {
    constexpr float kPanPx = 14.0f;
    constexpr float kDepth = 4.0f;
    GltfWriter writer("running_figure_pan");
    addPanningCamera(writer, kYardCaseShot, kPanPx);
    addYardStage(writer);
    Gait gait = makeRun();
    gait.phase = 0.4f;
    const float speed = glm::length(kYardCaseShot.velocityFor({kPanPx, 0.0f}, kDepth));
    (void)addCrossingFigure(writer, kYardCaseShot, 320.0f, kDepth, speed, gait);
    return writer;
}

GltfWriter buildMorphCase() {
    constexpr float kRadius = 0.42f;
    GltfWriter writer("morphing_ball");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    MeshPart part{
        .shape = sphere(kRadius, 64, 40),
        .material = addTextured(writer, "chevrons", chevrons(), 0.7f)};
    std::vector<vec3>& spikes = part.targets.emplace_back();
    for (const vec3& position : part.shape.positions) {
        const vec3 direction = position / kRadius;
        const float spike =
            std::sin(7.0f * std::atan2(direction.y, direction.x)) * std::cos(5.0f * direction.z);
        spikes.push_back(direction * (0.22f * spike * std::abs(spike) + 0.10f));
    }
    const Index ball = writer.addNode(
        {.name = "ball",
         .translation = kYardCaseShot.pointAt({320.0f, 165.0f}, 2.8f),
         .mesh = writer.addMesh("ball", {&part, 1})}
    );
    // From 0 to 1 in an exposure, halfway at the case's time.
    const float half = kSeconds / kExposureSeconds;
    const std::array times = {0.0f, 2.0f * kSeconds};
    const std::array weights = {0.5f - half, 0.5f + half};
    writer.addWeights(writer.addClip("spikes"), ball, times, weights);
    return writer;
}

GltfWriter buildFlagCase() {
    constexpr vec2 kHalf{0.9f, 0.55f};
    GltfWriter writer("waving_flag");
    addStillCamera(writer, kYardCaseShot);
    const CourtyardSurfaces surfaces = addYardStage(writer);
    const vec3 middle = kYardCaseShot.pointAt({335.0f, 120.0f}, 3.0f);
    const MeshPart part{
        .shape = cloth(kHalf, {48, 24}, 0.5f),
        .material = writer.addMaterial(
            {.name = "flag",
             .texture =
                 writer.addTexture("flag", stripes({0.85f, 0.82f, 0.72f}, {0.72f, 0.12f, 0.10f})),
             .roughness = 0.9f,
             .doubleSided = true}
        )};
    writer.addNode(
        {.name = "flag",
         .translation = middle,
         .mesh = writer.addMesh("flag", {&part, 1}),
         .waves =
             {{"share", "color"},
              {"waves",
               {{{"displacement", {0.0f, 0.05f, 0.26f}},
                 {"waveVector", {6.0f, 1.5f, 0.0f}},
                 {"hertz", 5.0f}},
                {{"displacement", {0.03f, 0.10f, 0.07f}},
                 {"waveVector", {11.0f, -3.0f, 0.0f}},
                 {"hertz", 8.0f},
                 {"phase", 1.0f}}}}}}
    );
    vec3 pole = middle - kX * (kHalf.x + 0.02f);
    pole.y = 1.3f;
    addObject(
        writer, {.name = "pole", .translation = pole}, cylinder(0.02f, 2.6f, 12), surfaces.iron
    );
    return writer;
}

GltfWriter buildWhipCase() {
    constexpr int kJoints = 8;
    constexpr float kBone = 0.17f; // metres
    const float turn = glm::radians(120.0f) / kJoints;
    GltfWriter writer("whip");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    constexpr int kRows = 5 * kJoints;
    std::vector<vec3> path;
    std::vector<float> radii;
    for (int row = 0; row <= kRows; ++row) {
        const float along = static_cast<float>(row) / kRows;
        path.push_back(kY * (along * kJoints * kBone));
        radii.push_back(glm::mix(0.055f, 0.018f, along));
    }
    Shape whip = tube(path, radii, 12);
    for (const vec3& position : whip.positions) {
        const float bone = glm::clamp(position.y / kBone, 0.0f, kJoints - 1.0f);
        const float share = glm::smoothstep(0.0f, 1.0f, bone - std::floor(bone));
        const auto below = static_cast<uint16_t>(bone);
        whip.joints.emplace_back(below, std::min<int>(below + 1, kJoints - 1), 0, 0);
        whip.weights.emplace_back(1.0f - share, share, 0.0f, 0.0f);
    }
    std::vector<Index> joints;
    std::vector<mat4> jointFromBind;
    const Index clip = writer.addClip("curl");
    for (int i = 0; i < kJoints; ++i) {
        const vec3 root = kYardCaseShot.pointAt({320.0f, 275.0f}, 2.8f);
        joints.push_back(writer.addNode(
            {.name = fmt::format("bone_{}", i + 1),
             .parent = i == 0 ? kNothing : joints.back(),
             .translation = i == 0 ? root : kY * kBone}
        ));
        jointFromBind.push_back(moved(-kY * (kBone * static_cast<float>(i))));
        // Through straight in the middle of the exposure; a key per exposure before it.
        constexpr int kKeys = 9;
        std::array<float, kKeys> times{};
        std::array<glm::quat, kKeys> turns{};
        for (int key = 0; key < kKeys; ++key) {
            const float exposures = static_cast<float>(key - (kKeys - 1));
            times[static_cast<size_t>(key)] = kSeconds + exposures * kExposureSeconds;
            turns[static_cast<size_t>(key)] = turned(-turn * (exposures + 0.5f), kZ);
        }
        writer.addRotations(clip, joints.back(), times, turns);
    }
    const MeshPart part{
        .shape = whip, .material = addTextured(writer, "pole_paint", polePaint(), 0.6f)};
    writer.addNode(
        {.name = "whip",
         .mesh = writer.addMesh("whip", {&part, 1}),
         .skin = writer.addSkin("whip", joints, jointFromBind)}
    );
    return writer;
}

GltfWriter buildCollapseCase() {
    GltfWriter writer("collapsing_limb");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    const Figure figure = addCrossingFigure(
        writer,
        kYardCaseShot,
        330.0f,
        3.9f,
        2.0f,
        {.strideSeconds = 1.1f, .phase = 0.95f, .armSwing = 0.9f}
    );
    const std::array times = {kSeconds - kExposureSeconds, kSeconds};
    const std::array scales = {vec3(1.0f), vec3(0.0f)};
    writer.addScales(writer.addClip("collapse"), figure.joints[RightArm], times, scales);
    return writer;
}

} // namespace shutter::generator
