// SPDX-License-Identifier: MIT
#include "modules/shadows/shadow_maps.h"

#include "spirv/shadows/shadow_map.frag.h"
#include "spirv/shadows/shadow_map.vert.h"

#include "engine/core/words.h"
#include "engine/extract/extracted_frame.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

namespace shutter::shadows {

namespace {

constexpr VkFormat kShadowFormat = VK_FORMAT_D32_SFLOAT;
/// Width of the image that maps are drawn into, unless one map is wider.
constexpr uint32_t kImageWidth = 4096;
/// Width of one that needs no more. Images are kept for other frames by their size, and maps and
/// layers are of many: two widths, and heights that are powers of two from `kMinImageHeight`,
/// leave few.
constexpr uint32_t kSmallImageWidth = 1024;
constexpr uint32_t kMinImageHeight = 256;
/// Images that are kept for other frames.
constexpr size_t kMaxImages = 4;

gpu::GraphicsPipelineDesc describeCasters(const gpu_scene::GpuScene& scene, bool masked) {
    gpu::GraphicsPipelineDesc desc;
    desc.name = "shadow map";
    desc.vertexSpirv = shadows_shadow_map_vert;
    desc.fragmentSpirv = shadows_shadow_map_frag;
    desc.interface.pushConstantBytes = sizeof(shader::ShadowDraw);
    desc.interface.sceneLayout = scene.textureLayout();
    desc.specialization = {masked};
    desc.depthFormat = kShadowFormat;
    return desc;
}

VkDeviceSize alignShadowTable(VkDeviceSize bytes) {
    return (bytes + 255) / 256 * 256;
}

/// Appends tables to one mapped buffer.
class TableWriter {
  public:
    template <class Row> size_t add(const std::vector<Row>& rows) {
        return addBytes(rows.data(), rows.size() * sizeof(Row));
    }

    size_t addBytes(const void* data, size_t bytes) {
        const size_t at = mBytes.size();
        mBytes.resize(at + alignShadowTable(bytes));
        if (bytes > 0)
            std::memcpy(mBytes.data() + at, data, bytes);
        return at;
    }

    [[nodiscard]] std::vector<std::byte>& bytes() { return mBytes; }

  private:
    std::vector<std::byte> mBytes;
};

// Each map has both rows; the light's kind selects the one that is read.
shader::ShadowMap makeRow(const PlannedMap& map, const math::dvec3& eye) {
    shader::ShadowMap row{};
    row.clipFromRelWorld =
        math::mat4(map.view.clipFromWorld * glm::translate(math::dmat4(1.0), eye));
    row.firstTexel = map.firstTexel;
    row.sizePx = map.sizePx;
    row.texelMetres = float(map.view.texelMetres);
    return row;
}

shader::ShadowCascade makeCascade(const PlannedMap& map, const math::dvec3& eye) {
    const math::dmat4 clip = map.view.clipFromWorld * glm::translate(math::dmat4(1.0), eye);
    const double half = 0.5 * map.sizePx;
    const double rounding = 1.0 + double(shader::kDepthScaleRounding);
    shader::ShadowCascade row{};
    row.corner = math::vec2(half * (clip[3].x + 1.0), half * (clip[3].y + 1.0));
    row.texelsPerMetre = float(1.0 / map.view.texelMetres);
    row.depthPerMetre = float(rounding * glm::length(math::dvec3(clip[0].z, clip[1].z, clip[2].z)));
    row.depth = float(rounding * clip[3].z + double(shader::kDepthRounding));
    row.firstTexel = map.firstTexel;
    row.sizePx = map.sizePx;
    return row;
}

/// Records the draws of one map after another.
class ShadowRecorder {
  public:
    ShadowRecorder(
        graph::PassContext& context,
        const ShadowPipelines& pipelines,
        const extract::ExtractedFrame& frame,
        const gpu_scene::GpuScene& scene,
        VkDeviceAddress constants
    )
        : mContext(context), mPipelines(pipelines), mFrame(frame), mScene(scene),
          mConstants(gpu::splitAddress(constants)) {
        vkCmdBindIndexBuffer(mContext.commands, scene.indexBuffer(), 0, VK_INDEX_TYPE_UINT32);
    }

    /// \param shapeShift ShadowDraw's, of all that is drawn
    void begin(const LightView& view, const VkRect2D& place, float shapeShift) {
        VkViewport viewport{};
        viewport.x = float(place.offset.x);
        viewport.y = float(place.offset.y);
        viewport.width = float(place.extent.width);
        viewport.height = float(place.extent.height);
        viewport.maxDepth = 1.0f;
        vkCmdSetViewport(mContext.commands, 0, 1, &viewport);
        vkCmdSetScissor(mContext.commands, 0, 1, &place);
        mView = &view;
        mShapeShift = shapeShift;
    }

    void draw(uint32_t row) {
        const math::dmat4 clipFromObject = mView->clipFromWorld * mFrame.worldFromObject[row];
        const extract::SceneLayout& layout = mScene.layout();
        if (extract::isOutsideView(clipFromObject, extract::findRowBounds(mFrame, layout, row)))
            return;
        shader::ShadowDraw push{math::mat4(clipFromObject), mConstants, 0, mShapeShift};
        const uint32_t mesh = mFrame.entityMeshes[row];
        const uint32_t first = layout.firstGeometry[mesh];
        for (uint32_t i = first; i < layout.firstGeometry[mesh + 1]; ++i) {
            const extract::SceneLayout::GeometryInfo& info = layout.geometries[i];
            if (info.alphaMode == scene::AlphaMode::Blend)
                continue;
            const gpu::Pipeline& pipeline =
                info.alphaMode == scene::AlphaMode::Mask ? mPipelines.masked : mPipelines.solid;
            bind(pipeline);
            push.geometry = mFrame.entities[row].firstGeometry + i - first;
            vkCmdPushConstants(
                mContext.commands, pipeline.layout(), pipeline.stages(), 0, sizeof(push), &push
            );
            vkCmdDrawIndexed(mContext.commands, info.indexCount, 1, info.firstIndex, 0, 0);
        }
    }

  private:
    void bind(const gpu::Pipeline& pipeline) {
        if (std::exchange(mBound, &pipeline) == &pipeline)
            return;
        mContext.frame.bind(pipeline, {}, nullptr, 0, mScene.textureSet());
        // Both sides of a surface hold light back.
        vkCmdSetCullMode(mContext.commands, VK_CULL_MODE_NONE);
        vkCmdSetFrontFace(mContext.commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    }

    graph::PassContext& mContext;
    const ShadowPipelines& mPipelines;
    const extract::ExtractedFrame& mFrame;
    const gpu_scene::GpuScene& mScene;
    math::uvec2 mConstants;
    const LightView* mView = nullptr;
    float mShapeShift = 0.0f;
    const gpu::Pipeline* mBound = nullptr;
};

/// Layers that there is room for as soon as there is one.
constexpr uint64_t kMinLayers = 16;

/// Texels of the plan's maps, with spare room for layers: each time the buffer is recreated for a
/// new mover, all maps are drawn again.
uint64_t countRoom(const ShadowPlan& plan) {
    uint64_t layers = 0;
    uint64_t largest = 0;
    for (size_t i = plan.lightMapCount; i < plan.maps.size(); ++i) {
        const uint32_t side = plan.maps[i].sizePx;
        const uint64_t texels = uint64_t{shader::shadowRowTexels(side)} * side;
        layers += texels;
        largest = std::max(largest, texels);
    }
    if (layers == 0)
        return plan.texelCount;
    return plan.texelCount - layers + std::bit_ceil(std::max(layers, kMinLayers * largest));
}

} // namespace

ShadowPipelines::ShadowPipelines(gpu::Device& device, const gpu_scene::GpuScene& scene)
    : solid(device, describeCasters(scene, false)), masked(device, describeCasters(scene, true)) {}

core::Status ShadowMaps::prepare(ShadowPlan plan) {
    mPlan = std::move(plan);
    SHUTTER_TRY(checkFit());
    if (mTexels.bytes() < mPlan.texelCount * sizeof(float)) {
        mTexels = gpu::Buffer(
            mDevice,
            "shadow maps",
            countRoom(mPlan) * sizeof(float),
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Device
        );
        mKept.clear();
    }
    std::vector<shader::ShadowMap> maps;
    std::vector<shader::ShadowCascade> cascades;
    for (const PlannedMap& map : mPlan.maps) {
        maps.push_back(makeRow(map, mPlan.eye));
        cascades.push_back(makeCascade(map, mPlan.eye));
    }
    shader::ShadowConstants constants{};
    TableWriter writer;
    (void)writer.addBytes(&constants, sizeof(constants));
    const size_t lightsAt = writer.add(mPlan.lights);
    const size_t mapsAt = writer.add(maps);
    const size_t cascadesAt = writer.add(cascades);
    const size_t moversAt = writer.add(mPlan.movers);
    const size_t instantsAt = writer.add(mPlan.instants);
    const size_t runsAt = writer.add(mPlan.runs);
    mTilesAt = writer.add(mPlan.tiles);
    if (mTables.bytes() < writer.bytes().size())
        mTables = gpu::Buffer(
            mDevice,
            "shadow tables",
            writer.bytes().size() * 3 / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
    const auto addressOf = [&](size_t at) { return gpu::splitAddress(mTables.address() + at); };
    constants.texels = gpu::splitAddress(mTexels.address());
    constants.lights = addressOf(lightsAt);
    constants.maps = addressOf(mapsAt);
    constants.cascades = addressOf(cascadesAt);
    constants.movers = addressOf(moversAt);
    constants.instants = addressOf(instantsAt);
    constants.runs = addressOf(runsAt);
    constants.lightCount = static_cast<uint32_t>(mPlan.lights.size());
    constants.moverCount = static_cast<uint32_t>(mPlan.movers.size());
    constants.instantCount = mPlan.instantCount;
    std::memcpy(writer.bytes().data(), &constants, sizeof(constants));
    mTables.writeBytes(writer.bytes().data(), writer.bytes().size(), 0);
    return {};
}

ShadowMaps::Kept ShadowMaps::describe(const PlannedMap& map) const {
    return {map.view.clipFromWorld, map.sizePx, map.firstTexel, mPlan.casterRevision};
}

VkExtent2D ShadowMaps::placeMaps() {
    mDrawn.clear();
    mKept.resize(mPlan.lightMapCount);
    for (uint32_t i = 0; i < mPlan.maps.size(); ++i)
        if (i >= mPlan.lightMapCount || mKept[i] != describe(mPlan.maps[i]))
            mDrawn.push_back({i, {}});
    return mDrawn.empty() ? VkExtent2D{} : placeDrawn();
}

core::Status ShadowMaps::checkFit() {
    // All maps count, although later frames draw few: a film is refused at its first frame.
    mDrawn.clear();
    uint32_t largest = 0;
    for (uint32_t i = 0; i < mPlan.maps.size(); ++i) {
        mDrawn.push_back({i, {}});
        largest = std::max(largest, mPlan.maps[i].sizePx);
    }
    const uint32_t most = mDevice.limits().maxImageDimension2D;
    const VkExtent2D size = placeDrawn();
    if (size.width <= most && size.height <= most)
        return {};
    return core::makeError(
        "shadows: {} of up to {} texels a side do not fit an image of {} x {}, the largest of the "
        "device: mapSize (--shadow-map-size) must be less",
        core::countOf(mDrawn.size(), "map"),
        largest,
        most,
        most
    );
}

VkExtent2D ShadowMaps::placeDrawn() {
    // Large maps, or many, need rows that are longer.
    const uint32_t most = mDevice.limits().maxImageDimension2D;
    uint32_t width = kImageWidth;
    VkExtent2D size = placeInRows(width);
    while (size.height > width && width < most)
        size = placeInRows(width = std::min(2 * width, most));
    size.width = size.width > kSmallImageWidth ? std::max(size.width, width) : kSmallImageWidth;
    const uint32_t rounded = std::bit_ceil(std::max(size.height, kMinImageHeight));
    size.height = std::max(size.height, std::min(rounded, most));
    return size;
}

VkExtent2D ShadowMaps::placeInRows(uint32_t width) {
    // As they come: lights' maps before the smaller layers.
    VkExtent2D size{};
    uint32_t x = 0;
    uint32_t y = 0;
    for (Drawn& drawn : mDrawn) {
        const uint32_t side = mPlan.maps[drawn.map].sizePx;
        if (x > 0 && x + side > width) {
            x = 0;
            y = size.height;
        }
        drawn.place = {{int32_t(x), int32_t(y)}, {side, side}};
        x += side;
        size.width = std::max(size.width, x);
        size.height = std::max(size.height, y + side);
    }
    return size;
}

const gpu::Image* ShadowMaps::prepareImage(VkExtent2D size) {
    if (size.width == 0)
        return nullptr;
    gpu::ImageDesc desc;
    desc.width = size.width;
    desc.height = size.height;
    desc.format = kShadowFormat;
    desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const auto found = std::find_if(mImages.begin(), mImages.end(), [&](const gpu::Image& image) {
        return image.desc() == desc;
    });
    if (found != mImages.end()) {
        std::rotate(found, found + 1, mImages.end()); // used last
    } else {
        if (mImages.size() == kMaxImages)
            mImages.erase(mImages.begin());
        mImages.emplace_back(mDevice, "shadow casters", desc);
    }
    return &mImages.back();
}

graph::BufferHandle ShadowMaps::declare(
    graph::Graph& graph,
    const ShadowPipelines& pipelines,
    const extract::ExtractedFrame& frame,
    const gpu_scene::GpuScene& scene,
    graph::BufferHandle shapes,
    VkDeviceAddress frameConstants
) {
    mDrawn.clear();
    const gpu::Image* target = prepareImage(placeMaps());
    graph::BufferHandle texels =
        graph.importBuffer("shadow maps", mTexels.handle(), mTexels.bytes());
    if (mDrawn.empty())
        return texels;
    const graph::ImageHandle image = graph.importImage(
        "shadow casters", *target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_UNDEFINED
    );

    struct Casters {
        graph::ImageHandle depth;
    };

    const Casters& casters = graph.addPass<Casters>(
        "shadow maps",
        graph::PassKind::Raster,
        [&](graph::PassBuilder& builder, Casters& data) {
            if (shapes.isValid())
                builder.read(shapes, graph::Access::ShaderRead);
            data.depth = builder.depthTarget(image, 0.0f);
        },
        [this, &pipelines, &frame, &scene, frameConstants](
            const Casters&, graph::PassContext& context
        ) {
            ShadowRecorder recorder(context, pipelines, frame, scene, frameConstants);
            for (const Drawn& drawn : mDrawn) {
                const PlannedMap& map = mPlan.maps[drawn.map];
                recorder.begin(map.view, drawn.place, map.shapeShift);
                if (map.mover != shader::kNoEntity)
                    recorder.draw(map.mover);
                else
                    for (const uint32_t row : mPlan.mapCasters)
                        recorder.draw(row);
            }
        }
    );

    struct Keep {
        graph::ImageHandle depth;
        graph::BufferHandle texels;
    };

    const Keep& keep = graph.addPass<Keep>(
        "keep shadow maps",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Keep& data) {
            data.depth = builder.read(casters.depth, graph::Access::TransferRead);
            data.texels = builder.write(texels, graph::Access::TransferWrite);
        },
        [this](const Keep& data, graph::PassContext& context) {
            std::vector<VkBufferImageCopy> copies;
            for (const Drawn& drawn : mDrawn) {
                const PlannedMap& map = mPlan.maps[drawn.map];
                VkBufferImageCopy copy{};
                copy.bufferOffset = VkDeviceSize{map.firstTexel} * sizeof(float);
                copy.bufferRowLength = shader::shadowRowTexels(map.sizePx);
                copy.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
                copy.imageOffset = {drawn.place.offset.x, drawn.place.offset.y, 0};
                copy.imageExtent = {map.sizePx, map.sizePx, 1};
                copies.push_back(copy);
                // Only recorded passes update the cache: a frame that reads no shadows has no such
                // pass.
                if (drawn.map < mPlan.lightMapCount)
                    mKept[drawn.map] = describe(map);
            }
            vkCmdCopyImageToBuffer(
                context.commands,
                context.resources.image(data.depth).handle(),
                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                context.resources.buffer(data.texels),
                static_cast<uint32_t>(copies.size()),
                copies.data()
            );
        }
    );
    return keep.texels;
}

} // namespace shutter::shadows
