// SPDX-License-Identifier: MIT
#include "game/bench/measure.h"

#include "engine/image/flip.h"
#include "engine/image/magma.h"
#include "engine/image/metrics.h"
#include "engine/io/content_hash.h"
#include "engine/io/image_file.h"
#include "game/bench/case_setup.h"
#include "game/method_renderer.h"
#include "game/shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using core::Status;
using game::MethodInfo;

/// Dear pictures are repeated less often: no point takes longer than this many seconds in all.
constexpr double kSecondsAPoint = 8.0;
constexpr uint32_t kCropSidePx = 96;

/// Frames or rays of one picture.
uint64_t stepsOf(const DialPoint& point) {
    switch (point.method->dial) {
    case game::Dial::Instants:
    case game::Dial::Rays:
        return point.samples;
    default:
        return 1;
    }
}

/// One case being measured.
class CaseBench {
  public:
    CaseBench(
        gpu::Device& device,
        const Case& shot,
        const std::vector<DialPoint>& sweep,
        const MeasureOptions& options,
        core::Progress& progress,
        const StopQuestion& stop
    )
        : mDevice(device), mCase(shot), mOptions(options), mProgress(progress), mStop(stop) {
        for (const DialPoint& point : sweep) {
            const bool progressive = point.method->family == game::MethodFamily::Truth;
            (progressive ? mProgressive : mEntries).push_back({point, {}, nullptr, 0.0});
        }
    }

    core::Result<CaseResult> run() {
        if (Status loaded = load(); !loaded)
            return loaded.error();
        if (mOptions.comparePictures)
            if (Status drawn = provideTruth(); !drawn)
                return drawn.error();
        for (Entry& entry : mEntries)
            if (!mStop())
                if (Status drawn = drawFirst(entry); !drawn)
                    return drawn.error();
        if (Status drawn = drawProgressive(); !drawn)
            return drawn.error();
        for (uint32_t round = 0; round < mOptions.repeats; ++round) {
            for (Entry& entry : mEntries)
                if (!mStop())
                    if (Status timed = timeOnce(entry, round); !timed)
                        return timed.error();
            if (Status timed = timeProgressive(round); !timed)
                return timed.error();
        }
        mResult.records = mJournal->records();
        if (mOptions.comparePictures && !mStop())
            if (Status chosen = chooseCrops(); !chosen)
                return chosen.error();
        return std::move(mResult);
    }

  private:
    struct Entry {
        DialPoint point;
        game::RenderOptions options; ///< the renderer keeps a reference
        std::unique_ptr<game::MethodRenderer> renderer;
        double firstSeconds; ///< wall time of the picture drawn first, 0: not drawn
        bool isRefused = false;
    };

    core::Result<game::RenderOptions> makeOptions(const MethodInfo& method, uint32_t samples) {
        game::RenderArguments arguments = mCase.shot;
        arguments.scene = mScene.string();
        arguments.method = method.name;
        arguments.samples = samples;
        arguments.out = "picture.png"; // a display-encoded picture; nothing is written there
        return game::interpret(arguments);
    }

    Status load() {
        auto setup = setUpCase(mCase, mDevice.info(), mOptions.folder);
        if (!setup)
            return setup.error();
        mScene = setup.value().scene;
        mResult.truthHash = io::computeContentHash(
            fmt::format("{} truth {}", setup.value().hash, mOptions.truthSamples)
        );
        mJournal.emplace(mOptions.folder / "journal" / (mCase.name + ".json"), setup.value().hash);
        auto options = makeOptions(*game::findMethod("sharp").value(), 0);
        if (!options)
            return options.error();
        auto loaded = game::loadShot(options.value());
        if (!loaded)
            return loaded.error();
        mShot.emplace(std::move(loaded.value()));
        mRenderer = std::make_unique<render::Renderer>(mDevice, mShot->world.assets);
        return {};
    }

    Status provideTruth() {
        const DialPoint point{game::findMethod("accumulate").value(), mOptions.truthSamples, true};
        const fs::path cached = mOptions.truthCache.empty()
                                    ? fs::path()
                                    : mOptions.truthCache / (mResult.truthHash + ".png");
        mResult.truthImage = fmt::format("images/{}.truth.png", mCase.name);
        std::error_code missing;
        if (!cached.empty() && fs::exists(cached, missing)) {
            mProgress.advance(stepsOf(point));
            auto read = io::readImage(cached);
            if (!read)
                return read.error();
            mTruth = std::move(read.value());
            return io::writeImage(mOptions.folder / mResult.truthImage, mTruth);
        }
        Entry entry{point, {}, nullptr, 0.0};
        auto drawn = draw(entry);
        if (!drawn)
            return drawn.error();
        const fs::path file = mOptions.folder / mResult.truthImage;
        if (Status written = io::writeImage(file, drawn.value().display); !written)
            return written;
        // What is compared is what the file holds: 8 bits a channel.
        auto read = io::readImage(file);
        if (!read)
            return read.error();
        mTruth = std::move(read.value());
        return cached.empty() ? Status() : io::writeImage(cached, mTruth);
    }

    core::Result<render::FrameResult>
    draw(Entry& entry, const game::Checkpoints& checkpoints = {}) {
        if (!entry.renderer) {
            auto options = makeOptions(*entry.point.method, entry.point.samples);
            if (!options)
                return options.error();
            entry.options = std::move(options.value());
            auto created = game::MethodRenderer::create(mDevice, *mRenderer, *mShot, entry.options);
            if (!created)
                return created.error();
            entry.renderer = std::move(created.value());
        }
        return entry.renderer->renderPicture(
            entry.options.frameTimes.front(), [&] { mProgress.advance(); }, checkpoints
        );
    }

    /// Why an entry is not drawn; empty where it is.
    std::string refuse(const Entry& entry) const {
        if (entry.point.method->needsRays && !mDevice.hasRays())
            return "the device traces no rays";
        // A picture's time grows with frames and rays: known from the dial before.
        double perStep = 0.0;
        for (const Entry& other : mEntries)
            if (other.point.method == entry.point.method && other.firstSeconds > 0.0)
                perStep = other.firstSeconds / double(stepsOf(other.point));
        const double predicted = perStep * double(stepsOf(entry.point));
        return predicted > mOptions.limitSeconds ? describeLimit(predicted) : std::string();
    }

    std::string describeLimit(double predicted) const {
        return fmt::format(
            "predicted {:.0f} s, above the limit of {:.0f} s", predicted, mOptions.limitSeconds
        );
    }

    /// Warms the driver up, compares the picture, learns what it costs.
    Status drawFirst(Entry& entry) {
        const std::string key = makeKey(entry.point);
        const Record& known = mJournal->find(key);
        const std::string refused = refuse(entry);
        if (!refused.empty()) {
            entry.isRefused = true;
            mProgress.advance(stepsOf(entry.point) * (mOptions.repeats + 1));
            return mJournal->skip(key, refused);
        }
        if (known.samples.size() >= mOptions.repeats && (known.hasPicture || mTruth.width == 0)) {
            mProgress.advance(stepsOf(entry.point) * (mOptions.repeats + 1));
            entry.firstSeconds = known.samples.front().wallMilliseconds / 1e3;
            return {};
        }
        auto drawn = draw(entry);
        if (!drawn)
            return drawn.error();
        const render::FrameResult& result = drawn.value();
        entry.firstSeconds = result.statistics.wallMilliseconds / 1e3;
        if (mTruth.width > 0 && !known.hasPicture)
            if (Status kept = keepPicture(entry, result); !kept)
                return kept;
        // The first picture of a dear dial is timed too: warming up is no part of its seconds.
        if (entry.firstSeconds > kSecondsAPoint / 2 && known.samples.empty())
            return keepSample(entry, result);
        return {};
    }

    Status keepPicture(const Entry& entry, const render::FrameResult& result) {
        const std::string key = makeKey(entry.point);
        PictureFacts facts;
        facts.image = pictureFile(mCase.name, entry.point.method->name, entry.point.samples);
        facts.errorMap = fs::path(facts.image).replace_extension(".flip.png").string();
        const fs::path file = mOptions.folder / facts.image;
        if (Status written = io::writeImage(file, result.display); !written)
            return written;
        auto picture = io::readImage(file);
        if (!picture)
            return picture.error();
        const image::FlipResult flip = image::computeFlip(picture.value(), mTruth);
        facts.metrics = {
            {"psnr", image::computePsnr(picture.value(), mTruth)},
            {"ssim", image::computeSsim(picture.value(), mTruth)},
            {"flip", flip.mean}};
        if (Status written = io::writeImage(
                mOptions.folder / facts.errorMap, image::colorWithMagma(flip.errorMap)
            );
            !written)
            return written;
        facts.counters = result.statistics.counters;
        return mJournal->setPicture(key, std::move(facts));
    }

    Status keepSample(const Entry& entry, const render::FrameResult& result) {
        Sample sample;
        for (const gpu::PassTime& pass : result.statistics.passes)
            sample.passes.push_back({pass.name, pass.gpuMilliseconds});
        sample.wallMilliseconds = result.statistics.wallMilliseconds;
        return mJournal->addSample(makeKey(entry.point), std::move(sample));
    }

    Status timeOnce(Entry& entry, uint32_t round) {
        const Record& known = mJournal->find(makeKey(entry.point));
        if (entry.isRefused || known.samples.size() > round)
            return {};
        const double affordable = kSecondsAPoint / std::max(entry.firstSeconds, 1e-3);
        if (round > 0 && double(round) >= affordable) {
            mProgress.advance(stepsOf(entry.point));
            return {};
        }
        auto drawn = draw(entry);
        if (!drawn)
            return drawn.error();
        return keepSample(entry, drawn.value());
    }

    /// One run of a progressive method to the dial of `last`; what it is at the dials before it is
    /// measured on the way.
    Status runProgressive(Entry& last) {
        Status kept;
        game::Checkpoints checkpoints;
        for (const Entry& entry : mProgressive)
            if (entry.point.samples <= last.point.samples)
                checkpoints.rays.push_back(entry.point.samples);
        checkpoints.onPicture = [&](uint32_t rays, const render::FrameResult& picture) {
            const auto entry =
                std::find_if(mProgressive.begin(), mProgressive.end(), [&](const Entry& candidate) {
                    return candidate.point.samples == rays;
                });
            if (kept && mTruth.width > 0 && !mJournal->find(makeKey(entry->point)).hasPicture)
                kept = keepPicture(*entry, picture);
            if (kept)
                kept = keepSample(*entry, picture);
        };
        auto drawn = draw(last, checkpoints);
        if (!drawn)
            return drawn.error();
        return kept;
    }

    /// The last dial whose picture takes at most so many seconds; null where none does.
    Entry* findLastWithin(double seconds) {
        Entry* last = nullptr;
        for (Entry& entry : mProgressive)
            if (entry.firstSeconds <= seconds)
                last = &entry;
        return last;
    }

    Status drawProgressive() {
        if (mProgressive.empty() || mStop())
            return {};
        if (!mDevice.hasRays()) {
            for (const Entry& entry : mProgressive)
                if (Status kept = mJournal->skip(makeKey(entry.point), "the device traces no rays");
                    !kept)
                    return kept;
            return {};
        }
        // The first run warms up, the second tells what a ray costs.
        Entry& first = mProgressive.front();
        auto warm = draw(first);
        auto drawn = warm ? draw(first) : std::move(warm);
        if (!drawn)
            return drawn.error();
        const double seconds =
            drawn.value().statistics.wallMilliseconds / 1e3 / first.point.samples;
        for (Entry& entry : mProgressive)
            entry.firstSeconds = seconds * entry.point.samples;
        Entry* last = findLastWithin(mOptions.limitSeconds);
        for (Entry& entry : mProgressive)
            if (last == nullptr || entry.point.samples > last->point.samples) {
                Status kept =
                    mJournal->skip(makeKey(entry.point), describeLimit(entry.firstSeconds));
                if (!kept)
                    return kept;
            }
        const bool isKnown =
            last == nullptr || !mJournal->find(makeKey(last->point)).samples.empty();
        return isKnown || mStop() ? Status() : runProgressive(*last);
    }

    /// The dear end of the dial is timed once, by the run that made its pictures.
    Status timeProgressive(uint32_t round) {
        if (round == 0 || mProgressive.empty() || mStop() || !mDevice.hasRays())
            return {};
        Entry* last = findLastWithin(kSecondsAPoint / mOptions.repeats);
        if (last == nullptr || mJournal->find(makeKey(last->point)).samples.size() > round)
            return {};
        return runProgressive(*last);
    }

    /// Where rays change the picture most, and where motion blur does.
    Status chooseCrops() {
        struct Question {
            const char* a;
            const char* b;
            const char* label;
        };

        const auto read = [&](const char* method) -> core::Result<image::Image> {
            for (const Entry& entry : mEntries)
                if (entry.point.isDefault && entry.point.method->name == std::string_view(method)) {
                    const Record& record = mJournal->find(makeKey(entry.point));
                    if (record.hasPicture)
                        return io::readImage(mOptions.folder / record.picture.image);
                }
            return image::Image();
        };
        for (const Question& question :
             {Question{"gather", "hybrid", "where rays change the picture most"},
              Question{"gather", "hybrid", "where rays change it second most"},
              Question{"sharp", "", "where the shutter changes it most"}}) {
            auto a = read(question.a);
            auto b = *question.b ? read(question.b) : core::Result<image::Image>(mTruth);
            if (!a || !b)
                return !a ? a.error() : b.error();
            if (a.value().width != b.value().width || a.value().width == 0)
                continue;
            for (Crop& crop : findLargestDifference(
                     a.value(), b.value(), kCropSidePx, question.label, mResult.crops
                 ))
                mResult.crops.push_back(std::move(crop));
        }
        return {};
    }

    gpu::Device& mDevice;
    const Case& mCase;
    const MeasureOptions& mOptions;
    core::Progress& mProgress;
    const StopQuestion& mStop;
    fs::path mScene;
    std::optional<Journal> mJournal;
    std::optional<game::Shot> mShot;
    std::unique_ptr<render::Renderer> mRenderer;
    std::vector<Entry> mEntries;     ///< after the renderer: gone before it is
    std::vector<Entry> mProgressive; ///< dials of methods that pass them on the way to the last
    image::Image mTruth;             ///< empty where pictures are not compared
    CaseResult mResult;
};

} // namespace

uint64_t countSteps(const std::vector<DialPoint>& sweep, const MeasureOptions& options) {
    uint64_t steps = options.comparePictures ? options.truthSamples : 0;
    for (const DialPoint& point : sweep)
        steps += stepsOf(point) * (options.repeats + 1);
    return steps;
}

std::string pictureFile(const std::string& caseName, const std::string& method, uint32_t samples) {
    return fmt::format("images/{}.{}.{}.png", caseName, method, samples);
}

std::string makeKey(const DialPoint& point) {
    return fmt::format("{}/{}", point.method->name, point.samples);
}

core::Result<CaseResult> measureCase(
    gpu::Device& device,
    const Case& shot,
    const std::vector<DialPoint>& sweep,
    const MeasureOptions& options,
    core::Progress& progress,
    const StopQuestion& stop
) {
    return CaseBench(device, shot, sweep, options, progress, stop).run();
}

} // namespace shutter::bench
