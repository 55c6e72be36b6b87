// SPDX-License-Identifier: MIT
// Per-frame buffers for drawing, in addition to the scene's: the entity table, constants, lights,
// geometries of deformed meshes, and the shutter's response.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/gpu_scene/entity_table.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/render/shading_feature.h"

#include <span>

namespace shutter::render {

/// One for each raster of a frame in flight: the GPU must have finished the frame that it was last
/// uploaded for.
class FrameTables {
  public:
    explicit FrameTables(gpu::Device& device) : mDevice(device), mEntityTable(device) {}

    struct Addresses {
        VkDeviceAddress constants = 0;           ///< shader::FrameConstants
        shader::FrameConstants constantValues{}; ///< at that address
        VkDeviceAddress response = 0; ///< shader::ResponseTable; 0: the shutter's response is a box
    };

    /// What others made for the frame.
    struct Others {
        std::span<const uint32_t> taken;            ///< FrameConstants::takenRows
        std::span<const shader::Geometry> deformed; ///< geometries that follow the scene's own
        ShadingSlots slots{};                       ///< FrameConstants::slots
        VkDeviceAddress movingTlas = 0; ///< FrameConstants::movingTlas; 0: there is none
    };

    /// The rows of the frame's entities (EntityTable).
    [[nodiscard]] gpu_scene::EntityTable& entities() { return mEntityTable; }

    /// Writes everything else; the frame's rows come first.
    Addresses upload(
        const extract::ExtractedFrame& frame,
        const extract::ViewRequest& view,
        const gpu_scene::GpuScene& scene,
        const Others& others
    );

  private:
    gpu::Device& mDevice;
    gpu_scene::EntityTable mEntityTable;
    gpu::Buffer mBuffer; ///< mapped
};

} // namespace shutter::render
