// SPDX-License-Identifier: MIT
// The shutter: when a frame's light is taken, and its settings.
#pragma once

#include "engine/core/result.h"
#include "engine/core/setting_row.h"
#include "engine/ecs/entity.h"
#include "engine/scene/components.h"
#include "shaders/common/shutter_response_shared.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::scene {

/// Duration of a single frame that belongs to no sequence.
inline constexpr double kStillFrameSeconds = 1.0 / 24.0;

/// Shares of motion that remain where CameraShutter::maxBlurPercent caps it.
///
/// Motion beyond the cap is scaled as a whole, as if its exposure were shorter: everything static
/// in the world together with the camera, and each mover individually. Clamping each pixel's motion
/// vector instead would give motion that no rigid body has, which neither rays nor ground truth
/// could reproduce.
struct MotionCap {
    /// Share of its motion, [0, 1], for the camera and for everything without an individual share.
    double camera = 1.0;
    /// Movers' shares of their motion on the screen, [0, 1], by rising entity index.
    std::vector<std::pair<ecs::Entity, double>> movers;

    /// Null: it has no individual share.
    [[nodiscard]] const double* findMover(ecs::Entity entity) const {
        const auto at = std::lower_bound(
            movers.begin(),
            movers.end(),
            entity.index,
            [](const auto& mover, uint32_t index) { return mover.first.index < index; }
        );
        return at != movers.end() && at->first == entity ? &at->second : nullptr;
    }

    [[nodiscard]] double of(ecs::Entity entity) const {
        const double* share = findMover(entity);
        return share ? *share : camera;
    }
};

struct ExposureTimes {
    double open = 0.0;   ///< seconds
    double raster = 0.0; ///< seconds: when the raster image is taken
    double close = 0.0;  ///< seconds
};

/// The exposure around a frame's own time, and the shutter it is one of.
struct ExposureInterval {
    double open = 0.0;   ///< seconds
    double raster = 0.0; ///< seconds: when the raster image is taken
    double close = 0.0;  ///< seconds

    [[nodiscard]] double at(double s) const { return std::lerp(open, close, s); } ///< s in [0, 1]

    /// s of the raster instant: 0 start, 0.5 centre, 1 end.
    double rasterTime = 1.0;
    double frameSeconds = 0.0; ///< since the previous frame, 0 or more
    CameraShutter shutter{};
    MotionCap cap{}; ///< of this frame; render::MotionMeasures::measureCap() finds it
    /// Times of the whole exposure, if this is a part of one (takePart()); nothing: this is all of
    /// it.
    std::optional<ExposureTimes> whole{};

    /// Returns the whole exposure, which events, scales and the frame's number refer to.
    [[nodiscard]] ExposureTimes frame() const {
        return whole.value_or(ExposureTimes{open, raster, close});
    }
};

/// Length of the exposure, 0 or more and finite. A frame of duration 0 is paused: nothing moves in
/// any mode, and the exposure is 0. Negative or non-finite durations count as 0, except that Capped
/// accepts a frame of any length.
[[nodiscard]] double computeExposureSeconds(const CameraShutter& shutter, double frameSeconds);

/// \param raster the frame's own time, seconds
/// \param frameSeconds the frame's duration
[[nodiscard]] ExposureInterval computeExposure(
    const CameraShutter& shutter, double raster, double frameSeconds = kStillFrameSeconds
);

/// The exposure of an earlier frame of the same shutter and duration.
/// \param frames how many frames ago, 1 or more
[[nodiscard]] ExposureInterval
computeExposureBefore(const ExposureInterval& exposure, uint32_t frames);

/// Share of a frame's light below which a part of the exposure is left out.
inline constexpr double kMinLight = 1.0 / 512.0;

/// The part of the exposure from `open` to `close` seconds, as a separate exposure: its raster
/// instant is the one nearest to the frame's, and its share of the light follows the shutter's
/// response.
/// \param open, close within the exposure, open < close; the whole of it is a part, too
[[nodiscard]] ExposureInterval
takePart(const ExposureInterval& exposure, double open, double close);

/// By its time, so that a frame's number does not depend on the frames drawn before. Where frames
/// differ in length, their numbers need not follow one another; where they have none, all are 0.
[[nodiscard]] int64_t numberFrame(const ExposureInterval& exposure);

/// One sentence that names the field which is out of its range.
[[nodiscard]] core::Status validateResponse(const ShutterResponse& response);

/// The response as methods sample it; nothing for a constant one such as a box. It must be valid
/// (CHECKed).
[[nodiscard]] std::optional<shader::ResponseTable>
computeResponseTable(const ShutterResponse& response);
/// That of the exposure's shutter, over the exposure or the part of it.
[[nodiscard]] std::optional<shader::ResponseTable>
computeLightTable(const ExposureInterval& exposure);

/// Shutter time before which the share u of the light is taken; a box response returns u.
[[nodiscard]] double invertResponse(const ShutterResponse& response, double u);
/// The same of the exposure, or of the part of it.
[[nodiscard]] double invertLight(const ExposureInterval& exposure, double u);

/// Shutter times at the middles of `count` parts of the exposure, or of the part of it, that take
/// equal light; rising.
[[nodiscard]] std::vector<double> middlesOfLight(const ExposureInterval& exposure, uint32_t count);

/// Share of the exposure's light that is taken before `seconds`, [0, 1].
[[nodiscard]] double measureLightBefore(const ExposureInterval& exposure, double seconds);

// The settings as rows (engine/core/setting_row.h): the command line, settings files, panels and
// flythroughs read their names, ranges and meanings here.

/// One row per field of CameraShutter, except for `response` and `cuts`, which have their own.
[[nodiscard]] core::SettingRows<CameraShutter> listShutterRows();
/// One row per field of ShutterResponse, except for `samples`, which is a list.
[[nodiscard]] core::SettingRows<ShutterResponse> listResponseRows();
[[nodiscard]] core::SettingRows<CutDetection> listCutRows();

/// Error: one sentence that names the field which is out of its range.
/// \param prefix before the field's name, e.g. "shutter."
[[nodiscard]] core::Status validate(const CameraShutter& shutter, std::string_view prefix = "");

/// All fields and their values in one line; equal only if all values are.
[[nodiscard]] std::string describe(const CameraShutter& shutter);

} // namespace shutter::scene
