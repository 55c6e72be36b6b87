// SPDX-License-Identifier: MIT
#include "engine/gpu/kept_pipelines.h"
#include "engine/gpu/pipeline_key.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace shutter::gpu {
namespace {

template <typename Handle> Handle makeHandle(uintptr_t value) {
    return reinterpret_cast<Handle>(value);
}

PipelineObjects makeObjects(uintptr_t value) {
    return {
        makeHandle<VkPipeline>(value),
        makeHandle<VkPipelineLayout>(value + 1),
        makeHandle<VkDescriptorSetLayout>(value + 2)};
}

TEST(KeptPipelines, ACachedPipelineIsReturnedOnce) {
    KeptPipelines kept(2);
    EXPECT_EQ(kept.take("a"), std::nullopt);
    EXPECT_EQ(kept.keep("a", makeObjects(16)), std::nullopt);
    EXPECT_EQ(kept.take("b"), std::nullopt);
    EXPECT_EQ(kept.take("a"), makeObjects(16));
    EXPECT_EQ(kept.take("a"), std::nullopt);
}

TEST(KeptPipelines, TheOldestLeavesWhereThereIsNoRoom) {
    KeptPipelines kept(2);
    EXPECT_EQ(kept.keep("a", makeObjects(16)), std::nullopt);
    EXPECT_EQ(kept.keep("b", makeObjects(32)), std::nullopt);
    EXPECT_EQ(kept.keep("a", makeObjects(48)), makeObjects(16));
    EXPECT_EQ(kept.takeAll(), (std::vector{makeObjects(32), makeObjects(48)}));
    EXPECT_EQ(kept.takeAll(), std::vector<PipelineObjects>());
}

TEST(KeptPipelines, ACacheWithoutRoomStoresNothing) {
    KeptPipelines kept(0);
    EXPECT_EQ(kept.keep("a", makeObjects(16)), makeObjects(16));
    EXPECT_EQ(kept.take("a"), std::nullopt);
}

TEST(KeptPipelines, APartlyCreatedPipelineIsNotCached) {
    KeptPipelines kept(1);
    PipelineObjects half = makeObjects(16);
    half.pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(kept.keep("a", half), half);
    EXPECT_EQ(kept.take("a"), std::nullopt);
}

const std::vector<uint32_t> kShader{1, 2, 3};
const std::vector<uint32_t> kOtherShader{1, 2, 4};

/// Changes of a description; each must be another pipeline than the unchanged one and every other.
template <typename Desc>
void expectOwnKeys(const Desc& plain, const std::vector<std::function<void(Desc&)>>& changes) {
    std::set<std::string> keys{makePipelineKey(plain)};
    EXPECT_TRUE(keys.contains(makePipelineKey(Desc(plain)))) << "a copy is the same";
    for (size_t i = 0; i < changes.size(); ++i) {
        Desc changed = plain;
        changes[i](changed);
        EXPECT_TRUE(keys.insert(makePipelineKey(changed)).second) << "change " << i;
    }
}

template <typename Desc> std::vector<std::function<void(Desc&)>> listSharedChanges() {
    return {
        [](Desc& desc) { desc.name = "other"; },
        [](Desc& desc) { desc.interface.bindings[0] = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE; },
        [](Desc& desc) { desc.interface.bindings.pop_back(); },
        [](Desc& desc) { desc.interface.pushConstantBytes = 8; },
        [](Desc& desc) { desc.interface.sceneLayout = makeHandle<VkDescriptorSetLayout>(64); },
        [](Desc& desc) { desc.specialization = {5}; },
        [](Desc& desc) {
            desc.specialization = {5, 0};
        }};
}

template <typename Desc> Desc makePlain() {
    Desc desc;
    desc.name = "plain";
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    desc.interface.pushConstantBytes = 4;
    return desc;
}

TEST(PipelineKey, EachPartOfAComputePipelineCounts) {
    using Desc = ComputePipelineDesc;
    auto plain = makePlain<Desc>();
    plain.spirv = kShader;
    auto changes = listSharedChanges<Desc>();
    changes.emplace_back([](Desc& desc) { desc.spirv = kOtherShader; });
    expectOwnKeys(plain, changes);
}

TEST(PipelineKey, EachPartOfAGraphicsPipelineCounts) {
    using Desc = GraphicsPipelineDesc;
    auto plain = makePlain<Desc>();
    plain.vertexSpirv = kShader;
    plain.fragmentSpirv = kShader;
    plain.colorFormats = {VK_FORMAT_R8_UNORM, VK_FORMAT_R8_UNORM};
    auto changes = listSharedChanges<Desc>();
    changes.emplace_back([](Desc& desc) { desc.vertexSpirv = kOtherShader; });
    changes.emplace_back([](Desc& desc) { desc.fragmentSpirv = kOtherShader; });
    changes.emplace_back([](Desc& desc) { desc.colorFormats[1] = VK_FORMAT_R32_SFLOAT; });
    changes.emplace_back([](Desc& desc) { desc.colorFormats.pop_back(); });
    changes.emplace_back([](Desc& desc) { desc.depthFormat = VK_FORMAT_D32_SFLOAT; });
    changes.emplace_back([](Desc& desc) { desc.depthCompare = VK_COMPARE_OP_EQUAL; });
    changes.emplace_back([](Desc& desc) { desc.depthWrite = false; });
    changes.emplace_back([](Desc& desc) { desc.blend = gpu::Blend::Over; });
    expectOwnKeys(plain, changes);
}

TEST(PipelineKey, EachPartOfARayPipelineCounts) {
    using Desc = RayPipelineDesc;
    auto plain = makePlain<Desc>();
    for (auto* shader :
         {&plain.raygenSpirv, &plain.missSpirv, &plain.closestHitSpirv, &plain.anyHitSpirv})
        *shader = kShader;
    auto changes = listSharedChanges<Desc>();
    changes.emplace_back([](Desc& desc) { desc.raygenSpirv = kOtherShader; });
    changes.emplace_back([](Desc& desc) { desc.missSpirv = kOtherShader; });
    changes.emplace_back([](Desc& desc) { desc.closestHitSpirv = kOtherShader; });
    changes.emplace_back([](Desc& desc) { desc.anyHitSpirv = kOtherShader; });
    expectOwnKeys(plain, changes);
}

TEST(PipelineKey, PartsOfListsDoNotRunIntoEachOther) {
    ComputePipelineDesc one;
    one.name = "ab";
    ComputePipelineDesc other;
    other.name = "a";
    EXPECT_NE(makePipelineKey(one), makePipelineKey(other));
    GraphicsPipelineDesc early;
    early.vertexSpirv = kShader;
    GraphicsPipelineDesc late;
    late.fragmentSpirv = kShader;
    EXPECT_NE(makePipelineKey(early), makePipelineKey(late));
}

} // namespace
} // namespace shutter::gpu
