// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_values.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace shutter::gltf {

namespace {

/// Limit of the elements of an accessor without a buffer view, whose size no buffer bounds.
constexpr size_t kMaxZeroElements = size_t(1) << 24;

/// Elements inside a buffer view, checked to lie inside it.
struct Elements {
    const uint8_t* data = nullptr;
    size_t stride = 0;
};

size_t componentBytes(int componentType) {
    switch (componentType) {
    case kInt8:
    case kUint8:
        return 1;
    case kInt16:
    case kUint16:
        return 2;
    case kUint32:
    case kFloat32:
        return 4;
    default:
        return 0;
    }
}

size_t elementBytes(const tinygltf::Accessor& accessor) {
    return componentCount(accessor) * componentBytes(accessor.componentType);
}

/// Checks that `count` elements of `size` bytes from `offset` on lie inside the view.
Elements locate(
    const GltfContext& context,
    int viewIndex,
    uint64_t offset,
    uint64_t count,
    uint64_t size,
    bool honourStride,
    const std::string& path
) {
    const tinygltf::BufferView& view = context.model.bufferViews[size_t(viewIndex)];
    const uint64_t stride = honourStride && view.byteStride != 0 ? view.byteStride : size;
    if (stride < size) {
        failGltf("{}: byteStride {} is below the element size of {} bytes", path, stride, size);
    }
    // By the schema all terms are below 2^53 and the stride is at most 252, so only the product
    // with count could wrap; the division avoids it.
    const bool fits = offset <= view.byteLength && size <= view.byteLength - offset &&
                      (count - 1) <= (view.byteLength - offset - size) / stride;
    if (!fits) {
        failGltf(
            "{} reads past bufferViews[{}]: {} of {} at offset {}, but it has {}",
            path,
            viewIndex,
            core::countOf(count, "element"),
            core::countOf(size, "byte"),
            offset,
            core::countOf(view.byteLength, "byte")
        );
    }
    const std::span<const uint8_t> buffer = context.resources.buffer(size_t(view.buffer));
    return {buffer.data() + view.byteOffset + offset, size_t(stride)};
}

Elements locateDense(const GltfContext& context, size_t index) {
    const tinygltf::Accessor& accessor = context.model.accessors[index];
    return locate(
        context,
        accessor.bufferView,
        accessor.byteOffset,
        accessor.count,
        elementBytes(accessor),
        true,
        fmt::format("accessors[{}]", index)
    );
}

struct SparseElements {
    Elements indices;
    Elements values;
};

SparseElements locateSparse(const GltfContext& context, size_t index) {
    const tinygltf::Accessor& accessor = context.model.accessors[index];
    const auto& sparse = accessor.sparse;
    const int indexType = sparse.indices.componentType;
    const std::string path = fmt::format("accessors[{}].sparse", index);
    if (indexType != kUint8 && indexType != kUint16 && indexType != kUint32) {
        failGltf("{}.indices.componentType {} is no unsigned integer", path, indexType);
    }
    if (sparse.count < 1 || size_t(sparse.count) > accessor.count) {
        failGltf(
            "{}.count is {}, but the accessor has {}",
            path,
            sparse.count,
            core::countOf(accessor.count, "element")
        );
    }
    const auto count = uint64_t(sparse.count);
    SparseElements found;
    found.indices = locate(
        context,
        sparse.indices.bufferView,
        uint64_t(sparse.indices.byteOffset),
        count,
        componentBytes(indexType),
        false,
        path + ".indices"
    );
    found.values = locate(
        context,
        sparse.values.bufferView,
        uint64_t(sparse.values.byteOffset),
        count,
        elementBytes(accessor),
        false,
        path + ".values"
    );
    return found;
}

template <class T> T load(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T)); // buffers are not aligned for T
    return value;
}

uint32_t loadUnsigned(const uint8_t* bytes, int componentType) {
    switch (componentType) {
    case kUint8:
        return *bytes;
    case kUint16:
        return load<uint16_t>(bytes);
    default:
        return load<uint32_t>(bytes);
    }
}

/// Divides by the largest value and clamps, so that -128 is -1 too (glTF 2.0, 3.11).
template <class T> float scaleNormalized(T value) {
    constexpr auto kMax = float(std::numeric_limits<T>::max());
    return std::max(float(value) / kMax, -1.0f);
}

template <class T> float convert(const uint8_t* bytes, bool normalized) {
    const T value = load<T>(bytes);
    if constexpr (std::is_same_v<T, float>)
        return value;
    return normalized ? scaleNormalized(value) : float(value);
}

float loadFloat(const uint8_t* bytes, int componentType, bool normalized) {
    switch (componentType) {
    case kInt8:
        return convert<int8_t>(bytes, normalized);
    case kUint8:
        return convert<uint8_t>(bytes, normalized);
    case kInt16:
        return convert<int16_t>(bytes, normalized);
    case kUint16:
        return convert<uint16_t>(bytes, normalized);
    case kUint32:
        return convert<uint32_t>(bytes, normalized);
    default:
        return convert<float>(bytes, normalized);
    }
}

void checkUse(size_t index, const tinygltf::Accessor& accessor, const AccessorUse& use) {
    const auto accepts = [](const std::vector<int>& list, int value) {
        return std::find(list.begin(), list.end(), value) != list.end();
    };
    if (!accepts(use.types, accessor.type)) {
        failGltf("{}: accessors[{}].type does not fit this use", use.use, index);
    }
    if (!accepts(use.componentTypes, accessor.componentType)) {
        failGltf(
            "{}: accessors[{}].componentType {} does not fit this use",
            use.use,
            index,
            accessor.componentType
        );
    }
    const bool isInteger = accessor.componentType != kFloat32;
    if (use.integersMustBeNormalized && isInteger && !accessor.normalized) {
        failGltf("{}: accessors[{}] holds integers that are not normalized", use.use, index);
    }
}

/// Reads the dense part, then overwrites elements with the sparse values.
template <class T, class LoadComponent>
std::vector<T> readElements(GltfContext& context, size_t index, LoadComponent&& loadComponent) {
    const tinygltf::Accessor& accessor = context.model.accessors[index];
    const size_t components = componentCount(accessor);
    const size_t bytes = componentBytes(accessor.componentType);
    // checkAccessors bounds count by the buffer's size only where there is a buffer view.
    if (accessor.bufferView < 0 && accessor.count > kMaxZeroElements) {
        failGltf(
            "accessors[{}].count is {}, above the limit of {} without a bufferView",
            index,
            accessor.count,
            kMaxZeroElements
        );
    }
    context.spendVertexBytes(accessor.count * components * sizeof(T));
    std::vector<T> values(accessor.count * components, T(0));
    const auto loadElement = [&](const uint8_t* source, size_t element) {
        for (size_t c = 0; c < components; ++c) {
            values[element * components + c] = loadComponent(source + c * bytes);
        }
    };
    if (accessor.bufferView >= 0) {
        const Elements dense = locateDense(context, index);
        for (size_t i = 0; i < accessor.count; ++i)
            loadElement(dense.data + i * dense.stride, i);
    }
    if (!accessor.sparse.isSparse)
        return values;
    const SparseElements sparse = locateSparse(context, index);
    uint64_t nextAllowed = 0; // indices must increase
    for (size_t i = 0; i < size_t(accessor.sparse.count); ++i) {
        const uint32_t element = loadUnsigned(
            sparse.indices.data + i * sparse.indices.stride, accessor.sparse.indices.componentType
        );
        if (element >= accessor.count || element < nextAllowed) {
            failGltf(
                "accessors[{}].sparse.indices holds {}, not between {} and {}",
                index,
                element,
                nextAllowed,
                accessor.count - 1
            );
        }
        nextAllowed = uint64_t(element) + 1;
        loadElement(sparse.values.data + i * sparse.values.stride, element);
    }
    return values;
}

} // namespace

size_t componentCount(const tinygltf::Accessor& accessor) {
    switch (accessor.type) {
    case TINYGLTF_TYPE_SCALAR:
        return 1;
    case TINYGLTF_TYPE_VEC2:
        return 2;
    case TINYGLTF_TYPE_VEC3:
        return 3;
    case TINYGLTF_TYPE_VEC4:
    case TINYGLTF_TYPE_MAT2:
        return 4;
    case TINYGLTF_TYPE_MAT3:
        return 9;
    default:
        return 16;
    }
}

void checkAccessors(const GltfContext& context) {
    const tinygltf::Model& model = context.model;
    for (size_t i = 0; i < model.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = model.bufferViews[i];
        const size_t available = context.resources.buffer(size_t(view.buffer)).size();
        if (view.byteLength == 0)
            failGltf("bufferViews[{}].byteLength is 0", i);
        if (view.byteOffset > available || view.byteLength > available - view.byteOffset) {
            failGltf(
                "bufferViews[{}] reads bytes {} to {}, but buffers[{}] has {}",
                i,
                view.byteOffset,
                view.byteOffset + view.byteLength,
                view.buffer,
                available
            );
        }
    }
    for (size_t i = 0; i < model.accessors.size(); ++i) {
        const tinygltf::Accessor& accessor = model.accessors[i];
        if (componentBytes(accessor.componentType) == 0) {
            failGltf("accessors[{}].componentType {} is unknown", i, accessor.componentType);
        }
        if (accessor.count == 0)
            failGltf("accessors[{}].count is 0", i);
        if (accessor.bufferView >= 0)
            (void)locateDense(context, i);
        if (accessor.sparse.isSparse)
            (void)locateSparse(context, i);
    }
}

std::vector<float> readFloats(GltfContext& context, size_t index, const AccessorUse& use) {
    const tinygltf::Accessor& accessor = context.model.accessors[index];
    checkUse(index, accessor, use);
    return readElements<float>(context, index, [&](const uint8_t* bytes) {
        return loadFloat(bytes, accessor.componentType, accessor.normalized);
    });
}

std::vector<uint32_t> readUnsigned(GltfContext& context, size_t index, const AccessorUse& use) {
    const tinygltf::Accessor& accessor = context.model.accessors[index];
    checkUse(index, accessor, use);
    return readElements<uint32_t>(context, index, [&](const uint8_t* bytes) {
        return loadUnsigned(bytes, accessor.componentType);
    });
}

} // namespace shutter::gltf
