// SPDX-License-Identifier: MIT
// Small glTF files, built in the test and written to a folder that goes away with it.
#pragma once

#include "engine/gltf/gltf_loader.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::gltf {

using test::expectRefused;
using test::TempFolder;

inline constexpr int kByte = 5120;
inline constexpr int kUnsignedByte = 5121;
inline constexpr int kShort = 5122;
inline constexpr int kUnsignedShort = 5123;
inline constexpr int kUnsignedInt = 5125;
inline constexpr int kFloat = 5126;

/// Collects accessors and writes `data.bin` and `test.gltf`.
class GltfFile {
  public:
    /// Appends a buffer view with `values` and an accessor over all of it; returns its index.
    template <class T>
    int add(const std::vector<T>& values, int componentType, const char* type, bool norm = false) {
        const std::string_view name = type;
        const size_t components = name == "SCALAR" ? 1
                                  : name == "MAT4" ? 16
                                                   : size_t(type[3] - '0');
        const int view = addView(values);
        return addAccessor(fmt::format(
            R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}","normalized":{}}})",
            view,
            componentType,
            values.size() / components,
            type,
            norm ? "true" : "false"
        ));
    }

    template <class T> int addView(const std::vector<T>& values) {
        const size_t offset = mBin.size();
        const size_t bytes = values.size() * sizeof(T);
        mBin.resize(offset + (bytes + 3) / 4 * 4);
        std::memcpy(mBin.data() + offset, values.data(), bytes);
        return addViewJson(
            fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}}})", offset, bytes)
        );
    }

    int addViewJson(const std::string& json) {
        mViews.push_back(json);
        return int(mViews.size()) - 1;
    }

    int addAccessor(const std::string& json) {
        mAccessors.push_back(json);
        return int(mAccessors.size()) - 1;
    }

    /// The file with `members` (`"key":value,...`) in addition to asset, buffers, views and
    /// accessors.
    [[nodiscard]] std::string json(const std::string& members) const {
        std::string text = R"({"asset":{"version":"2.0"})";
        if (!mBin.empty()) {
            text +=
                fmt::format(R"(,"buffers":[{{"uri":"data.bin","byteLength":{}}}])", mBin.size());
        }
        if (!mViews.empty())
            text += fmt::format(R"(,"bufferViews":[{}])", fmt::join(mViews, ","));
        if (!mAccessors.empty())
            text += fmt::format(R"(,"accessors":[{}])", fmt::join(mAccessors, ","));
        return text + (members.empty() ? "" : "," + members) + "}";
    }

    [[nodiscard]] std::string_view bin() const { return {mBin.data(), mBin.size()}; }

    [[nodiscard]] core::Result<LoadedScene> load(const std::string& members) const {
        const TempFolder folder;
        if (!mBin.empty())
            folder.write("data.bin", bin());
        return loadGltf(folder.write("test.gltf", json(members)));
    }

    /// Of a file that loads.
    [[nodiscard]] LoadedScene read(const std::string& members) const {
        return test::valueOf(load(members));
    }

  private:
    std::vector<char> mBin;
    std::vector<std::string> mViews;
    std::vector<std::string> mAccessors;
};

/// Loads a file that holds nothing but `members`.
inline core::Result<LoadedScene> loadMembers(const std::string& members) {
    return GltfFile().load(members);
}

inline LoadedScene readMembers(const std::string& members) {
    return GltfFile().read(members);
}

/// Expects success and returns the scene.
inline LoadedScene expectLoads(core::Result<LoadedScene> result) {
    return test::valueOf(std::move(result));
}

/// Expects that load(change) is refused by the sentence beside it, for each change.
template <class Load>
void expectEachRefused(
    const Load& load, std::initializer_list<std::pair<std::string, const char*>> changes
) {
    for (const auto& [change, sentence] : changes) {
        SCOPED_TRACE(change);
        expectRefused(load(change), sentence);
    }
}

/// The first primitive of mesh 0.
inline const scene::Primitive& primitiveOf(const LoadedScene& scene) {
    return scene.world.assets.meshes.at(0).primitives.at(0);
}

inline bool hasWarning(const LoadedScene& scene, std::string_view part) {
    for (const std::string& warning : scene.warnings) {
        if (warning.find(part) != std::string::npos)
            return true;
    }
    return false;
}

/// A unit right triangle in the xy plane, facing +Z.
inline const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

} // namespace shutter::gltf
