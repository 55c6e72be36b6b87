// SPDX-License-Identifier: MIT
#include "tests/support/gpu_fixture.h"

#include "engine/core/check.h"

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace shutter::test {

namespace {

struct SharedDevice {
    std::unique_ptr<gpu::Device> device;
    std::string problem; ///< why there is none
};

SharedDevice openDevice() {
    gpu::DeviceOptions options;
    options.validate = true;
    options.keptPipelines = 512; // programs that make the same effects over and over
    auto opened = gpu::Device::create(options);
    if (!opened)
        return {nullptr, opened.error().message};
    return {std::move(opened).value(), ""};
}

/// Opened by the first test that uses it; closed after the last test, before statics die.
std::optional<SharedDevice>& sharedDevice() {
    static std::optional<SharedDevice> shared;
    return shared;
}

class CloseDevice : public ::testing::Environment {
  public:
    void TearDown() override { sharedDevice().reset(); }
};

const auto* const kCloseDevice = ::testing::AddGlobalTestEnvironment(new CloseDevice);

} // namespace

core::Result<std::unique_ptr<gpu::Device>>
openFaulty(const gpu::DeviceOptions& options, const char* variable, const std::string& value) {
    // The loader and the layer read them when an instance is made.
    const std::pair<const char*, std::string> variables[] = {
        {"VK_ADD_LAYER_PATH", SHUTTER_FAULT_LAYER},
        {"VK_INSTANCE_LAYERS", "VK_LAYER_SHUTTER_faults"},
        {variable, value}};
    for (const auto& [name, text] : variables)
        setenv(name, text.c_str(), 1);
    auto device = gpu::Device::create(options);
    for (const auto& [name, text] : variables)
        unsetenv(name);
    return device;
}

void GpuTest::SetUp() {
    if (!sharedDevice())
        sharedDevice() = openDevice();
    if (!sharedDevice()->device) {
        const std::string& problem = sharedDevice()->problem;
        if (std::getenv("SHUTTER_REQUIRE_DEVICE"))
            FAIL() << "SHUTTER_REQUIRE_DEVICE is set and no validated device opens: " << problem;
        GTEST_SKIP() << "no validated Vulkan device: " << problem;
    }
    mMessagesBefore = device().validationMessageCount();
}

void GpuTest::TearDown() {
    if (!sharedDevice() || !sharedDevice()->device)
        return;
    device().waitIdle();
    EXPECT_EQ(device().validationMessageCount(), mMessagesBefore)
        << "Vulkan validation reported something (see above)";
}

void RayTest::SetUp() {
    GpuTest::SetUp();
    if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
        GTEST_SKIP() << device().info().name << " has no ray queries";
}

gpu::Device& GpuTest::device() {
    SHUTTER_CHECK(
        sharedDevice() && sharedDevice()->device, "a test without a device must not get this far"
    );
    return *sharedDevice()->device;
}

} // namespace shutter::test
