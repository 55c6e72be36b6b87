// SPDX-License-Identifier: MIT
// Fifty ways in which a first trial in a foreign engine went wrong, through both interfaces: what
// can be seen gives a sentence that names the field, and nothing crashes or aborts.
#include "tests/gpu/misuse_host.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace shutter {
namespace {

using motion_blur::EmbeddedMotionBlur;
using motion_blur::HostDevice;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using test::kSampled;
using test::kWritten;

using test::expectNamed;
using test::expectNamedInC;
using test::kMisusedHeight;
using test::kMisusedWidth;
using test::Misuse;

class EmbeddedMisuses : public test::MisuseHost {};

/// A change that both interfaces take alike.
template <class Change> Misuse both(const char* part, const Change& change) {
    return {
        part,
        [change](HostInputs& in, MotionBlurSettings&) { change(in); },
        [change](ShutterBlurInputs& in, ShutterBlurSettings&) { change(in); }};
}

template <const char* Name, const char* Value> void setValue(ShutterBlurSettings& settings) {
    static const ShutterBlurValue kValue{Name, Value};
    settings.values = &kValue;
    settings.valueCount = 1;
}

constexpr char kJitter[] = "jitter";
constexpr char kNan[] = "nan";
constexpr char kNeighbourhood[] = "neighbourhoodTiles";
constexpr char kEven[] = "4";

TEST_F(EmbeddedMisuses, OfImagesAreNamed) {
    const std::vector<Misuse> misuses{
        both("color.image is null", [](auto& in) { in.color.image = VK_NULL_HANDLE; }),
        both("motionDepth.image is null", [](auto& in) { in.motionDepth.image = VK_NULL_HANDLE; }),
        both("the size is 0 x 24", [](auto& in) { in.width = 0; }),
        both(
            "motionDepth.image is color.image",
            [](auto& in) { in.motionDepth.image = in.color.image; }
        ),
        both("leave output.image null", [](auto& in) { in.output.image = in.color.image; }),
        both(
            "color.before.layout is undefined",
            [](auto& in) { in.color.before.layout = VK_IMAGE_LAYOUT_UNDEFINED; }
        ),
        both(
            "color.format is R8G8B8A8_UNORM",
            [](auto& in) { in.color.format = VK_FORMAT_R8G8B8A8_UNORM; }
        ),
        both(
            "motionDepth.format is R16G16B16A16_SFLOAT",
            [](auto& in) { in.motionDepth.format = VK_FORMAT_R16G16B16A16_SFLOAT; }
        ),
        // Swapped: what each image is of was said, and motion is not read from half floats.
        both("motionDepth.format is", [](auto& in) { std::swap(in.color, in.motionDepth); }),
        both("color.samples is 4", [](auto& in) { in.color.samples = VK_SAMPLE_COUNT_4_BIT; }),
        both(
            "motionDepth.samples is 2",
            [](auto& in) { in.motionDepth.samples = VK_SAMPLE_COUNT_2_BIT; }
        ),
        both(
            "output.area ends at 40, 24, beyond its extent",
            [](auto& in) {
                in.output.extent = {32, 24};
                in.output.area.extent = {40, 24};
            }
        ),
        both(
            "color.extent is 40 x 20, all of which is used where area is not said",
            [](auto& in) {
                in.color.extent = {40, 20};
            }
        ),
        both(
            "motionDepth is part of a larger image",
            [](auto& in) {
                in.motionDepth.extent = {64, 64};
                in.motionDepth.area.extent = {40, 24};
            }
        ),
        both(
            "color.area begins at 40, 0, beyond its extent",
            [](auto& in) {
                in.color.extent = {40, 24};
                in.color.area.offset.x = 40;
            }
        ),
        // Twelve times as wide as the images are.
        both("color takes ", [](auto& in) { in.width = 12 * kMisusedWidth; }),
        both(
            "color.area.extent is 20 x 24",
            [](auto& in) {
                in.color.area.extent = {20, 24};
            }
        ),
        both("color.area.offset is -1", [](auto& in) { in.color.area.offset.x = -1; }),
        both(
            "output.usage lacks VK_IMAGE_USAGE_STORAGE_BIT",
            [](auto& in) { in.output.usage &= ~VkImageUsageFlags(VK_IMAGE_USAGE_STORAGE_BIT); }
        ),
        both(
            "output.usage lacks VK_IMAGE_USAGE_TRANSFER_DST_BIT",
            [](auto& in) { in.output.usage &= ~VkImageUsageFlags(VK_IMAGE_USAGE_TRANSFER_DST_BIT); }
        ),
        both(
            "color.usage lacks VK_IMAGE_USAGE_STORAGE_BIT",
            [](auto& in) {
                in.output = {};
                in.color.usage &= ~VkImageUsageFlags(VK_IMAGE_USAGE_STORAGE_BIT);
            }
        ),
        both(
            "motionDepth.usage lacks VK_IMAGE_USAGE_SAMPLED_BIT",
            [](auto& in) { in.motionDepth.usage &= ~VkImageUsageFlags(VK_IMAGE_USAGE_SAMPLED_BIT); }
        ),
        both("rasterTime is 50", [](auto& in) { in.rasterTime = 50.0; }),
    };
    for (const Misuse& misuse : misuses)
        expectRefused(misuse);
}

TEST_F(EmbeddedMisuses, OfSettingsAreNamed) {
    using S = MotionBlurSettings;
    using I = ShutterBlurInputs;
    using CS = ShutterBlurSettings;
    const motion_blur::Method stranger = motion_blur::getMethod("gather"); // of no list
    const std::vector<Misuse> misuses{
        {"method is none of", [&](HostInputs&, S& s) { s.method = &stranger; }, {}},
        {"settings.method is 'blur99'", {}, [](I&, CS& s) { s.method = "blur99"; }},
        {"settings.preset 'ultra' is unknown", {}, [](I&, CS& s) { s.preset = "ultra"; }},
        {"sampleCount is",
         [](HostInputs&, S& s) { s.sampleCount = 257; },
         [](I&, CS& s) { s.sampleCount = 100000; }},
        {"neighbourhoodTiles",
         [](HostInputs&, S& s) { s.neighbourhoodTiles = 4; },
         [](I&, CS& s) { setValue<kNeighbourhood, kEven>(s); }},
        {"jitter",
         [](HostInputs&, S& s) { s.jitter = std::numeric_limits<float>::quiet_NaN(); },
         [](I&, CS& s) { setValue<kJitter, kNan>(s); }},
        {"maskTest is the value 9",
         [](HostInputs&, S& s) { s.maskTest = motion_blur::MaskTest(9); },
         {}},
        {"denoised",
         [](HostInputs&, S& s) { s.method = &motion_blur::getMethod("denoised"); },
         [](I&, CS& s) { s.method = "denoised"; }},
        {"hybrid needs rays",
         [](HostInputs&, S& s) { s.method = &motion_blur::getMethod("hybrid"); },
         [](I&, CS& s) { s.method = "hybrid"; }},
        {"recordSamples is null",
         [](HostInputs&, S& s) { s.method = &motion_blur::getMethod("adaptive"); },
         [](I&, CS& s) { s.preset = "quality"; }},
        {"raysPerPixel is inf",
         [](HostInputs& in, S& s) {
             s.method = &motion_blur::getMethod("adaptive");
             s.raysPerPixel = std::numeric_limits<float>::infinity();
             in.samples.record = [](const motion_blur::SampleTask&) {};
         },
         {}},
        {"which needs ShutterBlurDevice::measures",
         [](HostInputs& in, S&) { in.budget.milliseconds = 2.0; },
         [](I& in, CS&) { in.budgetMilliseconds = 2.0; }},
    };
    for (const Misuse& misuse : misuses)
        expectRefused(misuse);
}

TEST_F(EmbeddedMisuses, OfDevicesAreNamed) {
    VkPhysicalDeviceFeatures2 nothing{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    const auto refuse = [](const char* part, const auto& change) {
        HostDevice host = describeHost();
        change(host);
        const auto made = EmbeddedMotionBlur::create(host);
        expectNamed(!made, made ? "" : made.error().message, part);
        if constexpr (requires(ShutterBlurDevice d) { change(d); }) {
            ShutterBlurDevice described = describeDevice();
            change(described);
            ShutterBlur* blur = nullptr;
            const auto done = shutterBlurCreate(&described, &blur);
            expectNamedInC(done, part);
            EXPECT_EQ(blur, nullptr);
        }
    };
    refuse("physical is null", [](auto& d) { d.physical = VK_NULL_HANDLE; });
    refuse("device is null", [](auto& d) { d.device = VK_NULL_HANDLE; });
    refuse("queueFamily 9", [](auto& d) { d.queueFamily = 9; });
    refuse("framesInFlight is 0", [](auto& d) { d.framesInFlight = 0; });
    refuse("framesInFlight is 65", [](auto& d) { d.framesInFlight = 65; });
    refuse("apiVersion is 1.1", [](auto& d) { d.apiVersion = VK_API_VERSION_1_1; });
    refuse("enabledFeatures lacks shaderStorageImageExtendedFormats", [&](auto& d) {
        d.enabledFeatures = &nothing;
    });
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
    EXPECT_EQ(shutterBlurAddFeatures(&features), SHUTTER_BLUR_SUCCESS);
    v13.synchronization2 = VK_FALSE;
    refuse("enabledFeatures lacks synchronization2", [&](auto& d) {
        d.enabledFeatures = &features;
    });
    refuse("sceneLayout is null", [](HostDevice& d) { d.rayTier = gpu::RayTier::RayQuery; });
}

TEST_F(EmbeddedMisuses, OfFrameNumbersAreNamed) {
    const HostInputs inputs = makeInputs();
    const ShutterBlurInputs inputsOfC = makeInputsOfC();
    const MotionBlurSettings settings = test::gather();
    const auto expectStatus = [](const core::Status& status, const char* part) {
        expectNamed(!status, status ? "" : status.error().message, part);
    };
    const auto expectResult = [](ShutterBlurResult result, const char* part) {
        expectNamedInC(result, part);
    };
    expectStatus(mBlur->record(VK_NULL_HANDLE, 0, inputs, settings), "command buffer is null");
    expectResult(shutterBlurRecord(mC, VK_NULL_HANDLE, 0, &inputsOfC, nullptr), "buffer is null");
    expectStatus(mBlur->markDone(7), "frame is 7, framesInFlight 2");
    expectResult(shutterBlurMarkDone(mC, 7), "frame is 7, framesInFlight 2");
    expectStatus(mBlur->closeView(7), "view is 7, framesInFlight 2");
    expectResult(shutterBlurCloseView(mC, 7), "view is 7, framesInFlight 2");
    submit([&](VkCommandBuffer commands) {
        expectStatus(mBlur->record(commands, 2, inputs, settings), "frame is 2, framesInFlight 2");
        expectResult(shutterBlurRecord(mC, commands, 2, &inputsOfC, nullptr), "frame is 2");
        EXPECT_TRUE(mBlur->record(commands, 0, inputs, settings).ok());
        // Another view under the same number: the GPU has not run the first.
        expectStatus(
            mBlur->record(commands, 0, inputs, settings),
            "frame 0 was recorded before, and the GPU has not run that"
        );
    });
    submit([&](VkCommandBuffer commands) {
        EXPECT_EQ(shutterBlurRecord(mC, commands, 0, &inputsOfC, nullptr), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
        expectResult(
            shutterBlurRecord(mC, commands, 0, &inputsOfC, nullptr), "the GPU has not run that"
        );
    });
    // The GPU ran both: the numbers are free.
    submit([&](VkCommandBuffer commands) {
        EXPECT_TRUE(mBlur->record(commands, 0, inputs, settings).ok());
    });
}

TEST_F(EmbeddedMisuses, AFrameThatWasDroppedIsToldByMarkDone) {
    const MotionBlurSettings settings = test::gather();
    mFrame->begin();
    mHost->recordClears(mFrame->commands());
    ASSERT_TRUE(mBlur->record(mFrame->commands(), 0, makeInputs(), settings).ok());
    mFrame.emplace(device()); // nobody submits it
    mFrame->begin();
    mHost->recordClears(mFrame->commands());
    EXPECT_FALSE(mBlur->record(mFrame->commands(), 0, makeInputs(), settings).ok());
    EXPECT_TRUE(mBlur->markDone(0).ok());
    const core::Status done = mBlur->record(mFrame->commands(), 0, makeInputs(), settings);
    EXPECT_TRUE(done.ok()) << done.error().message;
    mFrame->submit();
    mFrame->wait();
}

/// A device of an instance that is made for another version of Vulkan, without validation: what is
/// wrong with it is for the motion blur to say.
class OldDevice {
  public:
    explicit OldDevice(uint32_t apiVersion) {
        VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
        application.apiVersion = apiVersion;
        VkInstanceCreateInfo instance{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
        instance.pApplicationInfo = &application;
        if (vkCreateInstance(&instance, nullptr, &mInstance) != VK_SUCCESS)
            return;
        uint32_t count = 1;
        if (vkEnumeratePhysicalDevices(mInstance, &count, &physical) < 0 || count == 0)
            return;
        const float priority = 1.0f;
        VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queue;
        (void)vkCreateDevice(physical, &info, nullptr, &device);
    }

    ~OldDevice() {
        if (device)
            vkDestroyDevice(device, nullptr);
        if (mInstance)
            vkDestroyInstance(mInstance, nullptr);
    }

    OldDevice(const OldDevice&) = delete;
    OldDevice& operator=(const OldDevice&) = delete;

    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;

  private:
    VkInstance mInstance = VK_NULL_HANDLE;
};

void expectRefusedOn(uint32_t apiVersion, gpu::RayTier tier, const char* part) {
    const OldDevice old(apiVersion);
    ASSERT_TRUE(old.device);
    HostDevice host;
    host.physical = old.physical;
    host.device = old.device;
    host.rayTier = tier;
    host.sceneLayout = reinterpret_cast<VkDescriptorSetLayout>(uintptr_t{1}); // nothing looks at it
    const auto made = EmbeddedMotionBlur::create(host);
    expectNamed(!made, made ? "" : made.error().message, part);
    if (tier != gpu::RayTier::None)
        return;
    ShutterBlurDevice described = shutterBlurDefaultDevice();
    described.physical = old.physical;
    described.device = old.device;
    ShutterBlur* blur = nullptr;
    const auto done = shutterBlurCreate(&described, &blur);
    expectNamed(done == SHUTTER_BLUR_ERROR_REFUSED, shutterBlurGetMessage(), part);
}

TEST_F(EmbeddedMisuses, AnInstanceOfVulkan10IsNamed) {
    expectRefusedOn(
        VK_API_VERSION_1_0, gpu::RayTier::None, "the instance is not made for Vulkan 1.3"
    );
}

TEST_F(EmbeddedMisuses, AnInstanceOfVulkan11IsNamed) {
    expectRefusedOn(
        VK_API_VERSION_1_1, gpu::RayTier::None, "the instance is not made for Vulkan 1.3"
    );
}

TEST_F(EmbeddedMisuses, RaysWithoutTheirExtensionAreNamed) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "the device traces no rays in compute shaders";
    expectRefusedOn(
        VK_API_VERSION_1_3, gpu::RayTier::RayQuery, "made without VK_KHR_acceleration_structure"
    );
}

// What no interface can see must at least leave a picture.
TEST_F(EmbeddedMisuses, NumbersThatAreNoneLeaveAFinitePicture) {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const VkClearColorValue motion :
         {VkClearColorValue{{nan, nan, 2.0f, 0.0f}},
          VkClearColorValue{{inf, -inf, 2.0f, 0.0f}},
          VkClearColorValue{{1e30f, 1e30f, 2.0f, 0.0f}},
          VkClearColorValue{{4.0f, 0.0f, nan, 0.0f}}}) {
        const test::Picture output(device(), "output", {kMisusedWidth, kMisusedHeight});
        submit([&](VkCommandBuffer commands) {
            const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            test::moveOn(commands, mHost->motionDepth.handle(), kWritten, kWritten);
            vkCmdClearColorImage(
                commands, mHost->motionDepth.handle(), kWritten.layout, &motion, 1, &all
            );
            HostInputs inputs = makeInputs();
            inputs.output = {output.handle(), test::kNothing, test::kCopied};
            const core::Status done = mBlur->record(commands, 0, inputs, test::gather());
            EXPECT_TRUE(done.ok()) << done.error().message;
            output.recordReadback(commands);
        });
        for (const float value : output.read().pixels)
            ASSERT_TRUE(std::isfinite(value));
    }
}

} // namespace
} // namespace shutter
