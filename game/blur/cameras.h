// SPDX-License-Identifier: MIT
// The JSON file of the cameras of pictures.
#pragma once

#include "engine/core/result.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <vector>

namespace shutter::blur {

struct PictureCamera {
    double frame = 0.0; ///< time, in frames: pictures are at whole numbers
    glm::dmat4 viewFromWorld{1.0};
    glm::dmat4 clipFromView{1.0};
};

struct Cameras {
    std::vector<PictureCamera> list; ///< by rising frame; one alone is static
    bool aheadIsPlusZ = false;       ///< of view space, where the matrices are perspective

    /// The camera of a frame. Null: there is none.
    [[nodiscard]] const PictureCamera* find(double frame) const;
};

/// \param aspect width of a picture over its height, for cameras of a field of view
/// Error: names the file, the line and the field.
[[nodiscard]] core::Result<Cameras> readCameras(const std::filesystem::path& file, double aspect);

} // namespace shutter::blur
