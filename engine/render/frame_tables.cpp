// SPDX-License-Identifier: MIT
#include "engine/render/frame_tables.h"

#include "engine/gpu/vulkan.h"
#include "engine/scene/shutter.h"

#include <span>
#include <vector>

namespace shutter::render {

namespace {

VkDeviceSize alignTable(VkDeviceSize bytes) {
    return (bytes + 255) / 256 * 256;
}

/// FrameConstants::layerRows; empty where it has none.
std::vector<uint32_t> listLayerBits(const extract::ExtractedFrame& frame) {
    std::vector<uint32_t> bits;
    if (frame.layerRows.empty())
        return bits;
    bits.resize(frame.entities.size() / 32 + 1, 0u);
    for (const uint32_t row : frame.layerRows)
        bits[row / 32] |= 1u << (row % 32);
    return bits;
}

} // namespace

FrameTables::Addresses FrameTables::upload(
    extract::ExtractedFrame& frame,
    const extract::ViewRequest& view,
    const gpu_scene::GpuScene& scene,
    std::span<const shader::Geometry> deformed
) {
    const std::span<const shader::Geometry> own = scene.geometryRows();
    const VkDeviceSize lightsAt = alignTable(sizeof(shader::FrameConstants));
    const VkDeviceSize lightBytes = frame.lights.size() * sizeof(shader::LightRow);
    const VkDeviceSize responseAt = lightsAt + alignTable(lightBytes);
    const VkDeviceSize geometriesAt = responseAt + alignTable(sizeof(shader::ResponseTable));
    const VkDeviceSize geometryBytes =
        deformed.empty() ? 0 : (own.size() + deformed.size()) * sizeof(shader::Geometry);
    const VkDeviceSize layerAt = geometriesAt + alignTable(geometryBytes);
    const std::vector<uint32_t> layer = listLayerBits(frame);
    const VkDeviceSize total = layerAt + layer.size() * sizeof(uint32_t);
    const auto response = scene::computeLightTable(view.exposure);
    if (mBuffer.bytes() < total)
        mBuffer = gpu::Buffer(
            mDevice,
            "frame tables",
            total + total / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
    frame.constants.entityCount = static_cast<uint32_t>(frame.entities.size());
    frame.constants.entities = gpu::splitAddress(mEntityTable.rows());
    frame.constants.entityMotions = gpu::splitAddress(mEntityTable.motions());
    frame.constants.lights = gpu::splitAddress(mBuffer.address() + lightsAt);
    frame.constants.geometries = gpu::splitAddress(
        deformed.empty() ? scene.geometryTable() : mBuffer.address() + geometriesAt
    );
    frame.constants.layerRows =
        layer.empty() ? math::uvec2(0) : gpu::splitAddress(mBuffer.address() + layerAt);
    frame.constants.materials = gpu::splitAddress(scene.materialTable());
    if ((frame.constants.flags & shader::kFrameEnvironment) != 0)
        frame.constants.environment = gpu::splitAddress(scene.environment());
    mBuffer.writeBytes(&frame.constants, sizeof(frame.constants), 0);
    mBuffer.write(std::span<const shader::LightRow>(frame.lights), lightsAt);
    mBuffer.write(std::span<const uint32_t>(layer), layerAt);
    if (response)
        mBuffer.writeBytes(&*response, sizeof(*response), responseAt);
    if (!deformed.empty()) {
        mBuffer.write(own, geometriesAt);
        mBuffer.write(deformed, geometriesAt + own.size_bytes());
    }
    return {mBuffer.address(), response ? mBuffer.address() + responseAt : 0};
}

} // namespace shutter::render
