// SPDX-License-Identifier: MIT
// The user interface on the window: pixels in their places, for windows and scripts; and the panel:
// nothing changes by itself, and whatever is clicked, settings stay valid.
#include "engine/app/ui.h"
#include "engine/app/window_output.h"
#include "game/play/panel/panel.h"
#include "game/play/panel/panel_sections.h"
#include "game/play/panel/setting_widgets.h"
#include "game/shot/methods.h"
#include "modules/tonemap/tonemap.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <imgui.h>
#include <imgui_internal.h>
#include <iterator>
#include <limits>
#include <random>
#include <span>
#include <vector>

namespace shutter {
namespace {

constexpr uint32_t kWidth = 80;
constexpr uint32_t kHeight = 60;
constexpr float kGrey = 128.0f / 255.0f;

using Declare = std::function<void(ImDrawList&)>;

class UiOnWindow : public test::GpuTest {
  protected:
    static image::Image makeGrey() {
        image::Image picture(kWidth, kHeight, 4);
        std::fill(picture.pixels.begin(), picture.pixels.end(), kGrey);
        return picture;
    }

    static void
    declare(app::Ui& ui, const Declare& draw, double scale = 1.0, double seconds = 0.01) {
        ui.begin({}, {kWidth, kHeight}, scale, seconds);
        draw(*ImGui::GetForegroundDrawList());
        ui.end();
    }

    /// What the window shows of a grey picture and the overlay.
    static image::Image show(app::Overlay& overlay) {
        test::GraphRig rig(device());
        test::EffectRig effect(rig, {}, kWidth, kHeight);
        effect.context.display = rig.upload(makeGrey());
        app::WindowOutput window(device());
        window.setTarget({.size = {kWidth, kHeight}, .overlay = &overlay});
        window.declare(effect.context);
        const size_t ticket = rig.want(effect.context.display);
        run(rig);
        return rig.take(ticket);
    }

    /// Red is `inside` within the rectangle, and the picture's beyond.
    static void expectRectangle(
        const image::Image& shown, const ImVec4& rectangle, float inside, const char* what
    ) {
        for (uint32_t y = 0; y < shown.height; ++y)
            for (uint32_t x = 0; x < shown.width; ++x) {
                const bool isInside = float(x) >= rectangle.x && float(x) < rectangle.z &&
                                      float(y) >= rectangle.y && float(y) < rectangle.w;
                ASSERT_NEAR(shown.at(x, y, 0), isInside ? inside : kGrey, 0.6f / 255.0f)
                    << what << " at " << x << ", " << y;
            }
    }
};

/// Pixels that white covers, parts of pixels included.
double measureCoverage(const image::Image& shown) {
    double sum = 0.0;
    for (uint32_t y = 0; y < shown.height; ++y)
        for (uint32_t x = 0; x < shown.width; ++x)
            sum += (shown.at(x, y, 0) - kGrey) / (1.0 - kGrey);
    return sum;
}

TEST_F(UiOnWindow, ARectangleLiesOnItsPixelsAndIsBlendedOverThePicture) {
    app::Ui ui(device());
    declare(ui, [](ImDrawList& list) {
        list.AddRectFilled({10, 20}, {30, 41}, IM_COL32(255, 0, 0, 102));
    });
    const image::Image shown = show(ui);
    expectRectangle(shown, {10, 20, 30, 41}, 0.6f * kGrey + 0.4f, "red");
    EXPECT_NEAR(shown.at(15, 30, 2), 0.6f * kGrey, 0.6f / 255.0f);
    EXPECT_NEAR(shown.at(15, 30, 3), 1.0f, 0.6f / 255.0f);
}

TEST_F(UiOnWindow, NothingIsDrawnBeyondAClipRectangleOrTheWindowNorWithoutAFrame) {
    app::Ui ui(device());
    expectRectangle(show(ui), {0, 0, 0, 0}, 1.0f, "before the first frame");
    declare(ui, [](ImDrawList&) {});
    expectRectangle(show(ui), {0, 0, 0, 0}, 1.0f, "an empty frame");
    declare(ui, [](ImDrawList& list) {
        const auto fill = [&](const ImVec2& from, const ImVec2& to) {
            list.PushClipRect(from, to);
            list.AddRectFilled({-50, -50}, {500, 500}, IM_COL32_WHITE);
            list.PopClipRect();
        };
        fill({12, 5}, {20, 15});
        fill({-40, -30}, {0, 70});    // left of the window
        fill({200, 200}, {300, 300}); // right of and below it
        fill({30, 30}, {30, 40});     // of no area
        fill({12, 12}, {-5, -5});     // of a negative one
    });
    expectRectangle(show(ui), {12, 5, 20, 15}, 1.0f, "clipped");
    declare(ui, [](ImDrawList& list) {
        list.PushClipRect({-40, 50}, {9, 500});
        list.AddRectFilled({-50, -50}, {500, 500}, IM_COL32_WHITE);
        list.PopClipRect();
    });
    expectRectangle(show(ui), {0, 50, 9, 60}, 1.0f, "clipped by the window");
}

TEST_F(UiOnWindow, TextHasTheSizeOfItsScale) {
    app::Ui ui(device());
    std::vector<double> coverage;
    for (const double scale : {1.0, 1.5, 2.0, 1.0}) {
        const float size = std::floor(app::kTextPx * float(scale));
        declare(
            ui,
            [&](ImDrawList& list) {
                EXPECT_EQ(ImGui::GetFontSize(), size);
                list.AddText({4, 6}, IM_COL32_WHITE, "Hi");
            },
            scale
        );
        const image::Image shown = show(ui);
        coverage.push_back(measureCoverage(shown));
        EXPECT_GT(coverage.front(), 15.0);
        // Strokes have the same shape at every size, up to the parts of pixels at their borders.
        EXPECT_NEAR(coverage.back() / coverage.front(), scale * scale, 0.15 * scale * scale);
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x)
                if (float(x) < 4 || float(x) >= 4 + 18 * scale || float(y) < 6 ||
                    float(y) >= 6 + size) {
                    ASSERT_NEAR(shown.at(x, y, 0), kGrey, 0.6f / 255.0f) << x << ", " << y;
                }
    }
    EXPECT_EQ(coverage.back(), coverage.front()) << "the same again";
}

TEST_F(UiOnWindow, ScalesAndTimesThatAreNoneAreTakenAsSome) {
    app::Ui ui(device());
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {kNaN, 0.0, -1.0, 1e300}) {
        declare(
            ui,
            [](ImDrawList&) {
                EXPECT_GE(ImGui::GetFontSize(), 7.0f);
                EXPECT_LE(ImGui::GetFontSize(), 120.0f);
                EXPECT_GT(ImGui::GetIO().DeltaTime, 0.0f);
            },
            bad > 1.0 ? 1.0 : bad,
            bad
        );
    }
    declare(
        ui, [](ImDrawList&) { EXPECT_EQ(ImGui::GetFontSize(), 120.0f); }, 1e300
    );
}

TEST_F(UiOnWindow, FramesInFlightDrawFromTheirOwnData) {
    const test::SceneBuilder scene;
    render::Renderer renderer(device(), scene.world.assets, 2);
    tonemap::Tonemap tonemap(device(), {});
    app::WindowOutput window(device());
    app::Ui ui(device());
    const std::vector<render::Effect*> effects{&tonemap, &window};
    render::FrameRequest request;
    request.view.camera = scene.camera;
    request.view.width = kWidth;
    request.view.height = kHeight;
    request.wantColor = false;
    request.wantDisplay = true;
    const auto submit = [&](float left, int rectangles) {
        declare(ui, [&](ImDrawList& list) {
            for (int i = 0; i < rectangles; ++i)
                list.AddRectFilled({left, 10}, {left + 10, 20}, IM_COL32_WHITE);
        });
        window.setTarget({.size = {kWidth, kHeight}, .overlay = &ui});
        ASSERT_TRUE(renderer.submitFrame(scene.world, request, {.effects = effects}).ok());
    };
    // More in each frame, so that buffers grow while another frame draws from its own.
    submit(5, 1);
    submit(25, 2000);
    for (int frame = 0; frame < 4; ++frame) {
        const image::Image shown = renderer.finishFrame().display;
        const uint32_t left = 5 + 20 * uint32_t(frame % 3);
        for (uint32_t x = 0; x < kWidth; ++x)
            ASSERT_EQ(shown.at(x, 15, 0) > 0.9f, x >= left && x < left + 10)
                << "frame " << frame << " x " << x;
        if (frame < 2)
            submit(5 + 20 * float((frame + 2) % 3), 5000 * (frame + 1));
    }
}

class UiInput : public UiOnWindow {
  protected:
    /// One frame with a widget; returns what the widget returned.
    bool frame(app::Ui& ui, app::InputCollector& input, const std::function<bool()>& widget) {
        ui.begin(input.take(), {kWidth, kHeight}, 1.0, 0.02);
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({60, 60});
        ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        const bool result = widget();
        ImGui::End();
        ui.end();
        return result;
    }
};

TEST_F(UiInput, AClickThatIsOverWithinOneFrameIsAClick) {
    app::Ui ui(device());
    app::InputCollector input;
    const auto button = [] { return ImGui::Button("button", {40, 40}); };
    input.movePointer({70, 50});
    frame(ui, input, button);
    frame(ui, input, button);
    EXPECT_FALSE(ui.wantsPointer());
    input.movePointer({20, 20});
    frame(ui, input, button);
    frame(ui, input, button);
    EXPECT_TRUE(ui.wantsPointer());
    input.setButton(app::MouseButton::Left, true);
    input.setButton(app::MouseButton::Left, false);
    int clicks = 0;
    for (int i = 0; i < 5; ++i)
        clicks += frame(ui, input, button);
    EXPECT_EQ(clicks, 1);
}

TEST_F(UiInput, TextIsTypedAndErased) {
    app::Ui ui(device());
    app::InputCollector input;
    char text[32] = "";
    bool focus = true;
    const auto field = [&] {
        if (focus)
            ImGui::SetKeyboardFocusHere();
        focus = false;
        return ImGui::InputText("##text", text, sizeof(text));
    };
    for (int i = 0; i < 3; ++i)
        frame(ui, input, field);
    EXPECT_TRUE(ui.wantsKeys());
    for (const char c : {'a', 'b', 'c'})
        input.type(uint32_t(c));
    frame(ui, input, field);
    EXPECT_STREQ(text, "abc");
    input.setKey(app::Key::Backspace, true);
    input.setKey(app::Key::Backspace, false);
    frame(ui, input, field);
    EXPECT_STREQ(text, "ab");
    input.setKey(app::Key::Enter, true);
    for (int i = 0; i < 3; ++i)
        frame(ui, input, field);
    EXPECT_FALSE(ui.wantsKeys());
}

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
