// SPDX-License-Identifier: MIT
#include "engine/scene/deformation.h"

#include "engine/core/check.h"
#include "engine/math/transform.h"
#include "engine/scene/animation.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace shutter::scene {

using math::dmat4;
using math::dvec3;

namespace {

/// The channel that drives the weights, of several the one of the latest active clip.
const Animated::Channel* findDriver(const World& world, const MorphWeights& morph) {
    const Animated::Channel* driver = nullptr;
    for (const Animated::Channel& channel : morph.channels)
        if (isActive(world.playback, channel.clip) && (!driver || channel.clip >= driver->clip))
            driver = &channel;
    return driver;
}

std::vector<double> weightsAt(const World& world, const MorphWeights& morph, double seconds) {
    const Animated::Channel* driver = findDriver(world, morph);
    if (!driver)
        return {morph.weights.begin(), morph.weights.end()};
    const AnimationClip& clip = world.assets.clips.at(driver->clip);
    const WeightChannel& channel = clip.weightChannels.at(driver->channel);
    SHUTTER_CHECK_EQ(size_t{channel.targetCount}, morph.weights.size());
    return sampleWeights(channel, clipSeconds(clip, world.playback.loop, seconds));
}

/// A skinned entity's own transform has no meaning.
bool wavesInWorld(const World& world, ecs::Entity entity, const VertexWaves& waves) {
    return waves.inWorld && !world.registry.has<Skinned>(entity);
}

} // namespace

bool isDeformable(const World& world, ecs::Entity entity) {
    return world.registry.has<Skinned>(entity) || world.registry.has<MorphWeights>(entity) ||
           world.registry.has<VertexWaves>(entity);
}

bool mayDeform(const World& world, ecs::Entity entity) {
    if (const auto* skinned = world.registry.find<Skinned>(entity))
        for (const ecs::Entity joint : skinned->joints)
            if (mayMove(world, joint))
                return true;
    if (const auto* waves = world.registry.find<VertexWaves>(entity))
        if (isRunning(*waves) || (wavesInWorld(world, entity, *waves) && mayMove(world, entity)))
            return true;
    const auto* morph = world.registry.find<MorphWeights>(entity);
    return morph && findDriver(world, *morph) != nullptr;
}

dmat4 worldFromObject(const World& world, ecs::Entity entity, double seconds) {
    const auto* skinned = world.registry.find<Skinned>(entity);
    if (!skinned)
        return worldFromEntity(world, entity, seconds);
    SHUTTER_CHECK(!skinned->joints.empty(), "{} has a skin without joints", entity);
    const dmat4 joint = worldFromEntity(world, skinned->joints.front(), seconds);
    // A first joint that deforms nothing need not be finite; the world's origin is used then.
    return math::isFinite(joint) ? glm::translate(dmat4(1.0), dvec3(joint[3])) : dmat4(1.0);
}

bool mayObjectMove(const World& world, ecs::Entity entity) {
    const auto* skinned = world.registry.find<Skinned>(entity);
    return mayMove(world, skinned ? skinned->joints.front() : entity);
}

Deformation deformationAt(const World& world, ecs::Entity entity, double seconds) {
    Deformation result;
    if (const auto* skinned = world.registry.find<Skinned>(entity)) {
        const Skin& skin = world.assets.skins.at(skinned->skin);
        SHUTTER_CHECK_EQ(skin.jointFromBind.size(), skinned->joints.size());
        const dvec3 origin(worldFromObject(world, entity, seconds)[3]);
        for (size_t i = 0; i < skinned->joints.size(); ++i) {
            dmat4 objectFromJoint = worldFromEntity(world, skinned->joints[i], seconds);
            objectFromJoint[3] -= math::dvec4(origin, 0.0);
            result.objectFromBind.push_back(objectFromJoint * skin.jointFromBind[i]);
        }
    }
    if (const auto* morph = world.registry.find<MorphWeights>(entity))
        result.morphWeights = weightsAt(world, *morph, seconds);
    if (const auto* waves = world.registry.find<VertexWaves>(entity))
        result.waves = wavesInWorld(world, entity, *waves)
                           ? poseWaves(*waves, seconds, worldFromEntity(world, entity, seconds))
                           : poseWaves(*waves, seconds);
    return result;
}

dmat4 objectFromBind(const World& world, ecs::Entity entity, size_t joint, double seconds) {
    const auto& skinned = world.registry.get<Skinned>(entity);
    const dvec3 origin(worldFromObject(world, entity, seconds)[3]);
    dmat4 objectFromJoint = worldFromEntity(world, skinned.joints.at(joint), seconds);
    objectFromJoint[3] -= math::dvec4(origin, 0.0);
    return objectFromJoint * world.assets.skins.at(skinned.skin).jointFromBind.at(joint);
}

std::vector<double> sampleWeights(const WeightChannel& channel, double seconds) {
    const size_t keyCount = channel.times.size();
    const size_t targets = channel.targetCount;
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    SHUTTER_CHECK(keyCount > 0, "the weights of node {} have no keys", channel.node);
    SHUTTER_CHECK_EQ(channel.values.size(), keyCount * targets * (cubic ? 3 : 1));

    // Which: 0 in-tangent, 1 value, 2 out-tangent.
    const auto valueAt = [&](size_t key, size_t which, size_t target) {
        return double{channel.values[((cubic ? 3 * key + which : key) * targets) + target]};
    };
    size_t key = 0;
    double share = 0.0;
    // Written so that NaN falls to the first key.
    if (seconds >= double{channel.times.back()}) {
        key = keyCount - 1;
    } else if (seconds > double{channel.times.front()}) {
        const auto next = std::upper_bound(channel.times.begin(), channel.times.end(), seconds);
        key = static_cast<size_t>(std::distance(channel.times.begin(), next)) - 1;
        share = (seconds - double{channel.times[key]}) /
                (double{channel.times[key + 1]} - double{channel.times[key]});
    }
    std::vector<double> result;
    for (size_t target = 0; target < targets; ++target) {
        const double from = valueAt(key, 1, target);
        if (share == 0.0 || channel.interpolation == Interpolation::Step) {
            result.push_back(from);
            continue;
        }
        const double to = valueAt(key + 1, 1, target);
        if (!cubic) {
            result.push_back(std::lerp(from, to, share));
            continue;
        }
        const double interval = double{channel.times[key + 1]} - double{channel.times[key]};
        result.push_back(interpolateHermite<double>(
            {from, interval * valueAt(key, 2, target), to, interval * valueAt(key + 1, 0, target)},
            share
        ));
    }
    return result;
}

} // namespace shutter::scene
