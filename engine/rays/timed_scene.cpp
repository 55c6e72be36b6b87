// SPDX-License-Identifier: MIT
#include "engine/rays/timed_scene.h"

#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "engine/rays/instances.h"

#include <span>
#include <vector>

namespace shutter::rays {

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
TimedScene::prepareDeformed(const extract::TimedTables& tables, const gpu_scene::GpuScene& scene) {
    mShapes.update(tables.shapes, scene);
    return mShapes.rows();
}

std::vector<shader::TimedRow> TimedScene::makeRows(
    const extract::TimedTables& tables,
    const extract::ExtractedFrame& frame,
    const gpu_scene::GpuScene& scene,
    uint32_t firstDeformedGeometry
) const {
    std::vector<shader::TimedRow> rows(tables.rows.size());
    for (size_t i = 0; i < rows.size(); ++i) {
        rows[i].keyCount = static_cast<uint32_t>(tables.rows[i].keys.size());
        rows[i].firstGeometry = tables.findRow(frame, i).row.firstGeometry;
        rows[i].deformationKeyCount = 1;
        rows[i].handedness = 1.0f;
    }
    for (const uint32_t row : tables.moving)
        rows[row].meshScene =
            gpu::splitAddress(scene.meshScene(tables.findRow(frame, row).mesh).address());
    for (size_t i = 0; i < tables.shapes.size(); ++i) {
        shader::TimedRow& row = rows[tables.shapes[i].row];
        row.firstGeometry = firstDeformedGeometry + mShapes[i].firstRow;
        row.deformationKeyCount = mShapes[i].keyCount;
        row.meshScene = gpu::splitAddress(mShapes[i].scene);
        row.handedness = tables.shapes[i].mirrored ? -1.0f : 1.0f;
    }
    return rows;
}

VkDeviceAddress
TimedScene::upload(const extract::TimedTables& tables, std::vector<shader::TimedRow> rows) {
    std::vector<shader::MotionKey> keys = tables.camera.keys;
    std::vector<size_t> firstKey;
    for (const extract::MotionKeys& row : tables.rows) {
        firstKey.push_back(keys.size());
        keys.insert(keys.end(), row.keys.begin(), row.keys.end());
    }
    TableLayout layout;
    const VkDeviceSize constantsAt = layout.reserve(sizeof(shader::TimedConstants));
    const VkDeviceSize rowsAt = layout.reserve(tables.rows.size() * sizeof(shader::TimedRow));
    const VkDeviceSize boxesAt = layout.reserve(tables.moving.size() * sizeof(uint32_t));
    const VkDeviceSize keysAt = layout.reserve(keys.size() * sizeof(shader::MotionKey));
    const VkDeviceSize lightsAt = layout.reserve(tables.lights.size() * sizeof(shader::LightRow));
    const VkDeviceSize lensAt = layout.reserve(tables.lens.size() * sizeof(shader::LensKey));
    if (mTables.bytes() < layout.end())
        mTables = gpu::Buffer(
            mDevice,
            "timed scene tables",
            layout.end() + layout.end() / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
    const VkDeviceAddress base = mTables.address();

    for (size_t i = 0; i < rows.size(); ++i)
        rows[i].keys = gpu::splitAddress(base + keysAt + firstKey[i] * sizeof(shader::MotionKey));

    shader::TimedConstants constants{};
    constants.view = tables.view;
    constants.rows = gpu::splitAddress(base + rowsAt);
    constants.boxes = gpu::splitAddress(base + boxesAt);
    constants.cameraKeys = gpu::splitAddress(base + keysAt);
    constants.lights = gpu::splitAddress(base + lightsAt);
    constants.cameraKeyCount = static_cast<uint32_t>(tables.camera.keys.size());
    constants.lightKeyCount = tables.lightKeyCount;
    constants.lightCount = static_cast<uint32_t>(tables.lights.size() / tables.lightKeyCount);
    constants.lensKeyCount = static_cast<uint32_t>(tables.lens.size());
    constants.lensKeys = gpu::splitAddress(base + lensAt);
    constants.aperture = tables.aperture;
    constants.jitterPx = tables.jitterPx;
    mTables.writeBytes(&constants, sizeof(constants), constantsAt);
    mTables.write(std::span<const shader::TimedRow>(rows), rowsAt);
    mTables.write(std::span<const uint32_t>(tables.moving), boxesAt);
    mTables.write(std::span<const shader::MotionKey>(keys), keysAt);
    mTables.write(std::span<const shader::LightRow>(tables.lights), lightsAt);
    mTables.write(std::span<const shader::LensKey>(tables.lens), lensAt);
    return base + constantsAt;
}

void TimedScene::declareBuilds(graph::Graph& graph, bool anyMoves, graph::TimedRays& rays) {
    using graph::Access;

    struct Data {};

    graph::BufferHandle boxes;
    if (anyMoves) {
        const auto imported = graph.importBuffer("swept boxes", mBoxes.structure().buffer(), 0);
        graph.addPass<Data>(
            "build swept boxes",
            graph::PassKind::Build,
            [&](graph::PassBuilder& builder, Data&) {
                boxes = builder.write(imported, Access::AccelerationBuild);
            },
            [this](const Data&, graph::PassContext& context) {
                mBoxes.record(mDevice, context.commands);
            }
        );
    }
    const auto imported = graph.importBuffer("timed TLAS", mTlas.structure().buffer(), 0);
    graph.addPass<Data>(
        "build timed TLAS",
        graph::PassKind::Build,
        [&](graph::PassBuilder& builder, Data&) {
            // Built on the boxes: the second "build" of them orders the two, and writes nothing.
            if (boxes.isValid())
                boxes = builder.write(boxes, Access::AccelerationBuild);
            rays.tlasBuffer = builder.write(imported, Access::AccelerationBuild);
        },
        [this](const Data&, graph::PassContext& context) {
            mTlas.record(mDevice, context.commands);
        }
    );
    rays.boxesBuffer = boxes;
}

std::vector<gpu::Instance> TimedScene::listInstances(
    const extract::TimedTables& tables,
    const extract::ExtractedFrame& frame,
    const gpu_scene::GpuScene& scene
) {
    InstanceList instances(scene);
    size_t nextShape = 0;
    for (uint32_t row = 0; row < tables.rows.size(); ++row) {
        const std::vector<shader::MotionKey>& keys = tables.rows[row].keys;
        const bool deformed =
            nextShape < tables.shapes.size() && tables.shapes[nextShape].row == row;
        const size_t shape = nextShape;
        nextShape += deformed;
        if (keys.size() > 1)
            continue;
        if (!deformed) {
            instances.add(row, tables.findRow(frame, row).mesh, keys[0].rows);
        } else if (!tables.shapes[shape].changes()) {
            const extract::TimedDeformation& still = tables.shapes[shape];
            instances.add(
                DeformedInstance{
                    row, still.mesh, still.mirrored, mShapes[shape].level, still.bounds},
                keys[0].rows
            );
        }
    }
    if (tables.moving.empty())
        return instances.order();

    std::vector<gpu::BoxGeometry> boxes;
    extract::Box all = tables.boxes.front();
    for (const extract::Box& box : tables.boxes) {
        boxes.push_back({{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}});
        all.min = glm::min(all.min, box.min);
        all.max = glm::max(all.max, box.max);
    }
    mBoxes.prepare(mDevice, boxes);
    gpu::Instance instance{};
    for (int i = 0; i < 3; ++i)
        instance.worldFromObject[i][i] = 1.0f;
    instance.blas = mBoxes.structure().address();
    instances.add(instance, all);
    return instances.order();
}

graph::TimedRays TimedScene::declare(
    graph::Graph& graph,
    const extract::TimedTables& tables,
    const extract::ExtractedFrame& frame,
    gpu_scene::GpuScene& scene,
    uint32_t firstDeformedGeometry,
    VkDeviceAddress frameConstants
) {
    scene.buildAllBlas();
    std::vector<bool> deformed(tables.rows.size(), false);
    for (const extract::TimedDeformation& shape : tables.shapes)
        deformed[shape.row] = true;
    std::vector<uint32_t> meshes;
    for (const uint32_t row : tables.moving)
        if (!deformed[row])
            meshes.push_back(tables.findRow(frame, row).mesh);
    scene.buildMeshScenes(meshes);
    mTlas.prepare(mDevice, listInstances(tables, frame, scene));

    graph::TimedRays rays;
    rays.tlas = mTlas.structure().handle();
    rays.textures = scene.textureSet();
    rays.frameConstants = frameConstants;
    rays.timedConstants = upload(tables, makeRows(tables, frame, scene, firstDeformedGeometry));
    declareBuilds(graph, !tables.moving.empty(), rays);
    return rays;
}

} // namespace shutter::rays
