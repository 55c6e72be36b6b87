// SPDX-License-Identifier: MIT
#include "modules/motion_blur/instant_motions.h"

#include "engine/gpu/vulkan.h"
#include "shaders/motion_blur/resolved_shared.h"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace shutter::motion_blur {

namespace {

constexpr VkDeviceSize kAlignment = 16;

/// Lays tables out one behind the other in one buffer.
class Layout {
  public:
    template <class T> VkDeviceSize add(const std::vector<T>& table) {
        const VkDeviceSize at = mBytes;
        mBytes += (table.size() * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
        return at;
    }

    [[nodiscard]] VkDeviceSize bytes() const { return mBytes; }

  private:
    VkDeviceSize mBytes = 0;
};

struct PlacedLayer {
    const math::LayerTables* tables = nullptr;
    std::vector<float> parallaxesByRow;
    VkDeviceSize movers = 0;
    VkDeviceSize motions = 0;
    VkDeviceSize rasterRows = 0;
    VkDeviceSize parallaxes = 0;
};

PlacedLayer place(
    Layout& layout,
    const math::LayerTables& tables,
    const math::InstantLayers& exposure,
    glm::uvec2 sizePx
) {
    PlacedLayer placed{&tables, math::findParallaxes(tables, exposure, sizePx)};
    placed.movers = layout.add(tables.movers);
    placed.motions = layout.add(tables.motions);
    placed.rasterRows = layout.add(tables.rasterRows);
    placed.parallaxes = layout.add(placed.parallaxesByRow);
    return placed;
}

shader::LayerMotion write(gpu::Buffer& buffer, const PlacedLayer& layer) {
    buffer.write(std::span<const uint32_t>(layer.tables->movers), layer.movers);
    buffer.write(std::span<const shader::InstantMotion>(layer.tables->motions), layer.motions);
    buffer.write(std::span<const float>(layer.parallaxesByRow), layer.parallaxes);
    return {
        gpu::splitAddress(buffer.address() + layer.movers),
        gpu::splitAddress(buffer.address() + layer.motions),
        static_cast<uint32_t>(layer.tables->movers.size() - 1),
        layer.tables->isStatic ? 1u : 0u,
        gpu::splitAddress(buffer.address() + layer.parallaxes)};
}

glm::uvec2 writeRasterRows(gpu::Buffer& buffer, const PlacedLayer& layer) {
    buffer.write(std::span<const uint32_t>(layer.tables->rasterRows), layer.rasterRows);
    return gpu::splitAddress(buffer.address() + layer.rasterRows);
}

/// Whether more rows, including the sky's, or deforming parts may be candidates than a list holds.
bool mayCrowd(const math::LayerTables& layer) {
    if (layer.deforms)
        return true;
    uint32_t count = 0;
    for (const uint32_t mover : layer.movers) {
        const bool isFixed = mover == shader::kWorldMover || mover == shader::kSkyMover;
        if (mover != shader::kNoMover && !(layer.isStatic && isFixed))
            ++count;
        if (count > shader::kCandidatesPerTile)
            return true;
    }
    return false;
}

/// Whether a surface's depth decides how far it moves.
bool moves(const PlacedLayer& layer) {
    return std::any_of(
        layer.parallaxesByRow.begin(),
        layer.parallaxesByRow.end(),
        [](float parallax) { return parallax > 0.0f; }
    );
}

bool hasSize(const gpu::Image& image, glm::uvec2 sizePx) {
    return image.handle() && image.desc().width == sizePx.x && image.desc().height == sizePx.y;
}

} // namespace

WrittenLayers writeInstantLayers(
    gpu::Device& device, const math::InstantLayers& layers, glm::uvec2 sizePx, gpu::Buffer& buffer
) {
    Layout layout;
    std::vector<shader::InstantMotions> head(1);
    const VkDeviceSize headAt = layout.add(head);
    const VkDeviceSize times = layout.add(layers.times);
    const VkDeviceSize lens = layout.add(layers.lens);
    const VkDeviceSize lensReaches = layout.add(layers.lensReaches);
    const VkDeviceSize lensPlaces = layout.add(layers.lensPlaces);
    const PlacedLayer raster = place(layout, layers.raster, layers, sizePx);
    std::optional<PlacedLayer> second;
    if (layers.second)
        second = place(layout, *layers.second, layers, sizePx);
    std::optional<PlacedLayer> last;
    if (layers.last)
        last = place(layout, *layers.last, layers, sizePx);
    if (buffer.bytes() < layout.bytes())
        buffer = gpu::Buffer(
            device,
            "instant motions",
            layout.bytes() + layout.bytes() / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
    buffer.write(std::span<const float>(layers.times), times);
    head[0].raster = write(buffer, raster);
    if (second) {
        head[0].second = write(buffer, *second);
        head[0].secondRows = writeRasterRows(buffer, *second);
    }
    if (last) {
        head[0].last = write(buffer, *last);
        head[0].lastRows = writeRasterRows(buffer, *last);
    }
    head[0].times = gpu::splitAddress(buffer.address() + times);
    if (!layers.lens.empty()) {
        buffer.write(std::span<const glm::vec4>(layers.lens), lens);
        head[0].lens = gpu::splitAddress(buffer.address() + lens);
        buffer.write(std::span<const shader::LensReach>(layers.lensReaches), lensReaches);
        head[0].lensReaches = gpu::splitAddress(buffer.address() + lensReaches);
        buffer.write(std::span<const glm::vec2>(layers.lensPlaces), lensPlaces);
        head[0].lensPlaces = gpu::splitAddress(buffer.address() + lensPlaces);
    }
    head[0].confusion = layers.confusion;
    head[0].aperture = layers.aperture;
    head[0].isPerspective = layers.isPerspective ? 1 : 0;
    buffer.write(std::span<const shader::InstantMotions>(head), headAt);
    const bool mayHide = moves(raster) || (second && moves(*second)) || (last && moves(*last));
    return {buffer.address() + headAt, mayHide};
}

bool mayCrowdTiles(const math::InstantLayers& layers) {
    return mayCrowd(layers.raster) || (layers.second && mayCrowd(*layers.second)) ||
           (layers.last && mayCrowd(*layers.last));
}

bool RasterHistory::holds(glm::uvec2 sizePx) const {
    return mHasContents.at(mNewest) && hasSize(newest().color, sizePx);
}

const RasterHistory::Raster& RasterHistory::turn(glm::uvec2 sizePx) {
    mNewest = 1 - mNewest;
    mHasContents.at(mNewest) = true;
    Raster& raster = mRasters.at(mNewest);
    if (hasSize(raster.color, sizePx))
        return raster;
    gpu::ImageDesc desc;
    desc.width = sizePx.x;
    desc.height = sizePx.y;
    // Written by a pass or a transfer (SurfaceLayers), and read back by those who want to see it.
    desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    desc.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    raster.color = gpu::Image(mDevice, "kept colour", desc);
    desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    desc.format = VK_FORMAT_R32G32_UINT;
    raster.surface = gpu::Image(mDevice, "kept surface", desc);
    return raster;
}

void RasterHistory::fillPlaceholders(glm::uvec2 sizePx) {
    // A handle of nothing: transfers alone need no view of it.
    const auto image = reinterpret_cast<VkImage>(uintptr_t{1});
    gpu::ImageDesc desc{sizePx.x, sizePx.y, VK_FORMAT_R16G16B16A16_SFLOAT};
    desc.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    for (Raster& raster : mRasters) {
        desc.format = VK_FORMAT_R16G16B16A16_SFLOAT;
        raster.color = gpu::Image::adopt(mDevice, "kept colour", image, desc);
        desc.format = VK_FORMAT_R32G32_UINT;
        raster.surface = gpu::Image::adopt(mDevice, "kept surface", image, desc);
    }
    mHasContents = {true, true};
}

void RasterHistory::forget() {
    mRasters = {};
    mHasContents = {};
}

uint64_t RasterHistory::bytes() const {
    uint64_t bytes = 0;
    for (const Raster& raster : mRasters)
        for (const gpu::Image* image : {&raster.color, &raster.surface})
            if (image->handle())
                bytes += uint64_t(image->desc().width) * image->desc().height *
                         gpu::texelBytes(image->desc().format);
    return bytes;
}

} // namespace shutter::motion_blur
