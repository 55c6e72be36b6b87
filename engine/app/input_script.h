// SPDX-License-Identifier: MIT
// Scripted input for automated play: events with their times, so that a game can be tested and
// filmed unattended.
#pragma once

#include "engine/app/input.h"
#include "engine/core/result.h"
#include "engine/io/uri.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace shutter::app {

enum class PressAction : uint8_t { Press, Release, Tap };
enum class WindowAction : uint8_t { Minimise, Restore, FullScreen, Windowed, Quit };

struct KeyEvent {
    Key key = Key::A;
    PressAction action = PressAction::Tap;
};

struct ButtonEvent {
    MouseButton button = MouseButton::Left;
    PressAction action = PressAction::Tap;
};

struct PointerEvent {
    math::dvec2 share{0.0}; ///< of the window from the upper left, [0, 1]
};

struct WheelEvent {
    double steps = 0.0;
};

/// A gamepad's stick; the gamepad counts as connected from then on.
struct StickEvent {
    bool right = false;
    math::dvec2 value{0.0}; ///< [-1, 1], right and up positive
};

struct ResizeEvent {
    math::uvec2 size{1u}; ///< screen coordinates
};

struct ScreenshotEvent {
    std::filesystem::path file; ///< .png or .jpg, from where the program runs
};

struct ScriptEvent {
    double seconds = 0.0; ///< since the start, of the script's frames
    std::variant<
        KeyEvent,
        ButtonEvent,
        PointerEvent,
        WheelEvent,
        StickEvent,
        ResizeEvent,
        WindowAction,
        ScreenshotEvent>
        what;
};

/// engine/app/input_script.schema.json defines the file format.
struct InputScript {
    double frameSeconds = 1.0 / 30.0; ///< fixed duration of every frame, independent of wall-clock
                                      ///< time; above 0
    std::vector<ScriptEvent> events;  ///< by rising time
};

/// Error: names the file, line and field.
/// \param reach the screenshots that it may write: those below where the program runs, or all
[[nodiscard]] core::Result<InputScript>
readInputScript(const std::filesystem::path& path, io::Reach reach = io::Reach::Folder);

/// Hands out a script's events frame by frame.
class ScriptPlayer {
  public:
    explicit ScriptPlayer(InputScript script) : mScript(std::move(script)) {}

    [[nodiscard]] double frameSeconds() const { return mScript.frameSeconds; }

    /// The events of the next frame; those of input go to `input` already.
    /// \param windowPx size of the window, pixels
    [[nodiscard]] std::span<const ScriptEvent>
    takeFrame(InputCollector& input, const math::uvec2& windowPx);

    /// Frames from the start until the script is over or quits.
    [[nodiscard]] uint64_t countFrames() const;

    /// All events were handed out.
    [[nodiscard]] bool isOver() const { return mNext == mScript.events.size(); }

  private:
    void apply(const ScriptEvent& event, InputCollector& input, const math::uvec2& windowPx);

    InputScript mScript;
    size_t mNext = 0;
    uint64_t mFrame = 0;
    Gamepad mPad;
};

} // namespace shutter::app
