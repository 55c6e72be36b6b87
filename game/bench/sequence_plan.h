// SPDX-License-Identifier: MIT
// The frames to draw of a sequence, and their names in the journal.
#pragma once

#include "game/bench/contenders.h"
#include "game/shot/methods.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::bench {

/// Which camera a sequence is seen through.
enum class SequenceCamera : uint8_t {
    Own,      ///< the flight's or the demo's
    Standing, ///< at rest where the sequence's own is in its middle
};

/// The frames to draw of a sequence.
struct SequencePlan {
    std::vector<SamplePoint> points; ///< drawn in every frame
    std::vector<SamplePoint> sweep;  ///< other sample counts, drawn in some frames
    uint32_t frames = 0;
    uint32_t firstStanding = 0; ///< frames that are drawn again with a static camera
    uint32_t standingFrames = 0;
    std::vector<uint32_t> sweepFrames; ///< rising

    [[nodiscard]] bool isSwept(uint32_t frame) const;

    /// Whether HDR-FLIP is taken of it: of every fourth frame, since it is as dear as FLIP of all.
    [[nodiscard]] static bool isJudgedLinear(SequenceCamera camera, uint32_t frame);
};

/// \param methods that the device can run
/// \param truthInstants of accumulate at most, by which the truth is drawn
[[nodiscard]] SequencePlan planSequence(
    const std::vector<const game::MethodInfo*>& methods,
    uint32_t frames,
    uint32_t truthInstants,
    game::AntiAliasing antiAliasing = game::AntiAliasing::None
);

/// Pictures that are drawn in all, for a progress bar; the truth counts as one.
[[nodiscard]] uint64_t countPictures(const SequencePlan& plan);

/// The journal's key of a point's frame.
[[nodiscard]] std::string
makeFrameKey(SequenceCamera camera, const std::string& point, uint32_t frame);

/// The truth's, in place of makeKey()'s of a point, which has a sample count.
inline constexpr std::string_view kTruthKey = "truth";

} // namespace shutter::bench
