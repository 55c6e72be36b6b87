// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/subject.h"

#include "assets/generator/scaling_scenes.h"

#include <array>
#include <ctime>

namespace shutter::demand {

namespace {

constexpr uint32_t kUncounted = 2; ///< first pictures of a subject

double countProcessMilliseconds() {
    return 1e3 * double(std::clock()) / CLOCKS_PER_SEC;
}

core::Result<game::RenderOptions> makeOptions(
    const Stage& stage,
    std::string_view method,
    uint32_t width,
    uint32_t height,
    std::vector<std::string> settings = {}
) {
    game::RenderArguments arguments = stage.arguments;
    arguments.method = method;
    arguments.settings = std::move(settings);
    arguments.size = fmt::format("{}x{}", width, height);
    arguments.out = "picture.png"; // a display-encoded picture; nothing is written there
    return game::interpret(arguments);
}

} // namespace

core::Result<std::unique_ptr<Stage>> loadStage(
    const DemandOptions& options,
    const std::string& name,
    const std::function<generator::GltfWriter()>& build,
    game::RenderArguments arguments
) {
    const std::filesystem::path file = options.folder / (name + ".glb");
    if (const std::string error = build().write(file); !error.empty())
        return core::Error{error};
    auto stage = std::make_unique<Stage>();
    stage->arguments = std::move(arguments);
    stage->arguments.scene = file.string();
    auto loading = makeOptions(*stage, "sharp", options.width, options.height);
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
    game::RenderArguments arguments;
    arguments.camera = generator::kScalingCamera;
    arguments.time = generator::kScalingSeconds;
    arguments.exposureSeconds = generator::kScalingExposureSeconds;
    arguments.phase = generator::kScalingPhase;
    return loadStage(options, name, build, std::move(arguments));
}

std::unique_ptr<Stage> makeStage(stability::SceneDraft& draft, double exposureSeconds) {
    auto stage = std::make_unique<Stage>();
    stage->arguments.scene = "a scene made in code";
    stage->shot = std::move(draft.shot);
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
    uint32_t height,
    std::vector<std::string> settings
) {
    auto options = makeOptions(stage, method, width, height, std::move(settings));
    if (!options)
        return options.error();
    std::unique_ptr<Subject> subject(new Subject(device, stage, std::move(options).value()));
    auto made =
        game::MethodRenderer::create(device, subject->mRenderer, stage.shot, subject->mOptions);
    if (!made)
        return made.error();
    subject->mMethod = std::move(made).value();
    return subject;
}

Subject::Subject(gpu::Device& device, const Stage& stage, game::RenderOptions options)
    : mStage(stage), mOptions(std::move(options)), mRenderer(device, stage.shot.world.assets),
      mSeconds(mOptions.frameTimes.front()) {}

core::Result<std::unique_ptr<Subject>> Subject::createWithEffect(
    gpu::Device& device,
    const Stage& stage,
    std::unique_ptr<render::PostEffect> effect,
    uint32_t width,
    uint32_t height
) {
    auto options = makeOptions(stage, "sharp", width, height);
    if (!options)
        return options.error();
    std::unique_ptr<Subject> subject(new Subject(device, stage, std::move(options).value()));
    subject->mEffect = std::move(effect);
    subject->mTonemap = std::make_unique<tonemap::Tonemap>(device, subject->mOptions.tonemap);
    return subject;
}

core::Result<render::FrameResult> Subject::drawEffect() {
    render::FrameRequest request;
    request.view = game::makeView(mStage.shot, mOptions, mSeconds);
    request.wantColor = false;
    request.wantDisplay = true;
    const std::array<render::PostEffect*, 2> effects{mEffect.get(), mTonemap.get()};
    return mRenderer.renderFrame(mStage.shot.world, request, effects);
}

core::Result<render::FrameResult> Subject::draw() {
    auto drawn = mEffect ? drawEffect() : mMethod->renderPicture(mSeconds, [] {});
    mSeconds += mStepSeconds;
    return drawn;
}

core::Result<std::vector<Frames>> takeTurns(const Subjects& subjects, uint32_t rounds) {
    std::vector<Frames> frames(subjects.size());
    for (uint32_t round = 0; round < kUncounted + rounds; ++round)
        for (size_t i = 0; i < subjects.size(); ++i) {
            const size_t at = round % 2 == 0 ? i : subjects.size() - 1 - i;
            const double before = countProcessMilliseconds();
            auto drawn = subjects[at]->draw();
            const double spent = countProcessMilliseconds() - before;
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
