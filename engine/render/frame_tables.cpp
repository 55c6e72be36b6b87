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

/// A bit per row, for FrameConstants::layerRows; empty where none is taken.
std::vector<uint32_t> listBits(std::span<const uint32_t> taken, uint32_t rowCount) {
    std::vector<uint32_t> bits;
    if (taken.empty())
        return bits;
    bits.resize(rowCount / 32 + 1, 0u);
    for (const uint32_t row : taken)
        bits[row / 32] |= 1u << (row % 32);
    return bits;
}

/// Device addresses of a frame's tables; 0: there is none.
struct TableAddresses {
    VkDeviceAddress entities = 0;
    VkDeviceAddress entityMotions = 0;
    VkDeviceAddress lights = 0;
    VkDeviceAddress geometries = 0;
    VkDeviceAddress materials = 0;
    VkDeviceAddress layerRows = 0;
    VkDeviceAddress environment = 0;
    VkDeviceAddress shadows = 0;
    VkDeviceAddress movingTlas = 0;
};

/// The constants that shaders read.
/// \param ofView those of the extracted frame, which have no addresses
shader::FrameConstants composeConstants(
    const shader::FrameConstants& ofView, uint32_t entityCount, const TableAddresses& tables
) {
    shader::FrameConstants constants = ofView;
    constants.entityCount = entityCount;
    constants.entities = gpu::splitAddress(tables.entities);
    constants.entityMotions = gpu::splitAddress(tables.entityMotions);
    constants.lights = gpu::splitAddress(tables.lights);
    constants.geometries = gpu::splitAddress(tables.geometries);
    constants.materials = gpu::splitAddress(tables.materials);
    constants.layerRows = gpu::splitAddress(tables.layerRows);
    if ((constants.flags & shader::kFrameEnvironment) != 0)
        constants.environment = gpu::splitAddress(tables.environment);
    constants.shadows = gpu::splitAddress(tables.shadows);
    if (tables.shadows != 0)
        constants.flags |= shader::kFrameShadows;
    constants.movingTlas = gpu::splitAddress(tables.movingTlas);
    return constants;
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
    TableAddresses tables;
    tables.entities = mEntityTable.rows();
    tables.entityMotions = mEntityTable.motions();
    tables.lights = mBuffer.address() + lightsAt;
    tables.geometries = deformed.empty() ? scene.geometryTable() : mBuffer.address() + geometriesAt;
    tables.materials = scene.materialTable();
    tables.layerRows = layer.empty() ? 0 : mBuffer.address() + layerAt;
    tables.environment = scene.environment();
    tables.shadows = others.shadows;
    tables.movingTlas = others.movingTlas;
    const shader::FrameConstants constants =
        composeConstants(frame.constants, mEntityTable.rowCount(), tables);
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
