// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/check/checker.h"

#include "spirv/motion_blur/check_blended.comp.h"
#include "spirv/motion_blur/check_deformed.comp.h"
#include "spirv/motion_blur/check_ids.comp.h"
#include "spirv/motion_blur/check_picture.comp.h"

#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/passes/dispatch.h"
#include "shaders/render/scene_shared.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace shutter::motion_blur {

namespace {

using graph::Access;

constexpr uint64_t kQuietFrames = 600; ///< until a sentence is reported again

// Push constants, as the shaders declare them.
struct PicturePush {
    glm::uvec2 sizePx;
    shader::PrepareArea color;
    shader::PrepareArea vectors;
    shader::PrepareArea depth;
    glm::vec2 pixelsPerUnit;
    float skyValue;
    uint32_t flags;
    uint32_t serial;
};

struct CheckIdsPush {
    glm::uvec2 sizePx;
    shader::PrepareArea area;
    uint32_t noneValue;
    uint32_t rowCount;
};

struct CheckAreaPush {
    glm::uvec2 sizePx;
    shader::PrepareArea area;
};

gpu::ComputePipelineDesc describeCheck(
    const char* name, std::span<const uint32_t> spirv, uint32_t sampledCount, uint32_t pushBytes
) {
    gpu::ComputePipelineDesc desc;
    desc.name = name;
    desc.spirv = spirv;
    desc.interface.bindings.assign(sampledCount, kSampled);
    desc.interface.bindings.push_back(kBuffer);
    desc.interface.pushConstantBytes = pushBytes;
    return desc;
}

void clearTotals(graph::PassContext& context, graph::BufferHandle totals) {
    const VkBuffer buffer = context.resources.buffer(totals);
    constexpr VkDeviceSize kMinOffset = offsetof(shader::CheckTotals, depthLeast);
    vkCmdFillBuffer(context.commands, buffer, 0, kMinOffset, 0);
    vkCmdFillBuffer(context.commands, buffer, kMinOffset, 4, 0xFFFFFFFFu);
    vkCmdFillBuffer(context.commands, buffer, kMinOffset + 4, VK_WHOLE_SIZE, 0);
}

struct TotalsData {
    graph::BufferHandle totals;
};

/// Declares a pass of one thread a pixel that reads `sources` and adds to the totals.
template <class Push>
graph::BufferHandle addTotalsPass(
    graph::Graph& graph,
    const char* name,
    const gpu::LazyPipeline& pipeline,
    const std::vector<graph::ImageHandle>& sources,
    graph::BufferHandle totals,
    const Push& push,
    VkSampler sampler
) {
    return graph
        .addPass<TotalsData>(
            name,
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, TotalsData& data) {
                for (size_t i = 0; i < sources.size(); ++i)
                    if (std::find(
                            sources.begin(), sources.begin() + std::ptrdiff_t(i), sources[i]
                        ) == sources.begin() + std::ptrdiff_t(i))
                        builder.read(sources[i], Access::SampledCompute);
                data.totals = builder.write(totals, Access::StorageWrite);
            },
            [&pipeline, sources, push, sampler](
                const TotalsData& data, graph::PassContext& context
            ) {
                gpu::BindingList bindings;
                for (const graph::ImageHandle source : sources)
                    bindings.sampled(context.resources.view(source), sampler);
                bindings.buffer(context.resources.buffer(data.totals));
                context.frame.bind(pipeline.get(), bindings, &push, sizeof(push));
                const glm::uvec2 groups =
                    (push.sizePx + shader::kGroupSize - 1u) / shader::kGroupSize;
                vkCmdDispatch(context.commands, groups.x, groups.y, 1);
            }
        )
        .totals;
}

/// Copies the totals to where the CPU reads them.
void addReadback(graph::Graph& graph, graph::BufferHandle totals, const gpu::Buffer& target) {
    struct Data {
        graph::BufferHandle from;
        graph::BufferHandle to;
    };

    const auto imported = graph.importBuffer("checked totals", target.handle(), target.bytes());
    const graph::BufferHandle copied =
        graph
            .addPass<Data>(
                "copy checked totals",
                graph::PassKind::Transfer,
                [&](graph::PassBuilder& builder, Data& data) {
                    data.from = builder.read(totals, Access::TransferRead);
                    data.to = builder.write(imported, Access::TransferWrite);
                },
                [](const Data& data, graph::PassContext& context) {
                    const VkBufferCopy region{0, 0, sizeof(shader::CheckTotals)};
                    vkCmdCopyBuffer(
                        context.commands,
                        context.resources.buffer(data.from),
                        context.resources.buffer(data.to),
                        1,
                        &region
                    );
                }
            )
            .to;
    graph.addPass<TotalsData>(
        "read checked totals",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, TotalsData& data) {
            data.totals = builder.read(copied, Access::HostRead);
            builder.sideEffect();
        },
        [](const TotalsData&, graph::PassContext&) {}
    );
}

} // namespace

HostChecker::HostChecker(gpu::Device& device, uint32_t frames, HostMessage message)
    : mDevice(device), mMessage(std::move(message)),
      mPicture(
          device,
          describeCheck("check picture", motion_blur_check_picture_comp, 3, sizeof(PicturePush))
      ),
      mIds(device, describeCheck("check ids", motion_blur_check_ids_comp, 1, sizeof(CheckIdsPush))),
      mDeformed(
          device,
          describeCheck("check deformed", motion_blur_check_deformed_comp, 1, sizeof(CheckAreaPush))
      ),
      mBlended(
          device,
          describeCheck("check blended", motion_blur_check_blended_comp, 1, sizeof(CheckAreaPush))
      ),
      mSlots(frames), mLast(frames), mNumbers(frames), mNow(std::make_unique<CheckedFrame>()) {}

void HostChecker::add(
    graph::Graph& graph,
    uint32_t frame,
    const HostInputs& inputs,
    const ImportedInputs& images,
    const MotionBlurSettings& settings
) {
    Slot& slot = mSlots[frame];
    if (!slot.totals)
        slot.totals = gpu::Buffer(
            mDevice, "checked totals", sizeof(shader::CheckTotals), 0, gpu::MemoryUse::Readback
        );
    slot.serial = ++mSerial == 0 ? ++mSerial : mSerial;
    slot.isPending = true;
    CheckFacts& facts = slot.facts;
    describeFacts(inputs, settings, facts);
    facts.number = ++mNumbers[facts.view];

    const HostConvention& convention = facts.convention;
    PicturePush push{};
    push.sizePx = {inputs.width, inputs.height};
    push.color = makeArea(inputs.color, facts.picture);
    if (facts.hasVectors)
        push.vectors = makeArea(convention.vectors.image, facts.picture);
    push.depth = makeArea(convention.depth.image, facts.picture);
    push.pixelsPerUnit = convention.vectors.pixelsPerUnit;
    push.skyValue = convention.depth.skyValue;
    push.flags = (facts.isNative ? shader::kCheckDepthIsThird : 0u) |
                 (facts.hasVectors ? shader::kCheckHasVectors : 0u) |
                 (convention.depth.isLinear ? shader::kCheckSkyIsBeyond : 0u);
    push.serial = slot.serial;
    auto totals = graph.createBuffer(
        "totals", {sizeof(shader::CheckTotals), kListUsage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT}
    );
    totals = graph
                 .addPass<TotalsData>(
                     "clear checked totals",
                     graph::PassKind::Transfer,
                     [&](graph::PassBuilder& builder, TotalsData& data) {
                         data.totals = builder.write(totals, Access::TransferWrite);
                     },
                     [](const TotalsData& data, graph::PassContext& context) {
                         clearTotals(context, data.totals);
                     }
                 )
                 .totals;
    const VkSampler sampler = mDevice.nearestSampler();
    const graph::ImageHandle depth = facts.isNative ? images.motionDepth : images.depth;
    const graph::ImageHandle vectors = facts.isNative ? images.motionDepth : images.vectors;
    totals = addTotalsPass(
        graph,
        "check picture",
        mPicture,
        {images.color, facts.hasVectors ? vectors : depth, depth},
        totals,
        push,
        sampler
    );
    if (facts.hasIds)
        totals = addTotalsPass(
            graph,
            "check ids",
            mIds,
            {images.entityId},
            totals,
            CheckIdsPush{
                push.sizePx,
                makeArea(inputs.entityId, facts.picture),
                inputs.noEntity,
                facts.rowCount},
            sampler
        );
    if (facts.hasDeformed)
        totals = addTotalsPass(
            graph,
            "check deformed",
            mDeformed,
            {images.deformed},
            totals,
            CheckAreaPush{push.sizePx, makeArea(inputs.deformedMotion, facts.picture)},
            sampler
        );
    if (images.blended.isValid())
        totals = addTotalsPass(
            graph,
            "check blended",
            mBlended,
            {images.blended},
            totals,
            CheckAreaPush{push.sizePx, makeArea(inputs.blended, facts.picture)},
            sampler
        );
    addReadback(graph, totals, slot.totals);
}

void HostChecker::finish(uint32_t frame) {
    Slot& slot = mSlots[frame];
    if (!std::exchange(slot.isPending, false))
        return;
    const void* mapped = slot.totals.mapped();
    uint32_t serial = 0;
    std::memcpy(&serial, mapped, sizeof(serial));
    if (serial != slot.serial)
        return; // never submitted
    std::memcpy(&mNow->totals, mapped, sizeof(mNow->totals));
    std::swap(mNow->facts, slot.facts);
    mNow->hasOffset = false;
    mNow->keyShare = -1.0;
    mNow->areKeysReversed = false;
    mNow->unusedHistory = 0;
    ++mEvaluated;
    std::unique_ptr<CheckedFrame>& last = mLast[mNow->facts.view];
    // Numbers that skip or go back are of another frame, unless history says otherwise.
    const auto follows = [](const CheckFacts& then, const CheckFacts& now) {
        return now.followsLast || now.frameNumber == then.frameNumber ||
               now.frameNumber == then.frameNumber + 1;
    };
    const bool isNext =
        last && mNow->facts.number == last->facts.number + 1 && follows(last->facts, mNow->facts);
    for (const Finding& finding : checkFrame(*mNow, isNext ? last.get() : nullptr))
        report(finding);
    std::swap(last, mNow);
    if (!mNow)
        mNow = std::make_unique<CheckedFrame>();
}

void HostChecker::finishAll() {
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < mSlots.size(); ++i)
        order.push_back(i);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return mSlots[a].serial < mSlots[b].serial;
    });
    for (const uint32_t frame : order)
        finish(frame);
}

void HostChecker::report(const Finding& finding) {
    uint64_t& reported = mReported[size_t(finding.kind)];
    if (reported != 0 && mEvaluated - reported < kQuietFrames)
        return;
    if (reported != 0 && finding.kind == CheckKind::LeftOut)
        return;
    reported = mEvaluated;
    if (mMessage)
        mMessage("motion blur check: " + finding.sentence);
}

} // namespace shutter::motion_blur
