// SPDX-License-Identifier: MIT
// The textures of a scene, bindless: one descriptor set for all shaders.
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/scene/assets.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::gpu_scene {

/// Maximum number of textures in one shader on a device, in addition to those of a pass, and the
/// limit that determines it.
struct TextureLimit {
    uint32_t count = 0;
    const char* name = "";
};

[[nodiscard]] TextureLimit findTextureLimit(const VkPhysicalDeviceLimits& limits);

/// Images share blocks of memory and textures share samplers: devices guarantee 4096 allocations
/// and 4000 samplers, and some have no more.
class TextureTable {
  public:
    /// The set holds each texture of the scene twice, as sRGB at 2i and linear at 2i + 1, and
    /// behind them the pictures of its environment, where it has one. \param used which of these a
    /// material reads; only they get an image Throws DeviceError, with the limit's name, for more
    /// textures than the device takes.
    TextureTable(gpu::Device& device, const scene::Assets& assets, const std::vector<bool>& used);
    ~TextureTable();
    TextureTable(const TextureTable&) = delete;
    TextureTable& operator=(const TextureTable&) = delete;

    [[nodiscard]] VkDescriptorSetLayout layout() const { return mLayout; }

    [[nodiscard]] VkDescriptorSet set() const { return mSet; }

    /// Places in the set, where the scene has an environment.
    struct EnvironmentPlaces {
        uint32_t background = 0;
        uint32_t mirrored = 0;
    };

    [[nodiscard]] const EnvironmentPlaces& environment() const { return mEnvironment; }

  private:
    explicit TextureTable(gpu::Device& device) : mDevice(device) {}

    void createSet(uint32_t count);
    /// \return by place in the set, null where no image is
    std::vector<VkImageView>
    uploadImages(const scene::Assets& assets, const std::vector<bool>& used);
    /// \param cutoff of the image's own alpha
    void uploadMask(const scene::TextureImage& source, float cutoff, const gpu::Image& target);
    void addEnvironment(const scene::Environment& environment, uint32_t first);
    void addDirections(
        const char* name, std::span<const scene::DirectionPicture> levels, uint32_t place
    );
    void write(uint32_t place, VkSampler sampler, VkImageView view);
    VkSampler findSampler(const scene::Texture& texture);

    struct KnownSampler {
        bool nearest = false;
        scene::Wrap wrapU = scene::Wrap::Repeat;
        scene::Wrap wrapV = scene::Wrap::Repeat;
        VkSampler sampler = VK_NULL_HANDLE;
    };

    gpu::Device& mDevice;
    std::vector<gpu::MemoryBlock> mBlocks; // before mImages: they must outlive them
    std::vector<gpu::Image> mImages;
    std::vector<gpu::Image> mDirections; ///< of the environment, each with its own memory
    EnvironmentPlaces mEnvironment;
    std::vector<KnownSampler> mSamplers;
    VkDescriptorSetLayout mLayout = VK_NULL_HANDLE;
    VkDescriptorPool mPool = VK_NULL_HANDLE;
    VkDescriptorSet mSet = VK_NULL_HANDLE;
};

} // namespace shutter::gpu_scene
