// SPDX-License-Identifier: MIT
// The frames of a sequence, one after another: of a flight through a scene, or of a demo played by
// its script. The caller draws the frames.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/extracted_frame.h"
#include "engine/math/transform.h"
#include "engine/scene/components.h"
#include "engine/scene/world.h"
#include "game/bench/suites/suite.h"
#include "game/shot/shot_options.h"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace shutter::bench {

/// Files of a sequence on disk, written by writeSequenceFiles().
struct SequenceFiles {
    std::filesystem::path scene;
    std::filesystem::path script;
};

/// Writes scene and script into folder/scenes/. Error: a file cannot be written.
[[nodiscard]] core::Result<SequenceFiles>
writeSequenceFiles(const SequenceCase& film, const std::filesystem::path& folder);

/// A camera's pose and view at one time.
struct StandingView {
    math::Transform pose; ///< in the world
    scene::Camera lens;
    scene::CameraLens opening; ///< fStop 0: a pinhole
    scene::CameraShutter shutter;
};

class SequenceSource {
  public:
    SequenceSource() = default;
    virtual ~SequenceSource() = default;
    SequenceSource(const SequenceSource&) = delete;
    SequenceSource& operator=(const SequenceSource&) = delete;

    /// Loads the scene; the first advance() leads to the first frame. Error: a file cannot be read.
    /// \param frames of the film, at least 1
    [[nodiscard]] static core::Result<std::unique_ptr<SequenceSource>>
    open(const SequenceCase& film, const SequenceFiles& files, uint32_t frames);

    /// Advances to the next frame.
    virtual void advance() = 0;

    /// The sequence's own camera has a lens at some time: methods that have none draw other
    /// pictures.
    [[nodiscard]] bool hasLens() const;

    /// What is seen in the current frame.
    [[nodiscard]] extract::ViewRequest view() const;

    [[nodiscard]] virtual const scene::World& world() const = 0;

    /// Size, pixel model and tone map of the pictures.
    [[nodiscard]] virtual const game::ShotOptions& options() const = 0;

    /// The film's.
    [[nodiscard]] virtual core::FrameRate framesPerSecond() const = 0;

    /// Where the sequence's own camera is in the current frame.
    [[nodiscard]] StandingView standingView() const;

    /// From now on frames are seen from there, by a camera at rest.
    void stand(const StandingView& from);

  protected:
    [[nodiscard]] virtual ecs::Entity ownCamera() const = 0;
    /// The view of the sequence's own camera.
    [[nodiscard]] virtual extract::ViewRequest ownView() const = 0;
    [[nodiscard]] virtual scene::World& changeWorld() = 0;

  private:
    ecs::Entity mStanding{}; ///< null: the sequence's own camera
};

/// The frames that `shutter play DEMO --script FILE` draws, without the head-up display. Error: the
/// demo's scene or the script cannot be read.
[[nodiscard]] core::Result<std::unique_ptr<SequenceSource>>
openDemo(const SequenceCase& film, const SequenceFiles& files);

/// The frames of a flythrough. Error: the scene or the flythrough cannot be read.
[[nodiscard]] core::Result<std::unique_ptr<SequenceSource>>
openFlight(const SequenceCase& film, const SequenceFiles& files, uint32_t frames);

} // namespace shutter::bench
