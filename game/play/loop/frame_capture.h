// SPDX-License-Identifier: MIT
// A frame as a RenderDoc capture, where the program was started by RenderDoc (renderdoc_app.h: the
// in-application API, version 1.0).
#pragma once

#include <string>

namespace shutter::game {

class FrameCapture {
  public:
    /// The next frame is to be captured. \return for the player: empty, or why it cannot be
    [[nodiscard]] std::string request();

    /// To be called before anything of a frame is submitted; does nothing without a request.
    void begin();

    /// To be called once the GPU is done with the frame.
    /// \return for the player: the capture's file, or that there is none; empty without a capture
    [[nodiscard]] std::string end();

    /// Between begin() and end() of a frame that is captured.
    [[nodiscard]] bool isUnderWay() const { return mState == State::UnderWay; }

  private:
    enum class State : unsigned char { Idle, Requested, UnderWay };

    State mState = State::Idle;
};

} // namespace shutter::game
