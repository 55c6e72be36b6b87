// SPDX-License-Identifier: MIT
// Overlays of one frame that are drawn at one place, in the raster or over an effect: what they
// need of the effect below them, and their passes.
#pragma once

#include "engine/render/overlay.h"

#include <cstddef>
#include <span>
#include <vector>

namespace shutter::render {

class FrameOverlays {
  public:
    /// Calls extract() of more, in the order in which they are drawn. Error: the first of theirs.
    /// \param areTakers they draw taken rows
    [[nodiscard]] core::Status
    extract(std::span<Overlay* const> overlays, const OverlayExtract& source, bool areTakers);

    /// None draws anything.
    [[nodiscard]] bool empty() const { return mDrawn.empty(); }

    [[nodiscard]] const std::vector<Explanation>& explanations() const { return mExplanations; }

    /// That the effect must find: PictureContext::surfaces.
    [[nodiscard]] const std::vector<shader::InstantSurfaces>& surfaces() const { return mSurfaces; }

    /// Adds "... instants" and "... bytes" of those that are drawn at instants.
    void count(Counters& counters) const;

    /// Declares takers, or the others.
    /// \param words for each of surfaces()
    /// \return the picture with them
    [[nodiscard]] graph::ImageHandle declare(
        OverlayContext context,
        bool areTakers,
        std::span<const graph::BufferHandle> words,
        Explainer& explainer
    ) const;

    /// Publishes wanted intermediates of those that are no takers. The raster's depth hides them.
    void publishAlone(
        const OverlayContext& context, Intermediates& intermediates, Explainer& explainer
    ) const;

  private:
    struct Drawn {
        Overlay* overlay = nullptr;
        OverlayPlan plan;
        size_t words = 0;     ///< index of mSurfaces, with plan.readsSurfaces
        bool isOwner = false; ///< of that
        bool isTaker = false;
    };

    void shareSurfaces(Drawn& drawn);

    std::vector<Drawn> mDrawn;
    std::vector<shader::InstantSurfaces> mSurfaces;
    std::vector<Explanation> mExplanations;
};

} // namespace shutter::render
