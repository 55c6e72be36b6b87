// SPDX-License-Identifier: MIT
#include "engine/app/input_script.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace shutter::app {
namespace {

class InputScriptFile : public testing::Test {
  protected:
    core::Result<InputScript> read(const std::string& text) {
        std::ofstream(mPath) << text;
        return readInputScript(mPath);
    }

    void expectRefused(const std::string& event, const std::string& told) {
        const auto script = read("{\"version\": 1, \"events\": [\n" + event + "]}");
        ASSERT_FALSE(script) << event;
        EXPECT_NE(script.error().message.find(told), std::string::npos) << script.error().message;
        EXPECT_NE(script.error().message.find(":2"), std::string::npos) << script.error().message;
    }

    // Each test has a file of its own, because tests run in parallel.
    std::filesystem::path mPath = testing::TempDir() +
                                  testing::UnitTest::GetInstance()->current_test_info()->name() +
                                  ".input_script.json";
};

TEST_F(InputScriptFile, EventsComeInTheFrameOfTheirTime) {
    auto script = read(R"({"version": 1, "frameSeconds": 0.1, "events": [
        {"time": 0, "key": "w", "action": "press"},
        {"time": 0.1, "pointer": [0.25, 0.5]},
        {"time": 0.1, "key": "m"},
        {"time": 0.3, "resize": [320, 200]},
        {"time": 0.3, "window": "quit"}]})");
    ASSERT_TRUE(script) << script.error().message;
    ScriptPlayer player(std::move(script).value());
    InputCollector input;
    EXPECT_EQ(player.takeFrame(input, {400, 200}).size(), 1u);
    EXPECT_TRUE(input.take().isDown(Key::W));
    EXPECT_EQ(player.takeFrame(input, {400, 200}).size(), 2u);
    const InputState second = input.take();
    EXPECT_EQ(second.pointerPx, math::dvec2(100.0, 100.0));
    EXPECT_TRUE(second.wasPressed(Key::M));
    EXPECT_TRUE(second.isDown(Key::W));
    EXPECT_TRUE(player.takeFrame(input, {400, 200}).empty());
    EXPECT_FALSE(player.isOver());
    const auto last = player.takeFrame(input, {400, 200});
    ASSERT_EQ(last.size(), 2u);
    EXPECT_EQ(std::get<ResizeEvent>(last[0].what).size, math::uvec2(320, 200));
    EXPECT_EQ(std::get<WindowAction>(last[1].what), WindowAction::Quit);
    EXPECT_TRUE(player.isOver());
}

TEST_F(InputScriptFile, SticksStayWhereTheyWerePut) {
    auto script = read(R"({"version": 1, "events": [{"time": 0, "leftStick": [-1, 0.5]}]})");
    ASSERT_TRUE(script) << script.error().message;
    ScriptPlayer player(std::move(script).value());
    InputCollector input;
    (void)player.takeFrame(input, {1, 1});
    (void)input.take();
    (void)player.takeFrame(input, {1, 1});
    EXPECT_EQ(input.take().pad.leftStick, math::dvec2(-1.0, 0.5));
}

TEST_F(InputScriptFile, WrongEventsAreRefusedByLineAndField) {
    expectRefused(R"({"time": 0, "key": "nokey"})", "events[0].key");
    expectRefused(R"({"time": -1, "key": "w"})", "events[0].time");
    expectRefused(R"({"time": 0})", "must tell one of");
    expectRefused(R"({"time": 0, "key": "w", "wheel": 1})", "must tell one of");
    expectRefused(R"({"time": 0, "wheel": 1, "action": "tap"})", "events[0].action");
    expectRefused(R"({"time": 0, "resize": [0, 5]})", "events[0].resize[0]");
    expectRefused(R"({"time": 0, "resize": [5]})", "events[0].resize");
    expectRefused(R"({"time": 0, "pointer": [0.5, 1.5]})", "events[0].pointer[1]");
    expectRefused(R"({"time": 0, "window": "close"})", "events[0].window");
    expectRefused(R"({"time": 0, "keys": "w"})", "keys");
}

TEST_F(InputScriptFile, AScreenshotIsADisplayPictureBelowTheWorkingFolder) {
    const auto shoot = [](const std::string& file) {
        return "{\"time\": 0, \"screenshot\": \"" + file + "\"}";
    };
    EXPECT_TRUE(read("{\"version\": 1, \"events\": [" + shoot("sub/a.png") + "]}"));
    expectRefused(shoot("a.bmp"), "events[0].screenshot: 'a.bmp' has the unknown extension");
    expectRefused(shoot("a.exr"), "events[0].screenshot");
    for (const char* outside : {"../a.png", "sub/../../a.png", "/a.png"}) {
        expectRefused(shoot(outside), "leaves the folder");
        std::ofstream(mPath) << "{\"version\": 1, \"events\": [" << shoot(outside) << "]}";
        EXPECT_TRUE(readInputScript(mPath, io::Reach::Anywhere)) << outside;
    }
}

TEST_F(InputScriptFile, TimesMustNotFallBack) {
    const auto script =
        read(R"({"version": 1, "events": [{"time": 1, "key": "w"}, {"time": 0.5, "key": "w"}]})");
    ASSERT_FALSE(script);
    EXPECT_NE(script.error().message.find("events[1]"), std::string::npos);
    EXPECT_FALSE(read(R"({"version": 1, "events": []})"));
    EXPECT_FALSE(read(R"({"version": 2, "events": [{"time": 0, "key": "w"}]})"));
    EXPECT_FALSE(read(R"({"version": 1, "frameSeconds": 0, "events": [{"time": 0, "key": "w"}]})"));
}

} // namespace
} // namespace shutter::app
