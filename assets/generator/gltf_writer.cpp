// SPDX-License-Identifier: MIT
#include "assets/generator/gltf_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <fstream>
#include <limits>
#include <utility>

namespace shutter::generator {

namespace {

using nlohmann::json;

// glTF is little endian and we copy arrays as they lie in memory.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::vec2) == 8);

constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr int kNoTarget = 0;

constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kUnsignedShort = 5123;

Index addEntry(json& array, json value) {
    array.push_back(std::move(value));
    return static_cast<Index>(array.size()) - 1;
}

json toJson(glm::vec3 v) {
    return json::array({v.x, v.y, v.z});
}

/// glTF's order: x, y, z, w.
json toJson(glm::quat q) {
    return json::array({q.x, q.y, q.z, q.w});
}

template <typename Vector> std::span<const float> asFloats(const std::vector<Vector>& values) {
    return {&values.front()[0], values.size() * (sizeof(Vector) / sizeof(float))};
}

void putWord(std::string& out, size_t value) {
    const auto word = static_cast<uint32_t>(value);
    char bytes[4];
    std::memcpy(bytes, &word, 4);
    out.append(bytes, 4);
}

} // namespace

GltfWriter::GltfWriter(std::string title) {
    mRoot["asset"] = {
        {"version", "2.0"}, {"generator", "shutter_generate_assets"}, {"copyright", "CC0-1.0"}};
    mRoot["extensionsUsed"] = json::array({"KHR_lights_punctual", "KHR_physics_rigid_bodies"});
    mRoot["scene"] = 0;
    mRoot["scenes"] = json::array({{{"name", std::move(title)}, {"nodes", json::array()}}});
    constexpr int kLinear = 9729;
    constexpr int kLinearMipmapLinear = 9987;
    constexpr int kRepeat = 10497;
    mRoot["samplers"] = json::array(
        {{{"magFilter", kLinear},
          {"minFilter", kLinearMipmapLinear},
          {"wrapS", kRepeat},
          {"wrapT", kRepeat}}}
    );
}

Index GltfWriter::addView(const void* data, size_t byteCount, int target) {
    mBuffer.resize((mBuffer.size() + 3) / 4 * 4); // every accessor needs its component's alignment
    json view = {{"buffer", 0}, {"byteOffset", mBuffer.size()}, {"byteLength", byteCount}};
    if (target != kNoTarget) {
        view["target"] = target;
    }
    const auto* first = static_cast<const uint8_t*>(data);
    mBuffer.insert(mBuffer.end(), first, first + byteCount);
    return addEntry(mRoot["bufferViews"], view);
}

Index GltfWriter::addFloats(
    std::span<const float> values, int componentCount, int target, bool withBounds
) {
    static constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const auto stride = static_cast<size_t>(componentCount);
    assert(!values.empty() && values.size() % stride == 0);
    json accessor = {
        {"bufferView", addView(values.data(), values.size_bytes(), target)},
        {"componentType", kFloat},
        {"count", values.size() / stride},
        {"type", kTypes[componentCount - 1]}};
    if (withBounds) {
        std::vector<float> low(values.begin(), values.begin() + componentCount);
        std::vector<float> high = low;
        for (size_t i = 0; i < values.size(); ++i) {
            low[i % stride] = std::min(low[i % stride], values[i]);
            high[i % stride] = std::max(high[i % stride], values[i]);
        }
        accessor["min"] = low;
        accessor["max"] = high;
    }
    return addEntry(mRoot["accessors"], accessor);
}

Index GltfWriter::addIndices(std::span<const uint32_t> indices) {
    const uint32_t highest = *std::max_element(indices.begin(), indices.end());
    json accessor = {{"count", indices.size()}, {"type", "SCALAR"}};
    // The largest value of a type is reserved for primitive restart.
    if (highest < std::numeric_limits<uint16_t>::max()) {
        std::vector<uint16_t> narrow;
        for (const uint32_t index : indices) {
            narrow.push_back(static_cast<uint16_t>(index));
        }
        accessor["componentType"] = kUnsignedShort;
        accessor["bufferView"] = addView(narrow.data(), narrow.size() * 2, kElementArrayBuffer);
    } else {
        accessor["componentType"] = kUnsignedInt;
        accessor["bufferView"] = addView(indices.data(), indices.size_bytes(), kElementArrayBuffer);
    }
    return addEntry(mRoot["accessors"], accessor);
}

Index GltfWriter::addTexture(const std::string& name, const Picture& picture) {
    const std::vector<uint8_t> png = encodePng(picture);
    if (png.empty()) {
        mError = fmt::format("The texture \"{}\" cannot be encoded as PNG.", name);
    }
    const Index image = addEntry(
        mRoot["images"],
        {{"name", name},
         {"mimeType", "image/png"},
         {"bufferView", addView(png.data(), png.size(), kNoTarget)}}
    );
    return addEntry(mRoot["textures"], {{"name", name}, {"source", image}, {"sampler", 0}});
}

Index GltfWriter::addMaterial(const MaterialDesc& material) {
    json surface = {
        {"baseColorFactor", {material.color.x, material.color.y, material.color.z, 1.0f}},
        {"metallicFactor", material.metallic},
        {"roughnessFactor", material.roughness}};
    if (material.texture != kNothing) {
        surface["baseColorTexture"] = {{"index", material.texture}};
    }
    json entry = {{"name", material.name}, {"pbrMetallicRoughness", surface}};
    if (material.emissive != glm::vec3(0.0f)) {
        entry["emissiveFactor"] = toJson(material.emissive);
    }
    return addEntry(mRoot["materials"], entry);
}

Index GltfWriter::addMesh(const std::string& name, std::span<const MeshPart> parts) {
    json primitives = json::array();
    for (const MeshPart& part : parts) {
        const Shape& shape = part.shape;
        primitives.push_back(
            {{"attributes",
              {{"POSITION", addFloats(asFloats(shape.positions), 3, kArrayBuffer, true)},
               {"NORMAL", addFloats(asFloats(shape.normals), 3, kArrayBuffer, false)},
               {"TEXCOORD_0", addFloats(asFloats(shape.uvs), 2, kArrayBuffer, false)}}},
             {"indices", addIndices(shape.indices)},
             {"material", part.material}}
        );
    }
    return addEntry(mRoot["meshes"], {{"name", name}, {"primitives", primitives}});
}

Index GltfWriter::addCamera(const std::string& name, float yFov, float nearMetres) {
    return addEntry(
        mRoot["cameras"],
        {{"name", name},
         {"type", "perspective"},
         {"perspective", {{"aspectRatio", 16.0 / 9.0}, {"yfov", yFov}, {"znear", nearMetres}}}}
    );
}

Index GltfWriter::addLight(const std::string& name, const LightDesc& light) {
    return addEntry(
        mRoot["extensions"]["KHR_lights_punctual"]["lights"],
        {{"name", name},
         {"type", light.directional ? "directional" : "point"},
         {"color", toJson(light.color)},
         {"intensity", light.intensity}}
    );
}

Index GltfWriter::addNode(const NodeDesc& node) {
    json entry = {{"name", node.name}};
    if (node.translation != glm::vec3(0.0f)) {
        entry["translation"] = toJson(node.translation);
    }
    if (node.rotation != glm::quat(1.0f, 0.0f, 0.0f, 0.0f)) {
        entry["rotation"] = toJson(node.rotation);
    }
    if (node.mesh != kNothing) {
        entry["mesh"] = node.mesh;
    }
    if (node.camera != kNothing) {
        entry["camera"] = node.camera;
    }
    if (node.light != kNothing) {
        entry["extensions"]["KHR_lights_punctual"]["light"] = node.light;
    }
    if (node.linearVelocity || node.angularVelocity) {
        // Kinematic: a physics engine must keep the velocity and let no gravity bend it.
        json motion = {{"isKinematic", true}};
        if (node.linearVelocity) {
            motion["linearVelocity"] = toJson(*node.linearVelocity);
        }
        if (node.angularVelocity) {
            motion["angularVelocity"] = toJson(*node.angularVelocity);
        }
        entry["extensions"]["KHR_physics_rigid_bodies"]["motion"] = motion;
    }
    const Index index = addEntry(mRoot["nodes"], entry);
    json& siblings = node.parent == kNothing
                         ? mRoot["scenes"][0]["nodes"]
                         : mRoot["nodes"][static_cast<size_t>(node.parent)]["children"];
    siblings.push_back(index);
    return index;
}

void GltfWriter::addTranslationClip(
    const std::string& name,
    Index node,
    std::span<const float> times,
    std::span<const glm::vec3> translations
) {
    const std::vector<glm::vec3> values(translations.begin(), translations.end());
    addClip(name, node, "translation", times, addFloats(asFloats(values), 3, kNoTarget, false));
}

void GltfWriter::addRotationClip(
    const std::string& name,
    Index node,
    std::span<const float> times,
    std::span<const glm::quat> rotations
) {
    std::vector<glm::vec4> values;
    for (const glm::quat& q : rotations) {
        values.emplace_back(q.x, q.y, q.z, q.w);
    }
    addClip(name, node, "rotation", times, addFloats(asFloats(values), 4, kNoTarget, false));
}

void GltfWriter::addClip(
    const std::string& name,
    Index node,
    const char* path,
    std::span<const float> times,
    Index output
) {
    const Index input = addFloats(times, 1, kNoTarget, true);
    const json sampler = {{"input", input}, {"output", output}, {"interpolation", "LINEAR"}};
    const json channel = {{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}};
    mRoot["animations"].push_back(
        {{"name", name}, {"samplers", json::array({sampler})}, {"channels", json::array({channel})}}
    );
}

std::string GltfWriter::write(const std::filesystem::path& path) const {
    if (!mError.empty()) {
        return mError;
    }
    json root = mRoot;
    root["buffers"] = json::array({{{"byteLength", mBuffer.size()}}});
    std::string text = root.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const size_t binarySize = (mBuffer.size() + 3) / 4 * 4;

    std::string file = "glTF";
    putWord(file, 2);
    putWord(file, 12 + 8 + text.size() + 8 + binarySize);
    putWord(file, text.size());
    file += "JSON" + text;
    putWord(file, binarySize);
    file.append("BIN\0", 4);
    file.append(mBuffer.begin(), mBuffer.end());
    file.resize(file.size() + binarySize - mBuffer.size(), '\0');

    std::ofstream stream(path, std::ios::binary);
    stream.write(file.data(), static_cast<std::streamsize>(file.size()));
    stream.close();
    return stream ? std::string()
                  : fmt::format("The scene cannot be written to {}.", path.string());
}

} // namespace shutter::generator
