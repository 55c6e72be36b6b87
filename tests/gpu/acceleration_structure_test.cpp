// SPDX-License-Identifier: MIT
// Builds of bottom and top levels from nothing, one triangle, and triangles without area. The
// reveal's laws (tests/image) check that rays hit them.
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/structure_set.h"
#include "engine/gpu/upload.h"
#include "engine/math/math.h"
#include "tests/support/gpu_fixture.h"

#include <array>
#include <functional>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::vec3;

class AccelerationStructure : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRays())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

/// Positions on the device, three per triangle.
struct Triangles {
    gpu::Buffer vertices;
    gpu::Buffer indices;
    gpu::TriangleGeometry geometry;
};

Triangles makeTriangles(gpu::Device& device, const std::vector<vec3>& positions) {
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    std::vector<uint32_t> indices(positions.size());
    std::iota(indices.begin(), indices.end(), 0u);
    Triangles made;
    made.vertices = gpu::Buffer(
        device, "vertices", positions.size() * sizeof(vec3), kUsage, gpu::MemoryUse::Device
    );
    made.indices = gpu::Buffer(
        device, "indices", indices.size() * sizeof(uint32_t), kUsage, gpu::MemoryUse::Device
    );
    gpu::uploadBuffer(device, made.vertices, std::as_bytes(std::span(positions)));
    gpu::uploadBuffer(device, made.indices, std::as_bytes(std::span(indices)));
    made.geometry.vertices = made.vertices.address();
    made.geometry.vertexStride = sizeof(vec3);
    made.geometry.vertexCount = static_cast<uint32_t>(positions.size());
    made.geometry.indices = made.indices.address();
    made.geometry.triangleCount = static_cast<uint32_t>(positions.size() / 3);
    return made;
}

gpu::Instance makeInstance(const gpu::AccelerationStructure& blas) {
    gpu::Instance instance{};
    for (int i = 0; i < 3; ++i)
        instance.worldFromObject[i][i] = 1.0f;
    instance.blas = blas.address();
    return instance;
}

void build(gpu::Device& device, gpu::Tlas& top, std::span<const gpu::Instance> instances) {
    top.prepare(device, instances);
    gpu::runOnce(device, [&](VkCommandBuffer commands) { top.record(device, commands); });
}

/// Validation sees whether the levels fit.
void expectTop(
    gpu::Device& device, std::initializer_list<const gpu::AccelerationStructure*> levels
) {
    std::vector<gpu::Instance> instances;
    for (const gpu::AccelerationStructure* level : levels)
        instances.push_back(makeInstance(*level));
    gpu::Tlas top;
    build(device, top, instances);
    EXPECT_TRUE(top.structure());
}

using Meshes = std::vector<std::vector<gpu::TriangleGeometry>>;

Triangles makeTriangle(gpu::Device& device) {
    return makeTriangles(device, {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)});
}

TEST_F(AccelerationStructure, AMeshWithoutTrianglesHasNoStructure) {
    EXPECT_TRUE(gpu::buildBlas(device(), {}).empty());
    EXPECT_TRUE(gpu::buildTlas(device(), {}).empty());
    Triangles none = makeTriangle(device());
    none.geometry.triangleCount = 0;
    const auto structures = gpu::buildBlas(device(), Meshes{{}, {none.geometry}});
    ASSERT_EQ(structures.size(), 2u);
    EXPECT_FALSE(structures[0]);
    EXPECT_FALSE(structures[1]);
    gpu::Tlas top;
    build(device(), top, {});
    EXPECT_TRUE(top.structure()) << "a top level of nothing";
}

TEST_F(AccelerationStructure, ThousandsOfMeshesShareABufferAndASubmission) {
    const Triangles one = makeTriangle(device());
    const Meshes meshes(2000, {one.geometry});
    device().collectIdle();
    const gpu::LivingObjects before = device().living();
    const uint64_t allocations = device().allocationCount();
    {
        auto structures = gpu::buildBlas(device(), meshes);
        ASSERT_EQ(structures.size(), 2000u);
        std::set<VkDeviceAddress> addresses;
        for (const gpu::AccelerationStructure& structure : structures)
            addresses.insert(structure.address());
        EXPECT_EQ(addresses.size(), 2000u);
        EXPECT_EQ(device().living().accelerationStructures, before.accelerationStructures + 2000);
        EXPECT_EQ(device().allocationCount(), allocations + 2) << "structures and scratch";
        expectTop(device(), {&structures[0], &structures[1999]});
        const gpu::AccelerationStructure kept = std::move(structures[1]);
        structures.clear();
        device().collectIdle();
        EXPECT_EQ(device().living().buffers, before.buffers + 1) << "it lives as long as one";
        expectTop(device(), {&kept});
    }
    device().collectIdle();
    EXPECT_EQ(device().living(), before);
}

TEST_F(AccelerationStructure, CompactionLeavesTheSmallerCopiesAlone) {
    std::vector<vec3> positions;
    for (int i = 0; i < 3000; ++i)
        positions.emplace_back(float(i % 71), float(i % 37), float(i % 3));
    const Triangles many = makeTriangles(device(), positions);
    const Meshes meshes(50, {many.geometry});
    device().collectIdle();
    const gpu::LivingObjects before = device().living();
    uint64_t bytes[2] = {};
    for (const auto compaction : {gpu::Compaction::None, gpu::Compaction::Done}) {
        const bool compacts = compaction == gpu::Compaction::Done;
        const uint64_t submitted = device().completedValue();
        const auto structures = gpu::buildBlas(device(), meshes, compaction);
        EXPECT_EQ(device().completedValue(), submitted + (compacts ? 2 : 1));
        device().collectIdle();
        EXPECT_EQ(device().living().accelerationStructures, before.accelerationStructures + 50);
        EXPECT_EQ(device().living().buffers, before.buffers + 1);
        bytes[compacts] = device().living().memoryBytes - before.memoryBytes;
        expectTop(device(), {&structures[0], &structures[49]});
    }
    EXPECT_LE(bytes[1], bytes[0]);
    device().collectIdle();
    EXPECT_EQ(device().living(), before);
}

TEST_F(AccelerationStructure, TrianglesWithoutAreaBuild) {
    const vec3 nan(std::numeric_limits<float>::quiet_NaN());
    const vec3 right(1, 0, 0);
    // A point, a line, and inactive, as Vulkan calls it.
    const Triangles flat = makeTriangles(
        device(), {vec3(1), vec3(1), vec3(1), vec3(0), right, 2.0f * right, nan, vec3(0), vec3(1)}
    );
    const auto structures = gpu::buildBlas(device(), Meshes{{flat.geometry}});
    ASSERT_TRUE(structures.at(0));
    expectTop(device(), {&structures[0]});
}

TEST_F(AccelerationStructure, TopLevelsAndBoxesGrowAndKeepTheirRoomWhenTheyShrink) {
    const Triangles one = makeTriangle(device());
    const auto structures = gpu::buildBlas(device(), Meshes{{one.geometry}});
    gpu::Tlas top;
    gpu::BoxBlas boxes;
    const auto buildTop = [&](size_t count) {
        build(device(), top, std::vector(count, makeInstance(structures.at(0))));
        return top.structure().address();
    };
    const auto buildBoxes = [&](size_t count) {
        boxes.prepare(device(), std::vector<gpu::BoxGeometry>(count, {{-1, -1, -1}, {1, 1, 1}}));
        gpu::runOnce(device(), [&](VkCommandBuffer commands) { boxes.record(device(), commands); });
        return boxes.structure().address();
    };
    for (const auto& buildSome : {std::function<VkDeviceAddress(size_t)>(buildTop), {buildBoxes}}) {
        const VkDeviceAddress small = buildSome(1);
        EXPECT_NE(small, 0u);
        const VkDeviceAddress large = buildSome(100);
        EXPECT_NE(large, small);
        EXPECT_EQ(buildSome(3), large);
    }
    expectTop(device(), {&boxes.structure()});
}

TEST_F(AccelerationStructure, ATlasIsBuiltPerInstance) {
    const Triangles one = makeTriangle(device());
    const auto structures = gpu::buildBlas(device(), Meshes{{one.geometry}});
    const auto tops = gpu::buildTlas(device(), std::vector(3, makeInstance(structures.at(0))));
    ASSERT_EQ(tops.size(), 3u);
    for (const gpu::AccelerationStructure& top : tops)
        EXPECT_NE(top.address(), 0u);
    EXPECT_NE(tops[0].address(), tops[1].address());
}

TEST_F(AccelerationStructure, ASetOfLevelsIsKeptWhileItsSizesStay) {
    const Triangles one = makeTriangle(device());
    const Triangles two = makeTriangles(
        device(), {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0), vec3(0, 1, 0), vec3(0, 0, 1)}
    );
    using gpu::BuildAction;
    gpu::StructureSet levels;
    EXPECT_FALSE(levels.prepareBlas(device(), {{{one.geometry}, {}}, {{two.geometry}, {}}}, true));
    ASSERT_EQ(levels.count(), 2u);
    EXPECT_NE(levels.address(0), levels.address(1));
    const VkDeviceAddress first = levels.address(0);
    gpu::runOnce(device(), [&](VkCommandBuffer commands) {
        levels.record(device(), commands);
        gpu::fullBarrier(commands);
        levels.record(device(), commands, std::array{BuildAction::Refit, BuildAction::Keep});
    });
    EXPECT_TRUE(levels.prepareBlas(device(), {{{one.geometry}, {}}, {{two.geometry}, {}}}, true));
    EXPECT_EQ(levels.address(0), first);
    // Another order, other flags, and no refits: new ones.
    EXPECT_FALSE(levels.prepareBlas(device(), {{{two.geometry}, {}}, {{one.geometry}, {}}}, true));
    EXPECT_FALSE(levels.prepareBlas(device(), {{{two.geometry}, {}}, {{one.geometry}, {}}}));
    gpu::TriangleGeometry masked = two.geometry;
    masked.opaque = false;
    EXPECT_FALSE(levels.prepareBlas(device(), {{{masked}, {}}, {{one.geometry}, {}}}));
    EXPECT_FALSE(levels.prepareBlas(device(), {}));
    EXPECT_EQ(levels.count(), 0u);
}

TEST_F(AccelerationStructure, ASetOfTlasesHasOnePerInstance) {
    const std::vector<gpu::BoxGeometry> geometry(3, {{-1, -1, -1}, {1, 1, 1}});
    gpu::Buffer boxes(
        device(),
        "boxes",
        geometry.size() * sizeof(gpu::BoxGeometry),
        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR,
        gpu::MemoryUse::Stream
    );
    boxes.write(std::span<const gpu::BoxGeometry>(geometry));
    gpu::StructureSet levels;
    EXPECT_FALSE(levels.prepareBlas(device(), {{{}, {{boxes.address(), 3}, {boxes.address(), 0}}}})
    );
    gpu::Instance instance = makeInstance(gpu::AccelerationStructure());
    instance.blas = levels.address(0);
    instance.flipFacing = true;
    gpu::StructureSet tops;
    tops.prepareTlas(device(), std::vector(5, instance));
    ASSERT_EQ(tops.count(), 5u);
    EXPECT_NE(tops.address(0), tops.address(4));
    gpu::runOnce(device(), [&](VkCommandBuffer commands) {
        levels.record(device(), commands);
        gpu::fullBarrier(commands);
        tops.record(device(), commands);
    });
}

} // namespace
} // namespace shutter
