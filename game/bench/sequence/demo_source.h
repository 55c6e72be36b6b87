// SPDX-License-Identifier: MIT
#pragma once

#include "game/bench/sequence/sequence_source.h"

namespace shutter::bench {

/// The frames that `shutter play DEMO --script FILE` draws, without the head-up display. Error: the
/// demo's scene or the script cannot be read.
[[nodiscard]] core::Result<std::unique_ptr<SequenceSource>>
openDemo(const SequenceCase& film, const SequenceFiles& files);

} // namespace shutter::bench
