// SPDX-License-Identifier: MIT
#include "game/play/loop/settings_keeper.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace shutter::game {
namespace {

class Keeper : public testing::Test {
  protected:
    ~Keeper() override { std::filesystem::remove(mFile); }

    PlaySettings load(const std::string& lens, const PlayOptions& named) {
        return loadMember(R"("lens": )" + lens, named);
    }

    PlaySettings loadMember(const std::string& member, const PlayOptions& named) {
        std::ofstream(mFile) << R"({"version": 1, )" << member << "}";
        PlayOptions options = named;
        options.settings = mFile;
        std::string message;
        auto settings = SettingsKeeper().open(options, true, message);
        EXPECT_TRUE(settings) << settings.error().message;
        return settings ? settings.value() : PlaySettings();
    }

    std::filesystem::path mFile =
        std::filesystem::path(testing::TempDir()) /
        (std::string("keeper_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(Keeper, AnOpenFStopTurnsDepthOfFieldOn) {
    PlayOptions opened;
    opened.fStop = 1.4;
    const PlaySettings off = load(R"({"blurScale": 0})", opened);
    EXPECT_EQ(off.lens.fStop, 1.4);
    EXPECT_EQ(off.lens.blurScale, 1.0);
    EXPECT_EQ(load(R"({"blurScale": 0.5})", opened).lens.blurScale, 0.5);
    EXPECT_EQ(load(R"({"blurScale": 0})", {}).lens.blurScale, 0.0);
    PlayOptions closed;
    closed.fStop = 0.0;
    EXPECT_FALSE(load(R"({"fStop": 2})", closed).depthOfField);
}

TEST_F(Keeper, AnEntityToFocusOnReplacesTheDistanceOfTheSettings) {
    PlayOptions named;
    EXPECT_EQ(load(R"({"focusDistance": 3})", named).lens.focusDistance, 3.0);
    named.shot.focusEntity = "ball";
    EXPECT_EQ(load(R"({"focusDistance": 3})", named).lens.focusDistance, 0.0);
}

TEST_F(Keeper, APresetReplacesTheFilesMethodAndEffectsAndYieldsToTypedOptions) {
    const std::string file = R"("method": "gather", "antiAliasing": "box", "bloomShare": 0.5)";
    EXPECT_EQ(loadMember(file, {}).method, "gather");
    PlayOptions options;
    options.preset = findPreset("quality").value();
    const PlaySettings quality = loadMember(file, options);
    EXPECT_TRUE(isApplied(*options.preset, quality));
    EXPECT_EQ(quality.method, "adaptive");
    EXPECT_EQ(quality.picture.antiAliasing, AntiAliasing::Taa);
    options.typed = {"--aa"};
    options.shot.picture.antiAliasing = AntiAliasing::Box;
    EXPECT_EQ(loadMember(file, options).picture.antiAliasing, AntiAliasing::Box);
}

} // namespace
} // namespace shutter::game
