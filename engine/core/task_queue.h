// SPDX-License-Identifier: MIT
// Work that few background threads do in the order in which it was requested, unless whoever needs
// it does it first.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace shutter::core {

/// Work of a TaskQueue, done at most once.
class QueuedTask {
  public:
    explicit QueuedTask(std::function<void()> work) : mWork(std::move(work)) {}

    /// Does it on this thread unless one of the queue has begun it, for which this waits. Throws
    /// what the work threw.
    void finish();

    /// Prevents it from being begun, or waits for the thread that has begun it.
    void drop();

    /// Whether finish() returns at once.
    [[nodiscard]] bool isDone() const;

  private:
    friend class TaskQueue;

    enum class State : uint8_t { Waiting, Running, Done };

    /// \return false: another thread has begun it, or it was dropped
    bool begin();
    void run();

    std::function<void()> mWork;
    mutable std::mutex mMutex;
    mutable std::condition_variable mIsDone;
    State mState = State::Waiting;
    std::exception_ptr mError;
};

class TaskQueue {
  public:
    /// \param threadCount above 0. Where the system starts fewer, tasks are done by finish() alone
    explicit TaskQueue(size_t threadCount);
    /// Waits for the tasks that have begun; the others are not begun.
    ~TaskQueue();
    TaskQueue(const TaskQueue&) = delete;
    TaskQueue& operator=(const TaskQueue&) = delete;

    [[nodiscard]] std::shared_ptr<QueuedTask> add(std::function<void()> work);

  private:
    void serve();

    std::mutex mMutex;
    std::condition_variable mHasWork;
    std::deque<std::shared_ptr<QueuedTask>> mTasks;
    bool mEnds = false;
    std::vector<std::thread> mThreads;
};

} // namespace shutter::core
