// SPDX-License-Identifier: MIT
// Dear ImGui on this engine's window: input goes in, an overlay comes out.
#pragma once

#include "engine/app/input.h"
#include "engine/app/overlay.h"

#include <memory>

namespace shutter::app {

/// One at a time. Widgets are declared with ImGui's own functions between begin() and end().
class Ui : public Overlay {
  public:
    explicit Ui(gpu::Device& device);
    ~Ui() override;
    Ui(const Ui&) = delete;
    Ui& operator=(const Ui&) = delete;

    /// \param windowPx size, pixels \param scale pixels a point (Window::contentScale)
    /// \param seconds since the last frame
    void begin(const InputState& input, const math::uvec2& windowPx, double scale, double seconds);
    /// What record() draws is complete.
    void end();

    /// The pointer is over a widget or holds one: no input of the game's.
    [[nodiscard]] bool wantsPointer() const;
    /// Text is being typed.
    [[nodiscard]] bool wantsKeys() const;

    void record(gpu::Frame& frame, const OverlayTarget& target) override;

  private:
    struct State;
    std::unique_ptr<State> mState;
};

} // namespace shutter::app
