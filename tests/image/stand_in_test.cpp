// SPDX-License-Identifier: MIT
// Frames that another method draws while the pipelines of their own are still being made.
#include "engine/scene/history.h"
#include "game/shot/picture_drawer.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace shutter {
namespace {

using game::PictureDrawer;
using motion_blur::UntilReady;
using test::SceneBuilder;

constexpr const char* kBlendedPipeline = "ray reveal through blended surfaces";

/// A pane that moves before a wall.
SceneBuilder makeScene() {
    SceneBuilder builder;
    builder.setPerspective(0.9);
    builder.add(
        test::makeQuad(9, 7, builder.addTextured(builder.addWaveTexture())),
        {.position = {0, 0, -6}}
    );
    builder.add(
        test::makeQuad(0.7, 0.7, builder.addColor({1, 0, 0})),
        {.position = {-0.2, 0, -2}, .velocity = {0.8, 0.1, 0}}
    );
    return builder;
}

/// A device that makes pipelines ahead, except for one, which waits until it is let go.
class HoldingDevice {
  public:
    HoldingDevice(const std::string& name, gpu::RayTier tier) {
        gpu::DeviceOptions options;
        options.validate = true;
        options.wanted = name;
        options.bestTier = tier;
        options.pipelinesAhead = gpu::PipelinesAhead::Always;
        EXPECT_EQ(mkfifo(mFifo.c_str(), S_IRUSR | S_IWUSR), 0);
        auto made = test::openFaulty(
            options, "SHUTTER_FAULT_HOLD", kBlendedPipeline + ("=" + mFifo.string())
        );
        EXPECT_TRUE(made) << made.error().message;
        if (made)
            mDevice = std::move(made).value();
    }

    ~HoldingDevice() {
        letGo();
        mDevice.reset();
        close(mWriter);
        std::filesystem::remove(mFifo);
    }

    HoldingDevice(const HoldingDevice&) = delete;
    HoldingDevice& operator=(const HoldingDevice&) = delete;

    void letGo() {
        if (mWriter < 0)
            mWriter = open(mFifo.c_str(), O_RDWR); // does not wait for a reader
    }

    [[nodiscard]] gpu::Device* device() const { return mDevice.get(); }

  private:
    std::filesystem::path mFifo = std::filesystem::temp_directory_path() /
                                  ("shutter_held_pipeline_" + std::to_string(getpid()));
    int mWriter = -1;
    std::unique_ptr<gpu::Device> mDevice;
};

/// What is destroyed before a pipeline is made waits for it: a test that fails must not hold it.
struct LetGoAtEnd {
    HoldingDevice& holding;

    ~LetGoAtEnd() { holding.letGo(); }
};

struct Drawer {
    SceneBuilder scene = makeScene();
    render::Renderer renderer;
    PictureDrawer pictures;

    explicit Drawer(gpu::Device& device)
        : renderer(device, scene.world.assets), pictures(device, renderer) {}

    render::FrameResult draw(const char* method, UntilReady untilReady) {
        game::PictureRequest request;
        request.frame.view.camera = scene.camera;
        request.frame.view.exposure =
            scene::computeExposure({0.25, scene::ShutterPhase::Centre}, 0.0);
        request.frame.view.width = 96;
        request.frame.view.height = 64;
        request.frame.wantReasons = true;
        request.method = game::makeMethod(*game::findMethod(method).value());
        request.untilReady = untilReady;
        auto drawn = pictures.draw(scene.world, request);
        EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
        return drawn ? std::move(drawn).value() : render::FrameResult();
    }
};

bool standsIn(const render::FrameResult& frame) {
    return frame.statistics.measures.contains("blur stands in");
}

bool hasPass(const render::FrameResult& frame, const std::string& name) {
    const auto& passes = frame.statistics.passes;
    return std::any_of(passes.begin(), passes.end(), [&](const render::PassTime& pass) {
        return pass.name == name;
    });
}

class StandIn : public test::GpuTest {
  protected:
    /// `hybrid` on a device of the tier.
    static void checkTier(gpu::RayTier tier) {
        HoldingDevice holding(device().info().name, tier);
        ASSERT_TRUE(holding.device());
        {
            Drawer drawer(*holding.device());
            const LetGoAtEnd atEnd{holding};
            const render::FrameResult waited = drawer.draw("hybrid", UntilReady::Wait);
            EXPECT_FALSE(standsIn(waited));
            EXPECT_TRUE(hasPass(waited, "build TLAS"));
            EXPECT_TRUE(hasPass(waited, "ray reveal"));

            // Now the one for scenes without blended surfaces is made, which is not enough: one may
            // come into sight in any frame.
            const render::FrameResult held = drawer.draw("hybrid", UntilReady::StandIn);
            ASSERT_TRUE(standsIn(held));
            EXPECT_FALSE(hasPass(held, "ray mask"));
            EXPECT_FALSE(hasPass(held, "build TLAS"))
                << "nothing is done for rays that nobody traces";
            const render::FrameResult gathered = drawer.draw("gather", UntilReady::StandIn);
            EXPECT_FALSE(standsIn(gathered)) << "gather has nothing to wait for";
            EXPECT_TRUE(test::sameBits(held.color, gathered.color));

            holding.letGo();
            render::FrameResult ready = drawer.draw("hybrid", UntilReady::StandIn);
            for (int i = 0; i < 1000 && standsIn(ready); ++i)
                ready = drawer.draw("hybrid", UntilReady::StandIn);
            EXPECT_FALSE(standsIn(ready)) << "hybrid never took over";
            EXPECT_TRUE(test::sameBits(ready.color, waited.color));
            EXPECT_FALSE(test::sameBits(ready.color, gathered.color)) << "the scene tells nothing";
        }
        EXPECT_EQ(holding.device()->validationMessageCount(), 0u);
    }
};

TEST_F(StandIn, GatherDrawsUntilBothKindsOfRevealArePreparedByQueries) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << device().info().name << " has no ray queries";
    checkTier(gpu::RayTier::RayQuery);
}

TEST_F(StandIn, GatherDrawsUntilBothKindsOfRevealArePreparedByRayPipelines) {
    if (!device().hasRays())
        GTEST_SKIP() << device().info().name << " traces no rays";
    checkTier(gpu::RayTier::Pipeline);
}

TEST_F(StandIn, WherePipelinesAreMadeWhenFirstUsedNoneStandsIn) {
    if (!device().hasRays())
        GTEST_SKIP() << device().info().name << " traces no rays";
    Drawer drawer(device());
    EXPECT_FALSE(standsIn(drawer.draw("hybrid", UntilReady::StandIn)));
}

} // namespace
} // namespace shutter
