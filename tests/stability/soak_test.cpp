// SPDX-License-Identifier: MIT
// A short soak holds, and each of its checks can fail.
#include "engine/gpu/memory.h"
#include "engine/scene/history.h"
#include "game/soak/soak_run.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/temp_folder.h"

#include <cstring>
#include <memory>

namespace shutter {
namespace {

/// Not a whole number of cycles: the last sample is taken before the end.
constexpr uint32_t kFrames = 1050;

class SoakLaw : public test::GpuTest {
  protected:
    soak::SoakOptions makeOptions() {
        soak::SoakOptions options;
        options.frames = kFrames;
        options.storm = 50;
        options.size = {64, 36};
        options.out = mFolder.path();
        options.assets = std::filesystem::path(SHUTTER_BUILD_DIR) / "assets";
        return options;
    }

  private:
    test::TempFolder mFolder;
};

TEST_F(SoakLaw, AThousandFramesGainNothingAndRepeatThemselves) {
    soak::SoakOptions options = makeOptions();
    options.device.validate = true;
    const auto found = soak::runSoak(options);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found.value().findings.curves.size(), 4u);
    EXPECT_EQ(found.value().findings.checks.size(), 15u);
    // Times of a thousand frames beside other tests say nothing; unit/SoakSamples sees that they
    // count.
    for (const stability::Measured& row : found.value().findings.checks)
        EXPECT_TRUE(stability::holds(row) || row.check.ends_with("time of a frame"))
            << row.check << ": " << row.worst << " " << row.unit << ", at most " << row.bound
            << " (" << row.note << ")";
}

/// Makes the first run grow in every way, and draws something else in the second.
class Saboteur {
  public:
    void disturb(const soak::SoakOptions::Moment& moment) {
        if (moment.run > 0) {
            if (moment.picture == 0)
                hideAll(moment.stage.world());
            return;
        }
        constexpr size_t kLeak = size_t{64} << 10u;
        mBytes.push_back(std::make_unique<char[]>(kLeak));
        std::memset(mBytes.back().get(), 1, kLeak); // else it takes no memory
        if (moment.picture % 20 == 0)
            mBuffers.emplace_back(
                moment.device,
                "leak",
                64 << 10,
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                gpu::MemoryUse::Device
            );
        if (moment.picture + 1 == kFrames)
            mBuffers.clear(); // before their device
    }

  private:
    static void hideAll(scene::World& world) {
        std::vector<ecs::Entity> drawn;
        for (auto [entity, mesh] : std::as_const(world).registry.view<scene::MeshInstance>())
            drawn.push_back(entity);
        for (const ecs::Entity entity : drawn)
            scene::hide(world, entity);
    }

    std::vector<std::unique_ptr<char[]>> mBytes;
    std::vector<gpu::Buffer> mBuffers;
};

TEST_F(SoakLaw, ALeakAndAnotherPictureAreNoticed) {
    soak::SoakOptions options = makeOptions();
    Saboteur saboteur;
    options.disturb = [&](const soak::SoakOptions::Moment& moment) { saboteur.disturb(moment); };
    const auto found = soak::runSoak(options);
    ASSERT_TRUE(found) << found.error().message;
    std::vector<std::string> broken;
    for (const stability::Measured& row : found.value().findings.checks)
        if (!stability::holds(row) && !row.check.starts_with("run 2") &&
            !row.check.ends_with("time of a frame"))
            broken.push_back(row.check);
    EXPECT_EQ(
        broken,
        (std::vector<std::string>{
            "pictures of chosen frames that differ between the runs",
            "run 1: memory of the process gained",
            "run 1: device memory gained",
            "run 1: blocks of device memory gained",
            "run 1: buffers gained"})
    );
}

} // namespace
} // namespace shutter
