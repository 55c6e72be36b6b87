// SPDX-License-Identifier: MIT
#include "modules/motion_blur/instant_buffer.h"

#include "engine/gpu/vulkan.h"

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
    VkDeviceSize movers = 0;
    VkDeviceSize motions = 0;
};

PlacedLayer place(Layout& layout, const math::LayerTables& tables) {
    return {&tables, layout.add(tables.movers), layout.add(tables.motions)};
}

shader::LayerMotion write(gpu::Buffer& buffer, const PlacedLayer& layer) {
    buffer.write(std::span<const uint32_t>(layer.tables->movers), layer.movers);
    buffer.write(std::span<const shader::InstantMotion>(layer.tables->motions), layer.motions);
    return {
        gpu::splitAddress(buffer.address() + layer.movers),
        gpu::splitAddress(buffer.address() + layer.motions),
        static_cast<uint32_t>(layer.tables->movers.size() - 1),
        layer.tables->isStill ? 1u : 0u};
}

} // namespace

VkDeviceAddress
writeInstantLayers(gpu::Device& device, const math::InstantLayers& layers, gpu::Buffer& buffer) {
    Layout layout;
    std::vector<shader::InstantMotions> head(1);
    const VkDeviceSize headAt = layout.add(head);
    const VkDeviceSize times = layout.add(layers.times);
    const PlacedLayer raster = place(layout, layers.raster);
    std::optional<PlacedLayer> last;
    if (layers.last)
        last = place(layout, *layers.last);
    if (buffer.bytes() < layout.bytes())
        buffer = gpu::Buffer(
            device,
            "instant motions",
            layout.bytes() + layout.bytes() / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Upload
        );
    buffer.write(std::span<const float>(layers.times), times);
    head[0].raster = write(buffer, raster);
    if (last)
        head[0].last = write(buffer, *last);
    head[0].times = gpu::splitAddress(buffer.address() + times);
    head[0].isPerspective = layers.isPerspective ? 1 : 0;
    buffer.write(std::span<const shader::InstantMotions>(head), headAt);
    return buffer.address() + headAt;
}

} // namespace shutter::motion_blur
