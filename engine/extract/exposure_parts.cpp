// SPDX-License-Identifier: MIT
#include "engine/extract/exposure_parts.h"

#include "engine/extract/jump_sight.h"
#include "engine/scene/clip_jumps.h"
#include "engine/scene/exposure_motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace shutter::extract {

namespace {

using scene::ExposureInterval;
using scene::Jump;

/// What two keys that are nearer to each other than this share of the exposure lead through may be
/// a jump.
constexpr double kLongestJump = 1.0 / 8.0;

/// The jump as the exposure has it of what runs `speed` times as fast away from its raster instant.
/// Nothing: that never comes there.
std::optional<Jump> placeJump(const ExposureInterval& exposure, const Jump& jump, double speed) {
    if (!(speed > 0.0))
        return std::nullopt;
    Jump placed = jump;
    if (speed != 1.0) {
        const double raster = exposure.raster;
        placed = {raster + (jump.before - raster) / speed, raster + (jump.after - raster) / speed};
        const double slack = 16.0 * std::numeric_limits<double>::epsilon() *
                             std::max(std::abs(placed.before), std::abs(placed.after));
        placed.before -= slack;
        placed.after += slack;
    }
    if (placed.after < exposure.open || placed.before > exposure.close)
        return std::nullopt;
    return placed;
}

Jump makeStep(double seconds) {
    const double slack = 16.0 * std::numeric_limits<double>::epsilon() * std::abs(seconds);
    return {seconds - slack, seconds + slack};
}

/// All that the view sees, in the exposure's time.
std::vector<Jump>
findJumps(const scene::World& world, const SceneLayout& layout, const ViewRequest& view) {
    const ExposureInterval& exposure = view.exposure;
    // As its parts will show it.
    const scene::ExposureMotion motion(
        world, view.camera, scene::takePart(exposure, exposure.open, exposure.close)
    );
    if (motion.isCut())
        return {};
    const scene::ClipJumps clips(
        world, motion.reach(), kLongestJump * (exposure.close - exposure.open)
    );
    if (clips.empty() && !motion.hasComings())
        return {};
    const JumpSight sight(world, layout, view, motion);
    std::vector<Jump> seen;
    for (const Jump& jump : clips.of(world, view.camera))
        for (const double speed : motion.cameraSpeeds())
            if (const auto placed = placeJump(exposure, jump, speed);
                placed && sight.seesCamera(*placed))
                seen.push_back(*placed);
    for (auto [entity, instance] : world.registry.view<scene::MeshInstance>()) {
        if (layout.bounds[instance.mesh].isEmpty() || motion.isHidden(entity))
            continue;
        for (const double seconds : motion.comingsOf(entity)) {
            const Jump coming = makeStep(seconds);
            if (sight.sees(entity, instance.mesh, coming))
                seen.push_back(coming);
        }
        const std::vector<Jump> jumps = clips.of(world, entity);
        if (jumps.empty())
            continue;
        const double speed = motion.speedOf(entity);
        for (const Jump& jump : jumps)
            if (const auto placed = placeJump(exposure, jump, speed);
                placed && sight.sees(entity, instance.mesh, *placed))
                seen.push_back(*placed);
    }
    return seen;
}

/// What lies between the jumps, and of those that take their time the way itself.
/// \param jumps at least one
std::vector<Jump> cutAtJumps(const ExposureInterval& exposure, std::vector<Jump> jumps) {
    std::sort(jumps.begin(), jumps.end());
    std::vector<Jump> parts;
    double open = exposure.open;
    const auto add = [&](double from, double to) {
        from = std::max(from, exposure.open);
        to = std::min(to, exposure.close);
        if (from < to)
            parts.push_back({from, to});
    };
    for (const Jump& jump : jumps) {
        if (jump.before > open)
            add(open, jump.before);
        if (jump.after > open)
            add(std::max(open, jump.before), jump.after);
        open = std::max(open, jump.after);
    }
    add(open, exposure.close);
    return parts;
}

/// A part's times, and its share of the exposure's light.
struct Stretch {
    double open = 0.0;
    double close = 0.0;
    double light = 0.0;
};

/// Joins the two neighbours that take the least light together.
void joinShortest(std::vector<Stretch>& stretches) {
    size_t least = 0;
    const auto lightFrom = [&](size_t i) { return stretches[i].light + stretches[i + 1].light; };
    for (size_t i = 1; i + 1 < stretches.size(); ++i)
        if (lightFrom(i) < lightFrom(least))
            least = i;
    stretches[least].light = lightFrom(least);
    stretches[least].close = stretches[least + 1].close;
    stretches.erase(stretches.begin() + std::ptrdiff_t(least) + 1);
}

std::vector<Stretch>
measureLight(const ExposureInterval& exposure, const std::vector<Jump>& parts) {
    std::vector<Stretch> stretches;
    for (const auto& [open, close] : parts) {
        const double light =
            scene::measureLightBefore(exposure, close) - scene::measureLightBefore(exposure, open);
        if (light >= scene::kLeastLight)
            stretches.push_back({open, close, light});
    }
    while (stretches.size() > kMaxExposureParts)
        joinShortest(stretches);
    return stretches;
}

} // namespace

std::vector<ExposurePart>
planExposureParts(const scene::World& world, const SceneLayout& layout, const ViewRequest& view) {
    const ExposureInterval& exposure = view.exposure;
    if (!(exposure.open < exposure.close) || view.instant || view.part)
        return {};
    std::vector<Jump> jumps = findJumps(world, layout, view);
    if (jumps.empty())
        return {};
    const std::vector<Stretch> stretches =
        measureLight(exposure, cutAtJumps(exposure, std::move(jumps)));
    double light = 0.0;
    for (const Stretch& stretch : stretches)
        light += stretch.light;
    std::vector<ExposurePart> parts;
    size_t main = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Stretch& stretch : stretches) {
        const ExposureInterval part = scene::takePart(exposure, stretch.open, stretch.close);
        const double distance = std::abs(part.raster - exposure.raster);
        // What steps at the raster instant has stepped: of two parts as near the later one.
        if (distance <= nearest)
            main = parts.size();
        nearest = std::min(nearest, distance);
        parts.push_back({part, stretch.light / light});
    }
    if (!parts.empty())
        std::rotate(
            parts.begin() + std::ptrdiff_t(main),
            parts.begin() + std::ptrdiff_t(main) + 1,
            parts.end()
        );
    return parts;
}

} // namespace shutter::extract
