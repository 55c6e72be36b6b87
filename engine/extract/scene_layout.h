// SPDX-License-Identifier: MIT
// What the CPU needs to know of a scene's meshes, once they are on the device.
#pragma once

#include "engine/math/bounds.h"
#include "engine/scene/assets.h"
#include "engine/scene/deformed_bounds.h"

#include <cstdint>
#include <vector>

namespace shutter::extract {

/// Where a mesh's triangles are, as extraction needs it.
struct SceneLayout {
    struct GeometryInfo {
        uint32_t firstIndex = 0;
        uint32_t indexCount = 0;
        scene::AlphaMode alphaMode = scene::AlphaMode::Opaque;
        bool doubleSided = false;
        uint32_t vertexCount = 0;
    };

    std::vector<uint32_t> firstGeometry;   ///< one a mesh, and one past the last
    std::vector<GeometryInfo> geometries;  ///< all meshes' primitives in order
    std::vector<math::Bounds> bounds;      ///< one a mesh, object space, undeformed
    std::vector<scene::PoseReach> reaches; ///< one a mesh
};

} // namespace shutter::extract
