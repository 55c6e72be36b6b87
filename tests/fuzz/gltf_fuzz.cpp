// SPDX-License-Identifier: MIT
// Loads a scene, and poses its entities.
#include "engine/gltf/gltf_loader.h"
#include "engine/scene/deformation.h"
#include "engine/scene/motion.h"
#include "modules/particles/particle_extras.h"
#include "tests/fuzz/fuzz_file.h"

namespace {

using namespace shutter;

constexpr uint64_t kMaxBytes = uint64_t(64) << 20;

void checkMesh(const scene::Mesh& mesh) {
    for (const scene::Primitive& primitive : mesh.primitives) {
        const size_t count = primitive.positions.size();
        SHUTTER_CHECK(primitive.normals.size() == count, "{} normals", primitive.normals.size());
        for (const uint32_t index : primitive.indices)
            SHUTTER_CHECK(index < count, "index {} of {} vertices", index, count);
    }
}

void checkWorld(scene::World& world) {
    for (const scene::Mesh& mesh : world.assets.meshes)
        checkMesh(mesh);
    size_t posed = 0;
    for (const auto& [entity, instance] : world.registry.view<const scene::MeshInstance>()) {
        SHUTTER_CHECK(instance.mesh < world.assets.meshes.size(), "mesh {}", instance.mesh);
        constexpr size_t kMaxPosed = 16;
        if (++posed > kMaxPosed)
            break;
        for (const double seconds : {-1.0, 0.3, 1e6}) {
            (void)scene::worldFromEntity(world, entity, seconds);
            if (scene::isDeformable(world, entity))
                (void)scene::deformationAt(world, entity, seconds);
        }
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    auto loaded = gltf::loadGltf(
        fuzz::writeInput(data, size),
        {.maxVertexBytes = kMaxBytes, .maxImageBytes = kMaxBytes},
        {&particles::kParticleExtras, 1}
    );
    if (loaded)
        checkWorld(loaded.value().world);
    else
        fuzz::expectSentence(loaded.error());
    return 0;
}
