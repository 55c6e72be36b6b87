// SPDX-License-Identifier: MIT
#include "assets/generator/scaling_scenes.h"

#include "assets/generator/axes.h"
#include "assets/generator/figure.h"
#include "assets/generator/scenes.h"
#include "assets/generator/textures.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace shutter::generator {

namespace {

// Shot computes speeds from the one exposure.
static_assert(static_cast<float>(kScalingExposureSeconds) == kExposureSeconds);

const Shot kScalingShot{.position = {0.0f, 0.0f, 0.0f}, .yFov = 0.7f};
constexpr float kMoverDepth = 4.0f; ///< metres along the view axis
constexpr float kWallDepth = 6.0f;

/// Half the picture's width and height at a depth, metres.
vec2 halfView(float depth) {
    return kPictureSizePx / 2.0f / kScalingShot.focalLengthPx() * depth;
}

void addStage(GltfWriter& writer) {
    writer.addNode({.name = "main", .camera = writer.addCamera("main", kScalingShot.yFov, 0.05f)});
    writer.addNode(
        {.name = "sun",
         .rotation = rotationTowards({0.5f, -0.6f, -0.8f}),
         .light = writer.addLight(
             "sun", {.directional = true, .color = {1.0f, 0.96f, 0.9f}, .intensity = 3.0f}
         )}
    );
}

/// Fills the picture with margin.
void addFlatWall(GltfWriter& writer) {
    addObject(
        writer,
        {.name = "wall", .translation = {0.0f, 0.0f, -kWallDepth}},
        sheet(halfView(kWallDepth) * 1.1f, 1.12f),
        addTextured(writer, "bricks", bricks(), 0.95f)
    );
}

/// The relief's height towards the camera, metres, at a place in metres.
float reliefHeight(vec2 place) {
    return 0.16f * std::sin(place.x * 3.1f) * std::cos(place.y * 2.7f) +
           0.05f * std::sin(place.x * 11.0f + place.y * 7.0f);
}

Shape relief(vec2 halfExtents, int columnCount, int rowCount) {
    Shape shape = cloth(halfExtents, {columnCount, rowCount}, 1.12f);
    shape.slack.clear();
    for (vec3& position : shape.positions)
        position.z = reliefHeight(position);
    smoothNormals(shape);
    return shape;
}

/// A sphere with ribs and rings. \param ringCount [3, ...); 4 r (r - 1) triangles
Shape pumpkin(float radius, int ringCount) {
    Shape shape = sphere(radius, 2 * ringCount, ringCount);
    for (vec3& position : shape.positions) {
        const vec3 direction = position / radius;
        const float around = std::atan2(direction.z, direction.x);
        const float level = std::sqrt(std::max(0.0f, 1.0f - direction.y * direction.y));
        position *= 1.0f + 0.06f * level * std::cos(10.0f * around) +
                    0.012f * level * std::cos(14.0f * direction.y);
    }
    return shape;
}

/// Boxes in cells that are 16:9 as the picture is, as many in a row as in a column; the last row
/// may be short.
class BoxGrid {
  public:
    explicit BoxGrid(int count)
        : mSide(static_cast<int>(std::ceil(std::sqrt(static_cast<float>(count))))),
          mHalf(halfView(kMoverDepth) * 0.92f),
          mCell(2.0f * mHalf / vec2(mSide, (count + mSide - 1) / mSide)) {}

    [[nodiscard]] MeshPart makeBox(Index material) const {
        constexpr float kBoxShare = 0.68f; // of a cell's width and height
        const float size = kBoxShare / 2.0f * std::min(mCell.x, mCell.y);
        // Flat, or nearer fronts and visible sides would hide more than the cell's share.
        const float thickness = 0.1f * size;
        return {
            .shape =
                box({kBoxShare / 2.0f * mCell.x, kBoxShare / 2.0f * mCell.y, thickness},
                    2.0f * size),
            .material = material};
    }

    /// Centre of the box, metres.
    [[nodiscard]] vec3 placeOf(int i) const {
        const vec2 place = -mHalf + mCell * (vec2(i % mSide, i / mSide) + 0.5f);
        const float depth = depthOf(i);
        return {place * (depth / kMoverDepth), -depth};
    }

    /// 12 to 20 px in an exposure at 1280x720, m/s.
    [[nodiscard]] static vec3 velocityOf(int i) {
        const float angle = glm::two_pi<float>() * hash(i, 0, 3);
        const float pixels = 12.0f + 8.0f * hash(i, 1, 3);
        return kScalingShot.velocityFor(
            pixels * vec2(std::cos(angle), std::sin(angle)), depthOf(i)
        );
    }

  private:
    static float depthOf(int i) { return kMoverDepth + 0.2f * (hash(i, 2, 3) - 0.5f); }

    int mSide;
    vec2 mHalf;
    vec2 mCell;
};

} // namespace

GltfWriter buildEntitiesScene(int count) {
    count = std::clamp(count, 1, kMaxEntityCount);
    GltfWriter writer("entities");
    addStage(writer);
    addFlatWall(writer);
    const BoxGrid grid(count);
    const MeshPart part = grid.makeBox(addTextured(writer, "crate_boards", crateBoards(), 0.8f));
    const Index mesh = writer.addMesh("box", {&part, 1});
    for (int i = 0; i < count; ++i)
        writer.addNode(
            {.name = fmt::format("box_{}", i + 1),
             .translation = grid.placeOf(i),
             .mesh = mesh,
             .linearVelocity = grid.velocityOf(i)}
        );
    return writer;
}

GltfWriter buildFewMoversScene(int count, int movers, bool merged) {
    count = std::clamp(count, 1, kMaxEntityCount);
    movers = std::clamp(movers, 0, count);
    GltfWriter writer("few_movers");
    addStage(writer);
    const BoxGrid grid(count);
    const MeshPart part = grid.makeBox(addTextured(writer, "crate_boards", crateBoards(), 0.8f));
    const Index mesh = writer.addMesh("box", {&part, 1});
    // Each of as many runs of boxes has its mover in the middle, however long they are.
    const auto isMover = [&](int i) {
        const int64_t run = (int64_t{i} * movers) / count;
        const int64_t first = (run * count + movers - 1) / std::max(movers, 1);
        const int64_t next = ((run + 1) * count + movers - 1) / std::max(movers, 1);
        return movers > 0 && i == (first + next - 1) / 2;
    };
    MeshPart still{.shape = {}, .material = part.material};
    for (int i = 0; i < count; ++i) {
        NodeDesc node{
            .name = fmt::format("box_{}", i + 1), .translation = grid.placeOf(i), .mesh = mesh};
        if (isMover(i))
            node.linearVelocity = grid.velocityOf(i);
        else if (merged)
            append(still.shape, part.shape, glm::translate(mat4(1.0f), grid.placeOf(i)));
        if (isMover(i) || !merged)
            writer.addNode(node);
    }
    if (!still.shape.indices.empty())
        writer.addNode({.name = "boxes", .mesh = writer.addMesh("boxes", {&still, 1})});
    return writer;
}

GltfWriter buildCrowdScene(int count, bool walk) {
    constexpr float kCellHeight = 1.95f; // metres; a row's heads stay below the next row's feet
    constexpr float kCellWidth = 1.15f;
    count = std::clamp(count, 0, kMaxBodyCount);
    GltfWriter writer("crowd");
    // As many rows as fill a 16:9 picture with that many cells.
    const int rows = std::max(
        1,
        static_cast<int>(std::ceil(
            std::sqrt(static_cast<float>(count) * kCellWidth / kCellHeight * 9.0f / 16.0f)
        ))
    );
    const int columns = (count + rows - 1) / rows;
    const float depth = kCellHeight * static_cast<float>(rows) / (2.0f * halfView(1.0f).y);
    addStage(writer);
    addObject(
        writer,
        {.name = "wall", .translation = {0.0f, 0.0f, -depth - 2.0f}},
        sheet(halfView(depth + 2.0f) * 1.1f, 1.12f),
        addTextured(writer, "bricks", bricks(), 0.95f)
    );
    std::array<Index, 2> meshes{};
    if (count > 0)
        meshes = {
            addFigureMesh(writer, "walker", {0.75f, 0.25f, 0.15f}, {0.25f, 0.32f, 0.55f}),
            addFigureMesh(writer, "stroller", {0.20f, 0.45f, 0.25f}, {0.45f, 0.40f, 0.35f})};
    for (int i = 0; i < count; ++i) {
        const vec2 cell(static_cast<float>(i % columns), static_cast<float>(i / columns));
        const vec2 from = vec2(columns, rows) / 2.0f;
        const float side = hash(i, 0, 5) < 0.5f ? -1.0f : 1.0f;
        const float speed =
            walk ? glm::length(kScalingShot.velocityFor({6.0f + 4.0f * hash(i, 1, 5), 0.0f}, depth))
                 : 0.0f;
        NodeDesc place{
            .name = fmt::format("walker_{}", i + 1),
            .translation = {
                (cell.x + 0.5f - from.x) * kCellWidth,
                (cell.y - from.y) * kCellHeight + 0.1f,
                -depth - 0.3f * hash(i, 2, 5)}};
        if (walk)
            place.linearVelocity = kX * (side * speed);
        const Index walker = writer.addNode(place);
        const Figure figure = addFigure(
            writer,
            meshes[static_cast<size_t>(i) % meshes.size()],
            {.name = fmt::format("person_{}", i + 1),
             .parent = walker,
             .rotation = turned(side * glm::half_pi<float>(), kY)}
        );
        if (walk)
            addGait(
                writer,
                writer.addClip(fmt::format("gait_{}", i + 1)),
                figure,
                {.strideSeconds = 1.5f / speed, .phase = hash(i, 3, 5)},
                -0.25f,
                0.25f
            );
    }
    return writer;
}

GltfWriter buildCrowdScene(int count) {
    return buildCrowdScene(count, true);
}

GltfWriter buildTrianglesScene(int count) {
    count = std::clamp(count, kMinTriangleCount, kMaxTriangleCount);
    GltfWriter writer("triangles");
    addStage(writer);
    // Half in the mover, 4 r (r - 1); the relief takes the rest, 2 per cell.
    const int ringCount = static_cast<int>(std::lround(std::sqrt(count / 8.0 + 0.25) + 0.5));
    const int left = count - 4 * ringCount * (ringCount - 1);
    const vec2 half = halfView(kWallDepth) * 1.15f;
    const int rowCount = static_cast<int>(std::lround(std::sqrt(left / 2.0 * half.y / half.x)));
    const int columnCount = static_cast<int>(std::lround(left / 2.0 / rowCount));
    addObject(
        writer,
        {.name = "wall", .translation = {0.0f, 0.0f, -kWallDepth}},
        relief(half, columnCount, rowCount),
        addTextured(writer, "bricks", bricks(), 0.95f)
    );
    Shape mover = withUvScale(pumpkin(0.8f, ringCount), {4.0f, 2.0f});
    smoothNormals(mover);
    addObject(
        writer,
        {.name = "mover",
         .translation = {0.0f, 0.0f, -kMoverDepth},
         .linearVelocity = kScalingShot.velocityFor({32.0f, 10.0f}, kMoverDepth)},
        mover,
        addTextured(writer, "chevrons", chevrons(), 0.7f)
    );
    return writer;
}

GltfWriter buildMovingShareScene(float share) {
    constexpr int kColumns = 8;
    constexpr int kRows = 5;
    share = share > 0.0f ? std::min(share, 1.0f) : 0.0f; // written so that NaN becomes 0
    GltfWriter writer("moving_share");
    addStage(writer);
    addFlatWall(writer);
    if (share == 0.0f) {
        return writer;
    }
    const vec2 half = halfView(kMoverDepth);
    const vec2 cell = 2.0f * half / vec2(kColumns, kRows);
    const MeshPart part{
        .shape = sheet(cell / 2.0f * vec2(share, 1.0f), 0.6f),
        .material = addTextured(writer, "chevrons", chevrons(), 0.7f)};
    const Index mesh = writer.addMesh("panel", {&part, 1});
    for (int i = 0; i < kColumns * kRows; ++i) {
        const int column = i % kColumns;
        const int row = i / kColumns;
        // Each has another place in its cell, so that rounding to pixels averages out.
        const float slack = (1.0f - share) * (hash(column, row, 11) - 0.5f);
        const vec2 place = -half + cell * (vec2(column, row) + vec2(0.5f + slack, 0.5f));
        writer.addNode(
            {.name = fmt::format("panel_{}", i + 1),
             .translation = {place, -kMoverDepth},
             .mesh = mesh,
             .linearVelocity =
                 kScalingShot.velocityFor({row % 2 == 0 ? 24.0f : -24.0f, 0.0f}, kMoverDepth)}
        );
    }
    return writer;
}

GltfWriter buildMovingRegionScene(int columns, int rows) {
    constexpr float kPanelShare = 0.88f; // of a cell's sides: farther apart than they move
    constexpr float kMotionPx = 8.0f;
    columns = std::clamp(columns, 0, kPanelColumns);
    rows = std::clamp(rows, 0, kPanelRows);
    GltfWriter writer("moving_region");
    addStage(writer);
    addFlatWall(writer);
    const vec2 half = halfView(kMoverDepth);
    const vec2 cell = 2.0f * half / vec2(kPanelColumns, kPanelRows);
    const MeshPart part{
        .shape = sheet(cell / 2.0f * kPanelShare, 0.6f),
        .material = addTextured(writer, "chevrons", chevrons(), 0.7f)};
    const Index mesh = writer.addMesh("panel", {&part, 1});
    for (int row = 0; row < kPanelRows; ++row)
        for (int column = 0; column < kPanelColumns; ++column) {
            NodeDesc panel{
                .name = fmt::format("panel_{}_{}", column + 1, row + 1),
                .translation = {-half + cell * (vec2(column, row) + 0.5f), -kMoverDepth},
                .mesh = mesh};
            if (column < columns && row < rows)
                panel.linearVelocity = kScalingShot.velocityFor(
                    {row % 2 == 0 ? kMotionPx : -kMotionPx, 0.0f}, kMoverDepth
                );
            writer.addNode(panel);
        }
    return writer;
}

} // namespace shutter::generator
