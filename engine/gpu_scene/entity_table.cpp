// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/entity_table.h"

#include <algorithm>
#include <span>

namespace shutter::gpu_scene {

namespace {

using shader::EntityMotion;
using shader::EntityRow;

} // namespace

bool EntityTable::fit(gpu::Buffer& buffer, const char* name, VkDeviceSize bytes) {
    if (buffer && buffer.bytes() >= bytes)
        return false;
    buffer = gpu::Buffer(
        mDevice, name, bytes + bytes / 2, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Stream
    );
    return true;
}

EntityTable::Written EntityTable::update(const extract::ExtractedFrame& frame) {
    Written written;
    const std::span<const EntityRow> rows = frame.entities;
    const extract::RowChanges& changes = frame.changes;
    const bool renewed = fit(mRows, "entity table", rows.size_bytes());
    const bool follows = !renewed && !changes.all && changes.since == mRevision;
    if (follows) {
        for (const uint32_t row : changes.rows)
            mRows.write(rows.subspan(row, 1), row * sizeof(EntityRow));
        written.rows = changes.rows.size();
    }
    // Rows that others appended are of this frame only.
    const size_t first = follows ? changes.ownRows : 0;
    mRows.write(rows.subspan(first), first * sizeof(EntityRow));
    written.rows += rows.size() - first;
    mRevision = changes.revision;

    const std::span<const EntityMotion> still = frame.staticMotions;
    const std::span<const EntityMotion> moving = frame.movingMotions;
    const bool cleared = fit(mMotions, "entity motions", still.size_bytes() + moving.size_bytes());
    if (cleared || frame.staticRevision != mStillRevision) {
        mMotions.write(still);
        written.motions += still.size();
    }
    mMotions.write(moving, still.size_bytes());
    written.motions += moving.size();
    mStillRevision = frame.staticRevision;
    return written;
}

} // namespace shutter::gpu_scene
