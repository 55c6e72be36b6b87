// SPDX-License-Identifier: MIT
// How a film is drawn in parts: what `shutter render` would be told, and which frames each part
// draws. Lies as plan.json in the film's working folder, which every machine that draws sees.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace shutter::film {

/// Most parts of a film.
inline constexpr uint32_t kMaxParts = 10000;

/// Consecutive frames of a film.
struct FilmPart {
    uint32_t first = 0; ///< index among the film's frames, from 0
    uint32_t count = 0; ///< above 0

    bool operator==(const FilmPart&) const = default;
};

struct FilmPlan {
    std::string fingerprint;        ///< of the pictures, without a device (computeFingerprint)
    std::filesystem::path folder;   ///< absolute; relative paths among `words` start there
    std::vector<std::string> words; ///< arguments of `shutter render`
    std::vector<FilmPart> parts;    ///< in order, each frame once

    [[nodiscard]] uint32_t frameCount() const {
        return parts.empty() ? 0 : parts.back().first + parts.back().count;
    }
};

/// Splits frames where the costs sum up to equal shares.
/// \param costs one per frame, any unit, 0 or more; at least one
/// \param parts above 0; as many as there are frames at most are made
[[nodiscard]] std::vector<FilmPart> splitIntoParts(std::span<const double> costs, uint32_t parts);

/// Costs of all frames from those of some, linear in between.
/// \param samples frame index and cost, by index, at least one
[[nodiscard]] std::vector<double>
interpolateCosts(std::span<const std::pair<uint32_t, double>> samples, uint32_t frameCount);

/// Whole or not at all. Error: names the file.
[[nodiscard]] core::Status writePlan(const std::filesystem::path& file, const FilmPlan& plan);

/// Error: the file cannot be read, or its parts leave frames out; names it and the field.
[[nodiscard]] core::Result<FilmPlan> readPlan(const std::filesystem::path& file);

} // namespace shutter::film
