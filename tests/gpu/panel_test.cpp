// SPDX-License-Identifier: MIT
// The panel: nothing changes by itself, and whatever is clicked, settings stay valid.
#include "engine/app/window_output.h"
#include "game/play/panel/panel.h"
#include "game/play/panel/panel_sections.h"
#include "game/play/panel/setting_widgets.h"
#include "game/shot/methods.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <gtest/gtest.h>

#include <array>
#include <imgui.h>
#include <imgui_internal.h>
#include <iterator>
#include <random>
#include <span>

namespace shutter {
namespace {

constexpr const char* kHeaders[] = {
    "Play",
    "Method",
    "Picture",
    "Reduced motion",
    "Settings of the blur",
    "Shutter",
    "Times of passes",
    "Why",
    "Keys",
    "Depth of field"};

/// An example of each statistic of a frame.
render::FrameStatistics makeStatistics() {
    render::FrameStatistics statistics;
    statistics.passes = {
        {"G-buffer", 6.0, 0.1},
        {"tile max", 0.6, 0.1},
        {"neighbour max", 0.3, 0.1},
        {"sort blocks", 0.4, 0.1},
        {"ray mask", 1.2, 0.1},
        {"ray reveal", 3.1, 0.1},
        {"gather", 4.4, 0.1},
        {"tone map", 2.2, 0.1},
        {"window", 1.5, 0.1}};
    statistics.counters = {
        {"blocks still", 2000},
        {"blocks uniform", 900},
        {"blocks mixed", 600},
        {"blocks masked", 100},
        {"pixels masked", 4321},
        {"rays traced", 2222}};
    using render::ExplainedKind;
    statistics.explanations = {
        {ExplainedKind::Effect,
         "motion blur",
         {true, "something in the picture moves during the exposure"}},
        {ExplainedKind::Work, "deform meshes", {false, "no skin, morph target or wave is drawn"}},
        {ExplainedKind::Pass, "ray reveal", {true, "motion blur runs"}}};
    return statistics;
}

class PanelOnWindow : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped())
            return;
        for (const game::MethodInfo& method : game::listMethods())
            mMethods.emplace_back(method.name);
        mFacts.title = "vase";
        mFacts.hud = mHud;
        mFacts.keys = mKeys;
        mFacts.right = &mStatistics;
        mFacts.frameMilliseconds = 41.7;
        mFacts.pictureSize = {640, 360};
        mFacts.exposure = scene::computeExposure(game::makePlayShutter(), 1.0, 1.0 / 24.0);
        mFacts.methods = mMethods;
        mFacts.views = mViews;
    }

    game::PanelRequests draw(
        app::Ui& ui, game::Panel& panel, game::PlaySettings& settings, const app::InputState& input
    ) {
        ui.begin(input, mSize, 1.0, 1.0 / 30.0);
        const game::PanelRequests requests = panel.draw(mFacts, settings);
        ui.end();
        return requests;
    }

    /// Folds the panel's headers; the panel must have been drawn once.
    void unfold(std::span<const char* const> open) const {
        ImGuiWindow* window = ImGui::FindWindowByName((mFacts.title + "###panel").c_str());
        ASSERT_NE(window, nullptr);
        for (const char* header : kHeaders)
            window->StateStorage.SetInt(window->GetID(header), 0);
        for (const char* header : open)
            window->StateStorage.SetInt(window->GetID(header), 1);
    }

    math::uvec2 mSize{1280, 720};
    render::FrameStatistics mStatistics = makeStatistics();
    std::vector<std::string> mMethods;
    std::vector<std::string> mViews = {"motion", "tiles", "mask"};
    std::vector<game::HudLine> mHud = {
        {"1250", true, "Score"}, {"42.3 s", false, "Time"}, {"3 gates"}};
    std::vector<game::KeyHelp> mKeys = {{"A D", "steer"}, {"Space", "hand brake"}};
    game::PanelFacts mFacts;
};

TEST_F(PanelOnWindow, AnUntouchedPanelChangesNoSetting) {
    app::Ui ui(device());
    game::Panel panel;
    game::PlaySettings settings;
    settings.showPanel = true;
    draw(ui, panel, settings, {});
    unfold(kHeaders);
    const scene::ShutterResponse responses[] = {
        {},
        {scene::ResponseShape::Trapezoid, 0.3, 0.7, {}},
        {scene::ResponseShape::Sampled, 0.0, 0.0, {0.0, 3.0, 0.1}}};
    for (size_t i = 0; i < mMethods.size(); ++i) {
        game::PlaySettings given;
        given.showPanel = true;
        given.method = mMethods[i];
        given.leftMethod = mMethods[mMethods.size() - 1 - i];
        given.split = i % 2 == 0;
        given.blur.softDepthExtent = 0.012345678f; // more digits than a widget shows
        given.blur.halfResolutionPx = i % 3 == 0 ? 1000.0f : given.blur.halfResolutionPx;
        given.shutter.response = responses[i % 3];
        mFacts.left = given.split ? &mStatistics : nullptr;
        settings = given;
        for (int frame = 0; frame < 3; ++frame) {
            const game::PanelRequests requests = draw(ui, panel, settings, {});
            EXPECT_FALSE(
                requests.save || requests.load || requests.togglePause || requests.savePicture ||
                requests.singleStep || requests.toggleRecording || requests.toggleFullScreen ||
                requests.quit || requests.speed
            );
        }
        const auto same = [&](auto rows, const auto& a, const auto& b) {
            EXPECT_TRUE(core::areEqual(rows, a, b)) << given.method;
        };
        same(motion_blur::listSettingRows(), given.blur, settings.blur);
        EXPECT_EQ(settings.method, given.method);
        EXPECT_EQ(settings.shutter.response.openShare, given.shutter.response.openShare);
        EXPECT_EQ(settings.shutter.response.closeShare, given.shutter.response.closeShare);
        EXPECT_EQ(settings.shutter.response.samples, given.shutter.response.samples);
        EXPECT_EQ(settings.shutter.angleDegrees, given.shutter.angleDegrees);
    }
}

TEST_F(PanelOnWindow, SettingsStayValidWhateverIsClickedAndTyped) {
    app::Ui ui(device());
    game::Panel panel;
    game::PlaySettings settings;
    settings.showPanel = true;
    app::InputCollector input;
    std::mt19937 random(7);
    const auto below = [&](uint32_t count) {
        return std::uniform_int_distribution<uint32_t>(0, count - 1)(random);
    };
    draw(ui, panel, settings, {});
    int changed = 0;
    for (int frame = 0; frame < 2500; ++frame) {
        if (frame % 50 == 0) {
            settings.method = "hybrid"; // it has the most settings to click on
            unfold(std::array{
                kHeaders[below(std::size(kHeaders))],
                kHeaders[below(std::size(kHeaders))],
                kHeaders[4]});
        }
        if (below(5) == 0)
            input.movePointer({900.0 + below(380), 60.0 + below(620)});
        for (const app::MouseButton button : {app::MouseButton::Left, app::MouseButton::Right})
            if (below(2) == 0)
                input.setButton(button, below(2) == 0);
        input.setKey(app::Key::Control, below(6) == 0);
        input.setKey(app::Key::Enter, below(5) == 0);
        if (below(10) == 0)
            input.turnWheel(double(below(5)) - 2.0);
        for (const char c : std::string_view(below(2) == 0 ? "nan" : "-7e9").substr(below(4)))
            input.type(uint32_t(c));
        mFacts.left = settings.split ? &mStatistics : nullptr;
        const game::PlaySettings before = settings;
        draw(ui, panel, settings, input.take());
        const core::Status valid = game::validate(settings);
        ASSERT_TRUE(valid.ok()) << "frame " << frame << ": " << valid.error().message;
        settings.showPanel = true;
        changed += !core::areEqual(motion_blur::listSettingRows(), before.blur, settings.blur);
    }
    EXPECT_GT(changed, 10) << "the clicks reached too little";
}

TEST_F(PanelOnWindow, LinesOverThePictureDoNotMeetInSmallWindows) {
    app::Ui ui(device());
    for (const math::uvec2 size : {math::uvec2(320, 180), {480, 270}, {500, 300}, {1280, 720}})
        for (const bool split : {false, true})
            for (const bool hint : {false, true}) {
                SCOPED_TRACE(testing::Message() << size.x << " x " << size.y << split << hint);
                game::PlaySettings settings;
                settings.split = split;
                mFacts.left = split ? &mStatistics : nullptr;
                mFacts.showsHint = hint;
                mFacts.paused = true;
                mFacts.message = "settings.json:12: blur.jitter: must lie in [0, 1], not 2";
                ui.begin({}, size, 1.0, 1.0 / 30.0);
                const auto lines = game::drawHud(mFacts, settings).lines;
                ui.end();
                // Two readings on one ground, the line, the state and the message at least.
                EXPECT_GE(lines.size(), size.x < 1280 ? 4u : split ? 9u : 7u);
                for (size_t i = 0; i < lines.size(); ++i) {
                    const game::HudRect& a = lines[i];
                    EXPECT_TRUE(
                        a.left >= 0.0f && a.top >= 0.0f && a.right <= float(size.x) &&
                        a.bottom <= float(size.y)
                    );
                    for (size_t j = 0; j < i; ++j) {
                        const game::HudRect& b = lines[j];
                        EXPECT_TRUE(
                            a.right <= b.left || b.right <= a.left || a.bottom <= b.top ||
                            b.bottom <= a.top
                        ) << i
                          << " and " << j;
                    }
                }
            }
}

TEST_F(PanelOnWindow, ThePanelCoversThePictureAtItsPlaceOnly) {
    test::SceneBuilder scene;
    test::Stage stage(device(), scene);
    app::WindowOutput window(device());
    app::Ui ui(device());
    game::Panel panel;
    game::PlaySettings settings;
    settings.showPanel = settings.split = true;
    mFacts.left = &mStatistics;
    for (int frame = 0; frame < 3; ++frame)
        draw(ui, panel, settings, {});
    window.setTarget({.size = mSize, .overlay = &ui});
    const image::Image shown = stage
                                   .render(
                                       {.width = mSize.x,
                                        .height = mSize.y,
                                        .background = math::vec3(0.5f, 0.35f, 0.2f),
                                        .wantDisplay = true,
                                        .last = &window}
                                   )
                                   .display;
    // Left of the panel, below the score, the picture is unchanged.
    EXPECT_GT(shown.at(64, 360, 0), shown.at(1248, 360, 0));
}

} // namespace
} // namespace shutter
