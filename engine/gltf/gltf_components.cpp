// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "engine/scene/vertex_waves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shutter::gltf {

namespace {

/// Beyond this distance a single-precision projection matrix has no precision left.
constexpr double kMaxDistance = 1e30;

constexpr const char* kFocusNode = "focusNode";
constexpr const char* kFocusHalfLife = "focusHalfLife";

void expectRange(double value, double low, double high, const std::string& path) {
    if (!(value > low && value < high)) {
        failGltf("{} is {}, not between {} and {}", path, value, low, high);
    }
}

scene::Camera readPerspective(const tinygltf::PerspectiveCamera& source, const std::string& path) {
    expectRange(source.yfov, 0.0, std::numbers::pi, path + ".perspective.yfov");
    expectRange(source.znear, 0.0, kMaxDistance, path + ".perspective.znear");
    scene::Camera camera;
    camera.kind = scene::CameraKind::Perspective;
    camera.yFov = source.yfov;
    camera.near = source.znear;
    // tinygltf stores 0 for a missing one.
    if (source.aspectRatio != 0.0) {
        expectRange(source.aspectRatio, 0.0, kMaxDistance, path + ".perspective.aspectRatio");
        camera.aspectRatio = source.aspectRatio;
    }
    return camera;
}

/// Half an extent. It should not be negative, but may (glTF 2.0, camera.orthographic).
double readMagnification(double value, const std::string& path) {
    if (!(value != 0.0 && std::abs(value) < kMaxDistance))
        failGltf("{} is {}, it must not be 0 and must lie below 1e30", path, value);
    return value;
}

scene::Camera
readOrthographic(const tinygltf::OrthographicCamera& source, const std::string& path) {
    const std::string at = path + ".orthographic";
    if (!(source.znear >= 0.0))
        failGltf("{}.znear is {}, below 0", at, source.znear);
    expectRange(source.zfar, source.znear, kMaxDistance, at + ".zfar");
    scene::Camera camera;
    camera.kind = scene::CameraKind::Orthographic;
    camera.xMag = readMagnification(source.xmag, at + ".xmag");
    camera.yMag = readMagnification(source.ymag, at + ".ymag");
    camera.near = source.znear;
    camera.far = source.zfar;
    return camera;
}

scene::LightKind readLightKind(const std::string& type, const std::string& path) {
    if (type == "directional")
        return scene::LightKind::Directional;
    if (type == "point")
        return scene::LightKind::Point;
    if (type == "spot")
        return scene::LightKind::Spot;
    failGltf("{}.type '{}' is unknown", path, type);
}

void readCone(const tinygltf::SpotLight& spot, const std::string& path, scene::Light& light) {
    // KHR_lights_punctual requires 0 <= inner < outer <= pi / 2; files may round pi / 2 up.
    const bool isValid = spot.innerConeAngle >= 0.0 && spot.innerConeAngle < spot.outerConeAngle &&
                         spot.outerConeAngle <= std::numbers::pi / 2.0 + 1e-6;
    if (!isValid) {
        failGltf(
            "{}.spot has the cone angles {} and {}, but 0 <= inner < outer <= pi/2 is needed",
            path,
            spot.innerConeAngle,
            spot.outerConeAngle
        );
    }
    light.innerConeAngle = float(spot.innerConeAngle);
    light.outerConeAngle = float(spot.outerConeAngle);
}

std::vector<scene::VertexWave>
readWaves(GltfContext& context, const tinygltf::Value& object, const std::string& path) {
    std::vector<scene::VertexWave> waves;
    if (!object.Has("waves"))
        return waves;
    const tinygltf::Value& array = object.Get("waves");
    if (!array.IsArray())
        failGltf("{}.waves is not an array", path);
    if (array.ArrayLen() > scene::kMaxVertexWaves)
        failGltf("{}.waves has {} waves, above {}", path, array.ArrayLen(), scene::kMaxVertexWaves);
    for (size_t i = 0; i < array.ArrayLen(); ++i) {
        const tinygltf::Value& source = array.Get(int(i));
        const std::string at = fmt::format("{}.waves[{}]", path, i);
        if (!source.IsObject())
            failGltf("{} is not an object", at);
        warnOfOthers(context, source, {"displacement", "waveVector", "hertz", "phase"}, at);
        scene::VertexWave wave;
        wave.displacement = findVec3(source, "displacement", at).value_or(wave.displacement);
        wave.waveVector = findVec3(source, "waveVector", at).value_or(wave.waveVector);
        wave.hertz = findNumber(source, "hertz", at).value_or(wave.hertz);
        wave.phase = findNumber(source, "phase", at).value_or(wave.phase);
        waves.push_back(wave);
    }
    return waves;
}

ecs::Entity findFocusNode(
    const GltfContext& context,
    const std::vector<ecs::Entity>& entities,
    const std::string& name,
    const std::string& path
) {
    ecs::Entity found = ecs::kNullEntity;
    for (size_t n = 0; n < entities.size(); ++n) {
        if (entities[n] == ecs::kNullEntity || context.model.nodes[n].name != name)
            continue;
        if (found != ecs::kNullEntity)
            failGltf("{} '{}' is the name of several nodes", path, name);
        found = entities[n];
    }
    if (found == ecs::kNullEntity)
        failGltf("{} '{}' is the name of no node of the scene", path, name);
    return found;
}

std::optional<scene::AutoFocus>
readAutoFocus(GltfContext& context, size_t index, const std::vector<ecs::Entity>& entities) {
    const std::string path = fmt::format("cameras[{}]", index);
    const tinygltf::Value* object = findExtra(context.model.cameras[index].extras, "lens", path);
    if (!object)
        return std::nullopt;
    const std::string at = path + ".extras.lens";
    scene::AutoFocus focus;
    focus.halfLife = findNumber(*object, kFocusHalfLife, at).value_or(focus.halfLife);
    if (!scene::validateAutoFocus(focus))
        failGltf("{}.{} is {}, it must lie in [0, 1000]", at, kFocusHalfLife, focus.halfLife);
    if (!object->Has(kFocusNode)) {
        if (object->Has(kFocusHalfLife))
            failGltf("{}.{} needs a {}", at, kFocusHalfLife, kFocusNode);
        return std::nullopt;
    }
    const std::string member = fmt::format("{}.{}", at, kFocusNode);
    if (!object->Get(kFocusNode).IsString())
        failGltf("{} is not a string", member);
    focus.target =
        findFocusNode(context, entities, object->Get(kFocusNode).Get<std::string>(), member);
    return focus;
}

} // namespace

void addAutoFocus(
    GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities
) {
    for (size_t n = 0; n < entities.size(); ++n) {
        const int camera = context.model.nodes[n].camera;
        if (camera < 0 || entities[n] == ecs::kNullEntity ||
            !world.registry.has<scene::CameraLens>(entities[n]))
            continue;
        if (const auto focus = readAutoFocus(context, size_t(camera), entities))
            world.registry.add(entities[n], *focus);
    }
}

scene::Camera readCamera(const GltfContext& context, size_t index) {
    const tinygltf::Camera& source = context.model.cameras[index];
    const std::string path = fmt::format("cameras[{}]", index);
    scene::Camera camera;
    if (source.type == "perspective")
        camera = readPerspective(source.perspective, path);
    else if (source.type == "orthographic")
        camera = readOrthographic(source.orthographic, path);
    else
        failGltf("{}.type '{}' is unknown", path, source.type);
    camera.name = source.name;
    return camera;
}

std::optional<scene::CameraLens> readLens(GltfContext& context, size_t index) {
    const std::string path = fmt::format("cameras[{}]", index);
    const tinygltf::Value* object = findExtra(context.model.cameras[index].extras, "lens", path);
    if (!object)
        return std::nullopt;
    const std::string at = path + ".extras.lens";
    warnOfOthers(
        context,
        *object,
        {"fStop",
         "focusDistance",
         "sensorHeight",
         "blades",
         "bladeRotation",
         "roundness",
         "squeeze",
         "blurScale",
         kFocusNode,
         kFocusHalfLife},
        at
    );
    scene::CameraLens lens;
    lens.fStop = findNumber(*object, "fStop", at).value_or(lens.fStop);
    lens.focusDistance = findNumber(*object, "focusDistance", at).value_or(lens.focusDistance);
    lens.sensorHeight = findNumber(*object, "sensorHeight", at).value_or(lens.sensorHeight);
    lens.blades = findIndex(*object, "blades", at).value_or(lens.blades);
    lens.bladeRotation = findNumber(*object, "bladeRotation", at).value_or(lens.bladeRotation);
    lens.roundness = findNumber(*object, "roundness", at).value_or(lens.roundness);
    lens.squeeze = findNumber(*object, "squeeze", at).value_or(lens.squeeze);
    lens.blurScale = findNumber(*object, "blurScale", at).value_or(lens.blurScale);
    if (const core::Status valid = scene::validate(lens, at + "."); !valid)
        failGltf("{}", valid.error().message);
    return lens;
}

scene::Light readLight(const GltfContext& context, size_t index) {
    const tinygltf::Light& source = context.model.lights[index];
    const std::string path = fmt::format("KHR_lights_punctual.lights[{}]", index);
    scene::Light light;
    light.kind = readLightKind(source.type, path);
    if (!source.color.empty() && source.color.size() != 3) {
        failGltf("{}.color has {}, not 3", path, core::countOf(source.color.size(), "number"));
    }
    constexpr double kMaxIntensity = 1e30;
    for (size_t i = 0; i < source.color.size(); ++i) {
        if (!(source.color[i] >= 0.0 && source.color[i] <= kMaxIntensity)) {
            failGltf("{}.color holds {}, not between 0 and 1e30", path, source.color[i]);
        }
        light.color[glm::length_t(i)] = float(source.color[i]);
    }
    if (!(source.intensity >= 0.0 && source.intensity <= kMaxIntensity)) {
        failGltf("{}.intensity is {}, not between 0 and 1e30", path, source.intensity);
    }
    light.intensity = float(source.intensity);
    if (source.range < 0.0)
        failGltf("{}.range is {}, below 0", path, source.range);
    // tinygltf stores 0 for a missing range, which means unlimited.
    const bool hasRange = source.range > 0.0 && light.kind != scene::LightKind::Directional;
    if (hasRange)
        light.range = float(source.range);
    if (light.kind == scene::LightKind::Spot)
        readCone(source.spot, path, light);
    return light;
}

std::optional<scene::MotionBlur>
readMotionBlur(GltfContext& context, const tinygltf::Node& node, const std::string& path) {
    const tinygltf::Value* object = findExtra(node.extras, "motionBlur", path);
    if (!object)
        return std::nullopt;
    const std::string at = path + ".extras.motionBlur";
    warnOfOthers(context, *object, {"scale", "exclude"}, at);
    scene::MotionBlur blur;
    blur.scale = findNumber(*object, "scale", at).value_or(blur.scale);
    if (!(blur.scale >= 0.0 && blur.scale <= 2.0))
        failGltf("{}.scale is {}, it must lie in [0, 2]", at, blur.scale);
    blur.exclude = findBool(*object, "exclude", at).value_or(blur.exclude);
    return blur;
}

std::optional<scene::VertexWaves>
readVertexWaves(GltfContext& context, const tinygltf::Node& node, const std::string& path) {
    const tinygltf::Value* object = findExtra(node.extras, "vertexWaves", path);
    if (!object)
        return std::nullopt;
    const std::string at = path + ".extras.vertexWaves";
    warnOfOthers(
        context,
        *object,
        {"waves", "lean", "space", "share", "axis", "heldAt", "freeAt", "channel", "exponent"},
        at
    );
    scene::VertexWaves waves;
    waves.waves = readWaves(context, *object, at);
    waves.lean = findVec3(*object, "lean", at).value_or(waves.lean);
    waves.inWorld = findName(*object, "space", {"object", "world"}, at).value_or(0) == 1;
    waves.share = static_cast<scene::WaveShare>(
        findName(*object, "share", {"all", "height", "color"}, at).value_or(0)
    );
    waves.axis = findVec3(*object, "axis", at).value_or(waves.axis);
    waves.heldAt = findNumber(*object, "heldAt", at).value_or(waves.heldAt);
    waves.freeAt = findNumber(*object, "freeAt", at).value_or(waves.freeAt);
    waves.channel = findIndex(*object, "channel", at).value_or(waves.channel);
    waves.exponent = findNumber(*object, "exponent", at).value_or(waves.exponent);
    if (const core::Status valid = scene::validateWaves(waves); !valid)
        failGltf("{}: {}", at, valid.error().message);
    return waves;
}

} // namespace shutter::gltf
