// SPDX-License-Identifier: MIT
// Motion vectors and depth in a host's own conventions, for hosts without an image of both in the
// effect's convention (HostInputs::motionDepth); a pass converts them to it. The fields are
// documented in shutter_motion_blur.h.
#pragma once

#include "engine/core/result.h"
#include "modules/motion_blur/embedding/host_image.h"
#include "shaders/motion_blur/prepare_shared.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace shutter::motion_blur {

struct HostVectors {
    HostImage image;
    glm::vec2 pixelsPerUnit{1.0f};
    bool lackCamera = false; ///< ShutterBlurInputs::vectorsLackCamera
    bool haveJitter = false;
};

struct HostDepth {
    HostImage image;
    bool isLinear = false;
    float metresPerUnit = 1.0f;
    float skyValue = 0.0f;
};

/// ShutterBlurCameras.
struct HostCameras {
    bool areGiven = false;
    glm::dmat4 viewFromWorld{1.0};
    glm::dmat4 clipFromView{1.0};
    glm::dmat4 viewFromWorldBefore{1.0};
    glm::dmat4 clipFromViewBefore{1.0};
    bool aheadIsPlusZ = false;
    glm::dvec2 jitterPx{0.0};
    glm::dvec2 jitterPxBefore{0.0};
    double cutDistance = 0.0; ///< ShutterBlurInputs::cutDistance
    double cutDegrees = 0.0;
};

/// How much of the motion is blurred.
struct HostScales {
    float exposureShare = 0.5f;
    float camera = 1.0f; ///< ShutterBlurInputs::cameraScale
    float object = 1.0f;
    float displayedPerRendered = 1.0f;
    HostImage perPixel; ///< ShutterBlurInputs::blurScale
    bool isCut = false;
};

/// ShutterBlurViewModel.
struct HostViewModel {
    float depthMin = 0.0f;
    float depthMax = 0.0f;
    glm::dmat4 clipFromView{0.0}; ///< all 0: the camera's
    std::span<const glm::dmat4> viewFromObject;

    [[nodiscard]] bool isGiven() const { return depthMin != 0.0f || depthMax != 0.0f; }

    [[nodiscard]] bool hasProjection() const { return clipFromView != glm::dmat4(0.0); }
};

/// The host's inputs of the conversion pass.
struct HostConvention {
    HostVectors vectors;
    HostDepth depth;
    HostCameras cameras;
    HostScales scales;
    HostViewModel viewModel;
};

extern const HostImageRule kVectorsRule;   ///< HostVectors::image
extern const HostImageRule kDepthRule;     ///< HostDepth::image
extern const HostImageRule kBlurScaleRule; ///< HostScales::perPixel

/// Error: one sentence that names the wrong field. Cameras that are not given are not checked.
[[nodiscard]] core::Status checkHostCameras(const HostCameras& cameras, VkExtent2D picture);
[[nodiscard]] core::Status checkScales(const HostScales& scales, VkExtent2D picture);
/// The same for all of a convention.
[[nodiscard]] core::Status checkConvention(const HostConvention& convention, VkExtent2D picture);

/// Whether the camera went or turned so far since the frame before that it is a cut. Matrices that
/// are not given, or not finite, are none.
[[nodiscard]] bool isJump(const HostCameras& cameras);

/// A convention that describes HostInputs::motionDepth, with the cameras and the cut of `given`.
[[nodiscard]] HostConvention
describeMotionDepth(const HostImage& motionDepth, const HostConvention& given);

/// Where a picture's places are in an image.
[[nodiscard]] shader::PrepareArea makeArea(const HostImage& image, VkExtent2D picture);

/// The convention as shaders read it. Pure.
/// \param convention as checkConvention() accepts it
[[nodiscard]] shader::PrepareTable
makePrepareTable(const HostConvention& convention, VkExtent2D picture);

} // namespace shutter::motion_blur
