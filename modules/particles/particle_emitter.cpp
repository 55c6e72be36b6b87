// SPDX-License-Identifier: MIT
#include "modules/particles/particle_emitter.h"

#include "engine/math/bounds.h"
#include "engine/scene/recorded_motion.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace shutter::particles {

namespace {

using math::dvec3;
using math::isWithin;

constexpr double kMaxSeconds = 1.0e9;
constexpr double kMaxRate = 1.0e6;
constexpr double kMaxLife = 1.0e4;
constexpr double kMaxMagnitude = 1.0e6;
constexpr double kMaxShare = 10.0;
constexpr double kMaxPerSecond = 1.0e4; ///< of drag and spin
constexpr float kMaxBrightness = 1000.0f;

/// Written so that NaN is not within.
bool isWithin(double value, double low, double high) {
    return value >= low && value <= high;
}

core::Status validateSpans(const std::vector<EmissionSpan>& spans) {
    for (size_t i = 0; i < spans.size(); ++i) {
        const EmissionSpan& span = spans[i];
        if (!isWithin(span.fromSeconds, -kMaxSeconds, kMaxSeconds))
            return core::makeError(
                "spans[{}].fromSeconds is {}, not within 1e9 seconds", i, span.fromSeconds
            );
        if (!isWithin(span.untilSeconds, -kMaxSeconds, kMaxSeconds) ||
            !(span.untilSeconds > span.fromSeconds))
            return core::makeError(
                "spans[{}].untilSeconds is {}, not after {} and within 1e9 seconds",
                i,
                span.untilSeconds,
                span.fromSeconds
            );
        if (!isWithin(span.perSecond, 0.0, kMaxRate))
            return core::makeError("spans[{}].perSecond is {}, not in [0, 1e6]", i, span.perSecond);
        for (size_t j = 0; j < i; ++j)
            if (spans[j].fromSeconds == span.fromSeconds)
                return core::makeError("spans[{}] begins when spans[{}] does", i, j);
    }
    return {};
}

core::Status validateBursts(const std::vector<EmissionBurst>& bursts) {
    for (size_t i = 0; i < bursts.size(); ++i) {
        if (!isWithin(bursts[i].seconds, -kMaxSeconds, kMaxSeconds))
            return core::makeError(
                "bursts[{}].seconds is {}, not within 1e9", i, bursts[i].seconds
            );
        if (bursts[i].count > kMaxParticles)
            return core::makeError(
                "bursts[{}].count is {}, above {}", i, bursts[i].count, kMaxParticles
            );
        for (size_t j = 0; j < i; ++j)
            if (bursts[j].seconds == bursts[i].seconds)
                return core::makeError("bursts[{}] comes when bursts[{}] does", i, j);
    }
    return {};
}

core::Status validateColors(const std::array<math::vec4, 3>& colors) {
    for (size_t i = 0; i < colors.size(); ++i) {
        const math::vec4& color = colors[i];
        for (int c = 0; c < 3; ++c)
            if (!(color[c] >= 0.0f && color[c] <= kMaxBrightness))
                return core::makeError("colors[{}] holds {}, not in [0, 1000]", i, color[c]);
        if (!(color.a >= 0.0f && color.a <= 1.0f))
            return core::makeError("colors[{}] has the opacity {}, not in [0, 1]", i, color.a);
    }
    return {};
}

core::Status validateNumbers(const ParticleEmitter& emitter) {
    struct Range {
        const char* name;
        double value;
        double low;
        double high;
    };

    for (const Range& range :
         {Range{"coneDegrees", emitter.coneDegrees, 0.0, 180.0},
          Range{"speedSpread", emitter.speedSpread, 0.0, 1.0},
          Range{"inherit", emitter.inherit, -kMaxShare, kMaxShare},
          Range{"radius", emitter.radius, 0.0, kMaxMagnitude},
          Range{"drag", emitter.drag, 0.0, kMaxPerSecond},
          Range{"sizeBirth", emitter.sizeBirth, 0.0, kMaxMagnitude},
          Range{"sizeDeath", emitter.sizeDeath, 0.0, kMaxMagnitude},
          Range{"spin", emitter.spin, 0.0, kMaxPerSecond},
          Range{"softMetres", emitter.softMetres, 0.0, kMaxMagnitude}})
        if (!isWithin(range.value, range.low, range.high))
            return core::makeError(
                "{} is {}, not in [{}, {}]", range.name, range.value, range.low, range.high
            );
    if (!(emitter.lifeSeconds > 0.0 && emitter.lifeSeconds <= kMaxLife))
        return core::makeError("lifeSeconds is {}, not in (0, 10000]", emitter.lifeSeconds);
    if (!(emitter.lifeSpread >= 0.0 && emitter.lifeSpread < 1.0))
        return core::makeError("lifeSpread is {}, not in [0, 1)", emitter.lifeSpread);
    if (!isWithin(emitter.velocity, kMaxMagnitude))
        return core::makeError("velocity is not within 1e6 m/s");
    if (!isWithin(emitter.gravity, kMaxMagnitude))
        return core::makeError("gravity is not within 1e6 m/s^2");
    return {};
}

/// SplitMix64's finaliser (Steele, Lea and Flood 2014): every bit of the sum changes half of the
/// result's.
uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

/// The random numbers of one particle: a hash of the seed, of what emits it, and of its index
/// there.
class Dice {
  public:
    Dice(uint32_t seed, uint64_t source, uint64_t index)
        : mState(mix(mix(mix(seed + kStep) + source) + index * kStep)) {}

    /// [0, 1).
    double roll() {
        mState += kStep;
        return static_cast<double>(mix(mState) >> 11) * 0x1.0p-53;
    }

    /// [-1, 1).
    double rollSigned() { return 2.0 * roll() - 1.0; }

  private:
    static constexpr uint64_t kStep = 0x9E3779B97F4A7C15u;
    uint64_t mState;
};

/// Evenly over the directions that lie within the cone about `axis`, which is unit.
dvec3 rollDirection(Dice& dice, const dvec3& axis, double coneDegrees) {
    const double cosine = 1.0 - dice.roll() * (1.0 - std::cos(glm::radians(coneDegrees)));
    const double azimuth = glm::two_pi<double>() * dice.roll();
    if (coneDegrees == 0.0)
        return axis;
    const dvec3 sideways = std::abs(axis.x) < 0.7 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
    const dvec3 x = glm::normalize(glm::cross(axis, sideways));
    const dvec3 y = glm::cross(axis, x);
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    return axis * cosine + (x * std::cos(azimuth) + y * std::sin(azimuth)) * sine;
}

/// Evenly in a ball.
dvec3 rollPlace(Dice& dice, double radius) {
    const double height = dice.rollSigned();
    const double azimuth = glm::two_pi<double>() * dice.roll();
    const double distance = radius * std::cbrt(dice.roll());
    const double across = std::sqrt(std::max(1.0 - height * height, 0.0));
    return distance * dvec3(across * std::cos(azimuth), across * std::sin(azimuth), height);
}

class Lister {
  public:
    Lister(const ParticleEmitter& emitter, double open, double close)
        : mEmitter(emitter), mOpen(open), mClose(close), mSpeed(glm::length(emitter.velocity)),
          mAxis(mSpeed > 0.0 ? emitter.velocity / mSpeed : dvec3(0.0, 1.0, 0.0)) {}

    /// \return false: there are too many to test
    bool add(const EmissionSpan& span) {
        if (!(span.perSecond > 0.0))
            return true;
        const double oldest = mOpen - findLongestLife(mEmitter);
        const double last = std::min(mClose, span.untilSeconds);
        if (last < span.fromSeconds || span.untilSeconds < oldest)
            return true;
        // One more on either side because of rounding: each is tested individually.
        const double first =
            std::max(std::floor((oldest - span.fromSeconds) * span.perSecond) - 1.0, 0.0);
        const double end = std::floor((last - span.fromSeconds) * span.perSecond) + 2.0;
        if (!(end - first <= kMaxLooks))
            return false;
        const auto source = std::bit_cast<uint64_t>(span.fromSeconds);
        for (auto i = static_cast<uint64_t>(first); i < static_cast<uint64_t>(end); ++i) {
            Dice dice(mEmitter.seed, source, i);
            const double share = static_cast<double>(i) + dice.roll();
            const double seconds = span.fromSeconds + share / span.perSecond;
            if (seconds < span.untilSeconds)
                addBirth(seconds, dice);
        }
        return true;
    }

    void add(const EmissionBurst& burst) {
        if (burst.seconds > mClose || burst.seconds + findLongestLife(mEmitter) < mOpen)
            return;
        const uint64_t source = ~std::bit_cast<uint64_t>(burst.seconds); // not a span's
        for (uint64_t i = 0; i < burst.count; ++i) {
            Dice dice(mEmitter.seed, source, i);
            (void)dice.roll();
            addBirth(burst.seconds, dice);
        }
    }

    [[nodiscard]] std::vector<ParticleBirth> take() { return std::move(mLiving); }

  private:
    /// With any spread, at least half of the tested particles are alive.
    static constexpr double kMaxLooks = 4.0 * kMaxParticles;

    void addBirth(double seconds, Dice& dice) {
        ParticleBirth birth;
        birth.seconds = seconds;
        birth.lifeSeconds = mEmitter.lifeSeconds * (1.0 + mEmitter.lifeSpread * dice.rollSigned());
        if (seconds > mClose || seconds + birth.lifeSeconds <= mOpen)
            return;
        birth.place = rollPlace(dice, mEmitter.radius);
        const dvec3 direction = rollDirection(dice, mAxis, mEmitter.coneDegrees);
        birth.velocity = direction * (mSpeed * (1.0 + mEmitter.speedSpread * dice.rollSigned()));
        birth.angle = glm::two_pi<double>() * dice.roll();
        birth.spin = mEmitter.spin * dice.rollSigned();
        mLiving.push_back(birth);
    }

    const ParticleEmitter& mEmitter;
    double mOpen;
    double mClose;
    double mSpeed;
    dvec3 mAxis; ///< unit
    std::vector<ParticleBirth> mLiving;
};

} // namespace

core::Status validateEmitter(const ParticleEmitter& emitter) {
    SHUTTER_TRY(validateSpans(emitter.spans));
    SHUTTER_TRY(validateBursts(emitter.bursts));
    SHUTTER_TRY(validateNumbers(emitter));
    return validateColors(emitter.colors);
}

void addEmitter(ecs::Registry& registry, ecs::Entity entity, ParticleEmitter emitter) {
    registry.add(entity, scene::NeedsPast{findLongestLife(emitter)});
    registry.add(entity, std::move(emitter));
}

double findLongestLife(const ParticleEmitter& emitter) {
    return emitter.lifeSeconds * (1.0 + emitter.lifeSpread);
}

core::Result<std::vector<ParticleBirth>>
listLiving(const ParticleEmitter& emitter, double open, double close) {
    Lister lister(emitter, open, close);
    for (const EmissionSpan& span : emitter.spans)
        if (!lister.add(span))
            return core::makeError(
                "{} particles a second that live up to {} s are too many: a picture shows {}",
                span.perSecond,
                findLongestLife(emitter),
                kMaxParticles
            );
    for (const EmissionBurst& burst : emitter.bursts)
        lister.add(burst);
    return lister.take();
}

} // namespace shutter::particles
