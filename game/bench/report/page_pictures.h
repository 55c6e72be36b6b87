// SPDX-License-Identifier: MIT
// The pictures of a report inside its page, as exact as the page's size allows.
#pragma once

#include "engine/core/result.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <span>

namespace shutter::bench {

/// How exact the pictures of a page are.
struct PictureDetail {
    int jpegQuality = 0;        ///< of whole pictures; 0: the PNG files as they are
    bool isLinearWhole = false; ///< linear pictures are whole
    size_t linearCropCount = 0; ///< crops of each linear picture where it is not whole
};

/// From exact to small: crops keep their floats for as long as possible, as a whole picture only
/// has to show where they are.
[[nodiscard]] std::span<const PictureDetail> listPictureDetails();

struct PagePictures {
    PictureDetail detail;
    size_t bytes = 0; ///< of the text that `files` holds
    /// What the page's scripts read: `whole`, path to data URI; `parts`, path to an array of
    /// {x, y, width, height} with `uri` or `exr` (base64 of an EXR of half floats); `detail`;
    /// `magma`, 256 colours of three bytes, base64.
    nlohmann::json files;
};

/// The pictures that `results` shows, with the first detail at which their text has at most
/// `budgetBytes`, or else the last detail. Error: a file is missing, outside `folder`, no PNG or no
/// EXR with R, G and B, or a crop lies outside its picture.
[[nodiscard]] core::Result<PagePictures> encodePictures(
    const nlohmann::json& results, const std::filesystem::path& folder, size_t budgetBytes
);

} // namespace shutter::bench
