// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/gpu_scene.h"

#include "engine/extract/spatial_order.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/upload.h"
#include "engine/gpu/vulkan.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
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

VkSamplerAddressMode addressMode(scene::Wrap wrap) {
    switch (wrap) {
    case scene::Wrap::MirroredRepeat:
        return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case scene::Wrap::ClampToEdge:
        return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    default:
        return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    }
}

/// The bindless array holds each glTF texture twice: sRGB at 2i, linear at 2i + 1. Only the halves
/// that a material uses get an image.
uint32_t bindlessIndex(const scene::TextureSlot& slot, bool srgb) {
    return slot.texture == scene::kNone ? shader::kNoTexture : 2 * slot.texture + (srgb ? 0 : 1);
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
                (material.alphaMode == AlphaMode::Blend ? shader::kMaterialBlend : 0u);
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

} // namespace

GpuScene::GpuScene(gpu::Device& device, const scene::Assets& assets)
    : mDevice(device), mDeformSources(device, assets) {
    uploadMeshes(assets);
    uploadMaterials(assets);
    uploadTextures(assets);
}

GpuScene::~GpuScene() {
    mDevice.retire([device = mDevice.handle(),
                    layout = mTextureLayout,
                    pool = mTexturePool,
                    samplers = mSamplers] {
        vkDestroyDescriptorPool(device, pool, nullptr);
        vkDestroyDescriptorSetLayout(device, layout, nullptr);
        for (VkSampler sampler : samplers)
            vkDestroySampler(device, sampler, nullptr);
    });
}

void GpuScene::uploadMeshes(const scene::Assets& assets) {
    std::vector<shader::Vertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<shader::Geometry> rows;
    // The default material stands behind the scene's own.
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
                 row.vertexCount}
            );
            mFirstVertex.push_back(static_cast<uint32_t>(vertices.size()));
            for (size_t i = 0; i < primitive.positions.size(); ++i)
                vertices.push_back(packVertex(primitive, i));
            indices.insert(indices.end(), sorted.begin(), sorted.end());
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

void GpuScene::uploadTextures(const scene::Assets& assets) {
    const auto count = static_cast<uint32_t>(2 * assets.textures.size());
    std::vector<bool> used(count, false);
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
    createTextureSet(std::max(count, 1u));

    std::map<std::pair<scene::AssetIndex, bool>, VkImageView> views;
    for (uint32_t i = 0; i < count; ++i) {
        if (!used[i])
            continue;
        const scene::Texture& texture = assets.textures[i / 2];
        const bool srgb = i % 2 == 0;
        VkImageView& view = views[{texture.image, srgb}];
        if (!view) {
            const scene::TextureImage& source = assets.images[texture.image];
            gpu::ImageDesc desc;
            desc.width = source.width;
            desc.height = source.height;
            desc.format = srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
            desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                         VK_IMAGE_USAGE_TRANSFER_DST_BIT;
            desc.mipLevels = gpu::countMipLevels(desc.width, desc.height);
            gpu::Image image(mDevice, source.name, desc);
            gpu::uploadTexture(mDevice, image, std::as_bytes(std::span(source.rgba)));
            view = image.view();
            mTextures.push_back(std::move(image));
        }
        VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
        info.magFilter = texture.nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
        info.minFilter = VK_FILTER_LINEAR;
        info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
        info.maxLod = VK_LOD_CLAMP_NONE;
        info.addressModeU = addressMode(texture.wrapU);
        info.addressModeV = addressMode(texture.wrapV);
        VkSampler sampler = VK_NULL_HANDLE;
        gpu::require(vkCreateSampler(mDevice.handle(), &info, nullptr, &sampler), "a sampler");
        mSamplers.push_back(sampler);

        const VkDescriptorImageInfo entry{sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = mTextureSet;
        write.dstArrayElement = i;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        write.pImageInfo = &entry;
        vkUpdateDescriptorSets(mDevice.handle(), 1, &write, 0, nullptr);
    }
}

void GpuScene::createTextureSet(uint32_t count) {
    VkDescriptorSetLayoutBinding binding{};
    binding.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    binding.descriptorCount = count;
    binding.stageFlags = gpu::kSceneStages;
    if (mDevice.info().rayTier != gpu::RayTier::Pipeline)
        binding.stageFlags &= VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
    const VkDescriptorBindingFlags flags = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
    VkDescriptorSetLayoutBindingFlagsCreateInfo bindingFlags{
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
    bindingFlags.bindingCount = 1;
    bindingFlags.pBindingFlags = &flags;
    VkDescriptorSetLayoutCreateInfo layout{
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &bindingFlags};
    layout.bindingCount = 1;
    layout.pBindings = &binding;
    gpu::require(
        vkCreateDescriptorSetLayout(mDevice.handle(), &layout, nullptr, &mTextureLayout),
        "creating the texture table"
    );
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    gpu::require(
        vkCreateDescriptorPool(mDevice.handle(), &pool, nullptr, &mTexturePool),
        "creating the texture table"
    );
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = mTexturePool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &mTextureLayout;
    gpu::require(
        vkAllocateDescriptorSets(mDevice.handle(), &allocate, &mTextureSet),
        fmt::format("making room for {} textures", count)
    );
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
