// SPDX-License-Identifier: MIT
// Tests of the C interface alone: versions, sizes of structures, chains of features, presets. Its
// refusals are in embedded_refusals_test.cpp, its pictures with those of the C++ interface.
#include "engine/math/transform.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.hpp"
#include "modules/motion_blur/presets.h"
#include "tests/gpu/embedding_host.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace shutter {
namespace {

constexpr uint32_t kHostWidth = 96;
constexpr uint32_t kHostHeight = 64;

class CInterface : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (mBlur)
            mHost.emplace(device(), kHostWidth, kHostHeight);
    }

    void TearDown() override {
        mHost.reset();
        EmbeddedTest::TearDown();
    }

    static ShutterBlurDevice describeMeasuring() {
        ShutterBlurDevice described = test::describeForC(device());
        described.measures = VK_TRUE;
        return described;
    }

    void record(
        const test::BlurOfC& c,
        const ShutterBlurInputs& inputs,
        const ShutterBlurSettings* settings = nullptr,
        const test::Picture* output = nullptr
    ) const {
        submit([&](VkCommandBuffer commands) {
            mHost->recordClears(commands);
            EXPECT_EQ(
                shutterBlurRecord(c.blur, commands, 0, &inputs, settings), SHUTTER_BLUR_SUCCESS
            ) << shutterBlurGetMessage();
            if (output)
                output->recordReadback(commands);
        });
    }

    std::optional<test::HostFrame> mHost;
};

TEST_F(CInterface, OlderStructuresAreTaken) {
    const test::BlurOfC c(device());
    const test::InputsForC reported(mHost->inputs());
    ShutterBlurInputs inputs = reported.inputs;
    // A header that ended before the fields of "resolved".
    inputs.structBytes = offsetof(ShutterBlurInputs, entityId);
    inputs.keyCount = 77; // behind its end
    record(c, inputs);
    // One that ended before the response, with rubbish in its padding and behind it.
    inputs = reported.inputs;
    inputs.structBytes = offsetof(ShutterBlurInputs, responsePoints);
    constexpr size_t kEnd = offsetof(ShutterBlurInputs, showsInputs) + sizeof(VkBool32);
    static_assert(kEnd < offsetof(ShutterBlurInputs, responsePoints), "there was padding");
    std::memset(reinterpret_cast<std::byte*>(&inputs) + kEnd, 0x5A, sizeof(inputs) - kEnd);
    record(c, inputs);
    // One that ended before the lens: in padding, too, nothing is taken for one.
    inputs = reported.inputs;
    constexpr size_t kLast = offsetof(ShutterBlurInputs, blendedOpacityInAlpha) + sizeof(VkBool32);
    static_assert(kLast < offsetof(ShutterBlurInputs, lens), "there was padding");
    inputs.structBytes = offsetof(ShutterBlurInputs, lens);
    std::memset(reinterpret_cast<std::byte*>(&inputs) + kLast, 0x5A, sizeof(inputs) - kLast);
    record(c, inputs);
    static_assert(
        offsetof(ShutterBlurPlan, hasLens) ==
            offsetof(ShutterBlurPlan, blendedOpacityInAlpha) + sizeof(VkBool32),
        "an older plan had no padding"
    );
    ShutterBlurMemory memory = shutterBlurDefaultMemory();
    ASSERT_EQ(shutterBlurGetMemory(c.blur, &memory), SHUTTER_BLUR_SUCCESS);
    EXPECT_GT(memory.bytes, 0u);
    EXPECT_GT(memory.blockCount, 0u);
}

TEST_F(CInterface, EachPresetRunsAndOffIsACopy) {
    const test::BlurOfC c(describeMeasuring());
    const gpu::Image normal =
        test::makeImage(device(), "normal", VK_FORMAT_R16G16B16A16_SFLOAT, kHostWidth, kHostHeight);
    submit([&](VkCommandBuffer commands) {
        test::clear(commands, normal, {});
        test::moveOn(commands, normal.handle(), test::kWritten, test::kSampled);
    });
    const motion_blur::HostCameraKey key{
        1.0, glm::dmat4(1.0), math::clipFromViewPerspective(1.0, 1.5, 0.1)};
    const motion_blur::HostMover mover{0, {}};
    const test::Picture output(device(), {kHostWidth, kHostHeight});
    motion_blur::HostInputs given = mHost->inputs();
    given.entityId = mHost->ids();
    given.normal = {normal.handle(), test::kSampled, test::kSampled};
    given.output = output.output();
    given.motion.keys = {&key, 1};
    given.motion.movers = {&mover, 1};
    given.motion.rowCount = 1;
    given.reveal.record = [](const motion_blur::RevealTask&) {};
    given.samples.record = [](const motion_blur::SampleTask&) {};
    const test::InputsForC reported(given);
    for (const motion_blur::Preset& preset : motion_blur::listPresets()) {
        SCOPED_TRACE(preset.name);
        ShutterBlurSettings settings = shutterBlurDefaultSettings();
        settings.preset = preset.name;
        record(c, reported.inputs, &settings, &output);
        ShutterBlurReport report = shutterBlurDefaultReport();
        ASSERT_EQ(shutterBlurGetReport(c.blur, 0, &report), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
        EXPECT_GT(report.passCount, 0u);
        EXPECT_EQ(report.counterCount == 0, preset.isOff);
        const image::Image picture = output.read();
        for (size_t i = 0; preset.isOff && i < picture.pixels.size(); i += 4)
            ASSERT_EQ(picture.pixels[i], 3.0f) << "the input, to the bit";
    }
}

TEST_F(CInterface, PreparationAheadOfFramesSucceedsAndIsReported) {
    const ShutterBlurDevice described = describeMeasuring();
    const test::BlurOfC c(described);
    ShutterBlurPlan plan = shutterBlurDefaultPlan();
    plan.width = kHostWidth;
    plan.height = kHostHeight;
    uint64_t bytes = 0;
    EXPECT_EQ(shutterBlurEstimateMemory(&described, &plan, &bytes), SHUTTER_BLUR_SUCCESS)
        << shutterBlurGetMessage();
    EXPECT_GT(bytes, 0u);
    EXPECT_EQ(shutterBlurEstimateMemory(&described, &plan, nullptr), SHUTTER_BLUR_ERROR_REFUSED);
    EXPECT_EQ(shutterBlurWarmUp(c.blur, &plan), SHUTTER_BLUR_SUCCESS) << shutterBlurGetMessage();
    EXPECT_EQ(shutterBlurStartWarmUp(c.blur, &plan), SHUTTER_BLUR_SUCCESS);
    VkBool32 isWarm = VK_FALSE;
    while (!isWarm && shutterBlurIsWarm(c.blur, &isWarm) == SHUTTER_BLUR_SUCCESS)
        std::this_thread::yield();
    EXPECT_TRUE(isWarm);
}

TEST_F(CInterface, TheCppObjectMovesAndRefusesCallsWhereItIsEmpty) {
    auto created =
        MotionBlur::create({device().physical(), device().handle(), device().queueFamily(), 2});
    ASSERT_TRUE(created) << created.message();
    EXPECT_EQ(created.message(), "");
    MotionBlur blur = std::move(*created);
    EXPECT_TRUE(blur);
    EXPECT_FALSE(*created);
    const test::InputsForC given(mHost->inputs());
    ShutterBlurInputs inputs = given.inputs;
    gpu::Frame frame(device());
    frame.begin();
    mHost->recordClears(frame.commands());
    const BlurStatus done = blur.record(frame.commands(), 0, inputs, BlurSettings("gather"));
    EXPECT_TRUE(done) << done.message();
    inputs.width = 0;
    const BlurStatus wrong = blur.record(frame.commands(), 1, inputs);
    const BlurStatus empty = created->record(frame.commands(), 0, inputs);
    frame.submit();
    frame.wait();
    EXPECT_EQ(wrong.code(), SHUTTER_BLUR_ERROR_REFUSED);
    EXPECT_NE(wrong.message().find("the size is 0 x 64"), std::string::npos) << wrong.message();
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
    plan.width = kHostWidth;
    plan.height = kHostHeight;
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

TEST(CppStructures, CppStructuresHaveTheDefaultsOfCAndReferenceTheirArguments) {
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
    uint32_t requested = 0;
    const auto reveal = [&](const ShutterBlurRevealTask* task) { requested += task->width; };
    auto samples = [&](const ShutterBlurSampleTask* task) { requested += task->height; };
    given.setReveal(reveal);
    given.setSamples(samples);
    ShutterBlurRevealTask revealTask{};
    revealTask.width = 5;
    ShutterBlurSampleTask sampleTask{};
    sampleTask.height = 70;
    given.recordReveal(given.revealUser, &revealTask);
    given.recordSamples(given.samplesUser, &sampleTask);
    EXPECT_EQ(requested, 75u);
    std::string reported;
    const auto message = [&](const char* sentence) { reported = sentence; };
    BlurDevice described;
    described.setMessage(message);
    described.message(described.messageUser, "a message");
    EXPECT_EQ(reported, "a message");
    const BlurImage image(VK_NULL_HANDLE, VK_IMAGE_LAYOUT_GENERAL, {}, VK_FORMAT_R8_UINT);
    EXPECT_EQ(image.before.layout, VK_IMAGE_LAYOUT_GENERAL);
    EXPECT_TRUE(image.after.stages == 0 && image.extent.width == 0 && image.samples == 0);
    std::array<float, 16> numbers{};
    std::iota(numbers.begin(), numbers.end(), 1.0f);
    setMatrix(given.cameras.viewFromWorld, numbers.data());
    for (int i = 0; i < 16; ++i)
        EXPECT_EQ(given.cameras.viewFromWorld[i], i + 1.0);
}

TEST(CInterfaceLibrary, TheVersionIsTheHeadersAndListedMethodsAreThoseThatAHostCanRun) {
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
    std::set<std::string> names;
    for (uint32_t i = 0; shutterBlurGetMethod(i); ++i)
        names.insert(shutterBlurGetMethod(i));
    for (const char* name : {"gather", "resolved", "hybrid", "adaptive", "rosado2007"})
        EXPECT_TRUE(names.contains(name)) << name;
    EXPECT_FALSE(names.contains("denoised"));
}

TEST(CInterfaceFeatures, RequiredFeaturesAreAddedToTheHostsChain) {
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    v13.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceVulkan12Features v12{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
    ASSERT_EQ(shutterBlurAddFeatures(&features), SHUTTER_BLUR_SUCCESS);
    EXPECT_TRUE(features.features.shaderStorageImageExtendedFormats);
    EXPECT_TRUE(v12.bufferDeviceAddress && v12.scalarBlockLayout);
    EXPECT_TRUE(v13.synchronization2 && v13.maintenance4 && v13.dynamicRendering);
    EXPECT_TRUE(v13.subgroupSizeControl) << "which is used where it is enabled, and not required";

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
    EXPECT_EQ(shutterBlurAddFeatures(&old), SHUTTER_BLUR_ERROR_REFUSED);
    EXPECT_NE(std::strstr(shutterBlurGetMessage(), "no structure with scalarBlockLayout"), nullptr);
    EXPECT_FALSE(address.bufferDeviceAddress) << "all or nothing";
    EXPECT_EQ(shutterBlurAddFeatures(nullptr), SHUTTER_BLUR_ERROR_REFUSED);
}

} // namespace
} // namespace shutter
