// SPDX-License-Identifier: MIT
#include "engine/extract/exposure_parts.h"

#include "engine/extract/deformation_keys.h"
#include "engine/extract/deformed_entity.h"
#include "engine/extract/extracted_frame.h"
#include "engine/extract/frame_view.h"
#include "engine/extract/motion_keys.h"
#include "engine/math/math.h"
#include "engine/math/transform.h"
#include "engine/scene/clip_jumps.h"
#include "engine/scene/deformation.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace shutter::extract {

namespace {

using math::Bounds;
using math::dmat4;
using math::dvec3;
using scene::ExposureInterval;
using scene::Jump;

/// Shortest way that is seen, of kKeyTolerancePx: a quarter of a pixel.
constexpr double kSeenTolerances = 16.0;
/// How much longer the way of a jump is than those of as much time before it and after it.
constexpr double kMinSpeedUp = 8.0;

double findLargestScale(const dmat4& matrix) {
    return std::max(
        {glm::length(dvec3(matrix[0])),
         glm::length(dvec3(matrix[1])),
         glm::length(dvec3(matrix[2]))}
    );
}

/// Whether `way`, from the jump's one side to the other, is none that motion at the speed of its
/// surroundings takes. What steps has no length in time, and needs no comparison.
/// \param wayBetween (double from, double to) -> double, seconds to metres
template <class WayBetween>
bool isAbrupt(const Jump& jump, double way, const WayBetween& wayBetween) {
    const double length = jump.after - jump.before;
    const double rounding = 256.0 * std::numeric_limits<double>::epsilon() *
                            std::max(std::abs(jump.before), std::abs(jump.after));
    if (length <= rounding)
        return true;
    const double around = std::max(
        wayBetween(jump.before - length, jump.before), wayBetween(jump.after, jump.after + length)
    );
    return way > kMinSpeedUp * around;
}

/// Decides whether a jump during the exposure is visible: a surface in two places, with no motion
/// between them.
class JumpSight {
  public:
    /// All must outlive this. \param motion of the view's exposure
    JumpSight(
        const scene::World& world,
        const SceneLayout& layout,
        const ViewRequest& view,
        const scene::ExposureMotion& motion
    );

    /// Whether the picture of an entity that is drawn jumps by a quarter of a pixel or more, or it
    /// is there on one side only.
    /// \param jump in the exposure's time
    [[nodiscard]] bool sees(ecs::Entity entity, uint32_t mesh, const scene::Jump& jump) const;

    /// The same for the camera's view, at any distance.
    [[nodiscard]] bool seesCamera(const scene::Jump& jump) const;

  private:
    /// An entity where it can be drawn.
    struct Posed {
        math::dmat4 relWorldFromObject{1.0};
        scene::Deformation shape;
        math::Bounds bounds; ///< object space
    };

    /// Nothing: it cannot be drawn then.
    [[nodiscard]] std::optional<Posed>
    poseAt(ecs::Entity entity, uint32_t mesh, double seconds) const;
    [[nodiscard]] bool isInView(const std::optional<Posed>& posed, double seconds) const;
    /// Metres; an upper bound.
    [[nodiscard]] double measureWay(const Posed& from, const Posed& to, uint32_t mesh) const;
    [[nodiscard]] math::dmat4 relWorldFromCameraAt(double seconds) const;
    [[nodiscard]] double shutterTimeOf(double seconds) const;

    const scene::World& mWorld;
    const SceneLayout& mLayout;
    const ViewRequest& mView;
    const scene::ExposureMotion& mMotion;
    const scene::Camera& mCamera;
    KeyTolerance mTolerance;
    math::Bounds mNearView; ///< the camera's view volume from the near plane, in its own space
    math::dvec3 mEye{0.0};  ///< world space: origin of camera-relative space
};

JumpSight::JumpSight(
    const scene::World& world,
    const SceneLayout& layout,
    const ViewRequest& view,
    const scene::ExposureMotion& motion
)
    : mWorld(world), mLayout(layout), mView(view), mMotion(motion),
      mCamera(world.registry.get<scene::Camera>(view.camera)) {
    const double raster = view.exposure.rasterTime;
    const bool perspective = mCamera.kind == scene::CameraKind::Perspective;
    const math::dvec2 half = glm::abs(computeHalfExtents(mCamera, motion.cameraYFov(raster), view));
    const double pixel = 2.0 * half.y / view.height;
    (perspective ? mTolerance.pixelAtOne : mTolerance.pixelAnywhere) = pixel;
    mTolerance.near = perspective ? mCamera.near : 0.0;
    mTolerance.cameraPath = {dvec3(0.0)};
    const double scale = perspective ? mCamera.near : 1.0;
    const dvec3 corner(half.x * scale, half.y * scale, mCamera.near);
    mNearView.add(-corner);
    mNearView.add(dvec3(corner.x, corner.y, 0.0));
    mEye = dvec3(motion.worldFromCamera(raster)[3]);
}

double JumpSight::shutterTimeOf(double seconds) const {
    const scene::ExposureInterval& exposure = mView.exposure;
    return (seconds - exposure.open) / (exposure.close - exposure.open);
}

dmat4 JumpSight::relWorldFromCameraAt(double seconds) const {
    dmat4 view = mMotion.worldFromCamera(shutterTimeOf(seconds));
    view[3] -= math::dvec4(mEye, 0.0);
    return view;
}

std::optional<JumpSight::Posed>
JumpSight::poseAt(ecs::Entity entity, uint32_t mesh, double seconds) const {
    const double s = shutterTimeOf(seconds);
    Posed posed;
    posed.relWorldFromObject = mMotion.worldFromObject(entity, s);
    if (!isDrawable(posed.relWorldFromObject))
        return std::nullopt;
    posed.relWorldFromObject[3] -= math::dvec4(mEye, 0.0);
    posed.bounds = mLayout.bounds[mesh];
    if (!scene::isDeformable(mWorld, entity))
        return posed;
    auto deformed = poseEntity(mMotion, entity, mLayout.reaches.at(mesh), {s, s, s});
    if (!deformed)
        return std::nullopt;
    posed.shape = std::move(deformed->raster);
    posed.bounds = deformed->bounds;
    return posed;
}

bool JumpSight::isInView(const std::optional<Posed>& posed, double seconds) const {
    if (!posed)
        return false;
    if (mView.unseenMatters)
        return true;
    const dmat4 clipFromRelWorld =
        makeProjection(mCamera, mMotion.cameraYFov(shutterTimeOf(seconds)), mView) *
        glm::inverse(relWorldFromCameraAt(seconds));
    return !isOutsideView(clipFromRelWorld * posed->relWorldFromObject, posed->bounds);
}

double JumpSight::measureWay(const Posed& from, const Posed& to, uint32_t mesh) const {
    Bounds bounds = from.bounds;
    bounds.add(to.bounds);
    const double way = measureDeviation(from.relWorldFromObject, to.relWorldFromObject, bounds);
    if (from.shape.isRest())
        return way;
    return way + findLargestScale(to.relWorldFromObject) *
                     measureDeformationDeviation(
                         to.shape, from.shape, from.shape, 0.5, mLayout.reaches.at(mesh)
                     );
}

bool JumpSight::sees(ecs::Entity entity, uint32_t mesh, const Jump& jump) const {
    const std::optional<Posed> before = poseAt(entity, mesh, jump.before);
    const std::optional<Posed> after = poseAt(entity, mesh, jump.after);
    const scene::ExposureInterval& exposure = mView.exposure;
    const auto isInViewAt = [&](double seconds) {
        return isInView(poseAt(entity, mesh, seconds), seconds);
    };
    if (!isInView(before, jump.before) && !isInView(after, jump.after) &&
        !isInViewAt(exposure.open) && !isInViewAt(exposure.raster) && !isInViewAt(exposure.close))
        return false;
    if (before.has_value() != after.has_value()) {
        const Posed& there = before ? *before : *after;
        const Bounds swept = math::transformBounds(there.relWorldFromObject, there.bounds);
        return glm::length(swept.size()) > kSeenTolerances * mTolerance.of(swept);
    }
    if (!before)
        return false;
    Bounds swept = math::transformBounds(before->relWorldFromObject, before->bounds);
    swept.add(math::transformBounds(after->relWorldFromObject, after->bounds));
    const double way = measureWay(*before, *after, mesh);
    return way > kSeenTolerances * mTolerance.of(swept) &&
           isAbrupt(jump, way, [&](double from, double to) {
               const auto a = poseAt(entity, mesh, from);
               const auto b = poseAt(entity, mesh, to);
               return a && b ? measureWay(*a, *b, mesh) : 0.0;
           });
}

bool JumpSight::seesCamera(const Jump& jump) const {
    const auto wayBetween = [&](double from, double to) {
        return measureDeviation(relWorldFromCameraAt(from), relWorldFromCameraAt(to), mNearView);
    };
    // From the near plane a displacement shows most, and turning as much as anywhere.
    KeyTolerance nearest = mTolerance;
    nearest.cameraPath = {};
    const double way = wayBetween(jump.before, jump.after);
    return way > kSeenTolerances * nearest.of(mNearView) && isAbrupt(jump, way, wayBetween);
}

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

/// Splits the exposure at the jumps; a jump that takes time becomes a part itself.
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
        if (light >= scene::kMinLight)
            stretches.push_back({open, close, light});
    }
    while (stretches.size() > kMaxExposureParts)
        joinShortest(stretches);
    return stretches;
}

constexpr uint32_t kProbes = 64;
constexpr double kStraight = 0.9;
/// Deforming entities move along arcs that their boxes do not show.
constexpr uint32_t kDeformedParts = 4;

/// A box's way through the exposure, metres.
struct Way {
    double length = 0.0;
    uint32_t parts = 0; ///< whose chords are nearly as long; 0: it is static
};

template <class MatrixAt> Way measureWay(const math::Bounds& bounds, const MatrixAt& matrixAt) {
    std::array<dmat4, kProbes + 1> matrices;
    for (uint32_t i = 0; i <= kProbes; ++i)
        matrices[i] = matrixAt(double(i) / kProbes);
    const auto sumChords = [&](uint32_t parts) {
        double sum = 0.0;
        for (uint32_t i = 0, step = kProbes / parts; i < kProbes; i += step)
            sum += measureDeviation(matrices[i], matrices[i + step], bounds);
        return sum;
    };
    Way way;
    way.length = sumChords(kProbes);
    if (!(way.length > 0.0) || !std::isfinite(way.length))
        return {};
    way.parts = 1;
    while (way.parts < kMaxMotionParts && sumChords(way.parts) < kStraight * way.length)
        way.parts *= 2;
    return way;
}

/// How many parts the corners of the view take, `distance` metres ahead of the camera.
uint32_t countCameraParts(const scene::ExposureMotion& motion, double distance) {
    math::Bounds ahead;
    ahead.add(dvec3(-distance, -distance, -distance));
    ahead.add(dvec3(distance, distance, -distance));
    return measureWay(ahead, [&](double s) { return motion.worldFromCamera(s); }).parts;
}

bool movesAnyLight(const scene::World& world) {
    for (auto [entity, light] : world.registry.view<scene::Light>()) {
        (void)light;
        if (scene::mayMove(world, entity))
            return true;
    }
    return false;
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
        // A jump exactly at the raster instant has happened: of two equally near parts, the later.
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

MotionParts planMotionParts(
    const scene::World& world,
    const SceneLayout& layout,
    const ExtractedFrame& frame,
    const ViewRequest& view
) {
    const scene::ExposureMotion motion(world, view.camera, view.exposure);
    MotionParts plan;
    // Near things show how the camera travels, far ones how it turns.
    for (const double distance : {1.0, 1000.0})
        plan.count = std::max(plan.count, countCameraParts(motion, distance));
    if (motion.mayCameraZoom())
        plan.count = std::max(plan.count, 1u);
    const bool unseenMatters = view.unseenMatters && !view.unlit;
    const dvec3 eye(motion.worldFromCamera(view.exposure.rasterTime)[3]);
    for (const uint32_t row : frame.movingRows) {
        const ecs::Entity entity = frame.entityHandles[row];
        const math::Bounds& bounds = findRowBounds(frame, layout, row);
        const auto worldAt = [&](double s) { return motion.worldFromObject(entity, s); };
        const Way way = measureWay(bounds, worldAt);
        plan.count = std::max(plan.count, way.parts);
        if (motion.mayDeform(entity))
            plan.count = std::max(plan.count, kDeformedParts);
        if (!unseenMatters || !(way.length > 0.0))
            continue;
        const dvec3 centre(worldAt(view.exposure.rasterTime) * math::dvec4(bounds.centre(), 1.0));
        const math::vec2 footprint = frame.constants.pixelFootprint;
        const double pixel = footprint.x * glm::length(centre - eye) + footprint.y;
        if (pixel > 0.0)
            plan.unseenPx = std::max(plan.unseenPx, way.length / pixel);
    }
    plan.movesLight = !view.unlit && movesAnyLight(world);
    return plan;
}

} // namespace shutter::extract
