// SPDX-License-Identifier: MIT
// Private to engine/gltf: what a node's `extras` say of its motion blur.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/scene/components.h"

#include <optional>
#include <string>

namespace shutter::gltf {

/// Of `extras.motionBlur`: {"scale": number in [0, 2], "exclude": true or false}, both optional;
/// nothing without it or where it is empty. Throws GltfError, naming the member, for values of
/// another kind or range. \param path of the node
[[nodiscard]] std::optional<scene::MotionBlur>
readMotionBlur(GltfContext& context, const tinygltf::Node& node, const std::string& path);

} // namespace shutter::gltf
