// SPDX-License-Identifier: MIT
// One case ready to be drawn: its scene on disk and on the device, its truth, its journal, and a
// name for everything that its pictures depend on.
#pragma once

#include "engine/core/progress.h"
#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/gpu/device_select.h"
#include "engine/image/image.h"
#include "game/bench/contenders.h"
#include "game/bench/crops.h"
#include "game/bench/journal.h"
#include "game/bench/measure.h"
#include "game/bench/suites/suite.h"
#include "game/bench/truth_cache.h"
#include "game/shot/picture_drawer.h"
#include "game/shot/shot.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shutter::bench {

struct CaseSetup {
    std::filesystem::path scene;
    /// Hash of the scene's bytes, the shot's options, this program and the device: pictures with
    /// equal hashes are equal, and their times comparable.
    std::string hash;
    /// The same without how methods smooth edges, on which the truth does not depend.
    std::string truthHash;
};

/// Writes a generated scene into folder/scenes/. Error: a file cannot be read or written.
[[nodiscard]] core::Result<CaseSetup>
setUpCase(const Case& shot, const gpu::DeviceInfo& device, const std::filesystem::path& folder);

/// A method at one sample count, drawn again and again.
struct DrawnPoint {
    SamplePoint point;
    std::unique_ptr<game::PictureDrawer> drawer{}; ///< made when it is drawn first
};

class CaseStage {
  public:
    /// Loads the scene. Error: it cannot be written or read.
    [[nodiscard]] static core::Result<std::unique_ptr<CaseStage>> create(
        gpu::Device& device,
        const Case& shot,
        const MeasureOptions& options,
        core::Progress& progress
    );

    /// Draws the truth, or takes it from the cache, and writes it into the report's folder.
    [[nodiscard]] core::Status provideTruth();

    [[nodiscard]] core::Result<render::FrameResult>
    draw(DrawnPoint& drawn, const game::Checkpoints& checkpoints = {});

    /// Writes the picture and its error map, unless there is no truth or the journal has them.
    [[nodiscard]] core::Status
    keepPicture(const SamplePoint& point, const render::FrameResult& drawn);
    /// Adds the picture's times to the journal.
    [[nodiscard]] core::Status
    keepSample(const SamplePoint& point, const render::FrameResult& drawn);

    /// Where rays change the picture most, and where motion blur does.
    [[nodiscard]] core::Result<std::vector<Crop>> chooseCrops() const;

    [[nodiscard]] Journal& journal() { return mJournal; }

    /// Whether everything at this point has been measured.
    [[nodiscard]] bool isKnown(const SamplePoint& point, uint32_t repeats) const;

    /// Whether pictures are compared with the lens's depth of field.
    [[nodiscard]] bool hasLens() const;

    [[nodiscard]] const std::string& truthImage() const { return mTruthImage; }

    [[nodiscard]] const std::string& truthLinear() const { return mTruthLinear; }

    [[nodiscard]] const std::string& truthHash() const { return mTruthHash; }

  private:
    CaseStage(
        gpu::Device& device,
        const Case& shot,
        const MeasureOptions& options,
        core::Progress& progress,
        const CaseSetup& setup
    );
    core::Status load();
    [[nodiscard]] core::Result<TruthPictures> drawTruth();
    [[nodiscard]] core::Result<render::FrameResult>
    drawPicture(DrawnPoint& drawn, const game::Checkpoints& checkpoints, bool wantsLinear);
    [[nodiscard]] core::Result<image::Image> readDefault(std::string_view method) const;

    gpu::Device& mDevice;
    const Case& mCase;
    const MeasureOptions& mOptions;
    core::Progress& mProgress;
    std::filesystem::path mScene;
    std::string mTruthHash;
    std::string mTruthImage;  ///< empty until there is one
    std::string mTruthLinear; ///< likewise
    Journal mJournal;
    game::ShotOptions mShotOptions;
    game::Shot mShot;
    std::optional<tonemap::Tonemap> mTonemap;
    std::unique_ptr<render::Renderer> mRenderer;
    TruthPictures mTruth; ///< without pixels if nothing is compared
};

} // namespace shutter::bench
