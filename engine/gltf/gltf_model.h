// SPDX-License-Identifier: MIT
// Private to engine/gltf: the one place that includes tinygltf, so that every source file sees it
// configured alike. tinygltf turns checked JSON into structs; it is built without file access and
// without image decoding, and never sees a buffer or an image.
#pragma once

#include <nlohmann/json.hpp>

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include <tiny_gltf.h>

namespace shutter::gltf {

/// The model of a document that checkGltfSchema accepted, without its `buffers` and `images` (see
/// GltfResources for these). Throws GltfError.
[[nodiscard]] tinygltf::Model parseGltfModel(nlohmann::json root);

} // namespace shutter::gltf
