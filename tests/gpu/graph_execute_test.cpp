// SPDX-License-Identifier: MIT
// The render graph on a device: what passes write is what later ones read, and images that share
// memory do not disturb one another.
#include "engine/graph/execute.h"
#include "shaders/accumulate/accumulate_shared.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

namespace shutter {
namespace {

using graph::Access;
using graph::ImageHandle;
using graph::PassKind;

class GraphExecute : public test::GpuTest {};

constexpr uint32_t kGraphWidth = 41;
constexpr uint32_t kGraphHeight = 39;

struct Data {
    ImageHandle source;
    ImageHandle target;
};

ImageHandle addClear(graph::Graph& graph, VkFormat format, const VkClearColorValue& color) {
    return graph
        .addPass<Data>(
            "clear",
            PassKind::Transfer,
            [&](graph::PassBuilder& builder, Data& data) {
                const auto image =
                    graph.createImage("cleared", {kGraphWidth, kGraphHeight, format});
                data.target = builder.write(image, Access::TransferWrite);
            },
            [color](const Data& data, graph::PassContext& context) {
                const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
                vkCmdClearColorImage(
                    context.commands,
                    context.resources.image(data.target).handle(),
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    &color,
                    1,
                    &range
                );
            }
        )
        .target;
}

/// rgb = source's rgb times `scale`, in a new image. \param recorded where it is recorded
ImageHandle addScale(
    graph::Graph& graph,
    gpu::Device& device,
    const gpu::Pipeline& pipeline,
    ImageHandle source,
    float scale,
    bool startsBatch = false,
    VkCommandBuffer* recorded = nullptr
) {
    const shader::AccumulateParams params{{kGraphWidth, kGraphHeight}, 1, 1.0f, scale};
    return graph
        .addPass<Data>(
            "scale",
            PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                const auto image = graph.createImage(
                    "scaled", {kGraphWidth, kGraphHeight, VK_FORMAT_R32G32B32A32_SFLOAT}
                );
                data.source = builder.read(source, Access::SampledCompute);
                data.target = builder.write(image, Access::StorageWrite);
                if (startsBatch)
                    builder.startBatch();
            },
            [&device, &pipeline, params, recorded](const Data& data, graph::PassContext& context) {
                if (recorded)
                    *recorded = context.commands;
                gpu::BindingList bindings;
                bindings.sampled(context.resources.view(data.source), device.nearestSampler())
                    .storage(context.resources.image(data.target));
                context.frame.bind(pipeline, bindings, &params, sizeof(params));
                vkCmdDispatch(context.commands, (kGraphWidth + 7) / 8, (kGraphHeight + 7) / 8, 1);
            }
        )
        .target;
}

void expectConstant(const image::Image& picture, const math::vec3& color) {
    ASSERT_EQ(picture.width, kGraphWidth);
    ASSERT_EQ(picture.height, kGraphHeight);
    for (uint32_t y = 0; y < kGraphHeight; ++y)
        for (uint32_t x = 0; x < kGraphWidth; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                ASSERT_EQ(picture.at(x, y, c), color[int(c)]) << x << ", " << y;
}

TEST_F(GraphExecute, AClearedImageIsCopiedByComputeAndReadBack) {
    const gpu::Pipeline scale = test::makeScalePipeline(device());
    test::GraphRig rig(device());
    // Powers of two: exact in half floats and when doubled.
    const auto cleared =
        addClear(rig.graph, VK_FORMAT_R16G16B16A16_SFLOAT, {{0.5f, 2.0f, 0.25f, 1.0f}});
    const auto copied = addScale(rig.graph, device(), scale, cleared, 2.0f);
    (void)addScale(rig.graph, device(), scale, cleared, 3.0f); // unused
    const size_t before = rig.want(cleared);
    const size_t after = rig.want(copied);
    const graph::Plan plan = run(rig);
    EXPECT_EQ(plan.passes.size(), 4u) << "with two that read back";
    ASSERT_EQ(plan.culled.size(), 1u);
    EXPECT_EQ(plan.culled[0].name, "scale");
    expectConstant(rig.take(before), {0.5f, 2.0f, 0.25f});
    expectConstant(rig.take(after), {1.0f, 4.0f, 0.5f});
}

TEST_F(GraphExecute, AChainWhoseImagesShareMemoryKeepsItsValues) {
    const gpu::Pipeline scale = test::makeScalePipeline(device());
    test::GraphRig rig(device());
    const auto first =
        addClear(rig.graph, VK_FORMAT_R32G32B32A32_SFLOAT, {{1.0f, 3.0f, 5.0f, 1.0f}});
    ImageHandle last = first;
    for (int i = 0; i < 8; ++i)
        last = addScale(rig.graph, device(), scale, last, 2.0f);
    const size_t ticket = rig.want(last);
    const graph::Plan plan = run(rig);
    expectConstant(rig.take(ticket), {256.0f, 768.0f, 1280.0f});
    // Two at a time are alive.
    EXPECT_LE(plan.blockBytes, plan.unaliasedBytes / 3);
}

TEST_F(GraphExecute, APassThatStartsABatchIsRecordedApartAndSeesWhatCameBefore) {
    const gpu::Pipeline scale = test::makeScalePipeline(device());
    test::GraphRig rig(device());
    const auto first =
        addClear(rig.graph, VK_FORMAT_R32G32B32A32_SFLOAT, {{0.25f, 0.5f, 0.75f, 1.0f}});
    VkCommandBuffer before = VK_NULL_HANDLE;
    VkCommandBuffer after = VK_NULL_HANDLE;
    const auto second = addScale(rig.graph, device(), scale, first, 2.0f, false, &before);
    const auto third = addScale(rig.graph, device(), scale, second, 2.0f, true, &after);
    const size_t ticket = rig.want(third);
    const uint64_t submissions = device().completedValue();
    test::run(rig);
    EXPECT_EQ(device().completedValue(), submissions + 1) << "of two batches";
    EXPECT_NE(before, VkCommandBuffer(VK_NULL_HANDLE));
    EXPECT_NE(after, VkCommandBuffer(VK_NULL_HANDLE));
    EXPECT_NE(before, after);
    expectConstant(rig.take(ticket), {1.0f, 2.0f, 3.0f});
}

} // namespace
} // namespace shutter
