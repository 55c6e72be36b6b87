// SPDX-License-Identifier: MIT
// Mistakes of hosts through both interfaces: detectable ones give one sentence that names the
// field, nothing crashes, and others leave a finite picture. Here are those that need a device, the
// whole of the inputs or an object; faults of an image, a convention, keys, movers, a lens and a
// setting by itself are in tests/unit/motion_blur, and here only one of each kind is passed on.
#include "engine/gpu/frame.h"
#include "engine/math/transform.h"
#include "engine/render/renderer.h"
#include "tests/gpu/embedding_host.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <concepts>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace shutter {
namespace {

using motion_blur::EmbeddedMotionBlur;
using motion_blur::getMethod;
using motion_blur::HostCameraKey;
using motion_blur::HostDevice;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using test::expectRefusal;
using test::kSampled;
using test::settingsOf;
using CInputs = ShutterBlurInputs;
using CSettings = ShutterBlurSettings;

constexpr uint32_t kRefusedWidth = 40;
constexpr uint32_t kRefusedHeight = 24;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// One sentence, without the source's name of an abort.
void expectNamed(const core::Status& status, const std::string& part) {
    expectRefusal(status, part);
    const std::string message = status ? "" : status.error().message;
    for (const char* never : {"CHECK", ".cpp", "\n"})
        EXPECT_EQ(message.find(never), std::string::npos) << message;
}

void expectNamed(ShutterBlurResult result, const std::string& part) {
    ASSERT_EQ(result, SHUTTER_BLUR_ERROR_REFUSED) << "expected: " << part;
    expectNamed(core::Status(core::Error{shutterBlurGetMessage()}), part);
}

/// Settings of the method with the fewest pipelines: every method makes the same checks.
MotionBlurSettings plain() {
    return settingsOf("own_velocity");
}

HostCameraKey makeKey() {
    return {1.0, glm::dmat4(1.0), math::clipFromViewPerspective(1.0, 1.5, 0.1)};
}

class EmbeddedRefusals : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (!mBlur)
            return;
        mC.emplace(device());
        mHost.emplace(device(), kRefusedWidth, kRefusedHeight);
        mRefused.emplace(device()).begin();
        inputs = makeInputs();
    }

    void TearDown() override {
        mC.reset();
        mHost.reset();
        mRefused.reset();
        EmbeddedTest::TearDown();
    }

    /// With all image properties but their samples.
    [[nodiscard]] HostInputs makeInputs() const {
        HostInputs made = mHost->inputs();
        for (motion_blur::HostImage* image : {&made.color, &made.motionDepth, &made.output}) {
            image->usage = test::kAllUsage;
            image->format = VK_FORMAT_R16G16B16A16_SFLOAT;
        }
        made.motionDepth.format = VK_FORMAT_R32G32B32A32_SFLOAT;
        return made;
    }

    [[nodiscard]] CInputs makeInputsOfC() const {
        const HostInputs given = makeInputs();
        CInputs made = shutterBlurDefaultInputs();
        made.width = kRefusedWidth;
        made.height = kRefusedHeight;
        made.color = test::convertForC(given.color);
        made.motionDepth = test::convertForC(given.motionDepth);
        made.output = test::convertForC(given.output);
        return made;
    }

    void submitCleared(const std::function<void(VkCommandBuffer)>& record) const {
        submit([&](VkCommandBuffer commands) {
            mHost->recordClears(commands);
            record(commands);
        });
    }

    core::Status
    record(const HostInputs& given, const MotionBlurSettings& with, uint32_t frame = 0) const {
        core::Status done;
        submitCleared([&](VkCommandBuffer commands) {
            done = mBlur->record(commands, frame, given, with);
        });
        return done;
    }

    core::Status record() const { return record(inputs, settings); }

    static CSettings plainInC() {
        CSettings made = shutterBlurDefaultSettings();
        made.method = "own_velocity";
        return made;
    }

    void expectRefused(
        const HostInputs& given, const MotionBlurSettings& with, const std::string& part
    ) const {
        expectNamed(mBlur->record(mRefused->commands(), 0, given, with), part);
    }

    void expectRefused(const std::string& part) const { expectRefused(inputs, settings, part); }

    void
    expectRefusedInC(const CInputs& given, const CSettings& with, const std::string& part) const {
        expectNamed(shutterBlurRecord(mC->blur, mRefused->commands(), 0, &given, &with), part);
    }

    /// \param change of the inputs of one interface or, generic, of each
    template <class Change> void refuse(const char* part, const Change& change) const {
        if constexpr (std::invocable<const Change&, HostInputs&>) {
            HostInputs changed = makeInputs();
            change(changed);
            expectRefused(changed, plain(), part);
        }
        if constexpr (std::invocable<const Change&, CInputs&>) {
            CInputs changed = makeInputsOfC();
            change(changed);
            expectRefusedInC(changed, plainInC(), part);
        }
    }

    /// The same of settings.
    template <class Change> void refuseSettings(const char* part, const Change& change) const {
        if constexpr (std::invocable<const Change&, MotionBlurSettings&>) {
            MotionBlurSettings changed = plain();
            change(changed);
            expectRefused(inputs, changed, part);
        }
        if constexpr (std::invocable<const Change&, CSettings&>) {
            CSettings changed = shutterBlurDefaultSettings();
            change(changed);
            expectRefusedInC(makeInputsOfC(), changed, part);
        }
    }

    HostInputs inputs;
    MotionBlurSettings settings = plain();
    std::optional<test::BlurOfC> mC;
    std::optional<test::HostFrame> mHost;
    std::optional<gpu::Frame> mRefused; ///< is never submitted: nothing is recorded in it
};

TEST_F(EmbeddedRefusals, EachBadImageIsNamed) {
    refuse("the size is 0 x 24", [](auto& in) { in.width = 0; });
    refuse("the size is 40 x 32769", [](HostInputs& in) { in.height = 32769; });
    refuse("color.image is null", [](auto& in) { in.color.image = VK_NULL_HANDLE; });
    refuse("motionDepth.image is color.image", [](auto& in) {
        in.motionDepth.image = in.color.image;
    });
    refuse("leave output.image null", [](auto& in) { in.output.image = in.color.image; });
    refuse("color.format is R8G8_UNORM", [](auto& in) { in.color.format = VK_FORMAT_R8G8_UNORM; });
    refuse("depth by VK_RESOLVE_MODE_SAMPLE_ZERO_BIT", [](CInputs& in) {
        in.depth = in.motionDepth;
        in.motionDepth = {};
        in.depth.format = VK_FORMAT_R32G32B32A32_SFLOAT;
        in.depth.samples = VK_SAMPLE_COUNT_4_BIT;
    });
    refuse("output.usage lacks VK_IMAGE_USAGE_TRANSFER_DST_BIT", [](auto& in) {
        in.output.format = VK_FORMAT_B8G8R8A8_UNORM;
        in.output.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    });
    refuse("motionDepth.format is", [](auto& in) { std::swap(in.color, in.motionDepth); });
    refuse("color.samples is 4", [](auto& in) { in.color.samples = VK_SAMPLE_COUNT_4_BIT; });
    refuse("color.extent is 40 x 20, all of which is used without an area", [](auto& in) {
        in.color.extent = {40, 20};
    });
    refuse("motionDepth is part of a larger image", [](auto& in) {
        in.motionDepth.extent = {64, 64};
        in.motionDepth.area.extent = {40, 24};
    });
    refuse("color takes ", [](auto& in) { in.width = 12 * kRefusedWidth; });
    refuse("output.usage lacks VK_IMAGE_USAGE_STORAGE_BIT", [](auto& in) {
        in.output.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    });
    refuse("output.usage lacks VK_IMAGE_USAGE_TRANSFER_DST_BIT", [](auto& in) {
        in.output.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    });
    refuse("color.usage lacks VK_IMAGE_USAGE_STORAGE_BIT", [](auto& in) {
        in.output = {};
        in.color.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    });
    const uint32_t most = device().limits().maxImageDimension2D;
    if (most < 32768) {
        refuse("the device's maxImageDimension2D", [&](HostInputs& in) { in.width = most + 1; });
        refuse("color.extent is ", [&](HostInputs& in) {
            in.color.extent = {most + 1, 24};
            in.color.area.extent = {40, 24};
        });
    }
}

TEST_F(EmbeddedRefusals, EachBadNumberOfTheInputsIsNamed) {
    refuse("rasterTime is 50", [](auto& in) { in.rasterTime = 50.0; });
    refuse("rasterTime is -0.1", [](auto& in) { in.rasterTime = -0.1; });
    refuse("rasterTime is nan", [](auto& in) { in.rasterTime = double(kNan); });
    refuse("which needs ShutterBlurDevice::measures", [](HostInputs& in) {
        in.budget.milliseconds = 2.0;
    });
    refuse("which needs ShutterBlurDevice::measures", [](CInputs& in) {
        in.budgetMilliseconds = 2.0;
    });
    refuse("inputs.structBytes is 0", [](CInputs& in) { in.structBytes = 0; });
    refuse("inputs.structBytes is 4", [](CInputs& in) { in.structBytes = 4; });
    refuse("or less of an older header", [](CInputs& in) { in.structBytes += 8; });
    refuse("responsePoints is null", [](CInputs& in) { in.responsePointCount = 2; });
    refuse("keys is null, keyCount is 1", [](CInputs& in) { in.keyCount = 1; });
    refuse("movers is null, moverCount is 2", [](CInputs& in) { in.moverCount = 2; });
    refuse("lens.radius is 0.01, but the method own_velocity has no lens", [](HostInputs& in) {
        in.motion.lens.radius = 0.01;
    });
    refuse("lens.radius is 0.01, but the method own_velocity has no lens", [](CInputs& in) {
        in.lens.radius = 0.01;
    });
    refuse("motion blur: view is 7", [](CInputs& in) { in.view = 7; });
    refuse("transfer is 3, it must be 0", [](CInputs& in) {
        in.transfer = static_cast<ShutterBlurTransfer>(3);
    });
    for (const double wrong : {0.5, 4.0, double(kNan)})
        refuse("transferPower is ", [&](CInputs& in) {
            in.transfer = SHUTTER_BLUR_TRANSFER_POWER;
            in.transferPower = wrong;
        });
    for (const double wrong : {0.0, 17.0, double(kNan)})
        refuse("transferScale is ", [&](CInputs& in) { in.transferScale = wrong; });
    refuse("viewModel.depthMax is 0.25, but motionDepth is given", [](CInputs& in) {
        in.viewModel.depthMax = 0.25f;
    });
    refuse("motionDepth.image is null, and so are vectors.image and depth.image", [](CInputs& in) {
        in.motionDepth = {};
    });
    using Points = std::vector<math::ResponsePoint>;
    const std::pair<Points, const char*> responses[] = {
        {{{0, 1}}, "responsePoints holds 1, it must be 2 to 64"},
        {Points(65), "responsePoints holds 65"},
        {{{0.1, 1}, {1, 0}}, "responsePoints[0].time is 0.1, times must rise from 0 to 1"},
        {{{0, 1}, {0.9, 0}}, "responsePoints[1].time is 0.9"},
        {{{0, 1}, {0.5, 0}, {0.5, 1}, {1, 1}}, "responsePoints[2].time is 0.5"},
        {{{0, 1}, {0.5, 0}, {0.5 + 1e-9, 1}, {1, 1}}, "responsePoints[2].time is 0.5"},
        {{{0, 1}, {double(kNan), 0}, {1, 1}}, "responsePoints[1].time is nan"},
        {{{0, 1}, {2, 0}, {1, 1}}, "responsePoints[1].time is 2"},
        {{{0, 1}, {1, -1}}, "responsePoints[1].sensitivity is -1"},
        {{{0, double(kInfinity)}, {1, 1}}, "responsePoints[0].sensitivity is inf"},
        {{{0, double(kNan)}, {1, 1}}, "responsePoints[0].sensitivity is nan"},
        {{{0, 0}, {1, 0}}, "no light is taken"}};
    for (const auto& [points, part] : responses)
        refuse(part, [&](HostInputs& in) { in.responsePoints = points; });
    const Points good{{0, 0}, {1, 1e300}};
    inputs.responsePoints = good;
    EXPECT_TRUE(record().ok());
    inputs.response = 16;
    expectRefused("response is not 0, although there are responsePoints");
}

TEST_F(EmbeddedRefusals, EachBadSettingIsNamed) {
    const motion_blur::Method stranger = getMethod("gather"); // of no list
    refuseSettings("method is none of", [&](MotionBlurSettings& s) { s.method = &stranger; });
    refuseSettings("maskTest is the value 9", [](MotionBlurSettings& s) {
        s.maskTest = motion_blur::MaskTest(9);
    });
    refuseSettings("sampleCount", [](auto& s) { s.sampleCount = 257; });
    const auto use = [](const char* method) {
        return [method](MotionBlurSettings& s) { s.method = &getMethod(method); };
    };
    refuseSettings("denoised", use("denoised"));
    refuseSettings("the method hybrid needs rays", use("hybrid"));
    refuseSettings("recordSamples is null", use("adaptive"));
    refuseSettings("adaptive needs rays with times of their own", [](MotionBlurSettings& s) {
        s = settingsOf("adaptive");
        s.raysPerPixel = 0.0f;
    });
    inputs.samples.record = [](const motion_blur::SampleTask&) {};
    refuseSettings("raysPerPixel is inf", [](MotionBlurSettings& s) {
        s = settingsOf("adaptive");
        s.raysPerPixel = kInfinity;
    });
    const auto name = [](const char* method) {
        return [method](CSettings& s) { s.method = method; };
    };
    refuseSettings("settings.method is 'teapot', it must be", name("teapot"));
    refuseSettings("denoised", name("denoised"));
    refuseSettings("recordReveal is null", name("hybrid"));
    refuseSettings("recordSamples is null", name("adaptive"));
    refuseSettings("settings.preset 'ultra' is unknown", [](CSettings& s) { s.preset = "ultra"; });
    refuseSettings("settings.values is null", [](CSettings& s) { s.valueCount = 1; });
    const std::pair<ShutterBlurValue, const char*> values[] = {
        {{"speed", "1"}, "settings.values has no 'speed'"},
        {{"history", "perhaps"}, "history: 'perhaps' is not true or false"},
        {{"jitter", "7"}, "jitter: 7 must be"},
        {{"jitter", nullptr}, "a name or value of settings.values is null"}};
    for (const auto& [value, part] : values)
        refuseSettings(part, [&](CSettings& s) {
            s.values = &value;
            s.valueCount = 1;
        });
}

TEST_F(EmbeddedRefusals, EachBadDeviceIsNamed) {
    const auto refuseDevice = []<class Change>(const char* part, const Change& change) {
        if constexpr (std::invocable<const Change&, HostDevice&>) {
            HostDevice host = describeHost();
            change(host);
            const auto made = EmbeddedMotionBlur::create(host);
            expectNamed(made ? core::Status() : core::Status(made.error()), part);
        }
        if constexpr (std::invocable<const Change&, ShutterBlurDevice&>) {
            ShutterBlurDevice described = test::describeForC(device());
            change(described);
            auto* blur = reinterpret_cast<ShutterBlur*>(uintptr_t{1});
            expectNamed(shutterBlurCreate(&described, &blur), part);
            EXPECT_EQ(blur, nullptr);
        }
    };
    VkPhysicalDeviceFeatures2 nothing{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
    EXPECT_EQ(shutterBlurAddFeatures(&features), SHUTTER_BLUR_SUCCESS);
    v13.synchronization2 = VK_FALSE;
    refuseDevice("physical is null", [](auto& d) { d.physical = VK_NULL_HANDLE; });
    refuseDevice("device is null", [](auto& d) { d.device = VK_NULL_HANDLE; });
    refuseDevice("queueFamily 9", [](auto& d) { d.queueFamily = 9; });
    refuseDevice("framesInFlight is 0", [](auto& d) { d.framesInFlight = 0; });
    refuseDevice("framesInFlight is 65", [](auto& d) { d.framesInFlight = 65; });
    refuseDevice("apiVersion is 1.1", [](auto& d) { d.apiVersion = VK_API_VERSION_1_1; });
    refuseDevice("enabledFeatures lacks shaderStorageImageExtendedFormats", [&](auto& d) {
        d.enabledFeatures = &nothing;
    });
    refuseDevice("enabledFeatures lacks synchronization2", [&](auto& d) {
        d.enabledFeatures = &features;
    });
    refuseDevice("sceneLayout is null", [](HostDevice& d) { d.rayTier = gpu::RayTier::RayQuery; });
    refuseDevice("device.structBytes is 1", [](ShutterBlurDevice& d) { d.structBytes = 1; });
    ShutterBlur* blur = nullptr;
    const ShutterBlurDevice described = test::describeForC(device());
    expectNamed(shutterBlurCreate(nullptr, &blur), "device is null");
    expectNamed(shutterBlurCreate(&described, nullptr), "blur is null");
    expectNamed(shutterBlurCheckDevice(VK_NULL_HANDLE, 0), "physical is null");
    expectNamed(shutterBlurCheckDevice(described.physical, 99), "queueFamily 99");
    EXPECT_EQ(
        shutterBlurCheckDevice(described.physical, described.queueFamily), SHUTTER_BLUR_SUCCESS
    );
    shutterBlurDestroy(nullptr);
}

TEST_F(EmbeddedRefusals, EachBadArgumentIsNamed) {
    const CInputs ofC = makeInputsOfC();
    const CSettings cheap = plainInC();
    expectNamed(mBlur->record(VK_NULL_HANDLE, 0, inputs, settings), "command buffer is null");
    expectNamed(shutterBlurRecord(mC->blur, VK_NULL_HANDLE, 0, &ofC, nullptr), "buffer is null");
    expectNamed(mBlur->markDone(7), "frame is 7, framesInFlight 2");
    expectNamed(shutterBlurMarkDone(mC->blur, 2), "frame is 2, framesInFlight 2");
    expectNamed(mBlur->closeView(7), "view is 7, framesInFlight 2");
    expectNamed(shutterBlurCloseView(mC->blur, 2), "view is 2, framesInFlight 2");
    expectNamed(shutterBlurGetMemory(mC->blur, nullptr), "memory is null");
    const VkCommandBuffer refused = mRefused->commands();
    expectNamed(shutterBlurRecord(mC->blur, refused, 0, nullptr, nullptr), "inputs is null");
    expectNamed(shutterBlurRecord(nullptr, refused, 0, &ofC, nullptr), "blur is null");
    expectNamed(mBlur->record(refused, 2, inputs, settings), "frame is 2, framesInFlight 2");
    expectNamed(shutterBlurRecord(mC->blur, refused, 9, &ofC, nullptr), "frame is 9");
    const char* pending = "frame 0 was recorded before, and the GPU has not run that";
    submitCleared([&](VkCommandBuffer commands) {
        EXPECT_TRUE(mBlur->record(commands, 0, inputs, settings).ok());
        expectNamed(mBlur->record(commands, 0, inputs, settings), pending);
    });
    submitCleared([&](VkCommandBuffer commands) {
        EXPECT_EQ(shutterBlurRecord(mC->blur, commands, 0, &ofC, &cheap), SHUTTER_BLUR_SUCCESS);
        expectNamed(shutterBlurRecord(mC->blur, commands, 0, &ofC, &cheap), pending);
    });
    EXPECT_TRUE(record().ok()) << "the GPU ran both: the numbers are free";
    gpu::Frame dropped(device()); // never submitted
    dropped.begin();
    mHost->recordClears(dropped.commands());
    ASSERT_TRUE(mBlur->record(dropped.commands(), 0, inputs, settings).ok());
    EXPECT_FALSE(record().ok());
    EXPECT_TRUE(mBlur->markDone(0).ok());
    EXPECT_TRUE(record().ok()) << "markDone() reports the dropped one";
}

TEST_F(EmbeddedRefusals, CamerasThatAMethodLacksOrThatAreNoneAreNamed) {
    motion_blur::HostCameras& cameras = inputs.convention.cameras;
    settings = settingsOf("rosado2007");
    expectRefused("cameras are not given, which the method rosado2007 needs");
    cameras.areGiven = true;
    cameras.clipFromView = glm::dmat4(0.0);
    expectRefused("cameras.clipFromView is neither");
    // Checkers, dumps and overlays read them.
    expectRefused(inputs, plain(), "cameras.clipFromView");
    cameras.areGiven = false;
    EXPECT_TRUE(record(inputs, plain()).ok());
    cameras.areGiven = true;
    cameras.clipFromView = cameras.clipFromViewBefore = makeKey().clipFromView;
    EXPECT_TRUE(record().ok());
    inputs.convention.scales.exposureShare = -1.0f;
    expectRefused("exposureShare is -1");
}

TEST_F(EmbeddedRefusals, ScalesThatAMethodCannotHonourAreNamed) {
    inputs.convention.cameras.cutDistance = -1.0;
    expectRefused(inputs, plain(), "cutDistance is -1, it must be 0 or more");
    inputs.convention.cameras.cutDistance = 0.0;
    inputs.convention.cameras.cutDegrees = double(kNan);
    expectRefused(inputs, plain(), "cutDegrees is nan, it must be 0 or more");
    inputs.convention.cameras.cutDegrees = 0.0;
    motion_blur::HostScales& scales = inputs.convention.scales;
    scales.camera = 0.5f;
    expectRefused(inputs, plain(), "cameraScale is 0.5, it must be 1: motionDepth is given");
    scales.camera = 1.0f;
    scales.object = 0.0f;
    expectRefused(inputs, plain(), "objectScale is 0, it must be 1: motionDepth is given");
    scales.object = 1.0f;
    scales.perPixel = {mHost->output.handle(), kSampled, kSampled};
    expectRefused(
        inputs, plain(), "blurScale.image is given, which does not count with motionDepth"
    );
    inputs.convention.depth.image = inputs.motionDepth;
    inputs.convention.depth.image.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    inputs.convention.depth.isLinear = true;
    inputs.convention.cameras.areGiven = true;
    inputs.convention.cameras.clipFromView = inputs.convention.cameras.clipFromViewBefore =
        makeKey().clipFromView;
    inputs.motionDepth = {};
    inputs.output = {};
    scales.perPixel.format = VK_FORMAT_R16_SFLOAT;
    expectRefused(
        inputs,
        settingsOf("resolved"),
        "blurScale.image is given, which the method resolved cannot honour; for a weapon or "
        "cockpit "
        "give viewModelRows"
    );
    scales.perPixel = {};
    const std::array<uint32_t, 1> rows{0};
    inputs.motion.viewModelRows = rows;
    expectRefused(
        inputs,
        settingsOf("resolved"),
        "entityId.image is null, although viewModelRows has 1 row: ids mark their pixels"
    );
}

TEST_F(EmbeddedRefusals, TheDefaultMethodInPlaceOfResolvedIsReportedOnce) {
    std::string reported;
    HostDevice host = describeHost();
    host.message = [&](std::string_view sentence) { reported += sentence; };
    useOwn(host);
    settings = {};
    bool readsMotions = false;
    inputs.observe = [&](graph::Graph&, const motion_blur::MotionBlurInputs& own, const auto&) {
        readsMotions = own.instantMotions.has_value();
    };
    const std::string once = "motion blur: motionDepth is given without keys, so the default "
                             "method is gather in place of resolved";
    for (int again = 0; again < 2; ++again) {
        EXPECT_TRUE(record().ok());
        EXPECT_FALSE(readsMotions);
        EXPECT_EQ(reported, once);
    }
    const HostCameraKey key = makeKey();
    inputs.motion.keys = {&key, 1};
    EXPECT_TRUE(record().ok());
    EXPECT_TRUE(readsMotions);
    EXPECT_EQ(reported, once);
}

TEST_F(EmbeddedRefusals, MissingInputsOfResolvedAreNamed) {
    settings = settingsOf("resolved");
    settings.secondRaster = true;
    inputs.entityId = mHost->ids();
    expectRefused("secondRaster is true, but hosts have one raster");
    settings.secondRaster = false;
    expectRefused("keys holds 0");
    inputs.entityId = {};
    expectRefused("keys holds 0"); // a still world needs no ids
    const motion_blur::HostMover mover{0, {}};
    inputs.motion.movers = {&mover, 1};
    expectRefused("entityId.image is null, although movers has 1 row");
    inputs.motion.view = 2;
    for (const MotionBlurSettings& each : {settings, plain()})
        expectRefused(inputs, each, "view is 2, framesInFlight 2");
    inputs.motion.view = 1;
    EXPECT_TRUE(record(inputs, plain()).ok()) << "it needs no motion";
    // Movers with neither vectors nor matrices.
    const HostCameraKey key = makeKey();
    inputs.motion.keys = {&key, 1};
    inputs.motion.rowCount = 1;
    inputs.entityId = mHost->ids();
    inputs.entityId.format = VK_FORMAT_R8_UINT;
    expectRefused("noEntity is 4294967295, but entityId holds values up to 255");
    const std::array matrices{math::dmat4(1.0)};
    const std::array<motion_blur::HostMover, 2> movers{{{7, matrices}, {200, {}}}};
    inputs.entityId = mHost->ids();
    inputs.convention.depth.image = {mHost->output.handle(), kSampled, kSampled};
    inputs.convention.depth.image.format = VK_FORMAT_R32_SFLOAT;
    inputs.convention.depth.isLinear = true;
    inputs.convention.cameras.areGiven = true;
    inputs.convention.cameras.clipFromView = key.clipFromView;
    inputs.convention.cameras.clipFromViewBefore = key.clipFromView;
    inputs.output = inputs.motionDepth = {};
    inputs.motion.keys = {&key, 1};
    inputs.motion.rowCount = 201;
    inputs.motion.movers = movers;
    expectRefused(
        "motion blur: movers[1] has no worldFromObject, and vectors.image is null: without "
        "vectors each mover needs matrices"
    );
}

TEST_F(EmbeddedRefusals, RaysWithoutTheirTablesAreNamed) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    test::SceneBuilder scene;
    render::Renderer renderer(device(), scene.world.assets);
    HostDevice host = describeHost();
    host.rayTier = device().info().rayTier;
    host.sceneLayout = renderer.scene().textureLayout();
    useOwn(host);
    settings = settingsOf("hybrid");
    expectRefused("normal.image is null");
    inputs.normal = {mHost->output.handle(), kSampled, kSampled};
    inputs.output = {};
    expectRefused("entityId.image is null");
    inputs.entityId = mHost->ids();
    expectRefused("rays.frameConstants is 0");
    inputs.rays.frameConstants = 4096;
    // Not dereferenced: it is refused for missing inputs.
    inputs.rays.tlas = reinterpret_cast<VkAccelerationStructureKHR>(uintptr_t{1});
    expectRefused("rays.tlasBuffer is null");
}

/// A device of an instance that is made for another version of Vulkan, without validation: the
/// motion blur must report its faults.
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

TEST_F(EmbeddedRefusals, AnOlderInstanceOrOneWithoutTheRaysExtensionIsNamed) {
    const auto refuseOn = [](uint32_t apiVersion, gpu::RayTier tier, const char* part) {
        const OldDevice old(apiVersion);
        ASSERT_TRUE(old.device);
        HostDevice host;
        host.physical = old.physical;
        host.device = old.device;
        host.rayTier = tier;
        host.sceneLayout =
            reinterpret_cast<VkDescriptorSetLayout>(uintptr_t{1}); // not dereferenced
        const auto made = EmbeddedMotionBlur::create(host);
        expectNamed(made ? core::Status() : core::Status(made.error()), part);
    };
    for (const uint32_t version : {VK_API_VERSION_1_0, VK_API_VERSION_1_1})
        refuseOn(version, gpu::RayTier::None, "the instance is not made for Vulkan 1.3");
    if (!device().hasRayQuery())
        GTEST_SKIP() << "the device traces no rays in compute shaders";
    refuseOn(
        VK_API_VERSION_1_3, gpu::RayTier::RayQuery, "made without VK_KHR_acceleration_structure"
    );
}

TEST_F(EmbeddedRefusals, NumbersThatAreNoneLeaveAFinitePicture) {
    for (const VkClearColorValue& motion :
         {VkClearColorValue{{kNan, kNan, 2.0f, 0.0f}},
          VkClearColorValue{{kInfinity, -kInfinity, 2.0f, 0.0f}},
          VkClearColorValue{{1e30f, 1e30f, 2.0f, 0.0f}},
          VkClearColorValue{{4.0f, 0.0f, kNan, 0.0f}}}) {
        const test::Picture output(device(), {kRefusedWidth, kRefusedHeight});
        inputs.output = output.output();
        submit([&](VkCommandBuffer commands) {
            test::clear(commands, mHost->color, {{3.0f, 2.0f, 1.0f, 1.0f}});
            test::clear(commands, mHost->motionDepth, motion);
            EXPECT_TRUE(mBlur->record(commands, 0, inputs, settings).ok());
            output.recordReadback(commands);
        });
        EXPECT_TRUE(test::allFinite(output.read()));
    }
}

/// Messages while an object is created, records and is destroyed.
class EmbeddedCare : public EmbeddedRefusals {
  protected:
    /// An object whose message goes to mReported.
    void createWithMessages(bool checksInputs) {
        HostDevice host = describeHost();
        host.checksInputs = checksInputs;
        host.message = [this](std::string_view sentence) {
            mReported.emplace_back(sentence);
            if (mOnSentence)
                mOnSentence();
        };
        useOwn(host);
        mReported.clear();
    }

    [[nodiscard]] size_t countReported(const char* part) const {
        return size_t(std::count_if(
            mReported.begin(),
            mReported.end(),
            [&](const std::string& one) { return one.find(part) != std::string::npos; }
        ));
    }

    void TearDown() override {
        mBlur.reset(); // which reports more
        EmbeddedRefusals::TearDown();
    }

    std::vector<std::string> mReported;
    std::function<void()> mOnSentence;
};

TEST_F(EmbeddedCare, UnknownUsageAndSamplesAreNotReported) {
    createWithMessages(true);
    inputs.color.usage = inputs.output.usage = 0;
    inputs.color.samples = VkSampleCountFlagBits(0);
    submitCleared([&](VkCommandBuffer commands) {
        EXPECT_TRUE(mBlur->record(commands, 0, inputs, settings).ok());
    });
    mBlur.reset();
    EXPECT_EQ(countReported("usage") + countReported("samples"), 0u);
}

TEST_F(EmbeddedCare, WhyTheDefaultMethodIsNotResolvedIsReported) {
    const std::vector<float> depth(size_t{kRefusedWidth} * kRefusedHeight, 2.0f);
    const test::HostTexels& texels =
        makeTexels(VK_FORMAT_R32_SFLOAT, {kRefusedWidth, kRefusedHeight}, depth);
    motion_blur::HostConvention& convention = inputs.convention;
    convention.depth.image = texels.describe();
    convention.depth.isLinear = true;
    convention.vectors.image = std::exchange(inputs.motionDepth, {});
    const auto countAll = [&](const char* reason) {
        createWithMessages(false);
        submitCleared([&](VkCommandBuffer commands) {
            texels.record(commands);
            const core::Status done = mBlur->record(commands, 0, inputs, {});
            EXPECT_TRUE(done.ok()) << done.error().message;
        });
        return countReported(reason);
    };
    EXPECT_EQ(countAll("neither keys nor cameras are given, so the default method is gather"), 1u);
    convention.cameras.areGiven = true;
    convention.cameras.clipFromView = convention.cameras.clipFromViewBefore =
        makeKey().clipFromView;
    EXPECT_EQ(countAll("vectors are given without keys or movers"), 1u);
    const motion_blur::HostMover byVectors{0, {}};
    inputs.motion.movers = {&byVectors, 1};
    inputs.motion.rowCount = 1;
    inputs.entityId = mHost->ids();
    EXPECT_EQ(countAll("the default method"), 0u) << "a mover without matrices follows vectors";
}

TEST_F(EmbeddedCare, ALargeImageWithoutAnExtentIsReported) {
    constexpr uint32_t kSide = 160;
    const test::HostFrame large(device(), 3 * kSide, 2 * kSide);
    const test::HostFrame right(device(), kSide, kSide);
    inputs = large.inputs();
    inputs.width = inputs.height = kSide;
    inputs.motionDepth = right.inputs().motionDepth;
    const auto countReports = [&] {
        submit([&](VkCommandBuffer commands) {
            large.recordClears(commands);
            right.recordClears(commands);
            const core::Status done = mBlur->record(commands, 0, inputs, settings);
            EXPECT_TRUE(done.ok()) << done.error().message;
        });
        return countReported("the extent of color, output is not declared");
    };
    createWithMessages(true);
    EXPECT_EQ(countReports(), 1u);
    EXPECT_EQ(countReports(), 1u) << "once";
    createWithMessages(true);
    inputs.color.extent = inputs.output.extent = {3 * kSide, 2 * kSide};
    inputs.color.area.extent = inputs.output.area.extent = {kSide, kSide};
    EXPECT_EQ(countReports(), 0u);
}

TEST_F(EmbeddedCare, AHostInCGetsTheFieldNamesOfTheCInterface) {
    std::string all;
    ShutterBlurDevice described = test::describeForC(device());
    described.checksInputs = VK_TRUE;
    described.messageUser = &all;
    described.message = [](void* user, const char* sentence) {
        *static_cast<std::string*>(user) += sentence;
    };
    mC.emplace(described);
    CInputs given = makeInputsOfC();
    const std::vector<float> depth(size_t{kRefusedWidth} * kRefusedHeight, 2.0f);
    const test::HostTexels& texels =
        makeTexels(VK_FORMAT_R32_SFLOAT, {kRefusedWidth, kRefusedHeight}, depth);
    given.depth = test::convertForC(texels.describe());
    given.vectors = std::exchange(given.motionDepth, {});
    given.depthIsLinear = VK_TRUE;
    const CSettings cheap = plainInC();
    submitCleared([&](VkCommandBuffer commands) {
        texels.record(commands);
        EXPECT_EQ(shutterBlurRecord(mC->blur, commands, 0, &given, &cheap), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
    });
    mC.reset();
    EXPECT_NE(all.find("without cameras, vectors and depth are not compared"), std::string::npos)
        << all;
}

TEST_F(EmbeddedCare, CallsOfASecondThreadOrWithinACallbackAreRefused) {
    std::string within;
    std::string concurrent;
    const auto call = [&](std::string& message) {
        const core::Status done = mBlur->markDone(0);
        message = done ? "" : done.error().message;
    };
    createWithMessages(false);
    settings = {}; // whose default method is reported
    mOnSentence = [&] {
        call(within);
        std::thread([&] { call(concurrent); }).join();
    };
    EXPECT_TRUE(record().ok());
    mOnSentence = nullptr;
    EXPECT_NE(within.find("called within a callback of its own"), std::string::npos) << within;
    EXPECT_NE(concurrent.find("another thread is in a call"), std::string::npos) << concurrent;
    EXPECT_TRUE(mBlur->markDone(0).ok()) << "alone again";
}

TEST_F(EmbeddedCare, TwoThreadsThatRecordAtOnceGetPicturesOrSentences) {
    constexpr int kRounds = 60;
    const HostCameraKey key = makeKey();
    std::array<std::deque<gpu::Frame>, 2> frames; // never submitted
    for (int round = 0; round < kRounds; ++round)
        for (auto& own : frames)
            own.emplace_back(device()).begin();
    std::atomic<int> recorded = 0;
    const auto work = [&](uint32_t number) {
        HostInputs given = makeInputs();
        given.entityId = mHost->ids();
        given.motion.keys = {&key, 1};
        given.motion.rowCount = 1;
        given.motion.view = number;
        for (gpu::Frame& frame : frames[number]) {
            const core::Status done =
                mBlur->record(frame.commands(), number, given, settingsOf("resolved"));
            recorded += done.ok();
            if (!done)
                expectRefusal(done, "another thread");
            while (!mBlur->markDone(number))
                std::this_thread::yield();
        }
    };
    std::thread other(work, 1);
    work(0);
    other.join();
    EXPECT_GT(recorded, 0);
}

TEST_F(EmbeddedCare, DestroyingAnObjectTooEarlyIsReported) {
    createWithMessages(false);
    gpu::Frame dropped(device()); // never submitted
    dropped.begin();
    mHost->recordClears(dropped.commands());
    ASSERT_TRUE(mBlur->record(dropped.commands(), 0, inputs, settings).ok());
    mBlur.reset();
    EXPECT_EQ(mReported.size(), 1u);
    EXPECT_EQ(countReported("destroyed while frame 0 is pending"), 1u);
}

} // namespace
} // namespace shutter
