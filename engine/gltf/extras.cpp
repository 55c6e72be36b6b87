// SPDX-License-Identifier: MIT
#include "engine/gltf/extras.h"

#include "engine/gltf/gltf_values.h"

#include <utility>

namespace shutter::gltf {

std::optional<double> ExtraObject::findNumber(const char* key) const {
    return gltf::findNumber(*mValue, key, mPath);
}

std::optional<uint32_t> ExtraObject::findIndex(const char* key) const {
    return gltf::findIndex(*mValue, key, mPath);
}

std::optional<bool> ExtraObject::findBool(const char* key) const {
    return gltf::findBool(*mValue, key, mPath);
}

std::optional<math::dvec3> ExtraObject::findVec3(const char* key) const {
    return gltf::findVec3(*mValue, key, mPath);
}

std::optional<size_t>
ExtraObject::findName(const char* key, std::initializer_list<std::string_view> names) const {
    return gltf::findName(*mValue, key, names, mPath);
}

std::optional<std::vector<math::vec4>>
ExtraObject::findColors(const char* key, size_t count) const {
    if (!mValue->Has(key))
        return std::nullopt;
    const tinygltf::Value& array = mValue->Get(key);
    const std::string at = fmt::format("{}.{}", mPath, key);
    if (!array.IsArray() || array.ArrayLen() != count)
        failGltf("{} is not an array of {} colours", at, count);
    std::vector<math::vec4> colors(count);
    for (size_t i = 0; i < count; ++i) {
        const tinygltf::Value& color = array.Get(int(i));
        if (!color.IsArray() || color.ArrayLen() != 4)
            failGltf("{}[{}] is not an array of 4 numbers", at, i);
        for (size_t c = 0; c < 4; ++c) {
            const tinygltf::Value& number = color.Get(int(c));
            if (!number.IsNumber())
                failGltf("{}[{}] is not an array of 4 numbers", at, i);
            colors[i][glm::length_t(c)] = float(number.GetNumberAsDouble());
        }
    }
    return colors;
}

std::optional<scene::AssetIndex> ExtraObject::findTexture(const char* key) const {
    const std::optional<uint32_t> index = findIndex(key);
    if (!index)
        return std::nullopt;
    return mContext->looseTextures.at(*index);
}

std::vector<ExtraObject> ExtraObject::listObjects(const char* key, size_t most) const {
    std::vector<ExtraObject> objects;
    for (auto& [value, path] : gltf::listObjects(*mValue, key, most, mPath))
        objects.emplace_back(*mContext, *value, path);
    return objects;
}

void ExtraObject::warnOfOthers(std::initializer_list<std::string_view> known) const {
    gltf::warnOfOthers(*mContext, *mValue, known, mPath);
}

void ExtraObject::fail(const std::string& sentence) const {
    failGltf("{}: {}", mPath, sentence);
}

} // namespace shutter::gltf
