// SPDX-License-Identifier: MIT
#pragma once

#include "game/bench/sequence/sequence_source.h"

namespace shutter::bench {

/// The frames of a flythrough. Error: the scene or the flythrough cannot be read.
[[nodiscard]] core::Result<std::unique_ptr<SequenceSource>>
openFlight(const SequenceCase& film, const SequenceFiles& files, uint32_t frames);

} // namespace shutter::bench
