// SPDX-License-Identifier: MIT
#include "game/bench/case_stage.h"

#include "engine/gltf/gltf_loader.h"
#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "game/bench/truth_cache.h"
#include "game/options/render_arguments.h"
#include "game/shot/surroundings.h"

#include <fmt/format.h>

#include <utility>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;

core::Result<fs::path> writeScene(const Case& shot, const fs::path& folder) {
    if (!shot.writeScene)
        return fs::path(shot.shot.scene);
    const fs::path file = folder / "scenes" / (shot.name + ".glb");
    SHUTTER_TRY(shot.writeScene(file));
    return file;
}

namespace fs = std::filesystem;
using core::Status;

constexpr uint32_t kCropSidePx = 96;

} // namespace

core::Result<CaseSetup>
setUpCase(const Case& shot, const gpu::DeviceInfo& device, const fs::path& folder) {
    auto scene = writeScene(shot, folder);
    if (!scene)
        return scene.error();
    const io::Reach reach = shot.shot.allowOutside ? io::Reach::Anywhere : io::Reach::Folder;
    auto sceneHash = gltf::computeSceneHash(scene.value(), reach);
    if (!sceneHash)
        return sceneHash.error();
    auto program = io::computeFileHash("/proc/self/exe");
    if (!program)
        return program.error();
    auto surroundings = game::computeSurroundingsHash(shot.shot.environment);
    if (!surroundings)
        return surroundings.error();
    const std::string facts = fmt::format(
        "scene {} surroundings {} program {} device {} {} {}",
        sceneHash.value(),
        surroundings.value(),
        program.value(),
        device.name,
        device.driver,
        game::describe(shot.shot)
    );
    return CaseSetup{scene.value(), io::computeContentHash(facts)};
}

core::Result<std::unique_ptr<CaseStage>> CaseStage::create(
    gpu::Device& device, const Case& shot, const MeasureOptions& options, core::Progress& progress
) {
    auto setup = setUpCase(shot, device.info(), options.folder);
    if (!setup)
        return setup.error();
    std::unique_ptr<CaseStage> stage(
        new CaseStage(device, shot, options, progress, setup.value().scene, setup.value().hash)
    );
    SHUTTER_TRY(stage->load());
    return stage;
}

CaseStage::CaseStage(
    gpu::Device& device,
    const Case& shot,
    const MeasureOptions& options,
    core::Progress& progress,
    fs::path scene,
    const std::string& hash
)
    : mDevice(device), mCase(shot), mOptions(options), mProgress(progress),
      mScene(std::move(scene)),
      mTruthHash(io::computeContentHash(fmt::format("{} truth {}", hash, options.truthSamples))),
      mJournal(options.folder / "journal" / (shot.name + ".json"), hash) {}

Status CaseStage::load() {
    game::ShotArguments arguments = mCase.shot;
    arguments.scene = mScene.string();
    auto options = game::interpret(arguments);
    if (!options)
        return options.error();
    mShotOptions = std::move(options).value();
    auto loaded = game::loadShot(mShotOptions);
    if (!loaded)
        return loaded.error();
    mShot = std::move(loaded.value());
    mRenderer = std::make_unique<render::Renderer>(mDevice, mShot.world.assets);
    mTonemap.emplace(mDevice, mShotOptions.tonemap);
    return {};
}

Status CaseStage::provideTruth() {
    mTruthImage = fmt::format("images/{}.truth.png", mCase.name);
    const fs::path file = mOptions.folder / mTruthImage;
    const fs::path cached =
        mOptions.truthCache.empty() ? fs::path() : mOptions.truthCache / (mTruthHash + ".png");
    if (auto kept = readCachedTruth(cached, mShotOptions.width, mShotOptions.height)) {
        mProgress.advance(mOptions.truthSamples);
        mTruth = std::move(*kept);
        return io::writeImage(file, mTruth);
    }
    SHUTTER_TRY(drawTruth(file));
    // What is compared is what the file holds: 8 bits a channel.
    auto read = io::readImage(file);
    if (!read)
        return read.error();
    mTruth = std::move(read.value());
    return cached.empty() ? Status() : io::writeImage(cached, mTruth);
}

Status CaseStage::drawTruth(const fs::path& file) {
    DrawnPoint truth{{game::findMethod("accumulate").value(), mOptions.truthSamples, true}};
    auto drawn = draw(truth);
    return drawn ? io::writeImage(file, drawn.value().display) : Status(drawn.error());
}

core::Result<render::FrameResult>
CaseStage::draw(DrawnPoint& drawn, const game::Checkpoints& checkpoints) {
    SHUTTER_TRY(game::checkPixel(mShotOptions, *drawn.point.method));
    if (!drawn.drawer)
        drawn.drawer = std::make_unique<game::PictureDrawer>(mDevice, *mRenderer);
    game::PictureRequest picture = game::makePicture(
        mShot, mShotOptions, makeMethodOptions(drawn.point), mShotOptions.frameTimes.front()
    );
    picture.frame.wantColor = false;
    picture.frame.wantDisplay = true;
    picture.ending = {&*mTonemap};
    return drawn.drawer->draw(
        mShot.world, picture, [&] { mProgress.advance(); }, checkpoints
    );
}

bool CaseStage::isKnown(const SamplePoint& point, uint32_t repeats) const {
    const Record& record = mJournal.find(makeKey(point));
    return record.samples.size() >= repeats && (record.hasPicture || mTruth.width == 0);
}

Status CaseStage::keepPicture(const SamplePoint& point, const render::FrameResult& drawn) {
    const std::string key = makeKey(point);
    if (mTruth.width == 0 || mJournal.find(key).hasPicture)
        return {};
    PictureFacts facts;
    facts.image = pictureFile(mCase.name, point.method->name, point.samples);
    facts.errorMap = fs::path(facts.image).replace_extension(".flip.png").string();
    const fs::path file = mOptions.folder / facts.image;
    SHUTTER_TRY(io::writeImage(file, drawn.display));
    auto picture = io::readImage(file);
    if (!picture)
        return picture.error();
    const image::FlipResult flip = image::computeFlip(picture.value(), mTruth);
    facts.metrics = {
        {"psnr", image::computePsnr(picture.value(), mTruth)},
        {"ssim", image::computeSsim(picture.value(), mTruth)},
        {"flip", flip.mean}};
    const fs::path map = mOptions.folder / facts.errorMap;
    SHUTTER_TRY(io::writeImage(map, image::colorWithMagma(flip.errorMap)));
    facts.counters = drawn.statistics.counters;
    return mJournal.setPicture(key, std::move(facts));
}

Status CaseStage::keepSample(const SamplePoint& point, const render::FrameResult& drawn) {
    Sample sample;
    for (const render::PassTime& pass : drawn.statistics.passes)
        sample.passes.push_back({pass.name, pass.gpuMilliseconds, pass.owner});
    sample.wallMilliseconds = drawn.statistics.wallMilliseconds;
    return mJournal.addSample(makeKey(point), std::move(sample));
}

/// The picture of a method at its default; one without pixels where it was not measured.
core::Result<image::Image> CaseStage::readDefault(std::string_view method) const {
    const game::MethodInfo& info = *game::findMethod(method).value();
    const Record& record = mJournal.find(makeKey({&info, info.defaultSamples, true}));
    return record.hasPicture ? io::readImage(mOptions.folder / record.picture.image)
                             : core::Result<image::Image>(image::Image());
}

core::Result<std::vector<Crop>> CaseStage::chooseCrops() const {
    auto gather = readDefault("gather");
    auto resolved = readDefault("resolved");
    auto sharp = readDefault("sharp");
    for (const auto* picture : {&gather, &resolved, &sharp})
        if (!*picture)
            return picture->error();
    std::vector<Crop> crops;
    const auto add = [&](const image::Image& a, const image::Image& b, const char* label) {
        if (a.width != b.width || a.height != b.height || a.width == 0)
            return;
        for (Crop& crop : findLargestDifference(a, b, kCropSidePx, label, crops))
            crops.push_back(std::move(crop));
    };
    add(gather.value(), resolved.value(), "where resolved and gather differ most");
    add(gather.value(), resolved.value(), "where they differ second most");
    add(sharp.value(), mTruth, "where the shutter changes it most");
    return crops;
}

} // namespace shutter::bench
