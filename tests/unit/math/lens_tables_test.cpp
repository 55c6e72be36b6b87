// SPDX-License-Identifier: MIT
#include "engine/math/lens_tables.h"

#include <gtest/gtest.h>

#include <vector>

namespace shutter::math {
namespace {

InstantLayers addTo(const ThinLens& lens) {
    InstantLayers layers;
    layers.times = {0.5f};
    const std::vector<ThinLens> lenses = {lens};
    addLens(lenses, lens, 0, layers);
    return layers;
}

TEST(LensTables, TheOpeningIsAsWideInPixelsAsThePlacesOfTheLensMoveAPicture) {
    // A host's pixels may be twice as wide as high.
    const ThinLens square{
        .pixelsPerUnit = {100.0, 100.0},
        .radius = 0.1,
        .focusDistance = 2.0,
        .aperture = {.blades = 0, .rotation = 0.0f, .roundness = 0.0f, .squeeze = 1.0f}};
    ThinLens wide = square;
    wide.pixelsPerUnit.x = 50.0;
    const InstantLayers one = addTo(square);
    const InstantLayers other = addTo(wide);
    EXPECT_FLOAT_EQ(one.aperture.w, 1.0f);
    EXPECT_FLOAT_EQ(other.aperture.w, 0.5f);
    ASSERT_EQ(one.lens.size(), other.lens.size());
    for (size_t i = 0; i < one.lens.size(); ++i) {
        EXPECT_FLOAT_EQ(other.lens[i].z, one.lens[i].z * other.aperture.w) << i;
        EXPECT_FLOAT_EQ(other.lens[i].w, one.lens[i].w) << i;
    }
    EXPECT_FLOAT_EQ(other.lensReaches.back().radius, 10.0f);
}

} // namespace
} // namespace shutter::math
