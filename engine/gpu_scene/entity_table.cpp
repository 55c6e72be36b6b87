// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/entity_table.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

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

void EntityTable::writeRow(const extract::ExtractedFrame& frame, uint32_t row) {
    EntityRow masked = frame.entities[row];
    masked.instanceMask = extract::maskOf(mMasks, row);
    mRows.writeBytes(&masked, sizeof(masked), row * sizeof(EntityRow));
}

EntityTable::Written EntityTable::update(
    const extract::ExtractedFrame& frame,
    const std::vector<extract::RowMask>* masks,
    std::span<const extract::ExtraRow> extra
) {
    Written written;
    const std::span<const EntityRow> rows = frame.entities;
    const extract::RowChanges& changes = frame.changes;
    mRowCount = static_cast<uint32_t>(rows.size() + extra.size());
    const bool renewed = fit(mRows, "entity table", mRowCount * sizeof(EntityRow));
    const bool follows = !renewed && !changes.all && changes.since == mRevision;
    std::vector<extract::RowMask> before;
    if (masks != nullptr)
        before = std::exchange(mMasks, *masks);
    if (follows) {
        for (const uint32_t row : changes.rows)
            writeRow(frame, row);
        written.rows = changes.rows.size();
        const auto writeIfChanged = [&](uint32_t row) {
            if (extract::maskOf(before, row) == extract::maskOf(mMasks, row))
                return;
            writeRow(frame, row);
            ++written.rows;
        };
        if (masks != nullptr) {
            for (const extract::RowMask& mask : mMasks)
                writeIfChanged(mask.row);
            for (const extract::RowMask& mask : before)
                if (extract::maskOf(mMasks, mask.row) == 0)
                    writeIfChanged(mask.row);
        }
    } else {
        if (masks == nullptr)
            mMasks.clear(); // rows may be other entities'
        mRows.write(rows);
        for (const extract::RowMask& mask : mMasks)
            writeRow(frame, mask.row);
        written.rows = rows.size();
    }
    std::vector<EntityRow> behind;
    for (const extract::ExtraRow& one : extra)
        behind.push_back(one.row);
    mRows.write(std::span<const EntityRow>(behind), rows.size_bytes());
    written.rows += behind.size();
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
