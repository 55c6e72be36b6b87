// SPDX-License-Identifier: MIT
#include "engine/core/task_queue.h"

#include "engine/core/log.h"

#include <system_error>
#include <utility>

namespace shutter::core {

bool QueuedTask::begin() {
    const std::lock_guard lock(mMutex);
    if (mState != State::Waiting)
        return false;
    mState = State::Running;
    return true;
}

void QueuedTask::run() {
    std::exception_ptr error;
    try {
        mWork();
    } catch (...) {
        error = std::current_exception();
    }
    const std::lock_guard lock(mMutex);
    mError = error;
    mState = State::Done;
    // While it is locked: who waits may destroy the task as soon as it can lock it.
    mIsDone.notify_all();
}

void QueuedTask::finish() {
    if (begin())
        run();
    std::unique_lock lock(mMutex);
    mIsDone.wait(lock, [&] { return mState == State::Done; });
    if (mError)
        std::rethrow_exception(mError);
}

void QueuedTask::drop() {
    std::unique_lock lock(mMutex);
    if (mState == State::Waiting)
        mState = State::Done;
    mIsDone.wait(lock, [&] { return mState == State::Done; });
}

bool QueuedTask::isDone() const {
    const std::lock_guard lock(mMutex);
    return mState == State::Done;
}

TaskQueue::TaskQueue(size_t threadCount) {
    try {
        for (size_t i = 0; i < threadCount; ++i)
            mThreads.emplace_back([this] { serve(); });
    } catch (const std::system_error& error) {
        logWarning(
            "only {} of {} threads were started: {}", mThreads.size(), threadCount, error.what()
        );
    }
}

TaskQueue::~TaskQueue() {
    {
        const std::lock_guard lock(mMutex);
        mEnds = true;
    }
    mHasWork.notify_all();
    for (std::thread& thread : mThreads)
        thread.join();
}

std::shared_ptr<QueuedTask> TaskQueue::add(std::function<void()> work) {
    auto task = std::make_shared<QueuedTask>(std::move(work));
    {
        const std::lock_guard lock(mMutex);
        mTasks.push_back(task);
    }
    mHasWork.notify_one();
    return task;
}

void TaskQueue::serve() {
    std::unique_lock lock(mMutex);
    while (true) {
        mHasWork.wait(lock, [&] { return mEnds || !mTasks.empty(); });
        if (mEnds)
            return;
        const std::shared_ptr<QueuedTask> task = std::move(mTasks.front());
        mTasks.pop_front();
        lock.unlock();
        if (task->begin())
            task->run();
        lock.lock();
    }
}

} // namespace shutter::core
