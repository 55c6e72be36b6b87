// SPDX-License-Identifier: MIT
#include "game/bench/sequence_pass.h"

#include "engine/scene/lens.h"
#include "game/bench/measure.h"
#include "game/shot/picture_drawer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using core::Status;

image::Image dropAlpha(const image::Image& from) {
    constexpr uint32_t kColors = 3;
    image::Image picture(from.width, from.height, kColors);
    for (size_t i = 0; i < size_t(from.width) * from.height; ++i)
        for (uint32_t c = 0; c < kColors; ++c)
            picture.pixels[i * kColors + c] = from.pixels[i * from.channels + c];
    return picture;
}

Sample makeSample(const render::FrameStatistics& statistics) {
    Sample sample;
    for (const render::PassTime& pass : statistics.passes)
        sample.passes.push_back({pass.name, pass.gpuMilliseconds, pass.owner});
    sample.wallMilliseconds = statistics.wallMilliseconds;
    return sample;
}

} // namespace

std::string namePart(std::string key) {
    std::replace(key.begin(), key.end(), '/', '.');
    return key;
}

fs::path fileOfFrame(const fs::path& folder, const std::string& key, uint32_t frame) {
    return folder / namePart(key) / fmt::format("frame_{:06}.png", frame);
}

SequencePass::SequencePass(
    gpu::Device& device,
    const SequenceSource& source,
    const SequencePlan& plan,
    const SequenceTruth& truth,
    SequenceCamera camera,
    fs::path folder
)
    : mDevice(device), mSource(source), mPlan(plan), mCamera(camera), mFolder(std::move(folder)),
      mRenderer(device, source.world().assets), mTonemap(device, source.options().picture.tonemap) {
    const SamplePoint most{game::findMethod("accumulate").value(), truth.mostInstants, false};
    mEachFrame.push_back({std::string(kTruthKey), makeMethodOptions(most), Judgement::Whole});
    // The mean over the pixel or the lens takes many instants where nothing moves, too.
    if (source.options().pixel == extract::PixelModel::Centre && !source.hasLens())
        mEachFrame.front().options.maxStepPx = truth.maxStepPx;
    const bool isOwn = camera == SequenceCamera::Own;
    for (const SamplePoint& point : plan.points)
        mEachFrame.push_back(
            {makeKey(point), makeMethodOptions(point), isOwn ? Judgement::Whole : Judgement::InTime}
        );
    if (isOwn)
        for (const SamplePoint& point : plan.sweep)
            mSwept.push_back({makeKey(point), makeMethodOptions(point), Judgement::Squares});
}

core::Result<std::vector<FramePicture>>
SequencePass::drawFrame(uint32_t frame, core::Progress& progress) {
    std::vector<FramePicture> pictures;
    const auto drawAll = [&](std::vector<Drawer>& drawers) -> Status {
        for (Drawer& drawer : drawers) {
            SHUTTER_TRY(draw(drawer, frame, pictures));
            progress.advance();
        }
        return {};
    };
    SHUTTER_TRY(drawAll(mEachFrame));
    if (mPlan.isSwept(frame))
        SHUTTER_TRY(drawAll(mSwept));
    return pictures;
}

core::Result<render::FrameResult> SequencePass::drawOnce(Drawer& drawer, bool wantLinear) {
    const game::ShotOptions& shown = mSource.options();
    game::PictureRequest picture;
    picture.frame.view = mSource.view();
    picture.frame.view.usesLens = drawer.options.method->hasLens &&
                                  scene::hasLens(mSource.world(), picture.frame.view.camera);
    picture.method = drawer.options;
    picture.features = shown.picture.features;
    picture.pixel = shown.pixel;
    picture.seed = shown.seed;
    picture.antiAliasing = shown.picture.antiAliasing;
    picture.frame.wantColor = wantLinear;
    picture.frame.wantDisplay = true;
    picture.ending = {&mTonemap};
    if (drawer.options.maxStepPx) {
        auto instants = drawer.drawer->findInstants(mSource.world(), picture);
        if (!instants)
            return instants.error();
        picture.instants = std::move(instants).value();
    }
    return drawer.drawer->draw(mSource.world(), picture);
}

Status SequencePass::draw(Drawer& drawer, uint32_t frame, std::vector<FramePicture>& pictures) {
    const bool wantLinear =
        SequencePlan::isJudgedLinear(mCamera, frame) && drawer.judgement == Judgement::Whole;
    if (!drawer.drawer) {
        // The first picture compiles shaders, which does not count as the method's time.
        drawer.drawer = std::make_unique<game::PictureDrawer>(mDevice, mRenderer);
        if (auto warm = drawOnce(drawer, wantLinear); !warm)
            return warm.error();
    }
    auto drawn = drawOnce(drawer, wantLinear);
    if (!drawn)
        return drawn.error();
    FramePicture picture;
    picture.key = drawer.key;
    picture.judgement = drawer.judgement;
    picture.shown = dropAlpha(drawn.value().display);
    picture.linear = std::move(drawn.value().color);
    picture.record.samples = {makeSample(drawn.value().statistics)};
    picture.record.hasPicture = true;
    picture.record.picture.counters = drawn.value().statistics.counters;
    if (!mFolder.empty() && drawer.judgement == Judgement::Whole)
        picture.file = fileOfFrame(mFolder, drawer.key, frame);
    pictures.push_back(std::move(picture));
    return {};
}

} // namespace shutter::bench
