// SPDX-License-Identifier: MIT
#include "modules/taa/static_layer.h"

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

/// Blended surfaces of the raster leave no id: what moves is not told from what is behind it.
/// \param rests by row
bool hasPassers(const render::ExtractContext& context, const std::vector<bool>& rests) {
    const extract::ExtractedFrame& frame = context.frame;
    const auto& blended = frame.blended.moving;
    return context.rasterHasParticles ||
           std::any_of(blended.begin(), blended.end(), [&](const extract::DrawItem& item) {
               return !rests[item.entity] && !frame.isInLayer(item.entity);
           });
}

/// \param picture picture space without jitter, from the world, at the raster instant
bool isHeld(const render::ExtractContext& context, const math::dmat4& picture) {
    extract::ViewRequest view = context.view;
    view.jitterPx = math::dvec2(0.0);
    const auto isThere = [&](double s) {
        return extract::pictureFromWorldAt(context.world, view, context.motion, s) == picture;
    };
    return isThere(0.0) && isThere(1.0);
}

} // namespace

StaticLayer::Record StaticLayer::makeRecord(const render::ExtractContext& context) {
    const extract::ExtractedFrame& frame = context.frame;
    Record record;
    record.raster = extract::makeRasterRecord(
        context.world, context.view, context.motion, frame, context.view.exposure.rasterTime
    );
    record.meshes = frame.entityMeshes;
    for (size_t row = 0; row < record.raster.entities.size(); ++row)
        record.rests.push_back(
            frame.entities[row].motion == shader::kNoMotion && !record.raster.deforms[row]
        );
    record.lights = frame.lights;
    record.background = frame.constants.background;
    record.ambient = frame.constants.ambient;
    record.flags = frame.constants.flags;
    return record;
}

void StaticLayer::compare(Record& now, const Record& last) {
    mFrame.mayDiffer = last.hasPassers || now.background != last.background ||
                       now.ambient != last.ambient || now.flags != last.flags ||
                       now.raster.layer != last.raster.layer ||
                       !hasSameBytes(now.lights, last.lights);
    const std::vector<uint32_t> nowRows = extract::findRows(last.raster, now.raster.entities);
    std::vector<bool> isKnown(now.rests.size(), false);
    for (size_t row = 0; row < nowRows.size(); ++row) {
        const uint32_t current = nowRows[row];
        if (current != extract::kNoRow) {
            const bool isSame =
                last.raster.worldFromObject[row] == now.raster.worldFromObject[current] &&
                last.meshes[row] == now.meshes[current];
            now.rests[current] = now.rests[current] && isSame;
            isKnown[current] = last.rests[row];
        }
        if (!last.rests[row])
            continue;
        if (current != extract::kNoRow && now.rests[current])
            mNowRows[row] = current;
        else
            mFrame.mayDiffer = true;
    }
    mNowRows.back() = uint32_t(now.rests.size()); // the sky's
    for (size_t row = 0; row < now.rests.size(); ++row) {
        mStates[row] = shader::kMovingRow;
        if (!now.rests[row])
            continue;
        mStates[row] = isKnown[row] ? shader::kStaticRow : shader::kNewRow;
        mFrame.mayDiffer = mFrame.mayDiffer || !isKnown[row];
    }
}

void StaticLayer::extract(const render::ExtractContext& context) {
    Record now = makeRecord(context);
    const bool isAfter = mRecord && mRecord->raster.seconds <= now.raster.seconds;
    mFrame = {};
    mHasLast = isAfter && now.raster.unjitteredFromWorld == mRecord->raster.unjitteredFromWorld &&
               extract::showsTheSame(context.world, context.view, context.motion, mRecord->raster);
    mFrame.isCameraAtRest =
        (mHasLast || !mRecord) && isHeld(context, now.raster.unjitteredFromWorld);
    mStates.clear();
    for (const bool rests : now.rests)
        mStates.push_back(rests ? shader::kStaticRow : shader::kMovingRow);
    mStates.push_back(shader::kStaticRow); // the sky
    mNowRows.assign(mRecord ? mRecord->rests.size() + 1 : 1, extract::kNoRow);
    if (mHasLast)
        compare(now, *mRecord);
    now.hasPassers = hasPassers(context, now.rests);
    mFrame.mayDiffer = mFrame.mayDiffer || now.hasPassers;
    mRecord = std::move(now);
}

StaticLayer::Frame StaticLayer::turn(const render::PostContext& context) {
    Frame frame = mFrame;
    if (mHasLast)
        frame.last = &mImages.at(mNewest);
    frame.rows = writeRows(mBuffers.at(context.slot));
    mNewest = 1 - mNewest;
    Images& kept = mImages.at(mNewest);
    const auto make = [&](gpu::Image& image, const char* name, VkFormat format) {
        const gpu::ImageDesc desc = describeImage(context.facts, format);
        if (!image.handle() || !(image.desc() == desc))
            image = gpu::Image(mDevice, name, desc);
    };
    make(kept.color, "static colour", VK_FORMAT_R16G16B16A16_SFLOAT);
    make(kept.row, "static row", VK_FORMAT_R32_UINT);
    frame.kept = &kept;
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
