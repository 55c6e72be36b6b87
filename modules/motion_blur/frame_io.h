// SPDX-License-Identifier: MIT
// Inputs and outputs of the effect in a frame.
//
// Conventions: colours are linear HDR, at most 65000. `motion` is a pixel's displacement in pixels
// (right, down) from shutter open to close, without temporal jitter; a camera rotation moves the
// sky too. `depth` is metres along the view direction, kSkyDepth (1e9) for the background. The
// entity id is the row of the entity table, 0xFFFFFFFF for the background. All images have one
// size.
#pragma once

#include "engine/gpu/vulkan.h"
#include "engine/graph/ray_scene.h"
#include "engine/graph/types.h"
#include "shaders/common/instant_surfaces.glsl"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace shutter::motion_blur {

class RasterHistory;
struct HostReveal;
struct HostSamples;

/// The raster of the previous frame, as that frame's inputs were.
struct LentRaster {
    graph::ImageHandle color;       ///< RGBA16F, sharp
    graph::ImageHandle motionDepth; ///< RGBA32F
    graph::ImageHandle entityId;    ///< R32_UINT
    bool hasEdges = false;          ///< the raster had a MotionBlurInputs::edgeSurface
};

/// A raster of the world at the other end of the exposure, with separate entity ids.
struct SecondRaster {
    graph::ImageHandle color;       ///< RGBA16F
    graph::ImageHandle motionDepth; ///< RGBA32F, of which only the depth is read
    graph::ImageHandle entityId;    ///< R32_UINT
    bool hasEdges = false;          ///< the raster had a MotionBlurInputs::edgeSurface
};

/// Rasters in which methods look up surfaces, as kRasterLayer and the others in resolved.glsl.
enum class LayerIndex : uint8_t { Raster, Last, Second };

/// Declares the pass that draws the motion of a layer's deforming entities: an RG32UI image of
/// packWay()s (common/pixel_way.glsl).
/// \param surface of the layer, RG32UI: bits of the depth, and a word of which `keyMask` has the
/// row of its entity table
using DrawWays = std::function<graph::ImageHandle(
    graph::Graph& graph, LayerIndex layer, graph::ImageHandle surface, uint32_t keyMask
)>;

/// Where the surfaces of this frame's rasters, and of the one before, are seen at each instant of
/// the exposure.
struct InstantMotions {
    VkDeviceAddress table = 0; ///< shader::InstantMotions (common/instant_motion_shared.h)
    uint32_t instantCount = 0; ///< countInstants() (settings.h)
    /// Each instant has a place of the lens (math::spreadLensPairs()), of which the raster is
    /// taken from the middle.
    bool hasLens = false;
    /// Differences between pixels that see through other places of the lens are filtered; false:
    /// they vanish in the mean of frames that take turns in the places.
    bool filtersLens = true;
    bool hasLast = false;          ///< also of the raster in `history` or `lent`
    std::array<bool, 3> deforms{}; ///< by layer: `table` has a shader::kDeformedMover
    /// A tile may see more entities that move than its list holds (mayCrowdTiles()).
    bool mayCrowd = true;
    /// An entity may show several surfaces that move differently, one behind the other
    /// (WrittenLayers::mayHide).
    bool mayHide = true;

    /// Tiles may need more than the usual search: they are crowded, or have such an entity.
    [[nodiscard]] bool isGeneral() const { return mayCrowd || mayHide; }

    /// For the layers in which something deforms. Empty: motion vectors are followed, of this
    /// frame's raster alone.
    DrawWays drawWays;
    /// The view's: the raster of the previous frame is read from it, unless it is `lent`. Null: no
    /// history is stored or read.
    RasterHistory* history = nullptr;
    bool keepsRaster = true;            ///< in `history`, this frame's, for the next one
    std::optional<LentRaster> lent;     ///< of the previous frame
    std::optional<SecondRaster> second; ///< `table` also maps its surfaces to the instants
};

struct MotionBlurInputs {
    graph::ImageHandle color;       ///< RGBA16F
    graph::ImageHandle motionDepth; ///< RGBA32F: motion.xy, depth; every value finite
    /// Its motion is the camera's own alone; Method::readsCamera needs no frame constants then.
    bool motionIsCameras = false;
    graph::ImageHandle normal;   ///< RGBA16F: xyz unit; for Method::readsNormal
    graph::ImageHandle entityId; ///< R32_UINT; for Method::readsEntityId
    /// RGBA32_UINT: what covers samples of a pixel that its own surface does not, where the fourth
    /// channel of `motionDepth` has a bit for each of them (render::GBuffer); for
    /// Method::readsInstantMotions. Invalid: there is one sample per pixel.
    graph::ImageHandle edgeSurface;
    double rasterTime = 1.0; ///< raster instant in the exposure: 0 open, 0.5 centre, 1 close
    glm::uvec2 response{0u}; ///< address of shader::ResponseTable; 0: a box
    /// For methods of RayNeed::Any (CHECKed), unless `reveal` is there. Without a TLAS only sky
    /// lies behind movers and no ray is traced; only `frameConstants` is used then.
    std::optional<graph::RayScene> rays;
    const HostReveal* reveal = nullptr; ///< in place of `rays`; it must outlive the graph
    /// For methods of RayNeed::Query (CHECKed), unless `samples` is there.
    std::optional<graph::TimedRays> timedRays;
    const HostSamples* samples = nullptr; ///< in place of `timedRays`; it must outlive the graph
    std::optional<InstantMotions> instantMotions; ///< for Method::readsInstantMotions (CHECKed)
    /// Numbers the frame for InstantNoise::PerFrame; the next frame has the next number.
    int64_t frameNumber = 0;
    /// Requests the surfaces visible in each pixel of a rectangle at some of the instants
    /// (MotionBlurOutputs::surfaces): for Method::readsInstantMotions; other methods give none.
    std::vector<shader::InstantSurfaces> surfaces;
    /// False: the frame is drawn only for RasterHistory. For Method::readsInstantMotions, which
    /// then needs no timed rays.
    bool wantsPicture = true;
    bool wantsCounters = true;           ///< MotionBlur::counters() will be read
    bool wantsMethodCounters = true;     ///< and the method's own among them, not the blocks alone
    bool measureEdgesEverywhere = false; ///< fill the edge view beyond candidates (debug, slower)
    /// The colour image may be written in place: it is a transient, or has storage usage. Where
    /// little moves, still pixels are then not touched.
    bool colorIsWritable = false;
    /// Index of the frame in flight, below kMaxSlots (params.h): the GPU must have finished with
    /// the slot's last frame.
    uint32_t slot = 0;

    /// Whether the method reads back its own counters.
    [[nodiscard]] bool methodCountersEnabled() const {
        return wantsCounters && wantsMethodCounters;
    }

    /// Whether `color` may be the target of the blurred picture.
    [[nodiscard]] bool mayWriteColor() const {
        return target.isValid() ? target == color : colorIsWritable;
    }

    /// Target of the blurred picture: an image with storage and transfer usage that is no other
    /// input, or `color` if that is writable. Invalid: the cheapest choice. Unused by methods that
    /// do not read the raster image.
    graph::ImageHandle target;
};

/// An intermediate for debug views; drawn only if something reads it.
struct View {
    std::string_view name;
    graph::ImageHandle image;
};

struct MotionBlurOutputs {
    graph::ImageHandle color; ///< RGBA16F: the blurred picture
    /// One for each of MotionBlurInputs::surfaces, with its words; empty: the method leaves none.
    std::vector<graph::BufferHandle> surfaces;
    /// Those of Method::views; by `hybrid` also reveal_id, which the debug view `unresolved` reads.
    std::vector<View> views;

    /// Invalid: the method has no such view.
    [[nodiscard]] graph::ImageHandle view(std::string_view name) const {
        for (const View& one : views)
            if (one.name == name)
                return one.image;
        return {};
    }
};

} // namespace shutter::motion_blur
