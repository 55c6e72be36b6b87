// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/check/checked_frame.h"

#include "engine/math/layer_tables.h"
#include "shaders/motion_blur/check_grid.glsl"
#include "shaders/motion_blur/prepare.glsl"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shutter::motion_blur {

namespace {

using math::dmat4;
using math::dvec2;

math::uvec2 sizeOf(VkExtent2D picture) {
    return {picture.width, picture.height};
}

/// Where a place of the picture, at a distance, is seen by another camera; nothing: behind it.
std::optional<dvec2>
seeFrom(const dmat4& toFromPicture, bool isPerspective, const dvec2& place, double metres) {
    const glm::dvec4 point =
        isPerspective ? glm::dvec4(place * metres, metres, 1.0) : glm::dvec4(place, metres, 1.0);
    const glm::dvec4 seen = toFromPicture * point;
    if (!isPerspective)
        return dvec2(seen);
    return seen.z > 0.0 ? std::optional(dvec2(seen) / seen.z) : std::nullopt;
}

/// Returns the distance in pixels between the images of a far point at the picture's centre under
/// two cameras; infinity: behind the other one.
double measureTurn(const HostCamera& from, const HostCamera& to, VkExtent2D picture) {
    const dvec2 middle = 0.5 * dvec2(picture.width, picture.height);
    const dmat4 map =
        to.pictureFromWorld(sizeOf(picture)) * glm::inverse(from.pictureFromWorld(sizeOf(picture)));
    // A translation of some metres turns nothing there.
    const auto seen = seeFrom(map, from.isPerspective, middle, from.isPerspective ? 1.0e4 : 10.0);
    return seen ? glm::length(*seen - middle) : HUGE_VAL;
}

HostCamera cameraOf(const CheckFacts& facts, const dmat4& view, const dmat4& clip) {
    const bool isPlus = facts.convention.cameras.aheadIsPlusZ;
    return normalize(HostCameraKey{0.0, view, clip}, isPlus).value();
}

/// Depth of a place from the camera of the previous frame.
float metresBefore(const shader::PrepareTable& table, const glm::vec2& place, float metres) {
    const bool isPerspective = (table.flags & shader::kPreparePerspective) != 0;
    const glm::vec4 point(isPerspective ? place * metres : place, metres, 1.0f);
    return glm::dot(table.beforeFromNow[2], point);
}

CheckPoint makePoint(
    const CheckFacts& declared,
    const shader::PrepareTable& table,
    const shader::PrepareTable* close,
    const shader::CheckSample& sample,
    const glm::uvec2& pixel
) {
    CheckPoint point;
    point.place = dvec2(pixel) + 0.5;
    point.motion = dvec2(sample.vector) * dvec2(table.pixelsPerUnit) - dvec2(table.jitterPx);
    const float depth = declared.flipsDepth ? 1.0f - sample.depth : sample.depth;
    point.stored = sample.depth;
    point.metres = shader::metresOfDepth(table, depth);
    point.isSky = point.metres >= shader::kSkyDepth;
    point.id = sample.id;
    point.deformed = sample.deformed;
    if (!hasCameras(declared))
        return point;
    const glm::vec2 place(point.place);
    point.camera = shader::motionOfCamera(table, place, point.metres);
    point.metresBefore = metresBefore(table, place, point.metres);
    if (close)
        point.camera -= dvec2(shader::motionOfCamera(*close, place, point.metres));
    return point;
}

} // namespace

bool hasCameras(const CheckFacts& facts) {
    return facts.hasExposureCameras || facts.convention.cameras.areGiven;
}

bool hasFound(const std::vector<Finding>& findings, std::initializer_list<CheckKind> kinds) {
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
        return std::find(kinds.begin(), kinds.end(), finding.kind) != kinds.end();
    });
}

std::vector<bool> markMovers(const CheckFacts& facts) {
    std::vector<bool> marks(facts.rowCount);
    for (const CheckFacts::Mover& mover : facts.movers)
        marks[mover.row] = true;
    return marks;
}

std::optional<HostCamera> findCamera(const CheckFacts& facts, bool isBefore) {
    const HostCameras& cameras = facts.convention.cameras;
    if (!cameras.areGiven)
        return std::nullopt;
    return isBefore ? cameraOf(facts, cameras.viewFromWorldBefore, cameras.clipFromViewBefore)
                    : cameraOf(facts, cameras.viewFromWorld, cameras.clipFromView);
}

double
measureApart(const HostCamera& from, const HostCamera& to, VkExtent2D picture, double metres) {
    const dmat4 map =
        to.pictureFromWorld(sizeOf(picture)) * glm::inverse(from.pictureFromWorld(sizeOf(picture)));
    double sum = 0.0;
    for (const double x : {0.2, 0.5, 0.8})
        for (const double y : {0.2, 0.5, 0.8}) {
            const dvec2 place = dvec2(x, y) * dvec2(picture.width, picture.height);
            const auto seen = seeFrom(map, from.isPerspective, place, metres);
            sum += seen ? glm::length(*seen - place) : HUGE_VAL;
        }
    return sum / 9.0;
}

double findTypicalMetres(const std::vector<CheckPoint>& points) {
    std::vector<float> metres;
    for (const CheckPoint& point : points)
        if (!point.isSky)
            metres.push_back(point.metres);
    if (metres.empty())
        return 10.0;
    const auto middle = metres.begin() + std::ptrdiff_t(metres.size() / 2);
    std::nth_element(metres.begin(), middle, metres.end());
    return *middle;
}

std::vector<CheckPoint> makePoints(const CheckedFrame& frame, const CheckFacts& declared) {
    HostConvention convention = declared.convention;
    if (declared.hasExposureCameras)
        convention.cameras = declared.open;
    const shader::PrepareTable table = makePrepareTable(convention, declared.picture);
    std::optional<shader::PrepareTable> close;
    if (declared.hasExposureCameras) {
        convention.cameras = declared.close;
        close = makePrepareTable(convention, declared.picture);
    }
    std::vector<CheckPoint> points;
    points.reserve(shader::kCheckSamples);
    // No camera explains what follows it.
    const auto isOwn = [&](const shader::CheckSample& sample) {
        const auto& rows = declared.viewModelRows;
        return shader::isViewModel(table, sample.depth) ||
               (declared.hasIds && std::find(rows.begin(), rows.end(), sample.id) != rows.end());
    };
    for (uint32_t i = 0; i < shader::kCheckSamples; ++i) {
        if (isOwn(frame.totals.samples[i]))
            continue;
        const glm::uvec2 cell(i % shader::kCheckAcross, i / shader::kCheckAcross);
        const CheckPoint point = makePoint(
            declared,
            table,
            close ? &*close : nullptr,
            frame.totals.samples[i],
            shader::checkedPixel(cell, sizeOf(declared.picture))
        );
        if (std::isfinite(point.motion.x) && std::isfinite(point.motion.y))
            points.push_back(point);
    }
    return points;
}

void checkCameras(
    const CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings
) {
    if (!last)
        return;
    const CheckFacts& facts = now.facts;
    const bool follows = facts.followsLast || (facts.frameNumber != 0 &&
                                               facts.frameNumber == last->facts.frameNumber + 1);
    if (!follows || facts.convention.scales.isCut)
        return;
    const auto before = findCamera(facts, true);
    const auto then = findCamera(last->facts, false);
    if (before && then) {
        const double off = measureTurn(*then, *before, facts.picture);
        if (off > 1.0)
            findings.push_back(
                {CheckKind::CameraJump,
                 fmt::format(
                     "cameras.viewFromWorldBefore is not the viewFromWorld of the frame "
                     "before: the middle of the picture differs by {:.3g} px; after a cut set "
                     "isCut, and followsLast = false",
                     off
                 )}
            );
        return;
    }
    if (!facts.followsLast || !facts.hasExposureCameras || !last->facts.hasExposureCameras)
        return;
    const auto opens = [](const CheckFacts& one) {
        return HostCamera{one.open.viewFromWorld, one.open.clipFromView};
    };
    const auto at = [](const HostCameras& pair) {
        return HostCamera{pair.viewFromWorldBefore, pair.clipFromViewBefore};
    };
    const double jump = measureTurn(opens(last->facts), opens(facts), facts.picture);
    const double during = measureTurn(at(facts.open), at(facts.close), facts.picture);
    // Eight exposures a frame are a shutter of 45 degrees.
    if (jump > 0.75 * facts.picture.width && jump > 8.0 * during)
        findings.push_back(
            {CheckKind::CameraJump,
             fmt::format(
                 "followsLast is true, but the camera keys are {:.3g} px away from those of "
                 "the frame before, and move {:.3g} px during the exposure: after a cut, set "
                 "followsLast = false",
                 jump,
                 during
             )}
        );
}

void checkHistory(CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings) {
    const CheckFacts& facts = now.facts;
    const bool mayFollow = last && facts.readsMotion && facts.wantsHistory && !facts.followsLast &&
                           !facts.convention.scales.isCut && last->facts.readsMotion &&
                           facts.picture.width == last->facts.picture.width &&
                           facts.picture.height == last->facts.picture.height;
    if (!mayFollow)
        return;
    const auto before = findCamera(facts, true);
    const auto then = findCamera(last->facts, false);
    const bool follows =
        before && then ? measureTurn(*then, *before, facts.picture) <= 1.0
                       : facts.frameNumber != 0 && facts.frameNumber == last->facts.frameNumber + 1;
    now.unusedHistory = follows ? last->unusedHistory + 1 : 0;
    if (now.unusedHistory < 2)
        return;
    findings.push_back(
        {CheckKind::HistoryUnused,
         fmt::format(
             "followsLast is false, although {} recordings of view {} in a row go on where "
             "the one before ended: set it where that shows the frame before, or what this frame "
             "hides is not looked up there; if no history is wanted, set history = false",
             now.unusedHistory,
             facts.view
         )}
    );
}

std::vector<Finding> checkFrame(CheckedFrame& now, const CheckedFrame* last) {
    std::vector<Finding> findings;
    checkTotals(now, findings);
    checkCameras(now, last, findings);
    checkHistory(now, last, findings);
    const bool isCut = now.facts.convention.scales.isCut;
    // Samples at wrong depths agree with no camera.
    const bool isDepthWrong = checkDepthDirection(now, findings);
    if (now.facts.hasVectors && hasCameras(now.facts) && !isDepthWrong && !isCut)
        checkVectors(now, last, findings);
    if (!now.facts.hasVectors && last && !isDepthWrong && !isCut)
        checkReprojection(now, *last, findings);
    if (!isCut)
        checkKeys(now, last, findings);
    checkIds(now, last, findings);
    // The camera is checked first: movers depend on it.
    const bool isCameraWrong =
        isDepthWrong ||
        hasFound(
            findings,
            {CheckKind::Vectors, CheckKind::VectorOffset, CheckKind::CameraJump, CheckKind::Keys}
        );
    if (isCut || isCameraWrong)
        return findings;
    if (last)
        checkViewModel(now, *last, findings);
    checkMovers(now, last, findings);
    checkDeformed(now, findings);
    checkUnexplained(now, findings);
    return findings;
}

} // namespace shutter::motion_blur
