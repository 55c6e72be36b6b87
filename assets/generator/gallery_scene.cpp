// SPDX-License-Identifier: MIT
// The shooting gallery: a booth with three rails of targets before a striped wall.
#include "assets/generator/axes.h"
#include "assets/generator/demo_scenes.h"
#include "assets/generator/figure.h"
#include "assets/generator/mesh_shapes.h"
#include "assets/generator/scenes.h"
#include "assets/generator/textures.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace shutter::generator {

namespace {

/// A rail along X with targets.
struct Rail {
    vec3 middle{0.0f}; ///< of its upper side
    float halfLength = 5.0f;
    float targetRadius = 0.3f;
    int targetCount = 3;
};

constexpr std::array kRails = {
    Rail{.middle = {0.0f, 0.95f, -5.0f}, .halfLength = 4.2f, .targetRadius = 0.26f},
    Rail{.middle = {0.0f, 1.60f, -7.5f}, .halfLength = 5.2f, .targetRadius = 0.32f},
    Rail{.middle = {0.0f, 2.50f, -10.0f}, .halfLength = 6.2f, .targetRadius = 0.40f}};

void addBooth(GltfWriter& writer) {
    const Index boards = addTextured(writer, "boards", planks(), 0.8f);
    const Index wall =
        addTextured(writer, "wall", stripes({0.16f, 0.30f, 0.42f}, {0.80f, 0.76f, 0.66f}), 0.95f);
    const Index dark = writer.addMaterial({.name = "dark_wood", .color = {0.15f, 0.08f, 0.05f}});
    Shape walls;
    append(walls, box({7.2f, 2.6f, 0.1f}, 2.4f), moved({0.0f, 2.5f, -12.1f}));
    for (const float side : {-1.0f, 1.0f})
        append(walls, box({0.1f, 2.6f, 7.2f}, 2.4f), moved({side * 7.2f, 2.5f, -5.0f}));
    Shape trim;
    append(trim, box({7.2f, 0.12f, 0.04f}, 1.0f), moved({0.0f, 0.12f, -11.98f}));
    append(trim, box({7.2f, 0.16f, 0.06f}, 1.0f), moved({0.0f, 4.5f, -11.96f}));
    // The counter before the player.
    append(trim, roundedBox({2.6f, 0.06f, 0.30f}, 0.05f, 1, 1.0f), moved({0.0f, 0.86f, -0.55f}));
    Shape floor = box({7.2f, 0.1f, 8.0f}, 2.0f);
    const std::array parts = {
        MeshPart{.shape = walls, .material = wall}, MeshPart{.shape = trim, .material = dark}};
    writer.addNode({.name = "booth", .mesh = writer.addMesh("booth", parts)});
    addObject(writer, {.name = "floor", .translation = {0.0f, -0.1f, -5.0f}}, floor, boards);
}

/// Flags on a line between two places that sags, and lamps between the flags.
void hangBunting(std::array<Shape, 3>& flags, Shape& lamps, vec3 from, vec3 to) {
    constexpr int kFlags = 17;
    constexpr float kSag = 0.35f;
    constexpr std::array kPennant = {
        vec2(0.0f, -0.34f), vec2(0.053f, -0.227f), vec2(0.107f, -0.113f), vec2(0.16f, 0.0f)};
    Shape pennant = lathe(kPennant, 6);
    for (const vec3& position : pennant.positions)
        pennant.slack.push_back(position.y / kPennant[0].y);
    const vec3 along = glm::normalize(to - from);
    const mat4 turn = glm::mat4_cast(glm::angleAxis(std::atan2(-along.z, along.x), kY));
    for (int i = 0; i < kFlags; ++i) {
        const float share = (static_cast<float>(i) + 0.5f) / kFlags;
        const vec3 place = glm::mix(from, to, share) - kY * (4.0f * kSag * share * (1.0f - share));
        // A cone pressed flat.
        const mat4 flat = glm::scale(moved(place) * turn, vec3(1.0f, 1.0f, 0.06f));
        append(flags[static_cast<size_t>(i) % flags.size()], pennant, flat);
        append(lamps, sphere(0.045f, 5, 4), moved(place + along * 0.19f + kY * 0.03f));
    }
}

/// Shelves at the side walls with what there is to win.
void addPrizes(GltfWriter& writer) {
    Shape shelves;
    Shape bears;
    Shape jugs;
    Shape parcels;
    constexpr std::array kJug = {
        vec2(0.0f, 0.0f),
        vec2(0.11f, 0.01f),
        vec2(0.17f, 0.13f),
        vec2(0.07f, 0.29f),
        vec2(0.10f, 0.36f),
        vec2(0.0f, 0.34f)};
    Shape bear = sphere(0.17f, 9, 6);
    append(bear, sphere(0.12f, 8, 6), moved({0.0f, 0.25f, 0.03f}));
    for (const float side : {-1.0f, 1.0f}) {
        append(bear, sphere(0.045f, 5, 4), moved({side * 0.09f, 0.35f, 0.03f}));
        append(bear, sphere(0.06f, 6, 4), moved({side * 0.15f, 0.06f, 0.09f}));
        append(bear, sphere(0.07f, 6, 4), moved({side * 0.10f, -0.13f, 0.13f}));
    }
    for (const float side : {-1.0f, 1.0f})
        for (int row = 0; row < 2; ++row) {
            const vec3 middle(side * 6.85f, 1.35f + 1.15f * static_cast<float>(row), -6.4f);
            append(shelves, box({0.26f, 0.03f, 3.6f}, 1.0f), moved(middle));
            for (int i = 0; i < 9; ++i) {
                const vec3 place = middle + vec3(0.0f, 0.03f, -3.2f + 0.8f * static_cast<float>(i));
                const float kind = hash(i, row + (side > 0.0f ? 7 : 0), 381);
                const mat4 turn = glm::mat4_cast(glm::angleAxis(-side * glm::half_pi<float>(), kY));
                if (kind < 0.45f)
                    append(bears, bear, moved(place + kY * 0.17f) * turn);
                else if (kind < 0.70f)
                    append(jugs, lathe(kJug, 10), moved(place));
                else
                    append(parcels, box({0.17f, 0.15f, 0.17f}, 0.34f), moved(place + kY * 0.15f));
            }
        }
    const std::array parts = {
        MeshPart{
            .shape = shelves,
            .material = addPlainMaterial(writer, "shelf", {0.20f, 0.11f, 0.06f}, 0.8f)},
        MeshPart{
            .shape = bears,
            .material = addPlainMaterial(writer, "plush", {0.45f, 0.24f, 0.10f}, 0.95f)},
        MeshPart{
            .shape = jugs,
            .material = addPlainMaterial(writer, "glaze", {0.10f, 0.30f, 0.42f}, 0.25f)},
        MeshPart{
            .shape = parcels,
            .material = addTextured(
                writer, "parcels", stripes({0.80f, 0.20f, 0.30f}, {0.95f, 0.88f, 0.60f}), 0.7f
            )}};
    writer.addNode({.name = "prizes", .mesh = writer.addMesh("prizes", parts)});
}

void addBunting(GltfWriter& writer) {
    std::array<Shape, 3> flags;
    Shape lamps;
    const std::array corners = {
        vec3(-7.0f, 5.0f, 0.5f),
        vec3(-7.0f, 5.0f, -11.8f),
        vec3(7.0f, 5.0f, -11.8f),
        vec3(7.0f, 5.0f, 0.5f)};
    for (size_t i = 0; i + 1 < corners.size(); ++i)
        hangBunting(flags, lamps, corners[i], corners[i + 1]);
    constexpr std::array kColours = {
        vec3(0.75f, 0.10f, 0.08f), vec3(0.85f, 0.60f, 0.08f), vec3(0.10f, 0.35f, 0.20f)};
    addObject(
        writer,
        {.name = "lamps"},
        lamps,
        writer.addMaterial({.name = "bulbs", .emissive = {1.0f, 0.85f, 0.5f}})
    );
    std::vector<MeshPart> parts;
    for (size_t i = 0; i < flags.size(); ++i)
        parts.push_back(
            {.shape = flags[i], .material = addPlainMaterial(writer, "flags", kColours[i], 0.9f)}
        );
    writer.addNode(
        {.name = "bunting",
         .mesh = writer.addMesh("bunting", parts),
         .waves =
             {{"share", "color"},
              {"exponent", 1.5},
              {"waves",
               {{{"displacement", {0.06f, 0.02f, 0.12f}},
                 {"waveVector", {1.3f, 0.0f, 0.9f}},
                 {"hertz", 1.6f}},
                {{"displacement", {0.03f, 0.01f, 0.05f}},
                 {"waveVector", {5.0f, 0.0f, 3.7f}},
                 {"hertz", 4.3f}}}}}}
    );
}

/// A window under the runner's arm: through it the runner and the wall are visible by turns.
void addCarriedPane(GltfWriter& writer, Index runner) {
    constexpr vec2 kHalf{0.75f, 0.55f};
    constexpr float kBar = 0.03f;
    Shape frame;
    for (const float side : {-1.0f, 1.0f}) {
        append(frame, box({kBar, kHalf.y + kBar, kBar}, 0.5f), moved(kZ * (side * kHalf.x)));
        append(frame, box({kBar, kBar, kHalf.x - kBar}, 0.5f), moved(kY * (side * kHalf.y)));
    }
    const Index window = addObject(
        writer,
        {.name = "window", .parent = runner, .translation = {-0.50f, 1.05f, 0.10f}},
        frame,
        addPlainMaterial(writer, "window_frame", {0.75f, 0.70f, 0.60f}, 0.6f)
    );
    addObject(
        writer,
        {.name = "pane", .parent = window},
        box({0.004f, kHalf.y, kHalf.x}, 1.0f),
        writer.addMaterial(
            {.name = "glass",
             .color = {0.15f, 0.50f, 0.45f},
             .roughness = 0.15f,
             .doubleSided = true,
             .alpha = 0.45f}
        )
    );
}

/// A person who runs to and fro between the first two rails, in clips that loop: where they end
/// they are as they began.
void addRunner(GltfWriter& writer) {
    constexpr float kHalfWay = 4.6f;       // metres
    constexpr float kCrossSeconds = 2.88f; // four strides
    constexpr float kTurnSeconds = 0.72f;  // one stride, on the spot
    constexpr float kDepth = -6.2f;
    const Gait gait = makeRun();
    const std::array times = {
        0.0f,
        kCrossSeconds,
        kCrossSeconds + kTurnSeconds,
        2.0f * kCrossSeconds + kTurnSeconds,
        2.0f * (kCrossSeconds + kTurnSeconds)};
    const vec3 left(-kHalfWay, 0.0f, kDepth);
    const vec3 right(kHalfWay, 0.0f, kDepth);
    const glm::quat towardsRight = turned(glm::half_pi<float>(), kY);
    const glm::quat towardsLeft = turned(-glm::half_pi<float>(), kY);
    const Figure runner = addFigure(
        writer,
        addFigureMesh(writer, "runner", {0.75f, 0.55f, 0.10f}, {0.15f, 0.30f, 0.25f}),
        {.name = "runner", .translation = left, .rotation = towardsRight}
    );
    const Index clip = writer.addClip("run");
    writer.addTranslations(clip, runner.root, times, std::array{left, right, right, left, left});
    // By the front both times: halves of a turn have no shorter way.
    const std::array turnTimes = {
        times[0],
        times[1],
        times[1] + kTurnSeconds / 2.0f,
        times[2],
        times[3],
        times[3] + kTurnSeconds / 2.0f,
        times[4]};
    const glm::quat front = turned(0.0f, kY);
    writer.addRotations(
        clip,
        runner.root,
        turnTimes,
        std::array{towardsRight, towardsRight, front, towardsLeft, towardsLeft, front, towardsRight}
    );
    addGait(writer, clip, runner, gait, 0.0f, times.back());
    addCarriedPane(writer, runner.root);
}

void addRails(GltfWriter& writer) {
    const Index iron =
        writer.addMaterial({.name = "iron", .color = vec3(0.25f), .roughness = 0.5f});
    const std::array faces = {
        addTextured(writer, "rings_red", rings(vec3(0.94f), {0.82f, 0.10f, 0.10f}), 0.6f),
        addTextured(writer, "rings_green", rings(vec3(0.94f), {0.06f, 0.42f, 0.20f}), 0.6f),
        addTextured(writer, "rings_blue", rings(vec3(0.94f), {0.10f, 0.20f, 0.62f}), 0.6f)};
    const mat4 upright = glm::rotate(mat4(1.0f), glm::half_pi<float>(), kX);
    for (size_t i = 0; i < kRails.size(); ++i) {
        const Rail& rail = kRails[i];
        Shape bar;
        append(bar, box({rail.halfLength, 0.06f, 0.05f}, 1.0f));
        for (const float side : {-0.96f, 0.0f, 0.96f}) {
            const float height = rail.middle.y / 2.0f - 0.03f;
            append(
                bar,
                box({0.04f, height, 0.04f}, 1.0f),
                moved({side * rail.halfLength, -height, -0.02f})
            );
        }
        addObject(
            writer,
            {.name = fmt::format("rail_{}", i), .translation = rail.middle - vec3(0, 0.06f, 0)},
            bar,
            iron
        );
        // The pivot is the foot, about which a target that is hit falls over.
        const float stalk = 0.16f;
        Shape face;
        append(
            face,
            cylinder(rail.targetRadius, 0.05f, 24),
            moved({0.0f, stalk + rail.targetRadius, 0.0f}) * upright
        );
        Shape foot = box({0.03f, stalk, 0.02f}, 1.0f);
        Shape stand;
        append(stand, foot, moved({0.0f, stalk, 0.0f}));
        const std::array parts = {
            MeshPart{.shape = face, .material = faces[i]},
            MeshPart{.shape = stand, .material = iron}};
        const Index mesh = writer.addMesh(fmt::format("target_{}", i), parts);
        for (int k = 0; k < rail.targetCount; ++k) {
            const float share =
                (static_cast<float>(k) + 0.5f) / static_cast<float>(rail.targetCount);
            writer.addNode(
                {.name = fmt::format("target_{}_{}", i, k),
                 .translation = rail.middle + kX * ((share * 2.0f - 1.0f) * rail.halfLength),
                 .mesh = mesh}
            );
        }
    }
}

/// A camera at `position`, facing `target`.
void addCamera(
    GltfWriter& writer,
    const char* name,
    vec3 position,
    vec3 target,
    float yFov,
    const nlohmann::json& lens = {}
) {
    writer.addNode(
        {.name = name,
         .translation = position,
         .rotation = rotationTowards(target - position),
         .camera = writer.addCamera(name, yFov, 0.05f, lens)}
    );
}

/// In the player's hand, below the line of sight: a tube that throws balls.
void addLauncher(GltfWriter& writer, Index camera) {
    const mat4 along = glm::rotate(mat4(1.0f), -glm::half_pi<float>(), kX);
    Shape barrel;
    append(barrel, cylinder(0.055f, 0.50f, 16), moved({0.0f, 0.0f, -0.25f}) * along);
    append(barrel, torus(0.055f, 0.016f, 20, 8), moved({0.0f, 0.0f, -0.49f}) * along);
    Shape grip;
    append(
        grip,
        roundedBox({0.025f, 0.09f, 0.04f}, 0.02f, 1, 0.2f),
        glm::rotate(moved({0.0f, -0.12f, -0.05f}), 0.3f, kX)
    );
    const std::array parts = {
        MeshPart{
            .shape = barrel,
            .material = writer.addMaterial(
                {.name = "brass",
                 .color = {0.72f, 0.52f, 0.20f},
                 .metallic = 0.2f,
                 .roughness = 0.4f}
            )},
        MeshPart{
            .shape = grip,
            .material = writer.addMaterial({.name = "grip", .color = {0.20f, 0.10f, 0.06f}})}};
    writer.addNode(
        {.name = "launcher",
         .parent = camera,
         .translation = {0.20f, -0.20f, -0.28f},
         .mesh = writer.addMesh("launcher", parts)}
    );
}

} // namespace

GltfWriter buildGalleryScene() {
    GltfWriter writer("gallery");
    const Index shooter = writer.addNode(
        {.name = "shooter",
         .translation = {0.0f, 1.65f, 0.9f},
         .camera = writer.addCamera("shooter", 0.80f, 0.05f)}
    );
    addLauncher(writer, shooter);
    // The runner crosses its view from near to far, and stays in focus.
    const nlohmann::json lens = {{"fStop", 0.95}, {"sensorHeight", 0.056}, {"focusNode", "runner"}};
    addCamera(writer, "side", {-5.8f, 2.5f, -1.6f}, {0.5f, 1.5f, -7.0f}, 0.80f, lens);
    addCamera(writer, "high", {4.6f, 4.2f, 0.8f}, {-0.6f, 1.4f, -7.6f}, 0.70f);
    addDemoSun(writer, {0.35f, -0.75f, -0.60f});
    addBooth(writer);
    addRails(writer);
    addPrizes(writer);
    addBunting(writer);
    addRunner(writer);
    // The one that others are made of.
    addObject(
        writer,
        {.name = "ball", .translation = {1.4f, 1.02f, -0.55f}},
        sphere(0.10f, 20, 12),
        addTextured(writer, "beach_ball", beachBall(), 0.5f)
    );
    return writer;
}

} // namespace shutter::generator
