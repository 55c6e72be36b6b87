// SPDX-License-Identifier: MIT
#include "game/bench/case_stage.h"

#include "engine/core/check.h"
#include "engine/gltf/gltf_loader.h"
#include "engine/image/flip.h"
#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "game/options/render_arguments.h"
#include "game/shot/surroundings.h"

#include <fmt/format.h>

#include <utility>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using core::Status;

core::Result<fs::path> writeScene(const Case& shot, const fs::path& folder) {
    if (!shot.writeScene)
        return fs::path(shot.shot.scene);
    const fs::path file = folder / "scenes" / (shot.name + ".glb");
    SHUTTER_TRY(shot.writeScene(file));
    return file;
}

constexpr uint32_t kCropSidePx = 96;

/// Packs the picture for the report's inspector: channels R, G and B of a linear picture and,
/// unless it has no pixels, the error map as the channel `flip`.
/// \param color three channels or more
/// \param errorMap one channel, as large as `color`, or without pixels
image::Image packLinearPicture(const image::Image& color, const image::Image& errorMap = {}) {
    constexpr uint32_t kColors = 3;
    const bool hasErrors = errorMap.width > 0;
    SHUTTER_CHECK(color.channels >= kColors, "{} channels", color.channels);
    SHUTTER_CHECK(
        !hasErrors || (errorMap.width == color.width && errorMap.height == color.height),
        "an error map of {}x{} for a picture of {}x{}",
        errorMap.width,
        errorMap.height,
        color.width,
        color.height
    );
    image::Image packed(color.width, color.height, hasErrors ? kColors + 1 : kColors);
    packed.channelNames = {"R", "G", "B"};
    if (hasErrors)
        packed.channelNames.emplace_back("flip");
    for (uint32_t y = 0; y < color.height; ++y)
        for (uint32_t x = 0; x < color.width; ++x) {
            for (uint32_t c = 0; c < kColors; ++c)
                packed.at(x, y, c) = color.at(x, y, c);
            if (hasErrors)
                packed.at(x, y, kColors) = errorMap.at(x, y, 0);
        }
    return packed;
}

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
    const auto hash = [&](const game::ShotArguments& arguments) {
        return io::computeContentHash(fmt::format(
            "scene {} surroundings {} program {} device {} {} {}",
            sceneHash.value(),
            surroundings.value(),
            program.value(),
            device.name,
            device.driver,
            game::describe(arguments)
        ));
    };
    game::ShotArguments ofTruth = shot.shot;
    ofTruth.picture.antiAliasing = game::AntiAliasing::None;
    return CaseSetup{scene.value(), hash(shot.shot), hash(ofTruth)};
}

core::Result<std::unique_ptr<CaseStage>> CaseStage::create(
    gpu::Device& device, const Case& shot, const MeasureOptions& options, core::Progress& progress
) {
    auto setup = setUpCase(shot, device.info(), options.folder);
    if (!setup)
        return setup.error();
    std::unique_ptr<CaseStage> stage(new CaseStage(device, shot, options, progress, setup.value()));
    SHUTTER_TRY(stage->load());
    return stage;
}

CaseStage::CaseStage(
    gpu::Device& device,
    const Case& shot,
    const MeasureOptions& options,
    core::Progress& progress,
    const CaseSetup& setup
)
    : mDevice(device), mCase(shot), mOptions(options), mProgress(progress), mScene(setup.scene),
      mTruthHash(
          io::computeContentHash(fmt::format("{} truth {}", setup.truthHash, options.truthSamples))
      ),
      mJournal(options.folder / "journal" / (shot.name + ".json"), setup.hash) {}

Status CaseStage::load() {
    game::ShotArguments arguments = mCase.shot;
    arguments.scene = mScene.string();
    auto options = game::interpret(arguments);
    if (!options)
        return options.error();
    mShotOptions = std::move(options).value();
    mShotOptions.usesLens = true;
    auto loaded = game::loadShot(mShotOptions);
    if (!loaded)
        return loaded.error();
    mShot = std::move(loaded.value());
    mRenderer = std::make_unique<render::Renderer>(mDevice, mShot.world.assets);
    mTonemap.emplace(mDevice, mShotOptions.picture.tonemap);
    return {};
}

Status CaseStage::provideTruth() {
    const std::string name = fmt::format("{}.truth", mCase.name);
    const TruthFiles files = nameTruthFiles(mOptions.folder / "images", name);
    const TruthFiles cached = nameTruthFiles(mOptions.truthCache, mTruthHash);
    mTruthImage = fmt::format("images/{}.png", name);
    mTruthLinear = fmt::format("images/{}.exr", name);
    if (auto kept = readCachedTruth(cached, mShotOptions.width, mShotOptions.height)) {
        mProgress.advance(mOptions.truthSamples);
        SHUTTER_TRY(writeTruth(files, *kept));
        mTruth = std::move(*kept);
        return {};
    }
    auto drawn = drawTruth();
    if (!drawn)
        return drawn.error();
    SHUTTER_TRY(writeTruth(files, drawn.value()));
    if (!cached.display.empty())
        SHUTTER_TRY(writeTruth(cached, drawn.value()));
    // Compare as stored in the files: 8 bits per channel, and half floats.
    auto read = readCachedTruth(files, mShotOptions.width, mShotOptions.height);
    if (!read)
        return core::makeError("'{}' cannot be read again", files.display.string());
    mTruth = std::move(*read);
    return {};
}

core::Result<TruthPictures> CaseStage::drawTruth() {
    DrawnPoint truth{{game::findMethod("accumulate").value(), mOptions.truthSamples, true}};
    auto drawn = drawPicture(truth, {}, true);
    if (!drawn)
        return drawn.error();
    return TruthPictures{std::move(drawn.value().display), packLinearPicture(drawn.value().color)};
}

core::Result<render::FrameResult>
CaseStage::draw(DrawnPoint& drawn, const game::Checkpoints& checkpoints) {
    // Reading the linear picture back takes time, and it is compared once.
    const bool isKept = mJournal.find(makeKey(drawn.point)).hasPicture;
    const bool wantsLinear = !checkpoints.rays.empty() || !isKept;
    return drawPicture(drawn, checkpoints, wantsLinear && mOptions.comparePictures);
}

core::Result<render::FrameResult>
CaseStage::drawPicture(DrawnPoint& drawn, const game::Checkpoints& checkpoints, bool wantsLinear) {
    if (!drawn.drawer)
        drawn.drawer = std::make_unique<game::PictureDrawer>(mDevice, *mRenderer);
    game::PictureRequest picture = game::makePicture(
        mShot, mShotOptions, makeMethodOptions(drawn.point), mShotOptions.frameTimes.front()
    );
    const extract::ViewRequest& view = picture.frame.view;
    scene::replayAutoFocus(mShot.world, view.camera, view.exposure);
    picture.frame.wantColor = wantsLinear;
    picture.frame.wantDisplay = true;
    picture.ending = {&*mTonemap};
    return drawn.drawer->draw(
        mShot.world, picture, [&] { mProgress.advance(); }, checkpoints
    );
}

bool CaseStage::hasLens() const {
    return scene::hasLens(mShot.world, mShot.camera);
}

bool CaseStage::isKnown(const SamplePoint& point, uint32_t repeats) const {
    const Record& record = mJournal.find(makeKey(point));
    return record.samples.size() >= repeats && (record.hasPicture || mTruth.display.width == 0);
}

Status CaseStage::keepPicture(const SamplePoint& point, const render::FrameResult& drawn) {
    const std::string key = makeKey(point);
    if (mTruth.display.width == 0 || mJournal.find(key).hasPicture)
        return {};
    PictureFacts facts;
    facts.image = pictureFile(mCase.name, point.method->name, point.samples);
    facts.errorMap = fs::path(facts.image).replace_extension(".flip.png").string();
    const fs::path file = mOptions.folder / facts.image;
    SHUTTER_TRY(io::writeImage(file, drawn.display));
    auto picture = io::readImage(file);
    if (!picture)
        return picture.error();
    const image::FlipResult flip = image::computeFlip(picture.value(), mTruth.display);
    facts.metrics = {
        {"psnr", image::computePsnr(picture.value(), mTruth.display)},
        {"linearPsnr", image::computePsnr(packLinearPicture(drawn.color), mTruth.linear)},
        {"ssim", image::computeSsim(picture.value(), mTruth.display)},
        {"flip", flip.mean}};
    const fs::path map = mOptions.folder / facts.errorMap;
    SHUTTER_TRY(io::writeImage(map, image::colorWithMagma(flip.errorMap)));
    if (point.isDefault) {
        facts.linear = fs::path(facts.image).replace_extension(".exr").string();
        SHUTTER_TRY(io::writeImage(
            mOptions.folder / facts.linear,
            packLinearPicture(drawn.color, flip.errorMap),
            io::SampleType::Half
        ));
    }
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
    add(sharp.value(), mTruth.display, "where the shutter changes it most");
    return crops;
}

} // namespace shutter::bench
