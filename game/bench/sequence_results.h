// SPDX-License-Identifier: MIT
// A measured sequence as the JSON that results.schema.json describes.
#pragma once

#include "game/bench/sequence_run.h"

#include <nlohmann/json_fwd.hpp>

namespace shutter::bench {

/// How the measures of a film are named and which way is better.
[[nodiscard]] nlohmann::json describeTemporalMetrics();

[[nodiscard]] nlohmann::json describeSequence(
    const SequenceCase& film, const SequenceResult& result, const SequenceOptions& options
);

} // namespace shutter::bench
