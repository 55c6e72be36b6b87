// SPDX-License-Identifier: MIT
#include "engine/graph/graph.h"

#include "engine/core/check.h"
#include "engine/gpu/memory.h"

#include <fmt/format.h>

#include <atomic>

namespace shutter::graph {

ClearColor ClearColor::floats(float r, float g, float b, float a) {
    ClearColor color{};
    color.f[0] = r;
    color.f[1] = g;
    color.f[2] = b;
    color.f[3] = a;
    return color;
}

ClearColor ClearColor::uints(uint32_t r) {
    ClearColor color{};
    for (uint32_t& channel : color.u)
        channel = 0;
    color.u[0] = r;
    return color;
}

Graph::Graph() {
    static std::atomic<uint32_t> next = 1; // 0 is the id of a default-constructed handle
    mId = next++;
}

template <class Handle> Handle Graph::addResource(ResourceRecord record) {
    mResources.push_back(std::move(record));
    return Handle{static_cast<uint32_t>(mResources.size() - 1), 0, mId};
}

ImageHandle Graph::createImage(std::string name, const TransientImageDesc& desc) {
    ResourceRecord record;
    record.name = std::move(name);
    record.imageDesc = desc;
    return addResource<ImageHandle>(std::move(record));
}

BufferHandle Graph::createBuffer(std::string name, const TransientBufferDesc& desc) {
    ResourceRecord record;
    record.name = std::move(name);
    record.isImage = false;
    record.bufferDesc = desc;
    return addResource<BufferHandle>(std::move(record));
}

ImageHandle Graph::importImage(
    std::string name,
    const gpu::Image& image,
    VkImageLayout initialLayout,
    VkImageLayout finalLayout
) {
    ResourceRecord record;
    record.name = std::move(name);
    record.imported = true;
    record.imageDesc = {image.desc().width, image.desc().height, image.desc().format};
    record.importedImage = &image;
    record.initialLayout = initialLayout;
    record.finalLayout = finalLayout;
    return addResource<ImageHandle>(std::move(record));
}

ImageHandle Graph::importImage(
    std::string name, const gpu::Image& image, const OutsideUse& before, const OutsideUse& after
) {
    const ImageHandle handle = importImage(std::move(name), image, before.layout, after.layout);
    mResources.back().before = before;
    mResources.back().after = after;
    return handle;
}

BufferHandle Graph::importBuffer(std::string name, VkBuffer buffer, VkDeviceSize bytes) {
    ResourceRecord record;
    record.name = std::move(name);
    record.isImage = false;
    record.imported = true;
    record.bufferDesc.bytes = bytes;
    record.importedBuffer = buffer;
    return addResource<BufferHandle>(std::move(record));
}

bool Graph::admit(uint32_t graph, uint32_t resource, uint32_t version, const std::string& user) {
    if (graph == mId && resource < mResources.size() && version < mResources[resource].versionCount)
        return true;
    mProblems.push_back(fmt::format("{} uses a handle that this graph never gave out", user));
    return false;
}

void Graph::markOutput(ImageHandle image) {
    if (admit(image.graph, image.resource, image.version, "an output"))
        mOutputs.emplace_back(image.resource, image.version);
}

void Graph::markOutput(BufferHandle buffer) {
    if (admit(buffer.graph, buffer.resource, buffer.version, "an output"))
        mOutputs.emplace_back(buffer.resource, buffer.version);
}

ImageHandle Graph::findImage(uint32_t resource, uint32_t version) const {
    SHUTTER_CHECK(
        resource < mResources.size() && mResources[resource].isImage &&
            version < mResources[resource].versionCount,
        "there is no version {} of an image {}",
        version,
        resource
    );
    return {resource, version, mId};
}

const TransientImageDesc& Graph::describeImage(ImageHandle image) const {
    SHUTTER_CHECK(
        image.graph == mId && image.resource < mResources.size(),
        "image handle {} of graph {} used with graph {}",
        image.resource,
        image.graph,
        mId
    );
    return mResources[image.resource].imageDesc;
}

std::string PassBuilder::title() const {
    return fmt::format("pass '{}'", mPass.name);
}

void PassBuilder::addRead(uint32_t resource, uint32_t version, Access access) {
    if (isWrite(access)) {
        mGraph.mProblems.push_back(fmt::format(
            "{} reads '{}' with an access that writes ({})",
            title(),
            mGraph.mResources[resource].name,
            describe(access)
        ));
        return;
    }
    for (const ResourceUse& use : mPass.uses)
        if (use.resource == resource && use.readVersion == version && use.access == access &&
            use.writeVersion == kNoVersion)
            return;
    mPass.uses.push_back({resource, version, kNoVersion, access});
}

uint32_t PassBuilder::addWrite(uint32_t resource, uint32_t version, Access access, bool clears) {
    ResourceRecord& record = mGraph.mResources[resource];
    if (!isWrite(access))
        mGraph.mProblems.push_back(fmt::format(
            "{} writes '{}' with an access that only reads ({})",
            title(),
            record.name,
            describe(access)
        ));
    else if (version + 1 != record.versionCount)
        mGraph.mProblems.push_back(
            fmt::format("{} writes an old version of '{}'", title(), record.name)
        );
    const bool holdsSomething = version > 0 || record.hasContentsAtStart();
    const uint32_t made = record.versionCount++;
    mPass.uses.push_back({resource, clears || !holdsSomething ? kNoVersion : version, made, access}
    );
    return made;
}

ImageHandle PassBuilder::read(ImageHandle image, Access access) {
    if (mGraph.admit(image.graph, image.resource, image.version, title()))
        addRead(image.resource, image.version, access);
    return image;
}

BufferHandle PassBuilder::read(BufferHandle buffer, Access access) {
    if (mGraph.admit(buffer.graph, buffer.resource, buffer.version, title()))
        addRead(buffer.resource, buffer.version, access);
    return buffer;
}

ImageHandle PassBuilder::write(ImageHandle image, Access access) {
    if (access == Access::ColorAttachment)
        return colorTarget(image, std::nullopt);
    if (access == Access::DepthAttachment)
        return depthTarget(image, std::nullopt);
    if (mGraph.admit(image.graph, image.resource, image.version, title()))
        image.version = addWrite(image.resource, image.version, access, false);
    return image;
}

BufferHandle PassBuilder::write(BufferHandle buffer, Access access) {
    if (mGraph.admit(buffer.graph, buffer.resource, buffer.version, title()))
        buffer.version = addWrite(buffer.resource, buffer.version, access, false);
    return buffer;
}

ImageHandle PassBuilder::colorTarget(ImageHandle image, std::optional<ClearColor> clear) {
    if (!mGraph.admit(image.graph, image.resource, image.version, title()))
        return image;
    image.version =
        addWrite(image.resource, image.version, Access::ColorAttachment, clear.has_value());
    mPass.colorTargets.push_back({image.resource, clear});
    return image;
}

ImageHandle PassBuilder::depthTarget(ImageHandle image, std::optional<float> clear) {
    if (!mGraph.admit(image.graph, image.resource, image.version, title()))
        return image;
    image.version =
        addWrite(image.resource, image.version, Access::DepthAttachment, clear.has_value());
    if (mPass.depthTarget)
        mGraph.mProblems.push_back(fmt::format(
            "{} has two depth targets, '{}' and '{}'",
            title(),
            mGraph.mResources[mPass.depthTarget->resource].name,
            mGraph.mResources[image.resource].name
        ));
    mPass.depthTarget = DepthTarget{image.resource, clear};
    return image;
}

void PassBuilder::startBatch() {
    mPass.startsBatch = true;
}

void PassBuilder::sideEffect() {
    mPass.hasSideEffect = true;
}

} // namespace shutter::graph
