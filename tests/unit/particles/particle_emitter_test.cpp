// SPDX-License-Identifier: MIT
#include "modules/particles/particle_emitter.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace shutter::particles {
namespace {

using math::dvec3;
using scene::kNan;

ParticleEmitter makeEmitter(double perSecond) {
    ParticleEmitter emitter;
    emitter.spans = {{.fromSeconds = 1.0, .untilSeconds = 3.0, .perSecond = perSecond}};
    emitter.lifeSeconds = 0.5;
    emitter.lifeSpread = 0.5;
    emitter.velocity = dvec3(0.0, 2.0, 0.0);
    emitter.coneDegrees = 30.0;
    emitter.speedSpread = 0.25;
    emitter.radius = 0.1;
    emitter.spin = 3.0;
    return emitter;
}

std::vector<ParticleBirth> list(const ParticleEmitter& emitter, double open, double close) {
    auto living = listLiving(emitter, open, close);
    EXPECT_TRUE(living.ok());
    return living.ok() ? std::move(living).value() : std::vector<ParticleBirth>{};
}

bool isSame(const ParticleBirth& a, const ParticleBirth& b) {
    return a.seconds == b.seconds && a.lifeSeconds == b.lifeSeconds && a.place == b.place &&
           a.velocity == b.velocity && a.angle == b.angle && a.spin == b.spin;
}

bool lives(const ParticleBirth& birth, double seconds) {
    return birth.seconds <= seconds && seconds < birth.seconds + birth.lifeSeconds;
}

TEST(ParticleEmission, LivingParticlesAreThoseOfAllBirthsAliveAtThatTime) {
    const ParticleEmitter emitter = makeEmitter(200.0);
    const auto all = list(emitter, -10.0, 10.0);
    ASSERT_EQ(all.size(), 400u);
    for (double seconds = 0.5; seconds < 4.0; seconds += 0.0625) {
        std::vector<ParticleBirth> expected;
        std::copy_if(all.begin(), all.end(), std::back_inserter(expected), [&](const auto& birth) {
            return lives(birth, seconds);
        });
        const auto living = list(emitter, seconds, seconds);
        ASSERT_EQ(living.size(), expected.size()) << seconds;
        EXPECT_TRUE(std::equal(living.begin(), living.end(), expected.begin(), isSame)) << seconds;
    }
}

TEST(ParticleEmission, BirthsLieInTheirSpanAndNothingIsBornOrDiesTwice) {
    const auto all = list(makeEmitter(64.0), -10.0, 10.0);
    ASSERT_EQ(all.size(), 128u);
    for (size_t i = 0; i < all.size(); ++i) {
        EXPECT_GE(all[i].seconds, 1.0 + double(i) / 64.0);
        EXPECT_LT(all[i].seconds, 1.0 + double(i + 1) / 64.0);
        EXPECT_GE(all[i].lifeSeconds, 0.25);
        EXPECT_LE(all[i].lifeSeconds, 0.75);
        EXPECT_LE(glm::length(all[i].place), 0.1);
        const double speed = glm::length(all[i].velocity);
        EXPECT_GE(speed, 1.5 - 1e-12);
        EXPECT_LE(speed, 2.5 + 1e-12);
        EXPECT_GE(all[i].velocity.y / speed, std::cos(glm::radians(30.0)) - 1e-12);
        EXPECT_LE(std::abs(all[i].spin), 3.0);
    }
}

TEST(ParticleEmission, ALifeHoldsItsFirstInstantAndNotItsLast) {
    ParticleEmitter emitter;
    emitter.bursts = {{.seconds = 1.0, .count = 3}};
    emitter.lifeSeconds = 0.5;
    EXPECT_EQ(list(emitter, 0.999, 0.999).size(), 0u);
    EXPECT_EQ(list(emitter, 1.0, 1.0).size(), 3u);
    EXPECT_EQ(list(emitter, 1.5, 1.5).size(), 0u);
    EXPECT_EQ(list(emitter, 1.499, 1.499).size(), 3u);
    EXPECT_EQ(list(emitter, 0.9, 1.0).size(), 3u);
    EXPECT_EQ(list(emitter, 1.5, 1.6).size(), 0u);
    EXPECT_EQ(list(emitter, 0.0, 5.0).size(), 3u) << "born and dead within";
    EXPECT_TRUE(list(makeEmitter(0.0), 2.0, 2.0).empty()) << "a rate of 0 emits nothing";
    EXPECT_TRUE(list(ParticleEmitter{}, 2.0, 2.0).empty());
}

TEST(ParticleEmission, ParticleSpacingAfterTenHoursIsThatAtFirst) {
    ParticleEmitter emitter = makeEmitter(1000.0);
    emitter.spans = {{.fromSeconds = 0.0, .untilSeconds = 1e6, .perSecond = 1000.0}};
    emitter.lifeSpread = 0.0;
    const auto late = list(emitter, 36000.0, 36000.0);
    EXPECT_NEAR(double(late.size()), 500.0, 2.0);
    for (size_t i = 1; i < late.size(); ++i) {
        EXPECT_GT(late[i].seconds, late[i - 1].seconds - 1e-9);
        EXPECT_LT(late[i].seconds, late[i - 1].seconds + 0.002);
    }
}

TEST(ParticleEmission, SpansAndBurstsThatComeOrGoChangeNoOther) {
    ParticleEmitter emitter = makeEmitter(50.0);
    const auto alone = list(emitter, 2.0, 2.0);
    emitter.spans.insert(emitter.spans.begin(), {0.0, 0.5, 50.0});
    emitter.bursts = {{.seconds = 1.0, .count = 10}}; // when the span begins, and dead by then
    EXPECT_EQ(list(emitter, 2.0, 2.0).size(), alone.size());
    const auto later = list(emitter, 2.0, 2.0);
    EXPECT_TRUE(std::equal(later.begin(), later.end(), alone.begin(), isSame));
    emitter.spans.erase(emitter.spans.begin());
    const auto first = list(emitter, 1.0, 1.0);
    EXPECT_EQ(first.size(), 10u + list(makeEmitter(50.0), 1.0, 1.0).size());
    emitter.seed = 1;
    ASSERT_FALSE(alone.empty());
    for (const ParticleBirth& other : list(emitter, 2.0, 2.0))
        for (const ParticleBirth& one : alone)
            EXPECT_FALSE(one.place == other.place) << "another seed gives other particles";
}

TEST(ParticleEmission, ACountThatNoPictureShowsIsRefusedWithoutBeingListed) {
    ParticleEmitter emitter = makeEmitter(1e6);
    emitter.lifeSeconds = 1e4;
    ASSERT_TRUE(validateEmitter(emitter).ok());
    emitter.spans = {{.fromSeconds = 0.0, .untilSeconds = 1e9, .perSecond = 1e6}};
    const auto late = listLiving(emitter, 1e5, 1e5);
    ASSERT_FALSE(late.ok());
    EXPECT_NE(late.error().message.find("too many"), std::string::npos) << late.error().message;
}

TEST(ParticleEmission, BadValuesAreRefusedByName) {
    const auto expectRefused = [](const std::string& part, auto&& change) {
        ParticleEmitter emitter = makeEmitter(10.0);
        emitter.bursts = {{.seconds = 1.0, .count = 1}};
        ASSERT_TRUE(validateEmitter(emitter).ok());
        change(emitter);
        const core::Status valid = validateEmitter(emitter);
        ASSERT_FALSE(valid.ok()) << part;
        EXPECT_NE(valid.error().message.find(part), std::string::npos) << valid.error().message;
    };
    for (const double bad : {0.0, -1.0, 1e5, kNan})
        expectRefused("lifeSeconds", [&](auto& e) { e.lifeSeconds = bad; });
    for (const double bad : {-0.1, 1.0, kNan})
        expectRefused("lifeSpread", [&](auto& e) { e.lifeSpread = bad; });
    for (const double bad : {-1.0, 2e6, kNan})
        expectRefused("spans[0].perSecond", [&](auto& e) { e.spans[0].perSecond = bad; });
    for (const double bad : {1.0, -2.0, kNan})
        expectRefused("spans[0].untilSeconds", [&](auto& e) { e.spans[0].untilSeconds = bad; });
    expectRefused("spans[0].fromSeconds", [&](auto& e) { e.spans[0].fromSeconds = kNan; });
    expectRefused("spans[1] begins", [](auto& e) { e.spans.push_back(e.spans[0]); });
    expectRefused("bursts[1] comes", [](auto& e) { e.bursts.push_back(e.bursts[0]); });
    expectRefused("bursts[0].seconds", [&](auto& e) { e.bursts[0].seconds = kNan; });
    expectRefused("bursts[0].count", [](auto& e) { e.bursts[0].count = 65537; });
    expectRefused("velocity", [&](auto& e) { e.velocity.z = kNan; });
    expectRefused("gravity", [](auto& e) { e.gravity.y = -1e7; });
    expectRefused("coneDegrees", [](auto& e) { e.coneDegrees = 181.0; });
    expectRefused("speedSpread", [](auto& e) { e.speedSpread = 1.5; });
    expectRefused("inherit", [&](auto& e) { e.inherit = kNan; });
    expectRefused("radius", [](auto& e) { e.radius = -1.0; });
    expectRefused("drag", [](auto& e) { e.drag = -1.0; });
    expectRefused("sizeBirth", [&](auto& e) { e.sizeBirth = kNan; });
    expectRefused("sizeDeath", [](auto& e) { e.sizeDeath = -0.1; });
    expectRefused("spin", [](auto& e) { e.spin = -1.0; });
    expectRefused("softMetres", [&](auto& e) { e.softMetres = kNan; });
    expectRefused("colors[1]", [](auto& e) { e.colors[1].r = 1001.0f; });
    expectRefused("colors[2]", [](auto& e) { e.colors[2].a = 1.5f; });
}

} // namespace
} // namespace shutter::particles
