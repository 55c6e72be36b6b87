// SPDX-License-Identifier: MIT
// Pictures that share a view share the measurement of its cap.
#include "game/shot/picture_drawer.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <optional>
#include <utility>

namespace shutter {
namespace {

class PictureDrawerTest : public test::GpuTest {};

TEST_F(PictureDrawerTest, ACapThatIsGivenIsNotMeasuredAgain) {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeBox({0.8, 0.8, 0.8}, scene.addColor({0.9f, 0.2f, 0.1f})),
        {.position = {0, 0, -3}, .velocity = {0.8, 0, 0}}
    );
    scene.world.registry.add(
        scene.camera,
        scene::CameraShutter{
            .exposureSeconds = 1.0, .phase = scene::ShutterPhase::Centre, .maxBlurPercent = 90.0}
    );
    const game::Shot shot{std::move(scene.world), scene.camera};
    game::ShotOptions options;
    options.width = 40;
    options.height = 30;
    render::Renderer renderer(device(), shot.world.assets);
    game::PictureDrawer drawer(device(), renderer);
    const auto draw = [&](const char* method, std::optional<scene::MotionCap> cap) {
        game::PictureRequest picture = game::makePicture(
            shot, options, game::makeMethod(*game::findMethod(method).value()), 0.0
        );
        picture.cap = std::move(cap);
        auto drawn = drawer.draw(shot.world, picture);
        EXPECT_TRUE(drawn.ok());
        return drawn ? std::move(drawn.value().color) : image::Image();
    };
    const image::Image sharp = draw("sharp", {});
    EXPECT_FALSE(test::sameBits(draw("gather", {}), sharp)) << "the measured cap leaves motion";
    EXPECT_TRUE(test::sameBits(draw("gather", scene::MotionCap{.camera = 0.0, .movers = {}}), sharp)
    );
}

} // namespace
} // namespace shutter
