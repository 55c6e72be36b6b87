// SPDX-License-Identifier: MIT
#include "engine/core/check.h"
#include "engine/graph/compile_stages.h"

#include <array>

namespace shutter::graph {

namespace {

constexpr uint8_t bit(PassKind kind) {
    return static_cast<uint8_t>(1u << static_cast<int>(kind));
}

constexpr uint8_t kCompute = bit(PassKind::Compute);
constexpr uint8_t kRaster = bit(PassKind::Raster);
constexpr uint8_t kTransfer = bit(PassKind::Transfer);
constexpr uint8_t kBuild = bit(PassKind::Build);
constexpr uint8_t kRays = bit(PassKind::RayTracing);
constexpr uint8_t kAny = kCompute | kRaster | kTransfer | kBuild | kRays;

struct Row {
    Access access;
    const char* words;
    uint8_t passes;
    bool image;
    bool buffer;
    AccessScope scope;
    VkImageUsageFlags imageUsage;
    VkBufferUsageFlags bufferUsage;
};

constexpr VkPipelineStageFlags2 kComputeStage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 kFragmentStage = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr VkPipelineStageFlags2 kShaderStages =
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | kFragmentStage | kComputeStage;
constexpr VkPipelineStageFlags2 kDepthStages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkPipelineStageFlags2 kBuildStage =
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;

constexpr VkImageLayout kNoLayout = VK_IMAGE_LAYOUT_UNDEFINED;
constexpr VkImageLayout kSampledLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

// Stores may load too, and blending and depth tests read their target: those rows have both masks.
const std::array<Row, 15> kRows{{
    {Access::SampledCompute,
     "sampled in compute",
     kCompute | kRays,
     true,
     false,
     {kComputeStage, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, 0, kSampledLayout},
     VK_IMAGE_USAGE_SAMPLED_BIT,
     0},
    {Access::SampledFragment,
     "sampled in fragment",
     kRaster,
     true,
     false,
     {kFragmentStage, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, 0, kSampledLayout},
     VK_IMAGE_USAGE_SAMPLED_BIT,
     0},
    {Access::StorageRead,
     "storage read",
     kCompute | kRays,
     true,
     true,
     {kComputeStage, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, 0, VK_IMAGE_LAYOUT_GENERAL},
     VK_IMAGE_USAGE_STORAGE_BIT,
     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
    {Access::StorageWrite,
     "storage write",
     kCompute | kRays,
     true,
     true,
     {kComputeStage,
      VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
      VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
      VK_IMAGE_LAYOUT_GENERAL},
     VK_IMAGE_USAGE_STORAGE_BIT,
     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
    {Access::StorageWriteDisjoint,
     "disjoint storage write",
     kCompute | kRays,
     true,
     false,
     {kComputeStage,
      VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
      VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
      VK_IMAGE_LAYOUT_GENERAL},
     VK_IMAGE_USAGE_STORAGE_BIT,
     0},
    {Access::OutsideWrite,
     "written from outside",
     kCompute,
     true,
     false,
     {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
      VK_ACCESS_2_MEMORY_READ_BIT,
      VK_ACCESS_2_MEMORY_WRITE_BIT,
      VK_IMAGE_LAYOUT_GENERAL},
     VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
         VK_IMAGE_USAGE_TRANSFER_DST_BIT,
     0},
    {Access::ColorAttachment,
     "colour attachment",
     kRaster,
     true,
     false,
     {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
      VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
      VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
     0},
    {Access::DepthAttachment,
     "depth attachment",
     kRaster,
     true,
     false,
     {kDepthStages,
      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
      VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL},
     VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
     0},
    {Access::TransferRead,
     "copied from",
     kTransfer,
     true,
     true,
     {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
      VK_ACCESS_2_TRANSFER_READ_BIT,
      0,
      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
     VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
     VK_BUFFER_USAGE_TRANSFER_SRC_BIT},
    {Access::TransferWrite,
     "copied to",
     kTransfer,
     true,
     true,
     {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
      0,
      VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL},
     VK_IMAGE_USAGE_TRANSFER_DST_BIT,
     VK_BUFFER_USAGE_TRANSFER_DST_BIT},
    {Access::IndirectRead,
     "indirect arguments",
     kCompute | kRays | kRaster,
     false,
     true,
     {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, 0, kNoLayout},
     0,
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {Access::ShaderRead,
     "shader read",
     kCompute | kRays | kRaster | kBuild,
     false,
     true,
     {kShaderStages, VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT, 0, kNoLayout},
     0,
     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
    {Access::AccelerationRead,
     "traced",
     kCompute | kRays | kBuild,
     false,
     true,
     {kComputeStage, VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR, 0, kNoLayout},
     0,
     0},
    {Access::AccelerationBuild,
     "built",
     kBuild,
     false,
     true,
     {kBuildStage,
      VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR,
      VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR,
      kNoLayout},
     0,
     0},
    {Access::HostRead,
     "read by the host",
     kAny,
     false,
     true,
     {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, 0, kNoLayout},
     0,
     0},
}};

const Row& rowOf(Access access) {
    const auto index = static_cast<size_t>(access);
    SHUTTER_CHECK(
        index < kRows.size() && kRows[index].access == access, "access {} has no row", index
    );
    return kRows[index];
}

} // namespace

bool isWrite(Access access) {
    return rowOf(access).scope.writes != 0;
}

const char* describe(Access access) {
    return rowOf(access).words;
}

AccessScope scopeOf(Access access, PassKind kind) {
    AccessScope scope = rowOf(access).scope;
    // A build takes its inputs (instances, lower structures) in the build stage, not in a shader.
    if (kind == PassKind::Build && access != Access::HostRead) {
        scope.stages = kBuildStage;
        if (access == Access::ShaderRead)
            scope.reads = VK_ACCESS_2_SHADER_READ_BIT;
    }
    if (kind == PassKind::RayTracing && (scope.stages & kComputeStage) != 0)
        scope.stages = VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR;
    return scope;
}

bool fitsImage(Access access) {
    return rowOf(access).image;
}

bool fitsBuffer(Access access) {
    return rowOf(access).buffer;
}

bool fitsPass(Access access, PassKind kind) {
    return (rowOf(access).passes & bit(kind)) != 0;
}

VkImageUsageFlags imageUsageOf(Access access) {
    return rowOf(access).imageUsage;
}

VkBufferUsageFlags bufferUsageOf(Access access) {
    return rowOf(access).bufferUsage;
}

} // namespace shutter::graph
