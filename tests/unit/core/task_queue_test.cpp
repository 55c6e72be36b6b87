// SPDX-License-Identifier: MIT
#include "engine/core/task_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace shutter::core {
namespace {

/// A queue whose only thread is held up until release().
class HeldQueue {
  public:
    HeldQueue() : mQueue(1) {
        std::promise<void> begun;
        mFirst = mQueue.add([&begun, this] {
            begun.set_value();
            mMayGoOn.get_future().wait();
        });
        begun.get_future().wait();
    }

    ~HeldQueue() { release(); }

    void release() {
        if (!std::exchange(mIsReleased, true))
            mMayGoOn.set_value();
    }

    TaskQueue& queue() { return mQueue; }

    QueuedTask& first() { return *mFirst; }

  private:
    std::promise<void> mMayGoOn;
    bool mIsReleased = false;
    TaskQueue mQueue;
    std::shared_ptr<QueuedTask> mFirst;
};

TEST(TaskQueue, AllTasksAreDoneOnceByWhateverThread) {
    std::atomic<int> sum = 0;
    TaskQueue queue(3);
    std::vector<std::shared_ptr<QueuedTask>> tasks;
    for (int i = 1; i <= 100; ++i)
        tasks.push_back(queue.add([&sum, i] { sum += i; }));
    for (const auto& task : tasks)
        task->finish();
    for (const auto& task : tasks) {
        task->finish();
        EXPECT_TRUE(task->isDone());
    }
    EXPECT_EQ(sum, 5050);
}

TEST(TaskQueue, WhoNeedsATaskThatWaitsDoesItThemselves) {
    HeldQueue held;
    int count = 0;
    const auto task = held.queue().add([&] { ++count; });
    EXPECT_FALSE(task->isDone());
    task->finish();
    EXPECT_EQ(count, 1);
    EXPECT_FALSE(held.first().isDone());
}

TEST(TaskQueue, ADroppedTaskIsNeverBegunAndOneThatHasBegunIsWaitedFor) {
    HeldQueue held;
    bool isDone = false;
    const auto task = held.queue().add([&] { isDone = true; });
    task->drop();
    held.release();
    held.first().drop();
    EXPECT_TRUE(held.first().isDone());
    held.queue().add([] {})->finish();
    EXPECT_FALSE(isDone);
}

TEST(TaskQueue, AnExceptionReachesWhoFinishesTheTask) {
    TaskQueue queue(1);
    const auto task = queue.add([] { throw std::runtime_error("lost"); });
    EXPECT_THROW(task->finish(), std::runtime_error);
    EXPECT_THROW(task->finish(), std::runtime_error);
}

TEST(TaskQueue, ItsEndBeginsNoTaskThatWaits) {
    int count = 0;
    std::shared_ptr<QueuedTask> late;
    {
        HeldQueue held;
        late = held.queue().add([&] { ++count; });
        late->drop();
    }
    EXPECT_EQ(count, 0);
}

} // namespace
} // namespace shutter::core
