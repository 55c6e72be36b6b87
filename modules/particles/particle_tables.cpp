// SPDX-License-Identifier: MIT
#include "modules/particles/particle_tables.h"

#include "engine/scene/clip_jumps.h"
#include "engine/scene/motion.h"
#include "modules/particles/particle_emitter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <ranges>
#include <string>
#include <utility>

namespace shutter::particles {

namespace {

using math::dmat3;
using math::dmat4;
using math::dvec3;

/// Steps of the exposure between which the camera is taken to go straight: as far as a mover's
/// vertices go between shutter open and close, divided by eight.
constexpr uint32_t kMovingCameras = 9;
/// With those on either side of jumps.
constexpr size_t kMaxCameras = 64;

/// What additive light may add up to without the picture's own: half floats end at 65504.
constexpr double kSafeSum = 30000.0;

/// The entity's name or number, for messages.
std::string describeEntity(const scene::World& world, ecs::Entity entity) {
    const auto* name = world.registry.find<scene::Name>(entity);
    return name ? fmt::format("'{}'", name->value) : fmt::format("{}", entity);
}

/// How an emitter's own time runs, which the artist's scales stretch away from the raster instant
/// (exposure_motion.h).
struct OwnTime {
    double raster = 0.0; ///< seconds, at the frame's raster instant
    double speed = 1.0;

    [[nodiscard]] double at(double seconds) const {
        return speed == 1.0 ? seconds : raster + speed * (seconds - raster);
    }
};

/// When an entity came to be: nothing of it is older.
double findBeginning(const scene::World& world, ecs::Entity entity) {
    double beginning = -std::numeric_limits<double>::infinity();
    (void)scene::findUpwards(world, entity, [&](ecs::Entity at) {
        if (const auto* appeared = world.registry.find<scene::Appeared>(at))
            beginning = std::max(beginning, appeared->seconds);
        return false;
    });
    return beginning;
}

/// Places the births of one emitter in the world.
class BirthPlace {
  public:
    BirthPlace(const scene::World& world, ecs::Entity entity, double inherit)
        : mWorld(world), mEntity(entity), mInherit(inherit) {
        if (!scene::mayMove(world, entity))
            mAlways = scene::worldFromEntity(world, entity, 0.0);
    }

    struct Placed {
        dvec3 place{0.0};
        dvec3 velocity{0.0};
    };

    /// Nothing: the entity is scaled to a point, which is how clips hide one.
    [[nodiscard]] std::optional<Placed> place(const ParticleBirth& birth) const {
        const dmat4 matrix =
            mAlways ? *mAlways : scene::worldFromEntity(mWorld, mEntity, birth.seconds);
        const dmat3 turned(matrix);
        if (turned == dmat3(0.0))
            return std::nullopt;
        Placed placed;
        placed.place = dvec3(matrix * math::dvec4(birth.place, 1.0));
        placed.velocity = turned * birth.velocity;
        if (!mAlways && mInherit != 0.0)
            placed.velocity += mInherit * velocityAt(birth.seconds);
        return placed;
    }

  private:
    /// The entity's velocity, m/s: a difference over kStep. A jump nearer than that shortens the
    /// step; right after a jump, the step ends before it. Recorded motion ends at the birth, so the
    /// step lies before it.
    [[nodiscard]] dvec3 velocityAt(double seconds) const {
        constexpr double kStep = 1.0e-3;
        constexpr double kLongestJump = 0.25 * kStep;
        constexpr double kShortest = 1.0e-6;
        double from = seconds - kStep;
        double to = seconds;
        const auto jumps =
            scene::findPlaceJumps(mWorld, mEntity, {seconds - 2.0 * kStep, seconds}, kLongestJump);
        for (auto jump = jumps.rbegin(); jump != jumps.rend() && jump->after > from; ++jump) {
            from = std::max(from, jump->after);
            if (to - from >= kShortest)
                break;
            to = std::min(to, jump->before);
            from = to - kStep;
        }
        if (!(to - from >= kShortest))
            return dvec3(0.0);
        return dvec3(
                   scene::worldFromEntity(mWorld, mEntity, to)[3] -
                   scene::worldFromEntity(mWorld, mEntity, from)[3]
               ) /
               (to - from);
    }

    const scene::World& mWorld;
    ecs::Entity mEntity;
    double mInherit;
    std::optional<dmat4> mAlways; ///< nothing: it moves
};

bool isFinite(const dvec3& value) {
    return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z);
}

/// A row and where it belongs among the others.
struct SortedRow {
    uint64_t key = 0; ///< rises from far to near; of equals, in the order of their emission
    shader::ParticleRow row{};
};

/// Bits whose order is that of the numbers.
uint32_t orderedBits(float value) {
    uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

class Extraction {
  public:
    Extraction(
        const scene::World& world,
        const extract::ViewRequest& request,
        const extract::FrameView& view,
        ParticleTime time
    )
        : mWorld(world), mRequest(request), mView(view), mMotion(view.motion()),
          mEye(view.matrices().eye), mForward(view.constants().forward) {
        mTables.isInstant = time == ParticleTime::Instant || request.instant.has_value();
        const double raster = view.times().raster;
        mTables.rasterTime = static_cast<float>(raster);
        mFirst = mTables.isInstant ? raster : 0.0;
        mLast = mTables.isInstant ? raster : 1.0;
    }

    core::Status add(ecs::Entity entity, const ParticleEmitter& emitter) {
        SHUTTER_TRY(check(entity, emitter));
        if (mMotion.isHidden(entity))
            return {};
        const scene::ExposureInterval& exposure = mMotion.exposure();
        const OwnTime own{exposure.frame().raster, mMotion.speedOf(entity)};
        auto living = listLiving(emitter, own.at(secondsAt(mFirst)), own.at(secondsAt(mLast)));
        if (!living)
            return core::makeError(
                "emitter {}: {}", describeEntity(mWorld, entity), living.error().message
            );
        if (living.value().empty())
            return {};
        const auto index = static_cast<uint32_t>(mTables.emitters.size());
        mTables.emitters.push_back(makeEmitterRow(entity, emitter, own));
        const double beginning = findBeginning(mWorld, entity);
        const double raster = own.at(secondsAt(mView.times().raster));
        const BirthPlace births(mWorld, entity, emitter.inherit);
        for (const ParticleBirth& birth : living.value())
            if (birth.seconds >= beginning)
                if (const auto placed = births.place(birth))
                    addRow(birth, *placed, raster, index);
        if (mRows.size() > kMaxParticles)
            return core::makeError(
                "more than {} particles live at {} s, with those of emitter {}: emit fewer",
                kMaxParticles,
                exposure.raster,
                describeEntity(mWorld, entity)
            );
        return {};
    }

    ParticleTables finish() {
        std::sort(mRows.begin(), mRows.end(), [](const SortedRow& a, const SortedRow& b) {
            return a.key < b.key;
        });
        mTables.rows.reserve(mRows.size());
        for (const SortedRow& sorted : mRows)
            mTables.rows.push_back(sorted.row);
        if (!mTables.empty())
            addCameras();
        if (!mTables.isInstant)
            measureCourses();
        mTables.mayOverflow = mBrightest > kSafeSum;
        return std::move(mTables);
    }

  private:
    core::Status check(ecs::Entity entity, const ParticleEmitter& emitter) const {
        if (const core::Status valid = validateEmitter(emitter); !valid)
            return core::makeError(
                "emitter {}: {}", describeEntity(mWorld, entity), valid.error().message
            );
        const std::vector<scene::Texture>& textures = mWorld.assets.textures;
        if (emitter.texture != scene::kNone &&
            (emitter.texture >= textures.size() || !textures[emitter.texture].isLoose))
            return core::makeError(
                "emitter {}: texture {} is none that particles show",
                describeEntity(mWorld, entity),
                emitter.texture
            );
        return {};
    }

    [[nodiscard]] double secondsAt(double s) const {
        const scene::ExposureInterval& exposure = mMotion.exposure();
        return s == exposure.rasterTime ? exposure.raster : exposure.at(s);
    }

    shader::ParticleEmitterRow
    makeEmitterRow(ecs::Entity entity, const ParticleEmitter& emitter, const OwnTime& own) const {
        const scene::ExposureInterval& exposure = mMotion.exposure();
        shader::ParticleEmitterRow row{};
        row.gravityDrag = math::vec4(math::vec3(emitter.gravity), float(emitter.drag));
        for (size_t i = 0; i < emitter.colors.size(); ++i)
            row.colors[i] = emitter.colors[i];
        row.sizes = {float(emitter.sizeBirth), float(emitter.sizeDeath)};
        row.softMetres = float(emitter.softMetres);
        row.secondsPerExposure = float(own.speed * (exposure.close - exposure.open));
        const double camera = exposure.cap.camera;
        const double screen = scene::findBlurScale(mWorld, entity) * exposure.cap.of(entity);
        row.cameraShare = camera > 0.0 ? float(screen / camera) : 1.0f;
        row.texture = shader::kNoParticleTexture;
        if (emitter.texture != scene::kNone) {
            const scene::Texture& texture = mWorld.assets.textures[emitter.texture];
            const scene::TextureImage& image = mWorld.assets.images[texture.image];
            row.texture = emitter.texture;
            row.textureTexels = float(std::max(image.width, image.height));
        }
        row.flags = (emitter.blend == ParticleBlend::Add ? shader::kParticleAdd : 0u) |
                    (emitter.lit ? shader::kParticleLit : 0u);
        return row;
    }

    void addRow(
        const ParticleBirth& birth,
        const BirthPlace::Placed& placed,
        double rasterSeconds,
        uint32_t emitter
    ) {
        if (!isFinite(placed.place) || !isFinite(placed.velocity))
            return; // as an entity whose transform is not finite has no row
        const shader::ParticleEmitterRow& emitterRow = mTables.emitters[emitter];
        SortedRow sorted;
        shader::ParticleRow& row = sorted.row;
        row.placeAge =
            math::vec4(math::vec3(placed.place - mEye), float(rasterSeconds - birth.seconds));
        row.velocityLife = math::vec4(math::vec3(placed.velocity), float(birth.lifeSeconds));
        row.angle = float(birth.angle);
        row.spin = float(birth.spin);
        row.emitter = emitter;
        const float age = std::clamp(row.placeAge.w, 0.0f, row.velocityLife.w);
        const math::vec3 place = shader::particlePlace(row, emitterRow, age);
        const float depth = glm::dot(place, math::vec3(mForward));
        sorted.key = uint64_t(~orderedBits(depth)) << 32 | uint32_t(mRows.size());
        if ((emitterRow.flags & shader::kParticleAdd) == 0)
            mTables.hides = true;
        else
            for (const math::vec4& color : emitterRow.colors)
                mBrightest += double(color.a) * double(std::max({color.r, color.g, color.b})) / 3.0;
        mRows.push_back(sorted);
    }

    void addCameras() {
        const auto& camera = mWorld.registry.get<scene::Camera>(mRequest.camera);
        for (const double s : listCameraTimes()) {
            const auto [worldFromView, clipFromView] = placeCamera(mMotion, camera, mRequest, s);
            // A difference of eyes, so that it is exact far from the world's origin.
            const dmat4 viewFromRelWorld =
                dmat4(dmat3(glm::inverse(worldFromView))) *
                glm::translate(dmat4(1.0), mEye - dvec3(worldFromView[3]));
            mTables.cameras.push_back({math::mat4(clipFromView * viewFromRelWorld), float(s)});
        }
    }

    /// Shutter times between which the camera is taken to go straight; rising.
    [[nodiscard]] std::vector<double> listCameraTimes() const {
        const double raster = mView.times().raster;
        if (mTables.isInstant || !mView.moves())
            return {raster};
        double first = 0.0;
        double last = 1.0;
        for (const shader::ParticleEmitterRow& emitter : mTables.emitters) {
            first = std::min(first, raster - double{emitter.cameraShare} * raster);
            last = std::max(last, raster + double{emitter.cameraShare} * (1.0 - raster));
        }
        std::vector<double> times;
        for (uint32_t i = 0; i < kMovingCameras; ++i)
            times.push_back(first + (last - first) * i / (kMovingCameras - 1));
        const scene::ExposureInterval& exposure = mMotion.exposure();
        const double length = exposure.close - exposure.open;
        const auto jumps = scene::findPlaceJumps(
            mWorld, mRequest.camera, mMotion.reach(), length / (kMovingCameras - 1)
        );
        const double middle = exposure.frame().raster;
        for (const double speed : mMotion.cameraSpeeds())
            for (const scene::Jump& jump : jumps)
                for (const double seconds : {jump.before, jump.after}) {
                    const double s = (middle + (seconds - middle) / speed - exposure.open) / length;
                    if (s > first && s < last && times.size() < kMaxCameras)
                        times.push_back(s);
                }
        std::sort(times.begin(), times.end());
        return times;
    }

    /// Where a particle is seen at shutter time s: pixels, and its radius; nothing: behind the
    /// camera.
    [[nodiscard]] std::optional<math::vec3> see(const shader::ParticleRow& row, float s) const {
        const shader::ParticleEmitterRow& emitter = mTables.emitters[row.emitter];
        const float age = shader::particleAge(row, emitter, s, mTables.rasterTime);
        const float step = mTables.rasterTime + emitter.cameraShare * (s - mTables.rasterTime);
        const math::mat4& camera =
            std::ranges::min_element(mTables.cameras, {}, [step](const auto& one) {
                return std::abs(one.s - step);
            })->clipFromRelWorld;
        const math::vec4 clip = camera * math::vec4(shader::particlePlace(row, emitter, age), 1.0f);
        if (!(clip.w > mForward.w))
            return std::nullopt;
        const math::vec2 half = 0.5f * math::vec2(float(mRequest.width), float(mRequest.height));
        const float scale = glm::length(math::vec3(camera[0][0], camera[1][0], camera[2][0]));
        const float radius =
            0.5f * shader::particleSize(row, emitter, age) * scale / clip.w * half.x;
        return math::vec3(math::vec2(clip) / clip.w * half, radius);
    }

    /// What a particle does during the exposure, pixels.
    struct Course {
        float way = 0.0f;
        float growth = 0.0f; ///< of its radius, either way
        float turn = 0.0f;   ///< of its picture's rim
        float radius = 0.0f; ///< the largest
    };

    /// Where it is seen; takes it into the tables' box.
    [[nodiscard]] std::optional<Course> measureCourse(const shader::ParticleRow& row) {
        const shader::ParticleEmitterRow& emitter = mTables.emitters[row.emitter];
        const math::vec2 alive =
            shader::particleLifetime(row, emitter, mTables.rasterTime, 0.0f, 1.0f);
        if (!(alive.x < alive.y))
            return std::nullopt;
        const math::vec2 half(float(mRequest.width) / 2.0f, float(mRequest.height) / 2.0f);
        const std::array seen{
            see(row, alive.x), see(row, 0.5f * (alive.x + alive.y)), see(row, alive.y)};
        if (!seen[0] || !seen[1] || !seen[2]) {
            // What crosses the camera's plane may be anywhere before that.
            if (seen[0] || seen[1] || seen[2])
                addToBox(-half, half);
            return std::nullopt;
        }
        math::vec2 least = math::vec2(*seen[0]);
        math::vec2 most = least;
        Course course;
        for (const auto& at : seen) {
            least = glm::min(least, math::vec2(*at));
            most = glm::max(most, math::vec2(*at));
            course.radius = std::max(course.radius, at->z);
        }
        for (const size_t i : {0, 1}) {
            course.way += glm::distance(math::vec2(*seen[i]), math::vec2(*seen[i + 1]));
            course.growth += std::abs(seen[i + 1]->z - seen[i]->z);
        }
        if (emitter.texture != shader::kNoParticleTexture)
            course.turn = std::abs(row.spin * emitter.secondsPerExposure) * (alive.y - alive.x) *
                          std::max(course.radius, shader::kMinParticleRadiusPx);
        // Corners of pictures, and the curve of the path between the three places.
        const math::vec2 aside(
            1.5f * std::max(course.radius, shader::kMinParticleRadiusPx) + 0.5f * course.way
        );
        least -= aside;
        most += aside;
        if (!(course.radius > 0.0f) || glm::any(glm::greaterThan(least, half)) ||
            glm::any(glm::lessThan(most, -half)))
            return std::nullopt;
        addToBox(least, most);
        return course;
    }

    /// Whether it comes, goes or changes its colour within the exposure.
    [[nodiscard]] bool isFleeting(const shader::ParticleRow& row) const {
        constexpr float kNoticeable = 0.1f;
        const shader::ParticleEmitterRow& emitter = mTables.emitters[row.emitter];
        if (!(emitter.secondsPerExposure > 0.0f))
            return false;
        const math::vec2 alive =
            shader::particleLifetime(row, emitter, mTables.rasterTime, 0.0f, 1.0f);
        if (alive.x > 0.0f || alive.y < 1.0f)
            return true;
        const auto colorAt = [&](float s) {
            return shader::particleColor(
                row, emitter, shader::particleAge(row, emitter, s, mTables.rasterTime)
            );
        };
        const math::vec4 open = colorAt(0.0f);
        const math::vec4 middle = colorAt(0.5f);
        const math::vec4 close = colorAt(1.0f);
        const math::vec4 change = glm::max(glm::abs(middle - open), glm::abs(close - middle));
        return glm::any(glm::greaterThan(change, kNoticeable * glm::max(open, close)));
    }

    /// \param least, most pixels from the picture's centre
    void addToBox(const math::vec2& least, const math::vec2& most) {
        const math::dvec2 half(mRequest.width / 2.0, mRequest.height / 2.0);
        mTables.leastPx = glm::min(mTables.leastPx, math::dvec2(least) + half);
        mTables.mostPx = glm::max(mTables.mostPx, math::dvec2(most) + half);
    }

    /// As many parts as the fastest picture needs instants, which are a quarter of its size apart.
    void measureCourses() {
        float most = 1.0f;
        for (const shader::ParticleRow& row : mTables.rows) {
            const auto course = measureCourse(row);
            if (!course)
                continue;
            const float longest = course->way + course->growth + course->turn;
            mTables.longestWayPx = std::max(mTables.longestWayPx, longest);
            mTables.areFleeting = mTables.areFleeting || isFleeting(row);
            if (mTables.emitters[row.emitter].texture == shader::kNoParticleTexture)
                continue;
            const float radius = std::max(course->radius, shader::kMinParticleRadiusPx);
            most = std::max(most, std::ceil(longest / (0.5f * radius)));
        }
        mTables.parts = uint32_t(std::min(most, float(shader::kMaxParticleParts)));
    }

    const scene::World& mWorld;
    const extract::ViewRequest& mRequest;
    const extract::FrameView& mView;
    const scene::ExposureMotion& mMotion;
    dvec3 mEye;
    math::vec4 mForward;
    double mFirst = 0.0; ///< shutter times
    double mLast = 1.0;
    double mBrightest = 0.0;
    std::vector<SortedRow> mRows;
    ParticleTables mTables;
};

} // namespace

core::Result<ParticleTables> extractParticles(
    const scene::World& world,
    const extract::ViewRequest& request,
    const extract::FrameView& view,
    ParticleTime time
) {
    Extraction extraction(world, request, view, time);
    for (auto [entity, emitter] : world.registry.view<ParticleEmitter>())
        SHUTTER_TRY(extraction.add(entity, emitter));
    return extraction.finish();
}

} // namespace shutter::particles
