// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_values.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace shutter::gltf {

namespace {

double asNumber(const tinygltf::Value& value, const std::string& path) {
    if (!value.IsNumber())
        failGltf("{} is not a number", path);
    const double number = value.GetNumberAsDouble();
    if (!(std::abs(number) <= kMaxMagnitude))
        failGltf("{} is {}, above 1e30", path, number);
    return number;
}

template <class Vector>
std::optional<Vector>
findVector(const tinygltf::Value& object, const std::string& key, const std::string& path) {
    if (!object.Has(key))
        return std::nullopt;
    const tinygltf::Value& array = object.Get(key);
    const std::string at = path + "." + key;
    constexpr int kLength = Vector::length();
    if (!array.IsArray() || array.ArrayLen() != size_t(kLength)) {
        failGltf("{} is not an array of {} numbers", at, kLength);
    }
    Vector vector(0.0);
    for (int i = 0; i < kLength; ++i)
        vector[i] = asNumber(array.Get(i), at);
    return vector;
}

} // namespace

bool isQuantized(const GltfContext& context) {
    const std::vector<std::string>& used = context.model.extensionsUsed;
    return std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
}

std::vector<float> readVectors(
    GltfContext& context,
    size_t accessor,
    const std::string& attribute,
    int type,
    const std::string& path
) {
    if (!isQuantized(context))
        return readFloats(context, accessor, {path, {type}, {kFloat32}});
    if (attribute == "POSITION") {
        return readFloats(
            context, accessor, {path, {type}, {kFloat32, kInt8, kUint8, kInt16, kUint16}}
        );
    }
    return readFloats(context, accessor, {path, {type}, {kFloat32, kInt8, kInt16}, true});
}

const tinygltf::Value*
findExtension(const tinygltf::ExtensionMap& extensions, const std::string& name) {
    const auto it = extensions.find(name);
    return it == extensions.end() || !it->second.IsObject() ? nullptr : &it->second;
}

const tinygltf::Value*
findExtra(const tinygltf::Value& extras, const std::string& name, const std::string& path) {
    if (!extras.IsObject() || !extras.Has(name))
        return nullptr;
    const tinygltf::Value& object = extras.Get(name);
    if (!object.IsObject())
        failGltf("{}.extras.{} is not an object", path, name);
    return &object;
}

void warnOfOthers(
    GltfContext& context,
    const tinygltf::Value& object,
    std::initializer_list<std::string_view> known,
    const std::string& path
) {
    for (const std::string& key : object.Keys())
        if (std::find(known.begin(), known.end(), key) == known.end())
            context.warnings.add(fmt::format("{} has a member '{}': not used", path, key));
}

std::optional<size_t> findName(
    const tinygltf::Value& object,
    const std::string& key,
    std::initializer_list<std::string_view> names,
    const std::string& path
) {
    if (!object.Has(key))
        return std::nullopt;
    const tinygltf::Value& value = object.Get(key);
    const std::string given = value.IsString() ? value.Get<std::string>() : "";
    const auto* const found = std::find(names.begin(), names.end(), given);
    if (found == names.end())
        failGltf("{}.{} is none of '{}'", path, key, fmt::join(names, "', '"));
    return static_cast<size_t>(found - names.begin());
}

std::optional<double>
findNumber(const tinygltf::Value& object, const std::string& key, const std::string& path) {
    if (!object.Has(key))
        return std::nullopt;
    return asNumber(object.Get(key), path + "." + key);
}

std::optional<uint32_t>
findIndex(const tinygltf::Value& object, const std::string& key, const std::string& path) {
    const std::optional<double> number = findNumber(object, key, path);
    if (!number)
        return std::nullopt;
    constexpr double kMaxIndex = 2147483647.0;
    if (!(*number >= 0.0 && *number <= kMaxIndex && *number == std::floor(*number))) {
        failGltf("{}.{} is {}, not an index", path, key, *number);
    }
    return uint32_t(*number);
}

std::optional<bool>
findBool(const tinygltf::Value& object, const std::string& key, const std::string& path) {
    if (!object.Has(key))
        return std::nullopt;
    if (!object.Get(key).IsBool())
        failGltf("{}.{} is neither true nor false", path, key);
    return object.Get(key).Get<bool>();
}

std::optional<math::dvec2>
findVec2(const tinygltf::Value& object, const std::string& key, const std::string& path) {
    return findVector<math::dvec2>(object, key, path);
}

std::optional<math::dvec3>
findVec3(const tinygltf::Value& object, const std::string& key, const std::string& path) {
    return findVector<math::dvec3>(object, key, path);
}

std::vector<std::pair<const tinygltf::Value*, std::string>> listObjects(
    const tinygltf::Value& object, const std::string& key, size_t most, const std::string& path
) {
    std::vector<std::pair<const tinygltf::Value*, std::string>> objects;
    if (!object.Has(key))
        return objects;
    const tinygltf::Value& array = object.Get(key);
    const std::string at = path + "." + key;
    if (!array.IsArray())
        failGltf("{} is not an array", at);
    if (array.ArrayLen() > most)
        failGltf("{} has {} members, above {}", at, array.ArrayLen(), most);
    for (size_t i = 0; i < array.ArrayLen(); ++i) {
        objects.emplace_back(&array.Get(int(i)), fmt::format("{}[{}]", at, i));
        if (!objects.back().first->IsObject())
            failGltf("{} is not an object", objects.back().second);
    }
    return objects;
}

} // namespace shutter::gltf
