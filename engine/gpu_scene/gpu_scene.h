// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/idle_counter.h"
#include "engine/extract/extracted_frame.h"
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/gpu_scene/deform_sources.h"
#include "engine/gpu_scene/texture_table.h"
#include "engine/scene/assets.h"
#include "shaders/render/scene_shared.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::gpu_scene {

/// The assets of a scene on the device: one vertex and one index buffer, tables of geometries and
/// materials, bindless textures, and, on request, a BLAS per mesh.
class GpuScene {
  public:
    GpuScene(gpu::Device& device, const scene::Assets& assets);
    GpuScene(const GpuScene&) = delete;
    GpuScene& operator=(const GpuScene&) = delete;

    [[nodiscard]] const extract::SceneLayout& layout() const { return mLayout; }

    [[nodiscard]] VkBuffer indexBuffer() const { return mIndices.handle(); }

    [[nodiscard]] VkDeviceAddress geometryTable() const { return mGeometries.address(); }

    /// What geometryTable() holds.
    [[nodiscard]] std::span<const shader::Geometry> geometryRows() const { return mGeometryRows; }

    /// The geometry's deformation data.
    [[nodiscard]] const DeformSource& deformSource(uint32_t geometry) const {
        return mDeformSources[geometry];
    }

    [[nodiscard]] VkDeviceAddress materialTable() const { return mMaterials.address(); }

    /// shader::EnvironmentConstants, where layout().hasEnvironment.
    [[nodiscard]] VkDeviceAddress environment() const { return mEnvironment.address(); }

    [[nodiscard]] VkDescriptorSetLayout textureLayout() const { return mTextures.layout(); }

    [[nodiscard]] VkDescriptorSet textureSet() const { return mTextures.set(); }

    /// The mesh's triangles for a BLAS, undeformed.
    [[nodiscard]] std::vector<gpu::TriangleGeometry> describeTriangles(uint32_t mesh) const;

    /// Builds every mesh's BLAS the first time. Candidates of blended geometries are shown to the
    /// shader, which passes or takes them.
    void buildAllBlas();

    /// Frees the BLASes and per-mesh TLASes of all meshes; objects that refer to them must be
    /// destroyed first.
    void releaseBlas();

    /// Must be called each frame: releases them once they were not wanted for a while.
    void releaseIdleBlas(bool wanted) {
        if (mBlasIdle.advance(wanted))
            releaseBlas();
    }

    /// Null (false) for a mesh without triangles that rays can meet.
    [[nodiscard]] const gpu::AccelerationStructure& blas(uint32_t mesh) const {
        return mBlas[mesh];
    }

    /// An instance of the mesh at the origin: its BLAS, culling and mask.
    [[nodiscard]] gpu::Instance describeInstance(uint32_t mesh) const;

    /// Builds, where it is not yet there, each mesh's own TLAS: one instance, in object space.
    /// \param meshes that have a blas(); may contain duplicates
    void buildMeshScenes(std::span<const uint32_t> meshes);

    /// Null (false) until built.
    [[nodiscard]] const gpu::AccelerationStructure& meshScene(uint32_t mesh) const {
        return mMeshScenes[mesh];
    }

  private:
    void uploadMeshes(const scene::Assets& assets);
    void uploadMaterials(const scene::Assets& assets);
    void uploadEnvironment(const scene::Environment& environment);

    gpu::Device& mDevice;
    extract::SceneLayout mLayout;
    gpu::Buffer mVertices;
    gpu::Buffer mIndices;
    gpu::Buffer mGeometries;
    std::vector<shader::Geometry> mGeometryRows;
    DeformSources mDeformSources;
    gpu::Buffer mMaterials;
    gpu::Buffer mEnvironment;
    TextureTable mTextures;
    std::vector<gpu::AccelerationStructure> mBlas;
    std::vector<gpu::AccelerationStructure> mMeshScenes;
    std::vector<uint32_t> mFirstVertex; ///< one per geometry
    bool mBlasBuilt = false;
    core::IdleCounter mBlasIdle;
};

} // namespace shutter::gpu_scene
