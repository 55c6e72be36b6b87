// SPDX-License-Identifier: MIT
#include "engine/render/shape_ways.h"

#include "spirv/render/shape_ways.frag.h"
#include "spirv/render/shape_ways.vert.h"

#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "shaders/common/pixel_way.glsl"

#include <optional>
#include <utility>

namespace shutter::render {

namespace {

using gpu_scene::PoseTable;

constexpr VkFormat kWayFormat = VK_FORMAT_R32G32_UINT;
/// vec4 that a shader::Vertex has: its place is the first.
constexpr uint32_t kVertexStride = sizeof(shader::Vertex) / sizeof(math::vec4);

gpu::GraphicsPipelineDesc describeWays() {
    gpu::GraphicsPipelineDesc desc;
    desc.name = "shape ways";
    desc.vertexSpirv = render_shape_ways_vert;
    desc.fragmentSpirv = render_shape_ways_frag;
    desc.interface.bindings = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
    desc.interface.pushConstantBytes = sizeof(shader::ShapeWayDraw);
    desc.colorFormats = {kWayFormat};
    return desc;
}

/// Geometries of a mesh, and what of them may be seen in a surface.
template <class Visit>
void forEachGeometry(const extract::SceneLayout& layout, uint32_t mesh, const Visit& visit) {
    const uint32_t first = layout.firstGeometry[mesh];
    for (uint32_t geometry = first; geometry < layout.firstGeometry[mesh + 1]; ++geometry)
        visit(geometry, geometry - first);
}

uint64_t countVertices(const extract::SceneLayout& layout, uint32_t mesh) {
    uint64_t count = 0;
    forEachGeometry(layout, mesh, [&](uint32_t geometry, uint32_t) {
        count += layout.geometries[geometry].vertexCount;
    });
    return count;
}

} // namespace

/// Lays out the shapes of one frame, and what draws them.
class ShapeWays::Planner {
  public:
    Planner(
        ShapeWays& ways,
        const ShapedFrame& now,
        const std::vector<scene::Deformation>& middles,
        std::span<const ShapeWayLayer> layers,
        const gpu_scene::GpuScene& scene
    )
        : mWays(ways), mNow(now), mMiddles(middles), mLayers(layers), mScene(scene),
          mLayout(scene.layout()), mMiddleOf(now.frame->deformed.size()) {}

    /// \return positions that the frame needs
    uint64_t placeShapes() {
        for (const ShapeWayLayer& layer : mLayers) {
            std::vector<Made>& kept = mKept.emplace_back();
            for (const extract::ShapeWay& way : layer.ways) {
                if (changes(way.shape) && !mMiddleOf[way.shape])
                    mMiddleOf[way.shape] = make(mMiddles.at(way.shape), way.mesh);
                kept.push_back(
                    layer.record ? make(layer.record->shapes.at(way.pose).pose, way.mesh) : Made{}
                );
            }
        }
        return mPositions;
    }

    /// placeShapes() came before, and mPositions has room.
    shader::DeformBatch listJobs() {
        mPoses.upload(mWays.mDevice, mWays.mPoses);
        gpu_scene::DeformJobs jobs;
        for (const Shape& shape : mShapes) {
            VkDeviceAddress at = addressOf(shape.made);
            forEachGeometry(mLayout, shape.mesh, [&](uint32_t geometry, uint32_t) {
                shader::DeformJob job = mPoses.makeJob(mScene, geometry, shape.pose);
                job.output_ = gpu::splitAddress(at);
                job.positionsOnly = 1;
                jobs.add(job, 1);
                at += uint64_t{job.vertexCount} * sizeof(math::vec4);
            });
        }
        jobs.upload(mWays.mDevice, mWays.mJobs);
        return jobs.batch();
    }

    void listDraws(VkDeviceAddress rows) {
        for (size_t i = 0; i < mLayers.size(); ++i) {
            Layer& layer = mWays.mLayers.emplace_back();
            if (mLayers[i].raster.shapes)
                layer.rasterShapes = mLayers[i].raster.shapes->buffer;
            for (size_t j = 0; j < mLayers[i].ways.size(); ++j) {
                addDraws(mLayers[i], mLayers[i].ways[j], mKept[i][j], rows, layer.draws);
                rows += sizeof(shader::ShapeWayRow);
            }
        }
    }

  private:
    /// Positions of all geometries of a mesh, one behind the other.
    struct Made {
        uint64_t first = 0;
    };

    struct Shape {
        PoseTable::Place pose;
        uint32_t mesh = 0;
        Made made;
    };

    [[nodiscard]] bool changes(uint32_t shape) const { return mNow.frame->deformed[shape].changes; }

    Made make(const scene::Deformation& pose, uint32_t mesh) {
        const Made made{mPositions};
        mShapes.push_back({mPoses.add(pose), mesh, made});
        mPositions += countVertices(mLayout, mesh);
        return made;
    }

    [[nodiscard]] VkDeviceAddress addressOf(const Made& made) const {
        return mWays.mPositions.address() + made.first * sizeof(math::vec4);
    }

    /// A frame's deformed geometry.
    [[nodiscard]] const shader::Geometry&
    rowOf(const ShapedFrame& frame, uint32_t shape, uint32_t index) const {
        const uint32_t first =
            frame.frame->entities[frame.frame->deformed[shape].row].firstGeometry;
        return frame.shapes->rows.at(first - mScene.geometryRows().size() + index);
    }

    void addDraws(
        const ShapeWayLayer& layer,
        const extract::ShapeWay& way,
        const Made& kept,
        VkDeviceAddress row,
        std::vector<Draw>& draws
    ) const {
        uint64_t before = 0; // vertices of the mesh's geometries
        forEachGeometry(mLayout, way.mesh, [&](uint32_t geometry, uint32_t index) {
            const extract::SceneLayout::GeometryInfo& info = mLayout.geometries[geometry];
            const uint64_t offset = std::exchange(before, before + info.vertexCount);
            // Blended surfaces are not in the raster.
            if (info.alphaMode == scene::AlphaMode::Blend || info.indexCount == 0)
                return;
            Draw draw{geometry, {}};
            draw.push.row = gpu::splitAddress(row);
            draw.push.key = way.row;
            draw.push.leastQ = mNow.frame->constants.forward.w;
            exposeDraw(rowOf(mNow, way.shape, index), way.shape, offset, draw.push);
            if (layer.record) {
                draw.push.rasterPositions =
                    gpu::splitAddress(addressOf(kept) + offset * sizeof(math::vec4));
                draw.push.rasterStride = 1;
            } else {
                draw.push.rasterPositions = rowOf(layer.raster, way.pose, index).vertices;
                draw.push.rasterStride = kVertexStride;
            }
            draws.push_back(draw);
        });
    }

    void exposeDraw(
        const shader::Geometry& now, uint32_t shape, uint64_t offset, shader::ShapeWayDraw& push
    ) const {
        if (changes(shape)) {
            push.openPositions = now.openPositions;
            push.middlePositions =
                gpu::splitAddress(addressOf(*mMiddleOf[shape]) + offset * sizeof(math::vec4));
            push.closePositions = now.closePositions;
            push.exposureStride = 1;
            return;
        }
        push.openPositions = push.middlePositions = push.closePositions = now.vertices;
        push.exposureStride = kVertexStride;
    }

    ShapeWays& mWays;
    const ShapedFrame& mNow;
    const std::vector<scene::Deformation>& mMiddles;
    std::span<const ShapeWayLayer> mLayers;
    const gpu_scene::GpuScene& mScene;
    const extract::SceneLayout& mLayout;
    std::vector<std::optional<Made>> mMiddleOf; ///< by shape
    std::vector<std::vector<Made>> mKept;       ///< by layer and way: shapes at kept rasters
    std::vector<Shape> mShapes;
    PoseTable mPoses;
    uint64_t mPositions = 0;
};

ShapeWays::ShapeWays(gpu::Device& device) : mDevice(device), mDeformer(device) {}

void ShapeWays::declareShapes(
    graph::Graph& graph,
    const ShapedFrame& now,
    const std::vector<scene::Deformation>& middles,
    std::span<const ShapeWayLayer> layers,
    const gpu_scene::GpuScene& scene
) {
    mLayers.clear();
    mShapes = {};
    mExposedShapes = now.shapes->buffer;
    if (!mPipeline.handle())
        mPipeline = gpu::Pipeline(mDevice, describeWays());
    Planner planner(*this, now, middles, layers, scene);
    const uint64_t bytes = planner.placeShapes() * sizeof(math::vec4);
    if (bytes > 0 && (!mPositions || mPositions.bytes() < bytes))
        mPositions = gpu::Buffer(
            mDevice,
            "shapes of ways",
            bytes + bytes / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Device
        );
    std::vector<shader::ShapeWayRow> rows;
    for (const ShapeWayLayer& layer : layers)
        for (const extract::ShapeWay& way : layer.ways)
            rows.push_back(way.maps);
    const uint64_t rowBytes = rows.size() * sizeof(shader::ShapeWayRow);
    if (!mRows || mRows.bytes() < rowBytes)
        mRows = gpu::Buffer(
            mDevice,
            "rows of ways",
            rowBytes + rowBytes / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
    mRows.write(std::span<const shader::ShapeWayRow>(rows));
    if (bytes > 0) {
        const shader::DeformBatch batch = planner.listJobs();
        const auto imported = graph.importBuffer("shapes of ways", mPositions.handle(), bytes);

        struct Data {};

        graph.addPass<Data>(
            "deform for ways",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data&) {
                mShapes = builder.write(imported, graph::Access::StorageWrite);
            },
            [this, batch](const Data&, graph::PassContext& context) {
                mDeformer.deform(context.commands, batch);
            }
        );
    }
    planner.listDraws(mRows.address());
}

graph::ImageHandle ShapeWays::declareLayer(
    graph::Graph& graph,
    size_t layer,
    graph::ImageHandle surface,
    uint32_t keyMask,
    const gpu_scene::GpuScene& scene
) {
    Layer& own = mLayers.at(layer);
    for (Draw& draw : own.draws)
        draw.push.keyMask = keyMask;
    const graph::TransientImageDesc& size = graph.resources().at(surface.resource).imageDesc;
    const auto image = graph.createImage("ways", {size.width, size.height, kWayFormat});

    struct Data {
        graph::ImageHandle ways;
    };

    return graph
        .addPass<Data>(
            "draw ways",
            graph::PassKind::Raster,
            [&](graph::PassBuilder& builder, Data& data) {
                for (const graph::BufferHandle buffer : {mShapes, mExposedShapes, own.rasterShapes})
                    if (buffer.isValid())
                        builder.read(buffer, graph::Access::ShaderRead);
                builder.read(surface, graph::Access::SampledFragment);
                data.ways = builder.colorTarget(image, graph::ClearColor::uints(shader::kNoWay));
            },
            [this, &own, &scene, surface](const Data&, graph::PassContext& context) {
                gpu::BindingList bindings;
                bindings.sampled(context.resources.view(surface), mDevice.nearestSampler());
                const VkCommandBuffer commands = context.commands;
                vkCmdBindIndexBuffer(commands, scene.indexBuffer(), 0, VK_INDEX_TYPE_UINT32);
                // Surfaces that the raster does not show are rejected by depth.
                vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
                vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
                bool isBound = false;
                for (const Draw& draw : own.draws) {
                    if (!std::exchange(isBound, true))
                        context.frame.bind(mPipeline, bindings, &draw.push, sizeof(draw.push));
                    vkCmdPushConstants(
                        commands,
                        mPipeline.layout(),
                        mPipeline.stages(),
                        0,
                        sizeof(draw.push),
                        &draw.push
                    );
                    const auto& info = scene.layout().geometries[draw.geometry];
                    vkCmdDrawIndexed(commands, info.indexCount, 1, info.firstIndex, 0, 0);
                }
            }
        )
        .ways;
}

} // namespace shutter::render
