// SPDX-License-Identifier: MIT
// Per-frame buffers for drawing, in addition to the scene's: the entity table, constants, lights,
// geometries of deformed meshes, and the shutter's response.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/gpu_scene/entity_table.h"
#include "engine/gpu_scene/gpu_scene.h"

#include <span>

namespace shutter::render {

/// One for each raster of a frame in flight: the GPU must have finished the frame that it was last
/// uploaded for.
class FrameTables {
  public:
    explicit FrameTables(gpu::Device& device) : mDevice(device), mEntityTable(device) {}

    struct Addresses {
        VkDeviceAddress constants = 0; ///< shader::FrameConstants
        VkDeviceAddress response = 0; ///< shader::ResponseTable; 0: the shutter's response is a box
    };

    /// Writes the rows that changed.
    gpu_scene::EntityTable::Written updateEntities(const extract::ExtractedFrame& frame) {
        return mEntityTable.update(frame);
    }

    /// Writes everything else; updateEntities() comes first.
    /// \param frame its constants get the addresses of the tables
    /// \param deformed geometries that follow the scene's own
    Addresses upload(
        extract::ExtractedFrame& frame,
        const extract::ViewRequest& view,
        const gpu_scene::GpuScene& scene,
        std::span<const shader::Geometry> deformed
    );

  private:
    gpu::Device& mDevice;
    gpu_scene::EntityTable mEntityTable;
    gpu::Buffer mBuffer; ///< mapped
};

} // namespace shutter::render
