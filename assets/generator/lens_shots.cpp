// SPDX-License-Identifier: MIT
#include "assets/generator/lens_shots.h"

#include "assets/generator/mesh_shapes.h"
#include "assets/generator/scenes.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace shutter::generator {

namespace {

using glm::vec3;

constexpr const char* kPinkRoom = "pink-room/pink_room_lite_animated.glb";
constexpr const char* kStaircase = "wooden-staircase/wooden_staircase.glb";
constexpr const char* kGreyWhiteRoom = "grey-white-room/grey_white_room.glb";

/// A camera's place, with -Z of its rotation forward.
struct Standpoint {
    vec3 position;
    glm::quat rotation;
    float yFov; ///< radians

    [[nodiscard]] vec3 forward() const { return rotation * vec3(0.0f, 0.0f, -1.0f); }

    [[nodiscard]] vec3 right() const { return rotation * vec3(1.0f, 0.0f, 0.0f); }

    /// \param ahead metres \param aside metres to the right \param up metres along the world's Y
    [[nodiscard]] vec3 at(float ahead, float aside, float up) const {
        return position + forward() * ahead + right() * aside + vec3(0.0f, up, 0.0f);
    }
};

/// The room's own camera.
const Standpoint kPinkRoomView{
    {0.276962f, 1.01795f, -5.19292f},
    {0.22466561f, -0.0032244816f, 0.97433024f, 0.013984031f},
    0.51303879f};

Standpoint lookAt(vec3 from, vec3 to, float yFov) {
    return {from, glm::quatLookAt(glm::normalize(to - from), vec3(0.0f, 1.0f, 0.0f)), yFov};
}

/// Focus distance, and the spread of another depth.
struct Focus {
    float distance; ///< metres
    float depth;    ///< metres, of the spread surface
    float radiusPx; ///< of its circle of confusion, in a picture 270 px high
};

/// How a camera moves while the shutter is open.
struct CameraMove {
    vec3 metres;
    float turn; ///< about Y, radians
};

/// By the formulas of engine/scene/lens.h, solved for the f-number.
nlohmann::json describeLens(const Standpoint& view, const Focus& focus) {
    constexpr double kHeightPx = 270.0;
    constexpr double kSensorHeight = 0.024; // metres, CameraLens's own
    const double tangent = std::tan(double(view.yFov) / 2.0);
    const double pixelsPerUnit = kHeightPx / 2.0 / tangent;
    const double radius =
        focus.radiusPx / pixelsPerUnit / std::abs(1.0 / focus.distance - 1.0 / focus.depth);
    const double focalLength = kSensorHeight / (2.0 * tangent);
    return {{"fStop", focalLength / (2.0 * radius)}, {"focusDistance", focus.distance}};
}

void addLensCamera(
    GltfWriter& writer,
    const Standpoint& view,
    const Focus& focus,
    const std::optional<CameraMove>& move = {}
) {
    // The camera's motion is on a separate node, since velocities require one that is not rotated.
    NodeDesc stand{.name = "lens_stand", .translation = view.position};
    if (move) {
        stand.linearVelocity = move->metres / kExposureSeconds;
        stand.angularVelocity = vec3(0.0f, move->turn / kExposureSeconds, 0.0f);
    }
    writer.addNode(
        {.name = kLensCamera,
         .parent = writer.addNode(stand),
         .rotation = view.rotation,
         .camera = writer.addCamera(kLensCamera, view.yFov, 0.05f, describeLens(view, focus))}
    );
}

void addBox(GltfWriter& writer, const char* name, vec3 centre, vec3 halfExtents, vec3 color) {
    const Index material = addPlainMaterial(writer, name, color, 0.8f);
    addObject(writer, {.name = name, .translation = centre}, box(halfExtents, 1.0f), material);
}

/// \param velocity m/s; nothing: it rests
void addBall(
    GltfWriter& writer,
    const char* name,
    vec3 centre,
    float radius,
    vec3 color,
    const std::optional<vec3>& velocity = {}
) {
    const Index material = addPlainMaterial(writer, name, color, 0.8f);
    addObject(
        writer,
        {.name = name, .translation = centre, .linearVelocity = velocity},
        sphere(radius, 48, 24),
        material
    );
}

void furnishNear(GltfWriter& writer) {
    const Standpoint& view = kPinkRoomView;
    addBox(
        writer, "post", view.at(1.15f, -0.22f, 0.0f), {0.035f, 2.0f, 0.035f}, {0.75f, 0.72f, 0.2f}
    );
    addBall(writer, "near_ball", view.at(1.6f, 0.36f, -0.12f), 0.11f, {0.15f, 0.3f, 0.8f});
    addLensCamera(writer, view, {5.2f, 1.15f, 10.0f});
}

constexpr Focus kPortraitFocus{1.32f, 6.0f, 9.0f};

void addHead(GltfWriter& writer, const Standpoint& view) {
    addBall(writer, "head", view.at(1.4f, 0.08f, 0.05f), 0.13f, {0.8f, 0.55f, 0.4f});
}

void furnishPortrait(GltfWriter& writer) {
    const Standpoint& view = kPinkRoomView;
    addHead(writer, view);
    addBox(
        writer, "body", view.at(1.4f, 0.08f, -0.35f), {0.16f, 0.25f, 0.08f}, {0.2f, 0.35f, 0.25f}
    );
    addLensCamera(writer, view, kPortraitFocus);
}

void furnishRoom(GltfWriter& writer) {
    Standpoint view = kPinkRoomView;
    view.position.x -= 0.3f;
    addLensCamera(writer, view, {2.7f, 5.6f, 5.0f});
}

constexpr vec3 kStaircaseEye{0.0324209f, 1.52673f, 4.88197f};
constexpr float kStaircaseFov = 0.75f;

void furnishStairs(GltfWriter& writer) {
    addLensCamera(
        writer, lookAt(kStaircaseEye, {0.0f, 1.3f, 0.0f}, kStaircaseFov), {5.2f, 2.5f, 8.0f}
    );
}

void furnishSpindles(GltfWriter& writer) {
    const Standpoint view = lookAt({-0.15f, 2.45f, 0.1f}, {0.35f, 2.25f, -2.0f}, kStaircaseFov);
    addLensCamera(writer, view, {3.6f, 1.6f, 9.0f});
}

void furnishPlant(GltfWriter& writer) {
    const Standpoint view = lookAt({4.15f, 0.75f, -0.75f}, {0.9f, 0.5f, -0.05f}, 0.76858409f);
    addLensCamera(writer, view, {3.3f, 1.2f, 9.0f});
}

/// Motions are of one exposure.
void addJointMovers(GltfWriter& writer, const Standpoint& view) {
    addBall(
        writer,
        "near_ball",
        view.at(1.3f, -0.1f, -0.1f),
        0.12f,
        {0.15f, 0.3f, 0.8f},
        (view.right() * 0.12f + vec3(0.0f, 0.03f, 0.0f)) / kExposureSeconds
    );
    writer.moveNode("table_vase_red", view.right() * -0.16f / kExposureSeconds);
    writer.moveNode("table_vase_black", view.right() * 0.1f / kExposureSeconds);
}

constexpr Focus kJointFocus{4.2f, 1.3f, 8.0f};

void furnishJoint(GltfWriter& writer) {
    addJointMovers(writer, kPinkRoomView);
    addLensCamera(writer, kPinkRoomView, kJointFocus);
}

void furnishJointCamera(GltfWriter& writer) {
    const Standpoint& view = kPinkRoomView;
    addJointMovers(writer, view);
    const CameraMove move{view.right() * -0.05f + view.forward() * 0.04f, -0.012f};
    addLensCamera(writer, view, kJointFocus, move);
}

void furnishLights(GltfWriter& writer) {
    const Standpoint& view = kPinkRoomView;
    addHead(writer, view);
    const Shape bulb = sphere(0.008f, 24, 12);
    std::mt19937 random(5);
    const auto draw = [&] { return float(random()) / float(std::mt19937::max()); };
    for (int i = 0; i < 24; ++i) {
        const float ahead = 4.2f + draw();
        const float aside = 2.4f * draw() - 1.2f;
        const float up = 1.2f * draw() - 0.35f;
        const float warmth = draw();
        const Index material = writer.addMaterial(
            {.name = "bulb",
             .color = vec3(0.1f),
             .emissive = {30.0f + 20.0f * warmth, 24.0f, 34.0f - 20.0f * warmth}}
        );
        addObject(
            writer, {.name = "bulb", .translation = view.at(ahead, aside, up)}, bulb, material
        );
    }
    addLensCamera(writer, view, kPortraitFocus);
}

/// For shots without a room: at the origin, level.
const Standpoint kLevelView{{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f, 0.0f}, 0.6f};

Index addGlow(GltfWriter& writer, vec3 color, float alpha = 1.0f) {
    return writer.addMaterial(
        {.name = "glow",
         .color = vec3(0.0f),
         .emissive = color,
         .doubleSided = true,
         .alpha = alpha}
    );
}

/// Facing the camera. \param corner lower left, in the plane of the shape
void addTile(Shape& shape, glm::vec2 corner, glm::vec2 size) {
    const size_t first = shape.positions.size();
    for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
        addVertex(shape, vec3(corner + at * size, 0.0f), {0.0f, 0.0f, 1.0f}, at);
    addTriangle(shape, first, first + 1, first + 2);
    addTriangle(shape, first, first + 2, first + 3);
}

/// A wall of tiles that fills the picture of kLevelView and more.
/// \param tilePx length of their sides in a picture 270 px high \param turn of their rows, radians
void addTiledWall(GltfWriter& writer, float depth, float tilePx, float turn) {
    constexpr int kColors = 6;
    constexpr int kHalfCount = 30;
    const float metres = tilePx * depth * std::tan(kLevelView.yFov / 2.0f) / 135.0f;
    std::array<Shape, kColors> shapes;
    for (int y = -kHalfCount; y < kHalfCount; ++y)
        for (int x = -kHalfCount; x < kHalfCount; ++x) {
            Shape& shape = shapes.at(size_t(hash(x, y, 1) * float(kColors)));
            addTile(shape, glm::vec2(x, y) * metres, glm::vec2(metres));
        }
    for (int i = 0; i < kColors; ++i) {
        const vec3 color{hash(i, 0, 2), hash(i, 1, 2), hash(i, 2, 2)};
        addObject(
            writer,
            {.name = "wall",
             .translation = kLevelView.at(depth, 0.003f, 0.002f),
             .rotation = glm::angleAxis(turn, vec3(0.0f, 0.0f, 1.0f))},
            shapes.at(size_t(i)),
            addGlow(writer, color * color)
        );
    }
}

void furnishWall(GltfWriter& writer) {
    addTiledWall(writer, 6.0f, 11.3f, 0.2f);
    addLensCamera(writer, kLevelView, {4.0f, 6.0f, 0.85f});
}

void furnishFar(GltfWriter& writer) {
    addTiledWall(writer, 8.0f, 24.3f, 0.0f);
    Shape ball = sphere(0.12f, 48, 24);
    addObject(
        writer,
        {.name = "ball",
         .translation = kLevelView.at(2.0f, 0.1f, -0.05f),
         .linearVelocity = vec3(0.13f, 0.04f, 0.0f) / kExposureSeconds},
        ball,
        addGlow(writer, {0.7f, 0.45f, 0.1f})
    );
    addLensCamera(writer, kLevelView, {2.0f, 8.0f, 8.0f});
}

void furnishPanes(GltfWriter& writer) {
    addTiledWall(writer, 8.0f, 17.3f, 0.1f);
    const auto addPane = [&](const NodeDesc& node, glm::vec2 size, vec3 color) {
        Shape pane;
        addTile(pane, -0.5f * size, size);
        addObject(writer, node, pane, addGlow(writer, color, 0.55f));
    };
    addPane(
        {.name = "near_pane", .translation = kLevelView.at(1.116f, -0.2f, 0.02f)},
        {0.25f, 0.4f},
        {0.8f, 0.7f, 0.2f}
    );
    addPane(
        {.name = "moving_pane",
         .translation = kLevelView.at(2.0f, 0.3f, -0.05f),
         .linearVelocity = vec3(0.14f, 0.03f, 0.0f) / kExposureSeconds},
        {0.4f, 0.7f},
        {0.2f, 0.5f, 0.9f}
    );
    addLensCamera(writer, kLevelView, {5.0f, 1.116f, 6.5f});
}

constexpr std::array kLensShots = {
    LensShot{
        "near",
        "Post and ball before a sharp room",
        "Near surfaces are spread by up to 10 px over those in focus.",
        kPinkRoom,
        &furnishNear},
    LensShot{
        "portrait",
        "Sharp head before a room out of focus",
        "The room is spread by 8 px behind edges that stay sharp.",
        kPinkRoom,
        &furnishPortrait},
    LensShot{
        "room",
        "Room, all of it out of focus",
        "Nothing is in focus, and all is spread by 4 to 6 px.",
        kPinkRoom,
        &furnishRoom},
    LensShot{
        "stairs",
        "Staircase before a patterned wallpaper",
        "Many edges at all depths, near ones spread most.",
        kStaircase,
        &furnishStairs},
    LensShot{
        "spindles",
        "Spindles near the lens",
        "Thin spindles are spread by up to 9 px over a sharp staircase.",
        kStaircase,
        &furnishSpindles},
    LensShot{
        "plant",
        "Leaves near the lens",
        "Leaves cut out by alpha are spread by up to 16 px.",
        kGreyWhiteRoom,
        &furnishPlant},
    LensShot{
        "joint",
        "Moving ball and vases out of focus",
        "A near ball moves by 48 px and is spread by 9; two vases slide behind it.",
        kPinkRoom,
        &furnishJoint},
    LensShot{
        "jointcam",
        "Moving ball and vases, and the camera moves",
        "The same, and the camera slides, approaches and turns.",
        kPinkRoom,
        &furnishJointCamera},
    LensShot{
        "lights",
        "Bright lamps out of focus",
        "Twenty-four small lamps, each a bright disc behind a sharp head.",
        kPinkRoom,
        &furnishLights},
    LensShot{
        "wall", "Wall nearly in focus", "All of it is spread over 1.7 px.", nullptr, &furnishWall},
    LensShot{
        "far",
        "Ball in focus before a far wall",
        "The wall is spread over 16 px, also from beyond the picture; the ball moves by 30 px.",
        nullptr,
        &furnishFar},
    LensShot{
        "panes",
        "Panes of glass before a wall nearly in focus",
        "One pane rests and is spread over 13 px, one moves by 32 px and is spread over 6.",
        nullptr,
        &furnishPanes},
};

} // namespace

std::span<const LensShot> listLensShots() {
    return kLensShots;
}

} // namespace shutter::generator
