// SPDX-License-Identifier: MIT
// Methods to measure: each with its default settings, the paper's also with those of the
// publication, and some with more or fewer rays; and their sample counts.
#pragma once

#include "engine/core/result.h"
#include "game/shot/methods.h"
#include "game/shot/shot_options.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace shutter::bench {

/// "sharp", "gather", "gather_paper", ... in the order of game::listMethods(), and then the filters
/// of the lens, which are rivals and no methods of the program.
[[nodiscard]] std::span<const game::MethodInfo> listContenders();

/// Error: lists the names of all contenders.
[[nodiscard]] core::Result<const game::MethodInfo*> findContender(std::string_view name);

/// Whether only a suite with a dial measures it by default.
[[nodiscard]] bool isOnDialAlone(std::string_view contender);

/// A method at one of its sample counts.
struct SamplePoint {
    const game::MethodInfo* method = nullptr;
    uint32_t samples = 0; ///< 0: the method takes none
    bool isDefault = false;
};

/// Every sample count that the methods are measured at, the cheapest first.
[[nodiscard]] std::vector<SamplePoint>
makeSweep(const std::vector<const game::MethodInfo*>& methods, uint32_t maxRays);

/// The methods at their defaults; of `truth` a few numbers of rays.
[[nodiscard]] std::vector<SamplePoint>
makeDialPoints(const std::vector<const game::MethodInfo*>& methods);

/// With anti-aliasing: the methods that draw a raster image, which it is about, at their defaults.
[[nodiscard]] std::vector<SamplePoint>
makeAntiAliasedPoints(const std::vector<const game::MethodInfo*>& methods);

/// The methods at their defaults; truths with a few samples, since their time is proportional to
/// them.
[[nodiscard]] std::vector<SamplePoint>
makeScalingPoints(const std::vector<const game::MethodInfo*>& methods);

/// The methods as a film is drawn with them: at their defaults, accumulate with 8 instants, truth
/// with 4 rays.
[[nodiscard]] std::vector<SamplePoint>
makeSequencePoints(const std::vector<const game::MethodInfo*>& methods);

/// \param point of a contender
[[nodiscard]] game::MethodOptions makeMethodOptions(const SamplePoint& point);

} // namespace shutter::bench
