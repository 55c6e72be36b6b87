// SPDX-License-Identifier: MIT
// Checks of a host's inputs, from totals and samples of its images. Needs no device: checker.h
// reads them back.
#pragma once

#include "modules/motion_blur/embedding/host_convention.h"
#include "modules/motion_blur/embedding/host_motion.h"
#include "modules/motion_blur/embedding/host_ways.h"
#include "shaders/motion_blur/check_shared.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace shutter::motion_blur {

struct HostInputs;
struct MotionBlurSettings;

/// The declarations of a host for a recording that can be compared with the images.
struct CheckFacts {
    struct Mover {
        uint32_t row = 0;
        /// Its origin is well within the picture at the raster instant, at `place` (pixels) and
        /// `metres`; deforming ones: false.
        bool isInView = false;
        glm::dvec2 place{0.0};
        double metres = 0.0;
        /// Of `matrices`, the first of one for each key; kNone: it has none.
        size_t firstMatrix = kNone;
    };

    static constexpr size_t kNone = SIZE_MAX;

    VkExtent2D picture{0, 0};
    HostConvention convention; ///< of motionDepth: metres, pixels over the exposure
    bool isNative = false;     ///< motionDepth was given, whose vectors are over the exposure
    bool hasVectors = true;    ///< false: nothing moves but the camera
    double rasterTime = 1.0;
    /// The two below count: isNative, and keys are known from shutter open to close.
    bool hasExposureCameras = false;
    HostCameras open;  ///< now: the raster instant; before: the shutter's opening
    HostCameras close; ///< before: its closing
    bool hasIds = false;
    bool hasDeformed = false; ///< CheckSample::deformed counts
    bool readsMotion = false; ///< the method reads HostMotion; otherwise its fields are empty
    uint32_t noEntity = 0xFFFFFFFF;
    uint32_t rowCount = 0;           ///< 0: unknown
    std::vector<HostCameraKey> keys; ///< ahead is -Z
    size_t rasterKey = 0;            ///< of `keys`
    std::vector<Mover> movers;
    std::vector<glm::dmat4> matrices; ///< world from object
    std::vector<uint64_t> rowIds;     ///< by row; empty: the row is the id
    std::vector<uint32_t> viewModelRows;
    bool wantsHistory = false; ///< MotionBlurSettings::history
    bool followsLast = false;
    int64_t frameNumber = 0;
    uint32_t view = 0;
    uint32_t number = 0; ///< of the view's recordings
    /// Hypothesis: raw depth is reversed.
    bool flipsDepth = false;
};

/// Sentences of the same kind are not repeated in every frame.
enum class CheckKind : uint8_t {
    LeftOut, ///< no mistake: names the checks that cannot be made
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
    Movers,
    Deformed,
    BlendedNan,
    BlendedNegative,
    BlendedOpacity,
    CameraJump,
    Keys,
    HistoryUnused,
    ViewModel,
    Unexplained,
    Count
};

struct Finding {
    CheckKind kind = CheckKind::LeftOut;
    std::string sentence; ///< without a full stop
};

/// Fills in all but `number`. The facts own copies of everything.
void describeFacts(const HostInputs& inputs, const MotionBlurSettings& settings, CheckFacts& facts);

/// Units of depth that hosts take for others.
inline constexpr std::array kUnitFactors{0.001f, 0.01f, 0.1f, 0.3048f, 10.0f, 100.0f, 1000.0f};

struct CheckedFrame {
    CheckFacts facts;
    shader::CheckTotals totals{};
    /// Vectors minus the camera's part, where that is the same nearly everywhere; for the frame
    /// after.
    glm::dvec2 offsetPx{0.0};
    bool hasOffset = false;
    /// Share of the way between the frames that the camera keys go in the exposure; below 0:
    /// unknown.
    double keyShare = -1.0;
    bool areKeysReversed = false;
    uint32_t unusedHistory = 0; ///< frames up to this one that followed another without declaring
                                ///< it
};

/// \param last the frame before of the same view, or null
[[nodiscard]] std::vector<Finding> checkFrame(CheckedFrame& now, const CheckedFrame* last);

// The parts of checkFrame().

/// Checks ranges, NaN and infinity, and depth values on their own.
void checkTotals(const CheckedFrame& now, std::vector<Finding>& findings);
/// Whether nearly all depth lies at the near plane, as it does where its direction is wrong.
[[nodiscard]] bool checkDepthDirection(const CheckedFrame& now, std::vector<Finding>& findings);
/// Compares vectors with the motion that the cameras imply.
void checkVectors(CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings);
void checkIds(const CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings);
void checkCameras(
    const CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings
);
/// Without vectors: compares the last frame's depth with this frame's surfaces reprojected by the
/// cameras.
void checkReprojection(
    const CheckedFrame& now, const CheckedFrame& last, std::vector<Finding>& findings
);
/// Camera keys against the cameras of both frames and the exposure's share.
void checkKeys(CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings);
/// Parts of depth that follow the camera, against the last frame.
void checkViewModel(
    const CheckedFrame& now, const CheckedFrame& last, std::vector<Finding>& findings
);
/// Movers' matrices against the vectors of their pixels, or without vectors against the last frame.
void checkMovers(const CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings);
/// Where deforming movers' pixels go against their vectors.
void checkDeformed(const CheckedFrame& now, std::vector<Finding>& findings);
/// Reports differences that no check above explains.
void checkUnexplained(const CheckedFrame& now, std::vector<Finding>& findings);
void checkHistory(CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings);

/// A sample as the motion blur would take it.
struct CheckPoint {
    glm::dvec2 place{0.0};  ///< pixels of the picture
    glm::dvec2 motion{0.0}; ///< pixels, by `pixelsPerUnit` and without declared jitter
    glm::dvec2 camera{0.0}; ///< implied by the cameras for static surfaces
    float stored = 0.0f;    ///< depth, as it is in the image
    float metres = 0.0f;
    /// Depth of static surfaces from the previous frame's camera; 0 or less: behind it.
    float metresBefore = 0.0f;
    bool isSky = false;
    uint32_t id = 0;
    glm::vec4 deformed{0.0f}; ///< as in the image
};

/// "0.03 %", "4 %", "100 %"
[[nodiscard]] std::string describeShare(double share);
/// "12 pixels (0.3 %)"
/// \param index of CheckTotals::counts
[[nodiscard]] std::string describeCount(const CheckedFrame& frame, uint32_t index);

/// Whether cameras imply anything for the frame.
[[nodiscard]] bool hasCameras(const CheckFacts& facts);

/// Returns the samples with finite vectors and depth.
/// \param declared the host's declarations, or a hypothesis
[[nodiscard]] std::vector<CheckPoint>
makePoints(const CheckedFrame& frame, const CheckFacts& declared);

/// Whether any finding is of one of the kinds.
[[nodiscard]] bool
hasFound(const std::vector<Finding>& findings, std::initializer_list<CheckKind> kinds);

/// By rows below rowCount: they are in CheckFacts::movers.
[[nodiscard]] std::vector<bool> markMovers(const CheckFacts& facts);

/// The camera of HostConvention::cameras now, or before; nothing: none is given.
[[nodiscard]] std::optional<HostCamera> findCamera(const CheckFacts& facts, bool isBefore);

/// By how many pixels a camera sees what another one sees at a distance elsewhere, in the mean over
/// the picture; infinity: behind it.
[[nodiscard]] double
measureApart(const HostCamera& from, const HostCamera& to, VkExtent2D picture, double metres);

/// Median depth of the drawn surfaces, metres.
[[nodiscard]] double findTypicalMetres(const std::vector<CheckPoint>& points);

} // namespace shutter::motion_blur
