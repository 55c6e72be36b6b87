// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/pipeline.h"

#include <string>

namespace shutter::gpu {

/// A pipeline's description as bytes: equal exactly if one pipeline serves both descriptions. Scene
/// layouts are compared by handle, so they must outlive the cached pipelines.
[[nodiscard]] std::string makePipelineKey(const ComputePipelineDesc& desc);
[[nodiscard]] std::string makePipelineKey(const GraphicsPipelineDesc& desc);
[[nodiscard]] std::string makePipelineKey(const RayPipelineDesc& desc);

} // namespace shutter::gpu
