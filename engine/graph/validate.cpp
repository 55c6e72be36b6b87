// SPDX-License-Identifier: MIT
#include "engine/gpu/memory.h"
#include "engine/graph/compile_stages.h"

namespace shutter::graph {

namespace {

const char* describe(PassKind kind) {
    switch (kind) {
    case PassKind::Compute:
        return "compute";
    case PassKind::Raster:
        return "raster";
    case PassKind::Transfer:
        return "transfer";
    case PassKind::Build:
        return "build";
    case PassKind::RayTracing:
        return "ray tracing";
    }
    return "unknown";
}

core::Status checkTransient(const ResourceRecord& resource) {
    const TransientImageDesc& desc = resource.imageDesc;
    if (!resource.isImage || resource.imported)
        return {};
    if (desc.width == 0 || desc.height == 0)
        return core::makeError("image '{}' is {} x {}", resource.name, desc.width, desc.height);
    if (desc.format == VK_FORMAT_UNDEFINED)
        return core::makeError("image '{}' has no format", resource.name);
    return {};
}

bool isWritten(const ResourceRecord& resource) {
    return resource.versionCount > 1;
}

/// One object under two names is invisible to the barriers, unless both only read it.
core::Status checkImports(const Graph& graph) {
    const auto& resources = graph.resources();
    for (size_t i = 0; i < resources.size(); ++i)
        for (size_t j = i + 1; j < resources.size(); ++j) {
            const ResourceRecord& a = resources[i];
            const ResourceRecord& b = resources[j];
            // Two images of one object also disagree on its layout, so not even reads are safe.
            const bool sameImage = a.importedImage && a.importedImage == b.importedImage;
            const bool sameBuffer = a.importedBuffer && a.importedBuffer == b.importedBuffer;
            if (sameImage || (sameBuffer && (isWritten(a) || isWritten(b))))
                return core::makeError(
                    "'{}' and '{}' import the same {}",
                    a.name,
                    b.name,
                    sameImage ? "image" : "buffer"
                );
        }
    return {};
}

core::Status checkSamples(const PassRecord& pass, const ResourceRecord& resource, Access access) {
    const bool mayHaveSeveral =
        access == Access::ColorAttachment || access == Access::DepthAttachment ||
        access == Access::SampledCompute || access == Access::SampledFragment;
    if (!resource.isImage || resource.imageDesc.samples == 1 || mayHaveSeveral)
        return {};
    return core::makeError(
        "pass '{}' uses '{}' as {}, but it has {} samples per pixel",
        pass.name,
        resource.name,
        describe(access),
        resource.imageDesc.samples
    );
}

core::Status checkFormat(const PassRecord& pass, const ResourceRecord& resource, Access access) {
    const VkFormat format = resource.imageDesc.format;
    if (!resource.isImage || format == VK_FORMAT_UNDEFINED)
        return {};
    const bool isColor = (gpu::aspectOf(format) & VK_IMAGE_ASPECT_COLOR_BIT) != 0;
    const bool needsDepth = access == Access::DepthAttachment;
    const bool needsColor = access == Access::ColorAttachment || access == Access::StorageRead ||
                            access == Access::StorageWrite ||
                            access == Access::StorageWriteDisjoint ||
                            access == Access::OutsideWrite;
    if ((needsDepth && isColor) || (needsColor && !isColor))
        return core::makeError(
            "pass '{}' uses '{}' as {}, but its format is a {} format",
            pass.name,
            resource.name,
            describe(access),
            isColor ? "colour" : "depth"
        );
    return {};
}

core::Status checkUse(const Graph& graph, const PassRecord& pass, const ResourceUse& use) {
    const ResourceRecord& resource = graph.resources()[use.resource];
    if (!fitsPass(use.access, pass.kind))
        return core::makeError(
            "pass '{}' uses '{}' as {}, which a {} pass cannot do",
            pass.name,
            resource.name,
            describe(use.access),
            describe(pass.kind)
        );
    if (!(resource.isImage ? fitsImage(use.access) : fitsBuffer(use.access)))
        return core::makeError(
            "pass '{}' uses '{}' as {}, which {} cannot be",
            pass.name,
            resource.name,
            describe(use.access),
            resource.isImage ? "an image" : "a buffer"
        );
    if (use.access == Access::HostRead && !resource.imported)
        return core::makeError(
            "pass '{}' makes the host read '{}', which is transient and not mapped",
            pass.name,
            resource.name
        );
    if (use.readVersion == 0 && !resource.hasContentsAtStart())
        return core::makeError(
            "pass '{}' reads '{}' that no pass writes", pass.name, resource.name
        );
    SHUTTER_TRY(checkSamples(pass, resource, use.access));
    return checkFormat(pass, resource, use.access);
}

core::Status checkTwice(const Graph& graph, const PassRecord& pass) {
    for (size_t i = 0; i < pass.uses.size(); ++i)
        for (size_t j = i + 1; j < pass.uses.size(); ++j)
            if (pass.uses[i].resource == pass.uses[j].resource)
                return core::makeError(
                    "pass '{}' uses '{}' twice: {} and {}",
                    pass.name,
                    graph.resources()[pass.uses[i].resource].name,
                    describe(pass.uses[i].access),
                    describe(pass.uses[j].access)
                );
    return {};
}

core::Status checkAttachments(const Graph& graph, const PassRecord& pass) {
    if (pass.kind != PassKind::Raster)
        return {};
    std::vector<uint32_t> targets;
    for (const ColorTarget& target : pass.colorTargets)
        targets.push_back(target.resource);
    if (pass.depthTarget)
        targets.push_back(pass.depthTarget->resource);
    if (targets.empty())
        return core::makeError("raster pass '{}' has no attachment", pass.name);
    const ResourceRecord& first = graph.resources()[targets.front()];
    for (uint32_t target : targets) {
        const ResourceRecord& other = graph.resources()[target];
        const TransientImageDesc& a = first.imageDesc;
        const TransientImageDesc& b = other.imageDesc;
        if (a.width != b.width || a.height != b.height)
            return core::makeError(
                "pass '{}' draws into '{}' of {} x {} and '{}' of {} x {}",
                pass.name,
                first.name,
                a.width,
                a.height,
                other.name,
                b.width,
                b.height
            );
        if (a.samples != b.samples)
            return core::makeError(
                "pass '{}' draws into '{}' with {} samples per pixel and '{}' with {}",
                pass.name,
                first.name,
                a.samples,
                other.name,
                b.samples
            );
    }
    return {};
}

/// The pass that stays and makes a newer version, if any.
std::optional<uint32_t> findOverwriter(
    const Graph& graph,
    const VersionTable& versions,
    const std::vector<bool>& kept,
    uint32_t resource,
    uint32_t version
) {
    for (uint32_t newer = version + 1; newer < graph.resources()[resource].versionCount; ++newer)
        if (const auto producer = versions.producer(resource, newer); producer && kept[*producer])
            return producer;
    return std::nullopt;
}

} // namespace

core::Status checkDeclaration(const Graph& graph) {
    if (!graph.problems().empty())
        return core::Error{graph.problems().front()};
    for (const ResourceRecord& resource : graph.resources())
        SHUTTER_TRY(checkTransient(resource));
    SHUTTER_TRY(checkImports(graph));
    for (const PassRecord& pass : graph.passes()) {
        for (const ResourceUse& use : pass.uses)
            SHUTTER_TRY(checkUse(graph, pass, use));
        SHUTTER_TRY(checkTwice(graph, pass));
        SHUTTER_TRY(checkAttachments(graph, pass));
    }
    for (const auto& [resource, version] : graph.outputs())
        if (version == 0 && !graph.resources()[resource].hasContentsAtStart())
            return core::makeError(
                "output '{}' is written by no pass", graph.resources()[resource].name
            );
    return {};
}

core::Status
checkResults(const Graph& graph, const VersionTable& versions, const std::vector<bool>& kept) {
    const auto& passes = graph.passes();
    for (const auto& [resource, version] : graph.outputs())
        if (const auto other = findOverwriter(graph, versions, kept, resource, version))
            return core::makeError(
                "output '{}' is overwritten by pass '{}' before the frame ends",
                graph.resources()[resource].name,
                passes[*other].name
            );
    for (size_t pass = 0; pass < passes.size(); ++pass)
        for (const ResourceUse& use : passes[pass].uses) {
            if (!kept[pass] || use.access != Access::HostRead)
                continue;
            if (const auto other =
                    findOverwriter(graph, versions, kept, use.resource, use.readVersion))
                return core::makeError(
                    "pass '{}' makes the host read '{}', but pass '{}' overwrites it",
                    passes[pass].name,
                    graph.resources()[use.resource].name,
                    passes[*other].name
                );
        }
    return {};
}

} // namespace shutter::graph
