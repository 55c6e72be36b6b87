// SPDX-License-Identifier: MIT
// Readers of components that other folders define, from objects in the `extras` of a file's nodes.
#pragma once

#include "engine/ecs/registry.h"
#include "engine/math/math.h"
#include "engine/scene/assets.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tinygltf {
class Value;
}

namespace shutter::gltf {

struct GltfContext;

/// Object in `extras`, while a file is loaded. A find function returns nothing for a missing
/// member, and refuses the file for one of another type, naming it.
class ExtraObject {
  public:
    /// \param path for messages: "nodes[0].extras.lamp"
    ExtraObject(GltfContext& context, const tinygltf::Value& value, std::string path)
        : mContext(&context), mValue(&value), mPath(std::move(path)) {}

    /// Up to 1e30.
    [[nodiscard]] std::optional<double> findNumber(const char* key) const;
    /// From 0 to 2^31 - 1.
    [[nodiscard]] std::optional<uint32_t> findIndex(const char* key) const;
    [[nodiscard]] std::optional<bool> findBool(const char* key) const;
    [[nodiscard]] std::optional<math::dvec3> findVec3(const char* key) const;
    /// The index of the member's value among `names`.
    [[nodiscard]] std::optional<size_t>
    findName(const char* key, std::initializer_list<std::string_view> names) const;
    /// An array of so many arrays of four numbers.
    [[nodiscard]] std::optional<std::vector<math::vec4>>
    findColors(const char* key, size_t count) const;
    /// The texture of ExtraReader::textureMember in Assets::textures; scene::kNone: it names no
    /// picture.
    [[nodiscard]] std::optional<scene::AssetIndex> findTexture(const char* key) const;
    /// An array of objects; empty where there is none. \param most members
    [[nodiscard]] std::vector<ExtraObject> listObjects(const char* key, size_t most) const;

    /// Warns of every member that is not `known`.
    void warnOfOthers(std::initializer_list<std::string_view> known) const;

    /// Refuses the file. \param sentence after the object's path
    [[noreturn]] void fail(const std::string& sentence) const;

  private:
    GltfContext* mContext;
    const tinygltf::Value* mValue;
    std::string mPath;
};

/// Reads `extras.NAME` of nodes.
struct ExtraReader {
    std::string_view name;
    /// Member with the index of a texture that is loaded although no material shows it; empty:
    /// there is none.
    std::string_view textureMember;
    /// Adds components to the node's entity.
    void (*read)(const ExtraObject& object, ecs::Registry& registry, ecs::Entity entity) = nullptr;
};

} // namespace shutter::gltf
