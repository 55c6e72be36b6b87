// SPDX-License-Identifier: MIT
// Draws the frames of a sequence by every method, through one camera.
#pragma once

#include "engine/core/progress.h"
#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/render/renderer.h"
#include "game/bench/frame_judge.h"
#include "game/bench/sequence/sequence_source.h"
#include "game/bench/sequence_plan.h"
#include "game/shot/picture_drawer.h"
#include "modules/tonemap/tonemap.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace shutter::bench {

/// How the truth is drawn: by accumulate, with as many instants as the frame moves.
struct SequenceTruth {
    double maxStepPx = 0.5; ///< nothing moves farther between two instants, pixels
    /// For any motion: the more there are, the less each of them shows.
    uint32_t mostInstants = 64;
};

/// The part of a file's name that a key of the journal gives: "hybrid.15".
[[nodiscard]] std::string namePart(std::string key);

/// The file of a picture that is stored for the film.
/// \param folder of the sequence's pictures
[[nodiscard]] std::filesystem::path
fileOfFrame(const std::filesystem::path& folder, const std::string& key, uint32_t frame);

/// Pattern of the file's name, for io::VideoFrames.
inline constexpr const char* kFramePattern = "frame_%06d.png";

class SequencePass {
  public:
    /// \param source, plan outlive this
    /// \param folder of the stored pictures; empty: none
    SequencePass(
        gpu::Device& device,
        const SequenceSource& source,
        const SequencePlan& plan,
        const SequenceTruth& truth,
        SequenceCamera camera,
        std::filesystem::path folder
    );

    /// The pictures of the source's current frame, the truth first, to be judged.
    [[nodiscard]] core::Result<std::vector<FramePicture>>
    drawFrame(uint32_t frame, core::Progress& progress);

  private:
    /// A method with its state between frames.
    struct Drawer {
        std::string key;
        game::MethodOptions options;
        Judgement judgement = Judgement::Whole;
        std::unique_ptr<game::PictureDrawer> drawer{}; ///< made when it draws first
    };

    /// \param wantLinear as well as the picture that a display shows
    [[nodiscard]] core::Result<render::FrameResult> drawOnce(Drawer& drawer, bool wantLinear);
    [[nodiscard]] core::Status
    draw(Drawer& drawer, uint32_t frame, std::vector<FramePicture>& pictures);

    gpu::Device& mDevice;
    const SequenceSource& mSource;
    const SequencePlan& mPlan;
    SequenceCamera mCamera;
    std::filesystem::path mFolder;
    render::Renderer mRenderer;
    tonemap::Tonemap mTonemap;
    std::vector<Drawer> mEachFrame; ///< the truth, then the plan's points
    std::vector<Drawer> mSwept;     ///< in the plan's frames alone
};

} // namespace shutter::bench
