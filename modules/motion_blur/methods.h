// SPDX-License-Identifier: MIT
// A blur method, as data and passes. Each lives in a file of methods/, and methods.cpp lists them.
#pragma once

#include "engine/gpu/device.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/params.h"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::motion_blur {

class BudgetLadder;
class SharedPasses;

/// Which of the device's ray tiers a method needs.
enum class RayNeed : uint8_t {
    None,
    Any,   ///< any tier: rays at the raster instant (MotionBlurInputs::rays)
    Query, ///< nested ray queries: time-sampled rays (MotionBlurInputs::timedRays)
};

/// What MotionBlurSettings::sampleCount counts.
enum class SampleUnit : uint8_t {
    Taps,     ///< taps of each gather
    Instants, ///< instants of the exposure
    Rays,     ///< rays per pixel
};

/// Numbers that a frame counted on the GPU, e.g. "rays traced".
using Counters = std::map<std::string, uint64_t>;

/// The passes of one method. Pipelines are made when a frame first needs them.
class MethodPasses {
  public:
    virtual ~MethodPasses() = default;

    /// Declares the passes of a frame. `params` are resolve()'s, with the frame's response table.
    [[nodiscard]] virtual MotionBlurOutputs
    add(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        const PassParams& params,
        SharedPasses& shared) = 0;

    /// Whether add() waits for none of the pipelines that take long to make and that the device
    /// makes ahead.
    [[nodiscard]] virtual bool isReady() const { return true; }

    /// Adds the counters of the frame declared last for the slot, except for the blocks of
    /// SharedPasses; the GPU must have finished that frame.
    virtual void count(uint32_t /*slot*/, Counters& /*counters*/) const {}
};

struct Method {
    const char* name;        ///< on the command line, in JSON and reports
    const char* description; ///< a few words
    const char* publication; ///< authors, year or title
    /// The name of a cheaper method without rays that may draw frames until
    /// MethodPasses::isReady(). Null: frames wait.
    const char* standIn = nullptr;
    RayNeed rays = RayNeed::None;
    SampleUnit sampleUnit = SampleUnit::Taps;
    uint32_t defaultSamples = 15;
    /// The raster image is an input; false: the method draws its own picture.
    bool readsRaster = true;
    bool readsNormal = false;   ///< MotionBlurInputs::normal is an input
    bool readsEntityId = false; ///< MotionBlurInputs::entityId is an input
    /// MotionBlurInputs::rays->frameConstants is an input even though no ray is traced, unless
    /// MotionBlurInputs::motionIsCameras.
    bool readsCamera = false;
    bool readsLens = false; ///< samples have places in the lens, with ViewRequest::usesLens
    bool readsInstantMotions = false; ///< MotionBlurInputs::instantMotions is an input
    bool blursObjects = true;         ///< false: only the camera's own motion is blurred
    bool countsBlocks = true;         ///< its filters go over SharedPasses' lists of blocks
    bool usesUniformMotion = false;   ///< blocks of uniform motion have a separate filter
    uint32_t listBytesPerPixel = 0;   ///< of the largest storage buffer, which grows with pixels
    std::vector<std::string_view> settings{}; ///< fields of MotionBlurSettings that it reads,
                                              ///< except sampleCount, which each method reads
    std::vector<std::string_view> views{};    ///< intermediates that it offers

    /// Nothing but the images of the raster is an input.
    [[nodiscard]] bool readsImagesOnly() const {
        return rays == RayNeed::None && !readsCamera && !readsInstantMotions;
    }

    /// Turns the settings into `params`: the method's own block, and changes to the rest. Null:
    /// nothing.
    void (*resolve)(const MotionBlurSettings& settings, PassParams& params) = nullptr;
    /// Whether rays may hit something even where no surface lies behind a mover. Null: never.
    bool (*alwaysTraces)(const MotionBlurSettings& settings) = nullptr;
    /// Adds the levels by which the method gives up quality (budget_ladder.h).
    void (*addBudgetLevels)(BudgetLadder& ladder, const MotionBlurSettings& wanted);
    /// \param sceneLayout of graph::RayScene::textures; null without rays
    std::unique_ptr<MethodPasses> (*makePasses
    )(gpu::Device& device, VkDescriptorSetLayout sceneLayout);
};

/// In the order in which quality rises.
[[nodiscard]] std::span<const Method* const> listMethods();

/// Null: there is none of that name.
[[nodiscard]] const Method* findMethod(std::string_view name);

/// The method of that name, which must exist (CHECKed).
[[nodiscard]] const Method& getMethod(std::string_view name);

} // namespace shutter::motion_blur
