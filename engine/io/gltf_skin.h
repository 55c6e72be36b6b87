// SPDX-License-Identifier: MIT
// Private to engine/io.
#pragma once

#include "engine/io/gltf_context.h"

namespace shutter::io {

/// Skins are not deformed yet: a skinned mesh is drawn as it is stored (the bind pose), under the
/// transform of its node. This warns of that and checks the joints of every mesh that a node draws
/// with a skin against that skin, because a file that names joints past it is damaged. Throws
/// GltfError.
void checkSkinnedNodes(GltfContext& context);

} // namespace shutter::io
