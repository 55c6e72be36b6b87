// SPDX-License-Identifier: MIT
// Reads dumps of EmbeddedMotionBlur::dump(): the manifest of each frame and its texels.
#pragma once

#include "engine/core/result.h"
#include "modules/motion_blur/embedding/host_convention.h"
#include "modules/motion_blur/embedding/host_motion.h"
#include "modules/motion_blur/settings.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace shutter::replay {

enum class Texels : uint8_t { Half4, Float1, Float2, Float4, Uint1 };

struct DumpImage {
    std::string file; ///< a name without a folder
    Texels texels = Texels::Half4;
    uint32_t width = 0; ///< pixels, [1, 32768]
    uint32_t height = 0;
    VkRect2D area{{0, 0}, {0, 0}};
    std::vector<uint8_t> bytes; ///< filled by readDumpTexels()
};

enum class DumpedReveal : uint8_t { None, Own, Tables };

/// The host's drawing over the picture: images drawnColor0 and so on.
struct DumpedDraws {
    VkRect2D area{{0, 0}, {0, 0}}; ///< within the picture
    uint32_t instantCount = 1;     ///< [1, 256]
    uint32_t partCount = 1;        ///< [1, 4]
    bool isOpacityInAlpha = false;
};

enum class DumpedResponse : uint8_t { Box, File, Address };

struct DumpFrame {
    std::string name; ///< of its file
    uint32_t width = 0;
    uint32_t height = 0;
    motion_blur::MotionBlurSettings settings;
    double rasterTime = 1.0;
    int64_t frameNumber = 0;
    uint32_t view = 0; ///< below 64
    uint32_t noEntity = 0xFFFFFFFF;
    bool hasConvention = false;
    motion_blur::HostConvention convention; ///< without images
    bool hasMotion = false;
    motion_blur::HostMotion motion; ///< without spans; these are below
    std::vector<motion_blur::HostCameraKey> keys;
    std::vector<uint32_t> moverRows;
    std::vector<std::vector<glm::dmat4>> moverMatrices; ///< one each
    std::vector<uint64_t> rowIds;
    std::vector<uint32_t> viewModelRows;
    std::vector<glm::dmat4> viewFromObject; ///< of convention.viewModel
    std::vector<double> focusDistances;
    DumpedReveal reveal = DumpedReveal::None;
    DumpedResponse response = DumpedResponse::Box;
    std::optional<DumpedDraws> drawn;
    std::map<std::string, DumpImage> images;
    std::vector<uint8_t> responseBytes;

    [[nodiscard]] const DumpImage* find(const std::string& image) const {
        const auto found = images.find(image);
        return found == images.end() ? nullptr : &found->second;
    }
};

[[nodiscard]] uint32_t texelBytes(Texels texels);

/// Names an image of DumpedDraws.
[[nodiscard]] std::string nameDrawnImage(uint32_t part, bool isOpacity);

/// Reads a frame's manifest. Error: names the file, the line and the field.
[[nodiscard]] core::Result<DumpFrame> readDumpManifest(const std::filesystem::path& file);

/// Reads the texels that the frame's images name. Error: names the file.
[[nodiscard]] core::Status readDumpTexels(const std::filesystem::path& folder, DumpFrame& frame);

/// The folder's frames in their order. Error: there is none.
[[nodiscard]] core::Result<std::vector<std::filesystem::path>>
listDumpFrames(const std::filesystem::path& folder);

} // namespace shutter::replay
