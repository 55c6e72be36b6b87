// SPDX-License-Identifier: MIT
// Two picture files brought to values that can be compared, and what of them is not.
#pragma once

#include "engine/core/result.h"
#include "engine/image/image.h"
#include "modules/tonemap/tonemap.h"

#include <optional>
#include <string>
#include <vector>

namespace shutter::game {

/// One of two pictures. Its values are those that the metrics are of.
struct ComparedPicture {
    std::string name;          ///< as typed
    image::Image image;        ///< without alpha
    bool isDisplay = false;    ///< values are display values, sRGB
    bool isToneMapped = false; ///< they were tone mapped here
};

/// A channel that both pictures have and no metric is of, alpha for one.
struct OtherChannel {
    std::string name;
    double maxDifference = 0.0; ///< of the values as stored; infinite where one is NaN
};

/// Two pictures of one size and the same channels.
struct Comparison {
    ComparedPicture a;
    ComparedPicture b;
    tonemap::TonemapSettings tonemap;
    bool isColor = false; ///< red, green and blue, or grey; else any values
    std::vector<OtherChannel> others;
    double maxDifference = 0.0; ///< of the images' values; infinite where one is NaN
    /// The same of the values as stored, where both were tone mapped.
    std::optional<double> storedDifference;
    std::vector<std::string> notes; ///< omissions and caveats, one sentence each

    [[nodiscard]] bool isDisplay() const { return a.isDisplay && b.isDisplay; }
};

/// Reads both. Pictures that are not stored for a display (EXR, HDR) are tone mapped unless
/// `isStored`. Compares the parts of the display windows that both have pixels of, which must be
/// the same; grey counts as a colour of three equal channels, and a picture without alpha as
/// opaque. Error: names the file; or what differs so that the two cannot be compared.
[[nodiscard]] core::Result<Comparison> readComparison(
    const std::string& a,
    const std::string& b,
    bool isStored,
    const tonemap::TonemapSettings& settings
);

} // namespace shutter::game
