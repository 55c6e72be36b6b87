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

VkDeviceAddress MovingScene::upload(
    const MovingTables& tables, const ExtractedFrame& frame, const GpuScene& scene
) {
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

    std::vector<shader::MovingRow> rows(tables.rows.size());
    for (size_t i = 0; i < rows.size(); ++i) {
        rows[i].keys = splitAddress(base + keysAt + firstKey[i] * sizeof(shader::MotionKey));
        rows[i].keyCount = static_cast<uint32_t>(tables.rows[i].keys.size());
        rows[i].firstGeometry = frame.entities[i].firstGeometry;
    }
    for (const uint32_t row : tables.moving)
        rows[row].meshScene = splitAddress(scene.meshScene(frame.entityMeshes[row]).address());

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

MovingRays MovingScene::declare(
    graph::Graph& graph,
    const MovingTables& tables,
    const ExtractedFrame& frame,
    GpuScene& scene,
    VkDeviceAddress frameConstants
) {
    scene.buildBottomLevels();
    std::vector<uint32_t> meshes;
    for (const uint32_t row : tables.moving)
        meshes.push_back(frame.entityMeshes[row]);
    scene.buildMeshScenes(meshes);

    InstanceList instances(scene);
    for (uint32_t row = 0; row < tables.rows.size(); ++row)
        if (tables.rows[row].keys.size() == 1)
            instances.add(row, frame.entityMeshes[row], tables.rows[row].keys[0].rows);
    const bool anyMoves = !tables.moving.empty();
    if (anyMoves) {
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
    }
    mTopLevel.prepare(mDevice, instances.order());

    MovingRays rays;
    rays.topLevel = mTopLevel.structure().handle();
    rays.textures = scene.textureSet();
    rays.frameConstants = frameConstants;
    rays.movingConstants = upload(tables, frame, scene);
    declareBuilds(graph, anyMoves, rays);
    return rays;
}

} // namespace shutter::render
