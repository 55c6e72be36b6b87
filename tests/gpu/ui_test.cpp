// SPDX-License-Identifier: MIT
// The user interface on the window: pixels in their places, for windows and scripts.
#include "engine/app/ui.h"
#include "engine/app/window_output.h"
#include "modules/tonemap/tonemap.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <imgui.h>
#include <limits>
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
    const std::vector<render::PostEffect*> effects{&tonemap, &window};
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
        ASSERT_TRUE(renderer.submitFrame(scene.world, request, effects).ok());
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

} // namespace
} // namespace shutter
