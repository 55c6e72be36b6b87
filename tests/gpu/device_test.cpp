// SPDX-License-Identifier: MIT
// Which device is taken, what is said when there is none, and what a device without rays refuses.
#include "engine/gpu/device.h"
#include "game/shot/picture_drawer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <string>
#include <vector>

namespace shutter {
namespace {

gpu::DeviceInfo makeInfo(const std::string& name, const std::string& kind, gpu::RayTier tier) {
    gpu::DeviceInfo info;
    info.name = name;
    info.kind = kind;
    info.rayTier = tier;
    return info;
}

std::vector<gpu::DeviceInfo> threeDevices() {
    return {
        makeInfo("llvmpipe (LLVM 15)", "software", gpu::RayTier::RayQuery),
        makeInfo("Old Card", "discrete", gpu::RayTier::None),
        makeInfo("New Card", "discrete", gpu::RayTier::RayQuery)};
}

void expectMessage(const core::Result<gpu::DeviceInfo>& result, const std::string& part) {
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
}

TEST(DeviceChoice, WithoutAWishASoftwareDeviceComesLastWhateverItCan) {
    using gpu::RayTier;
    // What Mesa's package puts beside the cards of a desktop or a data centre.
    const gpu::DeviceInfo lavapipe = makeInfo("llvmpipe (LLVM 19)", "software", RayTier::RayQuery);
    for (const gpu::DeviceInfo& card :
         {makeInfo("NVIDIA GeForce GTX 1050 (NVK GP107)", "discrete", RayTier::None),
          makeInfo("AMD Radeon RX Vega (RADV VEGA10)", "discrete", RayTier::None),
          makeInfo("Intel(R) UHD Graphics 620 (KBL GT2)", "integrated", RayTier::None),
          makeInfo("Virtio-GPU Venus", "virtual", RayTier::None),
          makeInfo("Some Card", "other", RayTier::None),
          makeInfo("NVIDIA H100", "discrete", RayTier::Pipeline)}) {
        EXPECT_EQ(gpu::chooseDevice({lavapipe, card}, "").value().name, card.name);
        EXPECT_EQ(gpu::chooseDevice({card, lavapipe}, "").value().name, card.name);
    }
    EXPECT_EQ(gpu::chooseDevice({lavapipe}, "").value().name, lavapipe.name);
}

TEST(DeviceChoice, AmongCardsRaysOfAnyTierComeFirstThenTheKindThenTheBetterTier) {
    using gpu::RayTier;
    const gpu::DeviceInfo old = makeInfo("Old Card", "discrete", RayTier::None);
    const gpu::DeviceInfo laptop = makeInfo("Laptop", "integrated", RayTier::RayQuery);
    const gpu::DeviceInfo centre = makeInfo("Data Centre", "discrete", RayTier::Pipeline);
    const gpu::DeviceInfo card = makeInfo("New Card", "discrete", RayTier::RayQuery);
    EXPECT_EQ(gpu::chooseDevice({old, laptop}, "").value().name, "Laptop");
    EXPECT_EQ(gpu::chooseDevice({old, laptop, centre}, "").value().name, "Data Centre");
    EXPECT_EQ(gpu::chooseDevice({old, laptop, centre, card}, "").value().name, "New Card");
}

TEST(DeviceChoice, ADeviceThatCanRunAMethodIsFoundForIt) {
    auto devices = threeDevices();
    const auto find = [&](const char* method) -> std::string {
        const auto* found = game::findDeviceFor(*game::findMethod(method).value(), devices);
        return found ? found->name : "none";
    };
    EXPECT_EQ(find("gather"), "llvmpipe (LLVM 15)") << "the first";
    devices.erase(devices.begin());
    EXPECT_EQ(find("hybrid"), "New Card");
    devices[1].rayTier = gpu::RayTier::Pipeline;
    EXPECT_EQ(find("hybrid"), "New Card");
    EXPECT_EQ(find("denoised"), "none");
    devices[1].missing = "Vulkan 1.3";
    EXPECT_EQ(find("hybrid"), "none");
}

TEST(DeviceChoice, TheTierIsTheBestOneThatIsThereAndAllowed) {
    using gpu::RayTier;
    gpu::DeviceInfo both;
    both.hasRayQuery = both.hasRayPipeline = true;
    EXPECT_EQ(gpu::chooseTier(both, RayTier::RayQuery), RayTier::RayQuery);
    EXPECT_EQ(gpu::chooseTier(both, RayTier::Pipeline), RayTier::Pipeline);
    EXPECT_EQ(gpu::chooseTier(both, RayTier::None), RayTier::None);
    gpu::DeviceInfo pipelines;
    pipelines.hasRayPipeline = true;
    EXPECT_EQ(gpu::chooseTier(pipelines, RayTier::RayQuery), RayTier::Pipeline);
    gpu::DeviceInfo queries;
    queries.hasRayQuery = true;
    EXPECT_EQ(gpu::chooseTier(queries, RayTier::Pipeline), RayTier::None);
    EXPECT_EQ(gpu::describeTiers(both), "VK_KHR_ray_query, VK_KHR_ray_tracing_pipeline");
    EXPECT_EQ(gpu::describeTiers(pipelines), "VK_KHR_ray_tracing_pipeline");
    EXPECT_EQ(gpu::describeTiers({}), "none");
}

TEST(DeviceChoice, ADeviceThatLacksSomethingIsPassedOver) {
    auto devices = threeDevices();
    devices[2].missing = "timeline semaphores";
    EXPECT_EQ(gpu::chooseDevice(devices, "").value().name, "Old Card");
    devices[1].missing = "dynamic rendering";
    EXPECT_EQ(gpu::chooseDevice(devices, "").value().name, "llvmpipe (LLVM 15)");
}

TEST(DeviceChoice, AWishIsAnIndexOrAPartOfAName) {
    const auto devices = threeDevices();
    EXPECT_EQ(gpu::chooseDevice(devices, "1").value().name, "Old Card");
    EXPECT_EQ(gpu::chooseDevice(devices, "LLVMPIPE").value().name, "llvmpipe (LLVM 15)");
}

TEST(DeviceChoice, AWishThatNamesNothingListsWhatThereIs) {
    const auto devices = threeDevices();
    expectMessage(gpu::chooseDevice(devices, "voodoo"), "'voodoo'");
    expectMessage(gpu::chooseDevice(devices, "voodoo"), "2: New Card");
    expectMessage(gpu::chooseDevice(devices, "3"), "'3'");
}

TEST(DeviceChoice, AWishedDeviceThatLacksSomethingSaysWhat) {
    auto devices = threeDevices();
    devices[1].missing = "dynamic rendering";
    expectMessage(gpu::chooseDevice(devices, "old"), "lacks dynamic rendering");
}

TEST(DeviceChoice, NoDeviceAtAllSaysWhatHelps) {
    expectMessage(gpu::chooseDevice({}, ""), "no Vulkan device");
    expectMessage(gpu::chooseDevice({}, "0"), "no Vulkan device");
}

TEST(DeviceChoice, WhereNoneCanRunTheEngineTheFirstIsNamed) {
    auto devices = threeDevices();
    for (auto& device : devices)
        device.missing = "Vulkan 1.3";
    expectMessage(gpu::chooseDevice(devices, ""), "llvmpipe (LLVM 15) lacks Vulkan 1.3");
}

class DeviceWithoutRays : public test::GpuTest {
  protected:
    static std::unique_ptr<gpu::Device> openWithoutRays() {
        gpu::DeviceOptions options;
        options.validate = true;
        options.bestTier = gpu::RayTier::None;
        auto opened = gpu::Device::create(options);
        EXPECT_TRUE(opened.ok());
        return opened ? std::move(opened).value() : nullptr;
    }
};

test::SceneBuilder makeScene() {
    test::SceneBuilder scene;
    scene.setPixelView(48);
    scene.add(test::makeQuad(80, 60, scene.addColor({0, 1, 0})), {.position = {0, 0, -20}});
    scene.add(
        test::makeQuad(16, 16, scene.addColor({1, 0, 0})),
        {.position = {0, 0, -10}, .velocity = {9, 0, 0}}
    );
    return scene;
}

TEST_F(DeviceWithoutRays, AWishForADeviceThatIsNotThereIsAnError) {
    gpu::DeviceOptions options;
    options.wanted = "no such device";
    const auto opened = gpu::Device::create(options);
    ASSERT_FALSE(opened.ok());
    EXPECT_NE(opened.error().message.find("'no such device'"), std::string::npos);
    EXPECT_NE(opened.error().message.find(device().info().name), std::string::npos);
}

TEST_F(DeviceWithoutRays, TheHybridMethodIsRefusedAndGatherIsNot) {
    const auto lower = openWithoutRays();
    ASSERT_TRUE(lower);
    EXPECT_FALSE(lower->hasRays());
    const auto check = [&](const char* method) {
        return game::PictureDrawer::check(
            *lower, game::makeMethod(*game::findMethod(method).value()), 64, 48
        );
    };
    const core::Status refused = check("hybrid");
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("hybrid"), std::string::npos);
    EXPECT_NE(refused.error().message.find("ray"), std::string::npos);
    EXPECT_TRUE(check("gather").ok());
}

TEST_F(DeviceWithoutRays, GatherIsTheSameWithAndWithoutRays) {
    const auto lower = openWithoutRays();
    ASSERT_TRUE(lower);
    const test::SceneBuilder scene = makeScene();
    const test::Shot shot{.method = "gather", .width = 64, .height = 48};
    const auto with = test::renderOnce(device(), scene, shot);
    const auto without = test::renderOnce(*lower, scene, shot);
    EXPECT_TRUE(test::sameBits(with.color, without.color));
    EXPECT_EQ(lower->validationMessageCount(), 0u);
}

} // namespace
} // namespace shutter
