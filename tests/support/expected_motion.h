// SPDX-License-Identifier: MIT
// Motion vectors by other means than the renderer's: positions of the same surface point at shutter
// open and close, rasterised on the CPU in double precision.
#pragma once

#include "engine/math/math.h"
#include "engine/scene/motion.h"
#include "engine/scene/world.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace shutter::test {

struct ExpectedPixel {
    double depth = 0.0;      ///< metres along the view at the raster instant
    math::dvec2 motion{0.0}; ///< pixels over the exposure, right and down
};

/// What the pixel centres of a picture of a perspective camera see, nearest triangle first, both
/// sides of every triangle; nothing where no triangle is, or where one of its corners passes the
/// camera's plane during the exposure.
class ExpectedMotion {
  public:
    ExpectedMotion(
        const scene::World& world,
        ecs::Entity camera,
        const scene::ExposureInterval& exposure,
        uint32_t width,
        uint32_t height
    );

    [[nodiscard]] const std::optional<ExpectedPixel>& at(uint32_t x, uint32_t y) const {
        return mPixels[size_t{y} * mWidth + x];
    }

  private:
    /// Clip positions of one vertex: open, raster, close.
    struct Corner {
        math::dvec4 open, raster, close;
    };

    void drawEntity(const scene::World& world, ecs::Entity entity, const scene::Mesh& mesh);
    void drawTriangle(const Corner& a, const Corner& b, const Corner& c);

    uint32_t mWidth = 0;
    uint32_t mHeight = 0;
    double mSeconds[3]{};            // open, raster, close
    math::dmat4 mClipFromWorld[3]{}; // the same
    std::vector<std::optional<ExpectedPixel>> mPixels;
};

} // namespace shutter::test
