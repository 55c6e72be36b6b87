// SPDX-License-Identifier: MIT
// The last effect of a frame that is shown: draws its picture onto the window's image, optionally
// another picture to the left of a divider, and an overlay over both.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/swapchain.h"
#include "engine/math/math.h"
#include "engine/render/effect.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace shutter::app {

/// A rectangle of pixels.
struct PixelRect {
    math::dvec2 origin{0.0}; ///< upper left corner
    math::dvec2 extent{0.0};
};

/// The largest rectangle with the picture's aspect ratio, in the middle of the window. Both sizes
/// above 0; a side that is within a pixel of the window's is the window's.
[[nodiscard]] PixelRect fitPicture(const math::uvec2& picture, const math::uvec2& window);

/// Where an overlay draws: a colour attachment of dynamic rendering that has begun, with viewport
/// and scissor set to all of it. Values are display-encoded.
struct OverlayTarget {
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t width = 0;  ///< pixels
    uint32_t height = 0; ///< pixels
    uint32_t slot = 0;   ///< frame in flight, below gpu::kMaxFramesInFlight
};

/// Drawn over the picture in the window: the user interface.
class Overlay {
  public:
    virtual ~Overlay() = default;

    /// Records the drawing; called once per frame, when the GPU has finished the slot's last one.
    virtual void record(gpu::Frame& frame, const OverlayTarget& target) = 0;
};

/// One frame's window.
struct WindowTarget {
    /// Acquires the window system's image, which is left in PRESENT_SRC layout. Called while the
    /// frame is declared, after its work on the CPU, since the answer may take as long as a picture
    /// is on the display. Empty, or no answer: the frame draws on a transient.
    std::function<std::optional<gpu::SwapchainImage>()> acquire;
    math::uvec2 size{1u};             ///< pixels; of the image, where there is one
    const gpu::Image* left = nullptr; ///< in SHADER_READ_ONLY layout; null: no split
    double dividerShare = 0.5;        ///< of the window's width that shows `left`, [0, 1]
    Overlay* overlay = nullptr;       ///< may be null
};

/// Replaces the context's display by the window's picture, so that it can be read back. Pictures of
/// another size than the window are fitted in and filtered linearly.
class WindowOutput : public render::Effect {
  public:
    explicit WindowOutput(gpu::Device& device);
    ~WindowOutput() override;
    WindowOutput(const WindowOutput&) = delete;
    WindowOutput& operator=(const WindowOutput&) = delete;

    /// Must be called before each frame.
    void setTarget(const WindowTarget& target) { mTarget = target; }

    [[nodiscard]] std::string name() const override { return "window"; }

    [[nodiscard]] render::PassOwner owner() const override { return render::PassOwner::Display; }

    [[nodiscard]] render::Needs decide(const render::DecideContext&) const override {
        return {.run = {true, "the picture is shown"}};
    }

    void declare(render::PictureContext& context) override;

  private:
    const gpu::Pipeline& findPipeline(VkFormat format);

    gpu::Device& mDevice;
    VkSampler mLinear = VK_NULL_HANDLE;
    std::map<VkFormat, gpu::Pipeline> mPipelines;
    WindowTarget mTarget;
};

} // namespace shutter::app
