// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/gpu_scene.h"

#include "engine/extract/spatial_order.h"
#include "engine/gpu/upload.h"
#include "engine/gpu/vulkan.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace shutter::gpu_scene {

namespace {

using scene::AlphaMode;

shader::Vertex packVertex(const scene::Primitive& primitive, size_t i) {
    const math::vec2 uv0 = primitive.uv0.empty() ? math::vec2(0.0f) : primitive.uv0[i];
    const math::vec4 color = primitive.colors.empty() ? math::vec4(1.0f) : primitive.colors[i];
    shader::Vertex vertex;
    vertex.positionU0 = math::vec4(primitive.positions[i], uv0.x);
    vertex.normalV0 = math::vec4(primitive.normals[i], uv0.y);
    vertex.tangent = primitive.tangents.empty() ? math::vec4(0.0f) : primitive.tangents[i];
    vertex.uv1 = primitive.uv1.empty() ? math::vec2(0.0f) : primitive.uv1[i];
    vertex.color = {
        glm::packHalf2x16(math::vec2(color.x, color.y)),
        glm::packHalf2x16(math::vec2(color.z, color.w))};
    return vertex;
}

/// uv' = offset + rotation * (scale * uv), KHR_texture_transform.
shader::TextureRef packSlot(const scene::TextureSlot& slot, uint32_t bindlessIndex) {
    const float c = std::cos(slot.rotation);
    const float s = std::sin(slot.rotation);
    shader::TextureRef ref;
    ref.axes = {c * slot.scale.x, -s * slot.scale.x, s * slot.scale.y, c * slot.scale.y};
    ref.offset = slot.offset;
    ref.texture = bindlessIndex;
    ref.uvSet = std::min(slot.uvSet, 1u);
    return ref;
}

/// The bindless array holds each glTF texture twice: sRGB at 2i, linear at 2i + 1. Only the halves
/// that a material uses get an image.
uint32_t bindlessIndex(const scene::TextureSlot& slot, bool srgb) {
    return slot.texture == scene::kNone ? shader::kNoTexture : 2 * slot.texture + (srgb ? 0 : 1);
}

uint32_t blendFlagsOf(scene::BlendMode mode) {
    switch (mode) {
    case scene::BlendMode::Over:
        return shader::kMaterialBlend;
    case scene::BlendMode::Add:
        return shader::kMaterialBlend | shader::kMaterialAdd;
    case scene::BlendMode::Premultiplied:
        return shader::kMaterialBlend | shader::kMaterialPremultiplied;
    }
    return shader::kMaterialBlend;
}

shader::MaterialRow packMaterial(const scene::Material& material) {
    shader::MaterialRow row{};
    row.baseColor = material.baseColorFactor;
    row.emissiveCutoff = math::vec4(material.emissive, material.alphaCutoff);
    row.surface = {
        material.metallicFactor,
        material.roughnessFactor,
        material.normalScale,
        material.occlusionStrength};
    row.flags = (material.unlit ? shader::kMaterialUnlit : 0u) |
                (material.doubleSided ? shader::kMaterialDoubleSided : 0u) |
                (material.alphaMode == AlphaMode::Mask ? shader::kMaterialMask : 0u) |
                (material.alphaMode == AlphaMode::Blend ? blendFlagsOf(material.blendMode) : 0u);
    const auto pack = [](const scene::TextureSlot& slot, bool srgb) {
        return packSlot(slot, bindlessIndex(slot, srgb));
    };
    row.baseColorTexture = pack(material.baseColor, true);
    row.metallicRoughnessTexture = pack(material.metallicRoughness, false);
    row.normalTexture = pack(material.normal, false);
    row.occlusionTexture = pack(material.occlusion, false);
    row.emissiveTexture = pack(material.emissiveTexture, true);
    return row;
}

/// By place in the table.
std::vector<bool> findUsedTextures(const scene::Assets& assets) {
    std::vector<bool> used(2 * assets.textures.size(), false);
    for (const scene::Material& material : assets.materials) {
        const auto use = [&](const scene::TextureSlot& slot, bool srgb) {
            if (slot.texture != scene::kNone)
                used[bindlessIndex(slot, srgb)] = true;
        };
        use(material.baseColor, true);
        use(material.metallicRoughness, false);
        use(material.normal, false);
        use(material.occlusion, false);
        use(material.emissiveTexture, true);
    }
    for (size_t i = 0; i < assets.textures.size(); ++i)
        used[2 * i] = used[2 * i] || assets.textures[i].isLoose;
    return used;
}

} // namespace

GpuScene::GpuScene(gpu::Device& device, const scene::Assets& assets)
    : mDevice(device), mDeformSources(device, assets),
      mTextures(device, assets, findUsedTextures(assets)) {
    uploadMeshes(assets);
    uploadMaterials(assets);
    if (assets.environment)
        uploadEnvironment(*assets.environment);
}

void GpuScene::uploadEnvironment(const scene::Environment& environment) {
    shader::EnvironmentConstants constants{};
    for (size_t i = 0; i < environment.irradiance.size(); ++i)
        constants.irradiance[i] = math::vec4(environment.irradiance[i], 0.0f);
    for (int row = 0; row < 3; ++row)
        constants.mapFromWorld[row] = math::vec4(
            environment.mapFromWorld[0][row],
            environment.mapFromWorld[1][row],
            environment.mapFromWorld[2][row],
            0.0f
        );
    constants.background = mTextures.environment().background;
    constants.mirrored = mTextures.environment().mirrored;
    constants.roughestLevel = static_cast<float>(environment.mirrored.size() - 1);
    constants.texelsPerRadian =
        static_cast<float>(environment.background.front().width / (2.0 * std::numbers::pi));
    mEnvironment = gpu::Buffer(
        mDevice,
        "environment",
        sizeof(constants),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        gpu::MemoryUse::Device
    );
    gpu::uploadBuffer(mDevice, mEnvironment, std::as_bytes(std::span(&constants, 1)));
    mLayout.hasEnvironment = true;
}

void GpuScene::uploadMeshes(const scene::Assets& assets) {
    std::vector<shader::Vertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<shader::Geometry> rows;
    // The default material follows the scene's own.
    const auto defaultMaterial = static_cast<uint32_t>(assets.materials.size());
    for (const scene::Mesh& mesh : assets.meshes) {
        mLayout.firstGeometry.push_back(static_cast<uint32_t>(rows.size()));
        mLayout.bounds.push_back(mesh.bounds);
        mLayout.reaches.push_back(scene::computePoseReach(mesh.primitives));
        for (const scene::Primitive& primitive : mesh.primitives) {
            const bool hasMaterial = primitive.material < assets.materials.size();
            const scene::Material material =
                hasMaterial ? assets.materials[primitive.material] : scene::Material{};
            std::vector<uint32_t> sorted = primitive.indices;
            extract::sortTriangles(primitive.positions, sorted);
            shader::Geometry row{};
            row.material = hasMaterial ? primitive.material : defaultMaterial;
            row.firstIndex = static_cast<uint32_t>(indices.size());
            row.indexCount = static_cast<uint32_t>(sorted.size());
            row.vertexCount = static_cast<uint32_t>(primitive.positions.size());
            rows.push_back(row);
            mLayout.geometries.push_back(
                {row.firstIndex,
                 row.indexCount,
                 material.alphaMode,
                 material.doubleSided,
                 row.vertexCount,
                 row.firstIndex + row.indexCount,
                 material.blendMode != scene::BlendMode::Over}
            );
            mLayout.hasBlended = mLayout.hasBlended || material.alphaMode == AlphaMode::Blend;
            mFirstVertex.push_back(static_cast<uint32_t>(vertices.size()));
            for (size_t i = 0; i < primitive.positions.size(); ++i)
                vertices.push_back(packVertex(primitive, i));
            indices.insert(indices.end(), sorted.begin(), sorted.end());
            if (material.alphaMode == AlphaMode::Blend)
                for (size_t i = sorted.size(); i >= 3; i -= 3)
                    indices.insert(indices.end(), &sorted[i - 3], &sorted[i - 3] + 3);
        }
    }
    mLayout.firstGeometry.push_back(static_cast<uint32_t>(rows.size()));

    VkBufferUsageFlags input = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (mDevice.hasRays())
        input |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    using gpu::MemoryUse;
    mVertices = gpu::Buffer(
        mDevice, "vertices", vertices.size() * sizeof(shader::Vertex), input, MemoryUse::Device
    );
    mIndices = gpu::Buffer(
        mDevice,
        "indices",
        indices.size() * sizeof(uint32_t),
        input | VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
        MemoryUse::Device
    );
    for (size_t i = 0; i < rows.size(); ++i) {
        rows[i].vertices = gpu::splitAddress(
            mVertices.address() + uint64_t(mFirstVertex[i]) * sizeof(shader::Vertex)
        );
        rows[i].indices = gpu::splitAddress(mIndices.address() + uint64_t(rows[i].firstIndex) * 4);
    }
    mGeometries = gpu::Buffer(
        mDevice,
        "geometries",
        rows.size() * sizeof(shader::Geometry),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        MemoryUse::Device
    );
    gpu::uploadBuffer(mDevice, mVertices, std::as_bytes(std::span(vertices)));
    gpu::uploadBuffer(mDevice, mIndices, std::as_bytes(std::span(indices)));
    gpu::uploadBuffer(mDevice, mGeometries, std::as_bytes(std::span(rows)));
    mGeometryRows = std::move(rows);
}

void GpuScene::uploadMaterials(const scene::Assets& assets) {
    std::vector<shader::MaterialRow> rows;
    for (const scene::Material& material : assets.materials)
        rows.push_back(packMaterial(material));
    rows.push_back(packMaterial(scene::Material{}));
    mMaterials = gpu::Buffer(
        mDevice,
        "materials",
        rows.size() * sizeof(shader::MaterialRow),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        gpu::MemoryUse::Device
    );
    gpu::uploadBuffer(mDevice, mMaterials, std::as_bytes(std::span(rows)));
}

std::vector<gpu::TriangleGeometry> GpuScene::describeTriangles(uint32_t mesh) const {
    const uint32_t first = mLayout.firstGeometry[mesh];
    const uint32_t end = mLayout.firstGeometry[mesh + 1];
    bool anySingleSided = false;
    bool anyDoubleSided = false;
    for (uint32_t i = first; i < end; ++i)
        (mLayout.geometries[i].doubleSided ? anyDoubleSided : anySingleSided) = true;
    std::vector<gpu::TriangleGeometry> result;
    for (uint32_t i = first; i < end; ++i) {
        const extract::SceneLayout::GeometryInfo& info = mLayout.geometries[i];
        gpu::TriangleGeometry triangles;
        triangles.vertices =
            mVertices.address() + uint64_t(mFirstVertex[i]) * sizeof(shader::Vertex);
        triangles.vertexStride = sizeof(shader::Vertex);
        triangles.vertexCount = info.vertexCount;
        triangles.indices = mIndices.address() + uint64_t(info.firstIndex) * 4;
        triangles.triangleCount = info.indexCount / 3;
        // Culling is per instance in Vulkan. Where a mesh mixes sides, the shader must see the
        // single-sided candidates to drop their backs (trace.glsl).
        const bool shaderCulls = anyDoubleSided && anySingleSided && !info.doubleSided;
        triangles.opaque = info.alphaMode == AlphaMode::Opaque && !shaderCulls;
        result.push_back(triangles);
    }
    return result;
}

gpu::Instance GpuScene::describeInstance(uint32_t mesh) const {
    gpu::Instance instance{};
    for (int i = 0; i < 3; ++i)
        instance.worldFromObject[i][i] = 1.0f;
    instance.blas = mBlas[mesh].address();
    instance.cullDisabled = false;
    instance.mask = 0;
    for (uint32_t g = mLayout.firstGeometry[mesh]; g < mLayout.firstGeometry[mesh + 1]; ++g) {
        const extract::SceneLayout::GeometryInfo& info = mLayout.geometries[g];
        instance.cullDisabled = instance.cullDisabled || info.doubleSided;
        instance.mask |=
            info.alphaMode == AlphaMode::Blend ? shader::kBlendedMask : shader::kSolidMask;
    }
    return instance;
}

void GpuScene::buildAllBlas() {
    if (mBlasBuilt)
        return;
    mBlasBuilt = true;
    std::vector<std::vector<gpu::TriangleGeometry>> meshes(mLayout.firstGeometry.size() - 1);
    for (uint32_t mesh = 0; mesh < meshes.size(); ++mesh)
        meshes[mesh] = describeTriangles(mesh);
    mBlas = gpu::buildBlas(mDevice, meshes);
    mMeshScenes.resize(mBlas.size());
}

void GpuScene::releaseBlas() {
    mMeshScenes.clear();
    mBlas.clear();
    mBlasBuilt = false;
}

void GpuScene::buildMeshScenes(std::span<const uint32_t> meshes) {
    std::set<uint32_t> missing;
    for (const uint32_t mesh : meshes)
        if (!mMeshScenes[mesh])
            missing.insert(mesh);
    std::vector<gpu::Instance> instances;
    for (const uint32_t mesh : missing)
        instances.push_back(describeInstance(mesh));
    auto built = gpu::buildTlas(mDevice, instances);
    size_t next = 0;
    for (const uint32_t mesh : missing)
        mMeshScenes[mesh] = std::move(built[next++]);
}

} // namespace shutter::gpu_scene
