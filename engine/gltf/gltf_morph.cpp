// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"

#include <cmath>
#include <map>

namespace shutter::gltf {

namespace {

using math::vec3;

/// Sets deltas that are not finite to 0, which leaves the vertex in place. Returns true when there
/// were any.
bool repairDeltas(std::vector<vec3>& deltas) {
    bool isRepaired = false;
    for (vec3& delta : deltas) {
        if (std::isfinite(delta.x) && std::isfinite(delta.y) && std::isfinite(delta.z))
            continue;
        delta = vec3(0.0f);
        isRepaired = true;
    }
    return isRepaired;
}

class TargetReader {
  public:
    TargetReader(
        GltfContext& context,
        const std::map<std::string, int>& source,
        std::string path,
        size_t vertexCount
    )
        : mContext(context), mSource(source), mPath(std::move(path)), mVertexCount(vertexCount) {}

    scene::MorphTarget read(const scene::Primitive& primitive) {
        for (const auto& [name, accessor] : mSource) {
            checkCount(name, size_t(accessor));
            const bool isMoved = name == "POSITION" || name == "NORMAL" || name == "TANGENT";
            if (!isMoved)
                mContext.warnings.add(fmt::format("morph targets of {} are ignored", name));
        }
        scene::MorphTarget target;
        target.positions = readDeltas("POSITION");
        if (!primitive.normals.empty())
            target.normals = readDeltas("NORMAL");
        if (!primitive.tangents.empty())
            target.tangents = readDeltas("TANGENT");
        return target;
    }

  private:
    void checkCount(const std::string& name, size_t accessor) const {
        const size_t count = mContext.model.accessors[accessor].count;
        if (count != mVertexCount) {
            failGltf(
                "{}.{} has {}, POSITION has {}",
                mPath,
                name,
                core::countOf(count, "element"),
                mVertexCount
            );
        }
    }

    std::vector<vec3> readDeltas(const std::string& name) {
        const auto it = mSource.find(name);
        if (it == mSource.end())
            return {};
        const std::string path = fmt::format("{}.{}", mPath, name);
        std::vector<vec3> deltas = toVectors<vec3>(
            readVectors(mContext, size_t(it->second), name, TINYGLTF_TYPE_VEC3, path)
        );
        if (repairDeltas(deltas))
            mContext.warnings.add(path + " holds values that are not finite: set to 0");
        return deltas;
    }

    GltfContext& mContext;
    const std::map<std::string, int>& mSource;
    std::string mPath;
    size_t mVertexCount;
};

} // namespace

size_t countMorphTargets(const tinygltf::Mesh& mesh, const std::string& path) {
    if (mesh.primitives.empty())
        return 0;
    const size_t expected = mesh.primitives[0].targets.size();
    for (size_t p = 1; p < mesh.primitives.size(); ++p) {
        const size_t count = mesh.primitives[p].targets.size();
        if (count != expected) {
            failGltf(
                "{}.primitives[{}].targets has {}, primitives[0] has {}",
                path,
                p,
                core::countOf(count, "morph target"),
                expected
            );
        }
    }
    return expected;
}

void readMorphTargets(
    GltfContext& context,
    const tinygltf::Primitive& source,
    const std::string& path,
    scene::Primitive& primitive
) {
    for (size_t t = 0; t < source.targets.size(); ++t) {
        const std::string at = fmt::format("{}.targets[{}]", path, t);
        primitive.morphTargets.push_back(
            TargetReader(context, source.targets[t], at, primitive.positions.size()).read(primitive)
        );
    }
}

std::vector<float> readMorphWeights(
    const std::vector<double>& given, const std::vector<float>& fallback, const std::string& path
) {
    if (given.empty())
        return fallback;
    if (given.size() != fallback.size()) {
        failGltf(
            "{} has {}, but the mesh has {}",
            path,
            core::countOf(given.size(), "number"),
            core::countOf(fallback.size(), "morph target")
        );
    }
    std::vector<float> weights;
    for (const double weight : given) {
        if (!(std::abs(weight) <= kMaxMagnitude))
            failGltf("{} holds {}, above 1e30", path, weight);
        weights.push_back(float(weight));
    }
    return weights;
}

} // namespace shutter::gltf
