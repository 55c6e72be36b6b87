// SPDX-License-Identifier: MIT
#include "modules/truth/truth.h"

#include "spirv/truth/truth.comp.h"

#include "engine/core/check.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "shaders/truth/truth_shared.h"

#include <algorithm>
#include <cmath>

namespace shutter::truth {

namespace {

/// Rays of one dispatch: seconds on a software device, and far below what watchdogs of graphics
/// drivers allow on a GPU.
constexpr uint64_t kRaysPerBatch = 1u << 21;

gpu::ComputePipelineDesc describePipeline(const gpu_scene::GpuScene& scene) {
    gpu::ComputePipelineDesc desc;
    desc.name = "truth";
    desc.spirv = truth_truth_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    desc.interface.pushConstantBytes = sizeof(shader::TruthParams);
    desc.interface.sceneLayout = scene.textureLayout();
    return desc;
}

} // namespace

float computeLodBias(PixelModel pixel, uint32_t rays) {
    SHUTTER_CHECK(rays > 0, "a picture of no rays");
    return pixel == PixelModel::Box ? -0.5f * std::log2(static_cast<float>(rays)) : 0.0f;
}

std::vector<uint32_t> planBatches(uint64_t pixels, uint32_t rays, std::span<const uint32_t> stops) {
    SHUTTER_CHECK(pixels > 0, "a picture of no pixels");
    const auto longest =
        static_cast<uint32_t>(std::clamp<uint64_t>(kRaysPerBatch / pixels, 1, rays));
    std::vector<uint32_t> ends(stops.begin(), stops.end());
    ends.push_back(rays);
    std::sort(ends.begin(), ends.end());
    std::vector<uint32_t> batches;
    uint32_t done = 0;
    for (const uint32_t end : ends)
        while (done < std::min(end, rays)) {
            batches.push_back(std::min(longest, std::min(end, rays) - done));
            done += batches.back();
        }
    return batches;
}

Truth::Truth(gpu::Device& device, const gpu_scene::GpuScene& scene, const TruthSettings& settings)
    : mDevice(device), mSettings(settings), mPipeline(device, describePipeline(scene)) {}

void Truth::setBatch(uint32_t first, uint32_t count) {
    SHUTTER_CHECK(first + count > 0, "no ray yet and none to come");
    mFirst = first;
    mCount = count;
}

render::Needs Truth::decide(const render::DecideContext&) const {
    return {
        .run = {true, "every batch is added"},
        .timedRays = {true, "every ray has its own time"},
        .exposure = {true, "its rays meet none"}};
}

Truth::Images Truth::importSums(render::PictureContext& context) {
    gpu::ImageDesc desc;
    desc.width = context.facts.width;
    desc.height = context.facts.height;
    desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    desc.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    if (!(mSumA.desc() == desc)) {
        SHUTTER_CHECK(mFirst == 0, "the picture's size changed between batches");
        mSumA = gpu::Image(mDevice, "rays of the first set", desc);
        mSumB = gpu::Image(mDevice, "rays of the second set", desc);
    }
    const auto import = [&](const gpu::Image& image) {
        return context.graph.importImage(
            image.name(),
            image,
            mFirst == 0 ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL,
            VK_IMAGE_LAYOUT_GENERAL
        );
    };
    return {import(mSumA), import(mSumB)};
}

void Truth::declare(render::PictureContext& context) {
    SHUTTER_CHECK(context.timedRays, "truth needs moving rays");
    using graph::Access;
    const render::ViewFacts& facts = context.facts;
    const graph::TimedRays rays = *context.timedRays;
    const glm::uvec2 size(facts.width, facts.height);
    const glm::uvec2 groups = (size + shader::kTruthGroupSize - 1u) / shader::kTruthGroupSize;
    mGroupCount = groups.x * groups.y;
    mPixels = uint64_t(size.x) * size.y;
    if (mGroups.bytes() < mGroupCount * sizeof(glm::vec2))
        mGroups = gpu::Buffer(
            mDevice,
            "truth groups",
            mGroupCount * sizeof(glm::vec2),
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Readback
        );
    shader::TruthParams params{};
    params.sizePx = size;
    params.frame = gpu::splitAddress(rays.frameConstants);
    params.moving = gpu::splitAddress(rays.timedConstants);
    params.firstRay = mFirst;
    params.rayCount = mCount;
    params.seed = mSettings.seed;
    params.boxFilter = mSettings.pixel == PixelModel::Box ? 1u : 0u;
    params.response = gpu::splitAddress(context.response);

    struct Data {
        Images sums;
        graph::ImageHandle mean;
        graph::ImageHandle error;
        graph::BufferHandle groups;
    };

    const Images sums = importSums(context);
    const graph::TransientImageDesc desc{size.x, size.y, VK_FORMAT_R32G32B32A32_SFLOAT};
    const auto mean = context.graph.createImage("truth", desc);
    const auto error = context.graph.createImage("standard error", desc);
    const auto imported =
        context.graph.importBuffer("truth groups", mGroups.handle(), mGroups.bytes());
    const Data& pass = context.graph.addPass<Data>(
        "truth rays",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            builder.read(rays.tlasBuffer, Access::AccelerationRead);
            if (rays.boxesBuffer.isValid())
                builder.read(rays.boxesBuffer, Access::AccelerationRead);
            data.sums.sumA = builder.write(sums.sumA, Access::StorageWrite);
            data.sums.sumB = builder.write(sums.sumB, Access::StorageWrite);
            data.mean = builder.write(mean, Access::StorageWrite);
            data.error = builder.write(error, Access::StorageWrite);
            data.groups = builder.write(imported, Access::StorageWrite);
        },
        [this, params, groups, rays](const Data& data, graph::PassContext& recording) {
            const graph::PassResources& resources = recording.resources;
            gpu::BindingList bindings;
            bindings.accelerationStructure(rays.tlas)
                .storage(resources.image(data.sums.sumA))
                .storage(resources.image(data.sums.sumB))
                .storage(resources.image(data.mean))
                .storage(resources.image(data.error))
                .buffer(resources.buffer(data.groups));
            recording.frame.bind(mPipeline, bindings, &params, sizeof(params), rays.textures);
            vkCmdDispatch(recording.commands, groups.x, groups.y, 1);
        }
    );

    struct ReadData {
        graph::BufferHandle groups;
    };

    context.color = pass.mean;
    if (mFirst + mCount >= 2)
        context.intermediates.publish("error", pass.error);
    const auto written = pass.groups;
    context.graph.addPass<ReadData>(
        "read truth groups",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, ReadData& data) {
            data.groups = builder.read(written, Access::HostRead);
            builder.sideEffect();
        },
        [](const ReadData&, graph::PassContext&) {}
    );
}

void Truth::finish(render::FinishedFrame& frame) {
    if (!frame.ran)
        return;
    const auto* groups = static_cast<const glm::vec2*>(mGroups.mapped());
    double squares = 0.0;
    double rays = 0.0;
    for (uint32_t i = 0; i < mGroupCount; ++i) {
        squares += double(groups[i].x);
        rays += double(groups[i].y);
    }
    mStandardError = std::nullopt;
    if (mFirst + mCount >= 2)
        mStandardError = std::sqrt(squares / double(mPixels));
    frame.counters["rays per pixel"] = mCount;
    frame.counters["rays traced"] = static_cast<uint64_t>(rays);
    if (mStandardError)
        frame.measures["standard error"] = *mStandardError;
}

} // namespace shutter::truth
