// SPDX-License-Identifier: MIT
#include "engine/scene/lens.h"
#include "game/play/panel/play_settings.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/panel/random_settings.h"

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <type_traits>

namespace shutter {
namespace {

using game::PlaySettings;

class PlaySettingsFile : public ::testing::Test {
  protected:
    [[nodiscard]] std::string read() const {
        std::ostringstream text;
        text << std::ifstream(mPath).rdbuf();
        return text.str();
    }

    /// The error of loading that text, without the path, or nothing.
    [[nodiscard]] std::string refuse(const std::string& text) const {
        const std::string message =
            test::errorOf(game::loadPlaySettings(mFolder.write("settings.json", text)));
        EXPECT_TRUE(message.empty() || message.starts_with(mPath.string() + ":")) << message;
        return message.substr(std::min(message.size(), mPath.string().size() + 1));
    }

    const test::TempFolder mFolder;
    const std::filesystem::path mPath = mFolder.path() / "settings.json";
};

/// Calls visit(row, owner, prefix) with all rows of all owners.
template <class Visit> void visitRows(PlaySettings& settings, Visit visit) {
    const auto each = [&](auto rows, auto& owner, const std::string& prefix) {
        for (const auto& row : rows)
            visit(row, owner, prefix);
    };
    each(game::listPlayRows(), settings, "");
    game::visitPictureRows([&](auto rows, const auto& part) {
        each(rows, part(settings.picture), "");
    });
    each(motion_blur::listBudgetRows(), settings.budget, "budget.");
    each(motion_blur::listSettingRows(), settings.blur, "blur.");
    each(scene::listShutterRows(), settings.shutter, "shutter.");
    each(scene::listResponseRows(), settings.shutter.response, "shutter.response.");
    each(scene::listCutRows(), settings.shutter.cuts, "shutter.cuts.");
    each(scene::listOverrideRows(), settings.lens, "lens.");
}

/// Past the range, as any kind of number.
template <class Owner> void force(const core::SettingRow<Owner>& row, Owner& owner, double value) {
    if (const auto* whole = std::get_if<uint32_t Owner::*>(&row.field))
        owner.** whole = value < 0.0 ? UINT32_MAX : static_cast<uint32_t>(value);
    else if (const auto* single = std::get_if<float Owner::*>(&row.field))
        owner.** single = static_cast<float>(value);
    else
        owner.**std::get_if<double Owner::*>(&row.field) = value;
}

TEST_F(PlaySettingsFile, SettingsAreReadBackAsWritten) {
    for (uint32_t seed = 0; seed < 100; ++seed) {
        const PlaySettings settings = test::RandomSettings(seed).make();
        ASSERT_TRUE(game::validate(settings).ok()) << game::validate(settings).error().message;
        ASSERT_TRUE(game::savePlaySettings(mPath, settings).ok());
        const std::string first = read();
        const auto loaded = test::valueOf(game::loadPlaySettings(mPath));
        ASSERT_TRUE(game::savePlaySettings(mPath, loaded).ok());
        ASSERT_EQ(read(), first);
        EXPECT_EQ(loaded.method, settings.method);
        EXPECT_EQ(loaded.view, settings.view);
        EXPECT_EQ(loaded.shutter.response.samples, settings.shutter.response.samples);
        EXPECT_EQ(loaded.blur.softDepthExtent, settings.blur.softDepthExtent);
        EXPECT_EQ(loaded.blur.halfResolutionPx, settings.blur.halfResolutionPx);
        EXPECT_EQ(loaded.shutter.maxBlurPercent, settings.shutter.maxBlurPercent);
        EXPECT_EQ(loaded.lens.focusDistance, settings.lens.focusDistance);
    }
}

TEST(PlaySettingsRows, EveryRowHasALabelForPeopleThatNoOtherOfItsTableHas) {
    PlaySettings settings;
    std::set<std::string> labels;
    visitRows(settings, [&](const auto& row, auto&, const std::string& prefix) {
        const std::string_view label = row.label;
        ASSERT_FALSE(label.empty()) << prefix << row.name;
        EXPECT_TRUE(std::isupper(static_cast<unsigned char>(label.front()))) << label;
        EXPECT_TRUE(labels.insert(prefix + row.label).second) << prefix << row.label;
    });
}

TEST_F(PlaySettingsFile, OnlyTheVersionIsRequired) {
    const auto loaded =
        test::valueOf(game::loadPlaySettings(mFolder.write("least.json", R"({"version": 1})")));
    ASSERT_TRUE(game::savePlaySettings(mPath, loaded).ok());
    const std::string fromFile = read();
    ASSERT_TRUE(game::savePlaySettings(mPath, PlaySettings{}).ok());
    EXPECT_EQ(fromFile, read());
}

TEST_F(PlaySettingsFile, InvalidSettingsAreRefusedWithLineAndField) {
    const std::pair<const char*, const char*> kRefused[] = {
        {"\n \"blur\": {\n  \"jitter\": 2}", "3: blur.jitter: must lie in [0, 1], not 2"},
        {"\n \"method\": \"hybird\"", "2: method: 'hybird' is not"},
        {"\n \"lens\": {\"fStop\": 0.001}",
         "2: lens: fStop is 0.001, it must be 0 or at least 0.01"},
        {R"("lens": {"focusDistance": 1e-6})",
         "1: lens: focusDistance is 1e-06, it must be 0 or at least 0.0001"},
        {R"("lens": {"blurScale": 3})", "lens.blurScale"},
        {R"("colour": 1)", "colour: is not a field"},
        {R"("shutter": {"cuts": {"enabled": 1}})", "shutter.cuts.enabled: must be true or false"},
        {R"("blur": {"neighbourhoodTiles": 4})",
         "blur.neighbourhoodTiles: must be 1 to 15 tiles in steps of 2, not 4"},
        {R"("blur": {"maxMotionDepth": "far"})",
         "blur.maxMotionDepth: 'far' is not one of unlimited"},
        {R"("blur": {"jitter": "unlimited"})", "blur.jitter: must be a number"},
        // A response without light.
        {R"("shutter": {"response": {"shape": "samples", "samples": [0, 0]}})",
         "shutter.response: samples are all 0"},
        {R"("shutter": {"response": {"shape": "trapezoid", "openShare": 0.6, "closeShare": 0.6}})",
         "are more than the exposure"},
        {R"("shutter": {"response": {"samples": [1, -1]}})", "shutter.response.samples[1]"}};
    for (const auto& [members, sentence] : kRefused) {
        const std::string refused = refuse("{\"version\": 1, " + std::string(members) + "}");
        EXPECT_NE(refused.find(sentence), std::string::npos) << members << ": " << refused;
    }
    EXPECT_EQ(refuse("{\"version\": 2}"), "1: version: must lie in [1, 1], not 2");
    EXPECT_NE(refuse("{}"), "");
    EXPECT_EQ(refuse(R"({"version": 1, "lens": {"fStop": 2.8, "blurScale": 0}})"), "");
    EXPECT_EQ(refuse(R"({"version": 1, "shutter": {"response": {"samples": []}}})"), "");
}

TEST_F(PlaySettingsFile, InvalidSettingsAreNotWritten) {
    PlaySettings settings;
    settings.dividerShare = 1.5;
    test::expectRefused(game::savePlaySettings(mPath, settings), "dividerShare is 1.5");
    EXPECT_FALSE(std::filesystem::exists(mPath));
}

TEST(PlaySettings, EveryFieldOutOfItsRangeIsNamed) {
    PlaySettings counted;
    int numbers = 0;
    visitRows(counted, [&](const auto& row, auto&, const std::string& prefix) {
        if (!core::isNumber(row))
            return;
        ++numbers;
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        for (const double bad : {row.range.lowest - 1.0, row.range.highest * 2.0 + 1.0, kNone}) {
            const bool isWhole = row.range.step != 0.0;
            if (isWhole && std::isnan(bad))
                continue;
            PlaySettings settings;
            visitRows(settings, [&](const auto& other, auto& owner, const std::string&) {
                if constexpr (std::is_same_v<decltype(other), decltype(row)>)
                    if (&other == &row)
                        force(other, owner, bad);
            });
            const core::Status valid = game::validate(settings);
            ASSERT_FALSE(valid.ok()) << prefix << row.name << " " << bad;
            EXPECT_TRUE(valid.error().message.starts_with(prefix + row.name + " is "))
                << valid.error().message;
        }
    });
    EXPECT_GT(numbers, 30);
}

TEST(PlaySettings, UnknownNamesAreRefused) {
    PlaySettings settings;
    EXPECT_TRUE(game::validate(settings).ok());
    settings.leftMethod = "nosuch";
    EXPECT_NE(game::validate(settings).error().message.find("leftMethod"), std::string::npos);
    settings.leftMethod = "sharp";
    settings.view = std::string(game::kMaxViewBytes + 1, 'a');
    EXPECT_NE(game::validate(settings).error().message.find("view"), std::string::npos);
}

TEST(PlaySettings, ReducedMotionTakesTheCamerasPartAlone) {
    PlaySettings settings;
    settings.shutter.cameraRotationScale = 0.8;
    settings.shutter.cameraTranslationScale = 1.5;
    settings.shutter.objectScale = 1.2;
    settings.cameraBlurScale = 0.5;
    const scene::CameraShutter shutter = game::makeShutter(settings);
    EXPECT_DOUBLE_EQ(shutter.cameraRotationScale, 0.4);
    EXPECT_DOUBLE_EQ(shutter.cameraTranslationScale, 0.75);
    EXPECT_EQ(shutter.objectScale, 1.2);
    settings.cameraBlurScale = 0.0;
    EXPECT_EQ(game::makeShutter(settings).cameraRotationScale, 0.0);
    EXPECT_EQ(game::makeShutter(settings).cameraTranslationScale, 0.0);
    EXPECT_EQ(game::makeShutter(settings).objectScale, 1.2);
}

TEST(
    PlaySettings, TheMethodIsTheBlursOwnDefaultAndRaysOfTheDenoisedOneAreNotTheSamplesOfTheOthers
) {
    EXPECT_EQ(PlaySettings().method, motion_blur::getDefaultMethod().name);
    PlaySettings settings;
    settings.blur.sampleCount = 31;
    settings.denoisedRays = 2;
    const auto count = [&](const char* method) {
        return game::makeBlurSettings(settings, *game::findMethod(method).value()).sampleCount;
    };
    EXPECT_EQ(count("hybrid"), 31u);
    EXPECT_EQ(count("denoised"), 2u);
    EXPECT_EQ(
        game::makeBlurSettings(settings, *game::findMethod("gather").value()).method,
        &motion_blur::getMethod("gather")
    );
}

TEST(Presets, PresetsSetTheOtherEffectsUnlessTheyCompareTheBlur) {
    PlaySettings settings;
    const auto apply = [&](const char* name) {
        game::applyPreset(*game::findPreset(name).value(), settings);
    };
    apply("performance");
    EXPECT_EQ(settings.picture.antiAliasing, game::AntiAliasing::None);
    EXPECT_EQ(settings.picture.features.shadows.mode, shadows::ShadowMode::Blurred);
    EXPECT_EQ(settings.picture.bloom.share, 0.0f);
    EXPECT_FALSE(settings.depthOfField);
    settings.environment = false;
    settings.picture.features.shadows.mode = shadows::ShadowMode::Sharp;
    for (const char* name : {"off", "paper"}) {
        apply(name);
        EXPECT_EQ(settings.picture.features.shadows.mode, shadows::ShadowMode::Sharp) << name;
        EXPECT_FALSE(settings.environment) << name;
    }
    apply("balanced");
    // What a new player has.
    EXPECT_EQ(game::formatPlaySettings(settings), game::formatPlaySettings(PlaySettings()));
}

TEST(Presets, DepthOfFieldIsThePresetsAndItsScaleThePlayers) {
    PlaySettings settings;
    settings.lens = {.fStop = 2.0, .blurScale = 0.5};
    for (const auto& [name, blurScale] :
         {std::pair{"performance", 0.0}, {"off", 0.0}, {"quality", 0.5}, {"paper", 0.5}}) {
        game::applyPreset(*game::findPreset(name).value(), settings);
        EXPECT_EQ(game::makeLens(settings).blurScale, blurScale) << name;
        EXPECT_EQ(game::makeLens(settings).fStop, 2.0) << name;
        EXPECT_EQ(settings.lens.blurScale, 0.5) << name;
    }
}

TEST(Presets, PresetsAreValidDistinctAndAppliedAndTurningTheBlurOffKeepsItsSettings) {
    for (const game::Preset& preset : game::listPresets()) {
        PlaySettings settings = test::RandomSettings(1).make();
        const scene::CameraShutter shutter = settings.shutter;
        game::applyPreset(preset, settings);
        EXPECT_TRUE(game::validate(settings).ok()) << preset.name;
        EXPECT_EQ(settings.shutter.angleDegrees, shutter.angleDegrees);
        for (const game::Preset& other : game::listPresets())
            EXPECT_EQ(game::isApplied(other, settings), &other == &preset)
                << preset.name << " and " << other.name;
    }
    EXPECT_EQ(game::listPresets().size(), 5u);
    PlaySettings settings;
    settings.blur.sampleCount = 77;
    game::applyPreset(game::listPresets().front(), settings);
    EXPECT_EQ(settings.method, "sharp");
    EXPECT_EQ(settings.blur.sampleCount, 77u);
}

} // namespace
} // namespace shutter
