// SPDX-License-Identifier: MIT
// Detects concurrent calls of an object that may be used by one thread at a time, so that they are
// refused without side effects.
#pragma once

#include "engine/core/result.h"

#include <atomic>
#include <thread>

namespace shutter::motion_blur {

class OneThread {
  public:
    /// A call, as long as it lives. Where status() is an error, it may do nothing.
    class Call {
      public:
        explicit Call(OneThread& object) : mObject(object) {
            std::thread::id inside;
            const std::thread::id own = std::this_thread::get_id();
            if (mObject.mInside.compare_exchange_strong(inside, own))
                mIsAlone = true;
            else
                mIsWithin = inside == own;
        }

        ~Call() {
            if (mIsAlone)
                mObject.mInside.store(std::thread::id());
        }

        Call(const Call&) = delete;
        Call& operator=(const Call&) = delete;

        [[nodiscard]] core::Status status() const {
            if (mIsAlone)
                return {};
            return core::makeError(
                "motion blur: {}",
                mIsWithin
                    ? "the object is called within a callback of its own, which must call none "
                      "of its functions"
                    : "another thread is in a call of the object, which one thread at a time "
                      "may use: lock it, or give each thread an object of its own"
            );
        }

      private:
        OneThread& mObject;
        bool mIsAlone = false;
        bool mIsWithin = false;
    };

  private:
    std::atomic<std::thread::id> mInside{}; ///< none: no call is in progress
};

} // namespace shutter::motion_blur
