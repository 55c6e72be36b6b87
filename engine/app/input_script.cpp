// SPDX-License-Identifier: MIT
#include "engine/app/input_script.h"

#include "engine/io/image_file.h"
#include "engine/json/json_file.h"

#include <array>
#include <cmath>
#include <utility>

namespace shutter::app {

namespace {

constexpr size_t kMaxEvents = 100'000;
constexpr double kMaxSeconds = 3600.0;

constexpr std::array<std::pair<std::string_view, PressAction>, 3> kPressActions = {
    {{"press", PressAction::Press}, {"release", PressAction::Release}, {"tap", PressAction::Tap}}};
constexpr std::array<std::pair<std::string_view, MouseButton>, 3> kButtons = {
    {{"left", MouseButton::Left}, {"right", MouseButton::Right}, {"middle", MouseButton::Middle}}};
constexpr std::array<std::pair<std::string_view, WindowAction>, 5> kWindowActions = {
    {{"minimise", WindowAction::Minimise},
     {"restore", WindowAction::Restore},
     {"full_screen", WindowAction::FullScreen},
     {"windowed", WindowAction::Windowed},
     {"quit", WindowAction::Quit}}};

Key readKey(const json::JsonNode& node) {
    const std::string name = node.readString(32);
    const auto key = findKey(name);
    if (!key)
        node.fail("there is no key '{}'", name);
    return key.value_or(Key::A);
}

PressAction readAction(const json::JsonObject& event) {
    const auto action = event.find("action");
    return action ? action->readChoice(kPressActions) : PressAction::Tap;
}

StickEvent readStick(const json::JsonNode& node, bool right) {
    const auto value = node.readNumbers<2>({-1.0, 1.0});
    return {right, {value[0], value[1]}};
}

ScreenshotEvent readScreenshot(const json::JsonNode& node, io::Reach reach) {
    const std::filesystem::path file = node.readString();
    const auto isDisplay = io::isDisplayFormat(file, ".png or .jpg");
    if (!isDisplay)
        node.fail(isDisplay.error().message);
    else if (!isDisplay.value())
        node.fail("'{}': a window's picture is no linear light", file.string());
    else if (reach == io::Reach::Folder && !io::liesInside("", file))
        node.fail("'{}' leaves the folder in which the program runs", file.string());
    return {file};
}

ScriptEvent readEvent(const json::JsonNode& node, io::Reach reach) {
    const json::JsonObject object = node.readObject(
        {"time",
         "key",
         "button",
         "action",
         "pointer",
         "wheel",
         "leftStick",
         "rightStick",
         "resize",
         "window",
         "screenshot"}
    );
    ScriptEvent event;
    event.seconds = object.require("time").readNumber({0.0, kMaxSeconds});
    int kinds = 0;
    const auto take = [&](std::string_view field, auto&& read) {
        if (const auto value = object.find(field)) {
            ++kinds;
            event.what = read(*value);
        }
    };
    take("key", [&](const json::JsonNode& n) { return KeyEvent{readKey(n), readAction(object)}; });
    take("button", [&](const json::JsonNode& n) {
        return ButtonEvent{n.readChoice(kButtons), readAction(object)};
    });
    take("pointer", [](const json::JsonNode& n) {
        const auto share = n.readNumbers<2>({0.0, 1.0});
        return PointerEvent{{share[0], share[1]}};
    });
    take("wheel", [](const json::JsonNode& n) {
        return WheelEvent{n.readNumber({-100.0, 100.0})};
    });
    take("leftStick", [](const json::JsonNode& n) { return readStick(n, false); });
    take("rightStick", [](const json::JsonNode& n) { return readStick(n, true); });
    take("resize", [](const json::JsonNode& n) {
        const std::vector<json::JsonNode> sides = n.readArray(2, 2);
        ResizeEvent resize;
        for (size_t i = 0; i < sides.size() && i < 2; ++i)
            resize.size[static_cast<int>(i)] =
                static_cast<uint32_t>(sides[i].readInteger(1, 16384));
        return resize;
    });
    take("window", [](const json::JsonNode& n) { return n.readChoice(kWindowActions); });
    take("screenshot", [&](const json::JsonNode& n) { return readScreenshot(n, reach); });
    if (kinds != 1)
        node.fail(
            "must have one of key, button, pointer, wheel, leftStick, rightStick, resize, window, "
            "screenshot; it has {}",
            kinds
        );
    if (object.find("action") && !object.find("key") && !object.find("button"))
        object.require("action").fail("belongs to a key or a button");
    return event;
}

InputScript readScript(const json::JsonNode& root, io::Reach reach) {
    const json::JsonObject object = root.readObject({"version", "frameSeconds", "events"});
    (void)object.require("version").readInteger(1, 1);
    InputScript script;
    if (const auto seconds = object.find("frameSeconds"))
        script.frameSeconds = seconds->readNumber({0.0, 1.0, true});
    double last = 0.0;
    for (const json::JsonNode& node : object.require("events").readArray(1, kMaxEvents)) {
        script.events.push_back(readEvent(node, reach));
        if (script.events.back().seconds < last)
            node.fail("must not come before the event before it, at {} s", last);
        last = script.events.back().seconds;
    }
    return script;
}

} // namespace

core::Result<InputScript> readInputScript(const std::filesystem::path& path, io::Reach reach) {
    return json::readJsonFile(path, [&](const json::JsonNode& root) {
        return readScript(root, reach);
    });
}

uint64_t ScriptPlayer::countFrames() const {
    double seconds = 0.0;
    for (const ScriptEvent& event : mScript.events) {
        seconds = event.seconds;
        const auto* action = std::get_if<WindowAction>(&event.what);
        if (action && *action == WindowAction::Quit)
            break;
    }
    return static_cast<uint64_t>(std::ceil(seconds / mScript.frameSeconds)) + 1;
}

std::span<const ScriptEvent>
ScriptPlayer::takeFrame(InputCollector& input, const math::uvec2& windowPx) {
    const double now = double(mFrame++) * mScript.frameSeconds;
    const size_t first = mNext;
    while (!isOver() && mScript.events[mNext].seconds <= now)
        apply(mScript.events[mNext++], input, windowPx);
    return std::span(mScript.events).subspan(first, mNext - first);
}

void ScriptPlayer::apply(
    const ScriptEvent& event, InputCollector& input, const math::uvec2& windowPx
) {
    const auto press = [](PressAction action, auto&& set) {
        if (action != PressAction::Release)
            set(true);
        if (action != PressAction::Press)
            set(false);
    };
    if (const auto* key = std::get_if<KeyEvent>(&event.what))
        press(key->action, [&](bool down) { input.setKey(key->key, down); });
    else if (const auto* button = std::get_if<ButtonEvent>(&event.what))
        press(button->action, [&](bool down) { input.setButton(button->button, down); });
    else if (const auto* pointer = std::get_if<PointerEvent>(&event.what))
        input.movePointer(pointer->share * math::dvec2(windowPx));
    else if (const auto* wheel = std::get_if<WheelEvent>(&event.what))
        input.turnWheel(wheel->steps);
    else if (const auto* stick = std::get_if<StickEvent>(&event.what)) {
        mPad.present = true;
        (stick->right ? mPad.rightStick : mPad.leftStick) = stick->value;
        input.setPad(mPad);
    }
}

} // namespace shutter::app
