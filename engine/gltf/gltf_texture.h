// SPDX-License-Identifier: MIT
// Private to engine/gltf: textures and images, taken over when a material first asks for them.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/scene/assets.h"

#include <string>
#include <vector>

namespace shutter::gltf {

/// Fills Assets::textures and Assets::images with what materials use; a picture nobody uses is
/// never opened.
class GltfTextures {
  public:
    GltfTextures(GltfContext& context, scene::Assets& assets);

    /// The slot for a reference to `texture` (kNone for -1 and for a texture without a picture that
    /// we read). Applies KHR_texture_transform. Throws GltfError when the picture cannot be
    /// decoded.
    [[nodiscard]] scene::TextureSlot addSlot(
        int texture, int texCoord, const tinygltf::ExtensionMap& extensions, const std::string& path
    );

  private:
    [[nodiscard]] scene::AssetIndex addTexture(size_t index);
    [[nodiscard]] scene::AssetIndex addImage(size_t index);
    [[nodiscard]] scene::TextureImage decodeImage(size_t index);

    GltfContext& mContext;
    scene::Assets& mAssets;
    std::vector<scene::AssetIndex> mTextureOf; ///< by the file's texture index; kNone: not yet
    std::vector<scene::AssetIndex> mImageOf;   ///< by the file's image index; kNone: not yet
};

} // namespace shutter::gltf
