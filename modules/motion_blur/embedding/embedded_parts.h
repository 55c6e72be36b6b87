// SPDX-License-Identifier: MIT
// Parts of EmbeddedMotionBlur; included only by its sources.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/graph/graph.h"
#include "engine/graph/transient_pool.h"
#include "modules/motion_blur/embedding/check/checker.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/embedding/host_blended.h"
#include "modules/motion_blur/embedding/host_instants.h"
#include "modules/motion_blur/instant_motions.h"

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace shutter::motion_blur {

/// What one frame in flight holds.
struct EmbeddedMotionBlur::Slot {
    Slot(gpu::Device& device, uint32_t timestampBits)
        : frame(gpu::Frame::createForHost(device, timestampBits)), pool(device) {}

    std::unique_ptr<gpu::Frame> frame;
    graph::TransientPool pool;
    /// Views of the host's images, recreated in each frame: an equal handle need not be the same
    /// image. A deque, since the graph points to them.
    std::deque<gpu::Image> images;
    gpu::Buffer instants;          ///< math::InstantLayers, for the methods that read them
    gpu::Buffer convention;        ///< shader::PrepareTable, where motion and depth are made
    gpu::Buffer overlay;           ///< shader::OverlayTable, where inputs are shown
    gpu::Buffer response;          ///< shader::ResponseTable, where points of it are given
    uint64_t handedOver = 0;       ///< timeline value of the last recording
    uint32_t recordings = 0;       ///< counter that the GPU marks once it has run the last of them
    bool isCompletionKnown = true; ///< by markDone(), or there is none
    bool counts = false;           ///< the last recording has counters
    uint32_t view = 0;             ///< of the last recording
    /// The budget's level that the frame was recorded with; nothing: the budget has its time
    /// already.
    std::optional<size_t> level;
    std::string droppedQuality;
};

/// State of a view between frames.
struct EmbeddedMotionBlur::View {
    explicit View(gpu::Device& device) : history(device) {}

    /// Describes the raster that `history` stores or the host lends; nothing: there is no previous
    /// frame.
    std::optional<HostRaster> last;
    RasterHistory history;
    std::optional<BudgetController> budget;
    MotionBlurSettings wanted; ///< that `budget` begins with

    void forget() {
        last.reset();
        history.forget();
    }
};

/// A recording in progress.
struct EmbeddedMotionBlur::Frame {
    uint32_t number; ///< of the frame in flight
    Slot& slot;
    graph::Graph& graph;
    const HostInputs& inputs;
    const MotionBlurSettings& settings;
    bool wantsCounters = false;
    /// Uses placeholder handles: the graph is compiled but not executed.
    bool isImagined = false;
    /// What frames to come may have and this one does not is planned for, too: movers that follow
    /// their vectors, and more of them than a tile's list holds.
    bool hasAll = false;

    bool isHosts = false; ///< the host will submit it: it may be checked and dumped
    bool isDumped = false;
    HostReveal dumpedReveal{}; ///< the host's, whose answer is dumped
    /// Made from HostInputs::responsePoints; none where they are a box.
    std::optional<shader::ResponseTable> responseTable{};
    std::optional<BlendedDraws> drawn{}; ///< of HostInputs::drawn
    ImportedInputs images{};             ///< the host's own
    graph::ImageHandle output{};         ///< the same; in place: invalid

    /// In main memory; null: there is none, or its address alone is known.
    [[nodiscard]] const shader::ResponseTable* response() const {
        if (responseTable)
            return &*responseTable;
        return inputs.response != 0 ? inputs.motion.response : nullptr;
    }

    /// The method follows the camera alone, by HostConvention::cameras.
    [[nodiscard]] bool wantsCameraMotion() const {
        return settings.method->readsCamera && inputs.rays.frameConstants == 0 && !inputs.isOff;
    }

    /// Invalid where there is no image.
    [[nodiscard]] graph::ImageHandle import(
        gpu::Device& device, const char* name, const HostImage& given, const HostImageRule& rule
    );
};

} // namespace shutter::motion_blur
