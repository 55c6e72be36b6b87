// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_geometry.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace shutter::gltf {

namespace {

/// The triangle mode of a primitive, or nothing for points and lines.
std::optional<TriangleMode> readMode(int mode, const std::string& path) {
    switch (mode) {
    case TINYGLTF_MODE_POINTS:
    case TINYGLTF_MODE_LINE:
    case TINYGLTF_MODE_LINE_LOOP:
    case TINYGLTF_MODE_LINE_STRIP:
        return std::nullopt;
    case TINYGLTF_MODE_TRIANGLES:
        return TriangleMode::List;
    case TINYGLTF_MODE_TRIANGLE_STRIP:
        return TriangleMode::Strip;
    case TINYGLTF_MODE_TRIANGLE_FAN:
        return TriangleMode::Fan;
    default:
        failGltf("{}.mode {} is unknown", path, mode);
    }
}

class PrimitiveReader {
  public:
    PrimitiveReader(
        GltfContext& context,
        const scene::Assets& assets,
        const tinygltf::Primitive& source,
        std::string path
    )
        : mContext(context), mAssets(assets), mSource(source), mPath(std::move(path)) {}

    /// The primitive, or nothing where there is nothing to draw.
    std::optional<scene::Primitive> read() {
        const std::optional<TriangleMode> mode = readMode(mSource.mode, mPath);
        if (!mode) {
            mContext.warnings.add("points and lines are not drawn");
            return std::nullopt;
        }
        if (!mSource.attributes.contains("POSITION")) {
            mContext.warnings.add(fmt::format("{} has no POSITION: not drawn", mPath));
            return std::nullopt;
        }
        readAttributes();
        readIndices(*mode);
        if (mPrimitive.indices.empty())
            return std::nullopt;
        repairPositions();
        if (mPrimitive.indices.empty())
            return std::nullopt;
        finishNormals();
        finishTangents();
        warnMissingUv();
        return std::move(mPrimitive);
    }

  private:
    [[nodiscard]] std::string attributePath(const std::string& name) const {
        return fmt::format("{} {}", mPath, name);
    }

    /// Index of the attribute's accessor, whose count is checked against that of POSITION; nothing
    /// for a missing attribute.
    std::optional<size_t> findAttribute(const std::string& name) {
        const auto it = mSource.attributes.find(name);
        if (it == mSource.attributes.end())
            return std::nullopt;
        const auto index = size_t(it->second);
        const size_t count = mContext.model.accessors[index].count;
        const size_t expected = positionCount();
        if (count != expected) {
            failGltf(
                "{} has {}, POSITION has {}",
                attributePath(name),
                core::countOf(count, "element"),
                expected
            );
        }
        return index;
    }

    [[nodiscard]] size_t positionCount() const {
        const auto it = mSource.attributes.find("POSITION");
        return it == mSource.attributes.end() ? 0
                                              : mContext.model.accessors[size_t(it->second)].count;
    }

    void readAttributes() {
        mPrimitive.material =
            mSource.material < 0 ? scene::kNone : scene::AssetIndex(mSource.material);
        mPrimitive.positions = toVectors<math::vec3>(readAttribute("POSITION", TINYGLTF_TYPE_VEC3));
        mPrimitive.normals = toVectors<math::vec3>(readAttribute("NORMAL", TINYGLTF_TYPE_VEC3));
        // A tangent without a normal means nothing (glTF 2.0, 3.7.2.1).
        if (!mPrimitive.normals.empty()) {
            mPrimitive.tangents =
                toVectors<math::vec4>(readAttribute("TANGENT", TINYGLTF_TYPE_VEC4));
        }
        mPrimitive.uv0 = readUv("TEXCOORD_0");
        mPrimitive.uv1 = readUv("TEXCOORD_1");
        mPrimitive.colors = readColors();
        readInfluences(mContext, mSource, mPath, mPrimitive);
        readMorphTargets(mContext, mSource, mPath, mPrimitive);
    }

    std::vector<float> readAttribute(const std::string& name, int type) {
        const std::optional<size_t> index = findAttribute(name);
        return index ? readVectors(mContext, *index, name, type, attributePath(name))
                     : std::vector<float>();
    }

    std::vector<math::vec2> readUv(const std::string& name) {
        const std::optional<size_t> index = findAttribute(name);
        if (!index)
            return {};
        const std::string path = attributePath(name);
        AccessorUse use{path, {TINYGLTF_TYPE_VEC2}, {kFloat32, kUint8, kUint16}, true};
        if (isQuantized(mContext)) {
            use = {path, {TINYGLTF_TYPE_VEC2}, {kFloat32, kInt8, kUint8, kInt16, kUint16}};
        }
        std::vector<math::vec2> uv = toVectors<math::vec2>(readFloats(mContext, *index, use));
        bool isRepaired = false;
        for (math::vec2& value : uv) {
            if (std::isfinite(value.x) && std::isfinite(value.y))
                continue;
            value = math::vec2(0.0f);
            isRepaired = true;
        }
        if (isRepaired)
            mContext.warnings.add(path + " holds values that are not finite: set to 0");
        return uv;
    }

    std::vector<math::vec4> readColors() {
        const std::optional<size_t> index = findAttribute("COLOR_0");
        if (!index)
            return {};
        const std::string path = attributePath("COLOR_0");
        const std::vector<float> values = readFloats(
            mContext,
            *index,
            {path, {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, {kFloat32, kUint8, kUint16}, true}
        );
        const size_t components = componentCount(mContext.model.accessors[*index]);
        std::vector<math::vec4> colors(values.size() / components, math::vec4(1.0f));
        bool isRepaired = false;
        for (size_t i = 0; i < values.size(); ++i) {
            // glTF defines colours in [0, 1]; NaN fails both comparisons.
            const bool isInRange = values[i] >= 0.0f && values[i] <= 1.0f;
            isRepaired |= !isInRange;
            const float value = values[i] > 1.0f ? 1.0f : isInRange ? values[i] : 0.0f;
            colors[i / components][glm::length_t(i % components)] = value;
        }
        if (isRepaired)
            mContext.warnings.add(path + " leaves [0, 1]: clamped");
        return colors;
    }

    void readIndices(TriangleMode mode) {
        const size_t vertexCount = mPrimitive.positions.size();
        std::vector<uint32_t> indices;
        if (mSource.indices >= 0) {
            const std::string path = mPath + ".indices";
            indices = readUnsigned(
                mContext,
                size_t(mSource.indices),
                {path, {TINYGLTF_TYPE_SCALAR}, {kUint8, kUint16, kUint32}}
            );
            const auto largest = std::max_element(indices.begin(), indices.end());
            if (*largest >= vertexCount) {
                failGltf(
                    "{} holds {}, but {}",
                    path,
                    *largest,
                    core::thereAre(vertexCount, "vertex", "vertices")
                );
            }
        } else {
            mContext.spendVertexBytes(vertexCount * sizeof(uint32_t));
            indices.resize(vertexCount);
            std::iota(indices.begin(), indices.end(), 0u);
        }
        if (mode == TriangleMode::List && indices.size() % 3 != 0) {
            mContext.warnings.add(mPath + " ends within a triangle: the rest is not drawn");
        }
        mPrimitive.indices = triangulate(indices, mode);
    }

    void repairPositions() {
        const bool isAllFinite = std::all_of(
            mPrimitive.positions.begin(),
            mPrimitive.positions.end(),
            [](const math::vec3& p) {
                return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
            }
        );
        if (isAllFinite)
            return;
        const size_t removed = removeNonFiniteTriangles(mPrimitive);
        mContext.warnings.add(fmt::format(
            "{} has positions that are not finite: {} not drawn",
            mPath,
            core::countOf(removed, "triangle is", "triangles are")
        ));
    }

    void finishNormals() {
        if (mPrimitive.normals.empty()) {
            constexpr uint64_t kVertexBytes = sizeof(math::vec3) * 2 + sizeof(math::vec2) * 2 +
                                              sizeof(math::vec4) + sizeof(uint32_t);
            constexpr uint64_t kInfluenceBytes = sizeof(uint16_t) + sizeof(float);
            const uint64_t bytes = kVertexBytes + mPrimitive.influenceCount * kInfluenceBytes +
                                   mPrimitive.morphTargets.size() * sizeof(math::vec3);
            mContext.spendVertexBytes(mPrimitive.indices.size() * bytes);
            makeFlatNormals(mPrimitive);
        } else if (const size_t repaired = repairNormals(mPrimitive); repaired != 0) {
            mContext.warnings.add(fmt::format(
                "{} NORMAL holds {} without direction: replaced",
                mPath,
                core::countOf(repaired, "vector")
            ));
        }
    }

    [[nodiscard]] const scene::Material* material() const {
        return mPrimitive.material == scene::kNone ? nullptr
                                                   : &mAssets.materials[mPrimitive.material];
    }

    void finishTangents() {
        const scene::Material* shading = material();
        const bool isNeeded = shading && shading->normal.texture != scene::kNone;
        const bool isGiven = !mPrimitive.tangents.empty();
        if (isGiven && areTangentsValid(mPrimitive.tangents)) {
            normalizeTangents(mPrimitive.tangents);
            return;
        }
        if (isGiven) {
            mContext.warnings.add(
                mPath + " TANGENT holds vectors without direction: computed anew"
            );
        }
        mPrimitive.tangents.clear();
        for (scene::MorphTarget& target : mPrimitive.morphTargets)
            target.tangents.clear(); // these deltas belong to the tangents of the file
        if (!isNeeded)
            return;
        const std::vector<math::vec2>& uv =
            shading->normal.uvSet == 0 ? mPrimitive.uv0 : mPrimitive.uv1;
        if (uv.empty())
            return; // warnMissingUv warns
        mContext.spendVertexBytes(mPrimitive.positions.size() * sizeof(math::vec4));
        makeTangents(mPrimitive, uv);
    }

    void warnMissingUv() {
        const scene::Material* shading = material();
        if (!shading)
            return;
        for (const scene::TextureSlot* slot :
             {&shading->baseColor,
              &shading->metallicRoughness,
              &shading->normal,
              &shading->occlusion,
              &shading->emissiveTexture}) {
            const bool isMissing =
                slot->uvSet == 0 ? mPrimitive.uv0.empty() : mPrimitive.uv1.empty();
            if (slot->texture == scene::kNone || !isMissing)
                continue;
            mContext.warnings.add(fmt::format(
                "{} has no TEXCOORD_{} for the textures of materials[{}]",
                mPath,
                slot->uvSet,
                mPrimitive.material
            ));
        }
    }

    GltfContext& mContext;
    const scene::Assets& mAssets;
    const tinygltf::Primitive& mSource;
    std::string mPath;
    scene::Primitive mPrimitive;
};

} // namespace

void loadMeshes(GltfContext& context, scene::Assets& assets) {
    for (size_t m = 0; m < context.model.meshes.size(); ++m) {
        const tinygltf::Mesh& source = context.model.meshes[m];
        const std::string meshPath = fmt::format("meshes[{}]", m);
        scene::Mesh mesh;
        mesh.name = source.name;
        const std::vector<float> zeros(countMorphTargets(source, meshPath), 0.0f);
        mesh.morphWeights = readMorphWeights(source.weights, zeros, meshPath + ".weights");
        for (size_t p = 0; p < source.primitives.size(); ++p) {
            const std::string path = fmt::format("{}.primitives[{}]", meshPath, p);
            std::optional<scene::Primitive> primitive =
                PrimitiveReader(context, assets, source.primitives[p], path).read();
            if (!primitive)
                continue;
            for (const math::vec3& position : primitive->positions)
                mesh.bounds.add(math::dvec3(position));
            mesh.primitives.push_back(std::move(*primitive));
        }
        assets.meshes.push_back(std::move(mesh));
    }
}

} // namespace shutter::gltf
