// SPDX-License-Identifier: MIT
// Stores a frame's display-encoded picture for a later frame: the other half of a split screen.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/render/effect.h"

#include <string>

namespace shutter::app {

/// Must be the last effect of the frame whose picture is stored.
class KeptPicture : public render::Effect {
  public:
    explicit KeptPicture(gpu::Device& device) : mDevice(device) {}

    [[nodiscard]] std::string name() const override { return "keep picture"; }

    [[nodiscard]] render::PassOwner owner() const override { return render::PassOwner::Display; }

    [[nodiscard]] render::Needs decide(const render::DecideContext&) const override {
        return {.run = {true, "a later frame shows the picture"}};
    }

    void declare(render::PictureContext& context) override;

    /// The picture of the frame declared last, in SHADER_READ_ONLY layout; null before the first.
    [[nodiscard]] const gpu::Image* image() const { return mImage.handle() ? &mImage : nullptr; }

  private:
    gpu::Device& mDevice;
    gpu::Image mImage;
};

} // namespace shutter::app
