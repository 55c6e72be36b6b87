// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/host_answers.h"
#include "modules/motion_blur/passes/resolve_pass.h"

namespace shutter::motion_blur {

/// The passes that list samples for a host, record its commands, and merge the answers into the
/// picture.
class HostSamplesPass {
  public:
    explicit HostSamplesPass(gpu::Device& device);

    /// \param found of a ResolvePass that lists pixels; gets the picture with the answers
    /// \param params with shader::ResolvedParams whose rayLimit is the expected number of requested
    /// samples, if there are as many
    /// \param own must outlive the graph
    void
    add(graph::Graph& graph,
        const HostSamples& own,
        ResolvePassOutputs& found,
        const PassParams& params) const;

  private:
    struct Lists;
    struct Searching;

    [[nodiscard]] Lists
    createLists(graph::Graph& graph, const PassParams& params, bool hasLens) const;
    void addList(
        graph::Graph& graph, ResolvePassOutputs& found, Lists& lists, const PassParams& params
    ) const;
    void addAnswer(
        graph::Graph& graph, const HostSamples& own, Lists& lists, const PassParams& params
    ) const;
    void addCollect(
        graph::Graph& graph, ResolvePassOutputs& found, const Lists& lists, const PassParams& params
    ) const;

    gpu::Device& mDevice;
    SearchPipelines mList; ///< hosts have no second raster
    SearchPipelines mCollect;
};

} // namespace shutter::motion_blur
