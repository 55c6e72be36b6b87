// SPDX-License-Identifier: MIT
#include "engine/math/lens_tables.h"

#include "engine/core/check.h"
#include "engine/math/lens_pairs.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace shutter::math {

namespace {

shader::LensReach describeReach(std::span<const vec4> shifts, const ThinLens& lens) {
    shader::LensReach reach{vec2(HUGE_VALF), vec2(-HUGE_VALF)};
    for (const vec4& shift : shifts) {
        reach.low = glm::min(reach.low, vec2(shift.z, shift.w));
        reach.high = glm::max(reach.high, vec2(shift.z, shift.w));
    }
    reach.inverseFocus = float(1.0 / lens.focusDistance);
    reach.radius = float(lens.radius * lens.pixelsPerUnit.y);
    return reach;
}

} // namespace

dvec2 measurePixelsPerUnit(const dmat4& clipFromView, const uvec2& sizePx) {
    const dmat4 rows = glm::transpose(clipFromView);
    return 0.5 * dvec2(sizePx) * dvec2(glm::length(dvec2(rows[0])), glm::length(dvec2(rows[1])));
}

vec2 confusionOf(const ThinLens& lens) {
    const double radius = lens.radius * lens.pixelsPerUnit.y;
    return vec2(dvec2(radius / lens.focusDistance, radius));
}

void addLens(
    std::span<const ThinLens> lenses, const ThinLens& raster, uint32_t turn, InstantLayers& layers
) {
    SHUTTER_CHECK(!lenses.empty(), "no samples");
    SHUTTER_CHECK_EQ(lenses.size(), layers.times.size());
    const std::vector<LensPair> pairs = spreadLensPairs(uint32_t(lenses.size()), turn);
    std::vector<float> times;
    for (size_t i = 0; i < pairs.size(); ++i) {
        const ThinLens& lens = lenses[i / shader::kLensSets];
        const dvec2 place =
            lens.radius * dvec2(shader::aperturePoint(lens.aperture, pairs[i].place));
        // From there the picture is the pinhole's, sheared so that the focus plane stays.
        const dvec2 shift = lens.pixelsPerUnit * dvec2(place.x, -place.y);
        times.push_back(layers.times[i / shader::kLensSets]);
        layers.lens.emplace_back(shift / lens.focusDistance, -shift);
        layers.lensPlaces.emplace_back(place);
    }
    layers.times = std::move(times);
    const std::span<const vec4> shifts = layers.lens;
    for (size_t i = 0; i < lenses.size(); ++i)
        layers.lensReaches.push_back(
            describeReach(shifts.subspan(i * shader::kLensSets, shader::kLensSets), lenses[i])
        );
    layers.lensReaches.push_back(describeReach(shifts, lenses[lenses.size() / 2]));
    layers.confusion = confusionOf(raster);
    const shader::Aperture& shape = raster.aperture;
    // Radii count in pixels down the picture; a host's need not be square.
    const double aspect = raster.pixelsPerUnit.x / raster.pixelsPerUnit.y;
    layers.aperture = {
        float(shape.blades), shape.rotation, shape.roundness, float(shape.squeeze * aspect)};
    layers.raster.isStatic = false;
    for (std::optional<LayerTables>* const layer : {&layers.second, &layers.last})
        if (*layer)
            (*layer)->isStatic = false;
}

} // namespace shutter::math
