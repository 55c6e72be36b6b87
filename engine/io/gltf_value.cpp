// SPDX-License-Identifier: MIT
#include "engine/io/gltf_value.h"

#include "engine/io/gltf_error.h"

#include <cmath>

namespace shutter::io {

namespace {

/// Float range is what all later stages keep these values in.
constexpr double kMaxMagnitude = 1e30;

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

const tinygltf::Value*
findExtension(const tinygltf::ExtensionMap& extensions, const std::string& name) {
    const auto it = extensions.find(name);
    return it == extensions.end() || !it->second.IsObject() ? nullptr : &it->second;
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

} // namespace shutter::io
