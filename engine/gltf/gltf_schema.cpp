// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_document.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace shutter::gltf {

namespace {

using nlohmann::json;

enum class Kind {
    Index,      ///< into the root array named by `target`
    IndexArray, ///< array of such indices
    IndexMap,   ///< object whose values are such indices
    IndexMaps,  ///< array of such objects
    Whole,      ///< 0 .. 2^53
    Int,        ///< 0 .. 2^31 - 1
    Number,     ///< finite (JSON has no other numbers)
    Numbers,    ///< array of `length` numbers; of any length where `length` is 0
    String,
    Choice, ///< string, one of the words in `target`, which '|' separates
    Boolean,
    Object,     ///< checked against `members`
    Array,      ///< of objects checked against `members`
    Extensions, ///< object of objects
};

struct Field {
    std::string_view key;
    Kind kind;
    std::string_view target{};
    std::span<const Field> members{};
    size_t length = 0;
    bool required = false;
};

constexpr Field index(std::string_view key, std::string_view target, bool required = false) {
    return {key, Kind::Index, target, {}, 0, required};
}

constexpr Field plain(std::string_view key, Kind kind, bool required = false) {
    return {key, kind, {}, {}, 0, required};
}

constexpr Field choice(std::string_view key, std::string_view choices) {
    return {key, Kind::Choice, choices, {}, 0, true};
}

constexpr Field numbers(std::string_view key, size_t length) {
    return {key, Kind::Numbers, {}, {}, length, false};
}

constexpr Field
nested(std::string_view key, Kind kind, std::span<const Field> members, bool required = false) {
    return {key, kind, {}, members, 0, required};
}

constexpr Field kName = plain("name", Kind::String);
constexpr Field kExtensions = plain("extensions", Kind::Extensions);

constexpr Field kBuffer[] = {
    kName,
    kExtensions,
    plain("byteLength", Kind::Whole, true),
    plain("uri", Kind::String),
};
constexpr Field kBufferView[] = {
    kName,
    kExtensions,
    index("buffer", "buffers", true),
    plain("byteOffset", Kind::Whole),
    plain("byteLength", Kind::Whole, true),
    plain("byteStride", Kind::Whole),
    plain("target", Kind::Int),
};
constexpr Field kSparseIndices[] = {
    index("bufferView", "bufferViews", true),
    plain("byteOffset", Kind::Int),
    plain("componentType", Kind::Int, true),
};
constexpr Field kSparseValues[] = {
    index("bufferView", "bufferViews", true),
    plain("byteOffset", Kind::Int),
};
constexpr Field kSparse[] = {
    plain("count", Kind::Int, true),
    nested("indices", Kind::Object, kSparseIndices, true),
    nested("values", Kind::Object, kSparseValues, true),
};
constexpr Field kAccessor[] = {
    kName,
    kExtensions,
    index("bufferView", "bufferViews"),
    plain("byteOffset", Kind::Whole),
    plain("componentType", Kind::Int, true),
    plain("normalized", Kind::Boolean),
    plain("count", Kind::Whole, true),
    choice("type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"),
    nested("sparse", Kind::Object, kSparse),
};
constexpr Field kTextureInfo[] = {
    kExtensions,
    index("index", "textures", true),
    plain("texCoord", Kind::Int),
    plain("scale", Kind::Number),
    plain("strength", Kind::Number),
};
constexpr Field kPbr[] = {
    kExtensions,
    numbers("baseColorFactor", 4),
    plain("metallicFactor", Kind::Number),
    plain("roughnessFactor", Kind::Number),
    nested("baseColorTexture", Kind::Object, kTextureInfo),
    nested("metallicRoughnessTexture", Kind::Object, kTextureInfo),
};
constexpr Field kMaterial[] = {
    kName,
    kExtensions,
    nested("pbrMetallicRoughness", Kind::Object, kPbr),
    nested("normalTexture", Kind::Object, kTextureInfo),
    nested("occlusionTexture", Kind::Object, kTextureInfo),
    nested("emissiveTexture", Kind::Object, kTextureInfo),
    numbers("emissiveFactor", 3),
    plain("alphaMode", Kind::String),
    plain("alphaCutoff", Kind::Number),
    plain("doubleSided", Kind::Boolean),
};
constexpr Field kTexture[] = {
    kName,
    kExtensions,
    index("sampler", "samplers"),
    index("source", "images"),
};
constexpr Field kImage[] = {
    kName,
    kExtensions,
    plain("uri", Kind::String),
    plain("mimeType", Kind::String),
    index("bufferView", "bufferViews"),
};
constexpr Field kSampler[] = {
    kName,
    kExtensions,
    plain("magFilter", Kind::Int),
    plain("minFilter", Kind::Int),
    plain("wrapS", Kind::Int),
    plain("wrapT", Kind::Int),
};
constexpr Field kPrimitive[] = {
    kExtensions,
    {"attributes", Kind::IndexMap, "accessors", {}, 0, true},
    index("indices", "accessors"),
    index("material", "materials"),
    plain("mode", Kind::Int),
    {"targets", Kind::IndexMaps, "accessors"},
};
constexpr Field kMesh[] = {
    kName,
    kExtensions,
    nested("primitives", Kind::Array, kPrimitive, true),
    numbers("weights", 0),
};
constexpr Field kNode[] = {
    kName,
    kExtensions,
    index("camera", "cameras"),
    index("mesh", "meshes"),
    index("skin", "skins"),
    {"children", Kind::IndexArray, "nodes"},
    numbers("matrix", 16),
    numbers("translation", 3),
    numbers("rotation", 4),
    numbers("scale", 3),
    numbers("weights", 0),
};
constexpr Field kScene[] = {kName, kExtensions, {"nodes", Kind::IndexArray, "nodes"}};
constexpr Field kSkin[] = {
    kName,
    kExtensions,
    index("inverseBindMatrices", "accessors"),
    index("skeleton", "nodes"),
    {"joints", Kind::IndexArray, "nodes", {}, 0, true},
};
constexpr Field kAnimationSampler[] = {
    kExtensions,
    index("input", "accessors", true),
    index("output", "accessors", true),
    plain("interpolation", Kind::String),
};
constexpr Field kTarget[] = {
    kExtensions,
    index("node", "nodes"),
    plain("path", Kind::String, true),
};
constexpr Field kChannel[] = {
    kExtensions,
    plain("sampler", Kind::Int, true), // into the animation's own samplers; see gltf_animation.cpp
    nested("target", Kind::Object, kTarget, true),
};
constexpr Field kAnimation[] = {
    kName,
    kExtensions,
    nested("channels", Kind::Array, kChannel, true),
    nested("samplers", Kind::Array, kAnimationSampler, true),
};
constexpr Field kPerspective[] = {
    plain("aspectRatio", Kind::Number),
    plain("yfov", Kind::Number, true),
    plain("zfar", Kind::Number),
    plain("znear", Kind::Number, true),
};
constexpr Field kOrthographic[] = {
    plain("xmag", Kind::Number, true),
    plain("ymag", Kind::Number, true),
    plain("zfar", Kind::Number, true),
    plain("znear", Kind::Number, true),
};
constexpr Field kCamera[] = {
    kName,
    kExtensions,
    choice("type", "perspective|orthographic"),
    nested("perspective", Kind::Object, kPerspective),
    nested("orthographic", Kind::Object, kOrthographic),
};
constexpr Field kRoot[] = {
    kExtensions,
    nested("buffers", Kind::Array, kBuffer),
    nested("bufferViews", Kind::Array, kBufferView),
    nested("accessors", Kind::Array, kAccessor),
    nested("materials", Kind::Array, kMaterial),
    nested("textures", Kind::Array, kTexture),
    nested("images", Kind::Array, kImage),
    nested("samplers", Kind::Array, kSampler),
    nested("meshes", Kind::Array, kMesh),
    nested("nodes", Kind::Array, kNode),
    nested("skins", Kind::Array, kSkin),
    nested("cameras", Kind::Array, kCamera),
    nested("animations", Kind::Array, kAnimation),
    nested("scenes", Kind::Array, kScene),
    index("scene", "scenes"),
};

class Checker {
  public:
    explicit Checker(json& root) : mRoot(root) {}

    void checkMembers(json& object, std::span<const Field> members, const std::string& path) {
        for (const Field& field : members) {
            const auto it = object.find(field.key);
            const std::string fieldPath =
                path.empty() ? std::string(field.key) : fmt::format("{}.{}", path, field.key);
            if (it != object.end()) {
                checkField(*it, field, fieldPath);
            } else if (field.required) {
                failGltf("{} is missing", fieldPath);
            }
        }
    }

  private:
    static constexpr uint64_t kMaxWhole = uint64_t(1) << 53;
    static constexpr uint64_t kMaxInt = uint64_t(std::numeric_limits<int32_t>::max());

    void checkField(json& value, const Field& field, const std::string& path) {
        switch (field.kind) {
        case Kind::Index:
            return checkIndex(value, field.target, path);
        case Kind::IndexArray:
            return forEachElement(value, path, [&](json& element, const std::string& at) {
                checkIndex(element, field.target, at);
            });
        case Kind::IndexMap:
            return checkIndexMap(value, field.target, path);
        case Kind::IndexMaps:
            return forEachElement(value, path, [&](json& element, const std::string& at) {
                checkIndexMap(element, field.target, at);
            });
        case Kind::Whole:
            return checkWhole(value, kMaxWhole, path);
        case Kind::Int:
            return checkWhole(value, kMaxInt, path);
        case Kind::Numbers:
            return checkNumbers(value, field.length, path);
        case Kind::Array:
            return forEachElement(value, path, [&](json& element, const std::string& at) {
                expect(element.is_object(), at, "an object");
                checkMembers(element, field.members, at);
            });
        case Kind::Object:
            expect(value.is_object(), path, "an object");
            return checkMembers(value, field.members, path);
        case Kind::Extensions:
            return checkExtensions(value, path);
        case Kind::Number:
            return expect(value.is_number(), path, "a number");
        case Kind::String:
            return expect(value.is_string(), path, "a string");
        case Kind::Choice:
            return checkChoice(value, field.target, path);
        case Kind::Boolean:
            return expect(value.is_boolean(), path, "true or false");
        }
    }

    static void expect(bool holds, const std::string& path, std::string_view what) {
        if (!holds)
            failGltf("{} is not {}", path, what);
    }

    static void checkChoice(const json& value, std::string_view choices, const std::string& path) {
        expect(value.is_string(), path, "a string");
        const std::string text = value.get<std::string>();
        for (size_t begin = 0; begin <= choices.size();) {
            const size_t end = std::min(choices.find('|', begin), choices.size());
            if (choices.substr(begin, end - begin) == text)
                return;
            begin = end + 1;
        }
        failGltf("{} is '{}', not one of {}", path, text, choices);
    }

    template <class F> static void forEachElement(json& value, const std::string& path, F&& visit) {
        expect(value.is_array(), path, "an array");
        for (size_t i = 0; i < value.size(); ++i) {
            visit(value[i], fmt::format("{}[{}]", path, i));
        }
    }

    /// Rewrites `value` to an unsigned integer.
    static void checkWhole(json& value, uint64_t max, const std::string& path) {
        expect(value.is_number(), path, "a number");
        if (!value.is_number_unsigned()) {
            const double number = value.get<double>();
            if (!(number >= 0.0 && number <= double(max) && number == std::floor(number))) {
                failGltf("{} is {}, not a whole number from 0 to {}", path, value.dump(), max);
            }
            value = uint64_t(number);
        }
        if (value.get<uint64_t>() > max) {
            failGltf("{} is {}, above the limit of {}", path, value.dump(), max);
        }
    }

    void checkIndex(json& value, std::string_view target, const std::string& path) const {
        checkWhole(value, kMaxInt, path);
        const auto array = mRoot.find(target);
        const size_t count = array != mRoot.end() && array->is_array() ? array->size() : 0;
        if (value.get<uint64_t>() >= count) {
            const size_t ending = target == "meshes" ? 2 : 1; // of the plural
            const std::string_view one = target.substr(0, target.size() - ending);
            failGltf("{} is {}, but {}", path, value.dump(), core::thereAre(count, one, target));
        }
    }

    void checkIndexMap(json& value, std::string_view target, const std::string& path) const {
        expect(value.is_object(), path, "an object");
        for (auto it = value.begin(); it != value.end(); ++it) {
            checkIndex(it.value(), target, fmt::format("{}.{}", path, it.key()));
        }
    }

    static void checkNumbers(json& value, size_t length, const std::string& path) {
        expect(value.is_array(), path, "an array");
        if (length != 0 && value.size() != length) {
            failGltf("{} has {}, not {}", path, core::countOf(value.size(), "number"), length);
        }
        for (const json& element : value) {
            if (!element.is_number())
                failGltf("{} holds a value that is no number", path);
        }
    }

    static void checkExtensions(json& value, const std::string& path) {
        expect(value.is_object(), path, "an object");
        for (auto it = value.begin(); it != value.end(); ++it) {
            expect(it.value().is_object(), fmt::format("{}.{}", path, it.key()), "an object");
        }
    }

    json& mRoot;
};

} // namespace

void checkGltfSchema(json& root) {
    Checker(root).checkMembers(root, kRoot, "");
}

} // namespace shutter::gltf
