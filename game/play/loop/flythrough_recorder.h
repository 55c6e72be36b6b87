// SPDX-License-Identifier: MIT
// A camera's way as it is flown, for a file that replays it.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/extracted_frame.h"
#include "engine/flythrough/flythrough.h"
#include "engine/scene/world.h"

#include <filesystem>
#include <optional>

namespace shutter::game {

/// Seconds of game time between keys: at 10 keys per second a curve through them is within
/// millimetres of a hand's flight.
inline constexpr double kRecordedKeySeconds = 0.1;

class FlythroughRecorder {
  public:
    [[nodiscard]] bool isRecording() const { return mFlight.has_value(); }

    void start();

    /// Takes the camera's place at the raster instant, the picture's field of view and, where the
    /// first camera has a lens, the lens, if the last key is long enough ago. Another camera than
    /// before is a cut.
    /// \param view at game times that do not fall
    void addFrame(const scene::World& world, const extract::ViewRequest& view);

    /// Ends, and writes flythrough_NNN.json, the first number that is free, into the folder. Times
    /// start at 0. Error: nothing was recorded, or the file cannot be written.
    [[nodiscard]] core::Result<std::filesystem::path> finish(const std::filesystem::path& folder);

  private:
    std::optional<flythrough::Flythrough> mFlight;
    ecs::Entity mCamera;                            ///< of the last frame
    double mStartSeconds = 0.0;                     ///< game time of the first key
    bool mHasLens = false;                          ///< the first key's camera; all keys have one
    std::optional<flythrough::FlythroughKey> mLast; ///< the last frame's key, if it was not kept
};

} // namespace shutter::game
