// SPDX-License-Identifier: MIT
// The suites there are, one function each.
#pragma once

#include "assets/generator/gltf_writer.h"
#include "game/bench/suites/suite.h"

namespace shutter::bench {

/// Case::writeScene of a generated scene.
[[nodiscard]] std::function<core::Status(const std::filesystem::path&)>
makeWriter(std::function<generator::GltfWriter()> build);

/// The paper's shot: a vase that crosses in front of a sofa.
[[nodiscard]] Suite makePaperSuite();
/// Twelve shots in which methods are known to fail.
[[nodiscard]] Suite makeHardSuite();
/// Resolution, entities, triangles, moving share of the screen, exposure.
[[nodiscard]] Suite makeScalingSuite();
/// Hard cases against the bounds that keep them numerically stable.
[[nodiscard]] Suite makeStabilitySuite();
/// What a frame costs against what its scene calls for.
[[nodiscard]] Suite makeDemandSuite();

} // namespace shutter::bench
