// SPDX-License-Identifier: MIT
// Parts that processes of this machine do.
#pragma once

#include "engine/core/result.h"
#include "game/parts/job_options.h"
#include "game/parts/part_work.h"

namespace shutter::parts {

/// Does the parts that are not done, each by a process of its own, with a bar of their progress on
/// stderr. The processes end when this one does. Error: what the first part that failed said; the
/// others that run are waited for, and no more are started.
[[nodiscard]] core::Status runHere(const PartWork& work, const JobOptions& options);

} // namespace shutter::parts
