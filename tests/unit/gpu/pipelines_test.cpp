// SPDX-License-Identifier: MIT
// Pipelines that are kept, their keys, and what a driver is given of the cache of an earlier run.
#include "engine/gpu/kept_pipelines.h"
#include "engine/gpu/pipeline_cache.h"
#include "engine/gpu/pipeline_key.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
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

TEST(KeptPipelines, AWholePipelineIsReturnedOnceAndTheOldestLeavesWhereThereIsNoRoom) {
    KeptPipelines kept(2);
    EXPECT_EQ(kept.take("a"), std::nullopt);
    EXPECT_EQ(kept.keep("a", makeObjects(16)), std::nullopt);
    EXPECT_EQ(kept.take("b"), std::nullopt);
    EXPECT_EQ(kept.take("a"), makeObjects(16));
    EXPECT_EQ(kept.take("a"), std::nullopt);
    EXPECT_EQ(kept.keep("a", makeObjects(16)), std::nullopt);
    EXPECT_EQ(kept.keep("b", makeObjects(32)), std::nullopt);
    EXPECT_EQ(kept.keep("a", makeObjects(48)), makeObjects(16));
    EXPECT_EQ(kept.takeAll(), (std::vector{makeObjects(32), makeObjects(48)}));
    EXPECT_EQ(kept.takeAll(), std::vector<PipelineObjects>());
    PipelineObjects half = makeObjects(16); // made in part
    half.pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(kept.keep("a", half), half);
    EXPECT_EQ(kept.take("a"), std::nullopt);
    KeptPipelines none(0);
    EXPECT_EQ(none.keep("a", makeObjects(16)), makeObjects(16));
    EXPECT_EQ(none.take("a"), std::nullopt);
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
        [](Desc& desc) { desc.specialization.assign(2, 5); }};
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
    changes.emplace_back([](Desc& desc) { desc.subgroupSize = 16; });
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
    changes.emplace_back([](Desc& desc) { desc.samples = 4; });
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
    GraphicsPipelineDesc early;
    early.vertexSpirv = kShader;
    GraphicsPipelineDesc late;
    late.fragmentSpirv = kShader;
    EXPECT_NE(makePipelineKey(early), makePipelineKey(late));
}

namespace fs = std::filesystem;

constexpr PipelineCacheOwner kOwner{
    .vendorId = 0x10005, .deviceId = 7, .uuid = {1, 2, 3, 4, 5, 6, 7, 8, 9}};

std::vector<uint8_t> makeBlob(const PipelineCacheOwner& owner = kOwner) {
    VkPipelineCacheHeaderVersionOne header{};
    header.headerSize = sizeof(header);
    header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
    header.vendorID = owner.vendorId;
    header.deviceID = owner.deviceId;
    std::copy(owner.uuid.begin(), owner.uuid.end(), header.pipelineCacheUUID);
    std::vector<uint8_t> blob(sizeof(header) + 100, 42);
    std::memcpy(blob.data(), &header, sizeof(header));
    return blob;
}

TEST(PipelineCacheFile, PackedBytesAreUnpackedUnchangedAndNotIfAnyIsChanged) {
    const std::vector<uint8_t> blob = makeBlob();
    const std::vector<uint8_t> file = packPipelineCache(blob);
    const auto unpacked = unpackPipelineCache(file, kOwner);
    ASSERT_TRUE(unpacked && unpacked.value());
    EXPECT_TRUE(std::equal(blob.begin(), blob.end(), unpacked.value()->begin()));
    EXPECT_EQ(unpacked.value()->size(), blob.size());
    for (size_t i = 0; i < file.size(); ++i) {
        std::vector<uint8_t> damaged = file;
        damaged[i] ^= 0x10;
        const auto changed = unpackPipelineCache(damaged, kOwner);
        EXPECT_FALSE(changed && changed.value()) << i;
        const auto cut = unpackPipelineCache(std::span(file).first(i), kOwner);
        EXPECT_FALSE(cut && cut.value()) << i;
    }
}

TEST(PipelineCacheFile, AnotherDriversCacheIsIgnoredWithoutAnError) {
    PipelineCacheOwner other = kOwner;
    other.uuid[3] = 0;
    const std::vector<uint8_t> file = packPipelineCache(makeBlob(other));
    const auto unpacked = unpackPipelineCache(file, kOwner);
    ASSERT_TRUE(unpacked);
    EXPECT_FALSE(unpacked.value());
    std::vector<uint8_t> unversioned = makeBlob();
    unversioned[5] = 0x30; // no value of the header's enum
    const std::vector<uint8_t> packed = packPipelineCache(unversioned);
    EXPECT_FALSE(unpackPipelineCache(packed, kOwner).value());
    const auto bare = unpackPipelineCache(makeBlob(), kOwner); // of a driver, without our header
    ASSERT_TRUE(bare);
    EXPECT_FALSE(bare.value());
}

TEST(PipelineCacheFile, TheCacheIsReadFromFilesUpToALimit) {
    const test::TempFolder folder;
    const std::vector<uint8_t> file = packPipelineCache(makeBlob());
    const fs::path path =
        folder.write("cache.bin", {reinterpret_cast<const char*>(file.data()), file.size()});
    EXPECT_EQ(readPipelineCache(path, kOwner), makeBlob());
    EXPECT_TRUE(readPipelineCache(folder.path(), kOwner).empty());
    EXPECT_TRUE(readPipelineCache(folder.path() / "missing", kOwner).empty());
    EXPECT_TRUE(readPipelineCache("", kOwner).empty());
    testing::internal::CaptureStderr();
    fs::resize_file(path, file.size() - 1);
    EXPECT_TRUE(readPipelineCache(path, kOwner).empty());
    EXPECT_NE(testing::internal::GetCapturedStderr().find("cache.bin"), std::string::npos);
    testing::internal::CaptureStderr();
    fs::resize_file(path, kMaxPipelineCacheBytes + 1); // sparse
    EXPECT_TRUE(readPipelineCache(path, kOwner).empty());
    EXPECT_NE(testing::internal::GetCapturedStderr().find("above the limit"), std::string::npos);
}

} // namespace
} // namespace shutter::gpu
