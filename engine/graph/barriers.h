// SPDX-License-Identifier: MIT
#pragma once

#include "engine/graph/compile.h"

namespace shutter::graph {

/// Fills the barriers of a plan whose passes are ordered and whose images are placed.
///
/// The uses of a resource fall into runs: a write by itself, or all reads up to the next write that
/// agree on the layout. One barrier stands before a run, for all stages and accesses in it:
/// - read after write, write after write, any change of layout: execution and memory;
/// - write after read: execution only, unless the write needs contents its stage has not seen;
/// - first use of a transient image: from UNDEFINED, behind the last uses of every image that had
///   its memory before; frames need no more, since each has a pool of its own and waits for its
///   GPU;
/// - first use of an imported resource: behind everything an earlier submission may have written.
void placeBarriers(const Graph& graph, Plan& plan);

} // namespace shutter::graph
