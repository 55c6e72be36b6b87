// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "tests/support/stage.h"

#include <cstdint>

namespace shutter::test {

/// Expects a white quad that moves at constant speed before black to be the exact trapezoid of its
/// coverage in each shutter phase. \param samples instants, or rays a pixel
void expectTrapezoidInEachPhase(
    gpu::Device& device, std::string_view method, uint32_t samples, double tolerance
);

} // namespace shutter::test
