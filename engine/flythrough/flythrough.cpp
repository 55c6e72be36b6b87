// SPDX-License-Identifier: MIT
#include "engine/flythrough/flythrough.h"

#include "engine/core/check.h"
#include "engine/json/json_rows.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/shutter.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <utility>

namespace shutter::flythrough {

namespace {

using nlohmann::ordered_json;

constexpr size_t kMaxKeys = 100'000;
constexpr json::JsonRange kTimes{.min = -1.0e6, .max = 1.0e6};
constexpr json::JsonRange kPlaces{.min = -1.0e9, .max = 1.0e9};
constexpr json::JsonRange kFieldsOfView{.min = 0.01, .max = 179.0};
constexpr json::JsonRange kFocusDistances{.min = 1.0e-4, .max = 1.0e9};
constexpr json::JsonRange kFStops{.min = 0.01, .max = 1.0e9};
constexpr json::JsonRange kTimeScales{.min = 0.001, .max = 1000.0};
constexpr json::JsonRange kRates{.min = 0.0, .max = 1000.0, .isAboveMin = true};
/// Tolerance of a rotation's length, whose components a file may have rounded.
constexpr double kUnitTolerance = 1.0e-3;

constexpr std::array<std::pair<std::string_view, scene::PathInterpolation>, 2> kInterpolations{
    {{"catmullRom", scene::PathInterpolation::CatmullRom},
     {"linear", scene::PathInterpolation::Linear}}};
constexpr std::array<std::pair<std::string_view, scene::PathEase>, 2> kEases{
    {{"none", scene::PathEase::None}, {"inOut", scene::PathEase::InOut}}};

template <class Value, size_t Count>
std::string_view
findName(const std::array<std::pair<std::string_view, Value>, Count>& names, Value value) {
    for (const auto& [name, named] : names)
        if (named == value)
            return name;
    SHUTTER_CHECK(false, "there is no word for {}", int(value));
    return {};
}

math::dvec3 readVector(const json::JsonNode& node) {
    const auto numbers = node.readNumbers<3>(kPlaces);
    return {numbers[0], numbers[1], numbers[2]};
}

math::dquat readRotation(const json::JsonNode& node) {
    const auto [x, y, z, w] = node.readNumbers<4>({.min = -1.001, .max = 1.001});
    const math::dquat rotation(w, x, y, z);
    if (!(std::abs(glm::length(rotation) - 1.0) < kUnitTolerance))
        node.fail("must be of length 1 (x, y, z, w), not {}", glm::length(rotation));
    return rotation;
}

ordered_json describeRate(const core::FrameRate& rate) {
    return rate.denominator == 1.0 ? ordered_json(rate.numerator) : ordered_json(describe(rate));
}

FlythroughShutter readShutter(const json::JsonNode& node) {
    FlythroughShutter shutter;
    const json::JsonObject object = node.readObject({"exposure", "shutterAngle", "phase"});
    const auto exposure = object.find("exposure");
    const auto angle = object.find("shutterAngle");
    const auto read = [](const json::JsonNode& field, std::string_view row) {
        scene::CameraShutter given;
        json::readRow(field, core::getRow(scene::listShutterRows(), row), given);
        return given;
    };
    if (exposure)
        shutter.exposureSeconds = read(*exposure, "exposureSeconds").exposureSeconds;
    if (angle)
        shutter.angleDegrees = read(*angle, "angleDegrees").angleDegrees;
    if (const auto phase = object.find("phase"))
        shutter.phase = read(*phase, "phase").phase;
    if (exposure && angle)
        node.fail("exposure and shutterAngle exclude each other");
    if (!exposure && !angle && !shutter.phase)
        node.fail("has none of exposure, shutterAngle, phase");
    return shutter;
}

/// Checks a field that either all keys have or none. \param first the first key's
void expectAsInFirst(
    const json::JsonNode& node,
    std::string_view name,
    const std::optional<double>& first,
    const std::optional<double>& own
) {
    if (first.has_value() != own.has_value())
        node.fail(
            "must have {}{}, as the first key has {}",
            first ? "" : "no ",
            name,
            first ? "one" : "none"
        );
}

/// \param first the first key; null while that key itself is read
FlythroughKey
readKey(const json::JsonNode& node, const FlythroughKey* first, const FlythroughKey* before) {
    FlythroughKey key;
    const json::JsonObject object = node.readObject(
        {"time",
         "position",
         "lookAt",
         "rotation",
         "fieldOfView",
         "focusDistance",
         "fStop",
         "shutter",
         "timeScale",
         "cut"}
    );
    const json::JsonNode time = object.require("time");
    key.seconds = time.readNumber(kTimes);
    if (before && !(key.seconds > before->seconds))
        time.fail("must come after the key before, at {} s", before->seconds);
    key.position = readVector(object.require("position"));
    if (const auto lookAt = object.find("lookAt"))
        key.lookAt = readVector(*lookAt);
    if (const auto rotation = object.find("rotation"))
        key.rotation = readRotation(*rotation);
    if (const auto fieldOfView = object.find("fieldOfView"))
        key.fieldOfView = fieldOfView->readNumber(kFieldsOfView);
    if (const auto focusDistance = object.find("focusDistance"))
        key.focusDistance = focusDistance->readNumber(kFocusDistances);
    if (const auto fStop = object.find("fStop"))
        key.fStop = fStop->readNumber(kFStops);
    if (const auto shutter = object.find("shutter"))
        key.shutter = readShutter(*shutter);
    if (const auto timeScale = object.find("timeScale"))
        key.timeScale = timeScale->readNumber(kTimeScales);
    if (const auto cut = object.find("cut"))
        key.cut = cut->readBoolean();
    if (key.lookAt.has_value() == key.rotation.has_value())
        node.fail("must have either lookAt or rotation");
    if (first && first->lookAt.has_value() != key.lookAt.has_value())
        node.fail("must have {} as the first key has", first->lookAt ? "lookAt" : "rotation");
    if (first) {
        expectAsInFirst(node, "fieldOfView", first->fieldOfView, key.fieldOfView);
        expectAsInFirst(node, "focusDistance", first->focusDistance, key.focusDistance);
        expectAsInFirst(node, "fStop", first->fStop, key.fStop);
    }
    return key;
}

Flythrough readRoot(const json::JsonNode& root) {
    Flythrough flythrough;
    const json::JsonObject object =
        root.readObject({"$schema", "version", "name", "fps", "interpolation", "ease", "up", "keys"}
        );
    if (const auto schema = object.find("$schema"))
        (void)schema->readString(); // used by editors only
    (void)object.require("version").readInteger(1, 1);
    if (const auto name = object.find("name"))
        flythrough.name = name->readString(256);
    if (const auto fps = object.find("fps"))
        flythrough.fps = json::readRate(*fps, kRates);
    if (const auto interpolation = object.find("interpolation"))
        flythrough.interpolation = interpolation->readChoice(kInterpolations);
    if (const auto ease = object.find("ease"))
        flythrough.ease = ease->readChoice(kEases);
    if (const auto up = object.find("up")) {
        flythrough.up = readVector(*up);
        if (!(glm::length(flythrough.up) > 0.0))
            up->fail("must have a direction");
    }
    for (const json::JsonNode& node : object.require("keys").readArray(1, kMaxKeys)) {
        const bool isFirst = flythrough.keys.empty();
        flythrough.keys.push_back(readKey(
            node,
            isFirst ? nullptr : &flythrough.keys.front(),
            isFirst ? nullptr : &flythrough.keys.back()
        ));
    }
    return flythrough;
}

ordered_json describeVector(const math::dvec3& v) {
    return {v.x, v.y, v.z};
}

ordered_json describeShutter(const FlythroughShutter& shutter) {
    ordered_json described = ordered_json::object();
    if (shutter.exposureSeconds)
        described["exposure"] = *shutter.exposureSeconds;
    if (shutter.angleDegrees)
        described["shutterAngle"] = *shutter.angleDegrees;
    if (shutter.phase)
        described["phase"] = core::describeValue(
            core::getRow(scene::listShutterRows(), "phase"),
            scene::CameraShutter{.phase = *shutter.phase}
        );
    return described;
}

ordered_json describeKey(const FlythroughKey& key) {
    ordered_json described;
    described["time"] = key.seconds;
    described["position"] = describeVector(key.position);
    if (key.lookAt)
        described["lookAt"] = describeVector(*key.lookAt);
    if (key.rotation)
        described["rotation"] = {
            key.rotation->x, key.rotation->y, key.rotation->z, key.rotation->w};
    if (key.fieldOfView)
        described["fieldOfView"] = *key.fieldOfView;
    if (key.focusDistance)
        described["focusDistance"] = *key.focusDistance;
    if (key.fStop)
        described["fStop"] = *key.fStop;
    if (key.shutter)
        described["shutter"] = describeShutter(*key.shutter);
    if (key.timeScale)
        described["timeScale"] = *key.timeScale;
    if (key.cut)
        described["cut"] = true;
    return described;
}

ordered_json describe(const Flythrough& flythrough) {
    ordered_json described;
    described["version"] = 1;
    if (!flythrough.name.empty())
        described["name"] = flythrough.name;
    described["fps"] = describeRate(flythrough.fps);
    described["interpolation"] = findName(kInterpolations, flythrough.interpolation);
    described["ease"] = findName(kEases, flythrough.ease);
    described["up"] = describeVector(flythrough.up);
    ordered_json& keys = described["keys"] = ordered_json::array();
    for (const FlythroughKey& key : flythrough.keys)
        keys.push_back(describeKey(key));
    return described;
}

bool isFinite(const math::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// True when JSON can hold the key's numbers; the reader checks everything else.
bool isFinite(const FlythroughKey& key) {
    const auto isNone = [](const auto& value) { return !value || std::isfinite(*value); };
    return std::isfinite(key.seconds) && isFinite(key.position) &&
           (!key.lookAt || isFinite(*key.lookAt)) &&
           (!key.rotation || std::isfinite(glm::length(*key.rotation))) &&
           isNone(key.fieldOfView) && isNone(key.focusDistance) && isNone(key.fStop) &&
           isNone(key.timeScale) &&
           (!key.shutter ||
            (isNone(key.shutter->exposureSeconds) && isNone(key.shutter->angleDegrees)));
}

double toRadians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

} // namespace

core::Result<Flythrough> readFlythrough(const std::filesystem::path& path) {
    return json::readJsonFile(path, readRoot);
}

core::Result<Flythrough> parseFlythrough(std::string_view text, std::string name) {
    auto document = json::JsonDocument::parse(text, std::move(name));
    if (!document)
        return document.error();
    Flythrough flythrough = readRoot(document.value().root());
    SHUTTER_TRY(document.value().finish());
    return flythrough;
}

core::Status validateFlythrough(const Flythrough& flythrough) {
    if (!std::isfinite(flythrough.fps.perSecond()) || !isFinite(flythrough.up))
        return core::makeError("flythrough: fps and up must be finite");
    for (size_t i = 0; i < flythrough.keys.size(); ++i)
        if (!isFinite(flythrough.keys[i]))
            return core::makeError("flythrough: keys[{}] holds a value that is not finite", i);
    // The reader has the only set of rules.
    const auto read = parseFlythrough(json::formatJson(describe(flythrough)), "flythrough");
    return read ? core::Status() : core::Status(read.error());
}

core::Status writeFlythrough(const std::filesystem::path& path, const Flythrough& flythrough) {
    if (core::Status valid = validateFlythrough(flythrough); !valid)
        return core::makeError("cannot write '{}': {}", path.string(), valid.error().message);
    return json::writeJsonFile(path, describe(flythrough));
}

scene::PathMotion makePath(const Flythrough& flythrough) {
    scene::PathMotion path;
    path.interpolation = flythrough.interpolation;
    path.ease = flythrough.ease;
    path.up = flythrough.up;
    for (const FlythroughKey& key : flythrough.keys) {
        scene::PathKey& made = path.keys.emplace_back();
        made.seconds = key.seconds;
        made.position = key.position;
        if (key.rotation)
            made.rotation = glm::normalize(*key.rotation);
        made.lookAt = key.lookAt;
        made.cut = key.cut;
    }
    return path;
}

std::optional<scene::LensMotion> makeLens(const Flythrough& flythrough) {
    if (!flythrough.keys.front().fieldOfView)
        return std::nullopt;
    scene::LensMotion lens;
    lens.interpolation = flythrough.interpolation;
    lens.ease = flythrough.ease;
    for (const FlythroughKey& key : flythrough.keys)
        lens.keys.push_back({key.seconds, toRadians(*key.fieldOfView), key.cut});
    return lens;
}

std::optional<scene::FocusMotion> makeFocus(const Flythrough& flythrough) {
    const FlythroughKey& first = flythrough.keys.front();
    if (!first.focusDistance && !first.fStop)
        return std::nullopt;
    scene::FocusMotion focus;
    focus.interpolation = flythrough.interpolation;
    focus.ease = flythrough.ease;
    for (const FlythroughKey& key : flythrough.keys)
        focus.keys.push_back({key.seconds, key.focusDistance, key.fStop, key.cut});
    return focus;
}

void applyShutter(const Flythrough& flythrough, double seconds, scene::CameraShutter& shutter) {
    const FlythroughShutter* given = nullptr;
    for (const FlythroughKey& key : flythrough.keys) {
        if (given && key.seconds > seconds)
            break;
        if (key.shutter)
            given = &*key.shutter;
    }
    if (!given)
        return;
    if (given->exposureSeconds) {
        shutter.mode = scene::ShutterMode::Physical;
        shutter.exposureSeconds = *given->exposureSeconds;
    }
    if (given->angleDegrees) {
        shutter.mode = scene::ShutterMode::Angle;
        shutter.angleDegrees = *given->angleDegrees;
    }
    shutter.phase = given->phase.value_or(shutter.phase);
}

ecs::Entity addFlythroughCamera(scene::World& world, const Flythrough& flythrough) {
    const core::Status valid = validateFlythrough(flythrough);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
    scene::Camera camera;
    std::optional<scene::CameraLens> opening;
    std::optional<scene::AutoFocus> autoFocus;
    if (!world.cameras.empty()) {
        const ecs::Entity first = world.cameras.front();
        camera = world.registry.get<scene::Camera>(first);
        if (const auto* found = world.registry.find<scene::CameraLens>(first))
            opening = *found;
        if (const auto* found = world.registry.find<scene::AutoFocus>(first))
            autoFocus = *found;
    }
    camera.name = flythrough.name;
    const ecs::Entity entity = world.registry.create();
    world.registry.add(entity, scene::Name{flythrough.name});
    world.registry.add(entity, scene::LocalTransform{});
    world.registry.add(entity, makePath(flythrough));
    if (const auto lens = makeLens(flythrough)) {
        camera.kind = scene::CameraKind::Perspective;
        camera.yFov = lens->keys.front().yFov;
        camera.aspectRatio.reset(); // that of the file is the picture's
        world.registry.add(entity, *lens);
    }
    if (opening)
        world.registry.add(entity, *opening);
    if (autoFocus)
        world.registry.add(entity, *autoFocus);
    if (auto focus = makeFocus(flythrough))
        world.registry.add(entity, std::move(*focus));
    world.registry.add(entity, camera);
    world.cameras.push_back(entity);
    return entity;
}

} // namespace shutter::flythrough
