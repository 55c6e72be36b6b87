// SPDX-License-Identifier: MIT
// Motion of a host's camera and entities during the exposure, for methods with lookups at
// its instants (Method::readsInstantMotions).
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace shutter::shader {
struct ResponseTable;
} // namespace shutter::shader

namespace shutter::motion_blur {

inline constexpr double kMaxKeyTime = 1.0e6; ///< of HostCameraKey::time

/// ShutterBlurCameraKey.
struct HostCameraKey {
    double time = 0.0; ///< within kMaxKeyTime of 0
    glm::dmat4 viewFromWorld{1.0};
    glm::dmat4 clipFromView{1.0};
};

/// ShutterBlurMover.
struct HostMover {
    uint32_t row = 0;
    std::span<const glm::dmat4> worldFromObject; ///< as many as camera keys, or empty
};

/// ShutterBlurLens.
struct HostLens {
    double radius = 0.0;
    double focusDistance = 10.0;
    std::span<const double> focusDistances; ///< as many as camera keys, or empty
    double bladeRotation = 0.0;
    double roundness = 0.0;
    double squeeze = 1.0;
    uint32_t blades = 0;

    [[nodiscard]] bool isOpen() const { return radius != 0.0; }
};

/// Spans and pointers are read during the call only.
struct HostMotion {
    std::span<const HostCameraKey> keys;
    bool aheadIsPlusZ = false; ///< of view space; false: ahead is -Z
    uint32_t rowCount = 0;
    std::span<const HostMover> movers;
    std::span<const uint64_t> rowIds;
    std::span<const uint32_t> viewModelRows; ///< ShutterBlurInputs::viewModelRows
    /// There is one more row, rowCount, for pixels that HostConvention::viewModel names by depth.
    bool hasViewModel = false;
    glm::dmat4 viewModelProjection{0.0};        ///< of that row; all 0: the raster key's
    std::span<const glm::dmat4> viewFromObject; ///< as many as camera keys, or empty: sharp
    double cameraScale = 1.0;                   ///< HostScales::camera, where the convention counts
    double objectScale = 1.0;
    /// The table in main memory that HostInputs::response is the address of; null where that is 0.
    const shader::ResponseTable* response = nullptr;
    HostLens lens;
    uint32_t view = 0;        ///< a method without history drops that of its view
    bool followsLast = false; ///< counts with MotionBlurSettings::history
};

} // namespace shutter::motion_blur
