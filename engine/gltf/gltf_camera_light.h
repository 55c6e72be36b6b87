// SPDX-License-Identifier: MIT
// Private to engine/gltf.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/scene/components.h"

namespace shutter::gltf {

/// cameras[index] as a component. Throws GltfError for values no picture can be taken with.
[[nodiscard]] scene::Camera readCamera(const GltfContext& context, size_t index);

/// KHR_lights_punctual lights[index] as a component. Throws GltfError.
[[nodiscard]] scene::Light readLight(const GltfContext& context, size_t index);

} // namespace shutter::gltf
