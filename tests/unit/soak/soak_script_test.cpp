// SPDX-License-Identifier: MIT
#include "engine/app/input_script.h"
#include "engine/json/json_file.h"
#include "game/play/panel/play_settings.h"
#include "game/soak/soak_script.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace shutter::soak {
namespace {

constexpr uint32_t kFrames = 4 * kCycleFrames;

TEST(SoakScript, IsOneThatPlayReads) {
    const test::TempFolder folder;
    const auto file = folder.path() / "script.json";
    ASSERT_TRUE(json::writeJsonFile(file, makeSoakScript(kFrames, {160, 90}, folder.path())));
    const auto script = app::readInputScript(file, io::Reach::Anywhere);
    ASSERT_TRUE(script) << script.error().message;
    EXPECT_EQ(
        std::get<app::WindowAction>(script.value().events.back().what), app::WindowAction::Quit
    );
    const auto settings = folder.path() / "settings.json";
    ASSERT_TRUE(json::writeJsonFile(settings, makeSoakSettings()));
    EXPECT_TRUE(game::loadPlaySettings(settings));
}

TEST(SoakScript, ACycleDoesWhatTheOneBeforeItDid) {
    std::map<uint32_t, std::vector<std::string>> cycles;
    std::set<std::string> keys;
    const nlohmann::ordered_json script = makeSoakScript(kFrames, {160, 90}, "pictures");
    for (nlohmann::ordered_json event : script["events"]) {
        if (event.contains("screenshot") || event.contains("window"))
            continue;
        const auto frame = uint32_t(std::ceil(event["time"].get<double>() * 30.0));
        event["time"] = frame % kCycleFrames;
        cycles[frame / kCycleFrames].push_back(event.dump());
        if (event.contains("key"))
            keys.insert(event["key"]);
    }
    ASSERT_EQ(cycles.size(), 4u);
    for (const auto& [cycle, events] : cycles)
        EXPECT_EQ(events, cycles[0]) << cycle;
    for (const char* key : {"m", "n", "v", "x", "b", "c", "f1", "1", "4", "t", "p", "period", "f9"})
        EXPECT_TRUE(keys.contains(key)) << key;
}

TEST(SoakScript, ChosenFramesLieAtDifferentPlacesOfTheCycle) {
    for (const uint32_t frameCount : {kFrames, 20'000u, 100'000u}) {
        const std::vector<uint32_t> frames = chooseFrames(frameCount);
        EXPECT_EQ(frames.size(), 20u);
        EXPECT_TRUE(std::is_sorted(frames.begin(), frames.end()));
        EXPECT_LT(frames.back(), frameCount);
        std::set<uint32_t> places;
        for (const uint32_t frame : frames)
            places.insert(frame % kCycleFrames);
        EXPECT_EQ(places.size(), frames.size());
    }
}

} // namespace
} // namespace shutter::soak
