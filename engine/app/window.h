// SPDX-License-Identifier: MIT
// A window of the desktop (GLFW), its input, and the surface that pictures are shown on.
#pragma once

#include "engine/app/input.h"
#include "engine/core/result.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace shutter::app {

struct WindowDesc {
    std::string title;
    uint32_t width = 1280; ///< of the picture, screen coordinates
    uint32_t height = 720;
};

/// One at a time, on the main thread.
class Window {
  public:
    /// Error: there is no display, or it has no Vulkan.
    [[nodiscard]] static core::Result<std::unique_ptr<Window>> open(const WindowDesc& desc);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Instance extensions that surfaces need.
    [[nodiscard]] std::vector<std::string> surfaceExtensions() const;
    /// The caller's to destroy.
    [[nodiscard]] core::Result<VkSurfaceKHR> createSurface(VkInstance instance) const;

    /// Takes what happened; with `wait`, sleeps until something does (for a window out of sight).
    void poll(bool wait);

    [[nodiscard]] InputCollector& input() { return mInput; }

    /// Pixels to draw; 0 x 0 while it is minimised.
    [[nodiscard]] math::uvec2 framebufferSize() const;

    /// Pixels a point of the user interface, by the desktop's setting: 1, 1.5, 2 ...
    [[nodiscard]] double contentScale() const;

    [[nodiscard]] bool closeRequested() const;
    [[nodiscard]] bool isFullScreen() const;
    /// On the monitor it lies on most, and back to where it was.
    void setFullScreen(bool fullScreen);
    void resize(uint32_t width, uint32_t height);
    void minimise();
    void restore();
    void setTitle(const std::string& title);

  private:
    Window() = default;
    void listen();
    void readPad();
    /// Framebuffer pixels a screen coordinate.
    [[nodiscard]] math::dvec2 pixelScale() const;

    struct Placement {
        int x = 0;
        int y = 0;
        int width = 0;
        int height = 0;
    };

    GLFWwindow* mWindow = nullptr;
    InputCollector mInput;
    Placement mWindowed; ///< before full screen
};

} // namespace shutter::app
