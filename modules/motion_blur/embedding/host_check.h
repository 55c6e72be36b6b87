// SPDX-License-Identifier: MIT
// What a checker finds wrong with a host's inputs, from totals and samples of its images. No
// device: host_checker.h reads them back.
#pragma once

#include "modules/motion_blur/embedding/host_convention.h"
#include "modules/motion_blur/embedding/host_motion.h"
#include "shaders/motion_blur/check_shared.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace shutter::motion_blur {

/// What a host said of a recording, as far as it can be compared with the images.
struct CheckFacts {
    struct Mover {
        uint32_t row = 0;
        bool isInView = false; ///< its origin is at the raster instant; deforming ones: false
    };

    VkExtent2D picture{0, 0};
    HostConvention convention; ///< of motionDepth: metres, pixels over the exposure
    bool isNative = false;     ///< motionDepth was given, whose vectors are over the exposure
    bool hasVectors = true;    ///< false: nothing moves but the camera
    double rasterTime = 1.0;
    /// With `exposure`: of HostMotion::keys, where there is more than one.
    bool hasExposureCameras = false;
    HostCameras open;  ///< now: the raster instant; before: the shutter's opening
    HostCameras close; ///< before: its closing
    bool hasIds = false;
    bool readsMotion = false; ///< the method reads HostMotion
    uint32_t noEntity = 0xFFFFFFFF;
    uint32_t rowCount = 0; ///< 0: not said
    std::vector<Mover> movers;
    bool followsLast = false;
    int64_t frameNumber = 0;
    uint32_t view = 0;
    uint32_t number = 0; ///< of the view's recordings
};

/// Sentences of the same kind are not repeated in every frame.
enum class CheckKind : uint8_t {
    LeftOut, ///< no mistake: says which checks cannot be made
    ColorNan,
    ColorInfinite,
    ColorNegative,
    MotionNan,
    MotionInfinite,
    MotionBeyond,
    DepthNan,
    DepthInfinite,
    DepthNegative,
    DepthZero,
    DepthAboveOne,
    DepthEqual,
    DepthSky,
    DepthDirection,
    DepthPrecision,
    Vectors,
    VectorOffset,
    IdBeyond,
    IdChanges,
    MoverUnlisted,
    MoverUnseen,
    CameraJump,
    Count
};

struct Finding {
    CheckKind kind = CheckKind::LeftOut;
    std::string sentence; ///< without a full stop
};

struct CheckedFrame {
    CheckFacts facts;
    shader::CheckTotals totals{};
    /// Vectors minus the camera's part, where that is the same nearly everywhere; for the frame
    /// after.
    glm::dvec2 offsetPx{0.0};
    bool hasOffset = false;
};

/// \param last the frame before of the same view, or null
[[nodiscard]] std::vector<Finding> checkFrame(CheckedFrame& now, const CheckedFrame* last);

// The parts of checkFrame().

/// Ranges, NaN and infinity, what depth values tell by themselves.
void checkTotals(const CheckedFrame& now, std::vector<Finding>& findings);
/// Whether nearly all depth lies at the near plane, as it does where its direction is wrong.
[[nodiscard]] bool checkDepthDirection(const CheckedFrame& now, std::vector<Finding>& findings);
/// Vectors against what the cameras imply.
void checkVectors(CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings);
void checkIds(const CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings);
void checkCameras(
    const CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings
);

/// A sample as the motion blur would take it.
struct CheckPoint {
    glm::dvec2 place{0.0};  ///< pixels of the picture
    glm::dvec2 motion{0.0}; ///< pixels, by `pixelsPerUnit` and without declared jitter
    glm::dvec2 camera{0.0}; ///< what the cameras imply for what stands still
    float depth = 0.0f;     ///< as stored
    float metres = 0.0f;
    bool isSky = false;
    uint32_t id = 0;
};

/// "12 pixels (0.3 %)"
/// \param index of CheckTotals::counts
[[nodiscard]] std::string describeCount(const CheckedFrame& frame, uint32_t index);

/// Whether cameras imply anything for the frame.
[[nodiscard]] bool hasCameras(const CheckFacts& facts);

/// The samples with finite vectors and depth.
/// \param said what the host said, or what it might have meant
[[nodiscard]] std::vector<CheckPoint> makePoints(const CheckedFrame& frame, const CheckFacts& said);

} // namespace shutter::motion_blur
