// SPDX-License-Identifier: MIT
#include "engine/scene/auto_focus.h"

#include "engine/core/check.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <cmath>

namespace shutter::scene {

namespace {

constexpr double kMaxHalfLife = 1.0e3;     // seconds
constexpr int64_t kBlockSteps = 120 * 600; // of a replay, and the longest that is caught up with
constexpr size_t kKeptSteps = 120 * 2;     // of a simulated world, at least
constexpr double kMaxSteps = 9.0e15;       // that doubles count
constexpr double kStepSlack = 1.0e-6;      // of a step: sums of steps are not exact

double secondsOf(int64_t step) {
    return double(step) / kFocusStepsPerSecond;
}

/// The step at `seconds` or the first one after it.
int64_t findStep(double seconds) {
    const double steps = std::ceil(seconds * kFocusStepsPerSecond - kStepSlack);
    return int64_t(std::clamp(steps, -kMaxSteps, kMaxSteps));
}

/// When the last cut in the span, which has one, happens.
double findCutTime(const World& world, ecs::Entity camera, TimeSpan span) {
    // To the last bit: the cut's own time is after it.
    while (true) {
        const double middle = 0.5 * (span.after + span.until);
        if (!(middle > span.after && middle < span.until))
            return span.until;
        if (isCut(world, camera, {middle, span.until}))
            span.after = middle;
        else
            span.until = middle;
    }
}

/// Where the camera was cut between the step before and this one, or a cut was announced late.
std::optional<double>
findNewCut(const World& world, ecs::Entity camera, int64_t step, FocusTrail& trail) {
    const TimeSpan span{secondsOf(step - 1), secondsOf(step)};
    const auto* cut = world.registry.find<CameraCut>(camera);
    if (cut && cut->seconds > trail.cutSeconds && cut->seconds <= span.until) {
        trail.cutSeconds = cut->seconds;
        return std::max(cut->seconds, span.after);
    }
    if (!isCut(world, camera, span))
        return std::nullopt;
    return findCutTime(world, camera, span);
}

/// 1/m. \param before of the step before; null: there is none
double findInverse(
    const World& world,
    ecs::Entity camera,
    const AutoFocus& focus,
    int64_t step,
    const double* before
) {
    const auto distance = findFocusDistance(world, camera, focus.target, secondsOf(step));
    if (!distance && before)
        return *before;
    const auto* lens = world.registry.find<CameraLens>(camera);
    return 1.0 / distance.value_or(lens ? lens->focusDistance : CameraLens{}.focusDistance);
}

void addStep(const World& world, ecs::Entity camera, const AutoFocus& focus, FocusTrail& trail) {
    const int64_t step = trail.firstStep + int64_t(trail.inverses.size());
    const double* before = trail.inverses.empty() ? nullptr : &trail.inverses.back();
    const double wanted = findInverse(world, camera, focus, step, before);
    // What is refused only when a frame is extracted must not stay for ever.
    if (!validateAutoFocus(focus) || !(wanted > 0.0 && std::isfinite(wanted))) {
        trail.inverses.push_back(before ? *before : 1.0 / CameraLens{}.focusDistance);
        return;
    }
    const auto cut = findNewCut(world, camera, step, trail);
    if (cut)
        trail.cuts.push_back({step, *cut});
    if (!before || cut || focus.halfLife == 0.0) {
        trail.inverses.push_back(wanted);
        return;
    }
    const double rest = std::exp2(-1.0 / (kFocusStepsPerSecond * focus.halfLife));
    trail.inverses.push_back(wanted + (*before - wanted) * rest);
}

int64_t findLastStep(const FocusTrail& trail) {
    return trail.firstStep + int64_t(trail.inverses.size()) - 1;
}

/// What no exposure reaches any more.
void dropOldSteps(FocusTrail& trail) {
    if (trail.inverses.size() < 2 * kKeptSteps)
        return;
    const size_t dropped = trail.inverses.size() - kKeptSteps;
    trail.inverses.erase(trail.inverses.begin(), trail.inverses.begin() + std::ptrdiff_t(dropped));
    trail.firstStep += int64_t(dropped);
    std::erase_if(trail.cuts, [&](const FocusTrail::Cut& cut) {
        return cut.step <= trail.firstStep;
    });
}

FocusTrail startTrail(int64_t step, bool isReplayed, const AutoFocus& focus) {
    FocusTrail trail;
    trail.firstStep = step;
    trail.isReplayed = isReplayed;
    trail.focus = focus;
    return trail;
}

bool areEqual(const AutoFocus& a, const AutoFocus& b) {
    return a.target == b.target && a.halfLife == b.halfLife;
}

/// No component may be added while a view is iterated.
std::vector<ecs::Entity> listCameras(const World& world) {
    std::vector<ecs::Entity> cameras;
    for (auto [entity, focus, camera] : world.registry.view<AutoFocus, Camera>()) {
        (void)focus;
        if (camera.kind == CameraKind::Perspective)
            cameras.push_back(entity);
    }
    return cameras;
}

/// Continues the trail where that is possible, else starts one at `start`.
void runTo(World& world, ecs::Entity camera, int64_t start, int64_t last, bool isReplay) {
    ecs::Registry& registry = world.registry;
    const AutoFocus focus = registry.get<AutoFocus>(camera);
    FocusTrail* trail = registry.find<FocusTrail>(camera);
    const bool isKept = trail && !trail->inverses.empty() && trail->isReplayed == isReplay;
    const bool goesOn =
        isReplay ? isKept && trail->firstStep == start && areEqual(trail->focus, focus)
                 : isKept && last >= trail->firstStep && last - findLastStep(*trail) < kBlockSteps;
    if (!goesOn)
        trail = &registry.add(camera, startTrail(start, isReplay, focus));
    while (trail->inverses.empty() || findLastStep(*trail) < last)
        addStep(world, camera, focus, *trail);
    if (!isReplay)
        dropOldSteps(*trail);
}

} // namespace

core::Status validateAutoFocus(const AutoFocus& focus) {
    if (focus.halfLife >= 0.0 && focus.halfLife <= kMaxHalfLife)
        return {};
    return core::makeError(
        "autofocus: halfLife is {}, it must lie in [0, {:g}] seconds", focus.halfLife, kMaxHalfLife
    );
}

std::optional<double>
findFocusDistance(const World& world, ecs::Entity camera, ecs::Entity target, double seconds) {
    if (!world.registry.isAlive(target))
        return std::nullopt;
    const math::dmat4 view = worldFromRigid(world, camera, seconds);
    const math::dvec3 place(worldFromEntity(world, target, seconds)[3]);
    const double distance = glm::dot(math::dvec3(view[3]) - place, math::dvec3(view[2]));
    // Written so that NaN fails.
    if (!(distance >= world.registry.get<Camera>(camera).near && std::isfinite(distance)))
        return std::nullopt;
    return std::clamp(distance, kNearestFocus, kFarthestFocus);
}

void advanceAutoFocus(World& world, double until) {
    SHUTTER_CHECK(std::isfinite(until), "autofocus at {} seconds", until);
    const int64_t last = findStep(until);
    for (const ecs::Entity camera : listCameras(world))
        runTo(world, camera, last, last, false);
}

void replayAutoFocus(World& world, double until) {
    SHUTTER_CHECK(std::isfinite(until), "autofocus at {} seconds", until);
    const int64_t last = std::max<int64_t>(findStep(until), 0);
    const int64_t start = std::max<int64_t>(last / kBlockSteps - 1, 0) * kBlockSteps;
    for (const ecs::Entity camera : listCameras(world))
        runTo(world, camera, start, last, true);
}

void replayAutoFocus(World& world, ecs::Entity camera, const ExposureInterval& exposure) {
    const double until = ExposureMotion(world, camera, exposure).reach().until;
    replayAutoFocus(world, std::max(exposure.close, until));
}

std::optional<double> autoFocusAt(const World& world, ecs::Entity camera, double seconds) {
    const auto* trail = world.registry.find<FocusTrail>(camera);
    if (!trail || trail->inverses.empty() || !world.registry.has<AutoFocus>(camera))
        return std::nullopt;
    const double place = seconds * kFocusStepsPerSecond - double(trail->firstStep);
    const double end = double(trail->inverses.size() - 1);
    if (!(place > 0.0))
        return 1.0 / trail->inverses.front();
    if (place >= end)
        return 1.0 / trail->inverses.back();
    const size_t before = size_t(place);
    const double from = trail->inverses[before];
    const double to = trail->inverses[before + 1];
    const int64_t step = trail->firstStep + int64_t(before) + 1;
    for (const FocusTrail::Cut& cut : trail->cuts)
        if (cut.step == step)
            return 1.0 / (seconds < cut.seconds ? from : to);
    return 1.0 / (from == to ? from : std::lerp(from, to, place - double(before)));
}

} // namespace shutter::scene
