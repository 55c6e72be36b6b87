// SPDX-License-Identifier: MIT
#include "engine/scene/shutter.h"

#include "engine/core/check.h"
#include "engine/math/response.h"
#include "shaders/common/shutter_response.glsl"

#include <algorithm>
#include <cmath>
#include <vector>

namespace shutter::scene {

namespace {

/// Shortest flank and top of a trapezoid: shorter ones have no length in single precision.
constexpr double kShortestShare = 1.0e-6;

/// Corners of the piecewise linear response.
std::vector<math::ResponsePoint> listPoints(const ShutterResponse& response) {
    switch (response.shape) {
    case ResponseShape::Box:
        break;
    case ResponseShape::Triangle:
        return {{0.0, 0.0}, {0.5, 1.0}, {1.0, 0.0}};
    case ResponseShape::Trapezoid: {
        const bool opens = response.openShare > kShortestShare;
        const bool closes = response.closeShare > kShortestShare;
        const double from = opens ? response.openShare : 0.0;
        const double to = closes ? 1.0 - response.closeShare : 1.0;
        std::vector<math::ResponsePoint> points;
        if (opens)
            points.push_back({0.0, 0.0});
        points.push_back({from, 1.0});
        if (to > from + kShortestShare)
            points.push_back({to, 1.0});
        if (closes)
            points.push_back({1.0, 0.0});
        else
            points.back().s = 1.0;
        return points;
    }
    case ResponseShape::Sampled: {
        const double intervals = double(response.samples.size() - 1);
        std::vector<math::ResponsePoint> points;
        for (const double sample : response.samples)
            points.push_back({double(points.size()) / intervals, sample});
        return points;
    }
    }
    return {{0.0, 1.0}, {1.0, 1.0}};
}

double sensitivityAt(const std::vector<math::ResponsePoint>& points, double s) {
    size_t next = 1;
    while (next + 1 < points.size() && points[next].s < s)
        ++next;
    const math::ResponsePoint& from = points[next - 1];
    const math::ResponsePoint& to = points[next];
    const double share = std::clamp((s - from.s) / (to.s - from.s), 0.0, 1.0);
    return std::lerp(from.sensitivity, to.sensitivity, share);
}

/// Between the shutter times `from` and `to`, as shutter times of that part.
std::vector<math::ResponsePoint>
cutPoints(const std::vector<math::ResponsePoint>& points, double from, double to) {
    std::vector<math::ResponsePoint> part{{0.0, sensitivityAt(points, from)}};
    for (const math::ResponsePoint& point : points) {
        const double s = (point.s - from) / (to - from);
        if (s > kShortestShare && s < 1.0 - kShortestShare)
            part.push_back({s, point.sensitivity});
    }
    part.push_back({1.0, sensitivityAt(points, to)});
    return part;
}

/// Returns the response of the exposure's shutter, or of the part that the exposure is.
std::vector<math::ResponsePoint> listPoints(const ExposureInterval& exposure) {
    std::vector<math::ResponsePoint> points = listPoints(exposure.shutter.response);
    if (!exposure.whole)
        return points;
    const auto& [open, raster, close] = *exposure.whole;
    (void)raster;
    const double length = close - open;
    return cutPoints(points, (exposure.open - open) / length, (exposure.close - open) / length);
}

/// Written so that NaN is outside.
bool isShare(double value) {
    return value >= 0.0 && value <= 1.0;
}

core::Status validateSamples(const std::vector<double>& samples) {
    const auto most = size_t{shader::kMaxResponseKnots};
    if (samples.size() < 2 || samples.size() > most)
        return core::makeError("samples holds {}, it needs 2 to {}", samples.size(), most);
    for (const double sample : samples)
        if (!(sample >= 0.0 && std::isfinite(sample)))
            return core::makeError("samples holds {}, each must be 0 or more", sample);
    if (std::all_of(samples.begin(), samples.end(), [](double sample) { return sample == 0.0; }))
        return core::makeError("samples are all 0: no light is taken");
    return {};
}

double invertTable(const std::optional<shader::ResponseTable>& table, double u) {
    return table ? double(shader::inverseResponse({*table}, static_cast<float>(u))) : u;
}

double orZero(double value) {
    return value > 0.0 && std::isfinite(value) ? value : 0.0;
}

} // namespace

double computeExposureSeconds(const CameraShutter& shutter, double frameSeconds) {
    if (!(frameSeconds > 0.0))
        return 0.0;
    const double share = shutter.angleDegrees / 360.0;
    switch (shutter.mode) {
    case ShutterMode::Physical:
        return orZero(shutter.exposureSeconds);
    case ShutterMode::Angle:
        return orZero(share * frameSeconds);
    case ShutterMode::Capped:
        return orZero(share * std::min(frameSeconds, orZero(1.0 / shutter.referenceFps)));
    }
    SHUTTER_CHECK(false, "there is no shutter mode {}", static_cast<int>(shutter.mode));
    return 0.0;
}

ExposureInterval computeExposure(const CameraShutter& shutter, double raster, double frameSeconds) {
    const double exposure = computeExposureSeconds(shutter, frameSeconds);
    ExposureInterval interval;
    switch (shutter.phase) {
    case ShutterPhase::Start:
        interval.rasterTime = 0.0;
        break;
    case ShutterPhase::Centre:
        interval.rasterTime = 0.5;
        break;
    case ShutterPhase::End:
        interval.rasterTime = 1.0;
        break;
    }
    interval.open = raster - exposure * interval.rasterTime;
    interval.raster = raster;
    interval.close = raster + exposure * (1.0 - interval.rasterTime);
    interval.frameSeconds = orZero(frameSeconds);
    interval.shutter = shutter;
    return interval;
}

ExposureInterval computeExposureBefore(const ExposureInterval& exposure, uint32_t frames) {
    return computeExposure(
        exposure.shutter,
        exposure.frame().raster - frames * exposure.frameSeconds,
        exposure.frameSeconds
    );
}

ExposureInterval takePart(const ExposureInterval& exposure, double open, double close) {
    SHUTTER_CHECK(
        exposure.open <= open && open < close && close <= exposure.close,
        "the part from {} to {} s of the exposure from {} to {} s",
        open,
        close,
        exposure.open,
        exposure.close
    );
    ExposureInterval part = exposure;
    part.whole = exposure.frame();
    if (open == exposure.open && close == exposure.close)
        return part;
    part.open = open;
    part.close = close;
    part.raster = std::clamp(part.whole->raster, open, close);
    part.rasterTime = (part.raster - open) / (close - open);
    return part;
}

int64_t numberFrame(const ExposureInterval& exposure) {
    constexpr double kMaxExact = 9.0e15; // whole numbers are exact below
    const double number = exposure.frame().raster / exposure.frameSeconds;
    return std::abs(number) < kMaxExact ? std::llround(number) : 0; // nor NaN
}

core::Status validateResponse(const ShutterResponse& response) {
    if (response.shape == ResponseShape::Sampled)
        return validateSamples(response.samples);
    if (response.shape != ResponseShape::Trapezoid)
        return {};
    if (!isShare(response.openShare) || !isShare(response.closeShare))
        return core::makeError(
            "the trapezoid's shares are {} and {}, each must lie in [0, 1]",
            response.openShare,
            response.closeShare
        );
    if (response.openShare + response.closeShare > 1.0)
        return core::makeError(
            "the trapezoid's shares {} and {} are more than the exposure",
            response.openShare,
            response.closeShare
        );
    return {};
}

std::optional<shader::ResponseTable> computeResponseTable(const ShutterResponse& response) {
    const core::Status valid = validateResponse(response);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
    return math::makeResponseTable(listPoints(response));
}

std::optional<shader::ResponseTable> computeLightTable(const ExposureInterval& exposure) {
    const core::Status valid = validateResponse(exposure.shutter.response);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
    return math::makeResponseTable(listPoints(exposure));
}

double invertResponse(const ShutterResponse& response, double u) {
    return invertTable(computeResponseTable(response), u);
}

double invertLight(const ExposureInterval& exposure, double u) {
    return invertTable(computeLightTable(exposure), u);
}

std::vector<double> middlesOfLight(const ExposureInterval& exposure, uint32_t count) {
    std::vector<double> times;
    for (uint32_t i = 0; i < count; ++i)
        times.push_back(invertLight(exposure, (i + 0.5) / count));
    return times;
}

double measureLightBefore(const ExposureInterval& exposure, double seconds) {
    const double length = exposure.close - exposure.open;
    const double s = std::clamp((seconds - exposure.open) / length, 0.0, 1.0);
    const auto table = computeLightTable(exposure);
    return table ? double(shader::cumulativeResponse({*table}, static_cast<float>(s))) : s;
}

} // namespace shutter::scene
