// SPDX-License-Identifier: MIT
#include "tests/graph/hazard_simulator.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

namespace shutter::graph {

namespace {

constexpr VkDeviceSize kCellBytes = 256; // placements of the tests are multiples of it

struct Touch {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 reads = 0;
    VkAccessFlags2 writes = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

Touch touchOf(Access access, PassKind kind) {
    const auto compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const auto fragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    const auto transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    const auto build = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
    const auto sampled = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    switch (access) {
    case Access::SampledCompute:
        return {compute, sampled, 0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    case Access::SampledFragment:
        return {fragment, sampled, 0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    case Access::StorageRead:
        return {compute, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, 0, VK_IMAGE_LAYOUT_GENERAL};
    case Access::StorageWrite:
    case Access::StorageWriteDisjoint:
        return {
            compute,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
            VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_IMAGE_LAYOUT_GENERAL};
    case Access::ColorAttachment:
        return {
            VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
            VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
            VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    case Access::DepthAttachment:
        return {
            VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
            VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
            VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
            VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
    case Access::TransferRead:
        return {transfer, VK_ACCESS_2_TRANSFER_READ_BIT, 0, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    case Access::TransferWrite:
        return {transfer, 0, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    case Access::IndirectRead:
        return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, 0};
    case Access::ShaderRead:
        return {
            kind == PassKind::Build     ? build
            : kind == PassKind::Compute ? compute
                                        : VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | fragment,
            VK_ACCESS_2_SHADER_READ_BIT,
            0};
    case Access::AccelerationRead:
        return {
            kind == PassKind::Build ? build : compute,
            VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR,
            0};
    case Access::AccelerationBuild:
        return {
            build,
            VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR,
            VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR};
    case Access::OutsideWrite:
    case Access::HostRead:
        break; // no simulated frame has the one, and touch() the other by itself
    }
    ADD_FAILURE() << "an access that is not simulated";
    return {};
}

bool covers(uint64_t all, uint64_t part) {
    return (all & part) == part;
}

VkPipelineStageFlags2 expandStages(VkPipelineStageFlags2 stages) {
    const bool all = (stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) != 0;
    return all ? ~VkPipelineStageFlags2{VK_PIPELINE_STAGE_2_HOST_BIT} : stages;
}

VkAccessFlags2 expandAccess(VkAccessFlags2 access) {
    return (access & VK_ACCESS_2_MEMORY_WRITE_BIT) != 0 ? ~VkAccessFlags2{0} : access;
}

struct Event {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    VkPipelineStageFlags2 after = 0; ///< stages that now wait for it
    bool available = false;
    bool isDisjoint = false; ///< a write disjoint from others of its kind
    std::map<VkPipelineStageFlags2, VkAccessFlags2> visible{}; ///< by single stage
};

struct Barrier {
    VkPipelineStageFlags2 srcStages = 0;
    VkAccessFlags2 srcAccess = 0;
    VkPipelineStageFlags2 dstStages = 0;
    VkAccessFlags2 dstAccess = 0;
    bool transition = false;
    bool drops = false;
};

struct Cell {
    std::vector<Event> writes; ///< none, one, or some that are disjoint
    std::vector<Event> reads;  ///< since the write
    std::pair<uint32_t, uint32_t> contents{UINT32_MAX, 0};
};

void show(Event& write, VkPipelineStageFlags2 stages, VkAccessFlags2 access) {
    for (uint32_t bit = 0; bit < 64; ++bit)
        if (stages >> bit & 1)
            write.visible[VkPipelineStageFlags2{1} << bit] |= access;
}

bool sees(const Event& write, VkPipelineStageFlags2 stages, VkAccessFlags2 access) {
    for (uint32_t bit = 0; bit < 64; ++bit) {
        const VkPipelineStageFlags2 stage = VkPipelineStageFlags2{1} << bit;
        if ((stages & stage) == 0)
            continue;
        const auto shown = write.visible.find(stage);
        if (shown == write.visible.end() || !covers(shown->second, access))
            return false;
    }
    return true;
}

/// Returns whether everything before is ordered and flushed, as a transition needs.
bool applyBarrier(Cell& cell, const Barrier& barrier) {
    bool complete = true;
    const auto order = [&](Event& event) {
        const bool direct = covers(barrier.srcStages, event.stages) && event.stages != 0;
        const bool chained = (event.after & barrier.srcStages) != 0;
        if (direct || chained)
            event.after |= barrier.dstStages;
        complete &= direct || chained;
        return std::pair(direct, direct || chained);
    };
    for (Event& write : cell.writes) {
        const auto [direct, ordered] = order(write);
        if (direct && covers(barrier.srcAccess, write.access))
            write.available = true;
        if (ordered && write.available)
            show(write, barrier.dstStages, barrier.dstAccess);
        complete &= write.available;
    }
    for (Event& read : cell.reads)
        order(read);
    if (barrier.transition) {
        Event transition;
        transition.after = barrier.dstStages;
        transition.available = true;
        show(transition, barrier.dstStages, barrier.dstAccess);
        cell.writes = {transition};
        cell.reads.clear();
        if (barrier.drops)
            cell.contents = {UINT32_MAX, 0};
    }
    return complete;
}

class Simulator {
  public:
    Simulator(const Graph& graph, const Plan& plan)
        : mGraph(graph), mPlan(plan), mBlock(plan.blockBytes / kCellBytes + 1),
          mSingles(graph.resources().size()), mLayouts(graph.resources().size()),
          mHostReads(graph.resources().size()) {
        for (uint32_t i = 0; i < graph.resources().size(); ++i) {
            const ResourceRecord& record = graph.resources()[i];
            if (!record.imported)
                continue;
            mLayouts[i] = record.initialLayout;
            mSingles[i].writes = {
                {expandStages(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT), ~VkAccessFlags2{0}}};
            if (record.hasContentsAtStart())
                mSingles[i].contents = {i, 0};
        }
    }

    std::vector<std::string> run() {
        for (const PlannedPass& planned : mPlan.passes) {
            const PassRecord& pass = mGraph.passes()[planned.pass];
            mWhere = pass.name;
            for (const ImageBarrier& barrier : planned.imageBarriers)
                applyImage(barrier);
            for (const BufferBarrier& barrier : planned.bufferBarriers)
                applyBuffer(barrier);
            for (const ResourceUse& use : pass.uses)
                touch(use, pass.kind);
        }
        mWhere = "the end";
        for (const ImageBarrier& barrier : mPlan.finalImageBarriers)
            applyImage(barrier);
        for (const BufferBarrier& barrier : mPlan.finalBufferBarriers)
            applyBuffer(barrier);
        checkEnd();
        return mHazards;
    }

  private:
    void report(uint32_t resource, const char* what) {
        mHazards.push_back(
            fmt::format("at {}: '{}' {}", mWhere, mGraph.resources()[resource].name, what)
        );
    }

    std::vector<Cell*> cellsOf(uint32_t resource) {
        for (const Placement& image : mPlan.images) {
            if (image.resource != resource)
                continue;
            std::vector<Cell*> cells;
            for (VkDeviceSize at = image.offset; at < image.offset + image.bytes; at += kCellBytes)
                cells.push_back(&mBlock.at(at / kCellBytes));
            return cells;
        }
        return {&mSingles[resource]};
    }

    template <class Declared> static Barrier expand(const Declared& barrier) {
        return {
            expandStages(barrier.srcStages),
            expandAccess(barrier.srcAccess),
            expandStages(barrier.dstStages),
            expandAccess(barrier.dstAccess)};
    }

    void applyImage(const ImageBarrier& barrier) {
        Barrier simple = expand(barrier);
        simple.transition = barrier.oldLayout != barrier.newLayout;
        simple.drops = barrier.oldLayout == VK_IMAGE_LAYOUT_UNDEFINED;
        if (!simple.drops && mLayouts[barrier.resource] != barrier.oldLayout)
            report(barrier.resource, "is in another layout than its barrier has");
        for (Cell* cell : cellsOf(barrier.resource))
            if (!applyBarrier(*cell, simple) && simple.transition)
                report(barrier.resource, "is moved to a layout while still in use");
        mLayouts[barrier.resource] = barrier.newLayout;
    }

    void applyBuffer(const BufferBarrier& barrier) {
        for (Cell* cell : cellsOf(barrier.resource))
            applyBarrier(*cell, expand(barrier));
    }

    void touch(const ResourceUse& use, PassKind kind) {
        if (use.access == Access::HostRead) {
            mHostReads[use.resource] = true;
            return;
        }
        const Touch touch = touchOf(use.access, kind);
        if (mGraph.resources()[use.resource].isImage && mLayouts[use.resource] != touch.layout)
            report(use.resource, "is used in the wrong layout");
        for (Cell* cell : cellsOf(use.resource))
            touchCell(*cell, use, touch);
    }

    void touchCell(Cell& cell, const ResourceUse& use, const Touch& touch) {
        const bool needsContents = use.readVersion != kNoVersion;
        if (needsContents && cell.contents != std::pair(use.resource, use.readVersion))
            report(use.resource, "does not hold the version that is wanted");
        const bool isDisjoint = use.access == Access::StorageWriteDisjoint;
        for (const Event& write : cell.writes) {
            if (isDisjoint && write.isDisjoint)
                continue;
            if (!covers(write.after, touch.stages) || !write.available)
                report(use.resource, "is used before a write is done");
            else if (needsContents && !sees(write, touch.stages, touch.reads))
                report(use.resource, "is read without seeing what was written");
        }
        if (use.writeVersion == kNoVersion) {
            cell.reads.push_back({touch.stages, touch.reads});
            return;
        }
        for (const Event& read : cell.reads)
            if (!covers(read.after, touch.stages))
                report(use.resource, "is written before a read is done");
        const bool joins = isDisjoint && cell.reads.empty() &&
                           std::all_of(cell.writes.begin(), cell.writes.end(), [](const Event& e) {
                               return e.isDisjoint;
                           });
        if (!joins)
            cell.writes.clear();
        Event& event = cell.writes.emplace_back(Event{touch.stages, touch.writes});
        event.isDisjoint = isDisjoint;
        cell.reads.clear();
        cell.contents = {use.resource, use.writeVersion};
    }

    void checkEnd() {
        for (const auto& [resource, version] : mGraph.outputs()) {
            for (const Cell* cell : cellsOf(resource))
                if (cell->contents != std::pair(resource, version))
                    report(resource, "is an output whose contents are lost");
            mHostReads[resource] =
                mGraph.resources()[resource].imported && !mGraph.resources()[resource].isImage;
        }
        for (uint32_t i = 0; i < mHostReads.size(); ++i) {
            const ResourceRecord& record = mGraph.resources()[i];
            for (const Event& write : mSingles[i].writes)
                if (mHostReads[i] &&
                    !sees(write, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT))
                    report(i, "is not shown to the host");
            if (record.isImage && record.imported &&
                record.finalLayout != VK_IMAGE_LAYOUT_UNDEFINED &&
                record.finalLayout != mLayouts[i])
                report(i, "ends in the wrong layout");
        }
    }

    const Graph& mGraph;
    const Plan& mPlan;
    std::vector<Cell> mBlock;
    std::vector<Cell> mSingles; ///< by resource: imported ones and buffers
    std::vector<VkImageLayout> mLayouts;
    std::vector<bool> mHostReads;
    std::vector<std::string> mHazards;
    std::string mWhere;
};

} // namespace

std::vector<std::string> findHazards(const Graph& graph, const Plan& plan) {
    return Simulator(graph, plan).run();
}

} // namespace shutter::graph
