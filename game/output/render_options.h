// SPDX-License-Identifier: MIT
// Everything that `shutter render` does: checked, in engine terms.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/io/image_file.h"
#include "engine/io/video.h"
#include "game/shot/shot_options.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace shutter::game {

/// The frames that one of several processes draws: each `count`th, from the `index`th on. Costs of
/// successive frames are alike, so all have about the same work.
struct FramePart {
    uint32_t index = 0; ///< below `count`
    uint32_t count = 1;
};

/// Options of the output.
struct OutputOptions {
    std::filesystem::path out;    ///< picture or %d pattern; for a film, the pattern of its frames
    std::filesystem::path film;   ///< .mp4 to make of the frames; empty: none
    std::filesystem::path ffmpeg; ///< empty: the one on PATH
    io::VideoFormat video;        ///< of the film
    bool keepFrames = false;      ///< do not remove a film's frames
    bool restart = false;         ///< draw frames again that are complete on disk
    bool displayOut = false;      ///< .png or .jpg: tone-mapped; otherwise linear
    std::set<std::string> aovs;   ///< intermediates to write
    std::filesystem::path stats;  ///< empty: none
    std::filesystem::path hashPasses; ///< JSON with hashes of each pass's outputs; empty: none
    bool dumpGraph = false;
    bool explain = false;            ///< print why each effect and pass ran or was skipped
    uint32_t repeat = 1;             ///< pictures that are timed
    std::optional<FramePart> part{}; ///< draws these frames alone, and no film
    bool dryRun = false;             ///< checks, and draws nothing

    /// Whether a film's frames have 16 bits per channel, because the film has more than 8.
    [[nodiscard]] bool isDeep() const { return !film.empty() && video.bitDepth > 8; }
};

/// In place of a time code: that of the number of the film's first frame.
inline constexpr std::string_view kTimecodeOfFrame = "frame";

struct RenderOptions {
    ShotOptions shot;
    MethodOptions method;
    OutputOptions output;
    gpu::DeviceOptions device;
    /// The options that pictures depend on, in one line. Files are identified by content, so the
    /// scene and the flythrough are not included.
    std::string fingerprint;
};

/// Checks before hours of rendering whether out and stats can be written. Error: names the option.
[[nodiscard]] core::Status checkOutputs(const RenderOptions& options);

/// The file of one frame. In the pattern's file name, not in its folders, every %04d (any width up
/// to 99) becomes the frame's number and %% one %; any other % is copied.
[[nodiscard]] std::filesystem::path
frameFile(const std::filesystem::path& pattern, int frameNumber);

/// The time code of a frame of a sequence by --timecode and --fps; wraps after 24 hours. Empty
/// without --timecode.
/// \param frame index among the sequence's frames
/// Error: names --timecode.
[[nodiscard]] core::Result<std::optional<io::Timecode>>
findTimecode(const RenderOptions& options, size_t frame);

/// Time metadata for the EXR pictures of a frame of a sequence; a single picture has none. \param
/// frame index among the sequence's frames
/// Error: names --timecode.
[[nodiscard]] core::Result<std::optional<io::FrameStamp>>
findStamp(const RenderOptions& options, size_t frame);

/// "01:00:00:00"
[[nodiscard]] std::string describe(const io::Timecode& timecode);

} // namespace shutter::game
