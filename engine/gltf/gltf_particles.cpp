// SPDX-License-Identifier: MIT
// `extras.particles` of a node: an emitter (scene::ParticleEmitter).
#include "engine/core/words.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"

#include <utility>

namespace shutter::gltf {

namespace {

constexpr const char* kMember = "particles";
/// Far more than one writes by hand.
constexpr size_t kMaxEmissions = 1024;

std::string pathOf(size_t node) {
    return fmt::format("nodes[{}]", node);
}

/// Replaces the value where the object has one.
void read(const tinygltf::Value& object, const char* key, double& value, const std::string& path) {
    value = findNumber(object, key, path).value_or(value);
}

void readEmissions(
    GltfContext& context,
    const tinygltf::Value& object,
    const std::string& path,
    scene::ParticleEmitter& emitter
) {
    for (const auto& [source, at] : listObjects(object, "spans", kMaxEmissions, path)) {
        warnOfOthers(context, *source, {"fromSeconds", "untilSeconds", "perSecond"}, at);
        scene::EmissionSpan span;
        read(*source, "fromSeconds", span.fromSeconds, at);
        read(*source, "untilSeconds", span.untilSeconds, at);
        read(*source, "perSecond", span.perSecond, at);
        emitter.spans.push_back(span);
    }
    for (const auto& [source, at] : listObjects(object, "bursts", kMaxEmissions, path)) {
        warnOfOthers(context, *source, {"seconds", "count"}, at);
        scene::EmissionBurst burst;
        read(*source, "seconds", burst.seconds, at);
        burst.count = findIndex(*source, "count", at).value_or(burst.count);
        emitter.bursts.push_back(burst);
    }
}

void readColors(
    const tinygltf::Value& object, const std::string& path, scene::ParticleEmitter& emitter
) {
    if (!object.Has("colors"))
        return;
    const tinygltf::Value& array = object.Get("colors");
    const std::string at = path + ".colors";
    if (!array.IsArray() || array.ArrayLen() != emitter.colors.size())
        failGltf("{} is not an array of {} colours", at, emitter.colors.size());
    for (size_t i = 0; i < emitter.colors.size(); ++i) {
        const tinygltf::Value& color = array.Get(int(i));
        if (!color.IsArray() || color.ArrayLen() != 4)
            failGltf("{}[{}] is not an array of 4 numbers", at, i);
        for (size_t c = 0; c < 4; ++c) {
            const tinygltf::Value& number = color.Get(int(c));
            if (!number.IsNumber())
                failGltf("{}[{}] is not an array of 4 numbers", at, i);
            emitter.colors[i][glm::length_t(c)] = float(number.GetNumberAsDouble());
        }
    }
}

void readNumbers(
    const tinygltf::Value& object, const std::string& path, scene::ParticleEmitter& emitter
) {
    read(object, "lifeSeconds", emitter.lifeSeconds, path);
    read(object, "lifeSpread", emitter.lifeSpread, path);
    read(object, "coneDegrees", emitter.coneDegrees, path);
    read(object, "speedSpread", emitter.speedSpread, path);
    read(object, "inherit", emitter.inherit, path);
    read(object, "radius", emitter.radius, path);
    read(object, "drag", emitter.drag, path);
    read(object, "sizeBirth", emitter.sizeBirth, path);
    emitter.sizeDeath = emitter.sizeBirth;
    read(object, "sizeDeath", emitter.sizeDeath, path);
    read(object, "spin", emitter.spin, path);
    read(object, "softMetres", emitter.softMetres, path);
    emitter.velocity = findVec3(object, "velocity", path).value_or(emitter.velocity);
    emitter.gravity = findVec3(object, "gravity", path).value_or(emitter.gravity);
    emitter.lit = findBool(object, "lit", path).value_or(emitter.lit);
    emitter.seed = findIndex(object, "seed", path).value_or(emitter.seed);
}

} // namespace

std::optional<uint32_t> findParticleTexture(const GltfContext& context, size_t node) {
    const std::string path = pathOf(node);
    const tinygltf::Value* object = findExtra(context.model.nodes[node].extras, kMember, path);
    if (!object)
        return std::nullopt;
    const std::string at = path + ".extras." + kMember;
    const std::optional<uint32_t> index = findIndex(*object, "texture", at);
    const size_t count = context.model.textures.size();
    if (index && *index >= count)
        failGltf("{}.texture is {}, but {}", at, *index, core::thereAre(count, "texture"));
    return index;
}

std::optional<scene::ParticleEmitter> readParticles(GltfContext& context, size_t index) {
    const std::string path = pathOf(index);
    const tinygltf::Value* object = findExtra(context.model.nodes[index].extras, kMember, path);
    if (!object)
        return std::nullopt;
    const std::string at = path + ".extras." + kMember;
    warnOfOthers(
        context,
        *object,
        {"spans",       "bursts",      "lifeSeconds", "lifeSpread", "velocity",
         "coneDegrees", "speedSpread", "inherit",     "radius",     "gravity",
         "drag",        "sizeBirth",   "sizeDeath",   "spin",       "colors",
         "texture",     "blend",       "softMetres",  "lit",        "seed"},
        at
    );
    scene::ParticleEmitter emitter;
    readEmissions(context, *object, at, emitter);
    readNumbers(*object, at, emitter);
    readColors(*object, at, emitter);
    emitter.blend = static_cast<scene::ParticleBlend>(
        findName(*object, "blend", {"alpha", "add"}, at).value_or(0)
    );
    if (const auto texture = findParticleTexture(context, index))
        emitter.texture = context.particleTextures.at(*texture);
    if (const core::Status valid = scene::validateEmitter(emitter); !valid)
        failGltf("{}: {}", at, valid.error().message);
    return emitter;
}

} // namespace shutter::gltf
