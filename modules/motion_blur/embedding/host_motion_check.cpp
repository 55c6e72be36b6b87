// SPDX-License-Identifier: MIT
// Validates a host's motion: one sentence per fault.
#include "engine/core/check.h"
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/host_instants.h"
#include "modules/motion_blur/embedding/host_ways.h"
#include "shaders/common/shutter_response_shared.h"
#include "shaders/motion_blur/resolved_shared.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::motion_blur {

namespace {

using core::makeError;
using math::dmat4;

constexpr size_t kMaxKeys = 64;
constexpr double kMaxLensRadius = 1000.0;
// As scene::CameraLens has them.
constexpr double kMinFocus = 1.0e-4;
constexpr double kMaxFocus = 1.0e9;
constexpr uint32_t kMinBlades = 3;
constexpr uint32_t kMaxBlades = 16;
constexpr double kMaxSqueeze = 4.0;
constexpr uint32_t kMaxRows = shader::kSkyKey; // exact as floats, and not the sky

template <class T> core::Status checkSpan(std::string_view name, std::span<const T> values) {
    if (!values.empty() && !values.data())
        return makeError("motion blur: {} is null, its size is {}", name, values.size());
    return {};
}

/// Null: the matrix is as it must be.
const char* findFault(const dmat4& matrix) {
    if (!math::isFinite(matrix))
        return "not finite";
    return isAffine(matrix) ? nullptr : "not affine";
}

core::Status checkView(const std::string& name, const dmat4& viewFromWorld) {
    if (const char* fault = findFault(viewFromWorld))
        return makeError("motion blur: {} is {}", name, fault);
    if (!math::isFinite(glm::inverse(viewFromWorld)))
        return makeError("motion blur: {} is singular", name);
    return {};
}

core::Status checkKeyProjection(
    const std::string& name,
    const HostCameraKey& key,
    const HostMotion& motion,
    const math::uvec2& sizePx
) {
    if (!math::isFinite(key.clipFromView))
        return makeError("motion blur: {} is not finite", name);
    const auto camera = normalize(key, motion.aheadIsPlusZ);
    if (!camera && normalize(key, !motion.aheadIsPlusZ))
        return makeError(
            "motion blur: {} faces {}Z, cameras.aheadIsPlusZ means {}Z",
            name,
            motion.aheadIsPlusZ ? "-" : "+",
            motion.aheadIsPlusZ ? "+" : "-"
        );
    if (!camera)
        return makeError("motion blur: {} is neither perspective nor orthographic", name);
    if (!math::isFinite(glm::inverse(camera->pictureFromWorld(sizePx))))
        return makeError("motion blur: {} is singular", name);
    const auto first = normalize(motion.keys.front(), motion.aheadIsPlusZ);
    if (first && first->isPerspective != camera->isPerspective)
        return makeError(
            "motion blur: {} is {}, keys[0].clipFromView is not",
            name,
            camera->isPerspective ? "perspective" : "orthographic"
        );
    return {};
}

core::Status checkKeys(const HostMotion& motion, const HostMotionFrame& frame) {
    SHUTTER_TRY(checkSpan("keys", motion.keys));
    if (motion.keys.empty() || motion.keys.size() > kMaxKeys)
        return makeError(
            "motion blur: keys holds {}, it needs 1 to {}", motion.keys.size(), kMaxKeys
        );
    double before = -HUGE_VAL;
    bool hasRaster = false;
    for (size_t i = 0; i < motion.keys.size(); ++i) {
        const HostCameraKey& key = motion.keys[i];
        const std::string name = fmt::format("keys[{}]", i);
        if (!(std::abs(key.time) <= kMaxKeyTime))
            return makeError(
                "motion blur: {}.time is {}, it must be {} to {}",
                name,
                key.time,
                -kMaxKeyTime,
                kMaxKeyTime
            );
        if (!(key.time > before))
            return makeError(
                "motion blur: {}.time is {}, not after the key's before", name, key.time
            );
        before = key.time;
        hasRaster = hasRaster || isRasterKey(key, frame.rasterTime);
        SHUTTER_TRY(checkView(name + ".viewFromWorld", key.viewFromWorld));
        SHUTTER_TRY(checkKeyProjection(name + ".clipFromView", key, motion, frame.sizePx));
    }
    if (!hasRaster)
        return makeError(
            "motion blur: keys has no key at rasterTime, which is {}", frame.rasterTime
        );
    return {};
}

/// \param index of the mover
core::Status checkMatrices(const HostMotion& motion, size_t index) {
    const std::span<const dmat4> matrices = motion.movers[index].worldFromObject;
    const auto describe = [&] { return fmt::format("movers[{}].worldFromObject", index); };
    if (matrices.empty())
        return {};
    if (!matrices.data())
        return checkSpan(describe(), matrices);
    if (matrices.size() != motion.keys.size())
        return makeError(
            "motion blur: {} holds {}, keys {}", describe(), matrices.size(), motion.keys.size()
        );
    for (size_t k = 0; k < matrices.size(); ++k)
        if (const char* fault = findFault(matrices[k]))
            return makeError("motion blur: {}[{}] is {}", describe(), k, fault);
    return {};
}

core::Status checkMovers(const HostMotion& motion) {
    SHUTTER_TRY(checkSpan("movers", motion.movers));
    std::vector<bool> isListed(motion.rowCount);
    for (size_t i = 0; i < motion.movers.size(); ++i) {
        const HostMover& mover = motion.movers[i];
        if (mover.row >= motion.rowCount)
            return makeError(
                "motion blur: movers[{}].row is {}, rowCount {}", i, mover.row, motion.rowCount
            );
        if (isListed[mover.row])
            return makeError(
                "motion blur: movers[{}].row is {}, as another mover's is", i, mover.row
            );
        isListed[mover.row] = true;
        SHUTTER_TRY(checkMatrices(motion, i));
    }
    return {};
}

core::Status checkViewFromObject(const HostMotion& motion) {
    const std::span<const dmat4> matrices = motion.viewFromObject;
    SHUTTER_TRY(checkSpan("viewModel.viewFromObject", matrices));
    if (!matrices.empty() && matrices.size() != motion.keys.size())
        return makeError(
            "motion blur: viewModel.viewFromObject holds {}, keys {}",
            matrices.size(),
            motion.keys.size()
        );
    for (size_t k = 0; k < matrices.size(); ++k)
        SHUTTER_TRY(checkView(fmt::format("viewModel.viewFromObject[{}]", k), matrices[k]));
    return {};
}

core::Status checkViewModelRows(const HostMotion& motion) {
    SHUTTER_TRY(checkSpan("viewModelRows", motion.viewModelRows));
    std::vector<bool> isMover(motion.rowCount);
    for (const HostMover& mover : motion.movers)
        isMover[mover.row] = true;
    for (size_t i = 0; i < motion.viewModelRows.size(); ++i) {
        const uint32_t row = motion.viewModelRows[i];
        if (row >= motion.rowCount)
            return makeError(
                "motion blur: viewModelRows[{}] is {}, rowCount {}", i, row, motion.rowCount
            );
        if (isMover[row])
            return makeError("motion blur: viewModelRows[{}] is {}, as a mover's row is", i, row);
    }
    return {};
}

core::Status checkLensShape(const HostLens& lens) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    if (!(lens.radius > 0.0 && lens.radius <= kMaxLensRadius))
        return makeError(
            "motion blur: lens.radius is {}, it must be 0 to {}", lens.radius, kMaxLensRadius
        );
    if (lens.blades != 0 && (lens.blades < kMinBlades || lens.blades > kMaxBlades))
        return makeError(
            "motion blur: lens.blades is {}, it must be 0 or {} to {}",
            lens.blades,
            kMinBlades,
            kMaxBlades
        );
    if (!(std::abs(lens.bladeRotation) <= kTurn))
        return makeError(
            "motion blur: lens.bladeRotation is {}, it must be -2 pi to 2 pi", lens.bladeRotation
        );
    if (!(lens.roundness >= 0.0 && lens.roundness <= 1.0))
        return makeError("motion blur: lens.roundness is {}, it must be 0 to 1", lens.roundness);
    if (!(lens.squeeze > 0.0 && lens.squeeze <= kMaxSqueeze))
        return makeError(
            "motion blur: lens.squeeze is {}, it must be above 0, to {}", lens.squeeze, kMaxSqueeze
        );
    return {};
}

core::Status checkFocus(const std::string& name, double distance) {
    if (distance >= kMinFocus && distance <= kMaxFocus)
        return {};
    return makeError(
        "motion blur: {} is {}, it must be {} to {}", name, distance, kMinFocus, kMaxFocus
    );
}

core::Status checkLens(const HostMotion& motion) {
    const HostLens& lens = motion.lens;
    if (!lens.isOpen())
        return {};
    SHUTTER_TRY(checkLensShape(lens));
    SHUTTER_TRY(checkSpan("lens.focusDistances", lens.focusDistances));
    if (lens.focusDistances.empty())
        SHUTTER_TRY(checkFocus("lens.focusDistance", lens.focusDistance));
    else if (lens.focusDistances.size() != motion.keys.size())
        return makeError(
            "motion blur: lens.focusDistances holds {}, keys {}",
            lens.focusDistances.size(),
            motion.keys.size()
        );
    for (size_t i = 0; i < lens.focusDistances.size(); ++i)
        SHUTTER_TRY(checkFocus(fmt::format("lens.focusDistances[{}]", i), lens.focusDistances[i]));
    if (!normalize(motion.keys.front(), motion.aheadIsPlusZ)->isPerspective)
        return makeError(
            "motion blur: lens.radius is {}, but keys[0].clipFromView is orthographic; it must be "
            "0",
            lens.radius
        );
    return {};
}

core::Status checkResponse(const shader::ResponseTable& table) {
    if (table.knotCount < 2 || table.knotCount > shader::kMaxResponseKnots)
        return makeError(
            "motion blur: motion.response->knotCount is {}, it must be 2 to {}",
            table.knotCount,
            shader::kMaxResponseKnots
        );
    for (uint32_t i = 0; i < table.knotCount; ++i) {
        const shader::ResponseKnot& knot = table.knots[i];
        const bool isFirst = i == 0;
        const bool isLast = i + 1 == table.knotCount;
        const bool rises = isFirst ? knot.s == 0.0f && knot.cumulative == 0.0f
                                   : knot.s > table.knots[i - 1].s &&
                                         knot.cumulative >= table.knots[i - 1].cumulative;
        const bool ends = !isLast || knot.s == 1.0f;
        if (!(rises && ends && knot.s <= 1.0f && knot.cumulative <= 1.0f && knot.density >= 0.0f &&
              std::isfinite(knot.density)))
            return makeError(
                "motion blur: motion.response->knots[{}] is none: s and cumulative must rise from "
                "0 to 1, density be 0 or more",
                i
            );
    }
    for (uint32_t cell = 0; cell < shader::kResponseCells; ++cell) {
        const uint32_t knot = table.firstKnots[cell];
        const float light = static_cast<float>(cell) / static_cast<float>(shader::kResponseCells);
        if (knot + 2 > table.knotCount || table.knots[knot].cumulative > light)
            return makeError(
                "motion blur: motion.response->firstKnots[{}] is {}, more light than {} is taken "
                "before it: fillFirstKnots() sets them",
                cell,
                knot,
                light
            );
    }
    return {};
}

} // namespace

core::Status checkMotion(const HostMotion& motion, const HostMotionFrame& frame) {
    SHUTTER_TRY(checkKeys(motion, frame));
    if (motion.rowCount < 1 || motion.rowCount > kMaxRows)
        return makeError(
            "motion blur: rowCount is {}, it must be 1 to {}", motion.rowCount, kMaxRows
        );
    SHUTTER_TRY(checkMovers(motion));
    SHUTTER_TRY(checkViewModelRows(motion));
    SHUTTER_TRY(checkViewFromObject(motion));
    SHUTTER_TRY(checkLens(motion));
    SHUTTER_TRY(checkSpan("rowIds", motion.rowIds));
    if (!motion.rowIds.empty() && motion.rowIds.size() != motion.rowCount)
        return makeError(
            "motion blur: rowIds holds {}, rowCount is {}", motion.rowIds.size(), motion.rowCount
        );
    if (frame.hasResponse != (motion.response != nullptr))
        return makeError(
            "motion blur: motion.response is {}, response is {}",
            motion.response ? "given" : "null",
            frame.hasResponse ? "not 0" : "0"
        );
    return motion.response ? checkResponse(*motion.response) : core::Status();
}

} // namespace shutter::motion_blur
