// SPDX-License-Identifier: MIT
// Particles as a picture's tables, and the formulas that shaders evaluate them by.
#include "engine/scene/history.h"
#include "engine/scene/motion.h"
#include "engine/scene/recorded_motion.h"
#include "modules/particles/particle_emitter.h"
#include "modules/particles/particle_instants.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ranges>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace shutter::particles {
namespace {

using math::dvec3;
using math::vec2;
using math::vec3;
using math::vec4;

class ParticlesOfScenes : public extract::Extraction {
  protected:
    ParticlesOfScenes() {
        emitter.spans = {{.fromSeconds = -5.0, .untilSeconds = 5.0, .perSecond = 40.0}};
        emitter.velocity = dvec3(1.0, 2.0, 0.0);
        emitter.coneDegrees = 40.0;
        emitter.lifeSeconds = 0.8;
        emitter.lifeSpread = 0.5;
    }

    ecs::Entity addEmitter(const dvec3& position, const particles::ParticleEmitter& component) {
        const ecs::Entity entity = world.registry.create();
        world.registry.add(entity, scene::LocalTransform{{position}});
        particles::addEmitter(world.registry, entity, component);
        return entity;
    }

    [[nodiscard]] core::Result<ParticleTables> tryExtract(ParticleTime time) const {
        return extractParticles(world, request, extract::FrameView(world, request), time);
    }

    [[nodiscard]] ParticleTables extractAll(ParticleTime time = ParticleTime::Exposure) const {
        auto tables = tryExtract(time);
        EXPECT_TRUE(tables.ok()) << tables.error().message;
        return tables.ok() ? std::move(tables).value() : ParticleTables{};
    }

    /// A short exposure.
    void setTime(double seconds) {
        request.exposure = scene::computeExposure({.exposureSeconds = 0.1}, seconds);
    }

    particles::ParticleEmitter emitter;
};

TEST_F(ParticlesOfScenes, AFramesRowsDoNotDependOnTheFramesBeforeIt) {
    addEmitter({0, 0, -10}, emitter);
    setTime(2.0);
    const ParticleTables alone = extractAll();
    ASSERT_GT(alone.rows.size(), 20u);
    for (const double seconds : {0.0, 36000.0, 1.0}) {
        setTime(seconds);
        (void)extractAll();
    }
    setTime(2.0);
    const auto bytesOf = [](const ParticleTables& tables) {
        return std::as_bytes(std::span(tables.rows));
    };
    EXPECT_TRUE(std::ranges::equal(bytesOf(extractAll()), bytesOf(alone)));
}

TEST_F(ParticlesOfScenes, ParticlesAreSortedFarToNearAcrossEmitters) {
    emitter.velocity = dvec3(0.0, 0.0, 1.0);
    emitter.coneDegrees = 180.0;
    emitter.radius = 2.0;
    addEmitter({0, 0, -10}, emitter);
    particles::ParticleEmitter second = emitter;
    second.seed = 1;
    addEmitter({0, 0, -11}, second);
    const ParticleTables tables = extractAll();
    const auto depth = [&](const shader::ParticleRow& row) {
        const float age = std::clamp(row.placeAge.w, 0.0f, row.velocityLife.w);
        return -shader::particlePlace(row, tables.emitters[row.emitter], age).z;
    };
    ASSERT_GT(tables.rows.size(), 60u);
    EXPECT_TRUE(std::ranges::is_sorted(tables.rows, std::ranges::greater(), depth));
    world = scene::World{};
    request.camera = camera = addCamera({});
    addEmitter({0, 0, -11}, second);
    addEmitter({0, 0, -10}, emitter);
    const ParticleTables permuted = extractAll();
    ASSERT_EQ(permuted.rows.size(), tables.rows.size());
    for (size_t i = 0; i < tables.rows.size(); ++i)
        EXPECT_EQ(permuted.rows[i].placeAge, tables.rows[i].placeAge) << i;
}

TEST_F(ParticlesOfScenes, ParticlesAreBornAtTheirEmitterAndStayInTheWorld) {
    emitter = {};
    emitter.bursts = {{.seconds = 0.25, .count = 1}};
    emitter.inherit = 0.5;
    const ecs::Entity entity = addEmitter({0, 0, -10}, emitter);
    world.registry.add(entity, scene::LinearVelocity{dvec3(4.0, 0.0, 0.0)});
    setTime(0.75);
    const ParticleTables tables = extractAll();
    ASSERT_EQ(tables.rows.size(), 1u);
    const shader::ParticleRow& row = tables.rows[0];
    EXPECT_NEAR(row.placeAge.x, 1.0f, 1e-5f);
    EXPECT_NEAR(row.placeAge.w, 0.5f, 1e-6f);
    EXPECT_NEAR(row.velocityLife.x, 2.0f, 1e-4f);
    const vec3 now = shader::particlePlace(row, tables.emitters[0], 0.5f);
    EXPECT_NEAR(now.x, 2.0f, 1e-4f);
}

TEST_F(ParticlesOfScenes, InheritedVelocityIsNotTakenOverAJump) {
    emitter = {};
    emitter.inherit = 1.0;
    emitter.bursts = {{.seconds = 0.0, .count = 1}};
    const auto measure = [&](const std::function<void(ecs::Entity)>& move, double seconds) {
        reset();
        emitter.bursts[0].seconds = seconds;
        move(addEmitter({0, 0, -10}, emitter));
        setTime(seconds + 0.1);
        const ParticleTables tables = extractAll();
        EXPECT_EQ(tables.rows.size(), 1u);
        return tables.rows.at(0).velocityLife.x;
    };
    const auto steps = [&](ecs::Entity entity) {
        animateX(entity, {0.0f, 0.5f}, {-1.5f, 1.5f}, scene::Interpolation::Step);
    };
    for (const double after : {0.0, 1e-7, 0.0004, 0.002})
        EXPECT_EQ(measure(steps, 0.5 + after), 0.0f) << after;
    const auto loops = [&](ecs::Entity entity) {
        animateX(entity, {0.0f, 1.0f}, {-1.5f, 1.5f});
        world.playback.loop = true;
    };
    for (const double after : {-0.5, 0.0, 1e-7, 0.0004, 0.002})
        EXPECT_NEAR(measure(loops, 1.0 + after), 3.0f, 1e-3f) << after;
    // Two keys as near to each other as exporters bake a jump.
    const auto bakes = [&](ecs::Entity entity) {
        animateX(entity, {0.0f, 0.5f, 0.5001f, 1.0f}, {0.0f, 1.0f, 9.0f, 10.0f});
    };
    for (const double after : {0.00005, 0.0002, 0.0005, 0.002})
        EXPECT_NEAR(measure(bakes, 0.5 + after), 2.0f, 1e-2f) << after;
    const auto records = [&](ecs::Entity entity) {
        for (int step = 0; step <= 10; ++step) {
            const math::Transform pose{.translation = {0.4 * step + (step > 5 ? 50.0 : 0.0), 0, 0}};
            (step == 6 ? scene::recordJump : scene::recordMotion)(world, entity, pose, 0.1 * step);
        }
    };
    for (const double after : {0.0, 0.0004, 0.05})
        EXPECT_NEAR(measure(records, 0.6 + after), after > 0.0 ? 4.0f : 0.0f, 1e-2f) << after;
}

TEST_F(ParticlesOfScenes, AnEmitterThatIsScaledToAPointEmitsNothing) {
    emitter = {};
    emitter.bursts = {{.seconds = 0.2, .count = 1}, {.seconds = 0.4, .count = 1}};
    const ecs::Entity entity = addEmitter({0, 0, -10}, emitter);
    animateScale(entity, {0.0f, 0.3f}, {0.0f, 1.0f}, scene::Interpolation::Step);
    setTime(0.5);
    EXPECT_EQ(extractAll().rows.size(), 1u);
}

TEST_F(ParticlesOfScenes, CamerasStandOnBothSidesOfAJumpAndAsFarAsScalesReach) {
    const ecs::Entity entity = addEmitter({0, 0, -10}, emitter);
    setTime(2.0);
    animateX(camera, {0.0f, 1.96f}, {0.0f, 0.01f}, scene::Interpolation::Step);
    const auto placeAt = [](const shader::ParticleCamera& one) {
        return one.clipFromRelWorld[3].x;
    };
    const ParticleTables jumps = extractAll();
    ASSERT_GT(jumps.cameras.size(), 2u);
    float longest = 0.0f;
    for (size_t i = 1; i < jumps.cameras.size(); ++i) {
        EXPECT_LE(jumps.cameras[i - 1].s, jumps.cameras[i].s);
        if (placeAt(jumps.cameras[i - 1]) != placeAt(jumps.cameras[i]))
            longest = std::max(longest, jumps.cameras[i].s - jumps.cameras[i - 1].s);
    }
    EXPECT_LT(longest, 1e-4f);
    world.registry.add(entity, scene::MotionBlur{.scale = 2.0});
    EXPECT_LT(extractAll().cameras.front().s, -0.4f);
}

TEST_F(ParticlesOfScenes, WaysHoldTurnsAndGrowthAndThoseThatComeOrFlashAreFleeting) {
    world.assets.images.push_back({"puff", 8, 8, std::vector<uint8_t>(256, 255)});
    world.assets.textures.push_back({.image = 0, .isLoose = true});
    emitter = {};
    emitter.bursts = {{.seconds = 1.9, .count = 1}};
    emitter.lifeSeconds = 4.0;
    emitter.sizeBirth = emitter.sizeDeath = 1.0;
    emitter.colors.fill(vec4(1.0f));
    setTime(2.1);
    const ecs::Entity entity = addEmitter({0, 0, -10}, emitter);
    auto& component = world.registry.get<particles::ParticleEmitter>(entity);
    EXPECT_EQ(extractAll().longestWayPx, 0.0f);
    EXPECT_FALSE(extractAll().areFleeting);
    component.spin = 10.0;
    EXPECT_EQ(extractAll().longestWayPx, 0.0f) << "a round one looks the same";
    component.texture = 0;
    const float turn = extractAll().longestWayPx;
    EXPECT_GT(turn, 0.1f);
    component.spin = 0.0;
    component.sizeDeath = 41.0; // a metre in the exposure
    const double metrePx = request.height / 2.0 / std::tan(scene::Camera{}.yFov / 2.0) / 10.0;
    EXPECT_NEAR(extractAll().longestWayPx, 0.5 * metrePx, 0.2);
    component.sizeDeath = 1.0;
    component.bursts[0].seconds = 2.05;
    EXPECT_TRUE(extractAll().areFleeting) << "it is born";
    component.bursts[0].seconds = 1.9;
    component.lifeSeconds = 0.15;
    EXPECT_TRUE(extractAll().areFleeting) << "it dies";
    component.lifeSeconds = 4.0;
    component.colors[0] = vec4(0.0f);
    EXPECT_TRUE(extractAll().areFleeting) << "it lights up";
}

TEST_F(ParticlesOfScenes, RecordedMotionIsKnownForTheLongestLife) {
    emitter = {};
    emitter.lifeSeconds = 3.0;
    emitter.bursts = {{.seconds = 0.5, .count = 1}};
    const ecs::Entity carrier = world.registry.create();
    world.registry.add(carrier, scene::LocalTransform{});
    const ecs::Entity entity = addEmitter({0, 0, -10}, emitter);
    world.registry.add(entity, scene::Parent{carrier});
    for (int step = 1; step <= 30; ++step)
        scene::recordMotion(world, carrier, {.translation = {0.1 * step, 0, 0}}, 0.1 * step);
    setTime(3.0);
    const ParticleTables tables = extractAll();
    ASSERT_EQ(tables.rows.size(), 1u);
    EXPECT_NEAR(tables.rows[0].placeAge.x, 0.5f, 1e-5f);
}

TEST_F(ParticlesOfScenes, AnExcludedEmitterAndACutAreStatic) {
    const ecs::Entity entity = addEmitter({0, 0, -10}, emitter);
    setTime(2.0);
    EXPECT_GT(extractAll().emitters.at(0).secondsPerExposure, 0.0f);
    world.registry.add(entity, scene::MotionBlur{.exclude = true});
    EXPECT_EQ(extractAll().emitters.at(0).secondsPerExposure, 0.0f);
    const size_t atInstant = extractAll(ParticleTime::Instant).rows.size();
    EXPECT_EQ(extractAll().rows.size(), atInstant);
    world.registry.get<scene::MotionBlur>(entity) = {};
    EXPECT_GT(extractAll().rows.size(), atInstant);
    scene::cut(world, camera, 2.0);
    EXPECT_EQ(extractAll().rows.size(), atInstant);
}

TEST_F(ParticlesOfScenes, HiddenEmittersAndTimesBeforeTheirAppearanceHaveNoParticles) {
    const ecs::Entity entity = addEmitter({0, 0, -10}, emitter);
    setTime(2.0);
    const size_t all = extractAll().rows.size();
    scene::appear(world, entity, 1.9);
    const size_t recent = extractAll().rows.size();
    EXPECT_LT(recent, all);
    EXPECT_GT(recent, 0u);
    scene::hide(world, entity);
    EXPECT_TRUE(extractAll().empty());
}

TEST_F(ParticlesOfScenes, BadEmittersAndTooManyParticlesAreRefusedByTheEmittersName) {
    const auto expectRefused = [&](const std::string& name, const char* part) {
        const auto refused = tryExtract(ParticleTime::Exposure);
        ASSERT_FALSE(refused.ok());
        const std::string& message = refused.error().message;
        EXPECT_NE(message.find("'" + name + "'"), std::string::npos) << message;
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    const ecs::Entity entity = addEmitter({0, 0, -10}, emitter);
    world.registry.add(entity, scene::Name{"chimney"});
    auto& component = world.registry.get<particles::ParticleEmitter>(entity);
    component.texture = 0;
    expectRefused("chimney", "texture 0");
    component = emitter;
    component.lifeSeconds = std::numeric_limits<double>::quiet_NaN();
    expectRefused("chimney", "lifeSeconds");
    emitter.spans[0].perSecond = 60000.0;
    emitter.lifeSpread = 0.0;
    emitter.lifeSeconds = 1.0;
    component = emitter;
    request.exposure = scene::computeExposure({.exposureSeconds = 0.01}, 2.0);
    EXPECT_TRUE(tryExtract(ParticleTime::Exposure).ok());
    world.registry.add(addEmitter({0, 0, -10}, emitter), scene::Name{"geyser"});
    expectRefused("geyser", "65536");
}

TEST_F(ParticlesOfScenes, PicturesTakeAsManyPartsAsTheyAreQuartersOfTheirSizeApart) {
    world.assets.images.push_back({"puff", 8, 8, std::vector<uint8_t>(256, 255)});
    world.assets.textures.push_back({.image = 0, .isLoose = true});
    emitter = {};
    emitter.bursts = {{.seconds = 1.95, .count = 1}};
    emitter.sizeBirth = emitter.sizeDeath = 1.0;
    emitter.texture = 0;
    setTime(2.1);
    const ecs::Entity entity = addEmitter({0, 0, -10}, emitter);
    const auto countParts = [&](double metresInTheExposure) {
        world.registry.get<particles::ParticleEmitter>(entity).velocity.x =
            metresInTheExposure / 0.1;
        return extractAll().parts;
    };
    EXPECT_EQ(countParts(0.0), 1u);
    EXPECT_EQ(countParts(0.24), 1u);
    EXPECT_EQ(countParts(0.26), 2u);
    EXPECT_EQ(countParts(0.74), 3u);
    EXPECT_EQ(countParts(9.0), shader::kMaxParticleParts);
    world.registry.get<particles::ParticleEmitter>(entity).texture = scene::kNone;
    EXPECT_EQ(countParts(9.0), 1u) << "streaks need none";
}

class ParticleInstants : public ParticlesOfScenes {
  protected:
    ParticleInstants() { addEmitter({0, 0, -10}, emitter); }

    std::optional<shader::InstantSurfaces> plan(const render::OverlayLimits& limits = kLimits) {
        const extract::ExtractedFrame frame = extract();
        const scene::ExposureMotion exposure = motion();
        return planParticleInstants(
            {world, layout, request, exposure, frame}, extractAll(), limits
        );
    }

    static constexpr render::OverlayLimits kLimits{
        .instants = 15,
        .findsInstants = true,
        .surfaceBytes = std::numeric_limits<uint64_t>::max()};
};

TEST_F(ParticleInstants, InstantsCoverTheRectangleWhereMoversMeetParticles) {
    EXPECT_FALSE(plan());
    const ecs::Entity mover = addBox({0, 1, -8});
    EXPECT_FALSE(plan()) << "it does not move";
    world.registry.add(mover, scene::LinearVelocity{{2, 0, 0}});
    const auto found = plan();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->instantCount, 12u) << "as many in each part";
    EXPECT_EQ(found->partCount, shader::kMaxSurfaceParts);
    EXPECT_LT(found->sizePx.x, request.width / 2);
    EXPECT_LE(found->originPx.x + found->sizePx.x, request.width);
    EXPECT_LE(found->originPx.y + found->sizePx.y, request.height);
    world.registry.get<scene::LocalTransform>(mover).transform.translation.x = 14.0;
    EXPECT_FALSE(plan()) << "it moves next to them";
}

TEST_F(ParticleInstants, InstantsUnderAMovingCameraCoverAllParticles) {
    world.registry.add(camera, scene::LinearVelocity{{1, 0, 0}});
    const auto found = plan();
    ASSERT_TRUE(found);
    const ParticleTables particles = extractAll();
    EXPECT_EQ(found->originPx, math::uvec2(glm::floor(glm::max(particles.leastPx, 0.0))));
    world.registry.get<scene::Camera>(camera).kind = scene::CameraKind::Orthographic;
    EXPECT_FALSE(plan());
}

TEST_F(ParticleInstants, InstantsAreLimitedByTheBlendTheMethodAndTheMemory) {
    addMover({0, 1, -8}, {2, 0, 0});
    render::OverlayLimits limits = kLimits;
    limits.instants = 3;
    ASSERT_TRUE(plan(limits));
    EXPECT_EQ(plan(limits)->instantCount, 3u);
    EXPECT_EQ(plan(limits)->partCount, 3u);
    limits.surfaceBytes = 64;
    EXPECT_FALSE(plan(limits));
    limits = kLimits;
    limits.findsInstants = false;
    EXPECT_FALSE(plan(limits));
    for (auto [entity, component] : world.registry.view<particles::ParticleEmitter>())
        component.blend = particles::ParticleBlend::Add;
    ASSERT_TRUE(plan());
    EXPECT_EQ(plan()->partCount, 1u);
    EXPECT_EQ(plan()->instantCount, 15u);
}

TEST(ParticleFormulas, PlacesAgreeWithSmallStepsOfGravityAndOfAnyDrag) {
    shader::ParticleRow row{};
    row.velocityLife = vec4(3.0f, 5.0f, -1.0f, 4.0f);
    for (const double drag : {0.0, 1e-6, 0.01, 0.3, 2.0, 40.0}) {
        shader::ParticleEmitterRow emitter{};
        emitter.gravityDrag = vec4(0.5f, -9.81f, 0.0f, float(drag));
        dvec3 place(0.0);
        dvec3 velocity(row.velocityLife);
        constexpr int kSteps = 200000;
        const double step = 2.0 / kSteps;
        for (int i = 0; i < kSteps; ++i) {
            const dvec3 middle = velocity + 0.5 * step * (dvec3(0.5, -9.81, 0.0) - drag * velocity);
            velocity += step * (dvec3(0.5, -9.81, 0.0) - drag * middle);
            place += step * middle;
        }
        const vec3 computed = shader::particlePlace(row, emitter, 2.0f);
        EXPECT_LT(glm::distance(dvec3(computed), place), 2e-5 * (1.0 + glm::length(place))) << drag;
    }
    // The series of small drag meets the formula of large.
    for (const float x : {0.499999f, 0.5f}) {
        const vec2 shares = shader::dampedShares(x);
        const double first = -std::expm1(-double(x)) / double(x);
        EXPECT_NEAR(shares.x, first, 2e-7);
        EXPECT_NEAR(shares.y, (1.0 - first) / double(x), 1e-6);
    }
    EXPECT_EQ(shader::dampedShares(0.0f), vec2(1.0f, 0.5f));
}

/// Mean of the profile at many instants.
double measureStreak(const vec2& point, const vec2& way, float radius) {
    constexpr int kManyInstants = 4096;
    double sum = 0.0;
    for (int i = 0; i < kManyInstants; ++i) {
        const vec2 apart = (point - way * ((float(i) + 0.5f) / kManyInstants)) / radius;
        sum += double(shader::roundProfile(glm::dot(apart, apart)));
    }
    return sum / kManyInstants;
}

TEST(ParticleFormulas, AStreakIsTheMeanOfTheRoundParticleAtAllInstants) {
    for (const vec2& way : {vec2(0.0f), vec2(0.02f, 0.0f), vec2(3.0f, 1.0f), vec2(-20.0f, 35.0f)})
        for (const float radius : {1.0f, 2.5f, 12.0f})
            for (float y = -14.5f; y < 40.0f; y += 3.7f)
                for (float x = -30.5f; x < 16.0f; x += 2.9f) {
                    const vec2 covered = shader::streakCoverage({x, y}, way, radius);
                    EXPECT_NEAR(covered.x, measureStreak({x, y}, way, radius), 4e-5)
                        << x << ", " << y << " of " << way.x << ", " << way.y;
                    EXPECT_GE(covered.y, 0.0f);
                    EXPECT_LE(covered.y, 1.0f);
                }
}

TEST(ParticleFormulas, AParticleCoversNoPointOutsideItsPath) {
    for (const vec2& way : {vec2(3.0f, 1.0f), vec2(-20.0f, 35.0f)})
        for (float x = -30.5f; x < 16.0f; x += 2.9f) {
            const vec2 point(x, 0.7f * x + 4.0f);
            const vec2 span = shader::streakSpan(point, way, 5.0f, 5.0f);
            EXPECT_LE(0.0f, span.x);
            EXPECT_LE(span.x, span.y);
            EXPECT_LE(span.y, 1.0f);
            for (float share = 0.005f; share < 1.0f; share += 0.01f) {
                const float distance = glm::distance(point, share * way);
                if (distance < 4.99f) {
                    EXPECT_TRUE(span.x <= share && share <= span.y) << x << ", " << share;
                }
                if (span.x + 0.01f < share && share < span.y - 0.01f) {
                    EXPECT_LT(distance, 5.01f) << x << ", " << share;
                }
            }
        }
    EXPECT_EQ(shader::streakSpan({1.0f, 0.0f}, {0.001f, 0.0f}, 5.0f, 5.0f), vec2(0.0f, 1.0f));
}

TEST(ParticleFormulas, AStreakWhoseRadiusChangesIsTheMeanOfItsInstants) {
    constexpr int kManyInstants = 4096;
    for (const vec2& way : {vec2(0.0f), vec2(1.0f, 0.5f), vec2(11.0f, 0.0f), vec2(-20.0f, 35.0f)})
        for (const vec2& radii :
             {vec2(1.0f, 12.0f), vec2(12.0f, 1.0f), vec2(1.0f, 400.0f), vec2(5.0f)})
            for (float y = -14.5f; y < 40.0f; y += 3.7f)
                for (float x = -30.5f; x < 16.0f; x += 2.9f) {
                    const vec2 point(x, y);
                    double mean = 0.0;
                    for (int i = 0; i < kManyInstants; ++i) {
                        const float t = (float(i) + 0.5f) / kManyInstants;
                        const vec2 apart = (point - way * t) / glm::mix(radii.x, radii.y, t);
                        mean += double(shader::roundProfile(glm::dot(apart, apart)));
                    }
                    const vec2 span = shader::streakSpan(point, way, radii.x, radii.y);
                    double sum = 0.0;
                    for (uint32_t i = 0; span.x < span.y && i < shader::kStreakNodes; ++i) {
                        const vec2 node = shader::streakNode(span, radii.x, radii.y, i);
                        const vec2 apart =
                            (point - way * node.x) / glm::mix(radii.x, radii.y, node.x);
                        sum += double(node.y * shader::roundProfile(glm::dot(apart, apart)));
                    }
                    EXPECT_NEAR(sum, mean / kManyInstants, 3e-4)
                        << x << ", " << y << " of " << way.x << ", " << way.y << ", " << radii.y;
                }
}

TEST(ParticleFormulas, ALifeIsCutToTheExposure) {
    shader::ParticleRow row{};
    row.placeAge.w = 1.0f;
    row.velocityLife.w = 1.5f;
    shader::ParticleEmitterRow emitter{};
    emitter.secondsPerExposure = 4.0f;
    EXPECT_EQ(shader::particleLifetime(row, emitter, 1.0f, 0.0f, 1.0f), vec2(0.75f, 1.0f));
    EXPECT_EQ(shader::particleLifetime(row, emitter, 0.5f, 0.0f, 1.0f), vec2(0.25f, 0.625f));
    emitter.secondsPerExposure = 0.0f;
    EXPECT_EQ(shader::particleLifetime(row, emitter, 1.0f, 0.0f, 1.0f), vec2(0.0f, 1.0f));
    row.placeAge.w = 2.0f;
    const vec2 dead = shader::particleLifetime(row, emitter, 1.0f, 0.0f, 1.0f);
    EXPECT_GE(dead.x, dead.y);
}

} // namespace
} // namespace shutter::particles
