// SPDX-License-Identifier: MIT
// On which devices a load past the end of what a pass binds is caught. What it gives is Vulkan's
// own rule: lavapipe gives 0 on every device, so no picture here could tell them apart.
#include "engine/gpu/device.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <cstdint>
#include <string>

namespace shutter {
namespace {

class Bounds : public test::GpuTest {};

TEST_F(Bounds, AValidatedDeviceChecksThem) {
    EXPECT_TRUE(device().checksBounds());
    gpu::DeviceOptions options;
    options.wanted = device().info().name;
    const auto trusting = gpu::Device::create(options);
    ASSERT_TRUE(trusting) << trusting.error().message;
    EXPECT_FALSE(trusting.value()->checksBounds());
    options.bounds = gpu::Bounds::Checked;
    const auto checking = gpu::Device::create(options);
    ASSERT_TRUE(checking) << checking.error().message;
    EXPECT_TRUE(checking.value()->checksBounds());
}

} // namespace
} // namespace shutter
