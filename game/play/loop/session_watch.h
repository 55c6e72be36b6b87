// SPDX-License-Identifier: MIT
// Observer of an unattended session: may replace the stage, and measures.
#pragma once

#include "game/play/loop/stage.h"

#include <cstdint>
#include <functional>
#include <memory>

namespace shutter::gpu {
class Device;
}

namespace shutter::game {

/// A watched session shows no times, so that its pictures are the same in every run.
class SessionWatch {
  public:
    virtual ~SessionWatch() = default;

    /// Called once, before the first frame. \return the stage to play in place of `stage`
    [[nodiscard]] virtual std::unique_ptr<Stage> wrap(std::unique_ptr<Stage> stage) = 0;

    /// Called after a picture was submitted.
    /// \param picture counted from 0
    /// \param device that draws it
    /// \param finish waits until all that was submitted is done
    virtual void
    notePicture(uint32_t picture, gpu::Device& device, const std::function<void()>& finish) = 0;
};

} // namespace shutter::game
