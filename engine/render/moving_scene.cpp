// SPDX-License-Identifier: MIT
#include "engine/render/moving_scene.h"

#include "engine/graph/execute.h"
#include "engine/render/instances.h"

#include <span>
#include <vector>

namespace shutter::render {

namespace {

/// Tables one behind the other in one buffer.
class TableLayout {
  public:
    /// \return offset of a table of `bytes`
    VkDeviceSize reserve(VkDeviceSize bytes) {
        const VkDeviceSize at = mEnd;
        mEnd += (bytes + 255) / 256 * 256;
        return at;
    }

    [[nodiscard]] VkDeviceSize end() const { return mEnd; }

  private:
    VkDeviceSize mEnd = 0;
};

} // namespace

const std::vector<shader::Geometry>&
MovingScene::prepareShapes(const MovingTables& tables, const GpuScene& scene) {
    mShapes.update(tables.shapes, scene);
    return mShapes.rows();
}

std::vector<shader::MovingRow> MovingScene::makeRows(
    const MovingTables& tables,
    const ExtractedFrame& frame,
    const GpuScene& scene,
    uint32_t firstShapeGeometry
) const {
    std::vector<shader::MovingRow> rows(tables.rows.size());
    for (size_t i = 0; i < rows.size(); ++i) {
        rows[i].keyCount = static_cast<uint32_t>(tables.rows[i].keys.size());
        rows[i].firstGeometry = frame.entities[i].firstGeometry;
        rows[i].shapeKeyCount = 1;
        rows[i].handedness = 1.0f;
    }
    for (const uint32_t row : tables.moving)
        rows[row].meshScene = splitAddress(scene.meshScene(frame.entityMeshes[row]).address());
    for (size_t i = 0; i < tables.shapes.size(); ++i) {
        shader::MovingRow& row = rows[tables.shapes[i].row];
        row.firstGeometry = firstShapeGeometry + mShapes[i].firstRow;
        row.shapeKeyCount = mShapes[i].keyCount;
        row.meshScene = splitAddress(mShapes[i].scene);
        row.handedness = tables.shapes[i].mirrored ? -1.0f : 1.0f;
    }
    return rows;
}

VkDeviceAddress
MovingScene::upload(const MovingTables& tables, std::vector<shader::MovingRow> rows) {
    std::vector<shader::MotionKey> keys = tables.camera.keys;
    std::vector<size_t> firstKey;
    for (const MotionKeys& row : tables.rows) {
        firstKey.push_back(keys.size());
        keys.insert(keys.end(), row.keys.begin(), row.keys.end());
    }
    TableLayout layout;
    const VkDeviceSize constantsAt = layout.reserve(sizeof(shader::MovingConstants));
    const VkDeviceSize rowsAt = layout.reserve(tables.rows.size() * sizeof(shader::MovingRow));
    const VkDeviceSize boxesAt = layout.reserve(tables.moving.size() * sizeof(uint32_t));
    const VkDeviceSize keysAt = layout.reserve(keys.size() * sizeof(shader::MotionKey));
    const VkDeviceSize lightsAt = layout.reserve(tables.lights.size() * sizeof(shader::LightRow));
    if (mTables.bytes() < layout.end())
        mTables = gpu::Buffer(
            mDevice,
            "moving scene tables",
            layout.end() + layout.end() / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Upload
        );
    const VkDeviceAddress base = mTables.address();

    for (size_t i = 0; i < rows.size(); ++i)
        rows[i].keys = splitAddress(base + keysAt + firstKey[i] * sizeof(shader::MotionKey));

    shader::MovingConstants constants{};
    constants.view = tables.view;
    constants.rows = splitAddress(base + rowsAt);
    constants.boxes = splitAddress(base + boxesAt);
    constants.cameraKeys = splitAddress(base + keysAt);
    constants.lights = splitAddress(base + lightsAt);
    constants.cameraKeyCount = static_cast<uint32_t>(tables.camera.keys.size());
    constants.lightKeyCount = tables.lightKeyCount;
    constants.lightCount = static_cast<uint32_t>(tables.lights.size() / tables.lightKeyCount);
    mTables.writeBytes(&constants, sizeof(constants), constantsAt);
    mTables.write(std::span<const shader::MovingRow>(rows), rowsAt);
    mTables.write(std::span<const uint32_t>(tables.moving), boxesAt);
    mTables.write(std::span<const shader::MotionKey>(keys), keysAt);
    mTables.write(std::span<const shader::LightRow>(tables.lights), lightsAt);
    return base + constantsAt;
}

void MovingScene::declareBuilds(graph::Graph& graph, bool anyMoves, MovingRays& rays) {
    using graph::Access;

    struct Data {};

    graph::BufferHandle boxes;
    if (anyMoves) {
        const auto imported = graph.importBuffer("moving boxes", mBoxes.structure().buffer(), 0);
        graph.addPass<Data>(
            "build moving boxes",
            graph::PassKind::Build,
            [&](graph::PassBuilder& builder, Data&) {
                boxes = builder.write(imported, Access::AccelerationBuild);
            },
            [this](const Data&, graph::PassContext& context) {
                mBoxes.record(mDevice, context.commands);
            }
        );
    }
    const auto imported = graph.importBuffer("moving top level", mTopLevel.structure().buffer(), 0);
    graph.addPass<Data>(
        "build moving top level",
        graph::PassKind::Build,
        [&](graph::PassBuilder& builder, Data&) {
            // Built on the boxes: the second "build" of them orders the two, and writes nothing.
            if (boxes.isValid())
                boxes = builder.write(boxes, Access::AccelerationBuild);
            rays.topLevelBuffer = builder.write(imported, Access::AccelerationBuild);
        },
        [this](const Data&, graph::PassContext& context) {
            mTopLevel.record(mDevice, context.commands);
        }
    );
    rays.boxesBuffer = boxes;
}

std::vector<gpu::Instance> MovingScene::listInstances(
    const MovingTables& tables, const ExtractedFrame& frame, const GpuScene& scene
) {
    InstanceList instances(scene);
    size_t nextShape = 0;
    for (uint32_t row = 0; row < tables.rows.size(); ++row) {
        const std::vector<shader::MotionKey>& keys = tables.rows[row].keys;
        const bool bent = nextShape < tables.shapes.size() && tables.shapes[nextShape].row == row;
        const size_t shape = nextShape;
        nextShape += bent;
        if (keys.size() > 1)
            continue;
        if (!bent) {
            instances.add(row, frame.entityMeshes[row], keys[0].rows);
        } else if (!tables.shapes[shape].changes()) {
            const MovingShape& still = tables.shapes[shape];
            instances.add(
                BentInstance{row, still.mesh, still.mirrored, mShapes[shape].level, still.bounds},
                keys[0].rows
            );
        }
    }
    if (tables.moving.empty())
        return instances.order();

    std::vector<gpu::BoxGeometry> boxes;
    Box all = tables.boxes.front();
    for (const Box& box : tables.boxes) {
        boxes.push_back({{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}});
        all.min = glm::min(all.min, box.min);
        all.max = glm::max(all.max, box.max);
    }
    mBoxes.prepare(mDevice, boxes);
    gpu::Instance instance{};
    for (int i = 0; i < 3; ++i)
        instance.worldFromObject[i][i] = 1.0f;
    instance.bottomLevel = mBoxes.structure().address();
    instances.add(instance, all);
    return instances.order();
}

MovingRays MovingScene::declare(
    graph::Graph& graph,
    const MovingTables& tables,
    const ExtractedFrame& frame,
    GpuScene& scene,
    uint32_t firstShapeGeometry,
    VkDeviceAddress frameConstants
) {
    scene.buildBottomLevels();
    std::vector<bool> bent(tables.rows.size(), false);
    for (const MovingShape& shape : tables.shapes)
        bent[shape.row] = true;
    std::vector<uint32_t> meshes;
    for (const uint32_t row : tables.moving)
        if (!bent[row])
            meshes.push_back(frame.entityMeshes[row]);
    scene.buildMeshScenes(meshes);
    mTopLevel.prepare(mDevice, listInstances(tables, frame, scene));

    MovingRays rays;
    rays.topLevel = mTopLevel.structure().handle();
    rays.textures = scene.textureSet();
    rays.frameConstants = frameConstants;
    rays.movingConstants = upload(tables, makeRows(tables, frame, scene, firstShapeGeometry));
    declareBuilds(graph, !tables.moving.empty(), rays);
    return rays;
}

} // namespace shutter::render
