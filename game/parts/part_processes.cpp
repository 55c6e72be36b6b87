// SPDX-License-Identifier: MIT
#include "game/parts/part_processes.h"

#include "engine/io/process.h"
#include "game/options/option_rows.h"
#include "game/parts/part_progress.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

namespace shutter::parts {

namespace {

constexpr std::chrono::milliseconds kLook(500); ///< from one look at what is done to the next

/// What the processes have left to do, shared by the threads that wait for them.
class Queue {
  public:
    explicit Queue(const std::vector<uint32_t>& parts) : mParts(parts) {}

    /// Nothing where all are taken or one has failed.
    std::optional<uint32_t> take() {
        const std::lock_guard lock(mMutex);
        if (mError || mNext == mParts.size())
            return std::nullopt;
        return mParts[mNext++];
    }

    void fail(core::Error error) {
        const std::lock_guard lock(mMutex);
        if (!mError)
            mError = std::move(error);
    }

    /// A thread has nothing left to do.
    void leave() {
        const std::lock_guard lock(mMutex);
        ++mLeft;
        mChanged.notify_all();
    }

    /// Waits a while; whether `threads` have left.
    bool waitFor(size_t threads) {
        std::unique_lock lock(mMutex);
        return mChanged.wait_for(lock, kLook, [&] { return mLeft == threads; });
    }

    [[nodiscard]] core::Status status() {
        const std::lock_guard lock(mMutex);
        return mError ? core::Status(*mError) : core::Status();
    }

  private:
    std::mutex mMutex;
    std::condition_variable mChanged;
    const std::vector<uint32_t>& mParts;
    size_t mNext = 0;
    size_t mLeft = 0;
    std::optional<core::Error> mError;
};

/// Waits for a process that does the part.
core::Status runPart(const PartWork& work, uint32_t part, const std::string& device) {
    std::vector<std::string> words = {work.partCommand, work.folder.string(), std::to_string(part)};
    if (!device.empty())
        words.insert(words.end(), {"--device", device});
    const auto run = io::runProcess("/proc/self/exe", words, work.start);
    if (!run)
        return run.error();
    if (run.value().exitStatus == 0)
        return {};
    const std::string said = findLastSentence(run.value().errors);
    if (said.empty())
        return core::makeError(
            "part {} ended with status {}; the same command goes on where it stopped",
            part,
            run.value().exitStatus
        );
    return core::makeError("part {}: {}", part, said);
}

/// None where the work's own device is to be taken.
std::vector<std::string> splitDevices(const std::string& text) {
    return text.empty() ? std::vector<std::string>() : game::splitAt(text, ',');
}

} // namespace

core::Status runHere(const PartWork& work, const JobOptions& options) {
    const auto parts = work.listUnfinished();
    if (!parts)
        return parts.error();
    const std::vector<std::string> devices = splitDevices(options.devices);
    Queue queue(parts.value());
    const size_t count = std::min<size_t>(options.jobs, parts.value().size());
    std::vector<std::jthread> threads;
    for (size_t i = 0; i < count; ++i)
        threads.emplace_back([&, i] {
            // A process is killed when the thread that started it ends, so this one waits for it.
            const std::string device = devices.empty() ? "" : devices[i % devices.size()];
            while (const auto part = queue.take())
                if (core::Status done = runPart(work, *part, device); !done)
                    queue.fail(done.error());
            queue.leave();
        });
    PartProgress progress(work);
    while (!queue.waitFor(count))
        progress.look();
    threads.clear();
    return queue.status();
}

} // namespace shutter::parts
