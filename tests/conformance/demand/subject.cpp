// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/subject.h"

#include "assets/generator/scaling_scenes.h"
#include "game/options/method_arguments.h"
#include "tests/kit/process_use.h"

namespace shutter::demand {

namespace {

constexpr uint32_t kUncounted = 2; ///< first pictures of a subject

core::Result<game::ShotOptions> makeShot(const Stage& stage, uint32_t width, uint32_t height) {
    game::ShotArguments arguments = stage.arguments;
    arguments.size = {width, height};
    return game::interpret(arguments);
}

} // namespace

core::Result<std::unique_ptr<Stage>> loadStage(
    const DemandOptions& options,
    const std::string& name,
    const std::function<generator::GltfWriter()>& build,
    game::ShotArguments arguments
) {
    const std::filesystem::path file = options.folder / (name + ".glb");
    if (const std::string error = build().write(file); !error.empty())
        return core::Error{error};
    auto stage = std::make_unique<Stage>();
    stage->arguments = std::move(arguments);
    stage->arguments.scene = file.string();
    auto loading = makeShot(*stage, options.width, options.height);
    if (!loading)
        return loading.error();
    auto shot = game::loadShot(loading.value());
    if (!shot)
        return shot.error();
    stage->shot = std::move(shot).value();
    return stage;
}

core::Result<std::unique_ptr<Stage>> loadScalingStage(
    const DemandOptions& options,
    const std::string& name,
    const std::function<generator::GltfWriter()>& build
) {
    game::ShotArguments arguments;
    arguments.camera = generator::kScalingCamera;
    arguments.time = generator::kScalingSeconds;
    arguments.shutter =
        game::makeShutterArguments(generator::kScalingExposureSeconds, generator::kScalingPhase);
    return loadStage(options, name, build, std::move(arguments));
}

std::unique_ptr<Stage> makeStage(test::SceneBuilder scene, double exposureSeconds) {
    auto stage = std::make_unique<Stage>();
    stage->arguments.scene = "a scene made in code";
    stage->shot = {std::move(scene.world), scene.camera};
    stage->shot.world.registry.add(
        stage->shot.camera, scene::CameraShutter{exposureSeconds, scene::ShutterPhase::End}
    );
    return stage;
}

core::Result<std::unique_ptr<Subject>> Subject::create(
    gpu::Device& device,
    const Stage& stage,
    std::string_view method,
    uint32_t width,
    uint32_t height
) {
    auto shot = makeShot(stage, width, height);
    if (!shot)
        return shot.error();
    auto options = game::interpret(game::MethodArguments{.method = std::string(method)});
    if (!options)
        return options.error();
    SHUTTER_TRY(game::PictureDrawer::check(device, options.value(), width, height));
    return std::unique_ptr<Subject>(
        new Subject(device, stage, std::move(shot).value(), std::move(options).value())
    );
}

Subject::Subject(
    gpu::Device& device, const Stage& stage, game::ShotOptions shot, game::MethodOptions method
)
    : mStage(stage), mShot(std::move(shot)), mMethod(method),
      mRenderer(device, stage.shot.world.assets), mTonemap(device, mShot.picture.tonemap),
      mDrawer(device, mRenderer), mSeconds(mShot.frameTimes.front()) {}

core::Result<std::unique_ptr<Subject>> Subject::createWithEffect(
    gpu::Device& device,
    const Stage& stage,
    std::unique_ptr<render::PostEffect> effect,
    uint32_t width,
    uint32_t height
) {
    auto subject = create(device, stage, "sharp", width, height);
    if (subject)
        subject.value()->mEffect = std::move(effect);
    return subject;
}

core::Result<render::FrameResult> Subject::draw() {
    game::PictureRequest picture = game::makePicture(mStage.shot, mShot, mMethod, mSeconds);
    picture.frame.wantColor = false;
    picture.frame.wantDisplay = true;
    picture.frame.wantDump = mWantsDump;
    picture.frame.intermediates = mIntermediates;
    if (mEffect) {
        picture.ending.push_back(mEffect.get());
        picture.frame.wantBrightest = true; // it may ask for what the last picture showed
    }
    picture.ending.push_back(&mTonemap);
    mSeconds += mStepSeconds;
    return mDrawer.draw(mStage.shot.world, picture);
}

core::Result<std::vector<Frames>> takeTurns(const Subjects& subjects, uint32_t rounds) {
    std::vector<Frames> frames(subjects.size());
    for (uint32_t round = 0; round < kUncounted + rounds; ++round)
        for (size_t i = 0; i < subjects.size(); ++i) {
            const size_t at = round % 2 == 0 ? i : subjects.size() - 1 - i;
            const double before = test::countProcessorMilliseconds();
            auto drawn = subjects[at]->draw();
            const double spent = test::countProcessorMilliseconds() - before;
            if (!drawn)
                return drawn.error();
            if (round < kUncounted)
                continue;
            frames[at].push_back(std::move(drawn.value().statistics));
            frames[at].back().measures[kProcessMilliseconds] = spent;
        }
    return frames;
}

} // namespace shutter::demand
