// SPDX-License-Identifier: MIT
// The entity table and the table of motions on the device, of which only what changed is written.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/instance_masks.h"
#include "engine/extract/timed_tables.h"
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::gpu_scene {

/// One per frame in flight: the GPU must have finished the frame that it was last updated for. It
/// stores that frame's revision, and writes all rows of a frame that does not follow it.
class EntityTable {
  public:
    explicit EntityTable(gpu::Device& device) : mDevice(device) {}

    /// Counts of written rows, for statistics.
    struct Written {
        uint64_t rows = 0;
        uint64_t motions = 0;
    };

    /// \param masks of the frame's rows; null: no ray reads masks, and rows keep theirs
    /// \param extra rows of this frame only, behind its own
    Written update(
        const extract::ExtractedFrame& frame,
        const std::vector<extract::RowMask>* masks = nullptr,
        std::span<const extract::ExtraRow> extra = {}
    );

    [[nodiscard]] uint32_t rowCount() const { return mRowCount; }

    [[nodiscard]] VkDeviceAddress rows() const { return mRows.address(); }

    [[nodiscard]] VkDeviceAddress motions() const { return mMotions.address(); }

  private:
    /// True if it was recreated: then its contents are undefined.
    bool fit(gpu::Buffer& buffer, const char* name, VkDeviceSize bytes);

    void writeRow(const extract::ExtractedFrame& frame, uint32_t row);

    gpu::Device& mDevice;
    gpu::Buffer mRows;
    uint32_t mRowCount = 0;
    std::vector<extract::RowMask> mMasks; ///< of the rows in mRows
    gpu::Buffer mMotions;
    uint64_t mRevision = 0;      ///< RowChanges::revision of what mRows holds
    uint64_t mStillRevision = 0; ///< ExtractedFrame's, of the start of mMotions
};

} // namespace shutter::gpu_scene
