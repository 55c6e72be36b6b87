// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace shutter::gltf {

namespace {

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
    std::vector<float> times = readFloats(
        context, size_t(accessor), {path + ".input", {TINYGLTF_TYPE_SCALAR}, {kFloat32}}
    );
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

/// The output of a sampler, checked to be finite.
std::vector<float>
readNumbers(GltfContext& context, int accessor, int type, const std::string& path) {
    const std::string use = path + ".output";
    // glTF 2.0 (3.11) allows integers only for rotations and weights; accepting them for all paths
    // costs nothing.
    std::vector<float> numbers = readFloats(
        context, size_t(accessor), {use, {type}, {kFloat32, kInt8, kUint8, kInt16, kUint16}, true}
    );
    const size_t components = componentCount(context.model.accessors[size_t(accessor)]);
    for (size_t i = 0; i < numbers.size(); ++i) {
        if (!(std::abs(numbers[i]) <= float(kMaxMagnitude))) {
            failGltf("{} holds {} in key value {}", use, numbers[i], i / components);
        }
    }
    return numbers;
}

/// Rotations are x, y, z, w; translations and scales leave the fourth component at 0.
std::vector<math::vec4>
readValues(GltfContext& context, int accessor, bool isRotation, const std::string& path) {
    const int type = isRotation ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3;
    const std::vector<float> numbers = readNumbers(context, accessor, type, path);
    if (isRotation)
        return toVectors<math::vec4>(numbers);
    std::vector<math::vec4> values;
    for (const math::vec3& value : toVectors<math::vec3>(numbers))
        values.emplace_back(value, 0.0f);
    return values;
}

/// Keeps only the last of several keys at the same time, because interpolation starts from it. glTF
/// does not allow such keys, but exporters write them. Returns true when any key was removed.
/// \param channel AnimationChannel or WeightChannel
template <class Channel> bool removeEqualTimes(Channel& channel) {
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

/// Restores the unit length that quantization loses. Throws GltfError for a zero quaternion, unless
/// it `mayBeZero`: it then turns nothing. Returns true where there was one.
bool normalizeRotations(scene::AnimationChannel& channel, bool mayBeZero, const std::string& path) {
    bool hasZero = false;
    const bool isCubic = channel.interpolation == scene::Interpolation::CubicSpline;
    const size_t step = isCubic ? 3 : 1;
    for (size_t i = isCubic ? 1 : 0; i < channel.values.size(); i += step) {
        const double length = glm::length(math::dvec4(channel.values[i]));
        if (mayBeZero && length == 0.0) {
            channel.values[i] = math::vec4(0.0f, 0.0f, 0.0f, 1.0f);
            hasZero = true;
            continue;
        }
        if (!(length > 1e-6))
            failGltf("{}.output: rotation {} has no length", path, i);
        channel.values[i] = math::vec4(math::dvec4(channel.values[i]) / length);
    }
    return hasZero;
}

class ClipReader {
  public:
    ClipReader(GltfContext& context, const scene::Assets& assets, size_t index)
        : mContext(context), mAssets(assets), mSource(context.model.animations[index]),
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
                "{}.channels[{}].sampler is {}, but {}",
                mPath,
                index,
                source.sampler,
                core::thereAre(mSource.samplers.size(), "sampler")
            );
        }
        const std::optional<scene::AnimationPath> path = readPath(source.target_path);
        const bool isWeights = source.target_path == "weights";
        if (!path && !isWeights) {
            mContext.warnings.add(
                fmt::format("the animation path '{}' is ignored", source.target_path)
            );
            return;
        }
        if (source.target_node < 0)
            return; // must be ignored (glTF 2.0, 3.11)
        if (isWeights)
            readWeights(source);
        else
            readTransform(source, *path);
    }

    void readTransform(const tinygltf::AnimationChannel& source, scene::AnimationPath path) {
        const bool isRotation = path == scene::AnimationPath::Rotation;
        const tinygltf::AnimationSampler& sampler = mSource.samplers[size_t(source.sampler)];
        const std::string at = samplerPath(source);
        scene::AnimationChannel channel;
        channel.node = uint32_t(source.target_node);
        channel.path = path;
        channel.interpolation = readInterpolation(sampler.interpolation, at);
        channel.times = readTimes(mContext, sampler.input, at);
        channel.values = readValues(mContext, sampler.output, isRotation, at);
        finishKeys(channel, 1, at);
        const bool mayBeZero = lacksView(mContext.model, size_t(sampler.output));
        if (isRotation && normalizeRotations(channel, mayBeZero, at))
            mContext.warnings.add(at + ".output has no bufferView: its zeros turn nothing");
        mClip.channels.push_back(std::move(channel));
    }

    void readWeights(const tinygltf::AnimationChannel& source) {
        const int mesh = mContext.model.nodes[size_t(source.target_node)].mesh;
        const size_t targetCount = mesh < 0 ? 0 : mAssets.meshes[size_t(mesh)].morphWeights.size();
        if (targetCount == 0) {
            mContext.warnings.add(fmt::format(
                "{} drives the weights of nodes[{}], which has no morph targets: ignored",
                mPath,
                source.target_node
            ));
            return;
        }
        const tinygltf::AnimationSampler& sampler = mSource.samplers[size_t(source.sampler)];
        const std::string at = samplerPath(source);
        scene::WeightChannel channel;
        channel.node = uint32_t(source.target_node);
        channel.targetCount = uint32_t(targetCount);
        channel.interpolation = readInterpolation(sampler.interpolation, at);
        channel.times = readTimes(mContext, sampler.input, at);
        channel.values = readNumbers(mContext, sampler.output, TINYGLTF_TYPE_SCALAR, at);
        finishKeys(channel, targetCount, at);
        mClip.weightChannels.push_back(std::move(channel));
    }

    [[nodiscard]] std::string samplerPath(const tinygltf::AnimationChannel& source) const {
        return fmt::format("{}.samplers[{}]", mPath, source.sampler);
    }

    /// \param valueCount values per key, without tangents
    template <class Channel>
    void finishKeys(Channel& channel, size_t valueCount, const std::string& path) {
        const bool isCubic = channel.interpolation == scene::Interpolation::CubicSpline;
        const size_t expected = channel.times.size() * valueCount * (isCubic ? 3 : 1);
        if (channel.values.size() != expected) {
            failGltf(
                "{} has {} for {}, not {}",
                path,
                core::countOf(channel.values.size(), "value"),
                core::countOf(channel.times.size(), "key"),
                expected
            );
        }
        if (removeEqualTimes(channel)) {
            mContext.warnings.add(path + " has keys at equal times: the last of each is used");
        }
        mClip.duration = std::max(mClip.duration, double(channel.times.back()));
    }

    GltfContext& mContext;
    const scene::Assets& mAssets;
    const tinygltf::Animation& mSource;
    std::string mPath;
    scene::AnimationClip mClip;
};

/// Connects channels to the entities that they drive; entities outside the scene are skipped, and
/// so are, with a warning, those without translation, rotation and scale.
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

/// Connects weight channels to the entities that they morph. Nodes outside the scene, joints
/// included, draw nothing.
void addMorphed(scene::World& world, uint32_t clip, const std::vector<ecs::Entity>& entities) {
    const std::vector<scene::WeightChannel>& channels = world.assets.clips[clip].weightChannels;
    for (size_t c = 0; c < channels.size(); ++c) {
        const ecs::Entity entity = entities[channels[c].node];
        auto* morph =
            entity == ecs::kNullEntity ? nullptr : world.registry.find<scene::MorphWeights>(entity);
        if (morph)
            morph->channels.push_back({clip, uint32_t(c)});
    }
}

} // namespace

void loadAnimations(
    GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities
) {
    for (size_t a = 0; a < context.model.animations.size(); ++a) {
        world.assets.clips.push_back(ClipReader(context, world.assets, a).read());
        addAnimated(context, world, uint32_t(a), entities);
        addMorphed(world, uint32_t(a), entities);
    }
    world.playback.activeClips.assign(world.assets.clips.size(), true);
}

} // namespace shutter::gltf
