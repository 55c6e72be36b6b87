// SPDX-License-Identifier: MIT
#include "engine/io/gltf_animation.h"

#include "engine/io/gltf_accessor.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace shutter::io {

namespace {

constexpr int kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT;

scene::Interpolation readInterpolation(const std::string& name, const std::string& path) {
    if (name == "LINEAR")
        return scene::Interpolation::Linear;
    if (name == "STEP")
        return scene::Interpolation::Step;
    if (name == "CUBICSPLINE")
        return scene::Interpolation::CubicSpline;
    failGltf("{}.interpolation '{}' is unknown", path, name);
}

std::optional<scene::AnimationPath> readPath(const std::string& name) {
    if (name == "translation")
        return scene::AnimationPath::Translation;
    if (name == "rotation")
        return scene::AnimationPath::Rotation;
    if (name == "scale")
        return scene::AnimationPath::Scale;
    return std::nullopt;
}

std::vector<float> readTimes(GltfContext& context, int accessor, const std::string& path) {
    std::vector<float> times =
        readFloats(context, size_t(accessor), {path + ".input", {TINYGLTF_TYPE_SCALAR}, {kFloat}});
    for (size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(times[i])) {
            failGltf("{}.input: key {} is at {} s", path, i, times[i]);
        }
        if (i > 0 && times[i] < times[i - 1]) {
            failGltf("{}.input: key {} is earlier than the key before", path, i);
        }
    }
    return times;
}

/// Rotations come as x, y, z, w; the fourth component of the others stays 0.
std::vector<math::vec4>
readValues(GltfContext& context, int accessor, bool isRotation, const std::string& path) {
    const std::string use = path + ".output";
    // Integers are for rotations alone in glTF 2.0 (3.11), but a decoder that knows one knows all.
    const int type = isRotation ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3;
    const std::vector<float> numbers = readFloats(
        context,
        size_t(accessor),
        {use,
         {type},
         {kFloat,
          TINYGLTF_COMPONENT_TYPE_BYTE,
          TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
          TINYGLTF_COMPONENT_TYPE_SHORT,
          TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT},
         true}
    );
    const size_t components = isRotation ? 4 : 3;
    std::vector<math::vec4> values(numbers.size() / components, math::vec4(0.0f));
    constexpr float kMaxMagnitude = 1e30f;
    for (size_t i = 0; i < numbers.size(); ++i) {
        if (!(std::abs(numbers[i]) <= kMaxMagnitude)) {
            failGltf("{} holds {} in key value {}", use, numbers[i], i / components);
        }
        values[i / components][glm::length_t(i % components)] = numbers[i];
    }
    return values;
}

/// Of keys at the same time, which glTF does not allow but exporters write, the last one stays: it
/// is the one that the time after them starts from. Returns whether there were any.
bool removeEqualTimes(scene::AnimationChannel& channel) {
    const size_t step = channel.values.size() / channel.times.size();
    size_t kept = 0;
    for (size_t i = 0; i < channel.times.size(); ++i) {
        const bool isLastOfItsTime =
            i + 1 == channel.times.size() || channel.times[i + 1] > channel.times[i];
        if (!isLastOfItsTime)
            continue;
        channel.times[kept] = channel.times[i];
        std::copy_n(
            channel.values.begin() + std::ptrdiff_t(i * step),
            step,
            channel.values.begin() + std::ptrdiff_t(kept * step)
        );
        ++kept;
    }
    const bool isChanged = kept != channel.times.size();
    channel.times.resize(kept);
    channel.values.resize(kept * step);
    return isChanged;
}

/// Quantised quaternions are a little off unit length; a zero one turns to nowhere.
void normalizeRotations(scene::AnimationChannel& channel, const std::string& path) {
    const bool isCubic = channel.interpolation == scene::Interpolation::CubicSpline;
    const size_t step = isCubic ? 3 : 1;
    for (size_t i = isCubic ? 1 : 0; i < channel.values.size(); i += step) {
        const double length = glm::length(math::dvec4(channel.values[i]));
        if (!(length > 1e-6))
            failGltf("{}.output: rotation {} has no length", path, i);
        channel.values[i] = math::vec4(math::dvec4(channel.values[i]) / length);
    }
}

class ClipReader {
  public:
    ClipReader(GltfContext& context, size_t index)
        : mContext(context), mSource(context.model.animations[index]),
          mPath(fmt::format("animations[{}]", index)) {}

    scene::AnimationClip read() {
        mClip.name = mSource.name;
        for (size_t c = 0; c < mSource.channels.size(); ++c)
            readChannel(c);
        return std::move(mClip);
    }

  private:
    void readChannel(size_t index) {
        const tinygltf::AnimationChannel& source = mSource.channels[index];
        if (size_t(source.sampler) >= mSource.samplers.size()) {
            failGltf(
                "{}.channels[{}].sampler is {}, but there are {} samplers",
                mPath,
                index,
                source.sampler,
                mSource.samplers.size()
            );
        }
        const std::optional<scene::AnimationPath> path = readPath(source.target_path);
        if (!path) {
            mContext.warnings.add(
                source.target_path == "weights"
                    ? "morph targets are not applied yet: drawn in the rest pose"
                    : fmt::format("the animation path '{}' is ignored", source.target_path)
            );
            return;
        }
        if (source.target_node < 0)
            return; // glTF 2.0, 3.11: to be ignored
        const auto sampler = size_t(source.sampler);
        scene::AnimationChannel channel =
            readSampler(sampler, *path == scene::AnimationPath::Rotation);
        channel.node = uint32_t(source.target_node);
        channel.path = *path;
        mClip.duration = std::max(mClip.duration, double(channel.times.back()));
        mClip.channels.push_back(std::move(channel));
    }

    scene::AnimationChannel readSampler(size_t index, bool isRotation) {
        const tinygltf::AnimationSampler& source = mSource.samplers[index];
        const std::string path = fmt::format("{}.samplers[{}]", mPath, index);
        scene::AnimationChannel channel;
        channel.interpolation = readInterpolation(source.interpolation, path);
        channel.times = readTimes(mContext, source.input, path);
        channel.values = readValues(mContext, source.output, isRotation, path);
        const bool isCubic = channel.interpolation == scene::Interpolation::CubicSpline;
        const size_t expected = channel.times.size() * (isCubic ? 3 : 1);
        if (channel.values.size() != expected) {
            failGltf(
                "{} has {} values for {} keys, {} are needed",
                path,
                channel.values.size(),
                channel.times.size(),
                expected
            );
        }
        if (removeEqualTimes(channel)) {
            mContext.warnings.add(path + " has keys at equal times: the last of each is used");
        }
        if (isRotation)
            normalizeRotations(channel, path);
        return channel;
    }

    GltfContext& mContext;
    const tinygltf::Animation& mSource;
    std::string mPath;
    scene::AnimationClip mClip;
};

/// A channel drives its entity unless that one lies outside the scene or has no TRS to drive.
void addAnimated(
    GltfContext& context,
    scene::World& world,
    uint32_t clip,
    const std::vector<ecs::Entity>& entities
) {
    const std::vector<scene::AnimationChannel>& channels = world.assets.clips[clip].channels;
    for (size_t c = 0; c < channels.size(); ++c) {
        const ecs::Entity entity = entities[channels[c].node];
        if (entity == ecs::kNullEntity)
            continue;
        if (!world.registry.has<scene::LocalTransform>(entity)) {
            context.warnings.add(fmt::format(
                "nodes[{}] has a matrix that shears: its animation is ignored", channels[c].node
            ));
            continue;
        }
        auto* animated = world.registry.find<scene::Animated>(entity);
        if (!animated)
            animated = &world.registry.add<scene::Animated>(entity, {});
        animated->channels.push_back({clip, uint32_t(c)});
    }
}

} // namespace

void loadAnimations(
    GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities
) {
    for (size_t a = 0; a < context.model.animations.size(); ++a) {
        world.assets.clips.push_back(ClipReader(context, a).read());
        addAnimated(context, world, uint32_t(a), entities);
    }
    world.playback.activeClips.assign(world.assets.clips.size(), true);
}

} // namespace shutter::io
