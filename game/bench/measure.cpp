// SPDX-License-Identifier: MIT
#include "game/bench/measure.h"

#include "game/bench/case_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

namespace shutter::bench {

namespace {

using core::Status;

/// Dear pictures are repeated less often: no point takes longer than this many seconds in all.
constexpr double kSecondsAPoint = 8.0;

/// Frames or rays of one picture.
uint64_t stepsOf(const SamplePoint& point) {
    const game::MethodFamily family = point.method->family;
    const bool drawsOneFrame =
        family == game::MethodFamily::Sharp || family == game::MethodFamily::MotionBlur;
    return drawsOneFrame ? 1 : point.samples;
}

bool isProgressive(const SamplePoint& point) {
    return point.method->family == game::MethodFamily::Truth;
}

/// Why the device cannot run it.
const char* describeLack(const game::MethodInfo& method) {
    return method.rays == game::RayNeed::Query ? "the device traces no ray queries"
                                               : "the device traces no rays";
}

double secondsOf(const render::FrameResult& drawn) {
    return drawn.statistics.wallMilliseconds / 1e3;
}

/// The rounds of one case.
class Rounds {
  public:
    Rounds(
        gpu::Device& device,
        const Case& shot,
        CaseStage& stage,
        const std::vector<SamplePoint>& sweep,
        const MeasureOptions& options,
        core::Progress& progress,
        const StopQuestion& stop
    )
        : mDevice(device), mName(shot.name), mStage(stage), mOptions(options), mProgress(progress),
          mStop(stop) {
        for (const SamplePoint& point : sweep)
            (isProgressive(point) ? mProgressive : mEntries).push_back({{point}});
        std::set<const game::MethodInfo*> methods;
        for (const SamplePoint& point : sweep)
            methods.insert(point.method);
        mMethodCount = methods.size();
    }

    Status run() {
        for (Entry& entry : mEntries)
            if (!mStop()) {
                announce(entry);
                SHUTTER_TRY(drawFirst(entry));
            }
        if (!mProgressive.empty())
            announce(mProgressive.front());
        SHUTTER_TRY(drawProgressive());
        mProgress.startPart(fmt::format("{}: times", mName));
        for (uint32_t round = 0; round < mOptions.repeats; ++round) {
            for (Entry& entry : mEntries)
                if (!mStop())
                    SHUTTER_TRY(timeOnce(entry, round));
            SHUTTER_TRY(timeProgressive(round));
        }
        return {};
    }

  private:
    struct Entry {
        DrawnPoint drawn;
        double seconds = 0.0; ///< wall time of one picture; 0: not known
        bool isRefused = false;

        [[nodiscard]] const SamplePoint& point() const { return drawn.point; }
    };

    /// Names the method whose first sample count this is.
    void announce(const Entry& entry) {
        if (entry.point().method == mAnnounced)
            return;
        mAnnounced = entry.point().method;
        mProgress.startPart(fmt::format(
            "{}: {}, method {} of {}", mName, mAnnounced->name, ++mAnnouncedCount, mMethodCount
        ));
    }

    Status refuse(Entry& entry, const std::string& reason) {
        entry.isRefused = true;
        return mStage.journal().skip(makeKey(entry.point()), reason);
    }

    std::string describeLimit(double predicted) const {
        return fmt::format(
            "predicted {:.0f} s, above the limit of {:.0f} s", predicted, mOptions.limitSeconds
        );
    }

    /// A picture's time grows with frames and rays: predicted from the sample count before. 0:
    /// unknown.
    double predict(const Entry& entry) const {
        double perStep = 0.0;
        for (const Entry& other : mEntries)
            if (other.point().method == entry.point().method && other.seconds > 0.0)
                perStep = other.seconds / double(stepsOf(other.point()));
        return perStep * double(stepsOf(entry.point()));
    }

    /// Compares the picture and measures its cost.
    Status drawFirst(Entry& entry) {
        const SamplePoint& point = entry.point();
        if (!game::canRun(*point.method, mDevice))
            return refuse(entry, describeLack(*point.method));
        if (mStage.hasLens() && !point.method->hasLens &&
            point.method->family != game::MethodFamily::Sharp)
            return refuse(entry, "it draws what a pinhole sees, not what the lens does");
        if (!mStage.hasLens() && point.method->lensFilter != nullptr)
            return refuse(entry, "the camera has no lens");
        const double predicted = predict(entry);
        // A method's default is what its row in the report is of.
        if (predicted > mOptions.limitSeconds && !point.isDefault) {
            mProgress.advance(stepsOf(point) * (mOptions.repeats + 1));
            return refuse(entry, describeLimit(predicted));
        }
        const std::vector<Sample>& samples = mStage.journal().find(makeKey(point)).samples;
        const double known = samples.empty() ? 0.0 : samples.front().wallMilliseconds / 1e3;
        // An expensive point is done before it has all repeats.
        const bool isDone = double(samples.size()) * known >= kSecondsAPoint;
        if (mStage.isKnown(point, isDone ? 1 : mOptions.repeats)) {
            mProgress.advance(stepsOf(point) * (mOptions.repeats + 1));
            entry.seconds = known;
            return {};
        }
        // Its first picture compiles pipelines, which does not count as its time: a single frame's
        // for each sample count, but the same for any number of frames.
        if (predicted == 0.0 || stepsOf(point) == 1)
            if (auto warm = mStage.draw(entry.drawn); !warm)
                return warm.error();
        auto drawn = mStage.draw(entry.drawn);
        if (!drawn)
            return drawn.error();
        entry.seconds = secondsOf(drawn.value());
        SHUTTER_TRY(mStage.keepPicture(point, drawn.value()));
        // An expensive picture is drawn once: reuse the warm-up run as the sample.
        const bool isExpensive = entry.seconds > kSecondsAPoint / 2 && known == 0.0;
        return isExpensive ? mStage.keepSample(point, drawn.value()) : Status();
    }

    Status timeOnce(Entry& entry, uint32_t round) {
        const size_t known = mStage.journal().find(makeKey(entry.point())).samples.size();
        if (entry.isRefused || known > round)
            return {};
        if (round > 0 && round * entry.seconds >= kSecondsAPoint) {
            mProgress.advance(stepsOf(entry.point()));
            return {};
        }
        auto drawn = mStage.draw(entry.drawn);
        return drawn ? mStage.keepSample(entry.point(), drawn.value()) : Status(drawn.error());
    }

    /// Runs a progressive method up to the sample count of `last`, and measures the smaller counts
    /// on the way.
    Status runProgressive(Entry& last) {
        Status kept;
        game::Checkpoints checkpoints;
        for (const Entry& entry : mProgressive)
            if (entry.point().samples <= last.point().samples)
                checkpoints.rays.push_back(entry.point().samples);
        checkpoints.onPicture = [&](uint32_t rays, const render::FrameResult& picture) {
            for (const Entry& entry : mProgressive) {
                if (entry.point().samples != rays || !kept)
                    continue;
                kept = mStage.keepPicture(entry.point(), picture);
                if (kept)
                    kept = mStage.keepSample(entry.point(), picture);
            }
        };
        auto drawn = mStage.draw(last.drawn, checkpoints);
        return drawn ? kept : Status(drawn.error());
    }

    /// The last entry whose picture takes at most so many seconds; null if none does.
    Entry* findLastWithin(double seconds) {
        Entry* last = nullptr;
        for (Entry& entry : mProgressive)
            if (entry.seconds <= seconds)
                last = &entry;
        return last;
    }

    Status drawProgressive() {
        if (mProgressive.empty() || mStop())
            return {};
        if (!game::canRun(*mProgressive.front().point().method, mDevice)) {
            for (Entry& entry : mProgressive)
                SHUTTER_TRY(refuse(entry, describeLack(*entry.point().method)));
            return {};
        }
        // The first picture compiles shaders, the second measures the cost of a ray.
        Entry& first = mProgressive.front();
        auto warm = mStage.draw(first.drawn);
        auto drawn = warm ? mStage.draw(first.drawn) : std::move(warm);
        if (!drawn)
            return drawn.error();
        const double secondsARay = secondsOf(drawn.value()) / first.point().samples;
        for (Entry& entry : mProgressive)
            entry.seconds = secondsARay * entry.point().samples;
        Entry* last = findLastWithin(mOptions.limitSeconds);
        for (Entry& entry : mProgressive)
            if (last == nullptr || entry.point().samples > last->point().samples)
                SHUTTER_TRY(refuse(entry, describeLimit(entry.seconds)));
        const bool isKnown = last == nullptr || mStage.isKnown(last->point(), 1);
        return isKnown || mStop() ? Status() : runProgressive(*last);
    }

    /// The largest sample count is timed once, by the run that made its pictures.
    Status timeProgressive(uint32_t round) {
        if (round == 0 || mProgressive.empty() || mStop() ||
            !game::canRun(*mProgressive.front().point().method, mDevice))
            return {};
        Entry* last = findLastWithin(kSecondsAPoint / mOptions.repeats);
        if (last == nullptr || mStage.isKnown(last->point(), round + 1))
            return {};
        return runProgressive(*last);
    }

    gpu::Device& mDevice;
    const std::string& mName; ///< the case's
    size_t mMethodCount = 0;
    size_t mAnnouncedCount = 0;
    const game::MethodInfo* mAnnounced = nullptr; ///< last
    CaseStage& mStage;
    const MeasureOptions& mOptions;
    core::Progress& mProgress;
    const StopQuestion& mStop;
    std::vector<Entry> mEntries;
    std::vector<Entry> mProgressive; ///< sample counts that a method passes on the way to its last
};

} // namespace

uint64_t countSteps(const std::vector<SamplePoint>& sweep, const MeasureOptions& options) {
    uint64_t steps = options.comparePictures ? options.truthSamples : 0;
    uint64_t progressive = 0; // one run passes all sample counts
    for (const SamplePoint& point : sweep) {
        if (isProgressive(point))
            progressive = std::max(progressive, stepsOf(point));
        else
            steps += stepsOf(point) * (options.repeats + 1);
    }
    return steps + progressive;
}

std::string pictureFile(const std::string& caseName, const std::string& method, uint32_t samples) {
    return fmt::format("images/{}.{}.{}.png", caseName, method, samples);
}

std::string makeKey(const SamplePoint& point) {
    return fmt::format("{}/{}", point.method->name, point.samples);
}

core::Result<CaseResult> measureCase(
    gpu::Device& device,
    const Case& shot,
    const std::vector<SamplePoint>& sweep,
    const MeasureOptions& options,
    core::Progress& progress,
    const StopQuestion& stop
) {
    auto created = CaseStage::create(device, shot, options, progress);
    if (!created)
        return created.error();
    CaseStage& stage = *created.value();
    if (options.comparePictures) {
        progress.startPart(shot.name + ": the truth");
        SHUTTER_TRY(stage.provideTruth());
    }
    SHUTTER_TRY(Rounds(device, shot, stage, sweep, options, progress, stop).run());
    CaseResult result{
        stage.truthImage(), stage.truthLinear(), stage.truthHash(), stage.journal().records(), {}};
    if (options.comparePictures && !stop()) {
        auto crops = stage.chooseCrops();
        if (!crops)
            return crops.error();
        result.crops = std::move(crops.value());
    }
    return result;
}

} // namespace shutter::bench
