// SPDX-License-Identifier: MIT
// The list of reasons that `--explain` prints: why effects, work and passes ran or were skipped.
#pragma once

#include "engine/core/result.h"
#include "engine/graph/compile.h"
#include "engine/graph/graph.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace shutter::render {

enum class ExplainedKind : uint8_t {
    Effect, ///< an effect on the picture
    Work,   ///< a part of the renderer's own frame
    Pass,   ///< a pass of the graph
};

[[nodiscard]] const char* describe(ExplainedKind kind);

/// The part of the frame that a pass belongs to, for the statistics.
enum class PassOwner : uint8_t {
    Scene,   ///< any picture needs it: deformed meshes, G-buffer
    Rays,    ///< acceleration structures that effects trace rays through
    Blur,    ///< the motion blur, by any method
    Other,   ///< any other effect
    Display, ///< brings the linear picture to a screen, a file or memory
};

/// "scene", "rays", "blur", "other" or "display".
[[nodiscard]] const char* describe(PassOwner owner);

/// Why one thing ran or was skipped.
struct Explanation {
    ExplainedKind kind = ExplainedKind::Effect;
    std::string subject;
    core::Decision decision;
};

/// The decision about the effect or work of that name; null if there was none.
[[nodiscard]] const core::Decision*
findDecision(std::span<const Explanation> explanations, const std::string& subject);

/// Collects a frame's reasons while it is declared.
class Explainer {
  public:
    void decide(ExplainedKind kind, std::string subject, core::Decision decision);

    /// Calls `declare`: passes that it declares work for `owner` and run for `reason`, unless
    /// something else was decided about them.
    template <class Declare>
    decltype(auto) declareOwned(
        const graph::Graph& graph, PassOwner owner, std::string reason, Declare&& declare
    ) {
        const Owned owned(*this, graph, owner, std::move(reason));
        return std::forward<Declare>(declare)();
    }

    /// Owners of the plan's passes, in execution order.
    [[nodiscard]] std::vector<PassOwner> listOwners(const graph::Plan& plan) const;
    /// Effects and work as decided; with `passes`, the passes too: those of the plan in execution
    /// order, then omitted and culled passes.
    [[nodiscard]] std::vector<Explanation>
    finish(const graph::Graph& graph, const graph::Plan& plan, bool passes) const;

  private:
    struct PassRange {
        size_t first = 0; ///< index into Graph::passes()
        size_t end = 0;
        PassOwner owner = PassOwner::Scene;
        std::string reason;
    };

    /// Ends its range when it goes out of scope.
    struct Owned {
        Owned(Explainer& all, const graph::Graph& declared, PassOwner owner, std::string reason)
            : explainer(all), graph(declared), index(all.mRanges.size()) {
            all.mRanges.push_back({graph.passes().size(), SIZE_MAX, owner, std::move(reason)});
        }

        ~Owned() { explainer.mRanges[index].end = graph.passes().size(); }

        Owned(const Owned&) = delete;
        Owned& operator=(const Owned&) = delete;

        Explainer& explainer;
        const graph::Graph& graph;
        size_t index;
    };

    /// The innermost. Null for passes that were not declared by declareOwned().
    [[nodiscard]] const PassRange* findRange(size_t pass) const;

    std::vector<Explanation> mDecided;
    std::vector<PassRange> mRanges; ///< by rising first, the outer before the inner
};

} // namespace shutter::render
