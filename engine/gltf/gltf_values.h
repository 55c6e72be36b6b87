// SPDX-License-Identifier: MIT
// Private to engine/gltf: typed values out of the model: accessors, vertex attributes, and members
// of extension objects.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/math/math.h"

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::gltf {

/// Largest magnitude that is read. Beyond it, products of single-precision values overflow.
inline constexpr double kMaxMagnitude = 1e30;

inline constexpr int kInt8 = TINYGLTF_COMPONENT_TYPE_BYTE;
inline constexpr int kUint8 = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
inline constexpr int kInt16 = TINYGLTF_COMPONENT_TYPE_SHORT;
inline constexpr int kUint16 = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
inline constexpr int kUint32 = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
inline constexpr int kFloat32 = TINYGLTF_COMPONENT_TYPE_FLOAT;

/// Checks every buffer view against its buffer and every accessor against its buffer view, dense
/// and sparse part, before anything is read. Throws GltfError.
void checkAccessors(const GltfContext& context);

/// The accessor types that a use accepts.
struct AccessorUse {
    std::string use;                 ///< for messages: "meshes[0].primitives[0] POSITION"
    std::vector<int> types;          ///< TINYGLTF_TYPE_...
    std::vector<int> componentTypes; ///< kInt8 ... kFloat32
    /// Requires that integer components are marked normalized (float components never are).
    bool integersMustBeNormalized = false;
};

/// Components of the accessor's type: 1 to 16.
[[nodiscard]] size_t componentCount(const tinygltf::Accessor& accessor);

/// Without a buffer view, elements that the sparse part does not contain are zero (glTF 2.0,
/// 3.6.2.3): such zeros are never a reason to refuse a file, even where a value of zero has no
/// meaning.
[[nodiscard]] inline bool lacksView(const tinygltf::Model& model, size_t accessor) {
    return model.accessors[accessor].bufferView < 0;
}

/// All elements as floats, interleaved, with sparse values in place. Normalized integers are scaled
/// to [0, 1] or [-1, 1], others keep their value. May hold NaN and infinity. Throws GltfError when
/// the accessor is not what `use` accepts.
[[nodiscard]] std::vector<float>
readFloats(GltfContext& context, size_t accessor, const AccessorUse& use);

/// All elements of a scalar or vector accessor of unsigned integers, interleaved. Throws GltfError
/// as readFloats does.
[[nodiscard]] std::vector<uint32_t>
readUnsigned(GltfContext& context, size_t accessor, const AccessorUse& use);

/// True when the file uses KHR_mesh_quantization.
[[nodiscard]] bool isQuantized(const GltfContext& context);

/// The values of a POSITION, NORMAL or TANGENT, of a primitive or of a morph target: floats or,
/// where the file uses KHR_mesh_quantization, small integers too. Throws GltfError, naming `path`,
/// for other types.
/// \param type TINYGLTF_TYPE_...
[[nodiscard]] std::vector<float> readVectors(
    GltfContext& context,
    size_t accessor,
    const std::string& attribute,
    int type,
    const std::string& path
);

/// Groups interleaved values into vectors. \param values a multiple of the vector's length
template <class Vector>
[[nodiscard]] std::vector<Vector> toVectors(const std::vector<float>& values) {
    constexpr size_t kLength = size_t(Vector::length());
    std::vector<Vector> vectors(values.size() / kLength);
    for (size_t i = 0; i < vectors.size(); ++i) {
        for (size_t c = 0; c < kLength; ++c)
            vectors[i][glm::length_t(c)] = values[i * kLength + c];
    }
    return vectors;
}

/// The extension's object, or nullptr.
[[nodiscard]] const tinygltf::Value*
findExtension(const tinygltf::ExtensionMap& extensions, const std::string& name);

/// Returns `extras.name` of the object at `path`, or nullptr. Throws GltfError if `extras` is not
/// an object.
[[nodiscard]] const tinygltf::Value*
findExtra(const tinygltf::Value& extras, const std::string& name, const std::string& path);

/// Warns of every member that is not `known`.
void warnOfOthers(
    GltfContext& context,
    const tinygltf::Value& object,
    std::initializer_list<std::string_view> known,
    const std::string& path
);

// Members of extension objects, which checkGltfSchema does not validate. These functions return
// nothing for a missing member and throw GltfError, naming `path`.key, for one of the wrong type or
// out of range.

/// A number up to kMaxMagnitude.
[[nodiscard]] std::optional<double>
findNumber(const tinygltf::Value& object, const std::string& key, const std::string& path);

/// A whole number from 0 to 2^31 - 1.
[[nodiscard]] std::optional<uint32_t>
findIndex(const tinygltf::Value& object, const std::string& key, const std::string& path);

/// The index of the member's value among `names`.
[[nodiscard]] std::optional<size_t> findName(
    const tinygltf::Value& object,
    const std::string& key,
    std::initializer_list<std::string_view> names,
    const std::string& path
);

[[nodiscard]] std::optional<bool>
findBool(const tinygltf::Value& object, const std::string& key, const std::string& path);

[[nodiscard]] std::optional<math::dvec2>
findVec2(const tinygltf::Value& object, const std::string& key, const std::string& path);

[[nodiscard]] std::optional<math::dvec3>
findVec3(const tinygltf::Value& object, const std::string& key, const std::string& path);

/// An array of objects, each with its path; empty where there is none.
/// \param most members
[[nodiscard]] std::vector<std::pair<const tinygltf::Value*, std::string>> listObjects(
    const tinygltf::Value& object, const std::string& key, size_t most, const std::string& path
);

} // namespace shutter::gltf
