// SPDX-License-Identifier: MIT
// Dear ImGui on this engine's window: converts input, draws an overlay.
//
// Input comes from InputState, so that scripts drive widgets as players do, and drawing is our own:
// the overlay is drawn within dynamic rendering, which the Vulkan backend of the oldest version
// that we build with (1.86) does not know.
#pragma once

#include "engine/app/input.h"
#include "engine/app/window_output.h"

#include <memory>

namespace shutter::app {

/// Height of a line of text at scale 1, pixels.
inline constexpr float kTextPx = 15.0f;
/// The same for text that is read at a glance.
inline constexpr float kLargeTextPx = 24.0f;

/// One at a time. Widgets are declared with ImGui's own functions between begin() and end(), in
/// pixels of the window; ImGui's font 0 has kTextPx, font 1 has kLargeTextPx.
class Ui : public Overlay {
  public:
    /// The device must outlive it, and be done with all frames it was recorded into when it ends.
    explicit Ui(gpu::Device& device);
    ~Ui() override;
    Ui(const Ui&) = delete;
    Ui& operator=(const Ui&) = delete;

    /// Starts a frame. Where the scale changes, the font is rebuilt, which waits for the GPU.
    /// \param windowPx size, pixels
    /// \param scale pixels per point (Window::contentScale); clamped to [0.5, 8], 1 where it is NaN
    /// \param seconds since the last frame; below 0 and NaN count as 0
    void begin(const InputState& input, const math::uvec2& windowPx, double scale, double seconds);
    /// What record() draws is complete.
    void end();

    /// The pointer is over a widget or holds one: no input of the game's.
    [[nodiscard]] bool wantsPointer() const;
    /// Text is being typed.
    [[nodiscard]] bool wantsKeys() const;

    /// Draws the widgets declared between the last begin() and end(); draws nothing before the
    /// first.
    void record(gpu::Frame& frame, const OverlayTarget& target) override;

  private:
    struct State;
    std::unique_ptr<State> mState;
};

/// Maps our keys to those of the current ImGui context; called once.
void mapKeys();

/// Hands one frame's input to the current ImGui context. A key or button that was pressed and
/// released within the frame counts as down in this frame.
void feedInput(const InputState& input);

} // namespace shutter::app
