// SPDX-License-Identifier: MIT
#include "engine/render/explainer.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace shutter::render {

const char* describe(ExplainedKind kind) {
    switch (kind) {
    case ExplainedKind::Effect:
        return "effect";
    case ExplainedKind::Work:
        return "work";
    case ExplainedKind::Pass:
        return "pass";
    }
    return "";
}

const char* describe(PassOwner owner) {
    switch (owner) {
    case PassOwner::Scene:
        return "scene";
    case PassOwner::Rays:
        return "rays";
    case PassOwner::Blur:
        return "blur";
    case PassOwner::Other:
        return "other";
    case PassOwner::Display:
        return "display";
    }
    return "";
}

const core::Decision*
findDecision(std::span<const Explanation> explanations, const std::string& subject) {
    const auto found =
        std::find_if(explanations.begin(), explanations.end(), [&](const Explanation& e) {
            return e.kind != ExplainedKind::Pass && e.subject == subject;
        });
    return found == explanations.end() ? nullptr : &found->decision;
}

void Explainer::decide(ExplainedKind kind, std::string subject, core::Decision decision) {
    mDecided.push_back({kind, std::move(subject), std::move(decision)});
}

const Explainer::PassRange* Explainer::findRange(size_t pass) const {
    const auto own = std::find_if(mRanges.rbegin(), mRanges.rend(), [&](const PassRange& range) {
        return range.first <= pass && pass < range.end;
    });
    return own == mRanges.rend() ? nullptr : &*own;
}

std::vector<PassOwner> Explainer::listOwners(const graph::Plan& plan) const {
    std::vector<PassOwner> owners;
    for (const graph::PlannedPass& planned : plan.passes) {
        const PassRange* range = findRange(planned.pass);
        owners.push_back(range ? range->owner : PassOwner::Scene);
    }
    return owners;
}

std::vector<Explanation>
Explainer::finish(const graph::Graph& graph, const graph::Plan& plan, bool passes) const {
    std::vector<Explanation> all;
    std::copy_if(
        mDecided.begin(),
        mDecided.end(),
        std::back_inserter(all),
        [](const Explanation& e) { return e.kind != ExplainedKind::Pass; }
    );
    if (!passes)
        return all;
    for (const graph::PlannedPass& planned : plan.passes) {
        const PassRange* range = findRange(planned.pass);
        all.push_back(
            {ExplainedKind::Pass,
             graph.passes()[planned.pass].name,
             {true, range ? range->reason : "the frame needs it"}}
        );
    }
    std::copy_if(
        mDecided.begin(),
        mDecided.end(),
        std::back_inserter(all),
        [](const Explanation& e) { return e.kind == ExplainedKind::Pass; }
    );
    for (const graph::CulledPass& culled : plan.culled)
        all.push_back({ExplainedKind::Pass, culled.name, {false, culled.reason}});
    return all;
}

} // namespace shutter::render
