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

/// A bit per row, for FrameConstants::takenRows; empty where none is taken.
std::vector<uint32_t> listBits(std::span<const uint32_t> taken, uint32_t rowCount) {
    std::vector<uint32_t> bits;
    if (taken.empty())
        return bits;
    bits.resize(rowCount / 32 + 1, 0u);
    for (const uint32_t row : taken)
        bits[row / 32] |= 1u << (row % 32);
    return bits;
}

} // namespace

FrameTables::Addresses FrameTables::upload(
    const extract::ExtractedFrame& frame,
    const extract::ViewRequest& view,
    const gpu_scene::GpuScene& scene,
    const Others& others
) {
    const std::span<const shader::Geometry> deformed = others.deformed;
    const std::span<const shader::Geometry> own = scene.geometryRows();
    const VkDeviceSize lightsAt = alignTable(sizeof(shader::FrameConstants));
    const VkDeviceSize lightBytes = frame.lights.size() * sizeof(shader::LightRow);
    const VkDeviceSize responseAt = lightsAt + alignTable(lightBytes);
    const VkDeviceSize geometriesAt = responseAt + alignTable(sizeof(shader::ResponseTable));
    const VkDeviceSize geometryBytes =
        deformed.empty() ? 0 : (own.size() + deformed.size()) * sizeof(shader::Geometry);
    const VkDeviceSize layerAt = geometriesAt + alignTable(geometryBytes);
    const std::vector<uint32_t> layer = listBits(others.taken, mEntityTable.rowCount());
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
    shader::FrameConstants constants = frame.constants; // which have no addresses
    constants.entityCount = mEntityTable.rowCount();
    constants.entities = gpu::splitAddress(mEntityTable.rows());
    constants.entityMotions = gpu::splitAddress(mEntityTable.motions());
    constants.lights = gpu::splitAddress(mBuffer.address() + lightsAt);
    constants.geometries = gpu::splitAddress(
        deformed.empty() ? scene.geometryTable() : mBuffer.address() + geometriesAt
    );
    constants.takenRows = gpu::splitAddress(layer.empty() ? 0 : mBuffer.address() + layerAt);
    constants.materials = gpu::splitAddress(scene.materialTable());
    if ((constants.flags & shader::kFrameEnvironment) != 0)
        constants.environment = gpu::splitAddress(scene.environment());
    for (size_t slot = 0; slot < others.slots.size(); ++slot)
        constants.slots[slot] = gpu::splitAddress(others.slots[slot]);
    constants.movingTlas = gpu::splitAddress(others.movingTlas);
    mBuffer.writeBytes(&constants, sizeof(constants), 0);
    mBuffer.write(std::span<const shader::LightRow>(frame.lights), lightsAt);
    mBuffer.write(std::span<const uint32_t>(layer), layerAt);
    if (response)
        mBuffer.writeBytes(&*response, sizeof(*response), responseAt);
    if (!deformed.empty()) {
        mBuffer.write(own, geometriesAt);
        mBuffer.write(deformed, geometriesAt + own.size_bytes());
    }
    return {mBuffer.address(), constants, response ? mBuffer.address() + responseAt : 0};
}

} // namespace shutter::render
