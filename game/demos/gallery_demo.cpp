// SPDX-License-Identifier: MIT
#include "game/demos/gallery_demo.h"

#include "engine/core/words.h"
#include "game/demos/gallery_balls.h"
#include "game/demos/gallery_targets.h"
#include "game/demos/sparks.h"
#include "game/demos/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace shutter::game {

using math::dvec3;

namespace {

constexpr double kRoundSeconds = 45.0;
constexpr double kReloadSeconds = 0.4;
constexpr double kClosingShotSeconds = 2.5; // of each camera after the end
constexpr double kThrowSpeed = 24.0;        // m/s
constexpr double kThrowLift = 0.06;         // radians above the aim, against the fall
constexpr uint32_t kSplintersPerHit = 24;
constexpr uint32_t kFlashesPerHit = 14;
constexpr int kBallCount = 12;

/// The scene's rails: node `rail_N` is rail N's bar, nodes `target_N_K` are the targets on it.
struct RailRules {
    const char* rail;
    const char* targets;
    double halfLength; ///< metres
    double radius;     ///< of the faces, metres
    double slowest;    ///< m/s
    double fastest;    ///< m/s
};

constexpr std::array kRails = {
    RailRules{"rail_0", "target_0_", 4.2, 0.26, 2.0, 5.0},
    RailRules{"rail_1", "target_1_", 5.2, 0.32, 4.0, 8.0},
    RailRules{"rail_2", "target_2_", 6.2, 0.40, 6.0, 12.0}};
constexpr double kStalk = 0.16; // metres, from the rail to the face's rim

void addTargets(scene::World& world, NodeNames& names, Random& random) {
    for (size_t i = 0; i < kRails.size(); ++i) {
        const RailRules& rules = kRails[i];
        for (const ecs::Entity entity : names.findAll(rules.targets)) {
            const dvec3 place = simulate(world, entity).transform.translation;
            Target target;
            target.rail = {0.0, place.y, place.z};
            target.halfLength = rules.halfLength;
            target.radius = rules.radius;
            target.faceHeight = kStalk + rules.radius;
            target.slowest = rules.slowest;
            target.fastest = rules.fastest;
            target.along = place.x;
            // Neighbouring rails run against each other.
            target.speed = (i % 2 == 0 ? 1.0 : -1.0) * random.between(rules.slowest, rules.fastest);
            world.registry.add(entity, target);
        }
    }
}

/// Rides on the ball: an entity has one emitter, and the ball's own has its splinters.
ecs::Entity addFlash(scene::World& world, ecs::Entity ball, uint32_t seed) {
    const ecs::Entity flash = world.registry.create();
    world.registry.add(flash, scene::LocalTransform{});
    world.registry.add(flash, scene::Parent{ball});
    particles::addEmitter(world.registry, flash, makeFlash(seed));
    return flash;
}

} // namespace

core::Result<std::unique_ptr<Demo>> GalleryDemo::create(scene::World world, std::string_view file) {
    NodeNames names(world);
    Nodes nodes;
    nodes.shooter = names.find("shooter");
    nodes.launcher = names.find("launcher");
    nodes.ball = names.findMesh("ball");
    for (const RailRules& rules : kRails)
        (void)names.find(rules.targets + std::string("0"));
    SHUTTER_TRY(names.check(file));
    if (world.cameras.empty())
        return core::makeError("{}: it has no camera", file);
    world.playback.loop = true; // the runner never stops
    Random random(11);
    addTargets(world, names, random);
    return std::unique_ptr<Demo>(new GalleryDemo(std::move(world), nodes));
}

GalleryDemo::GalleryDemo(scene::World loaded, const Nodes& nodes)
    : DemoBase(std::move(loaded), nodes.launcher), mNodes(nodes),
      mShooterRest(restOf(world(), nodes.shooter)), mLauncherRest(restOf(world(), nodes.launcher)) {
    for (int i = 0; i < kBallCount; ++i) {
        const ecs::Entity ball = copyHidden(world(), mNodes.ball);
        const auto seed = static_cast<uint32_t>(i);
        world().registry.add(ball, Ball{.flash = addFlash(world(), ball, seed)});
        particles::addEmitter(world().registry, ball, makeSplinters(seed));
    }
    (void)game::simulate(world(), mNodes.shooter);
    (void)game::simulate(world(), mNodes.launcher);
    recordStart();
}

void GalleryDemo::throwOne() {
    const math::Transform eye = aimPose(mAim, mShooterRest);
    const dvec3 muzzle =
        eye.translation + eye.rotation * (mLauncherRest.translation + dvec3(0.0, 0.0, -0.6));
    // The ball starts next to the eye and is aimed at the point in view at the middle rail.
    constexpr double kAimedDepth = 8.4;
    const dvec3 ahead = eye.rotation * glm::angleAxis(kThrowLift, dvec3(1.0, 0.0, 0.0)) *
                        dvec3(0.0, 0.0, -kAimedDepth);
    const dvec3 direction = glm::normalize(eye.translation + ahead - muzzle);
    throwBall(world(), muzzle, direction * kThrowSpeed, seconds());
    kickBack(mAim);
    ++mThrows;
    mReadySeconds = seconds() + kReloadSeconds;
}

void GalleryDemo::countHits() {
    ecs::Registry& registry = world().registry;
    for (auto [entity, ball, pose] : registry.view<Ball, SimulatedPose>()) {
        if (!ball.flies || ball.hasHit)
            continue;
        const auto hit = hitTarget(registry, pose.transform.translation, kBallRadius);
        if (!hit)
            continue;
        ball.hasHit = true;
        burst(registry, entity, seconds(), kSplintersPerHit);
        burst(registry, ball.flash, seconds(), kFlashesPerHit);
        // It falls back from the face.
        ball.velocity = {ball.velocity.x * 0.3, ball.velocity.y, -0.25 * ball.velocity.z};
        if (isOver())
            continue;
        ++mHits;
        mScore += pointsFor(*hit);
    }
}

void GalleryDemo::placeShooter() {
    ecs::Registry& registry = world().registry;
    registry.get<SimulatedPose>(mNodes.shooter).transform = aimPose(mAim, mShooterRest);
    registry.get<SimulatedPose>(mNodes.launcher).transform = launcherPose(mAim, mLauncherRest);
}

void GalleryDemo::simulate(const DemoControls& controls) {
    stepAim(mAim, isOver() ? DemoControls{} : controls);
    stepTargets(world().registry, mRandom);
    stepBalls(world(), {});
    countHits();
    if (!isOver() && controls.action && seconds() >= mReadySeconds)
        throwOne();
    placeShooter();
    if (!isOver())
        return;
    if (mCutSeconds == 0.0)
        mCutSeconds = seconds() + kClosingShotSeconds;
    if (seconds() < mCutSeconds)
        return;
    cutToNextCamera();
    mCutSeconds += kClosingShotSeconds;
}

DemoAppearance GalleryDemo::appearance() const {
    return {{0.42f, 0.58f, 0.78f}, {0.42f, 0.42f, 0.44f}, 3.0, 2.0};
}

bool GalleryDemo::isOver() const {
    return seconds() >= kRoundSeconds;
}

std::vector<HudLine> GalleryDemo::hud() const {
    const HudLine hits{
        fmt::format("{} of {}", core::countOf(mHits, "hit"), core::countOf(mThrows, "throw"))};
    if (isOver())
        return {{"Closing time", true}, {fmt::format("{}", mScore), true, "Score"}, hits};
    return {
        {fmt::format("{}", mScore), true, "Score"},
        {fmt::format("{:.1f} s", kRoundSeconds - seconds()), false, "Left"},
        hits};
}

} // namespace shutter::game
