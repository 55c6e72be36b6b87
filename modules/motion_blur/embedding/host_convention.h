// SPDX-License-Identifier: MIT
// Motion vectors and depth as hosts have them, for a host that has no image of both in the motion
// blur's own convention (HostInputs::motionDepth). A pass makes that image of them.
#pragma once

#include "engine/core/result.h"
#include "modules/motion_blur/embedding/host_image.h"
#include "shaders/motion_blur/prepare_shared.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace shutter::motion_blur {

/// The host's motion vectors, at any resolution: x and y of the image's first two channels. A host
/// without vectors leaves the image null: they are then the camera's, which `cameras` gives, and
/// nothing else moves but movers with matrices (HostMover), for the methods that read these.
struct HostVectors {
    HostImage image; ///< RG16F, RG32F, RGBA16F or RGBA32F; sampled; or null
    /// What the vectors are multiplied by to be pixels of the picture, right and down, from where a
    /// point was in the frame before to where it is now. For a picture of w x h pixels:
    ///
    /// | vectors lead from ... in ... | pixelsPerUnit |
    /// |---|---|
    /// | before to now, pixels of the picture | (1, 1) |
    /// | now to before, texture coordinates, y down | (-w, -h) |
    /// | now to before, normalised device coordinates, y up | (-w / 2, h / 2) |
    ///
    /// Finite and not 0.
    glm::vec2 pixelsPerUnit{1.0f};
    /// They hold what objects move by themselves, and the camera's part comes from `cameras`.
    bool lackCamera = false;
    /// The pictures' jitter is left in them: `HostCameras::jitterPx` is taken out.
    bool haveJitter = false;
};

/// The host's depth buffer, at any resolution: the image's first channel.
struct HostDepth {
    HostImage image; ///< D32F, D16, D24S8, D32FS8, X8D24, R32F, R16F, RG32F or RGBA32F; sampled
    /// True: along the view direction, in units of metresPerUnit. False: as the hardware stores it,
    /// and `cameras` says what it means, whichever its range and direction.
    bool isLinear = false;
    float metresPerUnit = 1.0f; ///< where it is linear; finite, above 0
    /// Where nothing is drawn. Linear: this and all beyond it. Else: what the buffer is cleared to,
    /// 0 where far is 0. NaN: nothing tells the sky.
    float skyValue = 0.0f;
};

/// The camera of this frame and of the frame before. What counts as jitter: by how much a picture's
/// samples lie right and down of their pixels' centres, [-0.5, 0.5] as a rule. Matrices are column
/// by column and take columns, and have no jitter in them.
struct HostCameras {
    /// The two below count: they are needed for raw depth, without vectors or with vectors that
    /// lack the camera's part, and for scales of HostScales that are not the same.
    bool areGiven = false;
    glm::dmat4 viewFromWorld{1.0}; ///< ahead is -Z, or +Z with HostCameras::aheadIsPlusZ
    /// As HostCameraKey::clipFromView: perspective or orthographic, y = -1 is the picture's top.
    glm::dmat4 clipFromView{1.0};
    glm::dmat4 viewFromWorldBefore{1.0};
    glm::dmat4 clipFromViewBefore{1.0};
    bool aheadIsPlusZ = false;
    glm::dvec2 jitterPx{0.0};       ///< pixels of the picture
    glm::dvec2 jitterPxBefore{0.0}; ///< of the frame before
};

/// How much of the motion is blurred.
struct HostScales {
    /// Exposure over the time between this frame and the one before, which the vectors are over:
    /// 0.5 is a shutter angle of 180 degrees. [0, 16].
    float exposureShare = 0.5f;
    float camera = 1.0f; ///< of the camera's own motion, [0, 16]
    float object = 1.0f; ///< of what moves by itself, [0, 16]
    /// Frames that are shown for each one drawn, where others are generated between: each is shown
    /// for that much less time, and blurred as much less. [1, 16].
    float displayedPerRendered = 1.0f;
    /// A share of the motion for each pixel, such as 0 where a weapon or a display is; null: 1.
    HostImage perPixel; ///< R8, R16F or R32F, any resolution; sampled
    /// The frame before was of another place, or there is none: nothing is blurred, as vectors lead
    /// nowhere, and the cameras before do not count, nor does HostMotion::followsLast, nor any of
    /// its keys but the raster's.
    bool isCut = false;
};

/// What a preparation makes the motion blur's inputs of.
struct HostConvention {
    HostVectors vectors;
    HostDepth depth;
    HostCameras cameras;
    HostScales scales;
};

extern const HostImageRule kVectorsRule;   ///< HostVectors::image
extern const HostImageRule kDepthRule;     ///< HostDepth::image
extern const HostImageRule kBlurScaleRule; ///< HostScales::perPixel

/// One sentence that names the field which is wrong. Cameras that are not given are not looked at.
[[nodiscard]] core::Status checkHostCameras(const HostCameras& cameras, VkExtent2D picture);
[[nodiscard]] core::Status checkScales(const HostScales& scales, VkExtent2D picture);
/// The same for all of a convention.
[[nodiscard]] core::Status checkConvention(const HostConvention& convention, VkExtent2D picture);

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
