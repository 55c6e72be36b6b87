// SPDX-License-Identifier: MIT
#include "modules/taa/static_layer.h"

#include "engine/core/check.h"
#include "engine/extract/deformed_entity.h"
#include "engine/gpu/vulkan.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

namespace shutter::taa {

namespace {

gpu::ImageDesc describeImage(const render::ViewFacts& facts, VkFormat format) {
    gpu::ImageDesc desc;
    desc.width = facts.width;
    desc.height = facts.height;
    desc.format = format;
    desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT; // for those who want to see it
    return desc;
}

bool hasSameBytes(std::span<const shader::LightRow> a, std::span<const shader::LightRow> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

/// Blended surfaces of the raster write no id: a moving one cannot be distinguished from the
/// surface behind it.
/// \param rests by row
bool hasPassers(const render::ExtractContext& context, const std::vector<bool>& rests) {
    const extract::ExtractedFrame& frame = context.frame;
    const auto& blended = frame.blended.moving;
    return context.rasterHasOverlays ||
           std::any_of(blended.begin(), blended.end(), [&](const extract::DrawItem& item) {
               return !rests[item.entity] && !extract::isTaken(context.takenRows, item.entity);
           });
}

/// For each row of a record the index of its shape, or kNoRow.
std::vector<uint32_t> listShapes(const extract::RasterRecord& record) {
    std::vector<uint32_t> shapes(record.entities.size(), extract::kNoRow);
    for (uint32_t i = 0; i < record.shapes.size(); ++i)
        shapes[record.shapes[i].row] = i;
    return shapes;
}

} // namespace

StaticLayer::Record StaticLayer::makeRecord(const render::ExtractContext& context) {
    const extract::ExtractedFrame& frame = context.frame;
    Record record;
    record.raster = extract::makeRasterRecord(
        context.world, context.view, context.motion, frame, context.view.exposure.rasterTime
    );
    record.raster.taken = extract::listEntities(frame, context.takenRows);
    record.meshes = frame.entityMeshes;
    record.rests = frame.atRest;
    record.lights = frame.lights;
    record.background = frame.constants.background;
    record.ambient = frame.constants.ambient;
    record.flags = frame.constants.flags;
    record.hasShading = context.hasShading;
    record.shadingRevision = context.shadingRevision;
    record.mayReach = context.hasShading || !frame.blended.still.empty();
    return record;
}

void StaticLayer::compare(const Record& now, const Record& last) {
    mFrame.mayDiffer = last.hasPassers || now.background != last.background ||
                       now.ambient != last.ambient || now.flags != last.flags ||
                       now.hasShading != last.hasShading || now.raster.taken != last.raster.taken ||
                       now.shadingRevision != last.shadingRevision ||
                       !hasSameBytes(now.lights, last.lights);
    bool changes = false; // something came, went, started or stopped
    const std::vector<uint32_t> nowRows = extract::findRows(last.raster, now.raster.entities);
    const std::vector<uint32_t> nowShapes = listShapes(now.raster);
    const std::vector<uint32_t> lastShapes = listShapes(last.raster);
    const auto hasSameShape = [&](size_t before, uint32_t current) {
        const uint32_t a = lastShapes[before];
        const uint32_t b = nowShapes[current];
        return a == extract::kNoRow || b == extract::kNoRow
                   ? a == b
                   : extract::isSame(last.raster.shapes[a].pose, now.raster.shapes[b].pose);
    };
    for (size_t row = 0; row < nowRows.size(); ++row) {
        if (!last.rests[row])
            continue;
        const uint32_t current = nowRows[row];
        if (current != extract::kNoRow && now.rests[current] &&
            last.raster.worldFromObject[row] == now.raster.worldFromObject[current] &&
            last.meshes[row] == now.meshes[current] && hasSameShape(row, current)) {
            mNowRows[row] = current;
            mStates[current] = shader::kStaticRow;
        } else {
            changes = true;
        }
    }
    mNowRows.back() = uint32_t(now.rests.size()); // the sky's
    changes =
        changes || std::find(mStates.begin(), mStates.end(), shader::kNewRow) != mStates.end();
    // Otherwise it shows in pixels of its own alone, which have no history then.
    mFrame.mayDiffer = mFrame.mayDiffer || (changes && (now.mayReach || last.mayReach));
}

void StaticLayer::extract(const render::ExtractContext& context) {
    mFrame = {};
    if (!context.frame.isCameraAtRest) {
        mRecord.reset();
        return;
    }
    Record now = makeRecord(context);
    const bool isAfter = mRecord && mRecord->raster.seconds <= now.raster.seconds;
    mHasLast = isAfter && now.raster.unjitteredFromWorld == mRecord->raster.unjitteredFromWorld &&
               extract::showsTheSame(context.world, context.view, context.motion, mRecord->raster);
    mStates.clear();
    for (const bool rests : now.rests)
        mStates.push_back(rests ? shader::kNewRow : shader::kMovingRow);
    mStates.push_back(shader::kStaticRow); // the sky
    mNowRows.assign(mRecord ? mRecord->rests.size() + 1 : 1, extract::kNoRow);
    if (mHasLast)
        compare(now, *mRecord);
    now.hasPassers = hasPassers(context, now.rests);
    mFrame.mayDiffer = mFrame.mayDiffer || now.hasPassers;
    mRecord = std::move(now);
}

StaticLayer::Frame StaticLayer::turn(const render::PictureContext& context) {
    SHUTTER_CHECK(isGathering(), "nothing is static before a camera that moves");
    Frame frame = mFrame;
    frame.hasLast = mHasLast;
    frame.rows = writeRows(mBuffers.at(context.slot));
    const auto make = [&](gpu::Image& image, const char* name, VkFormat format) {
        const gpu::ImageDesc desc = describeImage(context.facts, format);
        if (image.handle() && image.desc() == desc)
            return;
        image = gpu::Image(mDevice, name, desc);
        frame.hasLast = false;
    };
    make(mImages.color, "static colour", VK_FORMAT_R32G32B32A32_SINT);
    make(mImages.row, "static row", VK_FORMAT_R32_UINT);
    frame.images = &mImages;
    return frame;
}

shader::StaticRows StaticLayer::writeRows(gpu::Buffer& buffer) const {
    const std::span<const uint32_t> states(mStates);
    const std::span<const uint32_t> nowRows(mNowRows);
    const VkDeviceSize bytes = states.size_bytes() + nowRows.size_bytes();
    if (buffer.bytes() < bytes)
        buffer = gpu::Buffer(
            mDevice,
            "static rows",
            bytes + bytes / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
    buffer.write(states, 0);
    buffer.write(nowRows, states.size_bytes());
    return {
        gpu::splitAddress(buffer.address()),
        gpu::splitAddress(buffer.address() + states.size_bytes()),
        static_cast<uint32_t>(states.size() - 1),
        static_cast<uint32_t>(nowRows.size() - 1)};
}

void StaticLayer::forget() {
    mRecord.reset();
    mImages = {};
    mBuffers = {};
}

} // namespace shutter::taa
