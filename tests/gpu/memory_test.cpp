// SPDX-License-Identifier: MIT
// Buffers on a device that says of its memory what others say of theirs.
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/upload.h"
#include "tests/support/gpu_fixture.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace shutter {
namespace {

class Memory : public test::GpuTest {
  protected:
    static std::vector<uint32_t> copyValues(const gpu::Buffer& buffer, size_t count) {
        const auto* values = static_cast<const uint32_t*>(buffer.mapped());
        return {values, values + count};
    }
};

TEST_F(Memory, WhatIsNotCoherentIsFlushedAndInvalidated) {
    gpu::DeviceOptions options;
    options.validate = true;
    auto opened = test::openFaulty(options, "SHUTTER_FAULT_HIDE", "hostCoherent");
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    const std::unique_ptr<gpu::Device> incoherent = std::move(opened).value();
    {
        gpu::Buffer source(*incoherent, "source", 16, 0, gpu::MemoryUse::Readback);
        gpu::Buffer target(*incoherent, "target", 16, 0, gpu::MemoryUse::Readback);
        const std::vector<uint32_t> values{1, 2, 3, 4};
        source.write(std::span(values));
        target.writeZeros();
        EXPECT_EQ(copyValues(target, 4), std::vector<uint32_t>(4, 0));
        gpu::runOnce(*incoherent, [&](VkCommandBuffer commands) {
            const VkBufferCopy region{0, 0, 16};
            vkCmdCopyBuffer(commands, source.handle(), target.handle(), 1, &region);
        });
        EXPECT_EQ(copyValues(target, 4), values);
    }
    EXPECT_THROW(gpu::Buffer(*incoherent, "table", 16, 0, gpu::MemoryUse::Stream), gpu::DeviceError)
        << "no device lacks coherent memory; one that says so gets a sentence";
    incoherent->collectIdle();
    EXPECT_EQ(incoherent->living(), gpu::LivingObjects{}) << "what failed leaves nothing behind";
    EXPECT_EQ(incoherent->validationMessageCount(), 0u);
}

TEST_F(Memory, ABufferThatIsStagedInPartsIsFilledWhole) {
    std::vector<uint32_t> values(gpu::kStagingBytes / 4 + 1000);
    std::iota(values.begin(), values.end(), 7u);
    gpu::Buffer buffer(device(), "large", 4 * values.size(), 0, gpu::MemoryUse::Readback);
    gpu::uploadBuffer(device(), buffer, std::as_bytes(std::span(values)));
    EXPECT_EQ(copyValues(buffer, values.size()), values);
}

} // namespace
} // namespace shutter
