// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/pipeline.h"

#include <string>

namespace shutter::gpu {

/// All that a pipeline is made of, as bytes: equal for two descriptions exactly where one pipeline
/// serves both. Scene layouts count by handle,
/// so they must live as long as the pipelines are kept.
[[nodiscard]] std::string makePipelineKey(const ComputePipelineDesc& desc);
[[nodiscard]] std::string makePipelineKey(const GraphicsPipelineDesc& desc);
[[nodiscard]] std::string makePipelineKey(const RayPipelineDesc& desc);

} // namespace shutter::gpu
