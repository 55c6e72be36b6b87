// SPDX-License-Identifier: MIT
#include "assets/generator/gltf_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

namespace shutter::generator {

namespace {

using nlohmann::json;

// glTF is little endian and we copy arrays as they lie in memory.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::vec2) == 8 && sizeof(glm::u16vec4) == 8);

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

template <typename Vector> std::span<const float> asFloats(std::span<const Vector> values) {
    return {&values.front()[0], values.size() * (sizeof(Vector) / sizeof(float))};
}

template <typename Vector> std::span<const float> asFloats(const std::vector<Vector>& values) {
    return asFloats(std::span<const Vector>(values));
}

void putWord(std::string& out, size_t value) {
    const auto word = static_cast<uint32_t>(value);
    char bytes[4];
    std::memcpy(bytes, &word, 4);
    out.append(bytes, 4);
}

/// Reads a word of a file that is long enough (checked before).
uint32_t getWord(std::span<const uint8_t> file, size_t at) {
    uint32_t word = 0;
    std::memcpy(&word, file.data() + at, sizeof(word));
    return word;
}

bool isArrayOf(const json& value, json::value_t type) {
    return value.is_array() && std::all_of(value.begin(), value.end(), [&](const json& element) {
               return element.type() == type;
           });
}

/// Whether additions keep a file's document valid: it has one scene, one buffer, which is in the
/// file, and the lists that the writer extends.
bool canExtend(const json& root) {
    const auto has = [&](const char* name, json::value_t type) {
        return !root.contains(name) || isArrayOf(root[name], type);
    };
    for (const char* name :
         {"accessors",
          "animations",
          "bufferViews",
          "buffers",
          "cameras",
          "images",
          "materials",
          "meshes",
          "nodes",
          "samplers",
          "scenes",
          "skins",
          "textures"})
        if (!has(name, json::value_t::object))
            return false;
    if (!has("extensionsUsed", json::value_t::string) ||
        root.value("buffers", json()).size() != 1 || root["buffers"][0].contains("uri") ||
        root.value("scenes", json()).size() != 1 ||
        !isArrayOf(root["scenes"][0].value("nodes", json::array()), json::value_t::number_unsigned))
        return false;
    const json nodes = root.value("nodes", json::array());
    return std::all_of(nodes.begin(), nodes.end(), [](const json& node) {
        const json extensions = node.value("extensions", json::object());
        return (!node.contains("name") || node["name"].is_string()) && extensions.is_object() &&
               extensions.value("KHR_physics_rigid_bodies", json::object()).is_object();
    });
}

/// Kinematic: a physics engine must keep the velocity and let no gravity bend it.
void setVelocity(json& node, const char* kind, glm::vec3 velocity) {
    json& motion = node["extensions"]["KHR_physics_rigid_bodies"]["motion"];
    motion["isKinematic"] = true;
    motion[kind] = toJson(velocity);
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

GltfWriter GltfWriter::open(const std::filesystem::path& path) {
    GltfWriter writer;
    writer.mError = writer.read(path);
    return writer;
}

std::string GltfWriter::read(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::vector<uint8_t> file(
        (std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>()
    );
    constexpr size_t kHeader = 12;
    constexpr size_t kChunkHeader = 8;
    const std::string refusal =
        fmt::format("{} is no binary glTF file with one scene and one buffer.", path.string());
    if (file.size() < kHeader + kChunkHeader || std::memcmp(file.data(), "glTF", 4) != 0) {
        return refusal;
    }
    const size_t text = kHeader + kChunkHeader;
    const size_t textBytes = getWord(file, kHeader);
    if (file.size() < text + textBytes + kChunkHeader) {
        return refusal;
    }
    const size_t binary = text + textBytes + kChunkHeader;
    const size_t binaryBytes = getWord(file, text + textBytes);
    json root = json::parse(file.data() + text, file.data() + text + textBytes, nullptr, false);
    if (!root.is_object() || !canExtend(root) || file.size() < binary + binaryBytes) {
        return refusal;
    }
    mRoot = std::move(root);
    mBuffer.assign(file.data() + binary, file.data() + binary + binaryBytes);
    useExtension("KHR_physics_rigid_bodies");
    return {};
}

void GltfWriter::useExtension(const char* name) {
    json& used = mRoot["extensionsUsed"];
    if (std::find(used.begin(), used.end(), name) == used.end()) {
        used.push_back(name);
    }
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
        {"baseColorFactor", {material.color.x, material.color.y, material.color.z, material.alpha}},
        {"metallicFactor", material.metallic},
        {"roughnessFactor", material.roughness}};
    if (material.texture != kNothing) {
        surface["baseColorTexture"] = {{"index", material.texture}};
    }
    json entry = {{"name", material.name}, {"pbrMetallicRoughness", surface}};
    if (material.alpha < 1.0f) {
        entry["alphaMode"] = "BLEND";
    }
    if (material.doubleSided) {
        entry["doubleSided"] = true;
    }
    const glm::vec3 light = material.emissive;
    const float brightest = std::max({light.x, light.y, light.z});
    if (brightest > 0.0f) {
        entry["emissiveFactor"] = toJson(light / std::max(brightest, 1.0f));
    }
    if (brightest > 1.0f) {
        entry["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = brightest;
        useExtension("KHR_materials_emissive_strength");
    }
    return addEntry(mRoot["materials"], entry);
}

json GltfWriter::addAttributes(const Shape& shape) {
    json attributes = {
        {"POSITION", addFloats(asFloats(shape.positions), 3, kArrayBuffer, true)},
        {"NORMAL", addFloats(asFloats(shape.normals), 3, kArrayBuffer, false)},
        {"TEXCOORD_0", addFloats(asFloats(shape.uvs), 2, kArrayBuffer, false)}};
    if (!shape.joints.empty()) {
        const Index view = addView(shape.joints.data(), shape.joints.size() * 8, kArrayBuffer);
        attributes["JOINTS_0"] = addEntry(
            mRoot["accessors"],
            {{"bufferView", view},
             {"componentType", kUnsignedShort},
             {"count", shape.joints.size()},
             {"type", "VEC4"}}
        );
        attributes["WEIGHTS_0"] = addFloats(asFloats(shape.weights), 4, kArrayBuffer, false);
    }
    if (!shape.slack.empty()) {
        std::vector<glm::vec4> colors;
        for (const float slack : shape.slack)
            colors.emplace_back(1.0f, 1.0f, 1.0f, slack);
        attributes["COLOR_0"] = addFloats(asFloats(colors), 4, kArrayBuffer, false);
    }
    return attributes;
}

Index GltfWriter::addMesh(const std::string& name, std::span<const MeshPart> parts) {
    json primitives = json::array();
    for (const MeshPart& part : parts) {
        json primitive = {
            {"attributes", addAttributes(part.shape)},
            {"indices", addIndices(part.shape.indices)},
            {"material", part.material}};
        for (const std::vector<glm::vec3>& target : part.targets)
            primitive["targets"].push_back(
                {{"POSITION", addFloats(asFloats(target), 3, kArrayBuffer, true)}}
            );
        primitives.push_back(primitive);
    }
    return addEntry(mRoot["meshes"], {{"name", name}, {"primitives", primitives}});
}

Index GltfWriter::addSkin(
    const std::string& name, std::span<const Index> joints, std::span<const glm::mat4> jointFromBind
) {
    const std::span<const float> values(&jointFromBind.front()[0][0], jointFromBind.size() * 16);
    const Index view = addView(values.data(), values.size_bytes(), kNoTarget);
    const Index matrices = addEntry(
        mRoot["accessors"],
        {{"bufferView", view},
         {"componentType", kFloat},
         {"count", jointFromBind.size()},
         {"type", "MAT4"}}
    );
    return addEntry(
        mRoot["skins"],
        {{"name", name},
         {"joints", std::vector<Index>(joints.begin(), joints.end())},
         {"inverseBindMatrices", matrices}}
    );
}

Index GltfWriter::addCamera(
    const std::string& name, float yFov, float nearMetres, const json& lens
) {
    json camera = {
        {"name", name},
        {"type", "perspective"},
        {"perspective", {{"aspectRatio", 16.0 / 9.0}, {"yfov", yFov}, {"znear", nearMetres}}}};
    if (!lens.is_null()) {
        camera["extras"]["lens"] = lens;
    }
    return addEntry(mRoot["cameras"], std::move(camera));
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
    if (node.skin != kNothing) {
        entry["skin"] = node.skin;
    }
    if (!node.waves.is_null()) {
        entry["extras"]["vertexWaves"] = node.waves;
    }
    if (!node.particles.is_null()) {
        entry["extras"]["particles"] = node.particles;
    }
    if (node.camera != kNothing) {
        entry["camera"] = node.camera;
    }
    if (node.light != kNothing) {
        entry["extensions"]["KHR_lights_punctual"]["light"] = node.light;
    }
    if (node.linearVelocity) {
        setVelocity(entry, "linearVelocity", *node.linearVelocity);
    }
    if (node.angularVelocity) {
        setVelocity(entry, "angularVelocity", *node.angularVelocity);
    }
    const Index index = addEntry(mRoot["nodes"], entry);
    json& siblings = node.parent == kNothing
                         ? mRoot["scenes"][0]["nodes"]
                         : mRoot["nodes"][static_cast<size_t>(node.parent)]["children"];
    siblings.push_back(index);
    return index;
}

void GltfWriter::moveNode(const std::string& name, glm::vec3 linearVelocity) {
    json& nodes = mRoot["nodes"];
    const auto found = std::find_if(nodes.begin(), nodes.end(), [&](const json& node) {
        return node.value("name", "") == name;
    });
    if (found != nodes.end()) {
        setVelocity(*found, "linearVelocity", linearVelocity);
    } else if (mError.empty()) {
        mError = fmt::format("The scene has no node \"{}\".", name);
    }
}

Index GltfWriter::addClip(const std::string& name) {
    return addEntry(
        mRoot["animations"],
        {{"name", name}, {"samplers", json::array()}, {"channels", json::array()}}
    );
}

void GltfWriter::addTranslations(
    Index clip, Index node, std::span<const float> times, std::span<const glm::vec3> values
) {
    addChannel(clip, node, "translation", times, addFloats(asFloats(values), 3, kNoTarget, false));
}

void GltfWriter::addRotations(
    Index clip, Index node, std::span<const float> times, std::span<const glm::quat> values
) {
    std::vector<glm::vec4> ordered;
    for (const glm::quat& q : values)
        ordered.emplace_back(q.x, q.y, q.z, q.w);
    addChannel(
        clip,
        node,
        "rotation",
        times,
        addFloats(asFloats(std::span<const glm::vec4>(ordered)), 4, kNoTarget, false)
    );
}

void GltfWriter::addScales(
    Index clip, Index node, std::span<const float> times, std::span<const glm::vec3> values
) {
    addChannel(clip, node, "scale", times, addFloats(asFloats(values), 3, kNoTarget, false));
}

void GltfWriter::addWeights(
    Index clip, Index node, std::span<const float> times, std::span<const float> values
) {
    addChannel(clip, node, "weights", times, addFloats(values, 1, kNoTarget, false));
}

void GltfWriter::addChannel(
    Index clip, Index node, const char* path, std::span<const float> times, Index output
) {
    const Index input = addFloats(times, 1, kNoTarget, true);
    json& animation = mRoot["animations"][static_cast<size_t>(clip)];
    const Index sampler = addEntry(
        animation["samplers"], {{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}
    );
    animation["channels"].push_back(
        {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}}
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
