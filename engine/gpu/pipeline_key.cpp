// SPDX-License-Identifier: MIT
#include "engine/gpu/pipeline_key.h"

#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

namespace shutter::gpu {

namespace {

/// Bytes in which every list is preceded by its length, so that different parts never give equal
/// keys.
class Key {
  public:
    explicit Key(char kind) : mBytes(1, kind) {}

    template <typename T>
    requires std::is_trivially_copyable_v<T>

    void add(const T& value) { mBytes.append(reinterpret_cast<const char*>(&value), sizeof value); }

    template <typename T> void addList(std::span<const T> values) {
        add(values.size());
        mBytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    }

    /// Adds the parts that all kinds have.
    template <typename Desc> void addShared(const Desc& desc) {
        addList(std::span<const char>(desc.name));
        addList(std::span(desc.interface.bindings.data(), desc.interface.bindings.size()));
        add(desc.interface.pushConstantBytes);
        add(desc.interface.sceneLayout);
        addList(std::span(desc.specialization.data(), desc.specialization.size()));
    }

    [[nodiscard]] std::string take() { return std::move(mBytes); }

  private:
    std::string mBytes;
};

} // namespace

std::string makePipelineKey(const ComputePipelineDesc& desc) {
    Key key('c');
    key.addShared(desc);
    key.addList(desc.spirv);
    key.add(desc.subgroupSize);
    return key.take();
}

std::string makePipelineKey(const GraphicsPipelineDesc& desc) {
    Key key('g');
    key.addShared(desc);
    key.addList(desc.vertexSpirv);
    key.addList(desc.fragmentSpirv);
    key.addList(std::span(desc.colorFormats.data(), desc.colorFormats.size()));
    key.add(desc.depthFormat);
    key.add(desc.depthCompare);
    key.add(desc.depthWrite);
    key.add(desc.blend);
    key.add(desc.samples);
    return key.take();
}

std::string makePipelineKey(const RayPipelineDesc& desc) {
    Key key('r');
    key.addShared(desc);
    key.addList(desc.raygenSpirv);
    key.addList(desc.missSpirv);
    key.addList(desc.closestHitSpirv);
    key.addList(desc.anyHitSpirv);
    return key.take();
}

} // namespace shutter::gpu
