// SPDX-License-Identifier: MIT
// Where a session is shown and played: window, device, swapchain and user interface; without a
// window, a device and the size of the pictures.
#pragma once

#include "engine/app/input_script.h"
#include "engine/app/ui.h"
#include "engine/app/window.h"
#include "engine/gpu/swapchain.h"
#include "game/play/loop/play_options.h"
#include "game/play/loop/play_renderer.h"

#include <future>
#include <memory>
#include <optional>
#include <string>

namespace shutter::game {

class PlayScreen {
  public:
    ~PlayScreen();

    /// Opens the window, unless the options do without one, and the device.
    /// Error: there is no display, or no device that can do what the options demand.
    [[nodiscard]] core::Status open(const PlayOptions& options, bool vsync);

    /// Destroys what draws, which validation watches too. Only device() may be used afterwards.
    void releaseDrawing();

    [[nodiscard]] bool hasWindow() const { return mWindow != nullptr; }

    [[nodiscard]] gpu::Device& device() const { return *mDevice; }

    [[nodiscard]] app::Ui& ui() const { return *mUi; }

    /// Pixels; 0 while the window is minimised.
    [[nodiscard]] math::uvec2 size() const;
    /// Scale of the user interface, 1 without a window.
    [[nodiscard]] double contentScale() const;

    /// The input of this turn. A script's is kept apart from what the window receives, an absent
    /// gamepad included.
    [[nodiscard]] app::InputCollector& collector(bool isScripted);

    /// Takes the window's events. \param wait until there is one
    void poll(bool wait);
    [[nodiscard]] bool closeRequested() const;
    void setTitle(const std::string& title);
    /// Pixels.
    void resize(const math::uvec2& size);
    /// What a script does to the window; nothing without one.
    void apply(app::WindowAction action);
    void toggleFullScreen();

    /// Recreates the swapchain if it does not fit the window, whose size is `sizePx`: for another
    /// size or mode, or at the window system's request. `renderer` is finished for that.
    /// \return whether there are images: a window may have no area to draw on now
    [[nodiscard]] bool fit(const math::uvec2& sizePx, bool vsync, PlayRenderer& renderer);

    /// The next image of the window; nothing if it changes its size: fit() comes before the next.
    [[nodiscard]] std::optional<gpu::SwapchainImage> acquire() { return mSwapchain->acquire(); }

    /// Shows an acquired image that was drawn on.
    void present(const gpu::SwapchainImage& image) { mSwapchain->present(image); }

    /// Shows what ui() declared last, alone on black, and waits for it: before there is a picture.
    /// Shows nothing without a window, or if that does not fit its images now.
    [[nodiscard]] core::Status showUi();

    /// Writes the pipelines that are made by now to disk, on another thread. Once.
    void keepPipelines();

    /// Null without a window.
    [[nodiscard]] const gpu::Swapchain* swapchain() const { return mSwapchain.get(); }

  private:
    core::Status openSwapchain(bool vsync);
    void remakeSwapchain(const gpu::SwapchainDesc& desc, PlayRenderer& renderer);

    std::unique_ptr<app::Window> mWindow;
    app::InputCollector mInput; ///< a script's, and that of a session without a window
    std::unique_ptr<gpu::Device> mDevice;
    std::future<void> mKeeping; ///< of keepPipelines(); ends before the device
    std::unique_ptr<gpu::Swapchain> mSwapchain;
    std::unique_ptr<app::Ui> mUi;
    math::uvec2 mHeadlessSize{1u};
};

} // namespace shutter::game
