// SPDX-License-Identifier: MIT
// The C interface gives the bits of the C++ one, and refuses in sentences what that one refuses,
// and what only C can get wrong.
#include "engine/gpu/frame.h"
#include "engine/math/transform.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.hpp"
#include "tests/gpu/embedding_host.h"
#include "tests/support/picture.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using test::HostFrame;
using test::kCopied;
using test::kNothing;
using test::kSampled;
using test::kWritten;

constexpr uint32_t kWidth = 64;
constexpr uint32_t kHeight = 48;

ShutterBlurUse convert(const graph::OutsideUse& use) {
    return {use.layout, use.stages, use.access};
}

void expectRefusal(ShutterBlurResult result, const std::string& part) {
    EXPECT_EQ(result, SHUTTER_BLUR_ERROR_REFUSED) << "expected: " << part;
    const std::string message = shutterBlurGetMessage();
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

class CInterface : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        mHost.emplace(device(), kWidth, kHeight);
        mFrame.emplace(device());
        const ShutterBlurDevice described = describeDevice();
        ASSERT_EQ(shutterBlurCreate(&described, &mBlur), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
    }

    void TearDown() override {
        shutterBlurDestroy(mBlur);
        mFrame.reset();
        mHost.reset();
        EmbeddedTest::TearDown();
    }

    static ShutterBlurDevice describeDevice() {
        ShutterBlurDevice described = shutterBlurDefaultDevice();
        described.physical = device().physical();
        described.device = device().handle();
        described.queueFamily = device().queueFamily();
        described.hasDebugUtils = VK_TRUE;
        return described;
    }

    [[nodiscard]] ShutterBlurInputs makeInputs() const {
        ShutterBlurInputs inputs = shutterBlurDefaultInputs();
        inputs.width = kWidth;
        inputs.height = kHeight;
        inputs.color.image = mHost->color.handle();
        inputs.color.before = convert(kWritten);
        inputs.color.after = convert(kSampled);
        inputs.motionDepth = inputs.color;
        inputs.motionDepth.image = mHost->motionDepth.handle();
        return inputs;
    }

    ShutterBlurResult record(
        const ShutterBlurInputs& inputs,
        const ShutterBlurSettings* settings = nullptr,
        const std::function<void(VkCommandBuffer)>& behind = {}
    ) {
        mFrame->begin();
        mHost->recordClears(mFrame->commands());
        const ShutterBlurResult result =
            shutterBlurRecord(mBlur, mFrame->commands(), 0, &inputs, settings);
        if (behind && result == SHUTTER_BLUR_SUCCESS)
            behind(mFrame->commands());
        mFrame->submit();
        mFrame->wait();
        return result;
    }

    /// All pixels are entity 0, which moves.
    static void recordIds(VkCommandBuffer commands, const gpu::Image& ids) {
        test::moveOn(commands, ids.handle(), kNothing, kWritten);
        const VkClearColorValue zero{};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(commands, ids.handle(), kWritten.layout, &zero, 1, &all);
    }

    ShutterBlur* mBlur = nullptr;
    std::optional<HostFrame> mHost;
    std::optional<gpu::Frame> mFrame;
};

TEST_F(CInterface, EachMethodGivesTheBitsOfTheCppInterface) {
    const auto reference = create(describeHost());
    ASSERT_TRUE(reference);
    const auto draw = [&](const std::function<core::Status(VkCommandBuffer, VkImage)>& blur) {
        const test::Picture output(device(), "output", {kWidth, kHeight});
        mFrame->begin();
        mHost->recordClears(mFrame->commands());
        const core::Status done = blur(mFrame->commands(), output.handle());
        EXPECT_TRUE(done.ok()) << done.error().message;
        output.recordReadback(mFrame->commands());
        mFrame->submit();
        mFrame->wait();
        return output.read();
    };
    const gpu::Image ids = test::makeImage(device(), "ids", VK_FORMAT_R32_UINT, kWidth, kHeight);
    const auto projection = math::clipFromViewPerspective(1.0, 1.5, 0.1);
    std::set<std::string> names;
    for (uint32_t i = 0; shutterBlurGetMethod(i); ++i) {
        const std::string name = shutterBlurGetMethod(i);
        SCOPED_TRACE(name);
        names.insert(name);
        if (name == "hybrid" || name == "adaptive")
            continue; // own_reveal_test.cpp, own_samples_test.cpp
        motion_blur::MotionBlurSettings own;
        own.method = &motion_blur::getMethod(name);
        own.sampleCount = 9;
        own.jitter = 0.0f;
        const image::Image wanted = draw([&](VkCommandBuffer commands, VkImage output) {
            motion_blur::HostInputs inputs = mHost->inputs();
            inputs.output = {output, kNothing, kCopied};
            inputs.entityId = {ids.handle(), kWritten, kSampled};
            const motion_blur::HostCameraKey key{1.0, glm::dmat4(1.0), projection};
            const motion_blur::HostMover mover{0, {}};
            inputs.motion.keys = {&key, 1};
            inputs.motion.movers = {&mover, 1};
            inputs.motion.rowCount = 4;
            inputs.convention.cameras.areGiven = true;
            inputs.convention.cameras.clipFromView = projection;
            inputs.convention.cameras.clipFromViewBefore = projection;
            recordIds(commands, ids);
            return reference->record(commands, 0, inputs, own);
        });
        const image::Image made = draw([&](VkCommandBuffer commands, VkImage output) {
            ShutterBlurInputs inputs = makeInputs();
            inputs.output.image = output;
            inputs.output.before = convert(kNothing);
            inputs.output.after = convert(kCopied);
            inputs.entityId = inputs.color;
            inputs.entityId.image = ids.handle();
            ShutterBlurCameraKey key{1.0, {}, {}};
            const glm::dmat4 unit(1.0);
            std::memcpy(key.viewFromWorld, &unit, sizeof(unit));
            std::memcpy(key.clipFromView, &projection, sizeof(projection));
            ShutterBlurCameras& cameras = inputs.cameras;
            cameras.areGiven = VK_TRUE;
            for (double* view : {cameras.viewFromWorld, cameras.viewFromWorldBefore})
                std::memcpy(view, &unit, sizeof(unit));
            for (double* clip : {cameras.clipFromView, cameras.clipFromViewBefore})
                std::memcpy(clip, &projection, sizeof(projection));
            const ShutterBlurMover mover{0, nullptr};
            inputs.keyCount = inputs.moverCount = 1;
            inputs.keys = &key;
            inputs.movers = &mover;
            inputs.rowCount = 4;
            ShutterBlurSettings settings = shutterBlurDefaultSettings();
            settings.method = name.c_str();
            settings.sampleCount = 9;
            const ShutterBlurValue value{"jitter", "0"};
            settings.values = &value;
            settings.valueCount = 1;
            recordIds(commands, ids);
            const ShutterBlurResult result =
                shutterBlurRecord(mBlur, commands, 0, &inputs, &settings);
            return result == SHUTTER_BLUR_SUCCESS ? core::Status()
                                                  : core::Status({shutterBlurGetMessage()});
        });
        EXPECT_TRUE(test::sameBits(made, wanted));
    }
    EXPECT_TRUE(names.contains("gather") && names.contains("resolved"));
    EXPECT_TRUE(names.contains("hybrid") && names.contains("adaptive"));
    EXPECT_TRUE(names.contains("rosado2007"));
    EXPECT_FALSE(names.contains("denoised"));
}

TEST_F(CInterface, WhatIsWrongIsNamed) {
    const auto refuse = [&](const std::function<void(ShutterBlurInputs&)>& change,
                            const std::string& part) {
        ShutterBlurInputs inputs = makeInputs();
        change(inputs);
        expectRefusal(record(inputs), part);
    };
    EXPECT_EQ(record(makeInputs()), SHUTTER_BLUR_SUCCESS) << shutterBlurGetMessage();
    using I = ShutterBlurInputs;
    refuse([](I& in) { in.structBytes = 0; }, "inputs.structBytes is 0");
    refuse([](I& in) { in.structBytes = 4; }, "inputs.structBytes is 4");
    refuse([](I& in) { in.structBytes += 8; }, "or less of an older header");
    refuse([](I& in) { in.width = 0; }, "the size is 0 x 48");
    refuse([](I& in) { in.responsePointCount = 2; }, "responsePoints is null");
    static const ShutterBlurResponsePoint kLate[2] = {{0.5, 1.0}, {1.0, 1.0}};
    refuse(
        [](I& in) {
            in.responsePointCount = 2;
            in.responsePoints = kLate;
        },
        "responsePoints[0].time is 0.5"
    );
    refuse([](I& in) { in.color.format = VK_FORMAT_R8G8B8A8_UNORM; }, "color.format is R8G8B8A8");
    refuse([](I& in) { in.color.usage = VK_IMAGE_USAGE_SAMPLED_BIT; }, "color.usage lacks");
    refuse(
        [](I& in) {
            in.color.extent = {32, 48};
        },
        "color.extent is 32 x 48, all of which is used where area is not said"
    );
    refuse(
        [](I& in) {
            in.motionDepth.extent = {80, 48};
            in.motionDepth.area.extent = {64, 48};
        },
        "motionDepth is part of a larger image; give it as vectors and depth, which may be"
    );
    refuse(
        [](I& in) { in.motionDepth = {}; },
        "motionDepth.image is null, and so are vectors.image and depth.image"
    );
    refuse([](I& in) { in.keyCount = 1; }, "keys is null, keyCount is 1");
    refuse([](I& in) { in.moverCount = 2; }, "movers is null, moverCount is 2");
    refuse([](I& in) { in.view = 7; }, "motion blur: view is 7");
    mFrame->begin();
    expectRefusal(
        shutterBlurRecord(mBlur, mFrame->commands(), 0, nullptr, nullptr), "inputs is null"
    );
    const ShutterBlurInputs inputs = makeInputs();
    expectRefusal(shutterBlurRecord(mBlur, VK_NULL_HANDLE, 0, &inputs, nullptr), "command buffer");
    expectRefusal(shutterBlurRecord(mBlur, mFrame->commands(), 9, &inputs, nullptr), "frame is 9");
    expectRefusal(
        shutterBlurRecord(nullptr, mFrame->commands(), 0, &inputs, nullptr), "blur is null"
    );
    mFrame->submit();
    mFrame->wait();
    expectRefusal(shutterBlurMarkDone(mBlur, 2), "frame is 2, framesInFlight 2");
    expectRefusal(shutterBlurCloseView(mBlur, 2), "view is 2, framesInFlight 2");
    expectRefusal(shutterBlurGetMemory(mBlur, nullptr), "memory is null");
}

TEST_F(CInterface, WrongSettingsAreNamed) {
    const ShutterBlurSettings defaults = shutterBlurDefaultSettings();
    EXPECT_EQ(defaults.method, nullptr);
    EXPECT_EQ(record(makeInputs(), &defaults), SHUTTER_BLUR_SUCCESS);
    const auto refuse = [&](const std::function<void(ShutterBlurSettings&)>& change,
                            const std::string& part) {
        ShutterBlurSettings settings = shutterBlurDefaultSettings();
        change(settings);
        expectRefusal(record(makeInputs(), &settings), part);
    };
    using S = ShutterBlurSettings;
    static const ShutterBlurValue kUnknown{"speed", "1"};
    static const ShutterBlurValue kWord{"history", "perhaps"};
    static const ShutterBlurValue kRange{"jitter", "7"};
    static const ShutterBlurValue kNull{"jitter", nullptr};
    const auto refuseValue = [&](const ShutterBlurValue& value, const std::string& part) {
        refuse(
            [&](S& settings) {
                settings.values = &value;
                settings.valueCount = 1;
            },
            part
        );
    };
    refuse(
        [](S& settings) { settings.method = "teapot"; }, "settings.method is 'teapot', it must be"
    );
    refuse([](S& settings) { settings.method = "adaptive"; }, "recordSamples is null");
    refuse([](S& settings) { settings.sampleCount = 1000000; }, "sampleCount");
    refuse([](S& settings) { settings.method = "hybrid"; }, "recordReveal is null");
    refuse([](S& settings) { settings.valueCount = 1; }, "settings.values is null");
    refuseValue(kUnknown, "settings.values has no 'speed'");
    refuseValue(kWord, "history: 'perhaps' is not true or false");
    refuseValue(kRange, "jitter: 7 must be");
    refuseValue(kNull, "a name or value of settings.values is null");
}

TEST_F(CInterface, AWrongDeviceIsNamed) {
    const auto refuse = [](const std::function<void(ShutterBlurDevice&)>& change,
                           const std::string& part) {
        ShutterBlurDevice described = describeDevice();
        change(described);
        ShutterBlur* blur = reinterpret_cast<ShutterBlur*>(uintptr_t{1});
        expectRefusal(shutterBlurCreate(&described, &blur), part);
        EXPECT_EQ(blur, nullptr);
    };
    using D = ShutterBlurDevice;
    refuse(
        [](D& device) { device.physical = VK_NULL_HANDLE; }, "ShutterBlurDevice::physical is null"
    );
    refuse([](D& device) { device.framesInFlight = 0; }, "framesInFlight is 0");
    refuse([](D& device) { device.queueFamily = 99; }, "queueFamily 99");
    refuse([](D& device) { device.structBytes = 1; }, "device.structBytes is 1");
    ShutterBlur* blur = nullptr;
    expectRefusal(shutterBlurCreate(nullptr, &blur), "device is null");
    const ShutterBlurDevice described = describeDevice();
    expectRefusal(shutterBlurCreate(&described, nullptr), "blur is null");
    expectRefusal(shutterBlurCheckDevice(VK_NULL_HANDLE, 0), "physical is null");
    expectRefusal(shutterBlurCheckDevice(device().physical(), 99), "queueFamily 99");
    EXPECT_EQ(
        shutterBlurCheckDevice(device().physical(), device().queueFamily()), SHUTTER_BLUR_SUCCESS
    );
    shutterBlurDestroy(nullptr);
}

TEST_F(CInterface, OlderStructuresAreTaken) {
    ShutterBlurInputs inputs = makeInputs();
    // A header that ended before the fields of "resolved".
    inputs.structBytes = offsetof(ShutterBlurInputs, entityId);
    inputs.keyCount = 77; // behind its end
    EXPECT_EQ(record(inputs), SHUTTER_BLUR_SUCCESS) << shutterBlurGetMessage();
    // One that ended before the response, with rubbish in its padding and behind it.
    inputs = makeInputs();
    inputs.structBytes = offsetof(ShutterBlurInputs, responsePoints);
    constexpr size_t kEnd = offsetof(ShutterBlurInputs, showsInputs) + sizeof(VkBool32);
    static_assert(kEnd < offsetof(ShutterBlurInputs, responsePoints), "there was padding");
    std::memset(reinterpret_cast<std::byte*>(&inputs) + kEnd, 0x5A, sizeof(inputs) - kEnd);
    EXPECT_EQ(record(inputs), SHUTTER_BLUR_SUCCESS) << shutterBlurGetMessage();
}

TEST_F(CInterface, TheCppObjectMovesAndRefusesCallsWhereItIsEmpty) {
    auto created =
        MotionBlur::create({device().physical(), device().handle(), device().queueFamily(), 2});
    ASSERT_TRUE(created) << created.message();
    EXPECT_EQ(created.message(), "");
    MotionBlur blur = std::move(*created);
    EXPECT_TRUE(blur);
    EXPECT_FALSE(*created);
    mFrame->begin();
    mHost->recordClears(mFrame->commands());
    ShutterBlurInputs inputs = makeInputs();
    const BlurStatus done = blur.record(mFrame->commands(), 0, inputs, BlurSettings("gather"));
    EXPECT_TRUE(done) << done.message();
    inputs.width = 0;
    const BlurStatus wrong = blur.record(mFrame->commands(), 1, inputs);
    const BlurStatus empty = created->record(mFrame->commands(), 0, inputs);
    mFrame->submit();
    mFrame->wait();
    EXPECT_EQ(wrong.code(), SHUTTER_BLUR_ERROR_REFUSED);
    EXPECT_NE(wrong.message().find("the size is 0 x 48"), std::string::npos) << wrong.message();
    EXPECT_EQ(empty.message(), "motion blur: blur is null");
    EXPECT_GT(blur.memory()->bytes, 0u);
    EXPECT_FALSE(created->memory());
    EXPECT_EQ(MotionBlur().memory()->bytes, 0u);
    const auto warm = blur.isWarm();
    EXPECT_TRUE(warm && *warm);
    const auto unmeasured = blur.report(0);
    EXPECT_FALSE(unmeasured);
    EXPECT_EQ(unmeasured->passCount, 0u);
    const auto none = MotionBlur::create({});
    EXPECT_FALSE(none || *none);
    EXPECT_NE(none.message().find("ShutterBlurDevice::physical is null"), std::string::npos);
}

TEST_F(CInterface, TheCppObjectRecordsAPlanThatItWarmedUpFor) {
    const BlurDevice described(device().physical(), device().handle(), device().queueFamily());
    BlurSettings settings("gather");
    const std::array<ShutterBlurValue, 1> values{{{"jitter", "0"}}};
    settings.setValues(values);
    BlurPlan plan;
    plan.width = kWidth;
    plan.height = kHeight;
    plan.outputFormat = VK_FORMAT_UNDEFINED;
    plan.settings = &settings;
    const auto bytes = MotionBlur::estimateMemory(described, plan);
    ASSERT_TRUE(bytes) << bytes.message();
    EXPECT_GT(*bytes, 0u);
    auto blur = MotionBlur::create(described);
    ASSERT_TRUE(blur) << blur.message();
    EXPECT_TRUE(blur->warmUp(plan));
    EXPECT_TRUE(blur->markDone(1));
    EXPECT_TRUE(blur->closeView(1));
    plan.width = 0;
    EXPECT_FALSE(MotionBlur::estimateMemory(described, plan));
}

TEST(CppStructures, BeginWithTheDefaultsOfCAndPointToWhatTheyAreGiven) {
    const BlurInputs inputs(3, 2);
    const ShutterBlurInputs inC = shutterBlurDefaultInputs();
    EXPECT_EQ(inputs.structBytes, sizeof(ShutterBlurInputs));
    EXPECT_EQ(inputs.noEntity, inC.noEntity);
    EXPECT_EQ(inputs.timeBefore(), shutterBlurGetTimeBefore(&inC));
    const std::array<ShutterBlurCameraKey, 2> keys{};
    const std::vector<ShutterBlurMover> movers(3);
    const ShutterBlurResponsePoint points[] = {{0.0, 1.0}, {1.0, 1.0}};
    BlurInputs given;
    given.setKeys(keys);
    given.setMovers(movers);
    given.setResponse(points);
    EXPECT_TRUE(given.keys == keys.data() && given.keyCount == 2);
    EXPECT_TRUE(given.movers == movers.data() && given.moverCount == 3);
    EXPECT_TRUE(given.responsePoints == points && given.responsePointCount == 2);
    uint32_t asked = 0;
    const auto reveal = [&](const ShutterBlurRevealTask* task) { asked += task->width; };
    auto samples = [&](const ShutterBlurSampleTask* task) { asked += task->height; };
    given.setReveal(reveal);
    given.setSamples(samples);
    ShutterBlurRevealTask revealTask{};
    revealTask.width = 5;
    ShutterBlurSampleTask sampleTask{};
    sampleTask.height = 70;
    given.recordReveal(given.revealUser, &revealTask);
    given.recordSamples(given.samplesUser, &sampleTask);
    EXPECT_EQ(asked, 75u);
    std::string told;
    const auto message = [&](const char* sentence) { told = sentence; };
    BlurDevice described;
    described.setMessage(message);
    described.message(described.messageUser, "said");
    EXPECT_EQ(told, "said");
    const BlurImage image(VK_NULL_HANDLE, VK_IMAGE_LAYOUT_GENERAL, {}, VK_FORMAT_R8_UINT);
    EXPECT_EQ(image.before.layout, VK_IMAGE_LAYOUT_GENERAL);
    EXPECT_TRUE(image.after.stages == 0 && image.extent.width == 0 && image.samples == 0);
    const glm::mat4 rows(
        1.0f,
        2.0f,
        3.0f,
        4.0f,
        5.0f,
        6.0f,
        7.0f,
        8.0f,
        9.0f,
        10.0f,
        11.0f,
        12.0f,
        13.0f,
        14.0f,
        15.0f,
        16.0f
    );
    setMatrix(given.cameras.viewFromWorld, &rows[0][0]);
    for (int i = 0; i < 16; ++i)
        EXPECT_EQ(given.cameras.viewFromWorld[i], i + 1.0);
}

TEST_F(CInterface, MemoryIsTold) {
    ASSERT_EQ(record(makeInputs()), SHUTTER_BLUR_SUCCESS) << shutterBlurGetMessage();
    ShutterBlurMemory memory = shutterBlurDefaultMemory();
    ASSERT_EQ(shutterBlurGetMemory(mBlur, &memory), SHUTTER_BLUR_SUCCESS);
    EXPECT_GT(memory.bytes, 0u);
    EXPECT_GT(memory.blockCount, 0u);
}

TEST(CInterfaceVersion, IsThatOfTheHeader) {
    EXPECT_EQ(shutterBlurGetVersion(), SHUTTER_BLUR_VERSION);
    EXPECT_TRUE(shutterBlurIsCompatible(SHUTTER_BLUR_VERSION));
    EXPECT_FALSE(shutterBlurIsCompatible(SHUTTER_BLUR_VERSION + 1)) << "a newer patch";
    EXPECT_FALSE(shutterBlurIsCompatible(SHUTTER_BLUR_VERSION + (1u << 12)));
    EXPECT_FALSE(shutterBlurIsCompatible(SHUTTER_BLUR_VERSION + (1u << 22)));
    EXPECT_EQ(
        std::to_string(SHUTTER_BLUR_VERSION_MAJOR) + "." +
            std::to_string(SHUTTER_BLUR_VERSION_MINOR) + "." +
            std::to_string(SHUTTER_BLUR_VERSION_PATCH),
        SHUTTER_PROJECT_VERSION
    );
}

TEST(CInterfaceFeatures, AreAddedToAHostsOwnChain) {
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    v13.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceVulkan12Features v12{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
    ASSERT_EQ(shutterBlurAddFeatures(&features), SHUTTER_BLUR_SUCCESS);
    EXPECT_TRUE(features.features.shaderStorageImageExtendedFormats);
    EXPECT_TRUE(v12.bufferDeviceAddress && v12.scalarBlockLayout);
    EXPECT_TRUE(v13.synchronization2 && v13.maintenance4 && v13.dynamicRendering);

    // A host of structures that came before those of the versions.
    VkPhysicalDeviceMaintenance4Features maintenance{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES};
    VkPhysicalDeviceSynchronization2Features synchronization{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, &maintenance};
    VkPhysicalDeviceScalarBlockLayoutFeatures scalar{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES, &synchronization};
    VkPhysicalDeviceBufferDeviceAddressFeatures address{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES, &scalar};
    VkPhysicalDeviceFeatures2 old{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &address};
    ASSERT_EQ(shutterBlurAddFeatures(&old), SHUTTER_BLUR_SUCCESS);
    EXPECT_TRUE(
        address.bufferDeviceAddress && scalar.scalarBlockLayout &&
        synchronization.synchronization2 && maintenance.maintenance4
    );

    address.pNext = &synchronization;
    address.bufferDeviceAddress = VK_FALSE;
    expectRefusal(shutterBlurAddFeatures(&old), "no structure with scalarBlockLayout");
    EXPECT_FALSE(address.bufferDeviceAddress) << "all or nothing";
    expectRefusal(shutterBlurAddFeatures(nullptr), "features is null");
}

} // namespace
} // namespace shutter
