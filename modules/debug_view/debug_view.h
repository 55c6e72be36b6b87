// SPDX-License-Identifier: MIT
// Intermediates on the screen: motion, tiles, masks and what else the effects of a frame publish,
// in the place of the picture.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/render/effect.h"

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace shutter::debug_view {

/// A channel of an intermediate that means something.
struct Channel {
    uint32_t source; ///< of the image
    const char* name;
};

struct ViewInfo {
    const char* name;                  ///< name of the intermediate, or of a combination of several
    const char* description;           ///< one line: content and how to read it
    std::span<const Channel> channels; ///< of the intermediate in a file; empty: there is none
};

/// In the order of the frame: every intermediate that an effect publishes to be seen.
[[nodiscard]] std::span<const ViewInfo> listViews();

/// Null: there is none of that name.
[[nodiscard]] const ViewInfo* findView(std::string_view name);

/// Intermediates that the view is made of (FrameRequest::shownIntermediates). Empty for a name that
/// is none of listViews().
[[nodiscard]] std::set<std::string> listSources(std::string_view view);

/// After the tone mapper. Where an intermediate was not made in this frame, the picture stays.
class DebugView : public render::Effect {
  public:
    explicit DebugView(gpu::Device& device);

    /// \param view one of listViews(), or empty: none
    void setView(std::string_view view) { mView = view; }

    /// The frame declared last showed the picture, since no effect made what the view needs.
    [[nodiscard]] bool isMissing() const { return mIsMissing; }

    [[nodiscard]] std::string name() const override { return "debug view"; }

    [[nodiscard]] render::PassOwner owner() const override { return render::PassOwner::Display; }

    [[nodiscard]] render::Needs decide(const render::DecideContext& context) const override;
    void declare(render::PictureContext& context) override;

  private:
    VkSampler mSampler;
    gpu::Pipeline mPipeline;
    std::string mView;
    bool mIsMissing = false;
};

} // namespace shutter::debug_view
