// SPDX-License-Identifier: MIT
#include "game/bench/sequence/sequence_source.h"

#include "engine/io/file_bytes.h"
#include "engine/scene/camera.h"
#include "engine/scene/motion.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <string>

namespace shutter::bench {

core::Result<SequenceFiles>
writeSequenceFiles(const SequenceCase& film, const std::filesystem::path& folder) {
    const std::filesystem::path scenes = folder / "scenes";
    // A demo finds its scene by its own name.
    const std::string name = film.demo.empty() ? film.name : film.demo;
    SequenceFiles files{scenes / (name + ".glb"), scenes / (film.name + ".json")};
    SHUTTER_TRY(film.writeScene(files.scene));
    SHUTTER_TRY(io::writeFileText(files.script, std::string(film.script)));
    return files;
}

core::Result<std::unique_ptr<SequenceSource>>
SequenceSource::open(const SequenceCase& film, const SequenceFiles& files, uint32_t frames) {
    return film.demo.empty() ? openFlight(film, files, frames) : openDemo(film, files);
}

extract::ViewRequest SequenceSource::view() const {
    extract::ViewRequest view = ownView();
    if (mStanding != ecs::kNullEntity)
        view.camera = mStanding;
    return view;
}

StandingView SequenceSource::standingView() const {
    const extract::ViewRequest view = ownView();
    const double seconds = view.exposure.raster;
    const math::dmat4 rigid = scene::worldFromRigid(world(), view.camera, seconds);
    StandingView standing;
    standing.pose.translation = math::dvec3(rigid[3]);
    standing.pose.rotation = glm::normalize(glm::quat_cast(math::dmat3(rigid)));
    standing.lens = world().registry.get<scene::Camera>(view.camera);
    standing.lens.yFov = scene::yFovAt(world(), view.camera, seconds);
    standing.shutter = view.exposure.shutter;
    return standing;
}

void SequenceSource::stand(const StandingView& from) {
    SHUTTER_CHECK(mStanding == ecs::kNullEntity, "it has a camera at rest already");
    ecs::Registry& registry = changeWorld().registry;
    mStanding = registry.create();
    registry.add(mStanding, from.lens);
    registry.add(mStanding, scene::LocalTransform{from.pose});
    registry.add(mStanding, from.shutter);
}

} // namespace shutter::bench
