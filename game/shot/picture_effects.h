// SPDX-License-Identifier: MIT
// The effects that PictureSettings configures and that end a picture.
#pragma once

#include "engine/gpu/device.h"
#include "engine/render/effect.h"
#include "game/shot/picture_settings.h"

#include <functional>
#include <initializer_list>
#include <memory>
#include <vector>

namespace shutter::game {

class PictureEffects {
  public:
    explicit PictureEffects(gpu::Device& device);

    /// For the frames to come.
    void configure(const PictureSettings& settings);

    /// Whether an effect needs the brightest light of the last picture
    /// (render::FrameRequest::wantBrightest).
    [[nodiscard]] bool needsBrightest() const { return mNeedsBrightest; }

    /// In the order in which they run, and `last` behind them.
    [[nodiscard]] std::vector<render::Effect*> listWith(std::initializer_list<render::Effect*> last
    ) const;

  private:
    /// \param settings the effect's own, a member of PictureSettings
    template <class Module, class Settings>
    void add(gpu::Device& device, Settings PictureSettings::*settings);

    std::vector<std::unique_ptr<render::Effect>> mEffects;
    std::vector<std::function<void(const PictureSettings&)>> mConfigure; ///< per effect
    bool mNeedsBrightest = false;
};

} // namespace shutter::game
